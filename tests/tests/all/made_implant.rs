//! Coarse implants with their files, and silhouettes of them.

use fluoropose::canonical::CanonicalSpec;
use fluoropose::image::mask::words_needed;
use fluoropose::implant::write_implant;
use fluoropose::library::ViewAxis;
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose::{Camera, Mask, MaskMut};
use fluoropose_laboratory::finding::{ViewOptions, build_library};
use fluoropose_laboratory::options::Range;
use fluoropose_phantom::implant::{Parameters, Triangles, femur, tibia};
use fluoropose_tests::surface;

pub(crate) const DISTANCE: f64 = 900.0;

/// A small frame: 512 x 512 pixels of 0.6 mm.
pub(crate) fn camera() -> Camera {
    Camera::from_principal_distance(512, 512, 1000.0, 0.6, [3.0, -2.0]).expect("valid")
}

/// A coarse implant and its file: 64 x 64 pixels, every 5 degrees.
fn made(make: impl Fn(&Parameters) -> Triangles) -> (OwnedModel, Words) {
    let parameters = Parameters {
        resolution: 0.5,
        ..Parameters::default()
    };
    let owned = surface(make(&parameters));
    let model = owned.as_model();
    let axis = |reach: f64| {
        Some(Range(ViewAxis {
            first: -reach,
            step: 5.0,
            count: (reach / 2.5) as usize + 1,
        }))
    };
    let views = ViewOptions {
        x: axis(15.0),
        y: axis(20.0),
        area: Some(CanonicalSpec::COARSE.area()),
        size: Some(CanonicalSpec::COARSE.size()),
        ..ViewOptions::default()
    };
    let library = build_library(model, camera(), &views, DISTANCE).expect("built");
    let planes = symmetry_planes(model.mesh());
    let bytes = write_implant(&model, &library.bytes, &planes, 0.25).expect("they belong together");
    (owned, Words::of(&bytes))
}

pub(crate) fn made_femur() -> (OwnedModel, Words) {
    made(|parameters| femur(parameters).expect("possible"))
}

pub(crate) fn made_tibia() -> (OwnedModel, Words) {
    made(|parameters| tibia(parameters).expect("possible"))
}

/// Bytes at an address that is a multiple of four.
pub(crate) struct Words {
    room: Vec<u8>,
    first: usize,
    pub(crate) length: usize,
}

impl Words {
    pub(crate) fn of(bytes: &[u8]) -> Self {
        let mut room = vec![0; bytes.len() + 3];
        let first = room.as_ptr().align_offset(4);
        room[first..first + bytes.len()].copy_from_slice(bytes);
        let length = bytes.len();
        Self {
            room,
            first,
            length,
        }
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.room[self.first..self.first + self.length]
    }

    pub(crate) fn flip(&mut self, bit: usize) {
        self.room[self.first + bit / 8] ^= 1 << (bit % 8);
    }
}

/// A silhouette at a pose, in all of the frame.
pub(crate) fn drawn(model: &OwnedModel, euler: EulerPose) -> Vec<u32> {
    let (model, camera) = (model.as_model(), camera());
    let mut words = vec![0; words_needed(512, 512)];
    let mut mask = MaskMut::new(&mut words, 512, 512).expect("fits");
    let mut scratch = vec![Projected::default(); scratch_needed(&model)];
    render(&model, &camera, &Pose::from(euler), &mut scratch, &mut mask).expect("in front");
    words
}

/// A few somewhere in the frame, at its border too.
pub(crate) fn poses() -> impl Iterator<Item = EulerPose> {
    many_poses().take(16)
}

/// As many as are wanted.
pub(crate) fn many_poses() -> impl Iterator<Item = EulerPose> {
    (0i32..).map(|k| {
        let draw = |irrational: f64, reach: f64| {
            reach * (2.0 * (irrational * f64::from(k + 1)).fract() - 1.0)
        };
        EulerPose {
            x_mm: draw(2f64.sqrt(), 95.0),
            y_mm: draw(3f64.sqrt(), 95.0),
            z_mm: draw(5f64.sqrt(), 40.0) - DISTANCE,
            z_rot_deg: draw(7f64.sqrt(), 180.0),
            x_rot_deg: draw(11f64.sqrt(), 14.0),
            y_rot_deg: draw(13f64.sqrt(), 19.0),
        }
    })
}

/// Whether a silhouette touches the frame's border: pieces of its outline are looked for then.
pub(crate) fn is_cut_off(mask: &Mask<'_>) -> bool {
    let (columns, rows) = mask.bounds();
    let [right, below] = [mask.width(), mask.height()];
    columns.start == 0 || rows.start == 0 || columns.end == right || rows.end == below
}

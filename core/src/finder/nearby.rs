//! Starts for refinement around a pose that is only roughly known.
//!
//! Four of six parameters follow from a whole silhouette's area, centroid and principal axis at
//! once (the first step of Walker et al. 1996, section 2.3, on a drawing made for the purpose),
//! so only the two rotations out of the image plane have to be searched.

use heapless::Vec;

use crate::camera::Camera;
use crate::image::mask::{MaskMut, words_needed};
use crate::image::moments::Moments;
use crate::image::silhouette::Silhouette;
use crate::locate::rerank::unmatched_at_pose;
use crate::math::{
    Vector3, add, apply, atan2, multiply, norm, radians, rotation_by, scale, sqrt, subtract, wrap,
};
use crate::mesh::Model;
use crate::pose::Pose;
use crate::refine::RefineMemory;
use crate::render::{Projected, render};
use crate::shortlist::{first_of, keep};

/// Most starts that [`nearby`] returns: the pose itself and the best of those around it.
pub const NEARBY: usize = 5;

/// Step of the search for a start that is only roughly known, degrees.
pub const WIDE_DEG: f64 = 8.0;
/// Steps to each side.
const STEPS: [f64; 5] = [-2.0, -1.0, 0.0, 1.0, 2.0];

/// How often a drawing is moved onto the silhouette: twice where steps are wider than this, degrees.
const MOVES: usize = 2;
const WIDE_STEP_DEG: f64 = 2.0;

/// Starts around `start` for [`crate::refine::refine()`]: the poses that cover a whole silhouette best, best first, and
/// `start` itself last. The poses tried are two steps of `step_deg` degrees to each side about the camera's x and
/// y. [`WIDE_DEG`] serves a start that is up to 15 degrees, 10 mm sideways and a tenth of its distance off. Draws
/// the model 75 times, for small steps 50 times.
///
/// Area and centroid must be those of the whole component: for a silhouette with unknown pixels only `start` is
/// returned ([`crate::locate::partial`] finds poses of such silhouettes).
pub fn nearby(
    model: &Model<'_>,
    camera: &Camera,
    silhouette: &Silhouette<'_>,
    start: &Pose,
    step_deg: f64,
    memory: &mut RefineMemory<'_>,
) -> Vec<Pose, NEARBY> {
    // A place is left for `start` itself.
    let mut found: Vec<(u64, Pose), { NEARBY - 1 }> = Vec::new();
    let (width, height) = (camera.width(), camera.height());
    let words = memory.drawn.get_mut(..words_needed(width, height));
    let drawn = MaskMut::new(words.unwrap_or_default(), width, height);
    if let (Ok(drawn), None) = (drawn, silhouette.unknown()) {
        let mut search = NearbySearch {
            model,
            camera,
            silhouette,
            wanted: silhouette.mask().moments(),
            middle: model.bounds().centre,
            moves: if step_deg > WIDE_STEP_DEG { MOVES } else { 1 },
            scratch: memory.projected,
            drawn,
        };
        for x in &STEPS {
            for y in &STEPS {
                let turn = [x, y].map(|steps| radians(step_deg * steps));
                let Some((unmatched, pose)) = search.moved([turn[0], turn[1], 0.0], start) else {
                    continue;
                };
                keep(&mut found, (unmatched, pose), |&(unmatched, _)| unmatched);
            }
        }
    }
    let mut poses: Vec<Pose, NEARBY> = first_of(found.iter().map(|&(_, pose)| pose));
    let _ = poses.push(*start);
    poses
}

struct NearbySearch<'s> {
    model: &'s Model<'s>,
    camera: &'s Camera,
    silhouette: &'s Silhouette<'s>,
    wanted: Moments,
    middle: Vector3,
    moves: usize,
    scratch: &'s mut [Projected],
    drawn: MaskMut<'s>,
}

impl NearbySearch<'_> {
    /// Rotates `start` by `turn`, moves it onto the silhouette, and counts the pixels that differ then.
    fn moved(&mut self, turn: Vector3, start: &Pose) -> Option<(u64, Pose)> {
        let mut pose = about(&self.middle, start, &turn, [0.0; 3]);
        for _ in 0..self.moves {
            pose = self.onto_silhouette(&pose)?;
        }
        let (model, camera) = (self.model, self.camera);
        let (scratch, drawn) = (&mut *self.scratch, &mut self.drawn);
        let unmatched =
            unmatched_at_pose(model, camera, &pose, self.silhouette, scratch, drawn).ok()?;
        Some((unmatched, pose))
    }

    /// The pose at which the drawing has the silhouette's area, centroid and principal axis, to
    /// first order. An axis has two directions: the smaller turn is taken.
    fn onto_silhouette(&mut self, pose: &Pose) -> Option<Pose> {
        let drawn = self.moments_at(pose)?;
        if drawn.area == 0 {
            return None;
        }
        let centre = pose.transform(&self.middle);
        let [fx, fy] = self.camera.focal();
        let size = sqrt(drawn.area as f64 / self.wanted.area as f64);
        let depth = -centre[2] * size;
        let (a, b) = (drawn.centroid(), self.wanted.centroid());
        let aside = [
            centre[0] * (size - 1.0) + (b.column - a.column) * depth / fx,
            centre[1] * (size - 1.0) - (b.row - a.row) * depth / fy,
            centre[2] * (size - 1.0),
        ];
        let aspect = self.camera.aspect();
        let turn = axis_angle(&self.wanted, aspect) - axis_angle(&drawn, aspect);
        let turn = wrap(turn, core::f64::consts::PI);
        let ray = scale(&centre, -1.0 / norm(&centre));
        Some(about(&self.middle, pose, &scale(&ray, turn), aside))
    }

    fn moments_at(&mut self, pose: &Pose) -> Option<Moments> {
        self.drawn.clear();
        render(self.model, self.camera, pose, self.scratch, &mut self.drawn).ok()?;
        Some(self.drawn.as_mask().moments())
    }
}

/// A pose rotated about a point of the model, then shifted; both in camera axes.
pub(crate) fn about(middle: &Vector3, pose: &Pose, turn: &Vector3, shift: Vector3) -> Pose {
    let rotation = multiply(&rotation_by(turn), &pose.rotation);
    let centre = add(&pose.transform(middle), &shift);
    Pose {
        rotation,
        translation: subtract(&centre, &apply(&rotation, middle)),
    }
}

/// Angle of the principal axis, counter-clockwise on the screen, radians, known up to half a turn; pixels are `aspect` times as high as wide
/// ([`Camera::aspect`]).
fn axis_angle(moments: &Moments, aspect: f64) -> f64 {
    let [xx, xy, yy] = moments.covariance();
    0.5 * atan2(-2.0 * xy * aspect, xx - yy * aspect * aspect)
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::finder::fake::{SIDE, camera, crank, drawn, placed};
    use crate::image::mask::Mask;
    use crate::pose::geodesic_deg;
    use crate::refine::RefineBuffers;
    use std::vec;

    /// How far a pose is from where the silhouette was drawn: degrees, mm in the image plane, and mm along the view, of the model's middle.
    fn off(pose: &Pose, right: &Pose, middle: &Vector3) -> [f64; 3] {
        let [x, y, z] = subtract(&pose.transform(middle), &right.transform(middle));
        [
            geodesic_deg(&pose.rotation, &right.rotation),
            norm(&[x, y, 0.0]),
            z.abs(),
        ]
    }

    /// A bar that is turned counter-clockwise on the screen, where rows go down.
    #[test]
    fn the_principal_axis_is_the_way_that_a_bar_lies() {
        for turn_deg in [-80.0, -45.0, -10.0, 0.0, 25.0, 60.0, 90.0] {
            let (sin, cos) = crate::math::sin_cos(radians(turn_deg));
            let mut words = vec![0; words_needed(SIDE, SIDE)];
            let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
            for at in 0..SIDE * SIDE {
                let (right, up) = ((at % SIDE) as f64 - 70.0, 85.0 - (at / SIDE) as f64);
                let (along, across) = (right * cos + up * sin, up * cos - right * sin);
                mask.set(
                    at % SIDE,
                    at / SIDE,
                    along.abs() < 49.5 && across.abs() < 7.5,
                );
            }
            let angle = axis_angle(&mask.as_mask().moments(), 1.0);
            let off = wrap(angle - radians(turn_deg), core::f64::consts::PI);
            assert!(off.abs() < 0.005, "{turn_deg}: {angle}");
        }
    }

    /// In the image plane and along the view a drawing tells all at once; a turn out of that plane is tried.
    #[test]
    fn a_start_off_to_all_sides_is_brought_onto_the_silhouette() {
        let (model, camera) = (crank(), camera());
        let right = placed([14.0, -9.0, 20.0], [4.0, -6.0, 0.0]);
        let words = drawn(&model, &camera, &right);
        let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
        let middle = model.as_model().bounds().centre;
        let silhouette = Silhouette::from(&mask);
        let (mut buffers, model) = (RefineBuffers::default(), model.as_model());
        for (turn_deg, shift) in [
            ([0.0, 0.0, 25.0], [9.0, 5.0, 60.0]),
            ([0.0, 0.0, -25.0], [-8.0, -7.0, -70.0]),
            ([0.0, 0.0, 70.0], [0.0, 9.0, 0.0]),
            ([WIDE_DEG, 0.0, 9.0], [6.0, 0.0, 30.0]),
            ([0.0, -WIDE_DEG, 0.0], [0.0, 0.0, 0.0]),
        ] {
            let start = about(&middle, &right, &turn_deg.map(radians), shift);
            let mut memory = buffers.borrow(&model, &camera);
            let found = nearby(&model, &camera, &silhouette, &start, WIDE_DEG, &mut memory);
            assert_eq!((found.len(), found.last()), (NEARBY, Some(&start)));
            let [deg, aside_mm, deeper_mm] = off(&found[0], &right, &middle);
            assert!(
                deg < 2.5 && aside_mm < 0.6 && deeper_mm < 12.0,
                "{turn_deg:?} {shift:?}: {deg} {aside_mm} {deeper_mm}"
            );
        }
    }

    /// Of a part of a silhouette neither area nor centroid is known.
    #[test]
    fn of_a_silhouette_that_is_not_known_as_a_whole_the_start_alone_is_left() {
        let (model, camera) = (crank(), camera());
        let right = placed([14.0, -9.0, 20.0], [0.0; 3]);
        let words = drawn(&model, &camera, &right);
        let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
        let nothing = vec![0; words.len()];
        let unknown = Mask::new(&nothing, SIDE, SIDE).expect("valid");
        let silhouette = Silhouette::new(&mask, &unknown).expect("as large");
        let (mut buffers, model) = (RefineBuffers::default(), model.as_model());
        let mut memory = buffers.borrow(&model, &camera);
        let found = nearby(&model, &camera, &silhouette, &right, WIDE_DEG, &mut memory);
        assert_eq!(found, [right]);
    }

    /// Of a flat part that faces the camera area, centroid and axis tell all four numbers at once, exactly.
    #[test]
    fn a_flat_part_is_brought_onto_its_silhouette_by_one_move() {
        let turned = [
            (0.0, [0.0, 0.0, 0.0]),
            (0.0, [-20.0, 0.0, 0.0]),
            (0.0, [0.0, 25.0, 0.0]),
            (0.0, [0.0, 0.0, 90.0]),
            (-30.0, [9.0, 12.0, -110.0]),
        ];
        for ([deg, aside_mm, deeper_mm], from) in brought(&camera(), &turned).iter().zip(&turned) {
            // About the ray, which is not quite the camera's axis.
            assert!(
                *deg < 1.0 && *aside_mm < 0.25 && *deeper_mm < 5.0,
                "{from:?}: {deg} {aside_mm} {deeper_mm}"
            );
        }
        // In pixels that are higher than wide, or wider than high, a turn is not that of the pixels' numbers.
        for focal in [[1010.0, 730.0], [730.0, 1010.0]] {
            let camera = Camera::new(SIDE, SIDE, focal, [81.0, 78.5]).expect("valid");
            let turned = [-35.0, -20.0, 20.0, 35.0].map(|deg| (deg, [0.0; 3]));
            let left = brought(&camera, &turned);
            assert!(left.iter().all(|[deg, ..]| *deg < 1.0), "{left:?}");
        }
    }

    /// What one move leaves of each of these turns about the view and shifts ([`off`]).
    fn brought(camera: &Camera, off_by: &[(f64, Vector3)]) -> std::vec::Vec<[f64; 3]> {
        use crate::mesh::OwnedModel;
        let (mut vertices, mut triangles) = (vec![], vec![]);
        crate::mesh::edges::fake::add_box(
            [-32.0, -14.0, -0.05],
            [32.0, 14.0, 0.05],
            &mut vertices,
            &mut triangles,
        );
        let (vertices, triangles) = (vertices.as_flattened(), triangles.as_flattened());
        let model = OwnedModel::new(vertices.to_vec(), triangles.to_vec()).expect("valid");
        let model_of = model.as_model();
        let right = placed([0.0, 0.0, 20.0], [14.0, -19.0, 30.0]);
        let words = drawn(&model, camera, &right);
        let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
        let silhouette = Silhouette::from(&mask);
        let mut buffers = RefineBuffers::default();
        let memory = buffers.borrow(&model_of, camera);
        let mut search = NearbySearch {
            model: &model_of,
            camera,
            silhouette: &silhouette,
            wanted: mask.moments(),
            middle: [0.0; 3],
            moves: 1,
            scratch: memory.projected,
            drawn: MaskMut::new(&mut memory.drawn[..words_needed(SIDE, SIDE)], SIDE, SIDE)
                .expect("fits"),
        };
        let left = off_by.iter().map(|&(turn_deg, shift)| {
            let turn = [0.0, 0.0, radians(turn_deg)];
            let start = about(&[0.0; 3], &right, &turn, shift);
            let (_, moved) = search.moved([0.0; 3], &start).expect("in the frame");
            off(&moved, &right, &[0.0; 3])
        });
        left.collect()
    }
}

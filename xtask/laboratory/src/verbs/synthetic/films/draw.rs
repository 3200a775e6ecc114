//! Random films of the built-in implants.

use anyhow::{Context, Result};
use fluoropose::camera::Camera;
use fluoropose::image::frame::Frame;
use fluoropose::image::mask::{Mask, Word};
use fluoropose::pose::{EulerPose, Pose};
use fluoropose_phantom::film::motion::{DEEPEST_DEG, knee};
use fluoropose_phantom::film::{self, Physics, Placed, Scene};
use fluoropose_phantom::implant::{Side, Size, Triangles};
use fluoropose_tracing::one_click::Prompt;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::finding::prompts::Kind;

/// Ranges of the tray's pose: mm to the sides, mm along the view about the distance, degrees out of plane about x and y.
/// That is what lateral fluoroscopy sees; in the plane a leg lies any way.
const ASIDE_MM: f64 = 30.0;
const DISTANCE_MM: f64 = 1084.0;
const DEPTH_MM: f64 = 50.0;
const X_DEG: f64 = 8.0;
const Y_DEG: f64 = 15.0;

/// A film with its truth. Of each pair the femur comes first.
pub(super) struct Film {
    /// 8-bit grey, row by row.
    pub(super) pixels: Vec<u8>,
    /// The true poses.
    pub(super) truth: [Pose; 2],
    /// Where a person clicks: where each component is thickest.
    pub(super) clicks: [Prompt; 2],
    /// Their true silhouettes.
    silhouettes: [Vec<Word>; 2],
}

impl Film {
    /// Its only frame.
    ///
    /// # Errors
    /// For a camera of another size.
    pub(super) fn frame(&self, camera: &Camera) -> Result<Frame<'_, u8>> {
        let (width, height) = (camera.width(), camera.height());
        Ok(Frame::new(&self.pixels, width, height, width)?)
    }

    /// The true silhouette of a component.
    ///
    /// # Errors
    /// For a camera of another size.
    pub(super) fn silhouette(&self, part: usize, camera: &Camera) -> Result<Mask<'_>> {
        let words = &self.silhouettes[part];
        Ok(Mask::new(words, camera.width(), camera.height())?)
    }
}

/// Number of a film: the same seed and number show the same knee in every kind of film.
pub(super) struct Number {
    pub(super) seed: u64,
    pub(super) frame: u64,
}

/// Draws a film.
///
/// # Errors
/// Where an implant cannot be drawn.
pub(super) fn draw(
    implants: &[Triangles; 2],
    camera: Camera,
    physics: &Physics,
    number: &Number,
) -> Result<Film> {
    let truth = knee_of(&implants[0], number);
    let [femur, tibia] = [0, 1].map(|part| Placed::at_rest(&implants[part], truth[part]));
    let scene = Scene {
        camera,
        side: Side::Left,
        width_mm: Size::default().width_mm(),
        femur,
        tibia,
    };
    let silhouettes = [
        film::silhouette(&camera, &femur)?,
        film::silhouette(&camera, &tibia)?,
    ];
    let click = |words: &[Word]| -> Result<Prompt> {
        let mask = Mask::new(words, camera.width(), camera.height())?;
        let click = Kind::Deepest.prompt(&mask, None, number.frame);
        click.context("a silhouette has a middle")
    };
    Ok(Film {
        pixels: film::expose(&scene, physics, number.seed, number.frame)?,
        truth,
        clicks: [click(&silhouettes[0])?, click(&silhouettes[1])?],
        silhouettes,
    })
}

fn knee_of(femur: &Triangles, number: &Number) -> [Pose; 2] {
    let mut random = ChaCha8Rng::seed_from_u64(number.seed);
    random.set_stream(number.frame);
    let mut draw = |reach: f64| reach * random.random_range(-1.0..=1.0f64);
    let tibia = EulerPose {
        x_mm: draw(ASIDE_MM),
        y_mm: draw(ASIDE_MM),
        z_mm: -DISTANCE_MM + draw(DEPTH_MM),
        z_rot_deg: draw(180.0),
        x_rot_deg: draw(X_DEG),
        y_rot_deg: draw(Y_DEG),
    };
    let flexion = (DEEPEST_DEG + draw(DEEPEST_DEG)) / 2.0;
    let position = knee(
        tibia,
        flexion,
        Side::Left,
        femur,
        Size::default().width_mm(),
    );
    [position.femur.into(), position.tibia.into()]
}

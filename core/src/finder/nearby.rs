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
        let turn = axis_angle(&self.wanted) - axis_angle(&drawn);
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

/// Angle of the principal axis, counter-clockwise on the screen, radians, known up to half a turn.
fn axis_angle(moments: &Moments) -> f64 {
    let [xx, xy, yy] = moments.covariance();
    0.5 * atan2(-2.0 * xy, xx - yy)
}

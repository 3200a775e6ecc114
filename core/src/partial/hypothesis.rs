//! A view laid on the frame, and what it says of the pose.

use super::similarity::Similarity;
use super::smooth::Plane;
use crate::camera::Camera;
use crate::canonical::CanonicalForm;
use crate::contour::Point;
use crate::estimate::pose_from_view;
use crate::interpolate::FineView;
use crate::library::{Library, ViewRecord};
use crate::locate::Located;
use crate::math::{sin_cos, sqrt, wrap};

/// A view of the library, the similarity that takes its canonical pixels to the frame, and how
/// badly it fits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hypothesis {
    pub(super) view: usize,
    pub(super) similarity: Similarity,
    /// See [`super::fit::Known::disagreement`].
    pub(super) score: f64,
}

/// Turns by less than this, radians, are no other hypothesis.
const SAME_TURN: f64 = 0.2;

impl Hypothesis {
    /// Whether two hypotheses of one view are nearly the same; `radius` in pixel widths.
    pub(super) fn is_like(&self, other: &Self, radius: f64) -> bool {
        let (a, b) = (&self.similarity, &other.similarity);
        let turn = wrap(a.angle() - b.angle(), 2.0 * core::f64::consts::PI);
        let (x, y) = (a.offset[0] - b.offset[0], a.offset[1] - b.offset[1]);
        turn.max(-turn) < SAME_TURN && sqrt(x * x + y * y) < radius
    }

    /// The pose that the hypothesis stands for: that of a silhouette whose canonical form the
    /// similarity undoes.
    pub(super) fn locate(&self, camera: &Camera, library: &Library<'_>, plane: &Plane) -> Located {
        let info = library.info();
        let record = library.record(self.view);
        let [column, row] = plane.frame(self.similarity.offset);
        let scale = 1.0 / self.similarity.scale();
        let area = f64::from(info.canonical.area()) / (scale * scale * plane.aspect);
        let form = CanonicalForm {
            area_px: area as u64,
            centroid: Point::new(column, row),
            angle: self.similarity.angle(),
            scale,
            aspect: camera.aspect(),
            elongation: f64::from(record.elongation),
            clipped: false,
        };
        let grid = &info.grid;
        let (x, y) = grid.place(self.view);
        let inside = |at: usize, count: usize| count == 1 || (at > 0 && at + 1 < count);
        let fine = FineView {
            record,
            reversed: false,
            unmatched: 0,
            at_border: !(inside(x, grid.x.count) && inside(y, grid.y.count)),
        };
        Located {
            pose: pose_from_view(camera, info, &form, &fine),
            view: self.view,
            fine,
        }
    }
}

/// The similarity of a view `to` that leaves the object's reference point, its turn in the plane and
/// its distance as another similarity of a view `from` has them.
pub(super) fn transfer(from: &ViewRecord, to: &ViewRecord, similarity: &Similarity) -> Similarity {
    let z_rot = similarity.angle() - from.angle;
    // Frame pixels per pixel of the views' own camera.
    let growth = similarity.scale() * from.scale;
    let (sin, cos) = sin_cos(z_rot);
    let [a, b] = [0, 1].map(|k| growth * (to.offset[k] - from.offset[k]));
    let scale = growth / to.scale;
    let (sin_to, cos_to) = sin_cos(z_rot + to.angle);
    Similarity {
        factor: [scale * cos_to, scale * sin_to],
        offset: [
            similarity.offset[0] + cos * a - sin * b,
            similarity.offset[1] + sin * a + cos * b,
        ],
    }
}

/// Puts a hypothesis in its place by rising score; of those that `same` calls one the better
/// stays, and of too many the best.
pub(super) fn keep<const K: usize>(
    list: &mut heapless::Vec<Hypothesis, K>,
    new: Hypothesis,
    same: impl Fn(&Hypothesis) -> bool,
) {
    if let Some(place) = list.iter().position(same) {
        if list[place].score <= new.score {
            return;
        }
        list.remove(place);
    }
    let place = list.partition_point(|other| other.score <= new.score);
    if place == K {
        return;
    }
    if list.is_full() {
        list.pop();
    }
    // There is room now.
    let _ = list.insert(place, new);
}

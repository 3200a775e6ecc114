//! A view laid on the frame, and what it says of the pose.

use super::similarity::Similarity;
use super::smooth::Plane;
use crate::camera::Camera;
use crate::canonical::CanonicalForm;
use crate::image::contour::Point;
use crate::library::{Library, ViewRecord};
use crate::locate::estimate::pose_from_view;
use crate::locate::interpolate::FineView;
use crate::locate::whole::Located;
use crate::math::{sin_cos, sqrt, wrap};
use crate::shortlist;

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
        turn.abs() < SAME_TURN && sqrt(x * x + y * y) < radius
    }

    /// The pose that the hypothesis stands for: that of a silhouette whose canonical form the
    /// similarity undoes.
    pub(super) fn locate(&self, camera: &Camera, library: &Library<'_>, plane: &Plane) -> Located {
        let info = library.info();
        let record = library.record(self.view);
        let [column, row] = plane.frame(self.similarity.offset);
        let scale = 1.0 / self.similarity.scale();
        let form = CanonicalForm {
            // A pose follows from the scale alone.
            area_px: 0,
            centroid: Point::new(column, row),
            angle: self.similarity.angle(),
            scale,
            aspect: camera.aspect(),
            elongation: f64::from(record.elongation),
            clipped: false,
        };
        let fine = FineView {
            record,
            reversed: false,
            unmatched: 0,
            at_border: info.grid.is_at_border(self.view),
        };
        Located {
            pose: pose_from_view(camera, info, &form, &fine),
            view: self.view,
            fine,
            by_pieces: true,
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
        if list.get(place).is_some_and(|old| old.score <= new.score) {
            return;
        }
        shortlist::take_out(list, place);
    }
    shortlist::keep(list, new, |other| other.score);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canonical::CanonicalSpec;
    use crate::library::fake::plain_library;
    use crate::math::degrees;
    use proptest::prelude::*;

    fn record(scale: f64, angle: f64, offset: [f64; 2]) -> ViewRecord {
        ViewRecord {
            scale,
            angle,
            offset,
            ..ViewRecord::default()
        }
    }

    /// The equations of `estimate.rs` for what must not change: the image of the reference point,
    /// the turn in the plane, and the scale of the object.
    fn placed(record: &ViewRecord, similarity: &Similarity) -> ([f64; 2], f64, f64) {
        let z_rot = similarity.angle() - record.angle;
        let growth = similarity.scale() * record.scale;
        let (sin, cos) = libm::sincos(z_rot);
        let [a, b] = record.offset.map(|v| v * growth);
        let image = [
            similarity.offset[0] - (cos * a - sin * b),
            similarity.offset[1] - (sin * a + cos * b),
        ];
        (image, z_rot, growth)
    }

    properties! {
        #[test]
        fn another_view_leaves_the_object_where_it_is(
            scales in (0.5..2.0f64, 0.5..2.0f64), angles in (-1.5..1.5f64, -1.5..1.5f64),
            offset in (-20.0..20.0f64, -20.0..20.0f64), to in (-20.0..20.0f64, -20.0..20.0f64),
            factor in (0.3..2.0f64, -2.0..2.0f64), shift in (-300.0..300.0f64, -300.0..300.0f64)
        ) {
            let from = record(scales.0, angles.0, [offset.0, offset.1]);
            let to = record(scales.1, angles.1, [to.0, to.1]);
            let similarity = Similarity {
                factor: [factor.0, factor.1],
                offset: [shift.0, shift.1],
            };
            let moved = transfer(&from, &to, &similarity);
            let (a, b) = (placed(&from, &similarity), placed(&to, &moved));
            for k in 0..2 {
                prop_assert!((a.0[k] - b.0[k]).abs() < 1e-9);
            }
            let turn = wrap(a.1 - b.1, 2.0 * core::f64::consts::PI);
            prop_assert!(degrees(turn).abs() < 1e-9 && (a.2 - b.2).abs() < 1e-9);
            let back = transfer(&to, &from, &moved);
            prop_assert!((back.offset[0] - shift.0).abs() < 1e-9);
            prop_assert!((back.factor[1] - factor.1).abs() < 1e-9);
        }
    }

    #[test]
    fn the_best_are_kept_and_each_once() {
        let hypothesis = |view, score| Hypothesis {
            view,
            score,
            ..Hypothesis::default()
        };
        let mut list: heapless::Vec<Hypothesis, 2> = heapless::Vec::new();
        for (view, score) in [(1, 0.5), (1, 0.4), (2, 0.9), (1, 0.6), (3, 0.3), (4, 0.8)] {
            let new = hypothesis(view, score);
            keep(&mut list, new, |other| other.view == new.view);
        }
        let kept: std::vec::Vec<_> = list.iter().map(|h| (h.view, h.score)).collect();
        assert_eq!(kept, [(3, 0.3), (1, 0.4)]);
    }

    #[test]
    fn views_at_the_border_of_a_grid_are_told_where_there_are_others_beside_them() {
        let spec = CanonicalSpec::new(64, 900).expect("possible");
        let camera = Camera::new(640, 480, [900.0; 2], [320.0, 240.0]).expect("valid");
        let plane = Plane::new(640, 480, camera.aspect());
        let sizes = (1..5).flat_map(|columns| (1..5).map(move |rows| (columns, rows)));
        for (columns, rows) in sizes {
            let views = std::vec![std::vec![1; spec.words_needed()]; columns * rows];
            let bytes = plain_library(&views, columns, spec);
            let library = Library::open(&bytes).expect("valid");
            for view in 0..columns * rows {
                let hypothesis = Hypothesis {
                    view,
                    similarity: Similarity {
                        factor: [1.0, 0.0],
                        offset: [0.0; 2],
                    },
                    score: 0.0,
                };
                let located = hypothesis.locate(&camera, &library, &plane);
                assert_eq!((located.view, located.by_pieces), (view, true));
                let (x, y) = (view % columns, view / columns);
                let at_end = |at: usize, count: usize| count > 1 && (at == 0 || at == count - 1);
                let at_border = at_end(x, columns) || at_end(y, rows);
                assert_eq!(located.fine.at_border, at_border, "{columns} {rows} {view}");
            }
        }
    }

    /// The library's views are of the reference point itself, a thousand mm away, for a focal length of 100 pixels.
    #[test]
    fn a_hypothesis_stands_for_a_pose_by_similar_triangles() {
        let spec = CanonicalSpec::new(64, 900).expect("possible");
        let bytes = plain_library(&[std::vec![1; spec.words_needed()]], 1, spec);
        let library = Library::open(&bytes).expect("valid");
        let camera = Camera::new(640, 480, [900.0; 2], [330.0, 236.0]).expect("valid");
        let plane = Plane::new(640, 480, camera.aspect());
        for (scale, turn, offset) in [
            (9.0, 0.0, [10.0, 4.0]),
            (18.0, 0.7, [10.0, 4.0]),
            (6.0, -2.0, [-80.0, 4.0]),
            (9.0, 1.0, [10.0, 124.0]),
        ] {
            let (sin, cos) = libm::sincos(turn);
            let similarity = Similarity {
                factor: [scale * cos, scale * sin],
                offset,
            };
            let hypothesis = Hypothesis {
                similarity,
                ..Hypothesis::default()
            };
            let Located { pose, .. } = hypothesis.locate(&camera, &library, &plane);
            // To the right of the principal point and above it, focal lengths.
            let ray = [(offset[0] - 10.0) / 900.0, (offset[1] - 4.0) / 900.0];
            let stretch = libm::pow(1.0 + ray[0] * ray[0] + ray[1] * ray[1], 0.25);
            // As large as in the library where a view's pixel, of a hundredth of a radian, is nine of the camera's.
            let depth = 1000.0 * 9.0 / scale * stretch;
            let expected = [depth * ray[0], depth * ray[1], -depth];
            for (k, expected) in expected.into_iter().enumerate() {
                let off = pose.translation[k] - expected;
                assert!(off.abs() < 1e-6, "{scale} {offset:?}: {off} along axis {k}");
            }
        }
    }

    #[test]
    fn near_hypotheses_are_alike_across_the_turn_of_pi() {
        let at = |radians: f64, x: f64| Hypothesis {
            similarity: Similarity {
                factor: [libm::cos(radians), libm::sin(radians)],
                offset: [x, 0.0],
            },
            ..Hypothesis::default()
        };
        assert!(at(3.1, 0.0).is_like(&at(-3.1, 9.0), 10.0));
        assert!(!at(3.1, 0.0).is_like(&at(-3.1, 11.0), 10.0));
        assert!(!at(3.1, 0.0).is_like(&at(2.8, 0.0), 10.0));
    }
}

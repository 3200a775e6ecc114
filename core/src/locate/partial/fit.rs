//! How well a view, laid on the frame by a similarity, explains what is known of an outline, and
//! the similarity near by that explains it best.

use super::field::Field;
use super::outline::OutlinePoints;
use super::similarity::{Similarity, times};
use super::smooth::Plane;
use super::units::{KNOWN_SPACING, Units};
use crate::image::silhouette::Silhouette;
use crate::math::{sin_cos, solve_spd, sqrt};

/// What is known of an outline, ready to be compared with views.
pub(super) struct Known<'a> {
    silhouette: &'a Silhouette<'a>,
    pub(super) plane: Plane,
    outline: OutlinePoints<'a>,
    field: Field<'a>,
    /// A place whose nearest point is this far along the outline, pixel widths, lies past an end of it.
    past_end: f64,
}

/// A sample of a view near the known outline.
struct Pair {
    /// From the centre of the view, rotated and scaled but not shifted.
    arm: [f64; 2],
    normal: [f64; 2],
    /// Distance along the outline's normal.
    along: f64,
    distance: f64,
}

/// What a view's sample meets in the frame.
enum Meeting {
    /// Beyond the frame or in unknown pixels.
    Unknown,
    /// Nothing near.
    Nothing,
    /// The outline.
    Outline(Pair),
}

/// Cosine of the largest angle between the normals of outlines that may be one.
const ALIKE: f64 = 0.5;

/// Distance along an outline at which its nearest point is no longer beside a place, in spacings.
const PAST_END: f64 = 4.0;

impl<'a> Known<'a> {
    /// `cells` is working memory of the [`Field`].
    pub(super) fn new(
        silhouette: &'a Silhouette<'a>,
        plane: Plane,
        outline: OutlinePoints<'a>,
        units: &Units,
        cells: &'a mut [u16],
    ) -> Self {
        Self {
            silhouette,
            plane,
            field: Field::new(outline.points, units.wide, cells),
            outline,
            past_end: PAST_END * KNOWN_SPACING * units.pixel,
        }
    }

    fn is_known(&self, point: [f64; 2]) -> bool {
        let [column, row] = self.plane.frame(point);
        // A negative number would be cast to 0.
        column >= 0.0 && row >= 0.0 && self.silhouette.is_known(column as usize, row as usize)
    }

    fn meet(&self, similarity: &Similarity, at: [f32; 2], normal: [f32; 2]) -> Meeting {
        let arm = times(similarity.factor, at.map(f64::from));
        let place = [arm[0] + similarity.offset[0], arm[1] + similarity.offset[1]];
        if !self.is_known(place) {
            return Meeting::Unknown;
        }
        let number = self.field.nearest(place);
        let Some(point) = number.and_then(|number| self.outline.points.get(number)) else {
            return Meeting::Nothing;
        };
        let own = times(similarity.factor, normal.map(f64::from));
        let normal = point.normal.map(f64::from);
        let cosine = own[0] * normal[0] + own[1] * normal[1];
        if cosine < ALIKE * similarity.scale() {
            return Meeting::Nothing;
        }
        let away = [0, 1].map(|k| place[k] - f64::from(point.at[k]));
        Meeting::Outline(Pair {
            arm,
            normal,
            along: away[0] * normal[0] + away[1] * normal[1],
            distance: sqrt(away[0] * away[0] + away[1] * away[1]),
        })
    }

    /// Disagreement between a view and the known outline: the length of the view's outline that lies in
    /// known pixels but not on the outline, and the length of the known outline that is not
    /// covered, as a fraction of the latter's length. 0 where they agree; distances count by their
    /// square, up to `cap` pixel widths. Only one point in `every` is compared. Infinite where it is certain to exceed `limit`.
    pub(super) fn disagreement(
        &self,
        view: &OutlinePoints<'_>,
        similarity: &Similarity,
        cap: f64,
        every: usize,
        limit: f64,
    ) -> f64 {
        // With some to spare for rounding.
        let most = limit * self.outline.length * (1.0 + 1e-9);
        let scale = similarity.scale();
        let (mut wrong, mut right) = (0.0, 0.0);
        for piece in view.pieces() {
            let length = piece.step * scale * every as f64;
            for point in piece.points.iter().step_by(every) {
                let off = match self.meet(similarity, point.at, point.normal) {
                    Meeting::Unknown => continue,
                    Meeting::Nothing => 1.0,
                    Meeting::Outline(pair) => {
                        let off = self.distance(&pair) / cap;
                        (off * off).min(1.0)
                    }
                };
                wrong += off * length;
                if wrong > most {
                    return f64::INFINITY;
                }
                right += (1.0 - off) * length;
            }
        }
        (wrong + (self.outline.length - right).max(0.0)) / self.outline.length
    }

    /// Distance from the outline: along the normal, unless that leads past an end.
    fn distance(&self, pair: &Pair) -> f64 {
        let along = pair.along.abs();
        let across = pair.distance * pair.distance - along * along;
        if across > self.past_end * self.past_end {
            pair.distance
        } else {
            along
        }
    }

    /// One step of robust Gauss-Newton on the distances along the outline's normals (Tukey's
    /// weights, nothing beyond `cap`); `None` where too little is near.
    pub(super) fn improve(
        &self,
        view: &OutlinePoints<'_>,
        similarity: &Similarity,
        cap: f64,
    ) -> Option<Similarity> {
        let mut normal = [[0.0; 4]; 4];
        let mut right = [0.0; 4];
        let mut used = 0;
        for point in view.points {
            let Meeting::Outline(pair) = self.meet(similarity, point.at, point.normal) else {
                continue;
            };
            let off = self.distance(&pair) / cap;
            if off >= 1.0 {
                continue;
            }
            let weight = (1.0 - off * off) * (1.0 - off * off);
            let slope = pair.slope();
            for (row, &a) in slope.iter().enumerate() {
                right[row] -= weight * a * pair.along;
                for (column, &b) in slope.iter().enumerate() {
                    normal[row][column] += weight * a * b;
                }
            }
            used += 1;
        }
        for (k, row) in normal.iter_mut().enumerate() {
            row[k] *= 1.0 + DAMPING;
        }
        let step = solve_spd(normal, right).filter(|_| used >= LEAST_USED)?;
        Some(moved(similarity, step))
    }
}

/// Samples that must be near the outline.
const LEAST_USED: usize = 8;
/// Keeps the equations solvable where the outline leaves a motion open: a circle's turn.
const DAMPING: f64 = 1e-3;
/// Largest growth and turn (radians) of one step.
const LARGEST_GROWTH: f64 = 0.2;
const LARGEST_TURN: f64 = 0.3;

impl Pair {
    /// How fast the sample moves along the outline's normal: with a shift to the right and
    /// upwards, with growth about the view's centre, with a turn about it.
    fn slope(&self) -> [f64; 4] {
        let ([x, y], [u, v]) = (self.normal, self.arm);
        [x, y, x * u + y * v, y * u - x * v]
    }
}

fn moved(similarity: &Similarity, [x, y, grow, turn]: [f64; 4]) -> Similarity {
    let (sin, cos) = sin_cos(turn.clamp(-LARGEST_TURN, LARGEST_TURN));
    let grow = 1.0 + grow.clamp(-LARGEST_GROWTH, LARGEST_GROWTH);
    Similarity {
        factor: times(similarity.factor, [grow * cos, grow * sin]),
        offset: [similarity.offset[0] + x, similarity.offset[1] + y],
    }
}

#[cfg(test)]
mod tests {
    use super::super::outline::{OutlinePoint, Sampling};
    use super::super::trace::{PixelSide, trace};
    use super::*;
    use crate::camera::Camera;
    use crate::image::contour::{Outline, Point};
    use crate::image::mask::{Mask, MaskMut, words_needed};
    use proptest::prelude::*;

    const SIDE: usize = 256;
    const UNITS: Units = Units {
        focal: 1.0,
        spacing: 6.0,
        view_reach: 2,
        pixel: 1.0,
        wide: 12.0,
        narrow: 5.0,
        apart: 15.0,
    };
    const NOTHING: Similarity = Similarity {
        factor: [1.0, 0.0],
        offset: [0.0, 0.0],
    };

    /// A shape without symmetry.
    fn words() -> std::vec::Vec<u32> {
        let corners = [
            (40.0, 60.0),
            (150.0, 40.0),
            (220.0, 90.0),
            (140.0, 110.0),
            (170.0, 210.0),
            (60.0, 180.0),
        ];
        let points = corners.map(|(column, row)| Point::new(column, row));
        let outline = Outline::new(&points, SIDE, SIDE).expect("simple");
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        mask.fill_outline(&outline);
        words
    }

    fn plane() -> Plane {
        let camera = Camera::new(SIDE, SIDE, [900.0; 2], [128.0; 2]).expect("valid");
        Plane::new(SIDE, SIDE, camera.aspect())
    }

    fn points<'p>(
        silhouette: &Silhouette<'_>,
        spacing: f64,
        points: &'p mut [OutlinePoint],
    ) -> OutlinePoints<'p> {
        let mut memory = std::vec![0; words_needed(SIDE, SIDE)];
        let mut visited = MaskMut::new(&mut memory, SIDE, SIDE).expect("fits");
        let mut sides = [PixelSide::default(); 2000];
        let stretches = trace(silhouette, &mut visited, &mut sides, 20).expect("fits");
        let sampling = Sampling {
            plane: plane(),
            reach: 2,
            spacing,
        };
        OutlinePoints::new(&sides, &stretches, &sampling, points).expect("fits")
    }

    /// Calls `look` with the shape known but for `hidden`, and its whole outline as the view.
    fn with_known(hidden: &Mask<'_>, look: impl Fn(&Known<'_>, &OutlinePoints<'_>)) {
        with_known_of(&words(), hidden, look);
    }

    fn with_known_of(
        words: &[u32],
        hidden: &Mask<'_>,
        look: impl Fn(&Known<'_>, &OutlinePoints<'_>),
    ) {
        let mask = Mask::new(words, SIDE, SIDE).expect("valid");
        let silhouette = Silhouette::new(&mask, hidden).expect("one size");
        let (mut own, mut theirs) = (
            [OutlinePoint::default(); 500],
            [OutlinePoint::default(); 200],
        );
        let outline = points(&silhouette, 2.0, &mut own);
        let view = points(&Silhouette::from(&mask), 6.0, &mut theirs);
        let mut cells = std::vec![0; super::super::field::FIELD_CELLS];
        let known = Known::new(&silhouette, plane(), outline, &UNITS, &mut cells);
        look(&known, &view);
    }

    /// Everything to the right of a column is hidden.
    fn hidden(from: usize) -> std::vec::Vec<u32> {
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        for row in 0..SIDE {
            mask.fill_span(row, from as i64, SIDE as i64);
        }
        words
    }

    #[test]
    fn a_view_agrees_with_what_is_known_of_itself_and_not_with_less_or_more() {
        for from in [SIDE, 160] {
            let hidden = hidden(from);
            let hidden = Mask::new(&hidden, SIDE, SIDE).expect("valid");
            with_known(&hidden, |known, view| {
                let own = known.disagreement(view, &NOTHING, 5.0, 1, f64::INFINITY);
                assert!(own < 0.05, "{own} of what is left of {from}");
                let away = Similarity {
                    offset: [300.0, 0.0],
                    ..NOTHING
                };
                assert!(
                    (known.disagreement(view, &away, 5.0, 1, f64::INFINITY) - 1.0).abs() < 1e-9
                );
                for offset in [[3.0, 0.0], [0.0, -3.0]] {
                    let moved = Similarity { offset, ..NOTHING };
                    let off = known.disagreement(view, &moved, 5.0, 1, f64::INFINITY);
                    // What stays below a limit is what it is without one.
                    for limit in [0.5 * off, off, 2.0 * off] {
                        let within = known.disagreement(view, &moved, 5.0, 1, limit);
                        assert!(within == off || (limit < off && within == f64::INFINITY));
                    }
                    assert!(off > own + 0.1, "{off} at {offset:?}");
                }
            });
        }
    }

    #[test]
    fn steps_lead_back_to_where_the_view_belongs() {
        for from in [SIDE, 160] {
            let hidden = hidden(from);
            let hidden = Mask::new(&hidden, SIDE, SIDE).expect("valid");
            with_known(&hidden, |known, view| {
                let mut similarity = moved(&NOTHING, [6.0, -5.0, 0.05, 0.06]);
                for cap in [16.0, 16.0, 12.0, 8.0, 5.0, 5.0, 5.0] {
                    similarity = known.improve(view, &similarity, cap).expect("near");
                }
                let [x, y] = similarity.offset;
                assert!(x.abs() < 0.3 && y.abs() < 0.3, "({x}, {y}) from {from}");
                assert!((similarity.scale() - 1.0).abs() < 0.004, "{similarity:?}");
                assert!(similarity.angle().abs() < 0.004, "{similarity:?}");
                let away = Similarity {
                    offset: [300.0, 0.0],
                    ..NOTHING
                };
                assert_eq!(known.improve(view, &away, 16.0), None);
            });
        }
    }

    #[test]
    fn a_place_is_as_far_off_as_along_the_normal_unless_that_leads_past_an_end() {
        let hidden = hidden(SIDE);
        let hidden = Mask::new(&hidden, SIDE, SIDE).expect("valid");
        with_known(&hidden, |known, _| {
            assert_eq!(known.past_end, 8.0);
            for along in [-3.0, 0.0, 0.5, 12.0] {
                for (across, is_past) in [(0.0, false), (7.999, false), (8.001, true), (30.0, true)]
                {
                    let distance = libm::hypot(along, across);
                    let pair = Pair {
                        arm: [0.0; 2],
                        normal: [0.0, 1.0],
                        along,
                        distance,
                    };
                    let expected = if is_past { distance } else { along.abs() };
                    assert_eq!(known.distance(&pair), expected, "{along} {across}");
                }
            }
        });
    }

    properties! {
        /// A step that is too large is cut, each of growth and turn by itself.
        #[test]
        fn a_similarity_grows_and_turns_and_shifts_by_what_it_is_moved(
            factor in (0.2..3.0f64, -1.5..1.5f64),
            offset in proptest::array::uniform2(-300.0..300.0f64),
            shift in proptest::array::uniform2(-20.0..20.0f64),
            grow in -0.5..0.5f64,
            turn in -0.8..0.8f64,
        ) {
            let before = Similarity { factor: [factor.0, factor.1], offset };
            let after = moved(&before, [shift[0], shift[1], grow, turn]);
            let cut = |value: f64, most: f64| value.max(-most).min(most);
            let growth = after.scale() / before.scale();
            prop_assert!((growth - 1.0 - cut(grow, 0.2)).abs() < 1e-12);
            let turned = crate::math::wrap(after.angle() - before.angle(), core::f64::consts::TAU);
            prop_assert!((turned - cut(turn, 0.3)).abs() < 1e-12);
            prop_assert_eq!(after.offset, [offset[0] + shift[0], offset[1] + shift[1]]);
        }

        /// How fast a point moves along a normal, by moving it a little both ways.
        #[test]
        fn slopes_are_those_of_what_is_moved(
            factor in (0.2..3.0f64, -1.5..1.5f64),
            point in proptest::array::uniform2(-100.0..100.0f64),
            direction in -4.0..4.0f64,
        ) {
            let similarity = Similarity { factor: [factor.0, factor.1], offset: [5.0, -7.0] };
            let (sin, cos) = libm::sincos(direction);
            let normal = [cos, sin];
            let pair = Pair { arm: times(similarity.factor, point), normal, along: 0.0, distance: 0.0 };
            for (k, slope) in pair.slope().into_iter().enumerate() {
                let along = |step: f64| {
                    let mut steps = [0.0; 4];
                    steps[k] = step;
                    let moved = moved(&similarity, steps);
                    let arm = times(moved.factor, point);
                    (0..2).map(|k| (arm[k] + moved.offset[k]) * normal[k]).sum::<f64>()
                };
                let difference = (along(1e-4) - along(-1e-4)) / 2e-4;
                prop_assert!((difference - slope).abs() < 1e-5, "{} {} {}", k, difference, slope);
            }
        }
    }

    /// Of a straight edge all samples of a view that lies beside it are as far off: what of it counts as wrong leaves as much of
    /// the known outline uncovered.
    #[test]
    fn beside_a_straight_edge_disagreement_is_twice_the_square_of_the_distance() {
        let hidden_words = hidden(SIDE);
        let nothing = Mask::new(&hidden_words, SIDE, SIDE).expect("valid");
        // What is hidden from a column on is a mask that is set there.
        let half = hidden(128);
        with_known_of(&half, &nothing, |known, view| {
            let off = |shift: [f64; 2], every: usize| {
                let offset = shift;
                let moved = Similarity { offset, ..NOTHING };
                known.disagreement(view, &moved, 5.0, every, f64::INFINITY)
            };
            for every in [1, 2] {
                for distance in [0.0, 1.0, -2.0, 3.5, -4.9] {
                    let expected = 2.0 * distance * distance / 25.0;
                    let found = off([distance, 0.0], every);
                    assert!((found - expected).abs() < 0.06, "{distance}: {found}");
                }
                // Farther than counts, and where nothing is near.
                for distance in [5.5, -11.0, 40.0] {
                    let found = off([distance, 0.0], every);
                    assert!((found - 2.0).abs() < 0.06, "{distance}: {found}");
                }
                // A quarter of it beyond the frame tells nothing, and leaves a quarter uncovered.
                let found = off([0.0, 64.0], every);
                assert!((found - 0.25).abs() < 0.06, "{found}");
            }
            // Turned by half it runs along the edge, its normals the other way.
            let about = Similarity {
                factor: [-1.0, 0.0],
                offset: [0.0; 2],
            };
            let found = known.disagreement(view, &about, 5.0, 1, f64::INFINITY);
            assert!((found - 2.0).abs() < 0.06, "{found}");
        });
    }
}

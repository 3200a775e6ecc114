//! How well a view, laid on the frame by a similarity, explains what is known of an outline, and
//! the similarity near by that explains it best.

use super::field::Field;
use super::outline::OutlinePoints;
use super::similarity::{Similarity, times};
use super::smooth::Plane;
use super::units::{KNOWN_SPACING, Units};
use crate::math::{sin_cos, solve_spd, sqrt};
use crate::silhouette::Silhouette;

/// What is known of an outline, ready to be compared with views.
pub(super) struct Known<'a> {
    silhouette: &'a Silhouette<'a>,
    pub(super) plane: Plane,
    outline: OutlinePoints<'a>,
    field: Field<'a>,
    /// A place so far along the outline from the nearest point, pixel widths, lies past an end of it.
    past_end: f64,
}

/// A sample of a view near the known outline.
struct Pair {
    /// From the centre of the view, turned and scaled but not shifted.
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
    /// `cells` is lent for a [`Field`].
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
    /// covered, as a share of the latter's length. 0 where they agree; distances count by their
    /// square, up to `cap` pixel widths. Only one point in `every` is looked at.
    pub(super) fn disagreement(
        &self,
        view: &OutlinePoints<'_>,
        similarity: &Similarity,
        cap: f64,
        every: usize,
    ) -> f64 {
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
                right += (1.0 - off) * length;
            }
        }
        (wrong + (self.outline.length - right).max(0.0)) / self.outline.length
    }

    /// Distance from the outline: along the normal, unless that leads past an end.
    fn distance(&self, pair: &Pair) -> f64 {
        let along = pair.along.max(-pair.along);
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
            let [n, arm] = [pair.normal, pair.arm];
            let slope = [
                n[0],
                n[1],
                n[0] * arm[0] + n[1] * arm[1],
                n[1] * arm[0] - n[0] * arm[1],
            ];
            for (row, &a) in slope.iter().enumerate() {
                right[row] -= weight * a * pair.along;
                for (column, &b) in slope.iter().enumerate() {
                    normal[row][column] += weight * a * b;
                }
            }
            used += 1;
        }
        if used < 8 {
            return None;
        }
        for (k, row) in normal.iter_mut().enumerate() {
            row[k] *= 1.0 + 1e-3;
            row[k] += 1e-6;
        }
        let [x, y, grow, turn] = solve_spd(normal, right)?;
        let (sin, cos) = sin_cos(turn.clamp(-0.3, 0.3));
        let grow = 1.0 + grow.clamp(-0.2, 0.2);
        Some(Similarity {
            factor: times(similarity.factor, [grow * cos, grow * sin]),
            offset: [similarity.offset[0] + x, similarity.offset[1] + y],
        })
    }
}

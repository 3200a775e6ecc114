//! The centre of rotation on the plate over several frames: where the condyle lines meet.

use crate::joint::shared::ERRORS;
use crate::math::{atan2, degrees, sqrt, wrap};

/// Below this range of directions, degrees, the lines hardly cross, and where they meet says nothing.
pub const ILL_CONDITIONED_DEG: f64 = 5.0;

/// Steps of the fit; it converges in three or four.
const STEPS: usize = 12;

/// A condyle line: from the medial to the lateral lowest point, each as anterior and medial place on the plate, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CondyleLine {
    /// The medial lowest point.
    pub medial: [f64; 2],
    /// The lateral lowest point.
    pub lateral: [f64; 2],
}

/// A centre of rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pivot {
    /// In front of the middle of the plate, mm.
    pub anterior_mm: f64,
    /// To medial of the middle of the plate, mm.
    pub medial_mm: f64,
    /// One standard deviation of either, mm, from how far the lines miss each other, which are taken to err independently: lines
    /// of neighbouring frames often do not, and it is then too small.
    pub deviation_mm: [f64; 2],
    /// Range of the lines' directions, degrees: of lines that are spread evenly over it and as far in all, less what the errors
    /// of the lowest points add. The largest less the smallest direction would be mostly error where there is little rotation.
    pub rotation_deg: f64,
    /// How many times less certain the worst direction is than the best one.
    pub condition: f64,
    /// Lines.
    pub n: usize,
}

impl Pivot {
    /// Whether the lines hardly cross ([`ILL_CONDITIONED_DEG`]).
    #[must_use]
    pub fn is_ill_conditioned(&self) -> bool {
        // What is not a number is not known either.
        !(self.rotation_deg >= ILL_CONDITIONED_DEG
            && self.deviation_mm.iter().all(|d| d.is_finite()))
    }
}

/// The centre of lines that move with errors which all frames have alike ([`super::shared`]): of [`pivot`], and as much less certain
/// as it moves with one standard deviation of each. `lines`: as they were found (`None`), and as an error moves all of them.
pub fn pivot_of_film<L>(lines: impl Fn(Option<usize>) -> L) -> Option<Pivot>
where
    L: Iterator<Item = CondyleLine> + Clone,
{
    let mut found = pivot(lines(None))?;
    for error in 0..ERRORS {
        let moved = pivot(lines(Some(error)))?;
        let by = [
            moved.anterior_mm - found.anterior_mm,
            moved.medial_mm - found.medial_mm,
        ];
        for (deviation, by) in found.deviation_mm.iter_mut().zip(by) {
            *deviation = sqrt(*deviation * *deviation + by * by);
        }
    }
    Some(found)
}

/// The point that the lines miss least: least squares of the distances, each in units of its own error. Two lowest points err
/// alike, so a line errs less between them than beyond them; without these units the point would be drawn
/// to the middle of the lines where they cross at small angles.
///
/// That is the centre by its published definition. Where the condyles lie beside the axis about which the knee turns, the lines
/// do not pass through that axis, and meet where they come nearest to it.
///
/// `None` for fewer than three lines or lines without length, or where all have one direction.
#[must_use]
pub fn pivot(lines: impl Iterator<Item = CondyleLine> + Clone) -> Option<Pivot> {
    let n = lines.clone().count();
    if n < 3 {
        return None;
    }
    let mut place = Sums::of(lines.clone(), Residual::plain).solve()?;
    for _ in 0..STEPS {
        let sums = Sums::of(lines.clone(), |line| Residual::in_units(line, place));
        let step = sums.solve()?;
        place = [place[0] + step[0], place[1] + step[1]];
    }
    let sums = Sums::of(lines.clone(), |line| Residual::in_units(line, place));
    let variance = sums.squares / (n - 2) as f64;
    let [[a, b], [_, d]] = sums.normal;
    let determinant = a * d - b * b;
    let (mean, half) = ((a + d) / 2.0, sqrt((a - d) * (a - d) / 4.0 + b * b));
    Some(Pivot {
        anterior_mm: place[0],
        medial_mm: place[1],
        deviation_mm: [d, a].map(|other| sqrt(variance * other / determinant)),
        rotation_deg: range_deg(lines, variance),
        condition: sqrt((mean + half) / (mean - half)),
        n,
    })
}

/// See [`Pivot::rotation_deg`]; `variance` is that of a lowest point's error, square mm.
fn range_deg(lines: impl Iterator<Item = CondyleLine>, variance: f64) -> f64 {
    let mut first = None;
    let (mut n, mut mean, mut squares, mut errors) = (0.0, 0.0, 0.0, 0.0);
    for line in lines {
        let ([across, along], _, length) = frame(&line);
        let direction = atan2(across, along);
        let turned = wrap(
            direction - *first.get_or_insert(direction),
            core::f64::consts::TAU,
        );
        n += 1.0;
        let off = turned - mean;
        mean += off / n;
        squares += off * (turned - mean);
        errors += 2.0 * variance / (length * length);
    }
    let spread = (squares - errors).max(0.0) / n;
    degrees(sqrt(12.0 * spread * (n - 1.0) / (n + 1.0)))
}

/// How far a line misses a place, and how that changes with the place.
struct Residual {
    value: f64,
    slope: [f64; 2],
}

impl Residual {
    /// The distance of the middle of the plate.
    fn plain(line: &CondyleLine) -> Self {
        let (normal, _, length) = frame(line);
        let offset = (0..2).map(|k| normal[k] * line.medial[k]).sum::<f64>();
        Self {
            value: -offset / length,
            slope: normal.map(|x| x / length),
        }
    }

    /// The distance in units of its error: for errors of one unit in both lowest points that of a place at the
    /// fraction `t` between them is `sqrt((1 - t)^2 + t^2)`.
    fn in_units(line: &CondyleLine, place: [f64; 2]) -> Self {
        let (normal, along, length) = frame(line);
        let from: [f64; 2] = core::array::from_fn(|k| place[k] - line.medial[k]);
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let distance = dot(normal, from) / length;
        let t = dot(along, from) / (length * length);
        let unit = sqrt((1.0 - t) * (1.0 - t) + t * t);
        let unit_by_t = (2.0 * t - 1.0) / unit;
        let slope = core::array::from_fn(|k| {
            let t_by_place = along[k] / (length * length);
            (normal[k] / length - distance / unit * unit_by_t * t_by_place) / unit
        });
        Self {
            value: distance / unit,
            slope,
        }
    }
}

/// The direction across a line and along it, both as long as the line, and that length.
fn frame(CondyleLine { medial, lateral }: &CondyleLine) -> ([f64; 2], [f64; 2], f64) {
    let along = [lateral[0] - medial[0], lateral[1] - medial[1]];
    let length = sqrt(along[0] * along[0] + along[1] * along[1]);
    ([-along[1], along[0]], along, length)
}

/// Normal equations.
#[derive(Default)]
struct Sums {
    normal: [[f64; 2]; 2],
    right: [f64; 2],
    squares: f64,
}

impl Sums {
    fn of(
        lines: impl Iterator<Item = CondyleLine>,
        residual: impl Fn(&CondyleLine) -> Residual,
    ) -> Self {
        let mut sums = Self::default();
        for line in lines {
            let Residual { value, slope } = residual(&line);
            for row in 0..2 {
                sums.right[row] -= slope[row] * value;
                for column in 0..2 {
                    sums.normal[row][column] += slope[row] * slope[column];
                }
            }
            sums.squares += value * value;
        }
        sums
    }

    fn solve(&self) -> Option<[f64; 2]> {
        crate::math::solve_spd(self.normal, self.right)
    }
}

#[cfg(test)]
mod tests;

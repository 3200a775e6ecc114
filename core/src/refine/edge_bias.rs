//! What is not known of a film moves all edges alike, which leaves no residual: how far that may move a pose.
//!
//! Each constant is changed by its standard deviation, edges are looked for again, and the pose follows to first order,
//! `(sum l J J')^-1 sum l J dr`. What physics leaves out, and all of it where no film is known, is a common distance between
//! edges and outline.

use super::border::{BorderPixel, NormalReading};
use super::common_distance::{CommonDistance, Errors, times};
use super::edge;
use super::loss::Loss;
use super::motion::Motion;
use super::stages::Stage;
use super::view::{CameraView, ImageTarget, Target};
use crate::film::edge::EdgeFilter;
use crate::film::model::CONSTANTS;
use crate::film::{FilmModel, PathLine};
use crate::image::display::QuickCurve;
use crate::image::silhouette::CommonOffset;
use crate::math::{inverse_spd, sqrt};
use crate::pose::covariance::{Matrix6, PoseCovariance, congruence};

/// Standard deviation of the common distance, pixels, where the film is known and before its residuals say anything of it. Depths on
/// synthetic films of nine kinds are off by 0.10 px of outline (femur) and 0.07 px (tray); edges enhanced, or cement beside them, move
/// the femur's by 0.4 to 0.5 px. A judgement, not a fit.
const KNOWN_PX: f64 = 0.1;
/// Edges that move farther than this have jumped to others, pixels.
const JUMP: f64 = 1.0;

/// Ways in which a mask lies off by where its outline faces: shifted to the right, downwards; wider along one line than across, along its diagonal.
const UNEVEN: usize = 4;

/// How far the outline at a sample lies off by each of them, where it is one at most.
fn uneven(sample: &BorderPixel) -> [f32; UNEVEN] {
    let [right, down] = sample.normal();
    [right, down, right * right - down * down, 2.0 * right * down]
}

/// `sum l J dr` of a mask by `px` of each way to be uneven.
fn uneven_pulls((border, motion): (&[BorderPixel], &Motion), px: f64) -> [[f64; 6]; UNEVEN] {
    let mut whole = [[0.0; 6]; UNEVEN];
    for block in border.chunks(BLOCK) {
        let mut pulls = [[0.0; 6]; UNEVEN];
        for sample in block.iter().filter(|sample| sample.has_residual()) {
            let jacobian = motion.jacobian(sample);
            for (pull, part) in pulls.iter_mut().zip(uneven(sample)) {
                let moved = sample.weight * part * px as f32;
                for (sum, a) in pull.iter_mut().zip(&jacobian) {
                    *sum += moved * a;
                }
            }
        }
        add_to(&mut whole, &pulls);
    }
    whole
}

/// Sums over the samples of all views.
#[derive(Default)]
pub(super) struct EdgeBias {
    information: Matrix6,
    /// Covariance of the pull of all ways in which masks are uneven, each mask by itself: one may be shifted to the right and
    /// another to the left.
    uneven: Matrix6,
    /// By one standard deviation of each constant, and by the common distance.
    pulls: [[f64; 6]; CONSTANTS + 1],
    correlation: [[f64; CONSTANTS]; CONSTANTS],
    any: bool,
    /// What residuals on known films say of the common distance.
    common: CommonDistance,
    /// Whether there are other residuals.
    others: bool,
}

/// Samples that are summed in 32 bits before their sum is added in 64.
const BLOCK: usize = 64;

/// Sums over a few samples.
#[derive(Default)]
struct Block {
    information: [[f32; 6]; 6],
    pulls: [[f32; 6]; CONSTANTS + 1],
}

impl Block {
    fn add(&mut self, sample: &BorderPixel, motion: &Motion, moved: [f32; CONSTANTS + 1]) {
        let jacobian = motion.jacobian(sample);
        for (pull, moved) in self.pulls.iter_mut().zip(moved) {
            for (sum, a) in pull.iter_mut().zip(&jacobian) {
                *sum += sample.weight * a * moved;
            }
        }
        for (row, a) in self.information.iter_mut().zip(&jacobian) {
            let a = sample.weight * a;
            for (sum, &b) in row.iter_mut().zip(&jacobian) {
                *sum += a * b;
            }
        }
    }
}

fn add_to<const ROWS: usize>(sums: &mut [[f64; 6]; ROWS], more: &[[f32; 6]; ROWS]) {
    let more = more.as_flattened().iter();
    for (sum, &more) in sums.as_flattened_mut().iter_mut().zip(more) {
        *sum += f64::from(more);
    }
}

impl EdgeBias {
    /// Adds the samples of a view, with the lines across them where edges were compared with drawn ones.
    pub(super) fn add(
        &mut self,
        (view, motion): (&CameraView<'_>, &Motion),
        stage: &Stage,
        border: &[BorderPixel],
        lines: &[PathLine],
    ) {
        let film = view.target.film().filter(|_| stage.drawn);
        self.others |= film.is_none();
        match (&view.target, film) {
            (Target::Silhouette(silhouette), _) => {
                let common = silhouette.common_offset().deviation_px;
                self.add_moved((border, motion), common, |_, _| [0.0; CONSTANTS]);
                self.add_uneven((border, motion), silhouette.uneven_px());
            }
            (Target::Image(_), None) => {
                let common = CommonOffset::ON_EDGES.deviation_px;
                self.add_moved((border, motion), common, |_, _| [0.0; CONSTANTS]);
            }
            (Target::Image(image), Some(film)) => {
                self.add_by_film((image, film), stage, (border, motion), lines);
            }
        }
    }

    /// By itself, because ready curves take up a part of the stack that silhouettes need not have.
    #[inline(never)]
    fn add_by_film(
        &mut self,
        (image, film): (&ImageTarget<'_>, &FilmModel),
        stage: &Stage,
        samples: (&[BorderPixel], &Motion),
        lines: &[PathLine],
    ) {
        let deviations = core::array::from_fn(|k| sqrt(film.covariance[k][k].max(0.0)));
        self.correlation = correlation(film, &deviations);
        let changes = Changes::of(image, film, &deviations, stage);
        self.add_common(stage.loss, samples);
        self.add_moved(samples, KNOWN_PX, |number, sample| {
            let line = lines.get(number);
            line.map_or([0.0; CONSTANTS], |line| changes.moves(sample, line))
        });
    }

    fn add_common(&mut self, loss: Loss, (border, motion): (&[BorderPixel], &Motion)) {
        for sample in border {
            if let Some(residual) = sample.residual_px() {
                let jacobian = motion.jacobian(sample);
                let psi = loss.pull(residual).into();
                (self.common).add(sample.weight.into(), &jacobian, KNOWN_PX, psi);
            }
        }
    }

    /// Adds samples whose edges a constant's standard deviation would move so far, and `common` pixels all of them.
    fn add_moved(
        &mut self,
        (border, motion): (&[BorderPixel], &Motion),
        common: f64,
        moves: impl Fn(usize, &BorderPixel) -> [f64; CONSTANTS],
    ) {
        for (few, block) in border.chunks(BLOCK).enumerate() {
            let mut sums = Block::default();
            for (place, sample) in block.iter().enumerate() {
                if !sample.has_residual() {
                    continue;
                }
                let [curvature, blur, attenuation] = moves(few * BLOCK + place, sample);
                let moved = [curvature, blur, attenuation, common];
                self.any |= moved.iter().any(|&x| x != 0.0);
                sums.add(sample, motion, moved.map(|px| px as f32));
            }
            add_to(&mut self.information, &sums.information);
            add_to(&mut self.pulls, &sums.pulls);
        }
    }

    /// Adds how far a mask's outline lies off where one side of it lies off by `px` and another does not. A whole outline that is shifted, or wider along
    /// one line than across, leaves as little as one that is wider everywhere: the pose goes along.
    fn add_uneven(&mut self, samples: (&[BorderPixel], &Motion), px: f64) {
        if px <= 0.0 {
            return;
        }
        self.any = true;
        for pull in &uneven_pulls(samples, px) {
            for (row, own) in self.uneven.iter_mut().zip(pull) {
                for (value, other) in row.iter_mut().zip(pull) {
                    *value += own * other;
                }
            }
        }
    }

    /// How far a pose may be off by each constant and by the common distance, where anything is known of them.
    fn shifts(&self) -> Option<[[f64; 6]; CONSTANTS + 1]> {
        let inverse = self.inverse()?;
        Some(self.pulls.map(|pull| times(&inverse, &pull)))
    }

    fn inverse(&self) -> Option<Matrix6> {
        inverse_spd(&self.information).filter(|_| self.any)
    }

    /// The common distance by what residuals say of it, in usual ones. What traced a mask errs otherwise from corner to corner, and would hide it.
    fn common(&self, shift: &[f64; 6], errors: Errors) -> f64 {
        match (self.others, &self.pulls) {
            (false, [.., pull]) if cfg!(feature = "frames") => {
                self.common.left(shift, pull, errors)
            }
            _ => 1.0,
        }
    }

    /// See [`super::Assessment::film_steps`]: curvature and blur come first of the constants, so these are the first two
    /// columns of Cholesky's factor of the correlation.
    pub(super) fn film_steps(&self) -> [[f64; 6]; 2] {
        let Some([curvature, blur, attenuation, _]) = self.shifts() else {
            return [[0.0; 6]; 2];
        };
        let of = |row: usize, column: usize| self.correlation[row][column];
        let own = sqrt((1.0 - of(0, 1) * of(0, 1)).max(0.0));
        let also = if own > 0.0 {
            (of(1, 2) - of(0, 1) * of(0, 2)) / own
        } else {
            0.0
        };
        let sum = |parts: [f64; 3]| {
            core::array::from_fn(|k| {
                parts[0] * curvature[k] + parts[1] * blur[k] + parts[2] * attenuation[k]
            })
        };
        [sum([1.0, of(0, 1), of(0, 2)]), sum([0.0, own, also])]
    }

    /// Adds how far a pose may be off by it.
    pub(super) fn widen(&self, covariance: PoseCovariance, errors: Errors) -> PoseCovariance {
        let (Some(shifts), Some(inverse)) = (self.shifts(), self.inverse()) else {
            return covariance;
        };
        let uneven = congruence(&inverse, &self.uneven);
        let mut matrix = covariance.matrix;
        let of = |shift: &[f64; 6], number: usize| shift.get(number).copied().unwrap_or_default();
        let (constants, [common]) = shifts.split_at(CONSTANTS) else {
            return covariance;
        };
        let left = self.common(common, errors);
        let common = &common.map(|value| left * value);
        for (row, (values, uneven)) in matrix.iter_mut().zip(&uneven).enumerate() {
            for (column, (value, uneven)) in values.iter_mut().zip(uneven).enumerate() {
                *value += of(common, row) * of(common, column) + uneven;
                for (one, correlated) in constants.iter().zip(&self.correlation) {
                    for (other, correlation) in constants.iter().zip(correlated) {
                        *value += correlation * of(one, row) * of(other, column);
                    }
                }
            }
        }
        PoseCovariance { matrix }
    }
}

fn correlation(film: &FilmModel, deviations: &[f64; CONSTANTS]) -> [[f64; CONSTANTS]; CONSTANTS] {
    core::array::from_fn(|row| {
        core::array::from_fn(|column| {
            let both = deviations[row] * deviations[column];
            match both > 0.0 {
                true => film.covariance[row][column] / both,
                false => 0.0,
            }
        })
    })
}

/// A film as it is known, and with each of its constants changed by a standard deviation.
struct Changes<'c> {
    image: &'c ImageTarget<'c>,
    range: f64,
    known: Seen,
    /// None where a constant is certain.
    changed: [Option<Seen>; CONSTANTS],
}

/// A film's edges, and the curve by which its frames are read.
struct Seen {
    filter: EdgeFilter,
    curve: QuickCurve,
}

impl<'c> Changes<'c> {
    fn of(
        image: &'c ImageTarget<'c>,
        film: &FilmModel,
        deviations: &[f64; CONSTANTS],
        stage: &Stage,
    ) -> Self {
        let seen = |film: FilmModel| {
            let film_of = Some(film);
            let curve = ImageTarget {
                film: film_of,
                ..*image
            };
            Seen {
                filter: EdgeFilter::from(&film),
                curve: curve.curve().into(),
            }
        };
        let changed =
            |k: usize| (deviations[k] != 0.0).then(|| seen(film.changed(k, deviations[k])));
        Self {
            image,
            range: stage.range,
            known: seen(*film),
            changed: core::array::from_fn(changed),
        }
    }

    /// How far the residual of a sample moves by each, pixels; not at all where an edge jumps.
    fn moves(&self, sample: &BorderPixel, line: &PathLine) -> [f64; CONSTANTS] {
        let certain = self.changed.iter().all(Option::is_none);
        let known = || self.residual(&self.known, sample, line);
        let Some(known) = (!certain).then(known).flatten() else {
            return [0.0; CONSTANTS];
        };
        self.changed.each_ref().map(|changed| {
            let residual = |seen| self.residual(seen, sample, line);
            let moved = changed
                .as_ref()
                .and_then(residual)
                .map(|there| there - known);
            moved.filter(|moved| moved.abs() < JUMP).unwrap_or(0.0)
        })
    }

    fn residual(&self, seen: &Seen, sample: &BorderPixel, line: &PathLine) -> Option<f64> {
        let NormalReading::At(drawn) = seen.filter.edge(line.paths(), 0.0) else {
            return None;
        };
        match edge::edge(self.image, &seen.curve, sample, drawn, self.range) {
            NormalReading::At(found) => Some(found - drawn),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;

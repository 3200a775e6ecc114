//! What is not known of a film moves all edges alike, which leaves no residual: how far that may move a pose.
//!
//! Each constant is changed by its standard deviation, edges are looked for again, and the pose follows to first order,
//! `(sum l J J')^-1 sum l J dr`. What physics leaves out, and all of it where no film is known, is a common distance between
//! edges and outline.

use super::border::{BorderPixel, NormalReading};
use super::edge;
use super::stages::Stage;
use super::view::{CameraView, ImageTarget, Target};
use crate::film::model::CONSTANTS;
use crate::film::{FilmModel, PathLine};
use crate::math::{inverse_spd, sqrt};
use crate::pose::covariance::{Matrix6, PoseCovariance};

/// Standard deviation of the common distance, pixels, where the film is known. Depths on synthetic films are off by some 0.06 px
/// of outline; real films hold more that is not modelled. A judgement, not a fit.
const KNOWN_PX: f64 = 0.1;
/// And where it is not: edges of films seen so far lie 0.2 to 0.9 px inside the outline.
const UNKNOWN_PX: f64 = 0.65;
/// Edges that move farther than this have jumped to others, pixels.
const JUMP: f64 = 1.0;

/// Sums over the samples of all grey frames.
#[derive(Default)]
pub(super) struct EdgeBias {
    information: Matrix6,
    /// By one standard deviation of each constant, and by the common distance.
    pulls: [[f64; 6]; CONSTANTS + 1],
    correlation: [[f64; CONSTANTS]; CONSTANTS],
    any: bool,
}

impl EdgeBias {
    /// Adds the samples of a view, with the lines across them where edges were compared with drawn ones.
    pub(super) fn add(
        &mut self,
        view: &CameraView<'_>,
        stage: &Stage,
        border: &[BorderPixel],
        lines: &[PathLine],
    ) {
        let film = view.target.film().filter(|_| stage.drawn);
        let deviations = film.map_or([0.0; CONSTANTS], |film| {
            core::array::from_fn(|k| sqrt(film.covariance[k][k].max(0.0)))
        });
        if let Some(film) = film {
            self.correlation = correlation(film, &deviations);
        }
        for (number, sample) in border.iter().enumerate() {
            if sample.residual_px().is_none() {
                continue;
            }
            let mut moved = [0.0; CONSTANTS + 1];
            moved[CONSTANTS] = match view.target {
                // A silhouette is where it is.
                Target::Silhouette(_) => 0.0,
                Target::Image(_) if film.is_some() => KNOWN_PX,
                Target::Image(_) => UNKNOWN_PX,
            };
            if let (Target::Image(image), Some(film), Some(line)) =
                (&view.target, film, lines.get(number))
            {
                let change = Change { image, film, stage };
                for (k, moved) in moved.iter_mut().take(CONSTANTS).enumerate() {
                    *moved = change.by(k, deviations[k], sample, line).unwrap_or(0.0);
                }
            }
            self.any |= moved.iter().any(|&x| x != 0.0);
            self.add_sample(sample, &moved);
        }
    }

    fn add_sample(&mut self, sample: &BorderPixel, moved: &[f64; CONSTANTS + 1]) {
        let jacobian = sample.jacobian.map(f64::from);
        let length = f64::from(sample.weight);
        for (row, &a) in jacobian.iter().enumerate() {
            for (pull, moved) in self.pulls.iter_mut().zip(moved) {
                pull[row] += length * a * moved;
            }
            for (sum, &b) in self.information[row].iter_mut().zip(&jacobian) {
                *sum += length * a * b;
            }
        }
    }

    /// Adds how far a pose may be off by it.
    pub(super) fn widen(&self, covariance: PoseCovariance) -> PoseCovariance {
        let Some(inverse) = inverse_spd(&self.information).filter(|_| self.any) else {
            return covariance;
        };
        let shifts = self
            .pulls
            .map(|pull| inverse.map(|row| row.iter().zip(&pull).map(|(a, b)| a * b).sum::<f64>()));
        let mut matrix = covariance.matrix;
        for (row, values) in matrix.iter_mut().enumerate() {
            for (column, value) in values.iter_mut().enumerate() {
                *value += shifts[CONSTANTS][row] * shifts[CONSTANTS][column];
                for (a, one) in shifts.iter().take(CONSTANTS).enumerate() {
                    for (b, other) in shifts.iter().take(CONSTANTS).enumerate() {
                        *value += self.correlation[a][b] * one[row] * other[column];
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

/// A change of one constant.
struct Change<'c> {
    image: &'c ImageTarget<'c>,
    film: &'c FilmModel,
    stage: &'c Stage,
}

impl Change<'_> {
    /// How far the residual of a sample moves, pixels; `None` where an edge jumps.
    fn by(&self, number: usize, by: f64, sample: &BorderPixel, line: &PathLine) -> Option<f64> {
        if by == 0.0 {
            return None;
        }
        let residual = |film: &FilmModel| {
            let NormalReading::At(drawn) = film.edge(line.paths(), 0.0) else {
                return None;
            };
            let image = ImageTarget {
                film: Some(*film),
                ..*self.image
            };
            match edge::edge(&image, &image.curve(), sample, drawn, self.stage.range) {
                NormalReading::At(found) => Some(found - drawn),
                _ => None,
            }
        };
        let moved = residual(&self.film.changed(number, by))? - residual(self.film)?;
        (moved.abs() < JUMP).then_some(moved)
    }
}

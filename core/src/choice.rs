//! Which of several refined poses of a component is chosen, and why.
//!
//! A nearly symmetric component has two poses with nearly one outline ([`crate::mirror`]). The rules,
//! in order; each leaves out the poses that are worse than the best by its margin, and the one after
//! which a single pose is left is the reason given:
//!
//! 1. the residual, where it is [`DECISIVE_RATIO`] times as large;
//! 2. the coronal tilt against the other component ([`coronal_tilt_deg`]), the smaller the better;
//! 3. the turn from the same component in neighbouring frames, the smaller the better.
//!
//! Where more than one pose is left, the one with the least residual is taken and said to be
//! undecided. A whole film is decided at once by [`choose_film`].
//!
//! Rule 2 needs models with the field's axes: x anteroposterior, y superoinferior (the tibial
//! component's along its stem, upwards), z mediolateral.

mod film;

pub use film::{FILM_MARGIN_DEG, FilmError, FilmFrame, FilmStep, choose_film};

use core::fmt;

use heapless::Vec;

use crate::kinematics::coronal_tilt_deg;
use crate::math::round;
use crate::pose::{Pose, geodesic_deg};

/// A residual this many times the best one rules a pose out. Of network masks and grey images the
/// ratio of the two mirror poses was 0.9 to 1.1, and the wrong one often the smaller.
pub const DECISIVE_RATIO: f64 = 1.3;

/// Poses whose tilts are nearer in magnitude than this are not told apart by it, degrees.
///
/// Measured on one study of 16 frames, right against mirrored pose: with the femur known, the right
/// tibia's tilt was smaller by 3.6 to 5.0 degrees; with the tibia known, the right femur's smaller
/// by up to 2.9, but in four frames larger, by up to 1.7.
pub const TILT_MARGIN_DEG: f64 = 2.0;

/// Poses whose turns from the neighbouring frames differ by less than this are not told apart by
/// them, degrees.
pub const TURN_MARGIN_DEG: f64 = 2.0;

/// Poses of a frame that are compared: those with the least residuals.
pub const CONTENDERS: usize = 8;

/// A refined pose and how well it fits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// `camera_from_model`.
    pub pose: Pose,
    /// Root mean square of what remains between outlines, pixels (of a loss in square pixels, the
    /// root). Anything else that is proportional to it serves. NaN counts as infinite.
    pub residual_px: f64,
}

/// The other component of the joint in the same frame: candidates are poses of its counterpart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Counterpart {
    /// The femoral component is known, candidates are tibial poses.
    Femur(Pose),
    /// The tibial component is known, candidates are femoral poses.
    Tibia(Pose),
}

impl Counterpart {
    /// Coronal tilt of the joint with `candidate` as the other component, degrees.
    #[must_use]
    pub fn tilt_deg(&self, candidate: &Pose) -> f64 {
        match self {
            Self::Femur(femur) => coronal_tilt_deg(femur, candidate),
            Self::Tibia(tibia) => coronal_tilt_deg(candidate, tibia),
        }
    }
}

/// What is known besides the candidates themselves.
#[derive(Clone, Copy, Debug, Default)]
pub struct Context<'a> {
    /// The other component in the same frame.
    pub counterpart: Option<Counterpart>,
    /// The same component in neighbouring frames: that before, that after, or both.
    pub neighbours: &'a [Pose],
}

/// What decided between candidates, with the chosen pose's figure first and the next best pose's
/// second. Displayed, it is a sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// There was no other.
    Only,
    /// The residual.
    Residual {
        /// Of the chosen pose, pixels.
        chosen_px: f64,
        /// Of the next best, pixels.
        other_px: f64,
    },
    /// The coronal tilt against the other component.
    Tilt {
        /// With the chosen pose, degrees.
        chosen_deg: f64,
        /// With the next best, degrees.
        other_deg: f64,
    },
    /// The turn from the neighbouring frames.
    Turn {
        /// Mean turn to the chosen pose, degrees.
        chosen_deg: f64,
        /// Mean turn to the next best, degrees.
        other_deg: f64,
    },
    /// The film as a whole, in which other frames were decided by themselves.
    Film {
        /// What the best film with another pose in this frame costs more, degrees of turning.
        saved_deg: f64,
    },
    /// Nothing: the pose with the least residual was taken, or, in a film, the one that goes with
    /// those taken in other frames.
    Undecided {
        /// Residual of the chosen pose, pixels.
        chosen_px: f64,
        /// Residual of the best of the others, pixels.
        other_px: f64,
    },
}

impl Reason {
    /// Whether the choice can be relied on.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        !matches!(self, Self::Undecided { .. })
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Without the sign of a negative zero.
        let tenth = |x: f64| round(x * 10.0) / 10.0 + 0.0;
        match *self {
            Self::Only => f.write_str("the only pose found"),
            Self::Residual {
                chosen_px,
                other_px,
            } => write!(f, "residual {chosen_px:.3} px against {other_px:.3} px"),
            Self::Tilt {
                chosen_deg,
                other_deg,
            } => write!(
                f,
                "coronal tilt {:.1} deg against {:.1} deg",
                tenth(chosen_deg),
                tenth(other_deg)
            ),
            Self::Turn {
                chosen_deg,
                other_deg,
            } => write!(
                f,
                "turned {chosen_deg:.1} deg from the neighbouring frames against {other_deg:.1} deg"
            ),
            Self::Film { saved_deg } => write!(
                f,
                "continuity over the film, which turns {saved_deg:.1} deg more with another pose"
            ),
            Self::Undecided {
                chosen_px,
                other_px,
            } => write!(
                f,
                "undecided: residual {chosen_px:.3} px against {other_px:.3} px, and nothing else tells the poses apart"
            ),
        }
    }
}

/// The pose that was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Its number among the candidates.
    pub index: usize,
    /// What decided.
    pub reason: Reason,
}

/// Chooses among the poses of one frame, which may come in any order; `None` where there is none.
#[must_use]
pub fn choose(candidates: &[Candidate], context: &Context<'_>) -> Option<Choice> {
    let (mut contenders, reason) = Contenders::of(candidates, context.counterpart.as_ref());
    let reason = reason.or_else(|| {
        let turn = |pose: &Pose| mean_turn_deg(pose, context.neighbours);
        let (chosen_deg, other_deg) = contenders.narrow(turn, TURN_MARGIN_DEG)?;
        Some(Reason::Turn {
            chosen_deg,
            other_deg,
        })
    });
    Some(Choice {
        index: contenders.first()?,
        reason: reason.unwrap_or_else(|| contenders.undecided()),
    })
}

/// Mean angle to the neighbours; NaN without any.
fn mean_turn_deg(pose: &Pose, neighbours: &[Pose]) -> f64 {
    let turn = |other: &Pose| geodesic_deg(&pose.rotation, &other.rotation);
    neighbours.iter().map(turn).sum::<f64>() / neighbours.len() as f64
}

/// Candidates that are still open, by rising residual.
struct Contenders<'a> {
    candidates: &'a [Candidate],
    open: Vec<usize, CONTENDERS>,
}

impl<'a> Contenders<'a> {
    /// What the candidates' residuals and the counterpart leave open, and the reason where that is
    /// one.
    fn of(
        candidates: &'a [Candidate],
        counterpart: Option<&Counterpart>,
    ) -> (Self, Option<Reason>) {
        let mut contenders = Self {
            candidates,
            open: Vec::new(),
        };
        contenders.sort();
        let reason = contenders.by_residual().or_else(|| {
            let tilt = |pose: &Pose| counterpart.map_or(f64::NAN, |known| known.tilt_deg(pose));
            let (chosen_deg, other_deg) = contenders.narrow(tilt, TILT_MARGIN_DEG)?;
            Some(Reason::Tilt {
                chosen_deg,
                other_deg,
            })
        });
        (contenders, reason)
    }

    fn first(&self) -> Option<usize> {
        self.open.first().copied()
    }

    fn residual(&self, index: usize) -> f64 {
        let residual = self.candidates.get(index).map(|c| c.residual_px);
        residual.filter(|r| !r.is_nan()).unwrap_or(f64::INFINITY)
    }

    /// The best few; of equal ones the first stays first.
    fn sort(&mut self) {
        for index in 0..self.candidates.len() {
            let residual = self.residual(index);
            let place = self.open.partition_point(|&k| self.residual(k) <= residual);
            if self.open.is_full() && place < CONTENDERS {
                self.open.pop();
            }
            // Where it is full still, the newcomer is no better than all of them.
            let _ = self.open.insert(place, index);
        }
    }

    fn by_residual(&mut self) -> Option<Reason> {
        let best = self.residual(self.first()?);
        let Some(&next) = self.open.get(1) else {
            return Some(Reason::Only);
        };
        let other_px = self.residual(next);
        let out = |residual: f64| residual > best && residual >= DECISIVE_RATIO * best;
        while self
            .open
            .last()
            .is_some_and(|&last| out(self.residual(last)))
        {
            self.open.pop();
        }
        (self.open.len() == 1).then_some(Reason::Residual {
            chosen_px: best,
            other_px,
        })
    }

    /// Leaves those open whose angle is within `margin` of the smallest in magnitude. The angles
    /// of the one that is left and of the next best, where one is left.
    fn narrow(&mut self, angle: impl Fn(&Pose) -> f64, margin: f64) -> Option<(f64, f64)> {
        let angle = |&index: &usize| {
            let pose = self.candidates.get(index).map(|candidate| &candidate.pose);
            (index, pose.map_or(f64::NAN, &angle))
        };
        let mut angles: Vec<(usize, f64), CONTENDERS> = self.open.iter().map(angle).collect();
        angles.sort_unstable_by(|(i, a), (j, b)| a.abs().total_cmp(&b.abs()).then(i.cmp(j)));
        let &(_, best) = angles.first()?;
        if !best.is_finite() {
            return None;
        }
        let near = |index: &usize| {
            let own = angles.iter().find(|(other, _)| other == index);
            own.is_some_and(|(_, angle)| angle.abs() - best.abs() < margin)
        };
        self.open.retain(near);
        let &(_, next) = angles.get(1)?;
        (self.open.len() == 1).then_some((best, next))
    }

    /// The reason where nothing decided: the first against the second that is open.
    fn undecided(&self) -> Reason {
        let residual = |number: usize| {
            let index = self.open.get(number).copied();
            index.map_or(f64::NAN, |index| self.residual(index))
        };
        Reason::Undecided {
            chosen_px: residual(0),
            other_px: residual(1),
        }
    }
}

#[cfg(test)]
mod tests;

//! The choice between several refined poses of a component, with its reason.
//!
//! A nearly symmetric component has two poses with nearly one outline ([`crate::mesh::mirror`]), and where
//! masks are poor two more that are mirrored in one out-of-plane rotation alone. The rules, in
//! order; each rules out the poses that are worse than the best by its margin, and the last one
//! that ruled out any is the reason given:
//!
//! 1. the residual, where it is [`DECISIVE_RATIO`] times as large;
//! 2. what no knee does with the other component ([`across_deg`] of [`KNEE_DEG`]), where another pose makes a knee with it;
//! 3. the coronal tilt against the other component ([`coronal_tilt_deg`]), the smaller the better, of poses that make a knee
//!    with it: in axes that are not the components' a tilt says nothing;
//! 4. the turn from the same component in neighbouring frames, the smaller the better.
//!
//! Of the poses that are left the one with the least residual is taken, and the next is named as
//! open. On network masks of a real tibia, its femur known, tilt ruled out the mirror image in 16
//! of 16 frames and left one other pose open, 8 to 21 degrees away and of 1.02 to 1.22 times the
//! residual; the pose taken was right in all of them. A whole film is decided at once by [`choose_film`].
//!
//! Where an end of the component is beyond the frame's border what tilt and neighbours rule out leaves the pose doubtful all the same
//! ([`super::judge`]): the right one may not be among the candidates.
//!
//! A counterpart that is doubtful itself rules out nothing: poses that it speaks against stay open, behind the others.
//!
//! Residual and tilt choose whatever the film says: a pose that its film does not go through is doubtful ([`detours`]).
//!
//! A chosen pose that makes no knee with the other component is doubtful ([`Choice::no_knee_deg`]), unless that is doubtful itself: then that one is
//! the likelier to be wrong.
//!
//! Rules 2 and 3 need models with the field's axes: x anteroposterior, y superoinferior (the tibial
//! component's along its stem, upwards), z mediolateral.

mod detour;
mod film;

pub use detour::{Detour, detours};
pub use film::{FILM_MARGIN_DEG, FilmError, FilmFrame, FilmStep, choose_film, rests_on_doubt};

use core::fmt;

use heapless::Vec;

use crate::joint::kinematics::{across_deg, coronal_tilt_deg};
use crate::math::round;
use crate::pose::{Pose, geodesic_deg};
use crate::shortlist::{first_of, smallest};

/// A residual this many times the best one rules a pose out. Of network masks and grey images the
/// ratio of the two mirror poses was 0.9 to 1.1, and the wrong one often the smaller.
pub const DECISIVE_RATIO: f64 = 1.3;

/// The tilt decides nothing between poses whose tilts differ by less than this in magnitude, degrees.
///
/// Measured on one study of 16 frames, right against mirrored pose: with the femur known, the right
/// tibia's tilt was smaller by 3.6 to 5.0 degrees; with the tibia known, the right femur's smaller
/// by up to 2.9, but in four frames larger, by up to 1.7.
pub const TILT_MARGIN_DEG: f64 = 2.0;

/// The mediolateral axes of two components of a knee are no farther apart, degrees: kneeling turns a knee by 30, and axes may be some degrees
/// off. A judgement.
pub const KNEE_DEG: f64 = 50.0;

/// The neighbouring frames decide nothing between poses whose rotations from them differ by less than this, degrees, nor where any other pose is less
/// than twice as far from them: of single pictures one is always the nearest.
pub const TURN_MARGIN_DEG: f64 = 2.0;

/// Poses of a frame that are compared: those with the least residuals.
pub const CONTENDERS: usize = 8;

/// A refined pose and how well it fits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RivalPose {
    /// `camera_from_model`.
    pub pose: Pose,
    /// Root mean square distance that remains between the outlines, pixels (of a loss in square pixels, its root).
    /// Only ratios matter, so anything proportional to it serves. NaN counts as infinite.
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

    /// How far the mediolateral axes of both components are apart, degrees, where that is farther than in any knee.
    #[must_use]
    pub fn no_knee_deg(&self, candidate: &Pose) -> Option<f64> {
        let (Self::Femur(known) | Self::Tibia(known)) = self;
        Some(across_deg(known, candidate)).filter(|&deg| deg > KNEE_DEG)
    }
}

/// What is known of a frame besides its candidates.
#[derive(Clone, Copy, Debug, Default)]
pub struct ChoiceContext<'a> {
    /// The other component in the same frame.
    pub counterpart: Option<Counterpart>,
    /// Whether its pose is doubtful itself: it tells which pose to prefer then, and rules out none.
    pub is_counterpart_doubtful: bool,
    /// Poses of the same component in the frame before, the frame after, or both.
    pub neighbours: &'a [Pose],
}

/// What ruled out other candidates: the chosen pose's figure first, then that of the best pose
/// among those ruled out. Displayed, it is a sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// There was no other pose.
    Only,
    /// The residual.
    Residual {
        /// Of the chosen pose, pixels.
        chosen_px: f64,
        /// Of the best ruled out, pixels.
        other_px: f64,
    },
    /// What no knee does with the other component: how far the mediolateral axes of both are apart.
    Knee {
        /// With the chosen pose, degrees.
        chosen_deg: f64,
        /// With the best ruled out, degrees.
        other_deg: f64,
    },
    /// The coronal tilt against the other component.
    Tilt {
        /// With the chosen pose, degrees.
        chosen_deg: f64,
        /// With the best ruled out, degrees.
        other_deg: f64,
    },
    /// The turn from the neighbouring frames.
    Turn {
        /// Mean turn to the chosen pose, degrees.
        chosen_deg: f64,
        /// Mean turn to the best ruled out, degrees.
        other_deg: f64,
    },
    /// The film as a whole.
    Film {
        /// By how much more the film jumps with any other pose in this frame, degrees.
        saved_deg: f64,
    },
    /// Nothing ruled out any: of the poses left, that with the least residual was taken, or, in a
    /// film, the one that goes with those taken in other frames.
    Undecided {
        /// Residual of the chosen pose, pixels.
        chosen_px: f64,
        /// Of the best of the others, pixels.
        other_px: f64,
    },
}

impl Reason {
    /// Whether any pose was ruled out. One may be open still: [`Choice::is_decided`].
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
                other_px: f64::INFINITY,
            } => write!(
                f,
                "residual {chosen_px:.3} px, and no other pose fits at all"
            ),
            Self::Residual {
                chosen_px,
                other_px,
            } => write!(f, "residual {chosen_px:.3} px against {other_px:.3} px"),
            Self::Knee {
                chosen_deg,
                other_deg,
            } => write!(
                f,
                "mediolateral axes {chosen_deg:.0} deg from the other component's against {other_deg:.0} deg, which no knee does"
            ),
            Self::Tilt {
                chosen_deg,
                other_deg,
            } => {
                let (chosen, other) = (tenth(chosen_deg), tenth(other_deg));
                write!(f, "coronal tilt {chosen:.1} deg against {other:.1} deg")
            }
            Self::Turn {
                chosen_deg,
                other_deg,
            } => write!(
                f,
                "turned {chosen_deg:.1} deg from the neighbouring frames against {other_deg:.1} deg"
            ),
            Self::Film { saved_deg } => write!(
                f,
                "continuity over the film, which jumps by {saved_deg:.1} deg more with another pose"
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

/// The best of the poses that nothing ruled out, besides the chosen one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenRival {
    /// Its number among the candidates.
    pub index: usize,
    /// Residual of the chosen pose, pixels.
    pub chosen_px: f64,
    /// Its own residual, pixels.
    pub other_px: f64,
}

/// The pose that was chosen. Displayed, it is a sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Its number among the candidates.
    pub index: usize,
    /// What ruled out others.
    pub reason: Reason,
    /// The best of what nothing ruled out: show it beside the chosen pose.
    pub open: Option<OpenRival>,
    /// How far the mediolateral axes are from the other component's, degrees, where that is known, not doubtful itself, and no knee does it: a
    /// pose or the axes of a model are wrong.
    pub no_knee_deg: Option<f64>,
}

impl Choice {
    /// Whether every other candidate was ruled out.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        self.open.is_none()
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.reason)?;
        match self.open {
            Some(OpenRival {
                chosen_px,
                other_px,
                ..
            }) if self.reason.is_decided() => write!(
                f,
                "; another pose is open: residual {chosen_px:.3} px against {other_px:.3} px"
            ),
            _ => Ok(()),
        }
    }
}

/// Chooses among the poses of one frame, which may come in any order; `None` where there is none.
#[must_use]
pub fn choose(candidates: &[RivalPose], context: &ChoiceContext<'_>) -> Option<Choice> {
    let beside = context.counterpart.as_ref();
    let mut contenders = Contenders::of(candidates, beside, context.is_counterpart_doubtful);
    let turn = |pose: &Pose| mean_turn_deg(pose, context.neighbours);
    let margin = |least_deg: f64| least_deg.max(TURN_MARGIN_DEG);
    if let Some((chosen_deg, other_deg)) = contenders.narrow(&turn, margin) {
        contenders.reason = Some(Reason::Turn {
            chosen_deg,
            other_deg,
        });
    }
    contenders.choice()
}

/// How far a pose is from a knee with the other component, where it is none ([`Counterpart::no_knee_deg`]).
fn no_knee_deg(counterpart: Option<&Counterpart>, candidate: Option<&RivalPose>) -> Option<f64> {
    counterpart?.no_knee_deg(&candidate?.pose)
}

/// Mean angle to the neighbours; NaN without any.
fn mean_turn_deg(pose: &Pose, neighbours: &[Pose]) -> f64 {
    let turn = |other: &Pose| geodesic_deg(&pose.rotation, &other.rotation);
    neighbours.iter().map(turn).sum::<f64>() / neighbours.len() as f64
}

/// Candidates that are still open, by rising residual, and why others are not.
struct Contenders<'a> {
    candidates: &'a [RivalPose],
    counterpart: Option<&'a Counterpart>,
    is_counterpart_doubtful: bool,
    open: Vec<usize, CONTENDERS>,
    /// How many of those nothing speaks against: they come first.
    preferred: usize,
    reason: Option<Reason>,
}

impl<'a> Contenders<'a> {
    /// What the candidates' residuals and the counterpart leave open.
    fn of(
        candidates: &'a [RivalPose],
        counterpart: Option<&'a Counterpart>,
        is_doubtful: bool,
    ) -> Self {
        let mut contenders = Self {
            candidates,
            counterpart,
            is_counterpart_doubtful: is_doubtful,
            open: Vec::new(),
            preferred: 0,
            reason: None,
        };
        contenders.sort();
        contenders.rule_by_residual();
        let fitting = contenders.open.clone();
        contenders.rule_by_knee();
        let tilt = |pose: &Pose| match counterpart {
            Some(known) if known.no_knee_deg(pose).is_none() => known.tilt_deg(pose),
            _ => f64::NAN,
        };
        if let Some((chosen_deg, other_deg)) = contenders.narrow(&tilt, |_| TILT_MARGIN_DEG) {
            contenders.reason = Some(Reason::Tilt {
                chosen_deg,
                other_deg,
            });
        }
        contenders.preferred = contenders.open.len();
        if is_doubtful {
            let behind = fitting
                .iter()
                .filter(|index| !contenders.open.contains(index));
            contenders.open = first_of(contenders.open.iter().chain(behind).copied());
        }
        contenders
    }

    fn choice(&self) -> Option<Choice> {
        let index = self.first()?;
        let chosen_px = self.residual(index);
        let open = self.open.get(1).map(|&index| OpenRival {
            index,
            chosen_px,
            other_px: self.residual(index),
        });
        let undecided = || Reason::Undecided {
            chosen_px,
            other_px: open.map_or(f64::INFINITY, |open| open.other_px),
        };
        Some(Choice {
            index,
            reason: self.reason.unwrap_or_else(undecided),
            open,
            no_knee_deg: no_knee_deg(self.trusted(), self.candidates.get(index)),
        })
    }

    /// The other component, unless it is doubtful itself.
    fn trusted(&self) -> Option<&Counterpart> {
        self.counterpart.filter(|_| !self.is_counterpart_doubtful)
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
        self.open = smallest(0..self.candidates.len(), |&index| self.residual(index));
    }

    fn rule_by_residual(&mut self) {
        let Some(best) = self.first().map(|k| self.residual(k)) else {
            return;
        };
        if self.open.len() == 1 {
            self.reason = Some(Reason::Only);
        }
        // Of equal residuals, zero or infinite, neither rules out the other.
        let out = |residual: f64| residual > best && residual >= DECISIVE_RATIO * best;
        while let Some(other_px) = self.open.last().map(|&last| self.residual(last)) {
            if !out(other_px) {
                break;
            }
            self.open.pop();
            self.reason = Some(Reason::Residual {
                chosen_px: best,
                other_px,
            });
        }
    }

    /// Where some poses make a knee with the other component, those that do not are ruled out.
    fn rule_by_knee(&mut self) {
        let Some(counterpart) = self.counterpart else {
            return;
        };
        let wrong_deg = |&index: &usize| no_knee_deg(Some(counterpart), self.candidates.get(index));
        let possible = || self.open.iter().filter(|index| wrong_deg(index).is_none());
        let other_deg = self.open.iter().find_map(wrong_deg);
        let chosen = possible()
            .next()
            .and_then(|&index| self.candidates.get(index));
        let (Some(chosen), Some(other_deg)) = (chosen, other_deg) else {
            return;
        };
        let (Counterpart::Femur(known) | Counterpart::Tibia(known)) = counterpart;
        self.reason = Some(Reason::Knee {
            chosen_deg: across_deg(known, &chosen.pose),
            other_deg,
        });
        self.open = first_of(possible().copied());
    }

    /// Rules out those whose angle is larger in magnitude than the smallest by the `margin` for that. If there
    /// are any, the angles of the first that is left and of the best of those.
    fn narrow(
        &mut self,
        angle: &dyn Fn(&Pose) -> f64,
        margin: impl Fn(f64) -> f64,
    ) -> Option<(f64, f64)> {
        let angle = |index: usize| {
            let pose = self.candidates.get(index).map(|candidate| &candidate.pose);
            pose.map_or(f64::NAN, angle)
        };
        let smaller = |a: &f64, b: &f64| a.abs().total_cmp(&b.abs());
        let least = self.open.iter().map(|&k| angle(k)).min_by(smaller)?;
        if !least.is_finite() {
            return None;
        }
        let margin = margin(least.abs());
        let near = |k: usize| angle(k).abs() - least.abs() < margin;
        let far = self.open.iter().filter(|&&k| !near(k));
        let other = far.map(|&k| angle(k)).min_by(smaller)?;
        let chosen = self.open.iter().copied().find(|&k| near(k)).map(angle)?;
        let left = first_of(self.open.iter().copied().filter(|&k| near(k)));
        self.open = left;
        Some((chosen, other))
    }
}

#[cfg(test)]
mod tests;

//! How far a chosen pose is to be trusted: good, doubtful, or no fit at all.
//!
//! A verdict looks at what residuals alone do not tell: how much of the model's outline has a counterpart, whether the two
//! outlines enclose the same pixels, whether the outline determines the pose, and whether another pose fits as well.
//! The limits are pixels where a hand or a network sets them, and parts of the silhouette's size where its shape does: the
//! outline of another implant of 300 pixels fits worse, in pixels, than that of one of 50.

use core::fmt;

use heapless::Vec;

use super::candidate::{CANDIDATES, Candidate};
use super::choice::{Choice, DECISIVE_RATIO, Detour, KNEE_DEG, OpenRival, RivalPose};
use crate::joint::beside::Beside;
use crate::math::{Decimal, norm, subtract};
use crate::pose::covariance::PoseCovariance;
use crate::pose::{Pose, geodesic_deg};
use crate::refine::{Fit, MET_WITHIN_PX};
use crate::shortlist::first_of;

/// What a pose must meet to be called good, and what it must not fall short of to be a pose at all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest root mean square distance of a good fit, pixels; what has no counterpart counts ([`Fit::misfit_px`]).
    pub good_px: f64,
    /// The same as a part of the silhouette's size ([`Fit::size_px`]).
    pub good_part: f64,
    /// Least part of a good fit's known outline that is met.
    pub good_met: f64,
    /// Largest mean distance between both outlines of a good fit, pixels ([`Fit::apart_px`]).
    pub good_apart_px: f64,
    /// Least part of the outline that is known of a good fit.
    pub good_known: f64,
    /// Least part of the model in the frame at a good pose.
    pub good_in_frame: f64,
    /// Least size of a good fit's silhouette, pixels ([`Fit::size_px`]): to a few pixels any outline fits, from some distance.
    pub good_size_px: f64,
    /// Least part of the known outline that is met at any pose.
    pub least_met: f64,
}

/// Of a part of which more lies beyond the frame an end is missing, and with it what tells the other poses from the right one. A judgement, by trays of
/// one study that were cut from above and below (tests/records/refinement.md).
const BEYOND: f64 = 0.2;

/// Poses that are mirrored lie farther apart than this, degrees; nearer ones are one, as noise has it.
pub const OTHER_DEG: f64 = 4.0;

impl Limits {
    /// The usual ones, of `cargo xtask synthetic --refusal`: outlines of the right model with a hand's jitter of 1 px and up
    /// to a fifth hidden, against outlines of other implants, ellipses, hulls, blobs and outlines cut off.
    pub const USUAL: Self = Self {
        good_px: 2.0,
        good_part: 0.02,
        good_met: 0.9,
        good_apart_px: 1.5,
        good_known: 0.5,
        good_in_frame: 0.6,
        good_size_px: 20.0,
        least_met: 0.45,
    };
}

/// Why a pose is doubtful.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Doubt {
    /// A part of the model's outline has no counterpart: hidden, cut off, or of another implant.
    Unmet {
        /// That part of the known outline.
        part: f64,
        /// How far away it was looked for, pixels.
        within_px: f64,
    },
    /// The outlines lie farther apart than those of a good fit.
    Apart {
        /// How far, pixels.
        px: f64,
        /// How far they may, pixels.
        limit_px: f64,
    },
    /// The model lies behind the detector, where no part can be.
    Behind {
        /// How far, mm.
        mm: f64,
    },
    /// The model has the size of no knee's component: every length may be of another unit.
    ImplausibleSize {
        /// How wide it is, mm.
        mm: f64,
    },
    /// The silhouette has too few pixels to tell a pose.
    Small {
        /// Its size, pixels: the root of its area.
        px: f64,
    },
    /// Too little of the outline is known.
    Unknown {
        /// The part that is known.
        known: f64,
    },
    /// The outline does not determine the pose, or its rotation no better than [`OTHER_DEG`] (one standard deviation).
    Undetermined,
    /// On its film other poses leave less: it may lie on other edges, or be the mirror image of the right pose.
    Unusual {
        /// What it leaves, pixels.
        px: f64,
        /// What is usual at most, pixels.
        limit_px: f64,
    },
    /// Another pose fits as well, and nothing tells which is right.
    Open {
        /// Turn from the chosen pose to that one, degrees.
        turn_deg: f64,
        /// How far the model's origin is from there, mm.
        shift_mm: f64,
        /// Its misfit, pixels.
        other_px: f64,
    },
    /// The film decided, by frames that are doubtful themselves.
    BesideDoubt,
    /// The film does not go through it: residual or tilt chose it all the same.
    OffTheWay(Detour),
    /// The other component is turned or tilted as in no knee.
    NoKnee {
        /// How far the mediolateral axes of both are apart, degrees.
        apart_deg: f64,
    },
    /// The other component lies beside it as in no knee: the picture may be mirrored.
    Mirrored(Beside),
}

/// Why no pose explains a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Refusal {
    /// The outline is not the model's from any side.
    NoFit {
        /// Root mean square distance of the outlines at the best pose, pixels.
        misfit_px: f64,
        /// Part of the outline that is met there.
        met: f64,
    },
}

/// How far a chosen pose is to be trusted. Displayed, it is a sentence without its full stop.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Verdict {
    /// The model's outline lies on what was seen, all round, and no other pose does.
    Good,
    /// A pose that may be wrong, and why.
    Doubtful(Doubt),
    /// No pose.
    NoFit(Refusal),
}

impl Verdict {
    /// The word for it in tables: `good`, `doubtful` or `none`.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Doubtful(_) => "doubtful",
            Self::NoFit(_) => "none",
        }
    }

    /// The verdict where there is another doubt, as that another pose is open too. What speaks against the fit itself comes
    /// first.
    #[must_use]
    pub fn or_doubt(self, doubt: Option<Doubt>) -> Self {
        match (self, doubt) {
            (Self::Good | Self::Doubtful(Doubt::Undetermined), Some(doubt)) => {
                Self::Doubtful(doubt)
            }
            _ => self,
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Good => f.write_str("the model's outline lies on what was seen"),
            Self::Doubtful(doubt) => doubt.fmt(f),
            Self::NoFit(refusal) => refusal.fmt(f),
        }
    }
}

impl Doubt {
    /// That a chosen pose makes no knee with the other component, where it does not.
    #[must_use]
    pub fn no_knee(choice: &Choice) -> Option<Self> {
        let apart_deg = choice.no_knee_deg?;
        Some(Self::NoKnee { apart_deg })
    }

    /// That another pose than the chosen one fits as well, with its misfit in pixels.
    #[must_use]
    pub fn open(chosen: &Pose, other: &Pose, other_px: f64) -> Self {
        let Away(turn_deg, shift_mm) = Away::between(chosen, other);
        Self::Open {
            turn_deg,
            shift_mm,
            other_px,
        }
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Unmet { part, within_px } => write!(
                f,
                "{} % of the model's outline has no counterpart within {} px: is a part hidden or cut off, or is it another implant?",
                Decimal::new(100.0 * part, 0),
                Decimal::brief(within_px)
            ),
            Self::Apart { px, limit_px } => {
                let [px, limit_px] = Decimal::told_apart(px, limit_px, 1);
                write!(
                    f,
                    "the outlines lie {px} px apart, those of a good fit at most {limit_px} px: trace again, or is it another size or implant?"
                )
            }
            Self::Behind { mm } => write!(
                f,
                "it would lie {} mm behind the detector: is the calibration of frames of another size, the model in another unit, or a part of the outline missing?",
                Decimal::new(mm, 0)
            ),
            Self::ImplausibleSize { mm } => write!(
                f,
                "the model is {} mm across, which no component of a knee is: is its file in another unit?",
                Decimal::new(mm, 2)
            ),
            Self::Small { px } => write!(
                f,
                "the silhouette is {} pixels across: too few to tell a pose",
                Decimal::new(px, 0)
            ),
            Self::Unknown { known } => write!(
                f,
                "only {} % of the model's outline is known",
                Decimal::new(100.0 * known, 0)
            ),
            Self::Undetermined => f.write_str("the outline does not determine the pose"),
            Self::Unusual { px, limit_px } => {
                let [px, limit_px] = Decimal::told_apart(px, limit_px, 2);
                write!(
                    f,
                    "{px} px remain between outline and edges, at most {limit_px} px are usual on this film: does it lie on other edges, as an inner rim, or is it the mirror image of the right pose (symmetry trap)?"
                )
            }
            Self::Open {
                turn_deg,
                shift_mm,
                other_px,
            } => write!(
                f,
                "another pose, {} away, fits as well ({} px), and nothing tells which is right",
                Away(turn_deg, shift_mm),
                Decimal::new(other_px, 2)
            ),
            Self::BesideDoubt => f.write_str(
                "continuity with the frames beside it decided, and those are doubtful themselves",
            ),
            Self::OffTheWay(Detour { deg, usual_deg }) => write!(
                f,
                "it does not go with the good frames beside it: through it the film would turn {}\u{b0} farther, where {}\u{b0} is usual: is it another pose, or the mask of another frame?",
                Decimal::new(deg, 0),
                Decimal::new(usual_deg, 0)
            ),
            Self::NoKnee { apart_deg } => write!(
                f,
                "its mediolateral axis is {}\u{b0} from the other component's, which no knee does: one of both poses or the axes of a model are wrong",
                Decimal::new(apart_deg, 0)
            ),
            Self::Mirrored(beside) => beside.fmt(f),
        }
    }
}

/// How far away another pose is, degrees and mm of the model's origin, as it is written: by its turn, and where that would be 0, by its shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Away(pub f64, pub f64);

impl Away {
    /// How far one pose is from another.
    #[must_use]
    pub fn between(one: &Pose, other: &Pose) -> Self {
        let shift = subtract(&one.translation, &other.translation);
        Self(geodesic_deg(&one.rotation, &other.rotation), norm(&shift))
    }
}

impl fmt::Display for Away {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(turn_deg, shift_mm) = *self;
        let (away, unit) = match turn_deg {
            ..0.5 => (shift_mm, "mm"),
            ..1.5 => (turn_deg, "degree"),
            _ => (turn_deg, "degrees"),
        };
        write!(f, "{} {unit}", Decimal::new(away, 0))
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::NoFit { misfit_px, met } = *self;
        let percent = Decimal::new(100.0 * met, 0);
        write!(
            f,
            "the outline does not fit this model from any side: {} px, and {percent} % of the model's outline is met; is it the other component's, another implant's, or mirrored?",
            Decimal::new(misfit_px, 1)
        )
    }
}

/// The pose that was chosen for a frame, why, and how far it is to be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// What was chosen among the candidates, and why; `index` counts in [`super::Found::candidates`].
    pub choice: Choice,
    /// How far that is to be trusted. Where it is [`Verdict::NoFit`], the chosen candidate is the best of those refused.
    pub verdict: Verdict,
}

/// Candidates as they are compared: one that does not fit at all comes last while another does, and is ruled out by it.
#[must_use]
pub fn contenders(candidates: &[Candidate]) -> Vec<RivalPose, CANDIDATES> {
    let fits = |candidate: &Candidate| refusal(&candidate.fit, &Limits::USUAL).is_none();
    let any = candidates.iter().any(fits);
    let rival = |candidate: &Candidate| match any && !fits(candidate) {
        true => RivalPose {
            residual_px: f64::INFINITY,
            ..candidate.rival()
        },
        false => candidate.rival(),
    };
    first_of(candidates.iter().map(rival))
}

/// How far a choice among candidates is to be trusted. `None` where it is none of theirs.
#[must_use]
pub fn judge(candidates: &[Candidate], choice: &Choice, limits: &Limits) -> Option<Verdict> {
    let chosen = candidates.get(choice.index)?;
    let open = choice.open.and_then(|OpenRival { index, .. }| {
        let other = candidates.get(index)?;
        is_another(chosen, other).then(|| Doubt::open(&chosen.pose, &other.pose, other.misfit()))
    });
    let alone = judge_one(candidates, choice.index, limits)?;
    Some(alone.or_doubt(Doubt::no_knee(choice)).or_doubt(open))
}

/// Whether two poses are two: what the plus-minus of the chosen one holds is said with that, and is no reason to doubt it.
fn is_another(chosen: &Candidate, other: &Candidate) -> bool {
    let depths = [chosen, other].map(|one| one.fit.depth_mm);
    let Some(covariance) = chosen.covariance.filter(|_| !depths.contains(&0.0)) else {
        return true;
    };
    let turn = geodesic_deg(&chosen.pose.rotation, &other.pose.rotation);
    covariance.tells_apart(turn, depths[1] - depths[0])
}

/// The same before anything is chosen: how far one of the candidates is to be trusted at most. `None` where there are not so many.
#[must_use]
pub fn judge_one(candidates: &[Candidate], index: usize, limits: &Limits) -> Option<Verdict> {
    let one = candidates.get(index)?;
    let determined = one.refined.is_none() || is_determined(one.covariance.as_ref());
    let alone = judge_fit(&one.fit, determined, limits);
    let other = other_of_a_part(candidates, index).and_then(|other| candidates.get(other));
    Some(alone.or_doubt(other.map(|other| Doubt::open(&one.pose, &other.pose, other.misfit()))))
}

/// Where an end of the component is beyond the frame, the best of the other poses that the residual does not rule out: tilt and film tell the
/// right pose only where it is among the candidates, and to that of a cut outline often none leads. A pose that is turned as in no knee is none of
/// these: the joint rules it out by far more than a tilt.
fn other_of_a_part(candidates: &[Candidate], chosen: usize) -> Option<usize> {
    let own = candidates.get(chosen)?;
    if own.fit.beyond <= BEYOND {
        return None;
    }
    let is_alike = |other: &Candidate| {
        let turn = geodesic_deg(&other.pose.rotation, &own.pose.rotation);
        (OTHER_DEG..KNEE_DEG).contains(&turn) && other.misfit() < DECISIVE_RATIO * own.misfit()
    };
    let mut others = candidates.iter().enumerate();
    others.find_map(|(index, other)| (index != chosen && is_alike(other)).then_some(index))
}

/// Whether what was seen determines a refined pose: its uncertainty is known, and its rotation better than [`OTHER_DEG`] (one standard
/// deviation). Of a part that is round it never is.
#[must_use]
pub fn is_determined(covariance: Option<&PoseCovariance>) -> bool {
    covariance.is_some_and(|of| of.rotation_deg() < OTHER_DEG)
}

/// How far a pose is to be trusted by itself, whatever other poses do; `determined` where what was seen determines it
/// ([`is_determined`]), or that was not asked.
#[must_use]
pub fn judge_fit(fit: &Fit, determined: bool, limits: &Limits) -> Verdict {
    if let Some(refusal) = refusal(fit, limits) {
        return Verdict::NoFit(refusal);
    }
    let undetermined = (!determined).then_some(Doubt::Undetermined);
    let doubt = doubt_of_fit(fit, limits).or(undetermined);
    doubt.map_or(Verdict::Good, Verdict::Doubtful)
}

fn refusal(fit: &Fit, limits: &Limits) -> Option<Refusal> {
    (fit.met < limits.least_met).then_some(Refusal::NoFit {
        misfit_px: fit.misfit_px,
        met: fit.met,
    })
}

fn doubt_of_fit(fit: &Fit, limits: &Limits) -> Option<Doubt> {
    let side = fit.square_px.max(1) as f64;
    let limit_px = (side * limits.good_px).min(limits.good_part * fit.size_px);
    if fit.implausible_width_mm > 0.0 {
        let mm = fit.implausible_width_mm;
        return Some(Doubt::ImplausibleSize { mm });
    }
    if fit.behind_mm > 0.0 {
        let mm = fit.behind_mm;
        return Some(Doubt::Behind { mm });
    }
    if fit.size_px < side * limits.good_size_px {
        return Some(Doubt::Small { px: fit.size_px });
    }
    if fit.seen() < limits.good_known || 1.0 - fit.beyond < limits.good_in_frame {
        return Some(Doubt::Unknown { known: fit.seen() });
    }
    if fit.met < limits.good_met {
        return Some(Doubt::Unmet {
            part: 1.0 - fit.met,
            within_px: side * MET_WITHIN_PX,
        });
    }
    let apart = |px: f64, limit_px: f64| (px > limit_px).then_some(Doubt::Apart { px, limit_px });
    let between = fit
        .apart_px
        .and_then(|px| apart(px, side * limits.good_apart_px));
    apart(fit.misfit_px, limit_px).or(between)
}

#[cfg(test)]
mod tests;

//! How far a chosen pose is to be trusted: good, doubtful, or no fit at all.
//!
//! A verdict looks at what residuals alone do not tell: how much of the model's outline has a counterpart, whether the two
//! outlines enclose the same pixels, whether the outline determines the pose, and whether another pose fits as well.
//! The limits are pixels where a hand or a network sets them, and parts of the silhouette's size where its shape does: the
//! outline of another implant of 300 pixels fits worse, in pixels, than that of one of 50.

use core::fmt;

use heapless::Vec;

use super::candidate::{CANDIDATES, Candidate};
use super::choice::{Choice, OpenRival, RivalPose};
use crate::joint::beside::Beside;
use crate::math::{Decimal, norm, subtract};
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
    /// Least size of a good fit's silhouette, pixels ([`Fit::size_px`]): to a few pixels any outline fits, from some distance.
    pub good_size_px: f64,
    /// Least part of the known outline that is met at any pose.
    pub least_met: f64,
}

impl Limits {
    /// The usual ones, of `cargo xtask synthetic --refusal`: outlines of the right model with a hand's jitter of 1 px and up
    /// to a fifth hidden, against outlines of other implants, ellipses, hulls, blobs and outlines cut off.
    pub const USUAL: Self = Self {
        good_px: 2.0,
        good_part: 0.02,
        good_met: 0.9,
        good_apart_px: 1.5,
        good_known: 0.5,
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
    /// The outline does not determine the pose.
    Undetermined,
    /// On its film other poses leave less: it may lie on other edges, or on the wrong side of the mirror.
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
    /// That another pose than the chosen one fits as well, with its misfit in pixels.
    #[must_use]
    pub fn open(chosen: &Pose, other: &Pose, other_px: f64) -> Self {
        Self::Open {
            turn_deg: geodesic_deg(&chosen.rotation, &other.rotation),
            shift_mm: norm(&subtract(&chosen.translation, &other.translation)),
            other_px,
        }
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Unmet { part } => {
                let percent = Decimal::new(100.0 * part, 0);
                write!(
                    f,
                    "{percent} % of the model's outline has no counterpart within {} px: is a part hidden or cut off, or is it another implant?",
                    Decimal::brief(MET_WITHIN_PX)
                )
            }
            Self::Apart { px, limit_px } => {
                let [px, limit_px] = Decimal::told_apart(px, limit_px, 1);
                write!(
                    f,
                    "the outlines lie {px} px apart, those of a good fit at most {limit_px} px: trace again, or is it another size or implant?"
                )
            }
            Self::Behind { mm } => write!(
                f,
                "it would lie {} mm behind the detector: is the calibration of frames of another size, or the model in another unit?",
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
            Self::Unknown { known } => {
                let percent = Decimal::new(100.0 * known, 0);
                write!(f, "only {percent} % of the model's outline is known")
            }
            Self::Undetermined => f.write_str("the outline does not determine the pose"),
            Self::Unusual { px, limit_px } => {
                let [px, limit_px] = Decimal::told_apart(px, limit_px, 2);
                write!(
                    f,
                    "{px} px remain, on this film at most {limit_px} px are usual: does it lie on other edges, as an inner rim, or on the wrong side of the mirror?"
                )
            }
            Self::Open {
                turn_deg,
                shift_mm,
                other_px,
            } => {
                let (away, unit) = away(turn_deg, shift_mm);
                write!(
                    f,
                    "another pose, {away} {unit} away, fits as well ({} px), and nothing tells which is right",
                    Decimal::new(other_px, 2)
                )
            }
            Self::Mirrored(beside) => beside.fmt(f),
        }
    }
}

/// How far away another pose is, as it is written: by its turn, and where that would be 0, by its shift.
fn away(turn_deg: f64, shift_mm: f64) -> (Decimal, &'static str) {
    match turn_deg {
        ..0.5 => (Decimal::new(shift_mm, 0), "mm"),
        ..1.5 => (Decimal::new(turn_deg, 0), "degree"),
        _ => (Decimal::new(turn_deg, 0), "degrees"),
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
        Some(Doubt::open(&chosen.pose, &other.pose, other.misfit()))
    });
    let determined = chosen.refined.is_none() || chosen.covariance.is_some();
    Some(judge_fit(&chosen.fit, determined, limits).or_doubt(open))
}

/// How far a pose is to be trusted by itself, whatever other poses do; `determined` where its uncertainty is known, or was
/// not asked for.
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
    if fit.seen() < limits.good_known {
        return Some(Doubt::Unknown { known: fit.seen() });
    }
    if fit.met < limits.good_met {
        return Some(Doubt::Unmet {
            part: 1.0 - fit.met,
        });
    }
    let apart = |px: f64, limit_px: f64| (px > limit_px).then_some(Doubt::Apart { px, limit_px });
    let between = fit
        .apart_px
        .and_then(|px| apart(px, side * limits.good_apart_px));
    apart(fit.misfit_px, limit_px).or(between)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    #[test]
    fn one_degree_is_not_several_and_none_is_told_as_a_shift() {
        for (turn_deg, words) in [(0.4, "12 mm away"), (1.2, "1 degree "), (1.6, "2 degrees")] {
            let doubt = Doubt::Open {
                turn_deg,
                shift_mm: 12.0,
                other_px: 0.3,
            };
            assert!(doubt.to_string().contains(words), "{doubt}");
        }
    }
    #[test]
    fn what_has_few_pixels_is_no_good_fit() {
        let judged = |size_px: f64| {
            let fit = Fit {
                size_px,
                met: 1.0,
                known: 1.0,
                ..Fit::default()
            };
            judge_fit(&fit, true, &Limits::USUAL)
        };
        assert_eq!(judged(150.0), Verdict::Good);
        assert_eq!(judged(7.0), Verdict::Doubtful(Doubt::Small { px: 7.0 }));
    }

    #[test]
    fn what_is_asked_is_asked_in_the_squares_that_the_frame_was_looked_at_in() {
        let fit = |misfit_px, size_px| Fit {
            misfit_px,
            size_px,
            met: 1.0,
            known: 1.0,
            square_px: 1,
            ..Fit::default()
        };
        let judged = |fit: Fit, side| judge_fit(&fit.in_pixels(side), true, &Limits::USUAL);
        for side in [1, 2, 4] {
            assert_eq!(judged(fit(1.9, 150.0), side), Verdict::Good);
            let [px, limit_px] = [2.1, 2.0].map(|px| side as f64 * px);
            let apart = Doubt::Apart { px, limit_px };
            assert_eq!(judged(fit(2.1, 150.0), side), Verdict::Doubtful(apart));
            let small = Doubt::Small {
                px: side as f64 * 19.0,
            };
            assert_eq!(judged(fit(0.1, 19.0), side), Verdict::Doubtful(small));
        }
    }

    #[test]
    fn a_model_of_no_knees_size_is_never_good() {
        let judged = |implausible_width_mm: f64| {
            let fit = Fit {
                size_px: 150.0,
                met: 1.0,
                known: 1.0,
                behind_mm: 20.0,
                implausible_width_mm,
                ..Fit::default()
            };
            judge_fit(&fit, true, &Limits::USUAL).to_string()
        };
        assert!(judged(0.0).contains("behind the detector"));
        assert!(judged(7.93).contains("7.93 mm across"), "{}", judged(7.93));
    }

    #[test]
    fn what_lies_beyond_the_frame_is_not_known() {
        let judged = |beyond: f64| {
            let fit = Fit {
                size_px: 150.0,
                met: 1.0,
                known: 0.8,
                beyond,
                ..Fit::default()
            };
            judge_fit(&fit, true, &Limits::USUAL)
        };
        assert_eq!(judged(0.2), Verdict::Good);
        assert!(matches!(judged(0.5), Verdict::Doubtful(Doubt::Unknown { known }) if known == 0.4));
    }

    fn candidate(misfit_px: f64, met: f64) -> Candidate {
        let pose = crate::pose::Pose::IDENTITY;
        let mut refined = crate::refine::Refined::at(pose);
        refined.loss = misfit_px * misfit_px / 2.0;
        Candidate {
            pose,
            start: pose,
            located: None,
            refined: Some(refined),
            covariance: None,
            fit: Fit {
                size_px: 150.0,
                met,
                known: 1.0,
                misfit_px,
                ..Fit::default()
            },
        }
    }

    #[test]
    fn a_refined_pose_without_a_covariance_is_undetermined_and_another_that_fits_leaves_it_open() {
        let judged = |change: fn(&mut Candidate), open: Option<usize>| {
            let mut all = [candidate(0.1, 1.0), candidate(0.2, 1.0)];
            change(&mut all[0]);
            all[1].pose.rotation = crate::math::rotation_by(&[0.0, crate::math::radians(9.0), 0.0]);
            let open = open.map(|index| OpenRival {
                index,
                chosen_px: 0.1,
                other_px: 0.2,
            });
            let reason = super::super::choice::Reason::Only;
            let choice = Choice {
                index: 0,
                reason,
                open,
            };
            judge(&all, &choice, &Limits::USUAL).map(|verdict| match verdict {
                Verdict::Doubtful(Doubt::Open {
                    turn_deg, other_px, ..
                }) => (libm::round(turn_deg), other_px > 0.19),
                Verdict::Doubtful(Doubt::Undetermined) => (-1.0, false),
                Verdict::Good => (0.0, false),
                other => panic!("{other}"),
            })
        };
        let known = |one: &mut Candidate| {
            let mut information = [[0.0; 6]; 6];
            (0..6).for_each(|k| information[k][k] = 1e6);
            one.covariance =
                crate::pose::covariance::PoseCovariance::from_information(&information);
        };
        assert_eq!(judged(|_| {}, None), Some((-1.0, false)));
        assert_eq!(judged(known, None), Some((0.0, false)));
        assert_eq!(judged(|one| one.refined = None, None), Some((0.0, false)));
        assert_eq!(judged(known, Some(1)), Some((9.0, true)));
        assert_eq!(judged(known, Some(7)), Some((0.0, false)));
        let none = Choice {
            index: 3,
            reason: super::super::choice::Reason::Only,
            open: None,
        };
        assert_eq!(judge(&[candidate(0.1, 1.0)], &none, &Limits::USUAL), None);
    }

    #[test]
    fn what_does_not_fit_at_all_is_no_rival_while_another_does() {
        let misfits = |mets: [f64; 2]| {
            let all = mets.map(|met| candidate(0.5, met));
            let rivals = contenders(&all);
            [0, 1].map(|k| rivals[k].residual_px.is_finite())
        };
        let least = Limits::USUAL.least_met;
        assert_eq!(misfits([least, least]), [true; 2]);
        assert_eq!(misfits([least, least - 0.01]), [true, false]);
        assert_eq!(misfits([least - 0.01, least]), [false, true]);
        assert_eq!(misfits([least - 0.01, least - 0.02]), [true; 2]);
    }

    #[test]
    fn parts_of_an_outline_are_told_in_percent() {
        let unknown = Doubt::Unknown { known: 0.4 }.to_string();
        assert!(unknown.contains("only 40 % of"), "{unknown}");
        let refused = Refusal::NoFit {
            misfit_px: 3.21,
            met: 0.25,
        };
        let refused = refused.to_string();
        assert!(refused.contains("3.2 px, and 25 % of"), "{refused}");
    }
}

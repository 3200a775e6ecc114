//! The table of a study: errors of each component, source and method.

use fluoropose::pose::Pose;
use serde::Serialize;

use crate::choice::{Decision, Reasons};
use crate::measure::accuracy::{Errors, rms};
use crate::measure::bound::Comparison;

use super::inside::Inside;

/// The table of a study.
#[derive(Debug, Serialize)]
pub struct Table {
    /// Name of the study.
    pub study: String,
    /// A row for each component, source and method.
    pub rows: Vec<Row>,
}

/// One row: errors of one method on one source.
#[derive(Debug, Serialize)]
pub struct Row {
    /// Name of the component.
    pub component: String,
    /// Name of the mask source, or of the other method's pose file.
    pub source: String,
    /// The method's word, or `peer` for another method's file.
    pub method: String,
    /// Number of frames.
    pub frames: usize,
    /// Frames without a pose; errors are those of the others.
    pub not_found: usize,
    /// Frames of which no reference pose is known.
    pub no_reference: usize,
    /// Root mean square errors.
    pub rms: Errors,
    /// Mean errors, with their signs; of the geodesic angle, which has none, its mean.
    pub bias: Errors,
    /// Median absolute errors.
    pub median: Errors,
    /// Of poses found here that say how sure they are: the part of frames in which each number lies within one and two standard
    /// deviations of the reference's. 68 and 95 % would be right.
    pub inside: Option<Inside>,
    /// Frames nearer to the reference's mirror image than to the reference.
    pub wrong_side: usize,
    /// Of poses found here: how far they are to be trusted.
    #[serde(flatten)]
    pub verdicts: Option<Verdicts>,
    /// Of poses found here: by what they were chosen.
    pub reasons: Option<Reasons>,
    /// Source of the femoral poses that were known when these were chosen.
    pub femur: Option<String>,
    /// Of the method `image`: what is known of the film, in words.
    pub film: Option<String>,
    /// Of the method `image`: how much the start matters.
    pub from_reference: Option<StartDifference>,
    /// Of poses found here: the limits at the reference poses, and the root mean square errors
    /// against them.
    pub limits: Option<Comparison>,
}

/// How many frames have which verdict.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Verdicts {
    /// Poses to be relied on.
    pub good: usize,
    /// Poses that may be wrong.
    pub doubtful: usize,
    /// Frames without a pose.
    pub none: usize,
}

impl Verdicts {
    pub(super) fn of(decisions: &[Option<Decision>]) -> Self {
        let mut counts = Self::default();
        for decision in decisions {
            let word = decision.map_or("none", |decision| decision.verdict.word());
            *match word {
                "good" => &mut counts.good,
                "doubtful" => &mut counts.doubtful,
                _ => &mut counts.none,
            } += 1;
        }
        counts
    }
}

/// How far poses that were found differ from what refinement finds from the reference poses.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct StartDifference {
    /// Frames in which both were found.
    pub frames: usize,
    /// Root mean square.
    pub rms: Errors,
    /// Largest magnitude in each column.
    pub largest: Errors,
}

impl StartDifference {
    /// Poses that were chosen against those that refinement found from the reference poses.
    pub(super) fn of(chosen: &[Option<Pose>], from_reference: &[Option<Pose>]) -> Self {
        let both = chosen.iter().zip(from_reference);
        let differences: Vec<Errors> = both
            .filter_map(|(chosen, other)| Some(Errors::of(&(*chosen)?, &(*other)?)))
            .collect();
        let largest = |values: &[f64]| values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        Self {
            frames: differences.len(),
            rms: Errors::summarise(&differences, rms),
            largest: Errors::summarise(&differences, largest),
        }
    }
}

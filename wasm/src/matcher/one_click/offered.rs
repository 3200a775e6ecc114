//! Which of the answers to a click are offered.

use fluoropose::camera::calibration::Calibration;
use fluoropose::finder::choice::RivalPose as Contender;
use fluoropose::math::Vector3;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose_tracing::one_click::Answer;

use super::super::on_frame::{OnFrame, misfit};
use super::super::{OFFERED, RIVAL_WITHIN};
use crate::choice::Chosen;
use crate::uncertainty::tells_apart;

/// An answer whose edges are weaker than this part of the best's is no rival.
const RIVAL_STRENGTH: f64 = 0.75;

/// The answers that lie before the detector and not within the tube; all of them where none does, which their verdicts say.
pub(super) fn possible<'a>(
    all: &'a [Answer],
    calibration: &Calibration,
    middle: &Vector3,
) -> Vec<&'a Answer> {
    let may_be = |answer: &&Answer| calibration.may_be_at(&answer.refined.pose, middle);
    let possible: Vec<_> = all.iter().filter(may_be).collect();
    match possible.is_empty() {
        true => all.iter().collect(),
        false => possible,
    }
}

/// Those whose edges are about as strong as the best's.
pub(super) fn rivals<'a>(answers: &[&'a Answer]) -> impl Iterator<Item = &'a Answer> {
    let strongest = answers.first().map_or(0.0, |best| best.score);
    let is_rival = move |answer: &&Answer| answer.score >= RIVAL_STRENGTH * strongest;
    answers.iter().copied().filter(is_rival)
}

/// Whether a pose is open that is another than the chosen one, by the `covariance` of that.
pub(super) fn is_open(
    answers: &[OnFrame],
    chosen: &Chosen,
    covariance: Option<&PoseCovariance>,
    middle: &Vector3,
) -> bool {
    chosen.open().is_some_and(|open| {
        let poses = [chosen.index(), open].map(|at| &answers[at].refined.pose);
        covariance.is_none_or(|of| tells_apart(of, poses, middle))
    })
}

pub(super) fn contender(one: &OnFrame) -> Contender {
    Contender {
        pose: one.refined.pose,
        residual_px: misfit(&one.refined),
    }
}

/// Numbers of the answers that are offered: the chosen one, the rival that is still open, and others that come near.
pub(super) fn offered(answers: &[OnFrame], chosen: &Chosen) -> Vec<usize> {
    let misfit = |at: usize| misfit(&answers[at].refined);
    let least = (0..answers.len()).map(misfit).fold(f64::MAX, f64::min);
    let first = [chosen.index()].into_iter().chain(chosen.open());
    let near = (0..answers.len()).filter(|&at| misfit(at) <= RIVAL_WITHIN * least);
    let mut places: Vec<usize> = Vec::new();
    for place in first.chain(near) {
        if place < answers.len() && places.len() < OFFERED && !places.contains(&place) {
            places.push(place);
        }
    }
    places
}

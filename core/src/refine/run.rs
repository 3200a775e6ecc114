//! A start refined, at once or in slices, and a pose corrected.

use core::future::Future;
use core::task::{Poll, ready};

use super::error::RefineError;
use super::memory::RefineMemory;
use super::options::RefineOptions;
use super::problem::Problem;
use super::refinement::Refinement;
use super::result::{Iterate, Refined};
use super::stages::{Pass, STAGES};
use super::unless::{Ended, Unless};
use super::view::CameraView;
use crate::mesh::Model;
use crate::pace::{Pace, in_slices, to_the_end};
use crate::pose::Pose;

/// Refines `start` until the model's outline lies on those of `views`. `start` is `world_from_model`; with a single
/// camera, `camera_from_model`. A start may be some 10 degrees, 5 mm sideways and 50 mm of depth off.
///
/// Draws the model at most 130 times in each view, usually 8 to 20 times. By the loss of the last stage the result is
/// never worse than `start`, up to what drawing in whole pixels leaves unknown.
///
/// # Errors
/// [`RefineError`].
pub fn refine(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    start: &Pose,
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
) -> Result<Refined, RefineError> {
    refine_traced(model, views, start, options, memory, &mut |_| ())
}

/// The same in slices, a drawing each ([`crate::pace`]); correction by a film is one of them.
///
/// # Errors
/// [`RefineError`].
pub fn refine_paced(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    start: &Pose,
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
    pace: &Pace,
) -> impl Future<Output = Result<Refined, RefineError>> {
    let mut refinement = Refinement::new(start);
    in_slices(pace, move || {
        let seen = (model, views);
        ready!(refinement.go_on(seen, options, &|_| false, memory, &mut |_| ()))?;
        Poll::Ready(Ok(refinement.state))
    })
}

/// As [`refine`]; calls `trace` with the start and with every pose that is accepted on the way.
///
/// # Errors
/// [`RefineError`].
pub fn refine_traced(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    start: &Pose,
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
    trace: &mut dyn FnMut(&Iterate),
) -> Result<Refined, RefineError> {
    let mut refinement = Refinement::new(start);
    let seen = (model, views);
    to_the_end(|| refinement.go_on(seen, options, &|_| false, memory, trace))?;
    Ok(refinement.state)
}

/// Brings a pose that was refined on frames whose film was not known to where its edges are put by the films of `views`: what
/// [`refine`] does at its end where it is known from the beginning.
///
/// # Errors
/// [`RefineError`].
pub fn correct(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    refined: &Refined,
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
) -> Result<Refined, RefineError> {
    let corrected = correct_unless(Unless::NOTHING, model, views, refined, options, memory);
    corrected.map(|(refined, _)| refined)
}

/// As [`correct`], but given up on the way where nothing hangs on its end; also gives how it ended.
///
/// # Errors
/// [`RefineError`].
pub(crate) fn correct_unless(
    unless: Unless<'_>,
    model: &Model<'_>,
    views: &[CameraView<'_>],
    refined: &Refined,
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
) -> Result<(Refined, Ended), RefineError> {
    let mut problem = Problem::new(model, views, memory)?;
    problem.hold(options.locks, &refined.pose);
    (problem.effort, problem.unless) = (options.effort, unless);
    let (mut state, mut ended) = (*refined, Ended::Itself);
    if problem.has_film() {
        let pass = Pass {
            index: STAGES - 1,
            sigma_px: refined.robust_sigma_px,
            drawn: true,
            ..Pass::default()
        };
        ended = problem.correct(&pass, &mut state, memory, &mut |_| ())?;
    }
    Ok((state, ended))
}

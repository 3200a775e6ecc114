//! All stages, one after the other.

use super::effort::Effort;
use super::error::RefineError;
use super::memory::RefineMemory;
use super::options::RefineOptions;
use super::problem::{Problem, Seen};
use super::result::{Iterate, Refined};
use super::stages::{Pass, STAGES};
use super::view::CameraView;
use crate::mesh::Model;
use crate::pace::{Pace, at_once};
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
pub async fn refine_paced(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    start: &Pose,
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
    pace: &Pace,
) -> Result<Refined, RefineError> {
    let mut problem = Problem::refining(model, views, start, options, memory)?;
    problem.pace = Some(pace);
    let mut state = Refined::at(*start);
    go(
        &problem,
        Part::All,
        options,
        &mut state,
        memory,
        &mut |_| (),
    )
    .await?;
    Ok(state)
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
    let problem = Problem::refining(model, views, start, options, memory)?;
    let mut state = Refined::at(*start);
    let work = go(&problem, Part::All, options, &mut state, memory, trace);
    at_once(&Pace::new(), work)?;
    Ok(state)
}

/// How much of the way is gone.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    All,
    /// The first stage: where a start leads. The loss is that stage's.
    First,
    /// All stages but the first, which was gone before.
    Rest,
}

/// A part of [`refine_paced`]'s way from where `begun` is; `None` as soon as a pose is reached from which it is `known` where
/// that leads.
///
/// # Errors
/// [`RefineError`].
pub(crate) async fn refine_unless(
    (model, views): (&Model<'_>, &[CameraView<'_>]),
    begun: &Refined,
    part: Part,
    options: RefineOptions,
    known: &dyn Fn(&Pose) -> bool,
    memory: &mut RefineMemory<'_>,
    pace: &Pace,
) -> Result<Option<Refined>, RefineError> {
    let mut problem = Problem::refining(model, views, &begun.pose, options, memory)?;
    (problem.known, problem.pace) = (Some(known), Some(pace));
    let mut state = *begun;
    go(&problem, part, options, &mut state, memory, &mut |_| ()).await?;
    Ok((!problem.is_known(&state.pose)).then_some(state))
}

/// A part of the stages.
async fn go(
    problem: &Problem<'_>,
    part: Part,
    options: RefineOptions,
    state: &mut Refined,
    memory: &mut RefineMemory<'_>,
    trace: &mut dyn FnMut(&Iterate),
) -> Result<(), RefineError> {
    let seen = &mut Seen::new();
    let mut pass = problem.first_pass();
    let drawn = pass.drawn;
    if part != Part::Rest {
        problem.run(&pass, state, seen, memory, trace).await?;
    }
    if part == Part::First {
        return Ok(());
    }
    for index in 1..STAGES {
        if problem.is_known(&state.pose) {
            return Ok(());
        }
        pass = Pass {
            index,
            sigma_px: state.robust_sigma_px,
            drawn,
            ..Pass::default()
        };
        // An outline is weighed again, a frame would be looked at again.
        if !drawn || problem.steps(&pass) > 0 {
            problem.run(&pass, state, seen, memory, trace).await?;
        }
    }
    if problem.is_known(&state.pose) {
        return Ok(());
    }
    if !problem.has_film() {
        problem.polish(&pass, state, seen, memory, trace).await?;
    } else if options.effort != Effort::Probe {
        problem.correct(&pass, state, memory, trace)?;
    }
    if options.edge_offset {
        pass.free = true;
        let mut with_offset = *state;
        seen.forget();
        problem
            .run(&pass, &mut with_offset, seen, memory, trace)
            .await?;
        problem
            .polish(&pass, &mut with_offset, seen, memory, trace)
            .await?;
        if problem.supports_offset(&pass, &with_offset, memory)? {
            *state = with_offset;
        } else {
            state.renders = with_offset.renders;
        }
    }
    Ok(())
}

/// A quick look at where `start` leads, by [`Effort::Probe`]; `None` as soon as a pose is reached from which that is `known`.
///
/// # Errors
/// [`RefineError`].
pub(crate) async fn probe(
    model: &Model<'_>,
    views: &[CameraView<'_>],
    start: &Pose,
    options: RefineOptions,
    known: &dyn Fn(&Pose) -> bool,
    memory: &mut RefineMemory<'_>,
    pace: &Pace,
) -> Result<Option<Refined>, RefineError> {
    let mut problem = Problem::new(model, views, memory)?;
    problem.hold(options.locks, start);
    problem.effort = Effort::Probe;
    (problem.known, problem.pace) = (Some(known), Some(pace));
    let (mut state, mut seen) = (Refined::at(*start), Seen::new());
    for index in 0..STAGES {
        let pass = Pass {
            index,
            sigma_px: state.robust_sigma_px,
            ..Pass::default()
        };
        problem
            .run(&pass, &mut state, &mut seen, memory, &mut |_| ())
            .await?;
        if problem.is_known(&state.pose) {
            return Ok(None);
        }
    }
    Ok(Some(state))
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
    correct_unless(f64::INFINITY, model, views, refined, options, memory)
}

/// As [`correct`], but given up on the way where a loss is so large that it is not likely to fall below `hopeless`, square pixels.
///
/// # Errors
/// [`RefineError`].
pub(crate) fn correct_unless(
    hopeless: f64,
    model: &Model<'_>,
    views: &[CameraView<'_>],
    refined: &Refined,
    options: RefineOptions,
    memory: &mut RefineMemory<'_>,
) -> Result<Refined, RefineError> {
    let mut problem = Problem::new(model, views, memory)?;
    problem.hold(options.locks, &refined.pose);
    problem.effort = options.effort;
    problem.hopeless = hopeless;
    let mut state = *refined;
    if problem.has_film() {
        let pass = Pass {
            index: STAGES - 1,
            sigma_px: refined.robust_sigma_px,
            drawn: true,
            ..Pass::default()
        };
        problem.correct(&pass, &mut state, memory, &mut |_| ())?;
    }
    Ok(state)
}

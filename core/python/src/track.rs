//! Both components of a film, followed.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::Result;
use fluoropose::refine::Polarity;
use fluoropose_laboratory::files::{Uncertain, covariances_beside, read_covariances, read_text};
use fluoropose_laboratory::progress::Stop;
use fluoropose_laboratory::verbs::track::{Click, Fixed, Listener, Request, Row, Told, Tracked};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::poses::{NOTHING, array_of, poses_of, six, six_deviations};
use crate::worker::beside_telling;

/// A click: component, frame from 0, column and row; what it is called.
type ClickGiven = (String, usize, f64, f64, String);

/// Fixed poses: component, rows; what they are called.
type FixedGiven<'py> = (String, PyReadonlyArray2<'py, f64>, String);

/// What a run told and nobody has heard yet.
#[derive(Default)]
struct Untold {
    remarks: Vec<String>,
    steps: Vec<(usize, usize, String)>,
}

/// Follows the components of a study; a dictionary for each, in the study's order. `remark` is called with every sentence that has to
/// be known, and `progress` with every step: what is done, of how much, and in words.
#[pyfunction]
#[pyo3(signature = (study, out, *, clicks, fixed, bright, interpolate, anew, remark, progress))]
#[allow(clippy::too_many_arguments, reason = "Python names each of them")]
pub(crate) fn track<'py>(
    py: Python<'py>,
    study: PathBuf,
    out: PathBuf,
    clicks: Vec<ClickGiven>,
    fixed: Vec<FixedGiven<'py>>,
    bright: Option<bool>,
    interpolate: usize,
    anew: bool,
    remark: Bound<'py, PyAny>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyList>> {
    let stop = Stop::default();
    let click = |(component, frame, column, row, called)| Click {
        component,
        frame,
        place: [column, row],
        called,
    };
    let fixed = fixed.iter().map(|(component, rows, called)| Fixed {
        component: component.clone(),
        poses: poses_of(rows),
        called: called.clone(),
    });
    let untold = Arc::new(Mutex::new(Untold::default()));
    let request = Request {
        study,
        out: out.clone(),
        clicks: clicks.into_iter().map(click).collect(),
        fixed: fixed.collect(),
        polarity: bright.map(Polarity::of),
        interpolate,
        anew,
        listener: listener(&untold),
        stop: stop.clone(),
    };
    let hear = |_: Python<'_>| hear(&untold, &remark, progress.as_ref());
    let found = beside_telling(py, &stop, hear, move || {
        let tracked = fluoropose_laboratory::verbs::track::track(&request)?;
        let covariances = tracked.iter().map(|part| of(&out, &part.component));
        let covariances = covariances.collect::<Result<Vec<_>>>()?;
        Ok((tracked, covariances))
    });
    let (tracked, covariances) = found?;
    let parts = PyList::empty(py);
    for (part, covariances) in tracked.iter().zip(&covariances) {
        parts.append(component(py, part, covariances)?)?;
    }
    Ok(parts)
}

/// Calls Python with what a run has told since.
fn hear(
    untold: &Mutex<Untold>,
    remark: &Bound<'_, PyAny>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<()> {
    let news = std::mem::take(&mut *untold.lock().unwrap_or_else(PoisonError::into_inner));
    for sentence in news.remarks {
        remark.call1((sentence,))?;
    }
    for step in news.steps {
        if let Some(progress) = progress {
            progress.call1(step)?;
        }
    }
    Ok(())
}

/// Notes what a run tells.
fn listener(untold: &Arc<Mutex<Untold>>) -> Listener {
    let untold = untold.clone();
    Arc::new(move |told| {
        let mut untold = untold.lock().unwrap_or_else(PoisonError::into_inner);
        match told {
            Told::Remark(remark) => untold.remarks.push(remark),
            Told::Taken(_) => {}
            Told::Step { what, done, of } => untold.steps.push((done, of, what)),
        }
    })
}

/// The covariances that were written of a component.
fn of(out: &Path, component: &str) -> Result<BTreeMap<usize, Uncertain>> {
    let poses = out.join(format!("{component}.jts"));
    read_covariances(&read_text(&covariances_beside(&poses))?)
}

fn component<'py>(
    py: Python<'py>,
    part: &Tracked,
    covariances: &BTreeMap<usize, Uncertain>,
) -> PyResult<Bound<'py, PyDict>> {
    let answer = PyDict::new(py);
    let rows = &part.rows;
    let poses = rows.iter().map(|row| row.pose.map_or(NOTHING, six));
    let deviations = rows
        .iter()
        .map(|row| row.sd.map_or(NOTHING, six_deviations));
    let covariance = |frame| {
        let known = covariances.get(&frame);
        known.map_or(vec![f64::NAN; 36], |known| {
            known.covariance.matrix.as_flattened().to_vec()
        })
    };
    let steps = |frame| {
        let known = covariances.get(&frame).and_then(|known| known.film_steps);
        known.map_or(vec![f64::NAN; 12], |known| known.as_flattened().to_vec())
    };
    let film_steps: Vec<f64> = (0..rows.len()).flat_map(steps).collect();
    let covariances: Vec<f64> = (0..rows.len()).flat_map(covariance).collect();
    answer.set_item("name", &part.component)?;
    answer.set_item("pose", array_of(py, poses.collect())?)?;
    answer.set_item("sd", array_of(py, deviations.collect())?)?;
    answer.set_item("covariance", covariances)?;
    answer.set_item("film_steps", film_steps)?;
    answer.set_item(
        "state",
        rows.iter().map(|row| row.state.word()).collect::<Vec<_>>(),
    )?;
    answer.set_item("verdict", rows.iter().map(Row::verdict).collect::<Vec<_>>())?;
    answer.set_item(
        "because",
        rows.iter()
            .map(|row| row.because.as_str())
            .collect::<Vec<_>>(),
    )?;
    answer.set_item(
        "misfit_px",
        rows.iter().map(|row| row.misfit_px).collect::<Vec<_>>(),
    )?;
    answer.set_item(
        "badness",
        rows.iter().map(|row| row.badness).collect::<Vec<_>>(),
    )?;
    Ok(answer)
}

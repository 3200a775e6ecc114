//! Films followed, both components on all cores.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result};

use super::row::{Row, timed};
use crate::files::{Component, Study, read_poses};
use crate::progress::{Stop, announce};
use crate::verbs::track::{Fixed, Request, Tracked, track};

const STUDIES: [&str; 2] = ["left8", "film70"];

/// Two rows for each study: from nothing, and from one frame whose poses are known.
pub(super) fn measure(studies: &Path, work: &Path) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for name in STUDIES {
        let study = studies.join(name).join("study.toml");
        let folder = work.join("followed").join(name);
        let known = known_in_the_middle(&study)?;
        for (fixed, from) in [(Vec::new(), "nothing"), (known, "one frame")] {
            announce(&format!("{name}, followed from {from}"));
            let request = Request {
                study: study.clone(),
                out: folder.join(from.replace(' ', "-")),
                clicks: Vec::new(),
                fixed,
                polarity: None,
                interpolate: 0,
                anew: true,
                listener: Arc::new(|_| ()),
                stop: Stop::default(),
            };
            let (ms, tracked) = timed(|| track(&request));
            let frames = tracked?.first().map_or(0, frames_of);
            let threads = rayon::current_num_threads();
            let what = format!(
                "{name} followed from {from}: a frame of {frames}, both components, {threads} threads"
            );
            rows.push(Row::new(&what, ms / frames as f64, "none", None));
        }
    }
    Ok(rows)
}

fn frames_of(component: &Tracked) -> usize {
    component.rows.len()
}

/// The reference poses of a film's middle frame, as a person would have fixed them.
fn known_in_the_middle(study: &Path) -> Result<Vec<Fixed>> {
    let study = Study::read(study)?;
    let one = |component: &Component| -> Result<Fixed> {
        let reference = component.reference.as_ref().context("no reference")?;
        let mut poses = read_poses(reference)?;
        let middle = poses.len() / 2;
        for (frame, pose) in poses.iter_mut().enumerate() {
            *pose = pose.filter(|_| frame == middle);
        }
        Ok(Fixed {
            component: component.name.clone(),
            poses,
            called: reference.display().to_string(),
        })
    };
    study.components.iter().map(one).collect()
}

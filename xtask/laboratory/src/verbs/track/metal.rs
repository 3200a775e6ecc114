//! How a film shows metal: darker or brighter than what surrounds it.

use anyhow::Result;
use fluoropose::follow::Anchor;
use fluoropose::refine::{Polarity, polarity_at, polarity_near};
use rayon::prelude::*;

use super::anchors::{begin, begin_beside, fixed_poses};
use super::part::Part;
use super::run::Run;
use crate::files::grey;
use crate::options::most;

/// So many fixed poses of a component are asked at most.
const VOTES: usize = 3;

/// The components, and the frames that each is followed from. Where nobody says how the film shows metal, and nothing is pointed
/// at that would tell it, metal is looked for as fluoroscopes show it, dark, and where that does not show all components the other
/// way too: what is found better counts, for a bright thing beside dark ones may be taken for a component.
pub(super) fn begun<'s>(
    run: &Run<'_>,
    parts: impl Fn(Polarity) -> Result<Vec<Part<'s>>>,
) -> Result<(Vec<Part<'s>>, Vec<Vec<Anchor>>)> {
    let begin_all = |parts: &[Part<'s>]| -> Result<Vec<Vec<Anchor>>> {
        let alone = parts.par_iter().map(|part| begin(run, part));
        let alone = alone.collect::<Result<Vec<_>>>()?;
        let one = |(part, found): (&Part<'s>, &Vec<Anchor>)| {
            if !found.is_empty() {
                return Ok(found.clone());
            }
            let others = parts.iter().zip(&alone);
            let others = others.map(|(other, anchors)| (other, anchors.as_slice()));
            begin_beside(run, part, &others.collect::<Vec<_>>())
        };
        parts.iter().zip(&alone).map(one).collect()
    };
    let told = match run.request.polarity {
        Some(stated) => Some(stated),
        None => told_by_what_is_given(run, &parts(Polarity::default())?)?,
    };
    let dark = parts(told.unwrap_or_default())?;
    let anchors = begin_all(&dark)?;
    if told.is_some() || anchors.iter().all(|anchors| !anchors.is_empty()) {
        return Ok((dark, anchors));
    }
    let bright = parts(Polarity::BrightImplant)?;
    let others = begin_all(&bright)?;
    Ok(if score(&others) > score(&anchors) {
        (bright, others)
    } else {
        (dark, anchors)
    })
}

/// How well components are found in all: the sum of what the best frame of each scores.
fn score(anchors: &[Vec<Anchor>]) -> f64 {
    let scores = |anchors: &Vec<Anchor>| {
        let each = anchors.iter().map(|anchor| anchor.found.score());
        each.fold(0.0, f64::max)
    };
    anchors.iter().map(scores).sum()
}

/// How the film shows metal, by clicks and fixed poses.
fn told_by_what_is_given(run: &Run<'_>, parts: &[Part<'_>]) -> Result<Option<Polarity>> {
    let mut votes = Vec::new();
    for click in &run.request.clicks {
        // Whether there is such a frame is told where the click is used.
        if let Ok(decoded) = run.film.frame(click.frame) {
            votes.push(polarity_near(&*grey(&decoded)?, click.place));
        }
    }
    for part in parts {
        for (frame, pose) in fixed_poses(run, part)?.into_iter().take(VOTES) {
            let told = part.see(run.film, frame, |subject, image, memory| {
                polarity_at(subject.model, subject.camera, &pose, image.frame, memory)
            })?;
            // A pose that cannot be drawn is told where it is used.
            votes.extend(told.ok());
        }
    }
    Ok(most(votes))
}

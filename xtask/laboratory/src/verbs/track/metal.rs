//! How a film shows metal: darker or brighter than what surrounds it.

use anyhow::Result;
use fluoropose::follow::{Anchor, frames_to_search};
use fluoropose::refine::{Polarity, polarity_at, polarity_near};
use rayon::prelude::*;

use super::anchors::{fixed_poses, found_in, given};
use super::part::Part;
use super::partner::{begin_beside, begin_in_joint, or_in_joint};
use super::run::Run;
use crate::files::{Role, grey};
use crate::options::most;

/// So many fixed poses of a component are asked at most.
const VOTES: usize = 3;

/// The components, and the frames that each is followed from. Where nobody says how the film shows metal, and nothing is pointed
/// at that would tell it, metal is looked for as fluoroscopes show it, dark, and where a frame shows nothing so the other way too:
/// whichever shows a component first is gone on with. Where that does not show all components, what is found better counts, for a
/// bright thing beside dark ones may be taken for a component.
pub(super) fn begun<'s>(
    run: &Run<'_>,
    parts: impl Fn(Polarity) -> Result<Vec<Part<'s>>>,
) -> Result<(Vec<Part<'s>>, Vec<Vec<Anchor>>)> {
    let told = match run.request.polarity {
        Some(stated) => Some(stated),
        None => told_by_what_is_given(run, &parts(Polarity::default())?)?,
    };
    let mut ways = vec![Search::begin(run, parts(told.unwrap_or_default())?)?];
    if told.is_none() {
        ways.push(Search::begin(run, parts(Polarity::BrightImplant)?)?);
    }
    for frame in frames_to_search(&(0..run.film.count())) {
        for k in 0..ways.len() {
            let others_lead = (0..ways.len()).any(|other| other != k && !ways[other].is_empty());
            if !others_lead && ways[k].alone(run, frame)? {
                return Ok(ways.swap_remove(k).found());
            }
        }
    }
    ways.sort_by_key(Search::is_empty);
    for way in &mut ways {
        for frame in frames_to_search(&(0..run.film.count())) {
            way.alone(run, frame)?;
        }
        if way.beside(run)? {
            break;
        }
    }
    // Of those that are as good the first.
    let scored = ways.into_iter().rev().map(|way| (score(&way.anchors), way));
    let best = scored.max_by(|(one, _), (other, _)| one.total_cmp(other));
    Ok(best.map_or_else(Default::default, |(_, way)| way.found()))
}

/// The search for all components of a film that shows metal in one way.
struct Search<'s> {
    parts: Vec<Part<'s>>,
    anchors: Vec<Vec<Anchor>>,
    /// Frames that were searched.
    seen: Vec<usize>,
    /// The anchors beside which joints have been looked for.
    led: usize,
}

impl<'s> Search<'s> {
    /// With what a person gave.
    fn begin(run: &Run<'_>, parts: Vec<Part<'s>>) -> Result<Self> {
        let anchors = parts.iter().map(|part| given(run, part));
        let mut anchors = anchors.collect::<Result<Vec<_>>>()?;
        let clicked = anchors.clone();
        let others = others(&parts, &clicked);
        let trays = parts.iter().zip(&mut anchors);
        for (part, anchors) in trays.filter(|(part, _)| is_tray(part)) {
            *anchors = or_in_joint(run, part, anchors, &others)?;
        }
        let seen = Vec::new();
        Ok(Self {
            parts,
            anchors,
            seen,
            led: 0,
        })
    }

    /// Looks for what is missing in a whole frame; whether all is found then. Femurs and others first: a tray is found by its joint
    /// where its femur is known, sooner and surer than alone.
    fn alone(&mut self, run: &Run<'_>, frame: usize) -> Result<bool> {
        self.in_joint(run)?;
        if !self.seen.contains(&frame) {
            self.seen.push(frame);
            for trays in [false, true] {
                let depth = self.depth();
                let both = self.parts.par_iter().zip(&mut self.anchors);
                both.filter(|(part, anchors)| anchors.is_empty() && is_tray(part) == trays)
                    .try_for_each(|(part, anchors)| -> Result<()> {
                        anchors.extend(found_in(run, part, frame, depth)?);
                        Ok(())
                    })?;
                self.in_joint(run)?;
            }
        }
        Ok(self.is_whole())
    }

    /// Looks for what is missing where its joint leaves it beside what is known.
    fn in_joint(&mut self, run: &Run<'_>) -> Result<()> {
        let known = self.anchors.clone();
        let led = known.iter().map(Vec::len).sum();
        if led == self.led {
            return Ok(());
        }
        self.led = led;
        let others = others(&self.parts, &known);
        for (part, anchors) in self.parts.iter().zip(&mut self.anchors) {
            if anchors.is_empty() && part.limb.is_some() {
                *anchors = begin_in_joint(run, part, &others)?;
            }
        }
        Ok(())
    }

    /// How far away a component is that is known, mm: the others of its joint are there too.
    fn depth(&self) -> Option<f64> {
        let known = self.parts.iter().zip(&self.anchors);
        let mut depths = known.filter_map(|(part, anchors)| {
            let anchor = anchors.first()?;
            Some(part.depth_of(&anchor.found.pose))
        });
        depths.next()
    }

    /// Looks for what is missing beside what was found; whether all is found then.
    fn beside(&mut self, run: &Run<'_>) -> Result<bool> {
        let alone = self.anchors.clone();
        let others = others(&self.parts, &alone);
        for (part, anchors) in self.parts.iter().zip(&mut self.anchors) {
            if anchors.is_empty() {
                *anchors = begin_beside(run, part, &others)?;
            }
        }
        Ok(self.is_whole())
    }

    fn is_whole(&self) -> bool {
        self.anchors.iter().all(|anchors| !anchors.is_empty())
    }

    fn is_empty(&self) -> bool {
        self.anchors.iter().all(Vec::is_empty)
    }

    fn found(self) -> (Vec<Part<'s>>, Vec<Vec<Anchor>>) {
        (self.parts, self.anchors)
    }
}

fn is_tray(part: &Part<'_>) -> bool {
    part.role() == Some(Role::Tibia)
}

/// Components with what is known of them.
fn others<'o, 's>(
    parts: &'o [Part<'s>],
    known: &'o [Vec<Anchor>],
) -> Vec<(&'o Part<'s>, &'o [Anchor])> {
    let each = parts.iter().zip(known);
    each.map(|(part, own)| (part, own.as_slice())).collect()
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
        let decoded = run.film.frame(click.frame)?;
        votes.push(polarity_near(&*grey(&decoded)?, click.place));
    }
    for part in parts {
        for (frame, pose) in fixed_poses(run, part).into_iter().take(VOTES) {
            let told = part.see(run.film, frame, |subject, image, memory| {
                polarity_at(subject.model, subject.camera, &pose, image.frame, memory)
            })?;
            // A pose that cannot be drawn is told where it is used.
            votes.extend(told.ok());
        }
    }
    Ok(most(votes))
}

//! The outer rim beyond an inner one.
//!
//! A tray's wall around its recess is thin, so the strongest edges along it may be those of the floor inside; a model
//! farther away and tilted lies on them all. What lies beyond tells: a second edge of the same sign along a part of the
//! outline. The model is brought onto the outline with that part moved out to it, and then onto the frame. Where it then
//! lies on the outer edge too, the inner one is explained as the recess, and the outer one could not be explained by the
//! other pose.

use super::candidates::{Answer, SAME_ANSWER, keep};
use super::error::OneClickError;
use super::memory::OneClickMemory;
use super::observation::Observation;
use super::scoring::nearness;
use super::state::OneClick;
use super::support::second_slope;
use fluoropose::finder::Component;
use fluoropose::image::mask::{Mask, MaskMut, words_needed};
use fluoropose::refine::{
    CameraView, OutlineSample, RefineError, RefineOptions, Refined, outline_samples, refine,
};

/// A second edge lies at least so far beyond an outline, pixels: nearer it is the first one's own blur.
const APART: f64 = 3.0;
/// It lies no farther beyond than this fraction of the expected size.
const BEYOND: f64 = 0.12;
/// Distance between readings along a normal, pixels.
const STEP: f64 = 0.5;
/// A rim is thin and its edge faint: it counts from this fraction of the slope of an edge of metal.
const FAINT: f64 = 0.12;
/// Between the edges the slope falls to this fraction of the second one's at most.
const VALLEY: f64 = 0.6;
/// The least part of an outline that has a second edge for an outer rim to be looked for.
const WORTH: f64 = 0.08;
/// The outer pose must keep this part of the edges that the inner one lies on, and lie as near to its own: the edge beyond may be
/// that of skin or bone.
const KEPT: f64 = 0.9;
const AS_NEAR: f64 = 0.8;
/// From this part of the outer rim on edges it takes the inner one's place; from the other on, both are open.
const TAKEN: f64 = 0.75;
const OPEN: f64 = 0.4;
/// The loss of a pose that nothing tells from another, as a multiple of the other's.
const LITTLE_WORSE: f64 = 1.2;
/// How far from the outer outline its edge may lie, pixels.
const CLOSE: f64 = 1.5;

/// What became of an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Beyond {
    /// There is nothing beyond it.
    Nothing,
    /// Another pose explains what lies beyond it, as well as not.
    Open(Answer),
    /// Another pose explains it and what lies beyond it.
    Taken(Answer),
}

impl OneClick {
    /// Looks for an outer rim beyond one answer. Returns whether there may be another answer to look at.
    pub(super) fn look_beyond(
        &mut self,
        at: usize,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<bool, OneClickError> {
        if at == 0 {
            self.inner = self.answers.clone();
        }
        let Some(inner) = self.inner.get(at).copied() else {
            return Ok(false);
        };
        let found = self.beyond(&inner, observation, component, memory)?;
        if matches!(found, Beyond::Taken(_)) {
            self.answers.retain(|answer| *answer != inner);
        }
        if let Beyond::Open(outer) | Beyond::Taken(outer) = found {
            keep(&mut self.answers, outer, SAME_ANSWER, component.model);
        }
        Ok(true)
    }

    fn beyond(
        &mut self,
        inner: &Answer,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Beyond, OneClickError> {
        // The masks of regions make room for the outline moved out and the silhouette inside of it.
        self.current = None;
        let part = self.move_out(inner, observation, component, memory)?;
        if part < WORTH {
            return Ok(Beyond::Nothing);
        }
        let (width, height) = (observation.camera.width(), observation.camera.height());
        let words = words_needed(width, height);
        let moved = Mask::new(memory.words.get(..words).unwrap_or_default(), width, height)?;
        let view = CameraView::only(observation.camera, &moved);
        let (model, start) = (component.model, &inner.refined.pose);
        let options = RefineOptions::default();
        let tried = refine(model, &[view], start, options, &mut memory.refine);
        let Some(onto) = RefineError::passed_over(tried)? else {
            return Ok(Beyond::Nothing);
        };
        let scorer = self.scorer(observation, component);
        let outer = scorer.onto_frame(&onto.pose, memory)?;
        let other = |outer: &Answer| {
            let same = SAME_ANSWER.holds(&outer.refined.pose, &inner.refined.pose, model);
            !same
                && outer.support.fraction >= KEPT * inner.support.fraction
                && nearness(&outer.refined) >= AS_NEAR * nearness(&inner.refined)
        };
        let (held, outer) = match outer.filter(other) {
            Some(outer) => (true, Some(outer)),
            // The edges of the inner rim, which are stronger, pull the outline back where the wall is thin.
            None => (false, scorer.answer(unsettled(onto, inner), start, memory)?),
        };
        let Some(outer) = outer.filter(other) else {
            return Ok(Beyond::Nothing);
        };
        let outer = Answer {
            start: *start,
            mirrored: inner.mirrored,
            // It explains what the inner one does, and more.
            score: outer.score.max(inner.score),
            ..outer
        };
        Ok(match self.on_rim(&outer, observation, component, memory)? {
            Some(part) if part >= TAKEN && held => Beyond::Taken(outer),
            Some(part) if part >= OPEN => Beyond::Open(outer),
            _ => Beyond::Nothing,
        })
    }

    /// Draws the silhouette of an answer with its outline moved out to second edges, and the silhouette alone as the second
    /// mask. Returns the part of the outline that was moved.
    fn move_out(
        &self,
        inner: &Answer,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<f64, OneClickError> {
        let (width, height) = (observation.camera.width(), observation.camera.height());
        let words = words_needed(width, height);
        let (moved, alone) = memory.words.split_at_mut(words.min(memory.words.len()));
        let mut mask = MaskMut::new(moved, width, height)?;
        mask.clear();
        let reach = (BEYOND * self.expected.size).max(2.0 * APART);
        let (mut length, mut moved_length) = (0.0, 0.0);
        let (model, pose) = (component.model, &inner.refined.pose);
        outline_samples(
            model,
            observation.camera,
            pose,
            &mut memory.refine,
            |sample| {
                length += sample.length;
                if let Some(edge) = self.second_edge(observation, sample, reach) {
                    moved_length += sample.length;
                    fill_along(&mut mask, sample, edge);
                }
            },
        )?;
        let drawn = memory.refine.drawn.get(..words).unwrap_or_default();
        for ((moved, alone), &drawn) in moved.iter_mut().zip(alone).zip(drawn) {
            *moved |= drawn;
            *alone = drawn;
        }
        Ok(moved_length / f64::max(length, f64::MIN_POSITIVE))
    }

    /// How far beyond a sample its second edge lies, pixels: the strongest slope that falls off towards the first edge, so that
    /// the foot of a blurred first edge is none.
    fn second_edge(
        &self,
        observation: &Observation<'_>,
        sample: &OutlineSample,
        reach: f64,
    ) -> Option<f64> {
        let slope = |k: usize| second_slope(observation, sample, STEP * k as f64);
        let (mut best, mut valley) = (None, f64::INFINITY);
        let (mut before, mut here) = (slope(0)?, slope(1)?);
        // Still rising at the end, it is something farther away.
        for k in 1..(reach / STEP) as usize {
            let after = slope(k + 1)?;
            let (place, is_peak) = (STEP * k as f64, here > before && here >= after);
            let stands_out = here >= FAINT * self.slope && here * VALLEY >= valley;
            let is_better = best.is_none_or(|(_, other)| here > other);
            if place >= APART && is_peak && stands_out && is_better {
                best = Some((place, here));
            }
            valley = valley.min(here);
            (before, here) = (here, after);
        }
        best.map(|(place, _)| place)
    }

    /// The part of an outer outline, where it lies outside of the inner silhouette, that lies on edges; `None` where hardly
    /// any does lie outside.
    fn on_rim(
        &self,
        outer: &Answer,
        observation: &Observation<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<Option<f64>, OneClickError> {
        let (width, height) = (observation.camera.width(), observation.camera.height());
        let words = words_needed(width, height);
        let inside = memory.words.get(words..).unwrap_or_default();
        let inside = Mask::new(inside.get(..words).unwrap_or_default(), width, height)?;
        let (mut all, mut rim, mut on_edges) = (0.0, 0.0, 0.0);
        let (model, pose) = (component.model, &outer.refined.pose);
        outline_samples(
            model,
            observation.camera,
            pose,
            &mut memory.refine,
            |sample| {
                all += sample.length;
                let [column, row] = along(sample, -APART);
                if column < 0.0 || row < 0.0 || inside.get(column as usize, row as usize) {
                    return;
                }
                rim += sample.length;
                if self.is_on_edge(observation, sample) {
                    on_edges += sample.length;
                }
            },
        )?;
        let enough: bool = rim >= WORTH * all;
        Ok(enough.then(|| on_edges / f64::max(rim, f64::MIN_POSITIVE)))
    }

    /// Whether a sample lies on an edge of its own, not on the foot of one farther in.
    fn is_on_edge(&self, observation: &Observation<'_>, sample: &OutlineSample) -> bool {
        let steps = (CLOSE / STEP) as i32;
        let slope = |k: i32| second_slope(observation, sample, STEP * f64::from(k));
        let near = (-steps..=steps).filter_map(|k| Some((k, slope(k)?)));
        let best = near.max_by(|a, b| a.1.total_cmp(&b.1));
        best.is_some_and(|(k, slope)| k > -steps && slope >= FAINT * self.slope)
    }
}

/// A pose on the outer rim that the frame's edges do not hold: it counts as little worse than the inner one, so that nothing
/// decides between them.
fn unsettled(onto: Refined, inner: &Answer) -> Refined {
    Refined {
        loss: LITTLE_WORSE * inner.refined.loss,
        ..onto
    }
}

/// The place at a distance outwards from a sample.
fn along(sample: &OutlineSample, t: f64) -> [f64; 2] {
    [
        sample.column + t * sample.normal[0],
        sample.row + t * sample.normal[1],
    ]
}

/// Sets the pixels from a sample outwards, a pixel's width.
fn fill_along(mask: &mut MaskMut<'_>, sample: &OutlineSample, length: f64) {
    let [right, down] = sample.normal;
    for k in 0..(2.0 * length) as usize {
        let [column, row] = along(sample, 0.5 * k as f64);
        for side in [-0.5, 0.0, 0.5] {
            let (column, row) = (column - side * down, row + side * right);
            // Beyond the other sides of the mask nothing is set.
            if column >= 0.0 && row >= 0.0 {
                mask.set(column as usize, row as usize, true);
            }
        }
    }
}

#[cfg(test)]
mod tests;

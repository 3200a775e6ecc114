//! Where to begin: seeds in a box, and the poses that the library has for a region.

use heapless::Vec;

use super::expect::Expected;
use super::job::{Goal, Start};
use super::shape::Shaper;
use super::support::support;
use super::window::{LEVELS, Window};
use super::{OneClickError, OneClickMemory, Part, Prompt, Scene};
use crate::locate::locate;
use crate::mask::{Mask, words_needed};
use crate::pose::Pose;

/// Places that growing begins from, at most.
pub(super) const SEEDS: usize = 4;

/// Parts of a box that are taken to be metal, by turns.
const DARKEST: [f64; SEEDS] = [0.1, 0.2, 0.35, 0.5];

/// Poses of a region that are looked at.
const MINIMA: usize = 4;

/// A click may miss the silhouette by so much, pixels.
const MISSED: usize = 4;
/// Part of two boxes, of the prompt's and of the silhouette's, that a rough box has in common.
const ROUGH: f64 = 0.5;

/// How far from the outline of a first pose an edge is looked for, in parts of the size.
const NEAR: f64 = 0.04;

/// The middles of the thickest dark things in a window, each once: the part of it that is
/// thickest, for several shares of dark pixels.
pub(super) fn seeds_in(window: &Window, memory: &mut OneClickMemory<'_>) -> Vec<usize, SEEDS> {
    let mut seeds = Vec::new();
    let histogram = &mut *memory.tallies;
    histogram.fill(0);
    for &grey in memory.grey.iter().filter(|&&grey| usize::from(grey) < LEVELS) {
        if let Some(count) = histogram.get_mut(usize::from(grey)) {
            *count += 1;
        }
    }
    for share in DARKEST {
        let wanted = share * window.pixels() as f64;
        let mut sum = 0.0;
        let level = memory.tallies.iter().position(|&count| {
            sum += f64::from(count);
            sum >= wanted
        });
        let mut shaper = Shaper {
            window: *window,
            reached: &*memory.grey,
            distance: &mut *memory.distance,
            marks: &mut *memory.marks,
            stack: &mut *memory.links,
        };
        let Some(seed) = shaper.thickest(level.unwrap_or(0) as u16) else {
            continue;
        };
        if !seeds.contains(&seed) {
            // There are as many places as shares.
            let _ = seeds.push(seed);
        }
    }
    seeds
}

/// How well a drawn silhouette agrees with what the person pointed at, 0 to 1.
pub(super) fn agreement(prompt: &Prompt, drawn: &Mask<'_>) -> f64 {
    let (columns, rows) = drawn.bounds();
    match *prompt {
        Prompt::Click(at) => {
            let near = |at: f64| (at as usize).saturating_sub(MISSED)..=at as usize + MISSED;
            let hit = |row: usize| near(at.column).any(|column| drawn.get(column, row));
            f64::from(u8::from(near(at.row).any(hit)))
        }
        Prompt::Box(low, high) => {
            let own = [columns.start, rows.start, columns.end, rows.end].map(|side| side as f64);
            let wanted = [low.column, low.row, high.column, high.row];
            (common(&own, &wanted) / ROUGH).min(1.0)
        }
    }
}

/// Intersection of two boxes divided by their union.
fn common(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    let area = |[left, top, right, bottom]: [f64; 4]| {
        (right - left).max(0.0) * (bottom - top).max(0.0)
    };
    let both = [
        a[0].max(b[0]),
        a[1].max(b[1]),
        a[2].min(b[2]),
        a[3].min(b[3]),
    ];
    let inside = area(both);
    inside / (area(*a) + area(*b) - inside).max(f64::MIN_POSITIVE)
}

/// The poses that the library has for a region, judged by the region, the frame's edges and the
/// prompt.
pub(super) fn poses_of(
    scene: &Scene<'_>,
    part: &Part<'_>,
    goal: &Goal<'_>,
    memory: &mut OneClickMemory<'_>,
) -> Result<Vec<Start, MINIMA>, OneClickError> {
    let (width, height) = (scene.camera.width(), scene.camera.height());
    let length = words_needed(width, height);
    let region = Mask::new(memory.words.get(..length).unwrap_or_default(), width, height)?;
    let work = memory.workspace.lend();
    let mut starts = Vec::new();
    let Ok(found) = locate::<MINIMA>(&region, scene.camera, part.library, work) else {
        // A shapeless region has no pose.
        return Ok(starts);
    };
    for located in &found.poses {
        let pose = located.pose;
        if !is_possible(&pose, part, goal.expected) {
            continue;
        }
        let near = (NEAR * goal.expected.size).max(2.0);
        let how = (near, goal.slope);
        let Ok(support) = support(scene, part.mesh, &pose, how, &mut memory.refine) else {
            continue;
        };
        let drawn = memory.refine.drawn.get(..length).unwrap_or_default();
        let drawn = Mask::new(drawn, width, height)?;
        let overlap = overlap(&region, &drawn);
        let agreement = agreement(goal.prompt, &drawn);
        // There are no more than minima.
        let _ = starts.push(Start {
            pose,
            region: goal.region,
            overlap,
            support,
            score: agreement * (overlap + support.strength),
        });
    }
    Ok(starts)
}

/// Whether the part stands where it can be.
pub(super) fn is_possible(pose: &Pose, part: &Part<'_>, expected: &Expected) -> bool {
    let [_, _, z] = pose.transform(&part.mesh.bounds().centre);
    (expected.depths[0]..=expected.depths[1]).contains(&-z)
}

/// Pixels in both masks divided by those in either.
pub(super) fn overlap(a: &Mask<'_>, b: &Mask<'_>) -> f64 {
    let pairs = a.words().iter().zip(b.words());
    let (mut both, mut either) = (0u64, 0u64);
    for (a, b) in pairs {
        both += u64::from((a & b).count_ones());
        either += u64::from((a | b).count_ones());
    }
    both as f64 / either.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contour::Point;
    use crate::mask::MaskMut;

    const SIDE: usize = 64;

    fn block() -> std::vec::Vec<u32> {
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        (20..40).for_each(|row| mask.fill_span(row, 10, 50));
        words
    }

    #[test]
    fn a_prompt_agrees_with_what_it_points_at() {
        let words = block();
        let drawn = Mask::new(&words, SIDE, SIDE).expect("valid");
        let click = |column, row| agreement(&Prompt::Click(Point::new(column, row)), &drawn);
        assert_eq!([click(30.0, 30.0), click(7.5, 18.0), click(3.0, 3.0)], [1.0, 1.0, 0.0]);
        let boxed = |corners: [f64; 4]| {
            let [left, top, right, bottom] = corners;
            let prompt = Prompt::Box(Point::new(left, top), Point::new(right, bottom));
            agreement(&prompt, &drawn)
        };
        assert_eq!(boxed([8.0, 18.0, 52.0, 42.0]), 1.0);
        // A fifth of it in common.
        assert!((boxed([10.0, 20.0, 50.0, 120.0]) - 0.4).abs() < 1e-12);
        assert_eq!(boxed([51.0, 0.0, 60.0, 60.0]), 0.0);
    }

    #[test]
    fn overlap_is_intersection_over_union() {
        let words = block();
        let mut other = words.clone();
        other[2 * 20..2 * 30].fill(0);
        let [a, b] = [&words, &other].map(|words| Mask::new(words, SIDE, SIDE).expect("valid"));
        assert_eq!(overlap(&a, &a), 1.0);
        assert_eq!(overlap(&a, &b), 0.5);
    }
}

//! The best hypotheses that differ, followed on the library's full grid.

use heapless::Vec;

use super::hypothesis::Hypothesis;
use super::search::PartialSearch;
use super::view::ViewMemory;
use crate::camera::Camera;
use crate::locate::whole::Located;
use crate::pose::geodesic_deg;
use crate::shortlist::first_of;

/// Hypotheses that are followed on the full grid.
const SEEDS: usize = 12;
/// Hypotheses that differ in rotation by less are one, degrees: refinement finds one pose from both.
const SEEDS_APART_DEG: f64 = 6.0;
const POSES_APART_DEG: f64 = 2.0;

/// The poses of the best hypotheses that differ, followed on the full grid, best first.
pub(super) fn follow<const K: usize>(
    search: &PartialSearch<'_>,
    camera: &Camera,
    found: &mut [Hypothesis],
    views: &mut ViewMemory<'_>,
) -> Vec<Located, K> {
    let locate =
        |hypothesis: &Hypothesis| hypothesis.locate(camera, search.library, &search.known.plane);
    found.sort_unstable_by(|a, b| a.score.total_cmp(&b.score).then(a.view.cmp(&b.view)));
    let seeds: Vec<Hypothesis, SEEDS> = distinct(found, SEEDS_APART_DEG, locate);
    let mut followed: Vec<Hypothesis, SEEDS> =
        first_of(seeds.iter().map(|seed| search.fine(seed, views)));
    followed.sort_unstable_by(|a, b| a.score.total_cmp(&b.score).then(a.view.cmp(&b.view)));
    let best: Vec<Hypothesis, K> = distinct(&followed, POSES_APART_DEG, locate);
    first_of(best.iter().map(locate))
}

/// The first hypotheses of a list whose rotations differ from those before by `apart` degrees.
fn distinct<const K: usize>(
    list: &[Hypothesis],
    apart: f64,
    locate: impl Fn(&Hypothesis) -> Located,
) -> Vec<Hypothesis, K> {
    let mut kept: Vec<(Hypothesis, Located), K> = Vec::new();
    for hypothesis in list {
        let located = locate(hypothesis);
        let differs = |(_, other): &(Hypothesis, Located)| {
            geodesic_deg(&other.pose.rotation, &located.pose.rotation) >= apart
        };
        if kept.iter().all(differs) && kept.push((*hypothesis, located)).is_err() {
            break;
        }
    }
    first_of(kept.iter().map(|(hypothesis, _)| *hypothesis))
}

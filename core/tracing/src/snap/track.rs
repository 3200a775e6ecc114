//! Which place each sample goes to, decided for all together.

use super::sample::{STATES, STEP, Sample, Snap};

/// The place on the line itself.
const MIDDLE: usize = STATES / 2;

/// The worth of a place on the line minus that of one at the end of the reach, where a usual edge is worth 1.
const FAR: f64 = 0.35;
/// The cost, for each pixel of their distance, of two neighbours whose offsets differ by that distance (45 degrees).
const BEND: f64 = 0.6;
/// How far a sample may climb to the top of its slope in the end, places.
const CLIMB: usize = 3;
/// The greatest difference of two neighbours' offsets, as a multiple of their distance.
const STEEPEST: f64 = 1.0;

/// Sets the offset of each sample. `slopes` and `ways` hold [`STATES`] numbers for each sample.
pub(super) fn track(
    samples: &mut [Sample],
    slopes: &mut [f32],
    ways: &mut [u8],
    settings: &Snap,
    least: f64,
) {
    let usual = usual(slopes, samples.len(), least);
    let half = ((settings.reach / STEP) as usize).min(MIDDLE);
    let mut tracker = Tracker {
        samples,
        slopes,
        ways,
        least,
        usual,
        half,
    };
    let count = tracker.samples.len();
    if settings.closed {
        // A ring has no first sample. The first run cuts it at sample 0; the second cuts it at the sample farthest from
        // there, which keeps the place that the first run chose for it.
        tracker.run(0, None);
        let held = (count / 2, tracker.state_of(count / 2));
        tracker.run(held.0, Some(held.1));
    } else {
        tracker.run_between_ends();
    }
    tracker.settle(settings.closed);
}

/// The median, over the samples with an edge, of their greatest slopes: the slope of a usual edge.
fn usual(slopes: &[f32], count: usize, least: f64) -> f64 {
    // By bisection, so that nothing has to be sorted or stored.
    let best = |slopes: &[f32]| slopes.iter().copied().fold(0.0, f32::max);
    let all = slopes.chunks_exact(STATES).take(count).map(best);
    let edges = all.filter(|&slope| f64::from(slope) >= least);
    let number = edges.clone().count();
    let (mut low, mut high) = (least, f64::from(edges.clone().fold(0.0, f32::max)));
    for _ in 0..20 {
        let middle = (low + high) / 2.0;
        let above = edges
            .clone()
            .filter(|&slope| f64::from(slope) > middle)
            .count();
        if 2 * above > number {
            low = middle;
        } else {
            high = middle;
        }
    }
    low.max(least).max(f64::MIN_POSITIVE)
}

struct Tracker<'a> {
    samples: &'a mut [Sample],
    slopes: &'a mut [f32],
    ways: &'a mut [u8],
    least: f64,
    usual: f64,
    /// Places to each side that are within reach.
    half: usize,
}

impl Tracker<'_> {
    fn slope(&self, number: usize, state: usize) -> f64 {
        f64::from(self.slopes[number * STATES + state])
    }

    /// The worth of a place for a sample.
    fn worth(&self, number: usize, state: usize) -> f64 {
        let slope = self.slope(number, state);
        let edge = if slope >= self.least {
            2.0 * slope / (slope + self.usual)
        } else {
            0.0
        };
        let away = state.abs_diff(MIDDLE) as f64 / self.half.max(1) as f64;
        edge - FAR * away * away
    }

    fn states(&self) -> core::ops::RangeInclusive<usize> {
        MIDDLE - self.half..=MIDDLE + self.half
    }

    /// Finds the best offsets of a ring that is cut before sample `first`. With `held`, that sample is at this place at
    /// the beginning and, when the way comes back to it, at the end.
    fn run(&mut self, first: usize, held: Option<usize>) {
        let count = self.samples.len();
        let mut worth = [f64::NEG_INFINITY; STATES];
        for state in self.states() {
            if held.is_none_or(|held| held == state) {
                worth[state] = self.worth(first, state);
            }
        }
        for k in 1..count {
            worth = self.forward((first + k) % count, &worth);
        }
        let last = match held {
            // Back to the first sample, whose ways are not needed for anything else.
            Some(held) => {
                self.forward(first, &worth);
                usize::from(self.ways[first * STATES + held])
            }
            None => best(&worth),
        };
        self.backward(first, count, last);
    }

    /// Finds the best offsets of an open line whose ends stay.
    fn run_between_ends(&mut self) {
        let count = self.samples.len();
        let mut worth = [f64::NEG_INFINITY; STATES];
        worth[MIDDLE] = 0.0;
        for number in 1..count {
            worth = self.forward(number, &worth);
        }
        self.backward(0, count, MIDDLE);
    }

    /// The worth of the best way to each place of a sample from those of the one before it.
    fn forward(&mut self, number: usize, before: &[f64; STATES]) -> [f64; STATES] {
        let step = self.samples[number].step.max(1e-3);
        let most = (libm::ceil(STEEPEST * step / STEP) as usize).clamp(1, 2 * self.half);
        let price = BEND * STEP * STEP / step;
        let mut after = [f64::NEG_INFINITY; STATES];
        for state in self.states() {
            let low = state.saturating_sub(most).max(*self.states().start());
            let high = (state + most).min(*self.states().end());
            let mut best = (f64::NEG_INFINITY, state);
            for (from, &worth) in before.iter().enumerate().take(high + 1).skip(low) {
                let difference = state.abs_diff(from) as f64;
                let worth = worth - price * difference * difference;
                if worth > best.0 {
                    best = (worth, from);
                }
            }
            after[state] = best.0 + self.worth(number, state);
            self.ways[number * STATES + state] = best.1 as u8;
        }
        after
    }

    /// Sets the offsets from the last sample of a run back to sample `first`.
    fn backward(&mut self, first: usize, count: usize, last: usize) {
        let mut state = last;
        for k in (0..count).rev() {
            let number = (first + k) % count;
            self.samples[number].offset = STEP * (state as f64 - MIDDLE as f64);
            state = usize::from(self.ways[number * STATES + state]);
        }
    }

    fn state_of(&self, number: usize) -> usize {
        let state = MIDDLE as f64 + self.samples[number].offset / STEP;
        (state + 0.5) as usize
    }

    /// Turns places into offsets: to a fraction of a place where there is an edge, then averaged with the neighbours that
    /// have an edge. The ends of an open line stay.
    fn settle(&mut self, closed: bool) {
        let count = self.samples.len();
        for number in 0..count {
            let state = self.climbed(number, self.state_of(number));
            let fixed = !closed && (number == 0 || number + 1 == count);
            let on_edge = !fixed && self.slope(number, state) >= self.least;
            self.samples[number].on_edge = on_edge;
            if on_edge {
                let place = state as f64 - MIDDLE as f64 + self.part(number, state);
                self.samples[number].offset = STEP * place;
            }
        }
        let mut before = self.samples[count - 1];
        let first = self.samples[0];
        for number in 0..count {
            let here = self.samples[number];
            let after = if number + 1 < count {
                self.samples[number + 1]
            } else {
                first
            };
            if before.on_edge && here.on_edge && after.on_edge {
                let mean = (before.offset + 2.0 * here.offset + after.offset) / 4.0;
                self.samples[number].offset = mean;
            }
            before = here;
        }
    }

    /// The nearest place with the greatest slope, at most [`CLIMB`] places away: staying close to the neighbours leaves
    /// samples beside the edge where a line bends.
    fn climbed(&self, number: usize, state: usize) -> usize {
        let mut state = state;
        for _ in 0..CLIMB {
            let here = self.slope(number, state);
            let around = [state.saturating_sub(1), (state + 1).min(STATES - 1)];
            // Between two tops the steeper way: which of them comes first depends on the way that a frame is shown.
            let [before, after] = around.map(|other| self.slope(number, other));
            if before > here.max(after) {
                state = around[0];
            } else if after > here.max(before) {
                state = around[1];
            }
        }
        state
    }

    /// Where between a place's neighbours the slope is greatest: the top of a parabola, in places.
    fn part(&self, number: usize, state: usize) -> f64 {
        if state == 0 || state + 1 >= STATES {
            return 0.0;
        }
        let [before, here, after] = [state - 1, state, state + 1].map(|k| self.slope(number, k));
        let curve = before - 2.0 * here + after;
        if here < before || here < after || curve >= 0.0 {
            return 0.0;
        }
        (0.5 * (before - after) / curve).clamp(-0.5, 0.5)
    }
}

fn best(worth: &[f64; STATES]) -> usize {
    let mut best = MIDDLE;
    for (state, value) in worth.iter().enumerate() {
        if *value > worth[best] {
            best = state;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    /// Slopes of samples, the greatest of each in one of its places.
    fn slopes(greatest: &[f32]) -> Vec<f32> {
        let one = |(number, &most): (usize, &f32)| {
            (0..STATES).map(move |state| {
                if state == number % STATES {
                    most
                } else {
                    most / 3.0
                }
            })
        };
        greatest.iter().enumerate().flat_map(one).collect()
    }

    #[test]
    fn a_usual_slope_is_the_median_of_those_that_are_edges() {
        let all = slopes(&[9.0, 1.0, 30.0, 12.0, 2.0, 10.0, 50.0]);
        // Nine, ten, twelve, thirty and fifty are at least three.
        assert!((usual(&all, 7, 3.0) - 12.0).abs() < 1e-3);
        assert!((usual(&all, 7, 0.5) - 10.0).abs() < 1e-3);
        assert!(
            (usual(&all, 3, 3.0) - 9.0).abs() < 1e-3,
            "of the first three alone"
        );
        assert_eq!(usual(&all, 7, 60.0), 60.0, "none is an edge");
        assert!(usual(&[], 0, 0.0) > 0.0);
    }

    /// The worth of places for each sample, less what each step between neighbours costs; none where a step is too steep.
    fn worth_of(tracker: &Tracker<'_>, places: &[usize], closed: bool) -> f64 {
        let count = places.len();
        let own = (0..count).map(|number| {
            let is_end = !closed && (number == 0 || number + 1 == count);
            // The ends of an open line stay whatever that is worth.
            if is_end {
                0.0
            } else {
                tracker.worth(number, places[number])
            }
        });
        let steps = (usize::from(!closed)..count).map(|number| {
            let step = tracker.samples[number].step;
            let apart = places[number].abs_diff(places[(number + count - 1) % count]) as f64 * STEP;
            let is_steep = apart > step + STEP;
            if is_steep {
                f64::INFINITY
            } else {
                BEND * apart * apart / step
            }
        });
        own.sum::<f64>() - steps.sum::<f64>()
    }

    /// Oracle: all ways through five places of each of six samples. A ring is at the best of those that begin at the place that is held.
    #[test]
    fn no_other_way_is_worth_more() {
        const COUNT: usize = 6;
        for seed in 0..12 {
            let mut random = crate::synthetic::Random(seed);
            let mut slopes: Vec<f32> = (0..COUNT * STATES)
                .map(|_| 9.0 * random.uniform() as f32)
                .collect();
            let mut samples: Vec<Sample> = (0..COUNT)
                .map(|_| Sample {
                    step: 0.6 + 1.2 * random.uniform(),
                    ..Sample::default()
                })
                .collect();
            let mut tracker = Tracker {
                samples: &mut samples,
                slopes: &mut slopes,
                ways: &mut [0; COUNT * STATES],
                least: 2.0,
                usual: 5.0,
                half: 2,
            };
            let all = || {
                (0..5usize.pow(COUNT as u32)).map(|way| -> [usize; COUNT] {
                    core::array::from_fn(|number| MIDDLE - 2 + way / 5usize.pow(number as u32) % 5)
                })
            };
            let found = |tracker: &Tracker<'_>| -> [usize; COUNT] {
                core::array::from_fn(|number| tracker.state_of(number))
            };
            let most = |tracker: &Tracker<'_>,
                        closed: bool,
                        is_possible: &dyn Fn(&[usize; COUNT]) -> bool| {
                let worths = all()
                    .filter(|way| is_possible(way))
                    .map(|way| worth_of(tracker, &way, closed));
                worths.fold(f64::NEG_INFINITY, f64::max)
            };
            tracker.run_between_ends();
            let own = found(&tracker);
            assert_eq!((own[0], own[COUNT - 1]), (MIDDLE, MIDDLE));
            let best = most(&tracker, false, &|way| {
                way[0] == MIDDLE && way[COUNT - 1] == MIDDLE
            });
            assert!(
                (worth_of(&tracker, &own, false) - best).abs() < 1e-9,
                "{own:?}"
            );
            for held in MIDDLE - 2..=MIDDLE + 2 {
                tracker.run(3, Some(held));
                let own = found(&tracker);
                let best = most(&tracker, true, &|way| way[3] == held);
                assert_eq!(own[3], held);
                assert!(
                    (worth_of(&tracker, &own, true) - best).abs() < 1e-9,
                    "{own:?}"
                );
            }
        }
    }

    /// Each sample with the two beside it, of a ring all and of an open line all but its ends.
    #[test]
    fn an_offset_is_averaged_where_all_three_have_an_edge() {
        const COUNT: usize = 7;
        let peaks = [1i32, 3, 2, 5, 4, 1, 3];
        let faint = 4;
        for closed in [true, false] {
            let mut slopes = Vec::new();
            for (number, &peak) in peaks.iter().enumerate() {
                let high = if number == faint { 0.5f32 } else { 9.0 };
                let at = |state: usize| (state as i32 - MIDDLE as i32 - peak).abs() as f32;
                slopes.extend((0..STATES).map(|state| (high - 0.4 * high * at(state)).max(0.0)));
            }
            let offsets = peaks.map(|peak| STEP * f64::from(peak));
            let mut samples = offsets.map(|offset| Sample {
                offset,
                ..Sample::default()
            });
            let mut tracker = Tracker {
                samples: &mut samples,
                slopes: &mut slopes,
                ways: &mut [],
                least: 1.0,
                usual: 5.0,
                half: 8,
            };
            tracker.settle(closed);
            let has_edge =
                |number: usize| number != faint && (closed || (number > 0 && number + 1 < COUNT));
            for (number, sample) in samples.iter().enumerate() {
                let [before, after] = [(number + COUNT - 1) % COUNT, (number + 1) % COUNT];
                let mean = (offsets[before] + 2.0 * offsets[number] + offsets[after]) / 4.0;
                let all = [before, number, after].into_iter().all(has_edge);
                assert_eq!(sample.on_edge, has_edge(number));
                assert!(
                    (sample.offset - if all { mean } else { offsets[number] }).abs() < 1e-6,
                    "{number}"
                );
            }
        }
    }

    /// By the square of the distance, from nothing on the line to all of it at the end of the reach.
    #[test]
    fn a_place_farther_from_the_line_is_worth_less() {
        let mut slopes = [5.0f32; STATES];
        slopes[MIDDLE + 1] = 0.9;
        let tracker = Tracker {
            samples: &mut [],
            slopes: &mut slopes,
            ways: &mut [],
            least: 1.0,
            usual: 5.0,
            half: 8,
        };
        let worth = |place: usize| tracker.worth(0, place);
        assert!((worth(MIDDLE) - 1.0).abs() < 1e-12, "a usual edge");
        for (away, part) in [(2, 1.0 / 16.0), (4, 0.25), (6, 9.0 / 16.0), (8, 1.0)] {
            for place in [MIDDLE - away, MIDDLE + away] {
                assert!((worth(MIDDLE) - worth(place) - part * FAR).abs() < 1e-12);
            }
        }
        assert!((worth(MIDDLE + 1) + FAR / 64.0).abs() < 1e-12, "no edge");
    }

    #[test]
    fn between_places_the_top_is_that_of_a_parabola() {
        let top = |peak: f64| {
            let slope =
                |state: usize| (9.0 - 2.0 * (state as f64 - peak) * (state as f64 - peak)) as f32;
            let mut slopes: Vec<f32> = (0..STATES).map(slope).collect();
            let mut samples = [Sample::default()];
            let tracker = Tracker {
                samples: &mut samples,
                slopes: &mut slopes,
                ways: &mut [],
                least: 1.0,
                usual: 5.0,
                half: 4,
            };
            // There is no neighbour beyond either end.
            assert_eq!([0, STATES - 1].map(|end| tracker.part(0, end)), [0.0; 2]);
            tracker.part(0, peak.round() as usize)
        };
        for off in [-0.4, -0.25, 0.0, 0.1, 0.45] {
            assert!(
                (top(6.0 + off) - off).abs() < 1e-4,
                "{off}: {}",
                top(6.0 + off)
            );
        }
    }
}

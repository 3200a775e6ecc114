//! How residuals along an outline err alike, over the distance between samples.

use super::border::BorderPixel;
use super::distances::{BINS, Distances};
use super::loss::Loss;

/// Samples that are summed in 32 bits before their sum is added in 64.
pub(super) const BLOCK: usize = 64;

/// Samples within reach, mostly: an outline has some four in a row.
const KEPT: usize = 256;

/// Derivatives of the loss at samples, each reckoned once: a sample has some hundred others near it.
struct Pulls<'b> {
    border: &'b [BorderPixel],
    loss: Loss,
    /// Of the last samples before [`Self::known`], by the remainder of their number.
    last: &'b mut [f32; KEPT],
    known: usize,
}

impl<'b> Pulls<'b> {
    /// In a kilobyte of any value that is not moved.
    fn new(border: &'b [BorderPixel], loss: Loss, last: &'b mut [f32; KEPT]) -> Self {
        Self {
            border,
            loss,
            last,
            known: 0,
        }
    }

    /// That of a sample which does not come before `least`, which rises from call to call.
    fn of(&mut self, number: usize, least: usize) -> f32 {
        if number - least >= KEPT {
            return self.reckoned(number);
        }
        while self.known <= number {
            self.last[self.known % KEPT] = self.reckoned(self.known);
            self.known += 1;
        }
        self.last[number % KEPT]
    }

    fn reckoned(&self, number: usize) -> f32 {
        let residual = self.border.get(number).and_then(BorderPixel::residual_px);
        residual.map_or(0.0, |residual| self.loss.pull(residual))
    }
}

fn add_each(sums: &mut [f64], more: &[f32]) {
    for (sum, &more) in sums.iter_mut().zip(more) {
        *sum += f64::from(more);
    }
}

/// Covariance of `psi` over distance.
pub(super) struct Correlation {
    /// At distance zero, then in bins; zero from where it first fails to be positive.
    pub(super) bins: [f32; BINS + 1],
    /// Of samples that err alike.
    distances: Distances,
}

impl Correlation {
    /// Rounds in which the correlation and what the fit took of it are brought to agree.
    const ROUNDS: usize = 8;
    /// More than this part of the variance is not supposed to have been taken. What is supposed lengthens the stretches that err alike,
    /// and those what is supposed: without a narrow bound two poses 0.03 degrees apart may be told with a deviation that is four times
    /// as large for one as for the other.
    const MOST_TAKEN: f32 = 0.25;

    /// `fitted` parameters took the longest waves out of the residuals, as much as they explain
    /// of the independent stretches. The covariance of what remains is too small by the same amount at every
    /// distance, and this amount is added again.
    pub(super) fn of(border: &[BorderPixel], loss: Loss, fitted: f32) -> Self {
        let distances = Distances::of(border);
        let (raw, length) = Self::raw(border, loss, &distances);
        let mut taken = 0.0;
        let mut correlation = Self::cut(&raw, taken, &distances);
        for _ in 0..Self::ROUNDS {
            let fraction =
                (fitted * correlation.stretch_px() / length.max(1.0)).min(Self::MOST_TAKEN);
            taken = raw[0] * fraction / (1.0 - fraction);
            correlation = Self::cut(&raw, taken, &distances);
        }
        correlation
    }

    /// `taken` more at every distance, up to where it first fails to be positive.
    fn cut(raw: &[f32; BINS + 1], taken: f32, distances: &Distances) -> Self {
        let mut bins = raw.map(|value| value + taken);
        let compared = bins.iter().take(distances.bins() + 1);
        let positive = compared.take_while(|&&value| value > 0.0).count();
        bins.iter_mut().skip(positive).for_each(|bin| *bin = 0.0);
        Self {
            bins,
            distances: distances.of_first(positive.saturating_sub(1)),
        }
    }

    /// The mean product of `psi` in every bin, and the length of the outline. A bin without pairs tells nothing of its own.
    #[inline(never)]
    fn raw(border: &[BorderPixel], loss: Loss, distances: &Distances) -> ([f32; BINS + 1], f32) {
        let (mut sums, mut weights) = ([0.0f64; BINS + 1], [0.0f64; BINS + 1]);
        let mut last = [0.0; KEPT];
        let mut pulls = Pulls::new(border, loss, &mut last);
        for (few, samples) in border.chunks(BLOCK).enumerate() {
            let (mut some, mut lengths) = ([0.0f32; BINS + 1], [0.0f32; BINS + 1]);
            for (place, sample) in samples.iter().enumerate() {
                if !sample.has_residual() {
                    continue;
                }
                let index = few * BLOCK + place;
                let (l, own) = (sample.weight, pulls.of(index, index));
                some[0] += l * own * own;
                lengths[0] += l;
                for (number, other, bin) in distances.after(border, index) {
                    let weight = l * other.weight;
                    if let (Some(sum), Some(length)) = (some.get_mut(bin), lengths.get_mut(bin)) {
                        *sum += weight * own * pulls.of(number, index);
                        *length += weight;
                    }
                }
            }
            add_each(&mut sums, &some);
            add_each(&mut weights, &lengths);
        }
        let mut before = 0.0;
        let mean = |bin: usize| {
            if weights[bin] > 0.0 {
                before = (sums[bin] / weights[bin]) as f32;
            }
            before
        };
        (core::array::from_fn(mean), weights[0] as f32)
    }

    /// The samples listed after one that err like it, with their places in the list and the covariance with it, as many times as
    /// one pair stands for.
    pub(super) fn after<'b>(
        &self,
        border: &'b [BorderPixel],
        index: usize,
    ) -> impl Iterator<Item = (usize, &'b BorderPixel, f32)> {
        let times = self.distances.one_in() as f32;
        let near = self.distances.after(border, index);
        near.map(move |(number, other, bin)| {
            let covariance = self.bins.get(bin).copied().unwrap_or(0.0);
            (number, other, times * covariance)
        })
    }

    /// Length of outline that errs alike, pixels: the integral of the correlation to both sides, at least one pixel, and as much as a
    /// sample stands for: against a film that is several.
    pub(super) fn stretch_px(&self) -> f32 {
        let [own, rest @ ..] = &self.bins;
        let least = self.distances.apart_px().max(1.0);
        if *own <= 0.0 {
            return least;
        }
        (2.0 * self.distances.width_px() * rest.iter().sum::<f32>() / own).max(least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::refine::border::Residual;
    use proptest::prelude::*;
    use std::vec::Vec;

    /// A wave as long as the outline looks like few stretches that err alike, and nothing taken or nearly all of it explain it.
    #[test]
    fn a_fit_takes_no_more_than_a_quarter_of_the_variance() {
        let sample = |k: u16| BorderPixel {
            column: 8 + k,
            row: 9,
            slope: [0, 1],
            weight: 1.0,
            residual: Residual::Px(0.5 * libm::sinf(f32::from(k) / 9.0)).into(),
            ..BorderPixel::EMPTY
        };
        let border: Vec<BorderPixel> = (0..300).map(sample).collect();
        let loss = Loss::Tukey(2.5);
        let (raw, _) = Correlation::raw(&border, loss, &Distances::of(&border));
        let taken = Correlation::of(&border, loss, 6.0).bins[0] / raw[0] - 1.0;
        assert!((taken - 1.0 / 3.0).abs() < 1e-6, "{taken}");
    }

    /// Where one pixel of several is a sample that stands for all of them, what it errs is that of all.
    #[test]
    fn there_are_no_more_independent_stretches_than_samples() {
        for apart in [1u16, 3, 5, 8] {
            let sample = |k: u16| BorderPixel {
                column: 8 + apart * k,
                row: 9,
                slope: [0, 1],
                weight: f32::from(apart),
                // Each by itself, as noise has it.
                residual: Residual::Px(f32::from(k * 37 % 11) / 11.0 - 5.0 / 11.0).into(),
                ..BorderPixel::EMPTY
            };
            let border: Vec<BorderPixel> = (0..300).map(sample).collect();
            let correlation = Correlation::of(&border, Loss::Tukey(2.5), 0.0);
            let stretches = 300.0 * f32::from(apart) / correlation.stretch_px();
            assert!(stretches <= 300.5, "{stretches} of {apart}");
        }
    }

    /// The same picture in twice as many pixels.
    #[test]
    fn stretches_grow_with_the_picture() {
        let stretch = |size: u16| {
            let border: Vec<BorderPixel> = (0..300 * size)
                .map(|k| BorderPixel {
                    column: 8 + k,
                    row: 9,
                    slope: [0, 1],
                    weight: 1.0,
                    residual: Residual::Px(libm::sinf(f32::from(k) / f32::from(9 * size))).into(),
                    ..BorderPixel::EMPTY
                })
                .collect();
            Correlation::of(&border, Loss::Tukey(2.5), 0.0).stretch_px()
        };
        let (one, two, five) = (stretch(1), stretch(2), stretch(5));
        assert!(one > 10.0, "{one}");
        assert!((two / one - 2.0).abs() < 0.1, "{one} {two}");
        assert!((five / one - 5.0).abs() < 0.25, "{one} {five}");
    }

    /// Samples of any place and residual, listed row by row, all of one side of a part.
    fn listed(places: &[(u16, u16, f32)]) -> Vec<BorderPixel> {
        let mut places = places.to_vec();
        places.sort_by_key(|&(row, column, _)| (row, column));
        let sample = |(row, column, px): (u16, u16, f32)| BorderPixel {
            column,
            row,
            slope: [2, 1],
            weight: 0.5 + f32::from(column % 3),
            residual: Residual::Px(px).into(),
            ..BorderPixel::EMPTY
        };
        places.into_iter().map(sample).collect()
    }

    #[test]
    fn what_is_taken_counts_at_every_distance_up_to_where_nothing_errs_alike() {
        let border = listed(&[(0, 0, 0.1); 600]);
        let distances = Distances::of(&border);
        let mut raw = [-0.5f32; BINS + 1];
        (raw[0], raw[1], raw[2], raw[4]) = (4.0, 2.0, -0.1, 1.0);
        let cut = |taken: f32| Correlation::cut(&raw, taken, &distances);
        assert_eq!(cut(0.0).bins[..4], [4.0, 2.0, 0.0, 0.0]);
        assert_eq!(cut(0.25).bins[..6], [4.25, 2.25, 0.15, 0.0, 0.0, 0.0]);
        // Two bins to both sides, as parts of the variance.
        let width = distances.width_px();
        let expected = 2.0 * width * (2.25 + 0.15) / 4.25;
        assert!((cut(0.25).stretch_px() - expected).abs() < 1e-4 * expected);
        raw[0] = -1.0;
        assert_eq!(Correlation::cut(&raw, 0.0, &distances).stretch_px(), 1.0);
    }

    properties! {
        #[test]
        fn covariances_are_mean_products_over_all_pairs_of_a_distance(
            places in proptest::collection::vec((0u16..60, 0u16..60, -3.0f32..3.0), 2..220),
        ) {
            let border = listed(&places);
            let (loss, distances) = (Loss::Cauchy(1.5), Distances::of(&border));
            prop_assert_eq!(distances.one_in(), 1);
            let (raw, length) = Correlation::raw(&border, loss, &distances);
            let (mut sums, mut weights) = ([0.0f64; BINS + 1], [0.0f64; BINS + 1]);
            let pull = |one: &BorderPixel| f64::from(loss.pull(one.residual_px().unwrap_or(0.0)));
            for (index, one) in border.iter().enumerate() {
                sums[0] += f64::from(one.weight) * pull(one) * pull(one);
                weights[0] += f64::from(one.weight);
                for (_, other, bin) in distances.after(&border, index) {
                    let weight = f64::from(one.weight * other.weight);
                    sums[bin] += weight * pull(one) * pull(other);
                    weights[bin] += weight;
                }
            }
            prop_assert!((f64::from(length) - weights[0]).abs() < 1e-3);
            let mut before = 0.0;
            for bin in 0..=BINS {
                if weights[bin] > 0.0 {
                    before = sums[bin] / weights[bin];
                }
                prop_assert!((f64::from(raw[bin]) - before).abs() < 1e-4, "{bin}: {} for {before}", raw[bin]);
            }
        }

        #[test]
        fn derivatives_that_are_kept_are_those_that_are_reckoned(
            residuals in proptest::collection::vec(proptest::option::weighted(0.8, -9.0f32..9.0), 1..900),
            every in 1usize..9, reach in 1usize..600,
        ) {
            let sample = |residual: &Option<f32>| {
                let mut pixel = BorderPixel::EMPTY;
                pixel.set_residual(residual.map_or(Residual::Missing, Residual::Px));
                pixel
            };
            let border: Vec<BorderPixel> = residuals.iter().map(sample).collect();
            let loss = Loss::Cauchy(1.5);
            let mut last = [0.5; KEPT];
            let mut pulls = Pulls::new(&border, loss, &mut last);
            for least in (0..residuals.len()).step_by(every) {
                let near = residuals.iter().enumerate().skip(least).take(reach);
                for (number, residual) in near {
                    let own = residual.map_or(0.0, |px| loss.pull(px));
                    prop_assert_eq!(pulls.of(number, least), own);
                }
            }
        }
    }
}

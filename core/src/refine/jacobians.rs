//! Jacobians of samples, kept where there is memory for them.

use super::border::BorderPixel;
use crate::render::Projected;

/// Numbers in a Jacobian, and places of memory that they take: two each.
const PARAMETERS: usize = 6;
const PLACES: usize = PARAMETERS / 2;

/// Jacobians of samples: of as many as there is memory for each is reckoned once, because a sample has some hundred others near
/// it; of the others it is reckoned again each time.
pub(super) struct Jacobians<'j, F> {
    pub(super) border: &'j [BorderPixel],
    reckon: F,
    kept: &'j [[Projected; PLACES]],
}

impl<'j, F: Fn(&BorderPixel) -> [f32; PARAMETERS]> Jacobians<'j, F> {
    pub(super) fn new(border: &'j [BorderPixel], reckon: F, memory: &'j mut [Projected]) -> Self {
        let kept = memory.as_chunks_mut::<PLACES>().0;
        for (kept, sample) in kept.iter_mut().zip(border) {
            let numbers = reckon(sample).map(|number| u64::from(number.to_bits()));
            let pairs = numbers.as_chunks::<2>().0.iter();
            for (place, &[low, high]) in kept.iter_mut().zip(pairs) {
                *place = (high << 32 | low).into();
            }
        }
        Self {
            border,
            reckon,
            kept,
        }
    }

    /// That of a sample.
    pub(super) fn of(&self, number: usize) -> [f32; PARAMETERS] {
        let Some(&[a, b, c]) = self.kept.get(number) else {
            let sample = self.border.get(number);
            return sample.map_or([0.0; PARAMETERS], &self.reckon);
        };
        let pair = |place: Projected| {
            let bits = u64::from(place);
            let (low, high) = (bits as u32, (bits >> 32) as u32);
            [f32::from_bits(low), f32::from_bits(high)]
        };
        let ([a, b], [c, d], [e, f]) = (pair(a), pair(b), pair(c));
        [a, b, c, d, e, f]
    }
}

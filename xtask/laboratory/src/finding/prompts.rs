//! What a person might have pointed at, from a mask of the implant.

use fluoropose::image::contour::Point;
use fluoropose::image::mask::Mask;
use fluoropose_tracing::one_click::Prompt;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Clicks are at least so deep inside the mask, pixels: who aims at an implant does not aim at
/// its edge.
const DEPTH: f64 = 3.0;
/// A box is wider than the implant by so much on each side, parts of its longer side.
const WIDER: [f64; 2] = [0.05, 0.15];

/// Kinds of prompts, in the order of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    /// A click where the implant is thickest.
    Deepest,
    /// A click anywhere inside.
    Anywhere,
    /// A rough box.
    Box,
    /// A click at the middle of the model, where it truly is.
    Centre,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Deepest, Self::Anywhere, Self::Box, Self::Centre];

    /// The word for it in the table.
    pub fn word(self) -> &'static str {
        match self {
            Self::Deepest => "click in the middle",
            Self::Anywhere => "click anywhere inside",
            Self::Box => "rough box",
            Self::Centre => "click at its centre",
        }
    }

    /// A prompt of this kind for the implant of `mask`, the middle of whose model is at `centre`, where that is known; `seed`
    /// tells random ones apart. `None` for a mask too thin to click into.
    pub fn prompt(self, mask: &Mask<'_>, centre: Option<Point>, seed: u64) -> Option<Prompt> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        match self {
            Self::Deepest => {
                let all = depths(mask);
                let deepest = all.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
                deepest.map(|(at, _)| Prompt::Click(at))
            }
            Self::Anywhere => {
                let all = depths(mask);
                let inside: Vec<_> = all.iter().filter(|(_, depth)| *depth >= DEPTH).collect();
                let (at, _) = inside.get(random.random_range(0..inside.len().max(1)))?;
                Some(Prompt::Click(*at))
            }
            Self::Box => {
                let (columns, rows) = mask.bounds();
                let long = columns.len().max(rows.len()) as f64;
                let mut margin = || long * random.random_range(WIDER[0]..WIDER[1]);
                let low = Point::new(
                    columns.start as f64 - margin(),
                    rows.start as f64 - margin(),
                );
                let high = Point::new(columns.end as f64 + margin(), rows.end as f64 + margin());
                Some(Prompt::Box(low, high))
            }
            Self::Centre => centre.map(Prompt::Click),
        }
    }
}

/// The set pixels of a mask and how far each is from the nearest clear one, pixels (chamfer 3-4).
fn depths(mask: &Mask<'_>) -> Vec<(Point, f64)> {
    let (columns, rows) = mask.bounds();
    let (width, height) = (columns.len() + 2, rows.len() + 2);
    let mut depth = vec![0u32; width * height];
    let set =
        |c: usize, r: usize| c > 0 && r > 0 && mask.get(columns.start + c - 1, rows.start + r - 1);
    let inner: Vec<(usize, usize)> = (1..height - 1)
        .flat_map(|row| (1..width - 1).map(move |column| (column, row)))
        .collect();
    for forward in [true, false] {
        let mut visit = |(c, r): (usize, usize)| {
            let at = |c: usize, r: usize| r * width + c;
            let near = if forward {
                [
                    (at(c - 1, r), 3),
                    (at(c, r - 1), 3),
                    (at(c - 1, r - 1), 4),
                    (at(c + 1, r - 1), 4),
                ]
            } else {
                [
                    (at(c + 1, r), 3),
                    (at(c, r + 1), 3),
                    (at(c + 1, r + 1), 4),
                    (at(c - 1, r + 1), 4),
                ]
            };
            let least = near
                .into_iter()
                .map(|(index, step)| depth[index] + step)
                .min();
            let least = least.unwrap_or(0);
            let own = if forward { u32::MAX } else { depth[at(c, r)] };
            depth[at(c, r)] = if set(c, r) { least.min(own) } else { 0 };
        };
        if forward {
            inner.iter().copied().for_each(&mut visit);
        } else {
            inner.iter().rev().copied().for_each(&mut visit);
        }
    }
    let place = |(c, r): (usize, usize)| {
        let column = (columns.start + c) as f64 - 0.5;
        Point::new(column, (rows.start + r) as f64 - 0.5)
    };
    inner
        .iter()
        .filter(|&&(c, r)| set(c, r))
        .map(|&(c, r)| (place((c, r)), f64::from(depth[r * width + c]) / 3.0))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::MaskBuffer;

    fn plate() -> MaskBuffer {
        let mut buffer = MaskBuffer::new(100, 60).unwrap();
        buffer.draw(|mask| {
            for (column, row) in (0..41 * 21).map(|k| (k % 41, k / 41)) {
                mask.set(30 + column, 20 + row, true);
            }
        });
        buffer
    }

    #[test]
    fn clicks_lie_inside_and_boxes_hold_the_implant() {
        let plate = plate();
        let mask = plate.mask();
        let Some(Prompt::Click(middle)) = Kind::Deepest.prompt(&mask, None, 0) else {
            panic!("a click")
        };
        assert_eq!(middle.row, 30.5);
        assert!((40.0..61.0).contains(&middle.column));
        for seed in 0..50 {
            let Some(Prompt::Click(at)) = Kind::Anywhere.prompt(&mask, None, seed) else {
                panic!("a click")
            };
            assert!((32.0..69.0).contains(&at.column) && (22.0..39.0).contains(&at.row));
            let Some(Prompt::Box(low, high)) = Kind::Box.prompt(&mask, None, seed) else {
                panic!("a box")
            };
            assert!((30.0 - 6.15..=30.0 - 2.05).contains(&low.column));
            assert!((41.0 + 2.05..=41.0 + 6.15).contains(&high.row));
        }
    }
}

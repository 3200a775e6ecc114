//! The disguise that a seed draws.

use std::ops::Range;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::plan::{Curve, Field, Frames, Kind, Marks, Mesh, Models, Plan, Tone, View};

fn hundredths(value: f64) -> f64 {
    (100.0 * value).round() / 100.0
}

/// Draws with a chance, among several, and from a range, at two digits: what is printed is then what was done.
struct Draw(ChaCha8Rng);

impl Draw {
    fn chance(&mut self, part: f64) -> bool {
        self.0.random_bool(part)
    }

    fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.0.random_range(0..of.len())]
    }

    fn from(&mut self, range: Range<f64>) -> f64 {
        hundredths(self.0.random_range(range))
    }

    fn sometimes(&mut self, part: f64, range: Range<f64>) -> Option<f64> {
        self.chance(part).then(|| self.from(range))
    }
}

impl Plan {
    /// The disguise that a seed draws for a film of `count` frames of `size` pixels. The unit is always mm: a model in another one is told when it is
    /// read, and every length is then in that.
    #[must_use]
    pub fn drawn(seed: u64, count: usize, size: (usize, usize)) -> Self {
        let mut draw = Draw(ChaCha8Rng::seed_from_u64(seed));
        Self {
            seed,
            frames: Frames::drawn(&mut draw, count),
            view: View::drawn(&mut draw, size),
            tone: Tone::drawn(&mut draw),
            marks: Marks::drawn(&mut draw),
            models: Models::drawn(&mut draw),
        }
    }
}

impl Frames {
    /// Some 16 frames of a long film, which takes an hour else; one film of six is short, down to a single frame.
    fn drawn(draw: &mut Draw, count: usize) -> Self {
        let every = 1 + count / draw.one(&[16, 16, 24]);
        let short = draw.sometimes(1.0 / 6.0, 1.0..9.0).map(|n| n as usize);
        let first = draw.from(0.0..count as f64 / 2.0) as usize;
        Self {
            first: if short.is_some() { first } else { 0 },
            every,
            count: short.unwrap_or(0),
            backwards: draw.chance(0.3),
            prefix: draw.one(&["", "f", "IM_", "knee 2-"]).to_owned(),
            digits: draw.one(&[1, 4, 6]),
            kind: draw.one(&[
                Kind::Png8,
                Kind::Png16,
                Kind::Tiff8,
                Kind::Tiff12,
                Kind::Jpeg85,
                Kind::Dicom8,
                Kind::Dicom12,
                Kind::Dicom16,
                Kind::Dicom12Inverse,
            ]),
        }
    }
}

impl View {
    /// Frames of 480 to 1400 pixels in which the components are nearly as large as they were; in one of four they come to lie near the border.
    fn drawn(draw: &mut Draw, (width, _): (usize, usize)) -> Self {
        let side = draw.one(&[480, 512, 640, 768, 900, 1024, 1024, 1400]);
        let other = draw.one(&[1.0, 1.0, 1.0, 0.82, 1.25]);
        let near = draw.chance(0.25);
        let (edge, across) = (draw.from(0.12..0.25), draw.from(0.35..0.65));
        let edge = if draw.chance(0.5) {
            edge
        } else {
            hundredths(1.0 - edge)
        };
        let middle = match (near, draw.chance(0.5)) {
            (false, _) => [draw.from(0.4..0.6), across],
            (true, true) => [edge, across],
            (true, false) => [across, edge],
        };
        let square = draw.chance(0.75);
        Self {
            size: [side, (side as f64 * other) as usize],
            turn_deg: draw.sometimes(0.85, -180.0..180.0).unwrap_or(0.0),
            mirrored: draw.chance(0.5),
            scale: hundredths(side as f64 / width as f64 * draw.from(0.8..1.2)),
            aspect: if square { 1.0 } else { draw.from(0.93..1.08) },
            middle: Some(middle),
            principal_distance: square && draw.chance(0.6),
        }
    }
}

impl Tone {
    fn drawn(draw: &mut Draw) -> Self {
        let curve = match draw.one(&[0, 0, 1, 2, 3]) {
            0 => Curve::Same,
            1 => Curve::Gamma(draw.from(0.5..2.0)),
            2 => Curve::Log(draw.from(3.0..40.0)),
            _ => Curve::Clipped([draw.from(0.0..0.08), draw.from(0.0..0.1)]),
        };
        Self {
            curve,
            negative: draw.chance(0.4),
            contrast: draw.sometimes(0.3, 0.4..1.0).unwrap_or(1.0),
            blur_px: draw.sometimes(0.25, 0.4..1.4).unwrap_or(0.0),
            noise: draw.sometimes(0.35, 0.01..0.04).unwrap_or(0.0),
            levels: if draw.chance(0.15) { 32 } else { 0 },
        }
    }
}

impl Marks {
    fn drawn(draw: &mut Draw) -> Self {
        let field = match draw.one(&[0, 0, 0, 1, 2]) {
            1 => Field::Round(draw.from(0.46..0.55)),
            2 => Field::Shutters(draw.from(0.02..0.1)),
            _ => Field::Whole,
        };
        Self {
            field,
            white_surround: draw.chance(0.4),
            words: draw.chance(0.3),
        }
    }
}

impl Models {
    fn drawn(draw: &mut Draw) -> Self {
        Self {
            turned: draw.chance(0.85),
            mesh: draw.one(&[Mesh::Stl, Mesh::Obj, Mesh::Ply]),
            unwelded: draw.chance(0.3),
            flipped: draw.one(&[0.0, 0.0, 1.0, 0.3]),
            doubled: draw.one(&[0.0, 0.0, 0.02]),
            ..Self::default()
        }
    }
}

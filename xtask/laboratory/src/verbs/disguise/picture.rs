//! Pixels of a disguised frame.

use fluoropose::image::grey::Grey;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::lens::Lens;
use super::marks::burn_in;
use super::plan::{Curve, Field, Marks, Plan, Tone};

/// Intensities of 0 to 1, row by row.
pub(super) struct Picture {
    /// Columns.
    pub(super) width: usize,
    /// Rows.
    pub(super) height: usize,
    /// From the top, each row from the left.
    pub(super) pixels: Vec<f64>,
}

impl Picture {
    /// A frame of the film, `grey` of at most `white`, as the disguise shows it; `number` draws its noise, and `clip` is where a steep curve ends.
    pub(super) fn of(
        plan: &Plan,
        lens: &Lens,
        (grey, white): (&dyn Grey, f64),
        clip: [f64; 2],
        number: u64,
    ) -> Self {
        let mut picture = Self::seen(plan, lens, |at| Some(grey.at(at[0], at[1])? / white), clip);
        blur(&mut picture, plan.tone.blur_px);
        add_noise(&mut picture, plan, number);
        if plan.marks.words {
            let size = (picture.width, picture.height);
            burn_in(&mut picture.pixels, size);
        }
        picture
    }

    /// What lies at each pixel, averaged over it where it covers several of the film's.
    fn seen(
        plan: &Plan,
        lens: &Lens,
        film: impl Fn([f64; 2]) -> Option<f64>,
        clip: [f64; 2],
    ) -> Self {
        let (width, height) = (lens.to.width(), lens.to.height());
        let fine = (1.5 / lens.scale()).ceil().clamp(1.0, 4.0) as usize;
        let step = |at: usize, k: usize| at as f64 + (k as f64 + 0.5) / fine as f64;
        let surround = f64::from(u8::from(plan.marks.white_surround));
        let pixel = |at: usize| {
            let (column, row) = (at % width, at / width);
            if !plan.marks.shows([column, row], [width, height]) {
                return surround;
            }
            let parts = (0..fine * fine).map(|k| {
                let place = [step(column, k % fine), step(row, k / fine)];
                let value = film(lens.backwards(place));
                value.map_or(surround, |value| plan.tone.of(value, clip))
            });
            parts.sum::<f64>() / (fine * fine) as f64
        };
        let pixels = (0..width * height).map(pixel).collect();
        Self {
            width,
            height,
            pixels,
        }
    }
}

impl Marks {
    /// Whether a pixel is within the field.
    fn shows(&self, [column, row]: [usize; 2], [width, height]: [usize; 2]) -> bool {
        let [x, y] = [(column, width), (row, height)]
            .map(|(at, side)| (at as f64 + 0.5) / side as f64 - 0.5);
        match self.field {
            Field::Whole => true,
            Field::Round(radius) => {
                let shorter = width.min(height) as f64;
                (x * width as f64).hypot(y * height as f64) < radius * shorter
            }
            Field::Shutters(part) => x.abs().max(y.abs()) < 0.5 - part,
        }
    }
}

impl Tone {
    /// The grey value of an intensity.
    fn of(&self, value: f64, [black, white]: [f64; 2]) -> f64 {
        let shown = match self.curve {
            Curve::Same => value,
            Curve::Gamma(power) => value.powf(power),
            Curve::Log(k) => (k * value).ln_1p() / k.ln_1p(),
            Curve::Clipped(_) => ((value - black) / (white - black)).clamp(0.0, 1.0),
        };
        let shown = if self.negative { 1.0 - shown } else { shown };
        0.5 + self.contrast * (shown - 0.5)
    }

    /// Where a steep curve is black and white on a film with such intensities.
    pub(super) fn clip(&self, mut intensities: Vec<f64>) -> [f64; 2] {
        let Curve::Clipped([below, above]) = self.curve else {
            return [0.0, 1.0];
        };
        intensities.sort_by(f64::total_cmp);
        let last = intensities.len().saturating_sub(1) as f64;
        let at = |part: f64| intensities.get((part * last) as usize).copied();
        let (black, white) = (at(below).unwrap_or(0.0), at(1.0 - above).unwrap_or(1.0));
        [black, white.max(black + 1e-3)]
    }
}

fn blur(picture: &mut Picture, sigma: f64) {
    if sigma <= 0.0 {
        return;
    }
    let reach = (4.0 * sigma).ceil() as isize;
    let weights: Vec<f64> = (-reach..=reach)
        .map(|k| (-0.5 * (k as f64 / sigma).powi(2)).exp())
        .collect();
    let sum: f64 = weights.iter().sum();
    let (width, height) = (picture.width as isize, picture.height as isize);
    for (right, down) in [(1, 0), (0, 1)] {
        let old = std::mem::take(&mut picture.pixels);
        let pixel = |at: usize| {
            let (column, row) = (at as isize % width, at as isize / width);
            let taps = weights.iter().zip(-reach..).map(|(weight, k)| {
                let column = (column + k * right).clamp(0, width - 1);
                let row = (row + k * down).clamp(0, height - 1);
                weight * old[(row * width + column) as usize]
            });
            taps.sum::<f64>() / sum
        };
        picture.pixels = (0..old.len()).map(pixel).collect();
    }
}

/// Noise that is alike in dark and bright, and few levels.
fn add_noise(picture: &mut Picture, plan: &Plan, number: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(plan.seed);
    random.set_stream(number + 1);
    let levels = f64::from(plan.tone.levels.saturating_sub(1));
    for pixel in &mut picture.pixels {
        if plan.tone.noise > 0.0 {
            // Box and Muller's.
            let (a, b) = (
                random.random_range(f64::MIN_POSITIVE..1.0),
                random.random_range(0.0..1.0),
            );
            let normal = (-2.0 * f64::ln(a)).sqrt() * (std::f64::consts::TAU * b).cos();
            *pixel = (*pixel + plan.tone.noise * normal).clamp(0.0, 1.0);
        }
        if levels > 0.0 {
            *pixel = (*pixel * levels).round() / levels;
        }
    }
}

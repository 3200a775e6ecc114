//! Frames drawn for the tests of tracing tools: shapes of known outline on a uniform background.

use fluoropose::image::contour::Point;
use std::vec::Vec;

/// A frame that is being drawn.
pub(crate) struct SyntheticFrame {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) grey: Vec<f64>,
}

impl SyntheticFrame {
    pub(crate) fn new(width: usize, height: usize, background: f64) -> Self {
        Self {
            width,
            height,
            grey: std::vec![background; width * height],
        }
    }

    /// Draws the inside of a shape, given by its signed distance (negative inside), in one grey. The edge is 2 pixels wide,
    /// and where the distance is 0 the grey is half way between the two.
    pub(crate) fn draw(&mut self, grey: f64, distance: impl Fn(f64, f64) -> f64) {
        for row in 0..self.height {
            for column in 0..self.width {
                let away = distance(column as f64 + 0.5, row as f64 + 0.5);
                let fraction = (0.5 - away / 2.0).clamp(0.0, 1.0);
                let pixel = &mut self.grey[row * self.width + column];
                *pixel += fraction * (grey - *pixel);
            }
        }
    }

    pub(crate) fn disc(&mut self, [x, y]: [f64; 2], radius: f64, grey: f64) {
        self.draw(grey, |column, row| (column - x).hypot(row - y) - radius);
    }

    /// A rectangle of half sides `half` around a centre, rotated by an angle in radians.
    pub(crate) fn plate(&mut self, [x, y]: [f64; 2], half: [f64; 2], angle: f64, grey: f64) {
        self.draw(grey, |column, row| {
            let (right, down) = (column - x, row - y);
            let (sin, cos) = angle.sin_cos();
            let along = (right * cos + down * sin).abs() - half[0];
            let across = (down * cos - right * sin).abs() - half[1];
            let outside = along.max(0.0).hypot(across.max(0.0));
            outside + along.max(across).min(0.0)
        });
    }

    /// Adds approximately normal noise with a standard deviation in grey values.
    pub(crate) fn add_noise(&mut self, sigma: f64, seed: u32) {
        let mut random = Random(seed);
        for pixel in &mut self.grey {
            // Twelve uniform numbers have the variance 1.
            let sum: f64 = (0..12).map(|_| random.uniform()).sum();
            *pixel += sigma * (sum - 6.0);
        }
    }

    pub(crate) fn eight_bit(&self) -> Vec<u8> {
        self.grey.iter().map(|g| g.round() as u8).collect()
    }

    pub(crate) fn sixteen_bit(&self) -> Vec<u16> {
        self.grey.iter().map(|g| g.round() as u16).collect()
    }
}

/// A generator of pseudo-random numbers; the field is its seed.
pub(crate) struct Random(pub(crate) u32);

impl Random {
    /// A number from 0 to 1.
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0 >> 8) / f64::from(1u32 << 24)
    }
}

/// Points on a circle, clockwise on the screen.
pub(crate) fn circle([x, y]: [f64; 2], radius: f64, count: usize) -> Vec<Point> {
    let point = |k: usize| {
        let (sin, cos) = (core::f64::consts::TAU * k as f64 / count as f64).sin_cos();
        Point::new(x + radius * cos, y + radius * sin)
    };
    (0..count).map(point).collect()
}

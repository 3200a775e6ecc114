//! Films for the tests of tracing aids: shapes of known outline on a bright ground.

use fluoropose::image::contour::Point;
use std::vec::Vec;

/// A film being drawn.
pub(crate) struct Film {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) grey: Vec<f64>,
}

impl Film {
    pub(crate) fn new(width: usize, height: usize, ground: f64) -> Self {
        Self {
            width,
            height,
            grey: std::vec![ground; width * height],
        }
    }

    /// Draws what lies inside of a signed distance (negative inside) in one grey; the edge is 2 pixels wide and half way
    /// between the two greys where the distance is 0.
    pub(crate) fn draw(&mut self, grey: f64, distance: impl Fn(f64, f64) -> f64) {
        for row in 0..self.height {
            for column in 0..self.width {
                let away = distance(column as f64 + 0.5, row as f64 + 0.5);
                let share = (0.5 - away / 2.0).clamp(0.0, 1.0);
                let pixel = &mut self.grey[row * self.width + column];
                *pixel += share * (grey - *pixel);
            }
        }
    }

    pub(crate) fn disc(&mut self, [x, y]: [f64; 2], radius: f64, grey: f64) {
        self.draw(grey, |column, row| (column - x).hypot(row - y) - radius);
    }

    /// A plate of `half` sizes about a middle, turned by an angle in radians.
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

    /// Adds noise that is about normal, of a standard deviation in grey values.
    pub(crate) fn add_noise(&mut self, sigma: f64, seed: u32) {
        let mut random = Random(seed);
        for pixel in &mut self.grey {
            // Twelve uniform numbers have the variance 1.
            let sum: f64 = (0..12).map(|_| random.share()).sum();
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

/// Numbers that look random and are the same every time.
pub(crate) struct Random(pub(crate) u32);

impl Random {
    /// From 0 to 1.
    pub(crate) fn share(&mut self) -> f64 {
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

//! The part of the detector that the beam lights, and how evenly.

use super::physics::Field;
use super::plane::Plane;
use libm::{exp, hypot};

/// The round window's radius as a part of the frame's half width, and the softness of its edge in pixels.
const COLLIMATOR: f64 = 0.985;
const COLLIMATOR_EDGE: f64 = 2.5;

/// The window that the beam comes through.
pub(super) struct Window {
    field: Field,
    centre: [f64; 2],
    radius: f64,
}

impl Window {
    pub(super) fn of(picture: &Plane, field: Field) -> Self {
        let centre = [picture.width, picture.height].map(|count| count as f64 / 2.0);
        Self {
            field,
            centre,
            radius: COLLIMATOR * centre[0].min(centre[1]),
        }
    }

    fn distance(&self, row: usize, column: usize) -> f64 {
        hypot(
            column as f64 + 0.5 - self.centre[0],
            row as f64 + 0.5 - self.centre[1],
        )
    }

    /// Strength of the open beam: behind a round window a little weaker towards its edge.
    pub(super) fn beam(&self, row: usize, column: usize) -> f64 {
        if self.field == Field::Flat {
            return 1.0;
        }
        let part = (self.distance(row, column) / self.radius).min(1.0);
        1.0 - 0.16 * part * part
    }

    /// What the window lets through.
    pub(super) fn open(&self, row: usize, column: usize) -> f64 {
        if self.field == Field::Flat {
            return 1.0;
        }
        let beyond = self.distance(row, column) - self.radius;
        1.0 / (1.0 + exp(beyond / (COLLIMATOR_EDGE / 4.0)))
    }
}

//! A sample of the model's outline, and what was found of the target's along its normal.

pub(super) use crate::image::profile::NormalReading;

/// A sample of the model's outline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BorderPixel {
    pub(super) column: u16,
    pub(super) row: u16,
    /// Outward unit normal: to the right and downwards.
    pub(super) normal: [f32; 2],
    /// Arc length of the outline in this pixel, pixels.
    pub(super) weight: f32,
    /// Least and greatest distance of the surface from the camera plane, mm.
    pub(super) near: f32,
    pub(super) far: f32,
    pub(super) residual: Residual,
    /// How fast the outline moves along the normal with each parameter of a step.
    pub(super) jacobian: [f32; 6],
}

/// How far the target's outline lies beyond the model's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Residual {
    /// It was not looked for: the model's own outline or the depth behind it is not known.
    #[default]
    None,
    /// It lies in unknown pixels of the target.
    Unknown,
    /// The target has no outline within the range.
    Missing,
    /// Distance along the outward normal, pixels.
    Px(f32),
}

impl Residual {
    /// What was found where `expected` would be none at all.
    pub(super) fn of(found: NormalReading, expected: f64) -> Self {
        match found {
            NormalReading::Unknown => Self::Unknown,
            NormalReading::Nothing => Self::Missing,
            NormalReading::At(place) => Self::Px((place - expected) as f32),
        }
    }
}

impl BorderPixel {
    /// What static memory is filled with.
    pub const EMPTY: Self = Self {
        column: 0,
        row: 0,
        normal: [0.0; 2],
        weight: 0.0,
        near: 0.0,
        far: 0.0,
        residual: Residual::None,
        jacobian: [0.0; 6],
    };

    /// The residual where there is one, pixels.
    pub(super) fn residual_px(&self) -> Option<f64> {
        match self.residual {
            Residual::Px(residual) => Some(f64::from(residual)),
            _ => None,
        }
    }

    /// Continuous image coordinates of the pixel's centre.
    pub(super) fn place(&self) -> [f64; 2] {
        [f64::from(self.column) + 0.5, f64::from(self.row) + 0.5]
    }

    /// Whether the depth behind the pixel is known.
    pub(super) fn is_on_surface(&self) -> bool {
        self.far > 0.0
    }

    /// A piece of the surface or of the contour that covers the pixel.
    pub(super) fn cover(&mut self, depth: f32) {
        self.near = self.near.min(depth);
        self.far = self.far.max(depth);
    }

    /// Distance of the contour from the camera plane, mm.
    pub(super) fn depth(&self) -> f64 {
        f64::from(self.near + self.far) / 2.0
    }
}

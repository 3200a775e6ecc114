//! A sample of the model's outline, and what was found of the target's along its normal.

pub(super) use crate::image::profile::NormalReading;

use crate::math::root_of_whole;

/// A sample of the model's outline. It is small, because a microcontroller keeps a thousand of them: what a sample's own
/// numbers tell again (its normal, how its place moves with the pose) is reckoned where it is needed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BorderPixel {
    pub(super) column: u16,
    pub(super) row: u16,
    /// Which way outwards is, to the right and downwards, of no certain length: whole numbers as the drawing has them, at
    /// most 160.
    pub(super) slope: [i16; 2],
    /// Arc length of the outline in this pixel, pixels.
    pub(super) weight: f32,
    /// Least and greatest distance of the surface from the camera plane, mm.
    pub(super) near: f32,
    pub(super) far: f32,
    pub(super) residual: Kept,
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

    /// The same of what was found `from` somewhere else.
    pub(super) fn beyond(self, from: f32) -> Self {
        match self {
            Self::Px(place) => Self::Px(place - from),
            other => other,
        }
    }
}

/// A residual in four bytes: the bits of its number, or of a number that is none, less those of [`NONE`], so that static memory
/// is all zeros.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Kept(u32);

/// Bits of numbers that are none and that no arithmetic makes.
const NONE: u32 = 0x7fc5_a5a1;
const UNKNOWN: u32 = 0x7fc5_a5a2;
const MISSING: u32 = 0x7fc5_a5a3;

impl From<Residual> for Kept {
    fn from(residual: Residual) -> Self {
        let bits = match residual {
            Residual::None => NONE,
            Residual::Unknown => UNKNOWN,
            Residual::Missing => MISSING,
            Residual::Px(residual) => residual.to_bits(),
        };
        Self(bits ^ NONE)
    }
}

impl From<Kept> for Residual {
    fn from(Kept(kept): Kept) -> Self {
        match kept ^ NONE {
            NONE => Self::None,
            UNKNOWN => Self::Unknown,
            MISSING => Self::Missing,
            bits => Self::Px(f32::from_bits(bits)),
        }
    }
}

impl BorderPixel {
    /// What static memory is filled with.
    pub const EMPTY: Self = Self {
        column: 0,
        row: 0,
        slope: [0; 2],
        weight: 0.0,
        near: 0.0,
        far: 0.0,
        residual: Kept(0),
    };

    pub(super) fn residual(&self) -> Residual {
        self.residual.into()
    }

    pub(super) fn set_residual(&mut self, residual: Residual) {
        self.residual = residual.into();
    }

    /// Whether there is one, without a call: it is asked of pairs of samples.
    #[inline(always)]
    pub(super) fn has_residual(&self) -> bool {
        !matches!(self.residual.0 ^ NONE, NONE | UNKNOWN | MISSING)
    }

    /// The residual where there is one, pixels.
    pub(super) fn residual_px(&self) -> Option<f32> {
        match self.residual() {
            Residual::Px(residual) => Some(residual),
            _ => None,
        }
    }

    /// Outward unit normal: to the right and downwards.
    pub(super) fn normal(&self) -> [f32; 2] {
        let [right, down] = self.slope;
        let (right, down) = (i32::from(right), i32::from(down));
        let one = 1.0 / root_of_whole((right * right + down * down) as u32);
        [right as f32 * one, down as f32 * one]
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
        // Of a NaN nothing comes, as of the language's own `min` and `max`, which take ten times as long where they are called.
        if depth < self.near {
            self.near = depth;
        }
        if depth > self.far {
            self.far = depth;
        }
    }

    /// Distance of the contour from the camera plane, mm.
    pub(super) fn depth(&self) -> f32 {
        (self.near + self.far) / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    properties! {
        #[test]
        fn residuals_are_kept_in_four_bytes(bits in any::<u32>()) {
            let px = f32::from_bits(bits);
            prop_assume!(!px.is_nan());
            let mut pixel = BorderPixel::EMPTY;
            prop_assert_eq!(pixel.residual(), Residual::None);
            for residual in [Residual::Px(px), Residual::Missing, Residual::Unknown, Residual::None] {
                pixel.set_residual(residual);
                prop_assert_eq!(pixel.residual(), residual);
            }
            prop_assert_eq!(pixel, BorderPixel::default());
            prop_assert_eq!(size_of::<BorderPixel>(), 24);
        }
    }
}

//! What a part is made from: side, size and density of the mesh.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Which knee a part belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// Left knee: `x` of the model points to the front.
    Left,
    /// Right knee: `x` of the model points to the back.
    Right,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Side::Left => "left",
            Side::Right => "right",
        })
    }
}

impl FromStr for Side {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "left" => Ok(Side::Left),
            "right" => Ok(Side::Right),
            _ => Err(format!("'{text}' is no side: use left or right")),
        }
    }
}

/// Mediolateral widths by size number, in millimetres; size 1 is the first.
pub const SIZES_MM: [f64; 8] = [58.0, 61.0, 64.0, 67.0, 70.0, 73.5, 77.0, 81.0];

/// Smallest and largest mediolateral width that is made, in millimetres.
pub const WIDTH_RANGE_MM: (f64, f64) = (30.0, 150.0);

/// Smallest and largest resolution that is made; 1 gives about 12 000 triangles for the femur.
pub const RESOLUTION_RANGE: (f64, f64) = (0.5, 4.0);

/// How large a part is, by its mediolateral width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    width_mm: f64,
}

impl Size {
    /// The size with this number, 1 to 8 (see [`SIZES_MM`]).
    pub fn numbered(number: usize) -> Result<Self, ImplantError> {
        match number.checked_sub(1).and_then(|index| SIZES_MM.get(index)) {
            Some(&width_mm) => Ok(Self { width_mm }),
            None => Err(ImplantError::Number(number)),
        }
    }

    /// A size by its mediolateral width in millimetres.
    pub fn from_width_mm(width_mm: f64) -> Result<Self, ImplantError> {
        if (WIDTH_RANGE_MM.0..=WIDTH_RANGE_MM.1).contains(&width_mm) {
            Ok(Self { width_mm })
        } else {
            Err(ImplantError::Width(width_mm))
        }
    }

    /// The mediolateral width in millimetres.
    pub fn width_mm(&self) -> f64 {
        self.width_mm
    }
}

impl Default for Size {
    /// Size 5, a mediolateral width of 70 mm.
    fn default() -> Self {
        Self {
            width_mm: SIZES_MM[4],
        }
    }
}

/// What a part is made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Left or right knee.
    pub side: Side,
    /// Anatomic size.
    pub size: Size,
    /// Mesh density: 1 is the default, 2 gives about four times the triangles. See [`RESOLUTION_RANGE`].
    pub resolution: f64,
}

impl Default for Parameters {
    fn default() -> Self {
        Self {
            side: Side::Left,
            size: Size::default(),
            resolution: 1.0,
        }
    }
}

impl Parameters {
    pub(super) fn checked_resolution(&self) -> Result<f64, ImplantError> {
        if (RESOLUTION_RANGE.0..=RESOLUTION_RANGE.1).contains(&self.resolution) {
            Ok(self.resolution)
        } else {
            Err(ImplantError::Resolution(self.resolution))
        }
    }
}

/// Why a part was not made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImplantError {
    /// No size has this number.
    Number(usize),
    /// The mediolateral width in millimetres is not a number or out of range.
    Width(f64),
    /// The resolution is not a number or out of range.
    Resolution(f64),
}

impl fmt::Display for ImplantError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => {
                write!(
                    f,
                    "there is no size {number}: use 1 to {}, or give a width in mm",
                    SIZES_MM.len()
                )
            }
            Self::Width(width) => write!(
                f,
                "an implant {width} mm wide is not made: use {} to {} mm",
                WIDTH_RANGE_MM.0, WIDTH_RANGE_MM.1
            ),
            Self::Resolution(value) => write!(
                f,
                "resolution {value} is not made: use {} to {}",
                RESOLUTION_RANGE.0, RESOLUTION_RANGE.1
            ),
        }
    }
}

impl std::error::Error for ImplantError {}

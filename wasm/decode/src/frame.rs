//! A decoded frame: grey pixels and what the file says of them.

use crate::error::Problem;
use crate::limits::{MAX_EXPANSION, MAX_SIDE};
use crate::shutter::Shutter;

/// One grey frame, black at 0.
#[derive(Debug, Clone, PartialEq)]
pub struct GreyFrame {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` pixels, row by row from the top, each from the left.
    pub pixels: Pixels,
    /// Significant bits of a pixel: values are below `2^bits`. 8 or less for [`Pixels::U8`], 9 to 16 for
    /// [`Pixels::U16`].
    pub bits: u8,
    /// The range of grey values that the file asks to be shown.
    pub window: Option<Window>,
    /// Geometry that the file states.
    pub geometry: Geometry,
    /// What the file says is no picture, though it has pixels.
    pub shutter: Option<Shutter>,
    /// What was done to the pixels or left undone, a sentence each, for the person who opened the file.
    pub notes: Vec<String>,
}

/// The pixels of a frame in the narrowest type that holds them.
#[derive(Debug, Clone, PartialEq)]
pub enum Pixels {
    /// One byte a pixel.
    U8(Vec<u8>),
    /// Two bytes a pixel, for more than 8 bits.
    U16(Vec<u16>),
}

/// The range of pixel values that is shown from black to white: black at `centre - width / 2` and below, white
/// at `centre + width / 2` and above, linear between, in units of the frame's own pixels.
///
/// DICOM's half-unit convention (PS3.3 C.11.2.1.2: `centre - 0.5`, `width - 1`), rescale slope and intercept, sign offset
/// and inversion are already applied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Middle of the range, pixel values.
    pub centre: f64,
    /// Extent of the range, pixel values; at least 1.
    pub width: f64,
}

/// Geometry as the file states it; each may be absent, none is used to change pixels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Geometry {
    /// Distance between pixel centres at the detector (DICOM Imager Pixel Spacing), mm: along a row, then from
    /// row to row.
    pub detector_spacing_mm: Option<[f64; 2]>,
    /// Distance between pixel centres (DICOM Pixel Spacing), mm: along a row, then from row to row.
    /// [`Self::pixel_spacing_calibration`] says at which depth it holds; without that it may hold at the detector or
    /// anywhere else.
    pub pixel_spacing_mm: Option<[f64; 2]>,
    /// How the pixel spacing was determined.
    pub pixel_spacing_calibration: Option<SpacingCalibration>,
    /// Distance between pixel centres on a digitised film (DICOM Nominal Scanned Pixel Spacing), mm.
    pub scanned_spacing_mm: Option<[f64; 2]>,
    /// Distance from the X-ray focus to the point that the C-arm rotates around, mm.
    pub source_to_isocentre_mm: Option<f64>,
    /// Estimated ratio of the size at the detector to the size of the object.
    pub magnification: Option<f64>,
    /// Distance from the X-ray focus to the detector, mm.
    pub source_to_detector_mm: Option<f64>,
    /// Distance from the X-ray focus to the patient, mm.
    pub source_to_patient_mm: Option<f64>,
    /// Height of a pixel over its width (1 for square pixels).
    pub pixel_aspect: Option<f64>,
}

/// How a pixel spacing that is not the detector's was determined (DICOM Pixel Spacing Calibration Type).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpacingCalibration {
    /// From distances: it holds at one assumed depth in the patient.
    Geometry,
    /// From an object of known size in the picture: it holds at the depth of that object.
    Fiducial,
}

impl Pixels {
    /// How many pixels there are.
    pub fn len(&self) -> usize {
        match self {
            Self::U8(p) => p.len(),
            Self::U16(p) => p.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes held.
    pub fn byte_len(&self) -> usize {
        match self {
            Self::U8(p) => p.len(),
            Self::U16(p) => 2 * p.len(),
        }
    }

    /// The pixel at `index` (row by row), widened; `None` beyond the last.
    pub fn get(&self, index: usize) -> Option<u16> {
        match self {
            Self::U8(p) => p.get(index).map(|&v| v.into()),
            Self::U16(p) => p.get(index).copied(),
        }
    }
}

impl GreyFrame {
    /// A frame of pixels alone, without window, geometry or notes.
    pub(crate) fn plain(width: u32, height: u32, pixels: Pixels) -> Self {
        let bits = match pixels {
            Pixels::U8(_) => 8,
            Pixels::U16(_) => 16,
        };
        Self {
            width,
            height,
            pixels,
            bits,
            window: None,
            geometry: Geometry::default(),
            shutter: None,
            notes: Vec::new(),
        }
    }
}

/// The number of pixels of a frame whose sides are within [`MAX_SIDE`].
pub(crate) fn checked_area(width: u64, height: u64) -> Result<usize, Problem> {
    let allowed = 1..=u64::from(MAX_SIDE);
    if !allowed.contains(&width) || !allowed.contains(&height) {
        return Err(Problem::FrameSize { width, height });
    }
    usize::try_from(width * height).map_err(|_| Problem::FrameSize { width, height })
}

/// Whether a file of `file` bytes can hold `area` pixels of `bits_per_pixel` bits in any coding (see [`MAX_EXPANSION`]).
pub(crate) fn can_hold(file: usize, area: usize, bits_per_pixel: u64) -> bool {
    area as u64 * bits_per_pixel / 8 <= MAX_EXPANSION * file as u64
}

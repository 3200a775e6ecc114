//! The attributes of an image that decoding needs, with their checks.

use std::sync::Arc;

use super::palette::Palette;
use super::problem::{FORMAT, damaged};
use super::shutter;
use super::structure::DataSet;
use super::syntax::Coding;
use super::tags::{
    BITS_ALLOCATED, BITS_STORED, COLUMNS, DETECTOR_SPACING, FRAMES, HIGH_BIT, INTERCEPT,
    MAGNIFICATION, PHOTOMETRIC, PIXEL_ASPECT, PIXEL_SPACING, PLANAR, ROWS, SAMPLES_PER_PIXEL,
    SCANNED_SPACING, SIGNED, SLOPE, SOURCE_TO_DETECTOR, SOURCE_TO_ISOCENTRE, SOURCE_TO_PATIENT,
    SPACING_CALIBRATION, TABLE_ENTRIES, WINDOW_CENTRE, WINDOW_FUNCTION, WINDOW_WIDTH,
};
use super::values::Values;
use crate::error::Problem;
use crate::frame::{Geometry, SpacingCalibration, checked_area};
use crate::limits::MAX_FRAMES;
use crate::luminance::ComponentColours;

/// The meaning of the numbers of a pixel.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Photometric {
    /// High is dark.
    Monochrome1,
    /// High is bright.
    Monochrome2,
    /// The number of a colour.
    Palette(Arc<Palette>),
    /// Red, green, blue.
    Rgb,
    /// Luminance first, then two colour differences.
    YbrFull,
    /// As before, with the differences shared by two pixels: Y Y Cb Cr.
    YbrFull422,
    /// What a JPEG or JPEG 2000 image makes of its own colours.
    InsideJpeg,
}

/// How greys of more than 16 bits become what is handed out: `(value - low) >> shift`. Nothing for fewer bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Narrowing {
    pub low: u32,
    pub shift: u32,
}

/// The window as the file states it, in rescaled units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StatedWindow {
    pub centre: f64,
    pub width: f64,
    /// The function is LINEAR, for which the standard takes half a unit and one unit off.
    pub half_unit: bool,
}

/// The attributes of an image.
#[derive(Debug, Clone)]
pub(super) struct Attributes {
    pub width: u32,
    pub height: u32,
    pub frames: usize,
    pub samples: u16,
    pub photometric: Photometric,
    /// What three components of a compressed image are where it does not tell itself.
    pub colour_inside: ComponentColours,
    pub planar: bool,
    pub bits_allocated: u16,
    pub bits_stored: u16,
    pub high_bit: u16,
    pub signed: bool,
    pub slope: f64,
    pub intercept: f64,
    pub window: Option<StatedWindow>,
    pub geometry: Geometry,
    /// The table that turns stored values into meaningful ones gives low ones for high ones; none without a table.
    pub falling_table: Option<bool>,
    /// What is not of the picture; one for all frames, where none has its own.
    pub shutter: Option<Arc<shutter::Stated>>,
    pub narrowing: Narrowing,
    /// Bits of the greys that are handed out.
    pub depth: u16,
}

fn whole(values: Values<'_>, tag: u32, name: &str) -> Result<u16, Problem> {
    whole_or_absent(values, tag, name)?
        .ok_or_else(|| damaged(format!("it does not say its {name}")))
}

fn whole_or_absent(values: Values<'_>, tag: u32, name: &str) -> Result<Option<u16>, Problem> {
    let Some(value) = values.finite(tag) else {
        return Ok(None);
    };
    match value.fract() == 0.0 && (0.0..=65535.0).contains(&value) {
        true => Ok(Some(value as u16)),
        false => Err(damaged(format!("its {name} is {value}"))),
    }
}

impl Attributes {
    /// Reads the elements that the walk found.
    pub(super) fn read(bytes: &[u8], data_set: &DataSet, coding: Coding) -> Result<Self, Problem> {
        let found = &data_set.wanted;
        let values = Values { bytes, found };
        let bits_stored = whole(values, BITS_STORED, "number of bits stored")?;
        let high_bit = whole_or_absent(values, HIGH_BIT, "high bit")?;
        let frames = whole_or_absent(values, FRAMES, "number of frames")?;
        let signed = whole_or_absent(values, SIGNED, "pixel representation")? == Some(1);
        let table = Values {
            bytes,
            found: &data_set.modality_table,
        };
        Ok(Self {
            width: whole(values, COLUMNS, "number of columns")?.into(),
            height: whole(values, ROWS, "number of rows")?.into(),
            frames: frames.unwrap_or(1).into(),
            samples: whole_or_absent(values, SAMPLES_PER_PIXEL, "samples per pixel")?.unwrap_or(1),
            photometric: photometric(values, coding, signed)?,
            colour_inside: colour_inside(values),
            planar: whole_or_absent(values, PLANAR, "planar configuration")? == Some(1),
            bits_allocated: whole(values, BITS_ALLOCATED, "number of bits allocated")?,
            bits_stored,
            high_bit: high_bit.unwrap_or(bits_stored.saturating_sub(1)),
            signed,
            slope: values.finite(SLOPE).filter(|&v| v != 0.0).unwrap_or(1.0),
            intercept: values.finite(INTERCEPT).unwrap_or(0.0),
            window: window(values),
            geometry: geometry(values),
            falling_table: is_falling(table),
            shutter: shutter::read(values).map(Arc::new),
            narrowing: Narrowing::default(),
            depth: bits_stored.min(16),
        })
    }

    /// The attributes of each frame by its functional groups; empty where there are no groups.
    pub(super) fn of_frames(&self, bytes: &[u8], data_set: &DataSet) -> Vec<Self> {
        let (shared, per_frame) = (&data_set.shared, &data_set.per_frame);
        if per_frame.is_empty() && shared.is_empty() {
            return Vec::new();
        }
        let values = |found| Values { bytes, found };
        let common = self.overridden(values(shared));
        let own = |frame: usize| match per_frame.get(frame) {
            Some(found) if !found.is_empty() => common.overridden(values(found)),
            _ => common.clone(),
        };
        (0..self.frames).map(own).collect()
    }

    /// These attributes where a functional group says nothing else.
    fn overridden(&self, group: Values<'_>) -> Self {
        let own = geometry(group);
        let known = &self.geometry;
        let rescaled = group.finite(SLOPE).filter(|&slope| slope != 0.0);
        Self {
            slope: rescaled.unwrap_or(self.slope),
            // Slope and intercept belong together.
            intercept: match rescaled {
                Some(_) => group.finite(INTERCEPT).unwrap_or(0.0),
                None => self.intercept,
            },
            window: window(group).or(self.window),
            shutter: match shutter::read(group) {
                Some(own) => Some(Arc::new(own)),
                None => self.shutter.clone(),
            },
            geometry: Geometry {
                detector_spacing_mm: own.detector_spacing_mm.or(known.detector_spacing_mm),
                pixel_spacing_mm: own.pixel_spacing_mm.or(known.pixel_spacing_mm),
                source_to_detector_mm: own.source_to_detector_mm.or(known.source_to_detector_mm),
                source_to_patient_mm: own.source_to_patient_mm.or(known.source_to_patient_mm),
                source_to_isocentre_mm: own.source_to_isocentre_mm.or(known.source_to_isocentre_mm),
                ..*known
            },
            ..self.clone()
        }
    }

    /// Refuses what is inconsistent or not read.
    pub(super) fn check(&self, coding: Coding) -> Result<(), Problem> {
        checked_area(self.width.into(), self.height.into())?;
        if !(1..=MAX_FRAMES).contains(&self.frames) {
            let detail = format!(
                "it states {} frames and 1 to {MAX_FRAMES} are possible",
                self.frames
            );
            return Err(damaged(detail));
        }
        let samples = if self.is_colour() { 3 } else { 1 };
        let grey = self.is_grey();
        let exact = matches!(coding, Coding::Native | Coding::Rle);
        let depths: &[u16] = match &self.photometric {
            _ if grey && coding == Coding::Native => &[1, 8, 16, 32],
            _ if grey && exact => &[8, 16, 32],
            Photometric::YbrFull422 => &[8],
            _ => &[8, 16],
        };
        let bits = self.bits_allocated;
        if !depths.contains(&bits) {
            let what = format!("{bits}-bit {} pixels", if grey { "grey" } else { "colour" });
            return Err(Problem::unsupported(
                FORMAT,
                what,
                "Export it with 8 or 16 bits",
            ));
        }
        let bits_fit = (1..=bits).contains(&self.bits_stored)
            && (self.bits_stored - 1..bits).contains(&self.high_bit);
        if !bits_fit {
            return Err(damaged(format!(
                "{} bits stored with high bit {} do not fit {bits} bits allocated",
                self.bits_stored, self.high_bit
            )));
        }
        if self.samples != samples && self.photometric != Photometric::InsideJpeg {
            return Err(damaged(format!(
                "it states {} samples a pixel where {samples} are due",
                self.samples
            )));
        }
        if self.photometric == Photometric::YbrFull422
            && (coding != Coding::Native || self.planar || self.width % 2 == 1)
        {
            return Err(damaged("its colours cannot be shared by pairs of pixels"));
        }
        Ok(())
    }

    /// Whether pixels are greys, and not colours or their numbers.
    pub(super) fn is_grey(&self) -> bool {
        matches!(
            self.photometric,
            Photometric::Monochrome1 | Photometric::Monochrome2
        )
    }

    fn is_colour(&self) -> bool {
        !self.is_grey() && !matches!(self.photometric, Photometric::Palette(_))
    }

    /// Whether a high stored value is shown dark.
    pub(super) fn is_inverted(&self) -> bool {
        let falling = self.falling_table.unwrap_or(self.slope < 0.0);
        (self.photometric == Photometric::Monochrome1) != falling
    }

    /// Bits of one uncompressed frame. At most 8192 x 8192 x 48.
    pub(super) fn native_frame_bits(&self) -> u64 {
        let samples = match self.photometric {
            Photometric::YbrFull422 => 2,
            _ => self.samples,
        };
        u64::from(self.width)
            * u64::from(self.height)
            * u64::from(samples)
            * u64::from(self.bits_allocated)
    }
}

fn photometric(values: Values<'_>, coding: Coding, signed: bool) -> Result<Photometric, Problem> {
    let stated = values.text(PHOTOMETRIC).unwrap_or_default();
    Ok(match (stated, coding) {
        ("MONOCHROME1", _) => Photometric::Monochrome1,
        ("MONOCHROME2", _) => Photometric::Monochrome2,
        ("PALETTE COLOR", _) => Photometric::Palette(Arc::new(Palette::read(values, signed)?)),
        ("RGB", Coding::Jpeg | Coding::Jpeg2000) => Photometric::InsideJpeg,
        (other, Coding::Jpeg | Coding::Jpeg2000) if other.starts_with("YBR_") => {
            Photometric::InsideJpeg
        }
        ("RGB", _) => Photometric::Rgb,
        ("YBR_FULL", _) => Photometric::YbrFull,
        ("YBR_FULL_422", _) => Photometric::YbrFull422,
        ("", _) => return Err(damaged("it does not say its photometric interpretation")),
        (other, _) => {
            let shown: String = other.chars().take(32).collect();
            let what = format!("pixels of the kind {shown}");
            return Err(Problem::unsupported(
                FORMAT,
                what,
                "Export it as MONOCHROME2 or RGB",
            ));
        }
    })
}

/// A JPEG 2000 image undoes its own transforms (YBR_RCT, YBR_ICT), but it does not know that YBR_FULL is stored in it.
fn colour_inside(values: Values<'_>) -> ComponentColours {
    match values
        .text(PHOTOMETRIC)
        .unwrap_or_default()
        .starts_with("YBR_FULL")
    {
        true => ComponentColours::LuminanceFirst,
        false => ComponentColours::Rgb,
    }
}

fn window(values: Values<'_>) -> Option<StatedWindow> {
    let function = values.text(WINDOW_FUNCTION).unwrap_or_default();
    Some(StatedWindow {
        centre: values.finite(WINDOW_CENTRE)?,
        width: values.positive(WINDOW_WIDTH)?,
        half_unit: function.is_empty() || function == "LINEAR",
    })
}

/// Whether a table gives a lower value for the last entry than for the first; none without a table.
fn is_falling(table: Values<'_>) -> Option<bool> {
    let entries = table.numbers(TABLE_ENTRIES)?;
    Some(entries.last()? < entries.first()?)
}

fn geometry(values: Values<'_>) -> Geometry {
    // All pairs are stated vertical first.
    let spacing = |tag| {
        values
            .positive_pair(tag)
            .map(|[rows, columns]| [columns, rows])
    };
    let calibration = values.text(SPACING_CALIBRATION).unwrap_or_default();
    Geometry {
        detector_spacing_mm: spacing(DETECTOR_SPACING),
        pixel_spacing_mm: spacing(PIXEL_SPACING),
        pixel_spacing_calibration: match calibration {
            "GEOMETRY" => Some(SpacingCalibration::Geometry),
            "FIDUCIAL" => Some(SpacingCalibration::Fiducial),
            _ => None,
        },
        scanned_spacing_mm: spacing(SCANNED_SPACING),
        source_to_isocentre_mm: values.positive(SOURCE_TO_ISOCENTRE),
        magnification: values.positive(MAGNIFICATION),
        source_to_detector_mm: values.positive(SOURCE_TO_DETECTOR),
        source_to_patient_mm: values.positive(SOURCE_TO_PATIENT),
        pixel_aspect: values
            .positive_pair(PIXEL_ASPECT)
            .map(|[vertical, horizontal]| vertical / horizontal),
    }
}

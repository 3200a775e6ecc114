//! The attributes of an image that decoding needs, with their checks.

use dicom_object::{InMemDicomObject, Tag};

use super::problem::{FORMAT, damaged};
use super::syntax::{Coding, Syntax};
use super::tags::{
    BITS_ALLOCATED, BITS_STORED, CINE_RATE, COLUMNS, DETECTOR_SPACING, FRAME_TIME, FRAME_TIMES,
    FRAMES, HIGH_BIT, INTERCEPT, MAGNIFICATION, PHOTOMETRIC, PIXEL_ASPECT, PIXEL_SPACING, PLANAR,
    ROWS, SAMPLES_PER_PIXEL, SCANNED_SPACING, SIGNED, SLOPE, SOURCE_TO_DETECTOR,
    SOURCE_TO_ISOCENTRE, SOURCE_TO_PATIENT, SPACING_CALIBRATION, WINDOW_CENTRE, WINDOW_FUNCTION,
    WINDOW_WIDTH,
};
use crate::error::Problem;
use crate::frame::{Geometry, SpacingCalibration, checked_area};
use crate::limits::MAX_FRAMES;
use crate::luminance::ComponentColours;

/// The meaning of the numbers of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Photometric {
    /// High is dark.
    Monochrome1,
    /// High is bright.
    Monochrome2,
    /// Red, green, blue.
    Rgb,
    /// Luminance first, then two colour differences.
    YbrFull,
    /// As before, with the differences shared by two pixels: Y Y Cb Cr.
    YbrFull422,
    /// What a JPEG or JPEG 2000 image makes of its own colours.
    InsideJpeg,
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
    pub frames_per_s: Option<f64>,
}

/// Typed access to the library's object.
struct Values(InMemDicomObject);

impl Values {
    fn numbers(&self, tag: u32) -> Option<Vec<f64>> {
        let element = self
            .0
            .element_opt(Tag((tag >> 16) as u16, tag as u16))
            .ok()??;
        element.to_multi_float64().ok()
    }

    fn finite(&self, tag: u32) -> Option<f64> {
        let first = self.numbers(tag)?.first().copied();
        first.filter(|v| v.is_finite())
    }

    /// A distance: finite and above zero.
    fn positive(&self, tag: u32) -> Option<f64> {
        self.finite(tag).filter(|&v| v > 0.0)
    }

    /// Two distances, both finite and above zero.
    fn positive_pair(&self, tag: u32) -> Option<[f64; 2]> {
        let pair: [f64; 2] = self.numbers(tag)?.try_into().ok()?;
        pair.iter()
            .all(|v| v.is_finite() && *v > 0.0)
            .then_some(pair)
    }

    fn text(&self, tag: u32) -> Option<String> {
        let element = self
            .0
            .element_opt(Tag((tag >> 16) as u16, tag as u16))
            .ok()??;
        let text = element.to_str().ok()?;
        Some(
            text.trim_matches(|c: char| c == '\0' || c.is_whitespace())
                .to_owned(),
        )
    }

    fn whole(&self, tag: u32, name: &str) -> Result<u16, Problem> {
        self.whole_or_absent(tag, name)?
            .ok_or_else(|| damaged(format!("it does not say its {name}")))
    }

    fn whole_or_absent(&self, tag: u32, name: &str) -> Result<Option<u16>, Problem> {
        let Some(value) = self.numbers(tag).and_then(|v| v.first().copied()) else {
            return Ok(None);
        };
        match value.fract() == 0.0 && (0.0..=65535.0).contains(&value) {
            true => Ok(Some(value as u16)),
            false => Err(damaged(format!("its {name} is {value}"))),
        }
    }
}

impl Attributes {
    /// Reads the small elements that the walk kept.
    pub(super) fn read(wanted: &[u8], syntax: &Syntax) -> Result<Self, Problem> {
        let object = InMemDicomObject::read_dataset_with_ts(wanted, &syntax.of_elements())
            .map_err(|e| damaged(format!("its attributes cannot be read ({e})")))?;
        let values = Values(object);
        let bits_stored = values.whole(BITS_STORED, "number of bits stored")?;
        let high_bit = values.whole_or_absent(HIGH_BIT, "high bit")?;
        let frames = values.whole_or_absent(FRAMES, "number of frames")?;
        Ok(Self {
            width: values.whole(COLUMNS, "number of columns")?.into(),
            height: values.whole(ROWS, "number of rows")?.into(),
            frames: frames.unwrap_or(1).into(),
            samples: values
                .whole_or_absent(SAMPLES_PER_PIXEL, "samples per pixel")?
                .unwrap_or(1),
            photometric: photometric(&values, syntax.coding)?,
            colour_inside: colour_inside(&values),
            planar: values.whole_or_absent(PLANAR, "planar configuration")? == Some(1),
            bits_allocated: values.whole(BITS_ALLOCATED, "number of bits allocated")?,
            bits_stored,
            high_bit: high_bit.unwrap_or(bits_stored.saturating_sub(1)),
            signed: values.whole_or_absent(SIGNED, "pixel representation")? == Some(1),
            slope: values.finite(SLOPE).filter(|&v| v != 0.0).unwrap_or(1.0),
            intercept: values.finite(INTERCEPT).unwrap_or(0.0),
            window: window(&values),
            geometry: geometry(&values),
            frames_per_s: frames_per_s(&values),
        })
    }

    /// The attributes of each frame by its functional groups; empty where there are no groups.
    pub(super) fn of_frames(
        &self,
        shared: &[u8],
        per_frame: &[Vec<u8>],
        syntax: &Syntax,
    ) -> Result<Vec<Self>, Problem> {
        let read = |wanted: &[u8]| {
            InMemDicomObject::read_dataset_with_ts(wanted, &syntax.of_elements())
                .map(Values)
                .map_err(|e| damaged(format!("its functional groups cannot be read ({e})")))
        };
        if per_frame.is_empty() && shared.is_empty() {
            return Ok(Vec::new());
        }
        let common = self.overridden(&read(shared)?);
        let own = |frame: usize| match per_frame.get(frame) {
            Some(wanted) if !wanted.is_empty() => Ok(common.overridden(&read(wanted)?)),
            _ => Ok(common.clone()),
        };
        (0..self.frames).map(own).collect()
    }

    /// These attributes where a functional group says nothing else.
    fn overridden(&self, group: &Values) -> Self {
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
            geometry: Geometry {
                detector_spacing_mm: own.detector_spacing_mm.or(known.detector_spacing_mm),
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
        let colour = !matches!(
            self.photometric,
            Photometric::Monochrome1 | Photometric::Monochrome2
        );
        let depths: &[u16] = if colour { &[8] } else { &[8, 16] };
        let bits = self.bits_allocated;
        if !depths.contains(&bits) {
            let what = format!(
                "{bits}-bit {} pixels",
                if colour { "colour" } else { "grey" }
            );
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
        let samples = if colour { 3 } else { 1 };
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

    /// Bytes of one uncompressed frame. At most 8192 x 8192 x 6, which fits 32 bits.
    pub(super) fn native_frame_bytes(&self) -> usize {
        let samples = match self.photometric {
            Photometric::YbrFull422 => 2,
            _ => usize::from(self.samples),
        };
        self.width as usize * self.height as usize * samples * usize::from(self.bits_allocated / 8)
    }
}

fn photometric(values: &Values, coding: Coding) -> Result<Photometric, Problem> {
    let stated = values.text(PHOTOMETRIC).unwrap_or_default();
    Ok(match (stated.as_str(), coding) {
        ("MONOCHROME1", _) => Photometric::Monochrome1,
        ("MONOCHROME2", _) => Photometric::Monochrome2,
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
fn colour_inside(values: &Values) -> ComponentColours {
    match values
        .text(PHOTOMETRIC)
        .unwrap_or_default()
        .starts_with("YBR_FULL")
    {
        true => ComponentColours::LuminanceFirst,
        false => ComponentColours::Rgb,
    }
}

fn window(values: &Values) -> Option<StatedWindow> {
    let function = values.text(WINDOW_FUNCTION).unwrap_or_default();
    Some(StatedWindow {
        centre: values.finite(WINDOW_CENTRE)?,
        width: values.positive(WINDOW_WIDTH)?,
        half_unit: function.is_empty() || function == "LINEAR",
    })
}

/// Times between frames that differ by more than this part of their mean are no rate.
const EVEN: f64 = 0.1;

/// From what says most: the times of all frames, the time of each, the rate at which it was taken. A pulsed or variable rate is none.
fn frames_per_s(values: &Values) -> Option<f64> {
    let even = |times: Vec<f64>| {
        // The first frame comes at no time after another.
        let steps = times.get(1..).filter(|steps| !steps.is_empty())?;
        let mean = steps.iter().sum::<f64>() / steps.len() as f64;
        let is_even = steps.iter().all(|step| (step - mean).abs() <= EVEN * mean);
        Some(mean).filter(|mean| is_even && mean.is_finite() && *mean > 0.0)
    };
    let ms = match values.numbers(FRAME_TIMES) {
        Some(times) if times.len() > 1 => Some(even(times)?),
        _ => values.positive(FRAME_TIME),
    };
    let rate = ms.map(|ms| 1000.0 / ms);
    // Times are stated in decimals, rates mostly are multiples of a half.
    let whole = |rate: f64| {
        let half = (2.0 * rate).round() / 2.0;
        if (rate - half).abs() < 2e-4 * rate {
            half
        } else {
            rate
        }
    };
    rate.map(whole).or_else(|| values.positive(CINE_RATE))
}

fn geometry(values: &Values) -> Geometry {
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
        pixel_spacing_calibration: match calibration.as_str() {
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

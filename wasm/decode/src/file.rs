//! A file of frames, opened once and decoded a frame at a time.

use std::borrow::Cow;

use crate::dicom::Dicom;
use crate::error::{DecodeError, Problem};
use crate::frame::GreyFrame;
use crate::limits::MAX_PIXEL_BYTES_AT_ONCE;
use crate::sniff::{Kind, sniff};
use crate::{bmp, jpeg, jpeg2000, numpy, png, tiff};

/// A PNG, JPEG, JPEG 2000, TIFF, BMP, DICOM or NumPy file whose structure has been checked, and whose frames are decoded one by one.
///
/// ```no_run
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let bytes = std::fs::read("run.dcm")?;
/// let file = fluoropose_decode::FrameFile::open(bytes, "run.dcm")?;
/// for index in 0..file.count() {
///     let frame = file.frame(index)?;
///     println!("{} x {}", frame.width, frame.height);
/// }
/// # Ok(())
/// # }
/// ```
pub struct FrameFile<'a> {
    name: String,
    kind: Kind,
    bytes: Cow<'a, [u8]>,
    content: Content,
}

/// What the kinds need to find a frame; of files that hold one, its width and height.
enum Content {
    Png((u32, u32)),
    Jpeg((u32, u32)),
    Jpeg2000((u32, u32)),
    Bmp((u32, u32)),
    Tiff { pages: Vec<tiff::Page> },
    Dicom(Box<Dicom>),
    Numpy(numpy::Array),
}

impl<'a> FrameFile<'a> {
    /// Opens a file from its bytes, borrowed or owned. `name` is used in errors, and its extension only where the
    /// content alone does not tell the format. No pixels are decoded yet.
    ///
    /// # Errors
    /// [`DecodeError`] if the content is not a frame of a known format, is damaged, is of a kind that is not read
    /// (JPEG XL, video, ...), or larger than the [limits](crate::limits).
    pub fn open(bytes: impl Into<Cow<'a, [u8]>>, name: &str) -> Result<Self, DecodeError> {
        let mut bytes = bytes.into();
        let kind = sniff(&bytes, name);
        let content = Content::of(kind, &mut bytes).map_err(|problem| problem.of(name))?;
        Ok(Self {
            name: name.to_owned(),
            kind,
            bytes,
            content,
        })
    }

    /// The name it was opened with.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Which format it is.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// How many frames it holds, at least 1.
    pub fn count(&self) -> usize {
        match &self.content {
            Content::Png(_) | Content::Jpeg(_) | Content::Jpeg2000(_) | Content::Bmp(_) => 1,
            Content::Tiff { pages } => pages.len(),
            Content::Dicom(dicom) => dicom.count(),
            Content::Numpy(array) => array.count(),
        }
    }

    /// Frames a second, where the file states them and they are even: of DICOM the times of the frames, the time of each, or
    /// the rate at which they were taken.
    pub fn frames_per_s(&self) -> Option<f64> {
        match &self.content {
            Content::Dicom(dicom) => dicom.frames_per_s(),
            _ => None,
        }
    }

    /// The place of the file among those of its series, where it states one (DICOM): names may have another order.
    pub fn instance_number(&self) -> Option<f64> {
        match &self.content {
            Content::Dicom(dicom) => dicom.instance_number(),
            _ => None,
        }
    }

    /// Width and height of frame `index`, counted from 0, pixels; `None` if there is no such frame. Nothing is decoded.
    pub fn size(&self, index: usize) -> Option<(u32, u32)> {
        if index >= self.count() {
            return None;
        }
        match &self.content {
            Content::Png(size)
            | Content::Jpeg(size)
            | Content::Jpeg2000(size)
            | Content::Bmp(size) => Some(*size),
            Content::Tiff { pages } => Some(pages.get(index)?.size),
            Content::Dicom(dicom) => Some(dicom.size(index)),
            Content::Numpy(array) => Some(array.size()),
        }
    }

    /// Decodes frame `index`, counted from 0.
    ///
    /// # Errors
    /// [`DecodeError`] if there is no such frame or its pixels are damaged; the other frames stay readable.
    pub fn frame(&self, index: usize) -> Result<GreyFrame, DecodeError> {
        self.decode(index).map_err(|problem| problem.of(&self.name))
    }

    fn decode(&self, index: usize) -> Result<GreyFrame, Problem> {
        let count = self.count();
        if index >= count {
            return Err(Problem::NoSuchFrame { index, count });
        }
        match &self.content {
            Content::Png(_) => png::decode(&self.bytes),
            Content::Jpeg(_) => jpeg::decode(&self.bytes),
            Content::Jpeg2000(_) => jpeg2000::decode(&self.bytes),
            Content::Bmp(_) => bmp::decode(&self.bytes),
            Content::Tiff { pages } => tiff::decode(&self.bytes, &pages[index]),
            Content::Dicom(dicom) => dicom.frame(&self.bytes, index),
            Content::Numpy(array) => Ok(array.frame(&self.bytes, index)),
        }
    }
}

impl Content {
    fn of(kind: Kind, bytes: &mut Cow<'_, [u8]>) -> Result<Self, Problem> {
        Ok(match kind {
            Kind::Png => Self::Png(png::check(bytes)?),
            Kind::Jpeg => Self::Jpeg(jpeg::check(bytes)?),
            Kind::Jpeg2000 => Self::Jpeg2000(jpeg2000::check(bytes)?),
            Kind::Bmp => Self::Bmp(bmp::check(bytes)?),
            Kind::Tiff => Self::Tiff {
                pages: tiff::pages(bytes)?,
            },
            Kind::Dicom => Self::Dicom(Box::new(Dicom::open(bytes)?)),
            Kind::Numpy => Self::Numpy(numpy::Array::open(bytes)?),
            _ if bytes.is_empty() => return Err(Problem::Empty),
            other => {
                return Err(Problem::NotAFrame {
                    found: other.noun(),
                });
            }
        })
    }
}

/// Decodes every frame of a file.
///
/// # Errors
/// Those of [`FrameFile::open`] and [`FrameFile::frame`], and if all pixels together take more than
/// [`MAX_PIXEL_BYTES_AT_ONCE`].
pub fn decode_frames(bytes: &[u8], name: &str) -> Result<Vec<GreyFrame>, DecodeError> {
    let file = FrameFile::open(bytes, name)?;
    let (mut frames, mut held) = (Vec::new(), 0);
    for index in 0..file.count() {
        let frame = file.frame(index)?;
        held += frame.pixels.byte_len();
        if held > MAX_PIXEL_BYTES_AT_ONCE {
            let frames = file.count();
            return Err(Problem::TooManyPixels { frames }.of(name));
        }
        frames.push(frame);
    }
    Ok(frames)
}

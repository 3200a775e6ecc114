//! What can be wrong with a file, as sentences a person can act on.

use thiserror::Error;

use crate::limits::{MAX_PIXEL_BYTES_AT_ONCE, MAX_SIDE, MAX_TRIANGLES, MAX_VERTICES};

/// Why a file could not be decoded: its name and the problem.
///
/// `Display` is one or two sentences: the file, what is wrong and where, what to do.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{file}: {problem}.")]
pub struct DecodeError {
    /// The name the file was given with.
    pub file: String,
    /// What is wrong with it.
    pub problem: Problem,
}

/// What is wrong with a file.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Problem {
    /// The file has no bytes.
    #[error("the file is empty. Choose another or copy it again")]
    Empty,
    /// The content is not a frame of a kind that is read here; `found` says what it looks like.
    #[error(
        "this is {found}, not a frame. Frames are PNG, JPEG, JPEG 2000, TIFF, BMP or DICOM files, or NumPy arrays"
    )]
    NotAFrame {
        /// What the content looks like, as a noun.
        found: &'static str,
    },
    /// The content is not a model of a kind that is read here; `found` says what it looks like.
    #[error("this is {found}, not a model. Models are STL, OBJ or PLY files")]
    NotAModel {
        /// What the content looks like, as a noun.
        found: &'static str,
    },
    /// A model in a form that is not read.
    #[error(
        "this is a model in a form that is not read. Export the part from the program that made it as a surface mesh, in mm: STL, OBJ or PLY"
    )]
    OtherModel,
    /// The content breaks the rules of its format or ends too early.
    #[error("this {format} file is damaged or incomplete: {detail}. Copy or export it again")]
    Damaged {
        /// The format, as people call it.
        format: &'static str,
        /// What is wrong and where.
        detail: String,
    },
    /// The content is sound but of a kind that is not read.
    #[error("this {format} file holds {detail}, which is not read. {remedy}")]
    Unsupported {
        /// The format, as people call it.
        format: &'static str,
        /// What is not read.
        detail: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// A frame has no pixels, or more than [`MAX_SIDE`] along one side.
    #[error(
        "a frame of {width} x {height} pixels cannot be opened: each side must be 1 to {MAX_SIDE}. Crop or scale it \
         first"
    )]
    FrameSize {
        /// Stated width, pixels.
        width: u64,
        /// Stated height, pixels.
        height: u64,
    },
    /// All frames together do not fit [`MAX_PIXEL_BYTES_AT_ONCE`].
    #[error(
        "its {frames} frames do not fit {} MiB when opened all at once. Open them one at a time",
        MAX_PIXEL_BYTES_AT_ONCE >> 20
    )]
    TooManyPixels {
        /// Frames in the file.
        frames: usize,
    },
    /// A frame was asked for that the file does not have.
    #[error("there is no frame {} in a file of {count}. Ask for 1 to {count}", index + 1)]
    NoSuchFrame {
        /// The index asked for, from 0.
        index: usize,
        /// How many frames there are.
        count: usize,
    },
    /// A mask file holds more than one frame.
    #[error(
        "a mask file holds one image and this one holds {count}. Save each mask as its own file"
    )]
    SeveralMasks {
        /// How many frames there are.
        count: usize,
    },
    /// A model without a single triangle of some area.
    #[error(
        "the model has no triangle with three different corners. Export it again as a surface mesh"
    )]
    EmptyModel,
    /// A vertex coordinate is NaN or infinite.
    #[error(
        "vertex {} has a coordinate that is not a finite number. Repair or export the model again",
        vertex + 1
    )]
    NonFiniteVertex {
        /// Index of the vertex in the file, from 0.
        vertex: usize,
    },
    /// A triangle names a vertex that is not there.
    #[error(
        "a face names vertex {index} (counted from 0) but there are only {vertices}. Export the model again"
    )]
    VertexIndex {
        /// The index that was named, from 0; a damaged file may name a negative one.
        index: i64,
        /// How many vertices there are.
        vertices: usize,
    },
    /// More than [`MAX_TRIANGLES`] triangles.
    #[error(
        "{triangles} triangles are more than the {MAX_TRIANGLES} that are read. Simplify the model first"
    )]
    TooManyTriangles {
        /// How many triangles are stated or found.
        triangles: u64,
    },
    /// More than [`MAX_VERTICES`] vertices.
    #[error(
        "{vertices} vertices are more than the {MAX_VERTICES} that are read. Simplify the model first"
    )]
    TooManyVertices {
        /// How many vertices are stated or found.
        vertices: u64,
    },
}

impl Problem {
    /// Broken content, with what and where.
    pub(crate) fn damaged(format: &'static str, detail: impl Into<String>) -> Self {
        Self::Damaged {
            format,
            detail: tidy(&detail.into()),
        }
    }

    /// Sound content that is not read, with what to do.
    pub(crate) fn unsupported(
        format: &'static str,
        detail: impl Into<String>,
        remedy: &'static str,
    ) -> Self {
        Self::Unsupported {
            format,
            detail: tidy(&detail.into()),
            remedy,
        }
    }

    /// The same problem with the file's name.
    pub(crate) fn of(self, name: &str) -> DecodeError {
        DecodeError {
            file: name.to_owned(),
            problem: self,
        }
    }
}

/// Most characters of a detail: libraries quote what they stumbled over, at any length.
const MAX_DETAIL: usize = 200;

/// One line of bounded length without a full stop, to stand inside a sentence.
fn tidy(detail: &str) -> String {
    let words: Vec<&str> = detail.split_whitespace().collect();
    let line = words.join(" ");
    let printable = |c: &char| !c.is_control();
    let mut short: String = line.chars().filter(printable).take(MAX_DETAIL).collect();
    if line.chars().count() > MAX_DETAIL {
        short.push_str("...");
    } else {
        short.truncate(short.trim_end_matches('.').len());
    }
    short
}

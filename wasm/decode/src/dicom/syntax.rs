//! Transfer syntaxes: how the data set and the pixels are written.

use dicom_transfer_syntax_registry::{TransferSyntax, entries};

use super::problem::FORMAT;
use crate::error::Problem;

/// How pixels are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Coding {
    /// As they are.
    Native,
    /// Run lengths.
    Rle,
    /// JPEG with loss, or lossless: the image itself tells which.
    Jpeg,
    /// JPEG 2000 with loss, or lossless.
    Jpeg2000,
}

/// How the data set is written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Syntax {
    /// Whether every element carries its value representation.
    pub explicit: bool,
    /// Whether numbers have their high byte first.
    pub big_endian: bool,
    /// Whether the data set is deflated.
    pub deflated: bool,
    /// How pixels are written.
    pub coding: Coding,
}

impl Syntax {
    /// What a transfer syntax identifier stands for.
    pub(super) fn of(uid: &str) -> Result<Self, Problem> {
        let explicit_little = Self {
            explicit: true,
            big_endian: false,
            deflated: false,
            coding: Coding::Native,
        };
        Ok(match uid {
            "1.2.840.10008.1.2" => Self {
                explicit: false,
                ..explicit_little
            },
            "1.2.840.10008.1.2.1" => explicit_little,
            "1.2.840.10008.1.2.1.99" => Self {
                deflated: true,
                ..explicit_little
            },
            "1.2.840.10008.1.2.2" => Self {
                big_endian: true,
                ..explicit_little
            },
            "1.2.840.10008.1.2.5" => Self {
                coding: Coding::Rle,
                ..explicit_little
            },
            "1.2.840.10008.1.2.4.50"
            | "1.2.840.10008.1.2.4.51"
            | "1.2.840.10008.1.2.4.57"
            | "1.2.840.10008.1.2.4.70" => Self {
                coding: Coding::Jpeg,
                ..explicit_little
            },
            "1.2.840.10008.1.2.4.90" | "1.2.840.10008.1.2.4.91" => Self {
                coding: Coding::Jpeg2000,
                ..explicit_little
            },
            other => return Err(refused(other)),
        })
    }

    /// The library's name for the way elements are written.
    pub(super) fn of_elements(&self) -> TransferSyntax {
        match (self.explicit, self.big_endian) {
            (_, true) => entries::EXPLICIT_VR_BIG_ENDIAN.erased(),
            (true, _) => entries::EXPLICIT_VR_LITTLE_ENDIAN.erased(),
            (false, _) => entries::IMPLICIT_VR_LITTLE_ENDIAN.erased(),
        }
    }
}

/// Where a person gets the same frames in a form that is read.
const REMEDY: &str = "Export it from the viewer or archive uncompressed (Explicit VR Little Endian), or as lossless \
                      JPEG, JPEG 2000 or RLE; gdcmconv --raw converts files, too";
const VIDEO_REMEDY: &str =
    "Export its frames uncompressed, or as an MP4 or WebM video, which the page opens itself";

/// Names of the syntaxes of encapsulated pixels that are not read, by the end of their identifiers.
const NOT_READ: [(&str, &str); 16] = [
    ("52", "hierarchical JPEG pixels"),
    ("53", "spectral selection JPEG pixels"),
    ("55", "full progression JPEG pixels"),
    ("80", "JPEG-LS lossless pixels"),
    ("81", "JPEG-LS near-lossless pixels"),
    (
        "92",
        "JPEG 2000 pixels of several components (part 2, lossless)",
    ),
    ("93", "JPEG 2000 pixels of several components (part 2)"),
    ("94", "pixels that are fetched from a server (JPIP)"),
    (
        "95",
        "pixels that are fetched from a server (JPIP, deflated)",
    ),
    ("110", "JPEG XL lossless pixels"),
    ("111", "JPEG XL pixels made from JPEG"),
    ("112", "JPEG XL pixels"),
    ("201", "high-throughput JPEG 2000 lossless pixels"),
    (
        "202",
        "high-throughput JPEG 2000 lossless pixels with resolutions in order",
    ),
    ("203", "high-throughput JPEG 2000 pixels"),
    (
        "204",
        "high-throughput JPEG 2000 pixels fetched from a server",
    ),
];

/// The sentence for a syntax that is not read: its name where it has one, its identifier, and what to do.
fn refused(uid: &str) -> Problem {
    let shown: String = uid.chars().take(64).collect();
    let end = uid.strip_prefix("1.2.840.10008.1.2.4.");
    let name = NOT_READ.iter().find(|(known, _)| end == Some(known));
    if let Some((_, name)) = name {
        let what = format!("{name} (transfer syntax {shown})");
        return Problem::unsupported(FORMAT, what, REMEDY);
    }
    let is_video = end.is_some_and(|rest| rest.len() == 3 && rest.starts_with("10"));
    match is_video {
        true => {
            let what = format!("a video (MPEG, H.264 or H.265; transfer syntax {shown})");
            Problem::unsupported(FORMAT, what, VIDEO_REMEDY)
        }
        false => Problem::unsupported(FORMAT, format!("the transfer syntax '{shown}'"), REMEDY),
    }
}

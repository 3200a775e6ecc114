//! Transfer syntaxes: how the data set and the pixels are written.

use super::element::Walker;
use super::problem::FORMAT;
use crate::error::Problem;

/// How pixels are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Coding {
    /// As they are.
    Native,
    /// Run lengths.
    Rle,
    /// JPEG with loss, lossless, or JPEG-LS: the image itself tells which.
    Jpeg,
    /// JPEG 2000 with loss, or lossless.
    Jpeg2000,
    /// The file does not say it: as they are, or what the first fragment begins like.
    Unknown,
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
    /// Elements without their representations, numbers with the low byte first.
    pub(super) const IMPLICIT: Self = Self {
        explicit: false,
        ..Self::EXPLICIT
    };
    /// Elements with their representations, numbers with the low byte first.
    pub(super) const EXPLICIT: Self = Self {
        explicit: true,
        big_endian: false,
        deflated: false,
        coding: Coding::Native,
    };
    /// Elements with their representations, numbers with the high byte first.
    pub(super) const BIG_ENDIAN: Self = Self {
        big_endian: true,
        ..Self::EXPLICIT
    };

    /// What a transfer syntax identifier stands for.
    pub(super) fn of(uid: &str) -> Result<Self, Problem> {
        let compressed = |coding| Self {
            coding,
            ..Self::EXPLICIT
        };
        Ok(match uid {
            "1.2.840.10008.1.2" => Self::IMPLICIT,
            "1.2.840.10008.1.2.1" => Self::EXPLICIT,
            "1.2.840.10008.1.2.1.99" => Self {
                deflated: true,
                ..Self::EXPLICIT
            },
            "1.2.840.10008.1.2.2" => Self::BIG_ENDIAN,
            "1.2.840.10008.1.2.5" => compressed(Coding::Rle),
            "1.2.840.10008.1.2.4.50"
            | "1.2.840.10008.1.2.4.51"
            | "1.2.840.10008.1.2.4.57"
            | "1.2.840.10008.1.2.4.70"
            | "1.2.840.10008.1.2.4.80"
            | "1.2.840.10008.1.2.4.81" => compressed(Coding::Jpeg),
            "1.2.840.10008.1.2.4.90" | "1.2.840.10008.1.2.4.91" => compressed(Coding::Jpeg2000),
            other => return Err(refused(other)),
        })
    }

    /// The same where nothing says how pixels are written.
    pub(super) fn of_unknown_pixels(self) -> Self {
        Self {
            coding: Coding::Unknown,
            ..self
        }
    }

    /// Reads elements in this syntax.
    pub(super) fn walker<'a>(&self, bytes: &'a [u8]) -> Walker<'a> {
        Walker {
            bytes,
            explicit: self.explicit,
            big_endian: self.big_endian,
        }
    }
}

/// Where a person gets the same frames in a form that is read.
const REMEDY: &str = "Export it from the viewer or archive uncompressed (Explicit VR Little Endian), or as lossless \
                      JPEG, JPEG-LS, JPEG 2000 or RLE; gdcmconv --raw converts files, too";
/// The same for high-throughput JPEG 2000, which gdcmconv does not know either.
const HIGH_THROUGHPUT_REMEDY: &str = "Export it from the viewer or archive uncompressed (Explicit VR Little Endian), or as lossless \
                                      JPEG, JPEG-LS, JPEG 2000 or RLE; pydicom's decompress with pylibjpeg-openjpeg converts files, too";
const VIDEO_REMEDY: &str =
    "Export its frames uncompressed, or as an MP4 or WebM video, which the page opens itself";

/// Names of the syntaxes of encapsulated pixels that are not read, by the end of their identifiers.
const NOT_READ: [(&str, &str); 14] = [
    ("52", "hierarchical JPEG pixels"),
    ("53", "spectral selection JPEG pixels"),
    ("55", "full progression JPEG pixels"),
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
        let remedy = match name.starts_with("high-throughput") {
            true => HIGH_THROUGHPUT_REMEDY,
            false => REMEDY,
        };
        return Problem::unsupported(FORMAT, what, remedy);
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

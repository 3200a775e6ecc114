//! Transfer syntaxes: how the data set and the pixels are written.

use dicom_transfer_syntax_registry::{TransferSyntax, entries};

use super::FORMAT;
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

/// The sentence for a syntax that is not read.
fn refused(uid: &str) -> Problem {
    let remedy = "Export it uncompressed, or as JPEG or RLE";
    let kind = match uid.strip_prefix("1.2.840.10008.1.2.4.") {
        Some("80" | "81") => "JPEG-LS pixels",
        Some("90" | "91" | "92" | "93") => "JPEG 2000 pixels",
        Some("94" | "95") => "pixels that are fetched from a server",
        Some("201" | "202" | "203") => "high-throughput JPEG 2000 pixels",
        Some("110" | "111" | "112") => "JPEG XL pixels",
        Some(rest) if rest.starts_with("10") => "video (MPEG or H.264 or H.265)",
        _ => {
            let shown: String = uid.chars().take(64).collect();
            let what = format!("the transfer syntax '{shown}'");
            return Problem::unsupported(FORMAT, what, remedy);
        }
    };
    Problem::unsupported(FORMAT, kind, remedy)
}

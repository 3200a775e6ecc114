//! What a file is, told by its content.

use crate::model::stl;

/// Kinds of files that a page or a command may be given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// A PNG image.
    Png,
    /// A JPEG image.
    Jpeg,
    /// A TIFF image of one or more pages.
    Tiff,
    /// A DICOM object.
    Dicom,
    /// An STL model.
    Stl,
    /// A Wavefront OBJ model.
    Obj,
    /// A PLY model.
    Ply,
    /// Poses (`JT_EULER_312`).
    Jts,
    /// A calibration (`JT_INTCALIB`).
    Calibration,
    /// A camera matrix (MayaCam 2.0).
    Mayacam,
    /// A pose library of this project.
    Library,
    /// A saved session of the page.
    Session,
    /// None of these.
    Unknown,
}

impl Kind {
    /// A word for programs: `png`, `jpeg`, `tiff`, `dicom`, `stl`, `obj`, `ply`, `jts`, `calibration`, `mayacam`,
    /// `library`, `session`, `unknown`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpeg",
            Self::Tiff => "tiff",
            Self::Dicom => "dicom",
            Self::Stl => "stl",
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Jts => "jts",
            Self::Calibration => "calibration",
            Self::Mayacam => "mayacam",
            Self::Library => "library",
            Self::Session => "session",
            Self::Unknown => "unknown",
        }
    }

    /// A noun for sentences.
    pub(crate) fn noun(self) -> &'static str {
        match self {
            Self::Png => "a PNG image",
            Self::Jpeg => "a JPEG image",
            Self::Tiff => "a TIFF image",
            Self::Dicom => "a DICOM file",
            Self::Stl => "an STL model",
            Self::Obj => "an OBJ model",
            Self::Ply => "a PLY model",
            Self::Jts => "a pose file",
            Self::Calibration => "a calibration",
            Self::Mayacam => "a camera matrix",
            Self::Library => "a pose library",
            Self::Session => "a saved session",
            Self::Unknown => "a file of an unknown kind",
        }
    }
}

/// How much of a text is looked at.
const TEXT_BYTES: usize = 64 << 10;

/// First bytes that leave no doubt.
const SIGNATURES: [(&[u8], Kind); 11] = [
    (b"\x89PNG\r\n\x1a\n", Kind::Png),
    (b"\xFF\xD8\xFF", Kind::Jpeg),
    (b"II*\0", Kind::Tiff),
    (b"MM\0*", Kind::Tiff),
    (b"II+\0", Kind::Tiff),
    (b"MM\0+", Kind::Tiff),
    (b"FLUOROPL", Kind::Library),
    (b"ply\n", Kind::Ply),
    (b"ply\r", Kind::Ply),
    (b"JT_EULER_312", Kind::Jts),
    (b"JT_INTCALIB", Kind::Calibration),
];

/// Tells what a file is. Content decides; the extension of `name` is asked only when the content fits nothing or
/// is cut too short to tell, so that the person is told what is wrong with the file rather than that it is
/// unknown.
pub fn sniff(bytes: &[u8], name: &str) -> Kind {
    by_content(bytes).unwrap_or_else(|| match bytes.is_empty() {
        true => Kind::Unknown,
        false => by_name(name),
    })
}

fn by_content(bytes: &[u8]) -> Option<Kind> {
    let signed = SIGNATURES
        .iter()
        .find(|(signature, _)| bytes.starts_with(signature));
    if let Some((_, kind)) = signed {
        return Some(*kind);
    }
    if bytes.get(128..132) == Some(b"DICM") {
        return Some(Kind::Dicom);
    }
    if stl::is_binary(bytes) {
        return Some(Kind::Stl);
    }
    text_kind(bytes)
}

fn text_kind(bytes: &[u8]) -> Option<Kind> {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(TEXT_BYTES)]);
    let text = head.trim_start_matches('\u{FEFF}').trim_start();
    let first = text.lines().next().unwrap_or_default().trim();
    if text.starts_with("JT_EULER_312") {
        Some(Kind::Jts)
    } else if text.starts_with("JT_INTCALIB") || text.starts_with("JTA_INTCALIB") {
        Some(Kind::Calibration)
    } else if first.eq_ignore_ascii_case("image size") {
        Some(Kind::Mayacam)
    } else if text.starts_with('{') && text.contains("fluoropose-session") {
        Some(Kind::Session)
    } else if stl::is_ascii(bytes) {
        Some(Kind::Stl)
    } else if text.lines().any(is_obj_line) {
        Some(Kind::Obj)
    } else {
        None
    }
}

/// A vertex line: `v` and at least three numbers.
fn is_obj_line(line: &str) -> bool {
    let mut words = line.split_ascii_whitespace();
    words.next() == Some("v") && words.take(3).filter(|w| w.parse::<f32>().is_ok()).count() == 3
}

fn by_name(name: &str) -> Kind {
    let extension = name
        .rsplit_once('.')
        .map(|(_, end)| end.to_ascii_lowercase());
    match extension.as_deref() {
        Some("png") => Kind::Png,
        Some("jpg" | "jpeg") => Kind::Jpeg,
        Some("tif" | "tiff") => Kind::Tiff,
        Some("dcm" | "dicom") => Kind::Dicom,
        Some("stl") => Kind::Stl,
        Some("obj") => Kind::Obj,
        Some("ply") => Kind::Ply,
        _ => Kind::Unknown,
    }
}

//! What a file is, by its content.

mod camera_form;
pub(crate) mod stl_form;

use crate::dicom::is_dicom;

/// Kinds of files that a page or a command may be given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// A PNG image.
    Png,
    /// A JPEG image.
    Jpeg,
    /// A JPEG 2000 image: a codestream or a JP2 file.
    Jpeg2000,
    /// A TIFF image of one or more pages.
    Tiff,
    /// A BMP image.
    Bmp,
    /// A DICOM object.
    Dicom,
    /// A NumPy array.
    Numpy,
    /// An STL model.
    Stl,
    /// A Wavefront OBJ model.
    Obj,
    /// A PLY model.
    Ply,
    /// A model in a form that is not read: STEP, IGES, Parasolid, 3MF, glTF, VTK and the like.
    OtherModel,
    /// Poses (`JT_EULER_312`, `JTA_EULER_KINEMATICS`, `JTA_EULER_POSE`).
    Jts,
    /// A calibration (`JT_INTCALIB`).
    Calibration,
    /// A camera matrix (MayaCam 2.0, or as OpenCV, ROS or MATLAB write one).
    Mayacam,
    /// A pose library of this project.
    Library,
    /// A saved session of the page.
    Session,
    /// Outlines as the page writes them.
    Outlines,
    /// Outlines in the form of the COCO data set.
    Coco,
    /// Outlines in the form of labelme.
    Labelme,
    /// A region of ImageJ, or several in a zip.
    Imagej,
    /// A correction of distortion.
    Distortion,
    /// A study: which files belong together, and what is known of them.
    Study,
    /// A video, which only a browser reads.
    Video,
    /// None of these.
    Unknown,
}

impl Kind {
    /// A word for programs: `png`, `jpeg`, `jpeg2000`, `tiff`, `bmp`, `dicom`, `numpy`, `stl`, `obj`, `ply`, `other-model`, `jts`, `calibration`,
    /// `mayacam`, `library`, `session`, `outlines`, `coco`, `labelme`, `imagej`, `distortion`, `study`, `video`, `unknown`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpeg",
            Self::Jpeg2000 => "jpeg2000",
            Self::Tiff => "tiff",
            Self::Bmp => "bmp",
            Self::Dicom => "dicom",
            Self::Numpy => "numpy",
            Self::Stl => "stl",
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::OtherModel => "other-model",
            Self::Jts => "jts",
            Self::Calibration => "calibration",
            Self::Mayacam => "mayacam",
            Self::Library => "library",
            Self::Session => "session",
            Self::Outlines => "outlines",
            Self::Coco => "coco",
            Self::Labelme => "labelme",
            Self::Imagej => "imagej",
            Self::Distortion => "distortion",
            Self::Study => "study",
            Self::Video => "video",
            Self::Unknown => "unknown",
        }
    }

    /// A noun for sentences.
    pub(crate) fn noun(self) -> &'static str {
        match self {
            Self::Png => "a PNG image",
            Self::Jpeg => "a JPEG image",
            Self::Jpeg2000 => "a JPEG 2000 image",
            Self::Tiff => "a TIFF image",
            Self::Bmp => "a BMP image",
            Self::Dicom => "a DICOM file",
            Self::Numpy => "a NumPy array",
            Self::Stl => "an STL model",
            Self::Obj => "an OBJ model",
            Self::Ply => "a PLY model",
            Self::OtherModel => "a model in another form",
            Self::Jts => "a pose file",
            Self::Calibration => "a calibration",
            Self::Mayacam => "a camera matrix",
            Self::Library => "a pose library",
            Self::Session => "a saved session",
            Self::Outlines => "a file of outlines",
            Self::Coco => "outlines in COCO form",
            Self::Labelme => "outlines of labelme",
            Self::Imagej => "regions of ImageJ",
            Self::Distortion => "a correction of distortion",
            Self::Study => "a study",
            Self::Video => "a video",
            Self::Unknown => "a file of an unknown kind",
        }
    }
}

/// Bytes of the beginning of a file that are examined.
pub const SNIFFED: usize = 64 << 10;

/// Any of these stands near the beginning of a COCO file, in whatever order it lists its parts.
const COCO_WORDS: [&str; 3] = ["\"annotations\"", "\"images\"", "\"categories\""];

/// The first stands near the beginning of a file of labelme, and one of the others behind it.
const LABELME_WORDS: (&str, [&str; 2]) = ("\"shapes\"", ["\"shape_type\"", "\"imagePath\""]);

/// First lines of files of poses.
const POSES: [&str; 3] = ["JT_EULER_312", "JTA_EULER_KINEMATICS", "JTA_EULER_POSE"];

/// A line of every study file.
const STUDY: &str = "[[component]]";

/// First bytes that belong to one kind alone.
const SIGNATURES: [(&[u8], Kind); 19] = [
    (b"\x89PNG\r\n\x1a\n", Kind::Png),
    (b"\xFF\xD8\xFF", Kind::Jpeg),
    (&crate::jpeg2000::CODESTREAM, Kind::Jpeg2000),
    (&crate::jpeg2000::JP2, Kind::Jpeg2000),
    (b"II*\0", Kind::Tiff),
    (b"MM\0*", Kind::Tiff),
    (b"II+\0", Kind::Tiff),
    (b"MM\0+", Kind::Tiff),
    (crate::numpy::MARK, Kind::Numpy),
    (b"FLUOROPL", Kind::Library),
    (b"ply\n", Kind::Ply),
    (b"ply\r", Kind::Ply),
    (b"JT_INTCALIB", Kind::Calibration),
    (b"Iout", Kind::Imagej),
    // STEP, Parasolid, glTF, VTK, OFF.
    (b"ISO-10303-21", Kind::OtherModel),
    (b"**ABCDEFGHIJKLMNOPQRSTUVWXYZ", Kind::OtherModel),
    (b"glTF", Kind::OtherModel),
    (b"# vtk DataFile", Kind::OtherModel),
    (b"OFF\n", Kind::OtherModel),
];

/// Files of CAD programs and meshes in forms that are not read, by their names: many are archives inside, or have no mark of their own.
const OTHER_MODELS: [&str; 22] = [
    "stp", "step", "igs", "iges", "x_t", "x_b", "sldprt", "sldasm", "catpart", "ipt", "f3d", "3dm",
    "3mf", "amf", "glb", "gltf", "off", "vtk", "vtp", "wrl", "fbx", "dae",
];

/// What a file is. The content decides. The extension of `name` is used only where the content fits nothing or is too short
/// to tell, so that the person learns what is wrong with the file and not that it is unknown.
pub fn sniff(bytes: &[u8], name: &str) -> Kind {
    sniff_head(&bytes[..bytes.len().min(SNIFFED)], bytes.len(), name)
}

/// The same from the first [`SNIFFED`] bytes of a file of `length` bytes, or all bytes of a shorter one, so that the rest
/// need not be moved into the module.
pub fn sniff_head(head: &[u8], length: usize, name: &str) -> Kind {
    by_content(head, length).unwrap_or_else(|| match head.is_empty() {
        true => Kind::Unknown,
        false => by_name(name),
    })
}

fn by_content(bytes: &[u8], length: usize) -> Option<Kind> {
    // Before signatures: scanners and archives put a TIFF header in front of the mark.
    if is_dicom(bytes, length) {
        return Some(Kind::Dicom);
    }
    let signed = SIGNATURES
        .iter()
        .find(|(signature, _)| bytes.starts_with(signature));
    if let Some((_, kind)) = signed {
        return Some(*kind);
    }
    if is_video(bytes) {
        return Some(Kind::Video);
    }
    if is_zip_of_regions(bytes) {
        return Some(Kind::Imagej);
    }
    if stl_form::is_binary(bytes, length) {
        return Some(Kind::Stl);
    }
    if is_bmp(bytes) {
        return Some(Kind::Bmp);
    }
    text_kind(bytes)
}

/// Its mark is two letters, so the length of its second header counts too.
fn is_bmp(bytes: &[u8]) -> bool {
    let header = bytes.get(14..).and_then(<[u8]>::first_chunk::<4>);
    bytes.starts_with(b"BM")
        && header.is_some_and(|&four| (12..=124).contains(&u32::from_le_bytes(four)))
}

/// By the name of the first file in it, behind a header of a fixed length.
fn is_zip_of_regions(bytes: &[u8]) -> bool {
    const NAME_LENGTH: usize = 26;
    const NAME: usize = 30;
    let length = bytes.get(NAME_LENGTH..).and_then(<[u8]>::first_chunk);
    let length = length.map_or(0, |&two| u16::from_le_bytes(two).into());
    let name = bytes.get(NAME..).and_then(|rest| rest.get(..length));
    bytes.starts_with(b"PK\x03\x04")
        && name.is_some_and(|name| name.to_ascii_lowercase().ends_with(b".roi"))
}

/// First bytes of Matroska and WebM, MPEG, Windows Media; then the forms that begin with a length: MP4 and QuickTime
/// (still pictures come in the same boxes), AVI.
fn is_video(bytes: &[u8]) -> bool {
    const BEGINNINGS: [&[u8]; 3] = [b"\x1A\x45\xDF\xA3", b"\0\0\x01\xBA", b"\x30\x26\xB2\x75"];
    const STILLS: [&[u8; 4]; 5] = [b"heic", b"heix", b"mif1", b"avif", b"avis"];
    let still = bytes
        .get(8..12)
        .is_some_and(|brand| STILLS.iter().any(|known| brand == *known));
    BEGINNINGS
        .iter()
        .any(|beginning| bytes.starts_with(beginning))
        || (bytes.get(4..8) == Some(b"ftyp") && !still)
        || (bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"AVI "))
}

fn text_kind(bytes: &[u8]) -> Option<Kind> {
    let text = String::from_utf8_lossy(bytes);
    let text = text.trim_start_matches('\u{FEFF}').trim_start();
    let first = camera_form::first_said(text);
    if POSES.iter().any(|form| text.starts_with(form)) {
        Some(Kind::Jts)
    } else if first.starts_with("JT_INTCALIB") || first.starts_with("JTA_INTCALIB") {
        Some(Kind::Calibration)
    } else if camera_form::is_mayacam(first) {
        Some(Kind::Mayacam)
    } else if text.starts_with('{') && text.contains("fluoropose-session") {
        Some(Kind::Session)
    } else if text.starts_with('{') && text.contains("fluoropose-outlines") {
        Some(Kind::Outlines)
    } else if text.starts_with('{') && text.contains("fluoropose-distortion") {
        Some(Kind::Distortion)
    } else if text.starts_with('{') && COCO_WORDS.iter().any(|word| text.contains(word)) {
        Some(Kind::Coco)
    } else if text.starts_with('{') && is_labelme(text) {
        Some(Kind::Labelme)
    } else if text.lines().any(|line| line.trim_end() == STUDY) {
        Some(Kind::Study)
    } else if stl_form::is_ascii(bytes) {
        Some(Kind::Stl)
    } else if text.lines().any(is_obj_line) {
        Some(Kind::Obj)
    } else if camera_form::is_other(text) {
        Some(Kind::Mayacam)
    } else {
        None
    }
}

fn is_labelme(text: &str) -> bool {
    let (first, others) = LABELME_WORDS;
    text.contains(first) && others.iter().any(|word| text.contains(word))
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
        Some("jp2" | "j2k" | "j2c" | "jpc") => Kind::Jpeg2000,
        Some("tif" | "tiff") => Kind::Tiff,
        Some("bmp" | "dib") => Kind::Bmp,
        Some("dcm" | "dicom") => Kind::Dicom,
        Some("npy") => Kind::Numpy,
        Some("stl") => Kind::Stl,
        Some("obj") => Kind::Obj,
        Some("ply") => Kind::Ply,
        Some("mp4" | "m4v" | "mov" | "webm" | "mkv" | "avi" | "mpg" | "mpeg" | "wmv") => {
            Kind::Video
        }
        Some(other) if OTHER_MODELS.contains(&other) => Kind::OtherModel,
        _ => Kind::Unknown,
    }
}

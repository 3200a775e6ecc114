//! What is given changed bytes.

use std::path::PathBuf;
use std::{fs, io};

use fluoropose::Calibration;
use fluoropose::image::mask::words_needed;
use fluoropose::implant::{ArenaNeeds, ImplantFile};
use fluoropose::library::Library;
use fluoropose::pose::jts;
use fluoropose::{Outline, Point};
use fluoropose_decode::{FrameFile, decode_mask, decode_model, sniff};

use super::made::{FEMUR, SIDE};
use super::{jts as second, outline};
use crate::home;

/// A file, whole, to be changed.
pub struct Seed {
    /// Readers look at a name's ending.
    pub name: String,
    /// What is in it.
    pub bytes: Vec<u8>,
}

/// A reader, or the way from an outline to a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Images, DICOM, masks and models.
    Frames,
    /// Libraries with checksums that are right for what they hold.
    Libraries,
    /// Implants in one file with checksums that are right for what they hold.
    Implants,
    /// Pose files, beside a second reader.
    Poses,
    /// Both kinds of calibration.
    Calibrations,
    /// Outlines of any shape, to poses.
    Outlines,
}

/// Most frames of a file that are decoded.
const FRAMES: usize = 4;

/// Where a library's header has its checksums.
const BODY_CRC: usize = 176;
const HEADER_CRC: usize = 252;
/// The same of an implant's, and the length of its library.
const IMPLANT_BODY_CRC: usize = 44;
const IMPLANT_HEADER_CRC: usize = 316;
const LIBRARY_BYTES: usize = 32;

impl Target {
    /// Every one.
    pub const ALL: [Self; 6] = [
        Self::Frames,
        Self::Libraries,
        Self::Implants,
        Self::Poses,
        Self::Calibrations,
        Self::Outlines,
    ];

    /// Its name, which is that of its folder in the corpus.
    pub fn name(self) -> &'static str {
        match self {
            Self::Frames => "frames",
            Self::Libraries => "libraries",
            Self::Implants => "implants",
            Self::Poses => "poses",
            Self::Calibrations => "calibrations",
            Self::Outlines => "outlines",
        }
    }

    /// What is kept of it.
    ///
    /// # Errors
    /// For what cannot be read.
    pub fn corpus(self) -> io::Result<Vec<Seed>> {
        let folder = match self {
            Self::Implants => {
                return Ok(vec![Seed {
                    name: "femur".into(),
                    bytes: FEMUR.implant.clone(),
                }]);
            }
            Self::Libraries => home().join("golden"),
            _ => home().join("corpus").join(self.name()),
        };
        let mut paths: Vec<PathBuf> = fs::read_dir(folder)?
            .map(|entry| Ok(entry?.path()))
            .collect::<io::Result<_>>()?;
        paths.retain(|path| {
            self != Self::Libraries || path.extension().is_some_and(|end| end == "library")
        });
        paths.sort();
        paths.into_iter().map(Seed::read).collect()
    }

    /// Reads bytes. Whatever they are it may refuse them, and does not panic.
    ///
    /// # Panics
    /// Where two readers do not agree, or an answer is none that may be given.
    pub fn run(self, Seed { name, bytes }: &Seed) {
        match self {
            Self::Frames => frames(bytes, name),
            Self::Libraries => library(bytes.clone()),
            Self::Implants => implant(bytes),
            Self::Poses => poses(&String::from_utf8_lossy(bytes)),
            Self::Calibrations => calibration(&String::from_utf8_lossy(bytes)),
            Self::Outlines => outline::run(bytes),
        }
    }
}

impl Seed {
    /// Reads a file.
    ///
    /// # Errors
    /// Where it cannot be read.
    pub fn read(path: PathBuf) -> io::Result<Self> {
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        Ok(Self {
            name,
            bytes: fs::read(path)?,
        })
    }
}

fn frames(bytes: &[u8], name: &str) {
    let _ = sniff(bytes, name);
    let _ = decode_model(bytes, name);
    let _ = decode_mask(bytes, name);
    if let Ok(file) = FrameFile::open(bytes, name) {
        for index in 0..file.count().min(FRAMES) {
            let _ = file.frame(index);
        }
    }
}

/// With the checksums that its bytes should have: what is behind them is read then.
fn library(mut bytes: Vec<u8>) {
    let _ = Library::open(&bytes);
    sum(&mut bytes, BODY_CRC, HEADER_CRC);
    let Ok(library) = Library::open(&bytes) else {
        return;
    };
    let mut words = vec![0; library.info().canonical.words_needed()];
    for view in 0..library.views() {
        library.draw(view, &mut words);
        let record = library.record(view);
        assert!(record.scale.is_finite(), "a view of no scale");
        let drawn: u32 = words.iter().map(|word| word.count_ones()).sum();
        assert_eq!(drawn, library.pixels(view), "view {view}");
    }
}

fn implant(bytes: &[u8]) {
    let _ = ImplantFile::open(bytes);
    // Only its lengths are looked at: what is meant is memory that was checked before.
    if ImplantFile::trusted(bytes).is_ok() {
        let _ = ArenaNeeds::of(bytes, 64, 64);
    }
    let mut bytes = bytes.to_vec();
    sum_implant(&mut bytes);
    let Ok(implant) = ImplantFile::open(&bytes) else {
        return;
    };
    let corners = [(40.0, 30.0), (90.0, 40.0), (85.0, 100.0), (45.0, 90.0)];
    let corners = corners.map(|(column, row)| Point::new(column, row));
    let outline = Outline::new(&corners, SIDE, SIDE).expect("simple");
    outline::look(&implant.component(), &outline);
}

/// Writes the checksums of what an implant file holds, of its library first.
fn sum_implant(bytes: &mut [u8]) {
    let number = |bytes: &[u8], at: usize| bytes.get(at..at + 4)?.try_into().ok();
    let Some(library) = number(bytes, LIBRARY_BYTES).map(u32::from_le_bytes) else {
        return;
    };
    if let Some(at) = bytes.len().checked_sub(library as usize) {
        sum(&mut bytes[at..], BODY_CRC, HEADER_CRC);
    }
    sum(bytes, IMPLANT_BODY_CRC, IMPLANT_HEADER_CRC);
}

/// Writes the checksums of a file's body, which begins behind that of the header.
fn sum(bytes: &mut [u8], body_crc: usize, header_crc: usize) {
    let body = header_crc + 4;
    if bytes.len() < body {
        return;
    }
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let of_body = crc.checksum(&bytes[body..]);
    bytes[body_crc..body_crc + 4].copy_from_slice(&of_body.to_le_bytes());
    let of_header = crc.checksum(&bytes[..header_crc]);
    bytes[header_crc..body].copy_from_slice(&of_header.to_le_bytes());
}

fn poses(text: &str) {
    let ours: Result<Vec<_>, usize> = match jts::read(text) {
        Err(_) => Err(0),
        Ok(rows) => rows
            .map(|row| match row {
                Ok(pose) => Ok(pose.map(|pose| bits_of(<[f64; 6]>::from(pose)))),
                Err(jts::JtsError::Row { line }) => Err(line),
                Err(jts::JtsError::Heading) => Err(0),
            })
            .collect(),
    };
    let theirs = second::read(text).map(|rows| {
        let bits = |row: [f64; 6]| row.map(f64::to_bits);
        rows.into_iter()
            .map(|row| row.map(bits))
            .collect::<Vec<_>>()
    });
    assert_eq!(ours, theirs, "the two readers of poses do not agree");
}

/// To the last bit, signs of zeros too.
fn bits_of(row: [f64; 6]) -> [u64; 6] {
    row.map(f64::to_bits)
}

fn calibration(text: &str) {
    let Ok(calibration) = Calibration::parse(text) else {
        return;
    };
    if let Ok(camera) = calibration.camera(64, 48) {
        calibration.doubts(&camera).for_each(drop);
        let words = words_needed(camera.width(), camera.height());
        assert!(words > 0, "a camera of no pixels");
    }
}

//! Opening a library: everything is checked once, afterwards nothing can fail.

use thiserror::Error;

use super::wire::{
    HEADER_BYTES, HEADER_CRC_AT, MAGIC, RECORD_BYTES, Reader, VERSION, checksum, read_grid,
    read_record,
};
use super::{Grid, LibraryInfo, ViewRecord};
use crate::camera::{Camera, CameraError};
use crate::canonical::{CanonicalError, CanonicalSpec};

/// Why bytes are not a library.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum LibraryError {
    /// The first bytes are others.
    #[error("this is not a library file: it does not begin with FLUOROPL")]
    Magic,
    /// The layout is unknown.
    #[error("the library has version {0}; this program reads version {VERSION}. Build it again")]
    Version(u16),
    /// The file is shorter or longer than its header says.
    #[error("the library has {given} bytes but should have {needed}: the file is cut or padded")]
    Length {
        /// By the header.
        needed: u64,
        /// In fact.
        given: u64,
    },
    /// A checksum is wrong.
    #[error("the library's {0} is damaged: its checksum does not fit. Build or fetch it again")]
    Checksum(&'static str),
    /// A number in it is impossible although the checksum fits.
    #[error("the library's {0} is not possible; the file was written wrongly. Build it again")]
    Value(&'static str),
    /// The canonical frame is impossible.
    #[error(transparent)]
    Canonical(#[from] CanonicalError),
    /// The camera is impossible.
    #[error(transparent)]
    Camera(#[from] CameraError),
}

/// A library read in place.
#[derive(Clone, Copy, Debug)]
pub struct Library<'a> {
    info: LibraryInfo,
    records: &'a [u8],
    bits: &'a [u8],
}

/// Bytes of the canonical bits of one view.
pub(super) fn view_bytes(canonical: &CanonicalSpec) -> usize {
    canonical.size() * canonical.size() / 8
}

/// Bytes of a whole library; `None` where that overflows.
pub(super) fn library_bytes(canonical: &CanonicalSpec, grid: &Grid) -> Option<usize> {
    let views = grid.x.count.checked_mul(grid.y.count)?;
    views
        .checked_mul(RECORD_BYTES + view_bytes(canonical))?
        .checked_add(HEADER_BYTES)
}

impl<'a> Library<'a> {
    /// Checks `bytes` and reads them in place: heading, length, both checksums, and that every
    /// number is finite and possible. Takes time proportional to the length, once.
    ///
    /// # Errors
    /// [`LibraryError`] says what is wrong. A file in which any one bit was flipped is refused.
    pub fn open(bytes: &'a [u8]) -> Result<Self, LibraryError> {
        let (header, body) = split_header(bytes)?;
        let (info, body_bytes, body_crc) = read_header(header)?;
        let needed = library_bytes(&info.canonical, &info.grid)
            .ok_or(LibraryError::Value("number of views"))? as u64;
        let given = bytes.len() as u64;
        if given != needed || body_bytes != body.len() as u64 {
            return Err(LibraryError::Length { needed, given });
        }
        if checksum(body) != body_crc {
            return Err(LibraryError::Checksum("body"));
        }
        let (records, bits) = body.split_at(info.grid.views() * RECORD_BYTES);
        let library = Self {
            info,
            records,
            bits,
        };
        library.check_records()?;
        Ok(library)
    }

    /// What the library was made from.
    #[must_use]
    pub fn info(&self) -> &LibraryInfo {
        &self.info
    }

    /// Number of views.
    #[must_use]
    pub fn views(&self) -> usize {
        self.info.grid.views()
    }

    /// The record of a view; all zero beyond the last.
    #[must_use]
    pub fn record(&self, view: usize) -> ViewRecord {
        let start = view.saturating_mul(RECORD_BYTES);
        read_record(self.records.get(start..).unwrap_or_default())
    }

    /// The canonical bits of a view, row by row, least significant bit leftmost; empty beyond
    /// the last.
    #[must_use]
    pub fn bits(&self, view: usize) -> &'a [u8] {
        let length = view_bytes(&self.info.canonical);
        let start = view.saturating_mul(length);
        self.bits
            .get(start..start.saturating_add(length))
            .unwrap_or_default()
    }

    /// The canonical bits of all views, one after another.
    pub fn all_bits(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        self.bits.chunks_exact(view_bytes(&self.info.canonical))
    }

    fn check_records(&self) -> Result<(), LibraryError> {
        for view in 0..self.views() {
            let record = self.record(view);
            let (x, y) = self.info.grid.place(view);
            let agrees = record.x_deg == self.info.grid.x.at(x as f64)
                && record.y_deg == self.info.grid.y.at(y as f64);
            let possible = record.scale > 0.0
                && record.scale.is_finite()
                && record.angle.abs() <= 2.0
                && record.offset.iter().all(|value| value.abs() < 1e6)
                && record.area > 0;
            if !agrees {
                return Err(LibraryError::Value("view rotation"));
            }
            if !possible {
                return Err(LibraryError::Value("view record"));
            }
        }
        Ok(())
    }
}

fn split_header(bytes: &[u8]) -> Result<(&[u8; HEADER_BYTES], &[u8]), LibraryError> {
    if !bytes.starts_with(&MAGIC) {
        return Err(LibraryError::Magic);
    }
    let short = LibraryError::Length {
        needed: HEADER_BYTES as u64,
        given: bytes.len() as u64,
    };
    bytes.split_first_chunk().ok_or(short)
}

fn read_header(header: &[u8; HEADER_BYTES]) -> Result<(LibraryInfo, u64, u32), LibraryError> {
    let (checked, crc) = header.split_at(HEADER_CRC_AT);
    let reader = &mut Reader::new(checked);
    let _: [u8; MAGIC.len()] = reader.bytes();
    let version = reader.u16();
    // The version comes before the checksum: a later layout may keep it elsewhere.
    if version != VERSION {
        return Err(LibraryError::Version(version));
    }
    if checksum(checked) != Reader::new(crc).u32() {
        return Err(LibraryError::Checksum("header"));
    }
    if usize::from(reader.u16()) != HEADER_BYTES {
        return Err(LibraryError::Value("header length"));
    }
    let area = reader.u32();
    let canonical = CanonicalSpec::new(usize::from(reader.u16()), area)?;
    let counts = [reader.u16(), reader.u16()].map(usize::from);
    let _reserved = reader.u16();
    let grid = read_grid(reader, counts[0], counts[1]);
    let distance = reader.f64();
    let reference = [reader.f64(), reader.f64(), reader.f64()];
    let focal = reader.f64();
    let size = [reader.u32(), reader.u32()].map(|side| side as usize);
    let focals = [reader.f64(), reader.f64()];
    let centre = [reader.f64(), reader.f64()];
    let info = LibraryInfo {
        canonical,
        grid,
        distance,
        reference,
        focal,
        camera: Camera::new(size[0], size[1], focals, centre)?,
        model: reader.bytes(),
    };
    check_info(&info)?;
    Ok((info, reader.u64(), reader.u32()))
}

pub(super) fn check_info(info: &LibraryInfo) -> Result<(), LibraryError> {
    let axis = |axis: &super::GridAxis, reach: f64| {
        let last = axis.at(axis.count.saturating_sub(1) as f64);
        (1..=4096).contains(&axis.count) && axis.step > 0.0 && axis.first >= -reach && last <= reach
    };
    let checks = [
        ("range of x rotations", axis(&info.grid.x, 89.0)),
        ("range of y rotations", axis(&info.grid.y, 360.0)),
        ("distance", info.distance > 0.0 && info.distance <= 1e5),
        ("focal length", info.focal >= 1.0 && info.focal <= 1e7),
        (
            "reference point",
            info.reference.iter().all(|value| value.abs() <= 1e4),
        ),
    ];
    match checks.iter().find(|(_, holds)| !holds) {
        Some((name, _)) => Err(LibraryError::Value(name)),
        None => Ok(()),
    }
}

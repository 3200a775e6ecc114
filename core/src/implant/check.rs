//! Checking an implant file in slices of time.

use super::error::ImplantError;
use super::header::Header;
use super::open::{ImplantFile, Parts};
use super::wire::HEADER_BYTES;
use crate::checksum::Checksum;
use crate::library::Library;
use crate::math::dot;
use crate::mesh::Mesh;
use crate::mesh::symmetry::SymmetryPlane;

/// A check that can be interrupted: [`Self::go_on`] sums some bytes of the body at a time; [`Self::finish`] does the rest.
pub struct ImplantCheck<'a> {
    bytes: &'a [u8],
    header: Header,
    sum: Checksum,
    /// Bytes that are in the sum.
    at: usize,
}

impl<'a> ImplantFile<'a> {
    /// Checks `bytes` and reads them in place: lengths, checksums, that vertices are possible, edges have
    /// theirs, and all that [`Library::open`] checks. Takes time proportional
    /// to the length, once; [`ImplantCheck`] takes it in slices.
    ///
    /// # Errors
    /// [`ImplantError`] says what is wrong. A file in which any one bit was flipped is refused.
    pub fn open(bytes: &'a [u8]) -> Result<Self, ImplantError> {
        ImplantCheck::new(bytes)?.finish()
    }

    /// Reads bytes in place that are as they were written: lengths and checksums, as [`Library::intact`] does. What these cannot
    /// tell is [`Self::open`]'s to ask, where a file is made or a program is built.
    ///
    /// # Errors
    /// [`ImplantError`] says what is wrong. A file in which any one bit was flipped is refused.
    pub fn intact(bytes: &'a [u8]) -> Result<Self, ImplantError> {
        ImplantCheck::new(bytes)?.finish_intact()
    }
}

impl core::fmt::Debug for ImplantCheck<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("ImplantCheck")
            .field("left", &self.left())
            .finish_non_exhaustive()
    }
}

impl<'a> ImplantCheck<'a> {
    /// Reads the header.
    ///
    /// # Errors
    /// [`ImplantError`] for bytes that no file begins with, of another length, or at an odd place.
    pub fn new(bytes: &'a [u8]) -> Result<Self, ImplantError> {
        let header = Header::read(bytes)?;
        Parts::of(&header, bytes)?;
        Ok(Self {
            bytes,
            header,
            sum: Checksum::EMPTY,
            at: HEADER_BYTES,
        })
    }

    /// Bytes of the body that are not yet in its sum.
    #[must_use]
    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Takes at most so many more bytes into the sum. Gives whether some are left.
    pub fn go_on(&mut self, bytes: usize) -> bool {
        let end = self.at.saturating_add(bytes).min(self.bytes.len());
        self.sum
            .add(self.bytes.get(self.at..end).unwrap_or_default());
        self.at = end;
        self.left() > 0
    }

    /// What is left of the sum, and no more: as [`ImplantFile::intact`].
    ///
    /// # Errors
    /// [`ImplantError`] where it does not fit.
    pub fn finish_intact(mut self) -> Result<ImplantFile<'a>, ImplantError> {
        self.go_on(usize::MAX);
        match self.sum.finish() == self.header.body_crc {
            true => ImplantFile::trusted(self.bytes),
            false => Err(ImplantError::Checksum("body")),
        }
    }

    /// What is left of the sum, and then what it cannot tell: that numbers are possible. That surface and library are of one model is
    /// asked where a file is written; the sum is over both.
    ///
    /// # Errors
    /// [`ImplantError`] says what is wrong.
    pub fn finish(self) -> Result<ImplantFile<'a>, ImplantError> {
        // Of the header as it was read, whose sum is right: once more of the file's it would stand on the stack twice.
        check_planes(&self.header.planes, self.header.deviation_mm)?;
        let parts = Parts::of(&self.header, self.bytes)?;
        let expected = self.header.bounds();
        let file = self.finish_intact()?;
        let bounds = match parts.triangles {
            // Those of the edges are.
            [] => Mesh::check_vertices(parts.vertices)?,
            triangles => Mesh::check(parts.vertices, triangles)?,
        };
        Library::open(parts.library)?;
        if bounds != expected {
            return Err(ImplantError::Value("bounds"));
        }
        if !parts.edges.are_some() || !parts.edges.fit(parts.vertices.len()) {
            return Err(ImplantError::Value("edges"));
        }
        Ok(file)
    }
}

/// How far the square of a normal's length may be from that of a unit.
const UNIT: f64 = 1e-9;
/// Lengths and coordinates that an implant may have, mm: those of its vertices.
const LONGEST_MM: f64 = 1e4;

/// Whether planes can be mirrored in, and deviations are lengths: a pose whose mirror image is none would be taken for the only one.
///
/// # Errors
/// [`ImplantError::Value`].
pub(super) fn check_planes(
    planes: &[SymmetryPlane],
    deviation_mm: f64,
) -> Result<(), ImplantError> {
    let is_length = |value: f64| (0.0..=LONGEST_MM).contains(&value);
    let is_possible = |plane: &SymmetryPlane| {
        let length = dot(&plane.normal, &plane.normal);
        (length - 1.0).abs() <= UNIT
            && plane.point.iter().all(|at| is_length(at.abs()))
            && is_length(plane.deviation_mm)
    };
    match (planes.iter().all(is_possible), is_length(deviation_mm)) {
        (true, true) => Ok(()),
        (false, _) => Err(ImplantError::Value("planes of symmetry")),
        (_, false) => Err(ImplantError::Value("deviation")),
    }
}

//! The header of an implant file.

use super::error::ImplantError;
use super::wire::{AS_NUMBERS, HEADER_BYTES, HEADER_CRC_AT, MAGIC, WITH_TRIANGLES, sizes};
use crate::checksum::checksum;
use crate::math::Vector3;
use crate::mesh::Bounds;
use crate::mesh::symmetry::{PLANES, SymmetryPlane};

/// What the header says.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Header {
    pub(super) version: u16,
    /// Vertices, triangles (of version 0; none of version 1; bytes of boxes and edges of version 2), boxes, edges and rims.
    pub(super) counts: [u32; 5],
    pub(super) library_bytes: u32,
    /// How far the surface lies from that of the model that it was made from at most, mm.
    pub(super) deviation_mm: f64,
    pub(super) centre: Vector3,
    pub(super) radius: f64,
    /// Silhouette edges at most, and crossings of a row in the mean at most, from any side.
    pub(super) edges: u32,
    pub(super) crossings: u32,
    pub(super) planes: heapless::Vec<SymmetryPlane, PLANES>,
    pub(super) body_crc: u32,
}

/// Where the parts of a body begin, and the library's end.
pub(super) type Places = [usize; 7];

impl Header {
    pub(super) fn bounds(&self) -> Bounds {
        Bounds {
            centre: self.centre,
            radius: self.radius,
        }
    }

    /// Where the parts are in the file; `None` where no file is so long.
    pub(super) fn places(&self) -> Option<Places> {
        let sizes = sizes(self.version)?;
        let mut places = [HEADER_BYTES; 7];
        let mut at = HEADER_BYTES;
        for ((&count, size), end) in self.counts.iter().zip(sizes).zip(&mut places[1..]) {
            let bytes = usize::try_from(count).ok()?.checked_mul(size)?;
            at = at.checked_add(bytes)?.checked_next_multiple_of(4)?;
            *end = at;
        }
        places[6] = at.checked_add(usize::try_from(self.library_bytes).ok()?)?;
        Some(places)
    }

    /// What a header says.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, ImplantError> {
        if !bytes.starts_with(&MAGIC) {
            return Err(ImplantError::Magic);
        }
        let (checked, rest) = bytes
            .split_at_checked(HEADER_CRC_AT)
            .filter(|(_, rest)| rest.len() >= 4)
            .ok_or(ImplantError::Length {
                needed: HEADER_BYTES as u64,
                given: bytes.len() as u64,
            })?;
        let mut reader = Reader(checked.get(MAGIC.len()..).unwrap_or_default());
        // The version comes before the checksum: a later layout may keep it elsewhere.
        let version = u16::from_le_bytes(reader.bytes());
        if sizes(version).is_none() {
            return Err(ImplantError::Version(version));
        }
        if checksum([checked]) != Reader(rest).u32() {
            return Err(ImplantError::Checksum("header"));
        }
        let length = u16::from_le_bytes(reader.bytes());
        let mut header = Self {
            version,
            counts: core::array::from_fn(|_| reader.u32()),
            library_bytes: reader.u32(),
            edges: reader.u32(),
            crossings: reader.u32(),
            body_crc: reader.u32(),
            ..Self::default()
        };
        let planes = reader.u32() as usize;
        header.deviation_mm = reader.f64();
        header.centre = reader.vector();
        header.radius = reader.f64();
        for _ in 0..planes.min(PLANES) {
            let plane = SymmetryPlane {
                point: reader.vector(),
                normal: reader.vector(),
                deviation_mm: reader.f64(),
            };
            // There is room for as many.
            let _ = header.planes.push(plane);
        }
        let is_right = usize::from(length) == HEADER_BYTES
            && planes <= PLANES
            && header.second_count_is_possible();
        match is_right && header.needs_are_possible() {
            true => Ok(header),
            false => Err(ImplantError::Value("header")),
        }
    }

    /// Whether what stands second is there where it must be, and nowhere else.
    fn second_count_is_possible(&self) -> bool {
        let [_, second, _, edges, _] = self.counts;
        match self.version {
            WITH_TRIANGLES => second > 0,
            AS_NUMBERS => second == 0,
            // An edge takes a byte at least.
            _ => edges <= second && (second > 0) == (edges > 0),
        }
    }

    /// Whether no more silhouette edges are said to be than there are edges, and no more of them to cross a row: programs
    /// make room by these numbers.
    fn needs_are_possible(&self) -> bool {
        let [_, _, _, edges, rims] = self.counts.map(u64::from);
        let (seen, crossings) = (u64::from(self.edges), u64::from(self.crossings));
        seen <= edges + rims && crossings <= seen + 1
    }

    /// The header's bytes.
    #[cfg(feature = "alloc")]
    pub(super) fn write(&self) -> [u8; HEADER_BYTES] {
        let mut bytes = [0; HEADER_BYTES];
        let mut writer = Writer {
            bytes: &mut bytes,
            at: 0,
        };
        writer.put(&MAGIC);
        writer.put(&self.version.to_le_bytes());
        writer.put(&(HEADER_BYTES as u16).to_le_bytes());
        let counts = self.counts.iter();
        let others = [
            self.library_bytes,
            self.edges,
            self.crossings,
            self.body_crc,
            self.planes.len() as u32,
        ];
        for number in counts.chain(&others) {
            writer.put(&number.to_le_bytes());
        }
        let planes = self.planes.iter().flat_map(|plane| {
            let ([a, b, c], [d, e, f]) = (plane.point, plane.normal);
            [a, b, c, d, e, f, plane.deviation_mm]
        });
        let [x, y, z] = self.centre;
        for number in [self.deviation_mm, x, y, z, self.radius]
            .into_iter()
            .chain(planes)
        {
            writer.put(&number.to_le_bytes());
        }
        let (checked, crc) = bytes.split_at_mut(HEADER_CRC_AT);
        crc.copy_from_slice(&checksum([checked]).to_le_bytes());
        bytes
    }
}

/// Reads numbers one after another; zero beyond the end.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        match self.0.split_first_chunk() {
            Some((head, rest)) => {
                self.0 = rest;
                *head
            }
            None => [0; N],
        }
    }

    fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.bytes())
    }

    fn f64(&mut self) -> f64 {
        f64::from_le_bytes(self.bytes())
    }

    fn vector(&mut self) -> Vector3 {
        core::array::from_fn(|_| self.f64())
    }
}

/// Writes numbers one after another.
#[cfg(feature = "alloc")]
struct Writer<'b> {
    bytes: &'b mut [u8],
    at: usize,
}

#[cfg(feature = "alloc")]
impl Writer<'_> {
    fn put(&mut self, bytes: &[u8]) {
        let end = self.at + bytes.len();
        self.bytes[self.at..end].copy_from_slice(bytes);
        self.at = end;
    }
}

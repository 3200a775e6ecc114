//! Opening an implant file.

use super::error::ImplantError;
use super::header::{Header, Places};
use super::needs::ContourNeeds;
use super::wire::VERSION;
use crate::finder::Component;
use crate::library::{Library, digest_in};
use crate::mesh::edges::PackedEdges;
use crate::mesh::symmetry::SymmetryPlane;
use crate::mesh::{Mesh, Model};

/// Bytes at an address that is a multiple of 4, as an implant file must have: `Aligned(*include_bytes!("femur.implant"))` in
/// a `static`.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(4))]
pub struct Aligned<T: ?Sized>(pub T);

/// All that is known of an implant, read in place.
#[derive(Clone, Debug)]
pub struct ImplantFile<'a> {
    bytes: &'a [u8],
    header: Header,
    model: Model<'a>,
    library: Library<'a>,
}

impl<'a> ImplantFile<'a> {
    /// Reads the header of bytes of which it is known that they are whole and right: [`Self::open`] accepted them before,
    /// or a boot loader has checked a signature over them. Of other bytes the poses mean nothing.
    ///
    /// # Errors
    /// [`ImplantError`] for bytes that no file begins with, or of another length.
    pub fn trusted(bytes: &'a [u8]) -> Result<Self, ImplantError> {
        let header = Header::read(bytes)?;
        let parts = Parts::of(&header, bytes)?;
        let library = Library::trusted(parts.library)?;
        Ok(Self {
            bytes,
            model: parts.model(&header)?,
            header,
            library,
        })
    }

    /// All of its bytes.
    #[must_use]
    pub fn bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// The surface with the edges that it is drawn from. Its triangles are those that the edges are of
    /// ([`Model::for_each_triangle`]); a list of them stands in files of version 0 alone.
    #[must_use]
    pub fn model(&self) -> &Model<'a> {
        &self.model
    }

    /// The library, made from that surface.
    #[must_use]
    pub fn library(&self) -> &Library<'a> {
        &self.library
    }

    /// Planes of near-symmetry.
    #[must_use]
    pub fn planes(&self) -> &[SymmetryPlane] {
        &self.header.planes
    }

    /// How far the surface lies from that of the CAD model that it was made from at most, mm; zero where it is that model.
    #[must_use]
    pub fn deviation_mm(&self) -> f64 {
        self.header.deviation_mm
    }

    /// What drawing it takes.
    #[must_use]
    pub fn contour_needs(&self) -> ContourNeeds {
        ContourNeeds {
            edges: self.header.edges as usize,
            crossings_a_row: self.header.crossings as usize,
        }
    }

    /// What [`crate::find()`] looks for.
    #[must_use]
    pub fn component(&self) -> Component<'_> {
        Component {
            library: &self.library,
            model: &self.model,
            planes: &self.header.planes,
        }
    }
}

/// The parts of a body, as long as the header says.
pub(super) struct Parts<'a> {
    pub(super) vertices: &'a [[f32; 3]],
    pub(super) triangles: &'a [[u32; 3]],
    pub(super) edges: PackedEdges<'a>,
    pub(super) library: &'a [u8],
}

impl<'a> Parts<'a> {
    pub(super) fn of(header: &Header, bytes: &'a [u8]) -> Result<Self, ImplantError> {
        let length = |needed| ImplantError::Length {
            needed,
            given: bytes.len() as u64,
        };
        let places: Places = header.places().ok_or(length(u64::MAX))?;
        if bytes.len() != places[6] {
            return Err(length(places[6] as u64));
        }
        let [_, second, boxes, edges, rims] = header.counts.map(|count| count as usize);
        let part = |number: usize| {
            bytes
                .get(places[number]..places[number + 1])
                .unwrap_or_default()
        };
        let rims = cast(part(4).get(..6 * rims).unwrap_or_default())?;
        let (triangles, edges) = match header.version {
            VERSION => {
                let bytes = part(1).get(..second).unwrap_or_default();
                let edges = PackedEdges::tight(bytes, boxes, edges, rims);
                (&[][..], Some(edges))
            }
            _ => {
                let edges = PackedEdges::new(cast(part(2))?, cast(part(3))?, rims);
                (cast(part(1))?, edges)
            }
        };
        Ok(Self {
            vertices: cast(part(0))?,
            triangles,
            edges: edges.ok_or(ImplantError::Value("edges"))?,
            library: part(5),
        })
    }

    /// The surface, as if it had been checked.
    fn model(&self, header: &Header) -> Result<Model<'a>, ImplantError> {
        let digest = digest_in(self.library).ok_or(ImplantError::Value("library"))?;
        let mesh = Mesh::known(self.vertices, self.triangles, header.bounds(), digest);
        Ok(Model::packed(mesh, self.edges))
    }
}

/// Bytes as what they were written from.
fn cast<T: bytemuck::AnyBitPattern>(bytes: &[u8]) -> Result<&[T], ImplantError> {
    if cfg!(target_endian = "big") {
        return Err(ImplantError::Place);
    }
    bytemuck::try_cast_slice(bytes).map_err(|_| ImplantError::Place)
}

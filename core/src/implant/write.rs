//! Writing an implant file, for callers that have an allocator.

use alloc::vec;
use alloc::vec::Vec;

use super::check::check_planes;
use super::error::ImplantError;
use super::header::Header;
use super::needs::contour_needed;
use super::wire::{HEADER_BYTES, VERSION};
use crate::checksum::checksum;
use crate::library::Library;
use crate::mesh::Model;
use crate::mesh::edges::{PackMemory, pack_edges, packed_needed, tightened};
use crate::mesh::symmetry::SymmetryPlane;

/// The bytes of an implant file: a model with its edges, the library that was made from it, its planes of near-symmetry, and
/// how far its surface lies from the CAD model that it stands for, mm.
///
/// # Errors
/// [`ImplantError`] where they do not belong together, or the model cannot be packed.
pub fn write_implant(
    model: &Model<'_>,
    library: &[u8],
    planes: &[SymmetryPlane],
    deviation_mm: f64,
) -> Result<Vec<u8>, ImplantError> {
    check_planes(planes, deviation_mm)?;
    if Library::open(library)?.info().model != model.digest() {
        return Err(ImplantError::OtherModel);
    }
    let edges = model.edges().ok_or(ImplantError::Edges)?;
    let needs = packed_needed(&edges);
    let mut boxes = vec![[0.0; 10]; needs.boxes];
    let mut packed = vec![[0; 4]; needs.edges];
    let mut rims = vec![[0; 3]; needs.rims];
    let memory = PackMemory {
        boxes: &mut boxes,
        edges: &mut packed,
        rims: &mut rims,
    };
    let kept = pack_edges(&edges, memory).ok().flatten();
    if !kept.is_some_and(|kept| kept.are_some()) {
        return Err(ImplantError::Edges);
    }
    let contour = contour_needed(model);
    let tight = tightened(&boxes, &packed);
    let lengths = [
        model.vertices().len(),
        tight.len(),
        boxes.len(),
        packed.len(),
        rims.len(),
    ];
    let bounds = model.bounds();
    let mut header = Header {
        version: VERSION,
        counts: lengths.map(|length| length as u32),
        library_bytes: library.len() as u32,
        deviation_mm,
        centre: bounds.centre,
        radius: bounds.radius,
        edges: contour.edges as u32,
        crossings: contour.crossings_a_row as u32,
        planes: planes.iter().copied().collect(),
        body_crc: 0,
    };
    let mut bytes = vec![0; HEADER_BYTES];
    let numbers = model.vertices().iter().flatten();
    bytes.extend(numbers.flat_map(|x| x.to_le_bytes()));
    bytes.extend(tight);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    bytes.extend(rims.iter().flatten().flat_map(|x| x.to_le_bytes()));
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    bytes.extend(library);
    header.body_crc = checksum([&bytes[HEADER_BYTES..]]);
    bytes[..HEADER_BYTES].copy_from_slice(&header.write());
    Ok(bytes)
}

//! Writes binary STL.

use crate::implant::Triangles;
use crate::whole;
use anyhow::{Context, Result};
use glam::Vec3;
use std::io::{self, Write};
use std::path::Path;

/// Writes a mesh as binary STL, in the units of its vertices (mm).
///
/// The header says what made it; a file of this kind must not begin with the word "solid".
pub fn write(mesh: &Triangles, out: &mut impl Write) -> io::Result<()> {
    let mut header = [b' '; 80];
    let text = b"fluoropose built-in implant, mm, binary STL";
    header[..text.len()].copy_from_slice(text);
    out.write_all(&header)?;
    let count = u32::try_from(mesh.triangles.len()).map_err(|_| {
        io::Error::new(
            io::ErrorKind::InvalidInput,
            "a binary STL holds at most 2^32 - 1 triangles",
        )
    })?;
    out.write_all(&count.to_le_bytes())?;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| Vec3::from(mesh.vertices[vertex as usize]));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for value in [normal, a, b, c].iter().flat_map(|v| v.to_array()) {
            out.write_all(&value.to_le_bytes())?;
        }
        out.write_all(&0u16.to_le_bytes())?;
    }
    Ok(())
}

/// Writes a mesh to a file as binary STL.
pub fn write_file(mesh: &Triangles, path: &Path) -> Result<()> {
    let mut bytes = Vec::new();
    write(mesh, &mut bytes).with_context(|| format!("cannot write {}", path.display()))?;
    whole::write(path, bytes)
}

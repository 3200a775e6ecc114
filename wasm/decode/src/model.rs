//! Indexed triangle meshes from model files.
//!
//! Coordinates are kept as they are (the field uses millimetres); normals, colours, textures and groups are left out.
//! Winding is not changed. OBJ and ASCII PLY have no end mark: such a file that was cut between two faces, or within its
//! last number, cannot be told from a shorter model.

mod raw;

mod obj;
mod ply;
mod stl;

use std::borrow::Cow;
use std::collections::HashMap;

use crate::error::{DecodeError, Problem};
use crate::sniff::{Kind, sniff};
use raw::{Raw, check_triangles, check_vertices};

/// An indexed triangle mesh: at least one triangle, every coordinate finite, every index in range, every triangle
/// with three different vertices, no two vertices equal.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// Coordinates x, y, z in the file's unit (the field uses mm).
    pub vertices: Vec<[f32; 3]>,
    /// Three indices into `vertices` each, in the file's winding.
    pub triangles: Vec<[u32; 3]>,
    /// What was left out of the file, a sentence each, for the person who opened it.
    pub notes: Vec<String>,
}

/// Decodes an STL (binary or ASCII), OBJ or PLY (ASCII or binary) model.
///
/// `bytes` is the whole file, borrowed or owned. `name` is used in errors, and its extension only where the content alone
/// does not tell the format.
///
/// # Errors
/// [`DecodeError`] if the file is not a model, is damaged, has no triangle with three different corners, names a
/// vertex that is not there, has a coordinate that is not finite, or is larger than the
/// [limits](crate::limits).
pub fn decode_model<'a>(bytes: impl Into<Cow<'a, [u8]>>, name: &str) -> Result<Model, DecodeError> {
    decode(bytes.into(), name).map_err(|problem| problem.of(name))
}

fn decode(bytes: Cow<'_, [u8]>, name: &str) -> Result<Model, Problem> {
    let raw = match sniff(&bytes, name) {
        Kind::Stl => stl::read(bytes)?,
        Kind::Obj => obj::read(&bytes)?,
        Kind::Ply => ply::read(&bytes)?,
        _ if bytes.is_empty() => return Err(Problem::Empty),
        Kind::OtherModel => return Err(Problem::OtherModel),
        other => {
            return Err(Problem::NotAModel {
                found: other.noun(),
            });
        }
    };
    merge(&raw)
}

/// Merges equal vertices (bit for bit, -0 being 0), drops triangles with equal corners and vertices without a
/// triangle.
fn merge(raw: &Raw) -> Result<Model, Problem> {
    check_vertices(raw.vertices.len())?;
    check_triangles(raw.triangles.len())?;
    if let Some(vertex) = raw
        .vertices
        .iter()
        .position(|v| !v.iter().all(|c| c.is_finite()))
    {
        return Err(Problem::NonFiniteVertex { vertex });
    }
    let mut merged = Merger::default();
    let mut model = Model {
        vertices: Vec::new(),
        triangles: Vec::with_capacity(raw.triangles.len()),
        notes: raw.notes.clone(),
    };
    for corners in &raw.triangles {
        let mut positions = [[0.0; 3]; 3];
        for (position, &index) in positions.iter_mut().zip(corners) {
            // Adding 0 turns -0 into 0 and changes nothing else.
            *position = raw
                .vertices
                .get(index as usize)
                .ok_or(Problem::VertexIndex {
                    index: index.into(),
                    vertices: raw.vertices.len(),
                })?
                .map(|c| c + 0.0);
        }
        let [a, b, c] = positions;
        if a != b && b != c && c != a {
            model
                .triangles
                .push(positions.map(|p| merged.index(p, &mut model.vertices)));
        }
    }
    match model.triangles.is_empty() {
        true => Err(Problem::EmptyModel),
        false => Ok(model),
    }
}

/// Positions that have been seen, with their indices.
#[derive(Default)]
struct Merger(HashMap<[u32; 3], u32>);

impl Merger {
    fn index(&mut self, position: [f32; 3], vertices: &mut Vec<[f32; 3]>) -> u32 {
        *self.0.entry(position.map(f32::to_bits)).or_insert_with(|| {
            vertices.push(position);
            // Within u32: at most three a triangle, and those are bounded.
            (vertices.len() - 1) as u32
        })
    }
}

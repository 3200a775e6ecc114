//! Model files to an indexed triangle mesh.
//!
//! Coordinates are taken as they are (the field uses millimetres); normals, colours, textures and groups are left
//! out. Winding is not changed. A file cut between two faces of a format without an end mark (OBJ, ASCII PLY
//! within its last number) cannot be told from a shorter model.

mod obj;
mod ply;
pub(crate) mod stl;

use std::borrow::Cow;
use std::collections::HashMap;

use crate::error::{DecodeError, Problem};
use crate::limits::{MAX_TRIANGLES, MAX_VERTICES};
use crate::sniff::{Kind, sniff};

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

/// Triangles and vertices as a file gives them.
#[derive(Default)]
pub(crate) struct Raw {
    pub vertices: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub notes: Vec<String>,
}

/// Decodes an STL (binary or ASCII), OBJ or PLY (ASCII or binary) model.
///
/// `bytes` is the whole file, borrowed or owned; `name` is used in errors, and its extension only where the content alone does not
/// tell the format.
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
        other => {
            return Err(Problem::NotAModel {
                found: other.noun(),
            });
        }
    };
    merge(&raw)
}

/// Refuses a number of triangles above the limit.
pub(crate) fn check_triangles(triangles: usize) -> Result<(), Problem> {
    match triangles > MAX_TRIANGLES {
        true => Err(Problem::TooManyTriangles {
            triangles: triangles as u64,
        }),
        false => Ok(()),
    }
}

/// Refuses a number of vertices above the limit.
pub(crate) fn check_vertices(vertices: usize) -> Result<(), Problem> {
    match vertices > MAX_VERTICES {
        true => Err(Problem::TooManyVertices {
            vertices: vertices as u64,
        }),
        false => Ok(()),
    }
}

impl Raw {
    /// Adds a face of any number of corners as a fan from its first.
    pub(crate) fn push_face(&mut self, corners: &[u32]) -> Result<(), Problem> {
        let [first, rest @ ..] = corners else {
            return Ok(());
        };
        for pair in rest.windows(2) {
            self.triangles.push([*first, pair[0], pair[1]]);
        }
        check_triangles(self.triangles.len())
    }
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

//! A mesh as a file gives it, and its limits.

use crate::error::Problem;
use crate::limits::{MAX_TRIANGLES, MAX_VERTICES};

/// Triangles and vertices as a file gives them.
#[derive(Default)]
pub(super) struct Raw {
    pub vertices: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub notes: Vec<String>,
}

/// Refuses a number of triangles above the limit.
pub(super) fn check_triangles(triangles: usize) -> Result<(), Problem> {
    match triangles > MAX_TRIANGLES {
        true => Err(Problem::TooManyTriangles {
            triangles: triangles as u64,
        }),
        false => Ok(()),
    }
}

/// Refuses a number of vertices above the limit.
pub(super) fn check_vertices(vertices: usize) -> Result<(), Problem> {
    match vertices > MAX_VERTICES {
        true => Err(Problem::TooManyVertices {
            vertices: vertices as u64,
        }),
        false => Ok(()),
    }
}

impl Raw {
    /// Adds a face of any number of corners as a fan from its first.
    pub(super) fn push_face(&mut self, corners: &[u32]) -> Result<(), Problem> {
        let [first, rest @ ..] = corners else {
            return Ok(());
        };
        for pair in rest.windows(2) {
            self.triangles.push([*first, pair[0], pair[1]]);
        }
        check_triangles(self.triangles.len())
    }
}

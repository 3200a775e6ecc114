//! Whether a mesh is a closed, consistently outward-wound surface.

use super::triangles::Triangles;
use glam::DVec3;
use std::collections::BTreeMap;
use std::fmt;

/// Triangles smaller than this many square millimetres count as degenerate.
pub const LEAST_AREA_MM2: f64 = 1e-5;

/// What is wrong with a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MeshFault {
    /// An edge, by its vertex indices, is not shared by exactly two triangles that run along it in opposite directions.
    Edge(u32, u32),
    /// A triangle, by its index, has next to no area (mm^2).
    Degenerate(usize, f64),
    /// The signed volume (mm^3) is not positive: the surface is inside out.
    InsideOut(f64),
}

impl fmt::Display for MeshFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Edge(a, b) => write!(
                f,
                "the edge between vertices {a} and {b} is not shared by two triangles"
            ),
            Self::Degenerate(triangle, area) => {
                write!(f, "triangle {triangle} has an area of only {area} mm^2")
            }
            Self::InsideOut(volume) => {
                write!(f, "the mesh is inside out: its volume is {volume} mm^3")
            }
        }
    }
}

impl std::error::Error for MeshFault {}

/// Checks a mesh and returns the volume it encloses, in cubic millimetres.
pub fn closed_volume(mesh: &Triangles) -> Result<f64, MeshFault> {
    let mut runs: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    let mut volume = 0.0;
    for (index, &[a, b, c]) in mesh.triangles.iter().enumerate() {
        for edge in [(a, b), (b, c), (c, a)] {
            *runs.entry(edge).or_default() += 1;
        }
        let [p, q, r] = [a, b, c].map(|v| corner(mesh, v));
        let area = (q - p).cross(r - p).length() / 2.0;
        if area < LEAST_AREA_MM2 {
            return Err(MeshFault::Degenerate(index, area));
        }
        volume += p.dot(q.cross(r)) / 6.0;
    }
    for (&(a, b), &count) in &runs {
        if count != 1 || runs.get(&(b, a)) != Some(&1) {
            return Err(MeshFault::Edge(a, b));
        }
    }
    if volume > 0.0 {
        Ok(volume)
    } else {
        Err(MeshFault::InsideOut(volume))
    }
}

fn corner(mesh: &Triangles, vertex: u32) -> DVec3 {
    let [x, y, z] = mesh.vertices[vertex as usize];
    DVec3::new(x.into(), y.into(), z.into())
}

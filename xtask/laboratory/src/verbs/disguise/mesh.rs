//! Models in other axes and files.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::Result;
use fluoropose::math::rotation_by;
use fluoropose_decode::decode_model;
use fluoropose_phantom::implant::Triangles;
use fluoropose_phantom::stl;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::lens::Axes;
use super::plan::{Mesh, Models};
use crate::files::{Component, read, write_bytes, write_text};

/// How far away an origin may lie, mm along each axis.
const ORIGIN_MM: f64 = 150.0;

impl Mesh {
    /// The ending of its files' names.
    pub(super) fn ending(self) -> &'static str {
        match self {
            Self::Stl => "stl",
            Self::Obj => "obj",
            Self::Ply => "ply",
        }
    }
}

/// The axes that a component gets.
pub(super) fn axes(models: &Models, mirrored: bool, random: &mut ChaCha8Rng) -> Axes {
    let turn = [0.0; 3].map(|_: f64| random.random_range(-1.8..1.8));
    let mut turn = rotation_by(&turn);
    let mut origin = [0.0; 3].map(|_: f64| random.random_range(-ORIGIN_MM..ORIGIN_MM));
    if !models.turned {
        turn = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        origin = [0.0; 3];
    }
    if mirrored {
        turn.iter_mut().for_each(|row| row[0] = -row[0]);
    }
    Axes {
        turn,
        origin,
        unit_mm: models.unit_mm,
    }
}

/// Writes the model of a component in other axes.
///
/// # Errors
/// Names the file.
pub(super) fn write(
    from: &Component,
    to: &Path,
    models: &Models,
    axes: &Axes,
    mirrored: bool,
    random: &mut ChaCha8Rng,
) -> Result<()> {
    let model = decode_model(read(&from.model)?, &from.model.display().to_string())?;
    let mut mesh = Triangles {
        vertices: model
            .vertices
            .into_iter()
            .map(|one| axes.vertex(one.map(|x| from.unit().in_mm(x))))
            .collect(),
        triangles: model.triangles,
    };
    for triangle in &mut mesh.triangles {
        // A reflection turns the winding of all.
        if mirrored != (random.random_range(0.0..1.0) < models.flipped) {
            triangle.swap(1, 2);
        }
    }
    let twice = |_: &&[u32; 3]| random.random_range(0.0..1.0) < models.doubled;
    let doubled: Vec<[u32; 3]> = mesh.triangles.iter().filter(twice).copied().collect();
    mesh.triangles.extend(doubled);
    if models.unwelded {
        mesh = unwelded(&mesh);
    }
    match models.mesh {
        Mesh::Stl => {
            let mut bytes = Vec::new();
            stl::write(&mesh, &mut bytes)?;
            write_bytes(to, &bytes)
        }
        Mesh::Obj => write_text(to, &obj(&mesh)),
        Mesh::Ply => write_text(to, &ply(&mesh)),
    }
}

/// Each triangle with vertices of its own.
fn unwelded(mesh: &Triangles) -> Triangles {
    let corners = mesh.triangles.as_flattened();
    let numbers: Vec<u32> = (0..corners.len() as u32).collect();
    Triangles {
        vertices: corners
            .iter()
            .map(|&corner| mesh.vertices[corner as usize])
            .collect(),
        triangles: numbers.as_chunks::<3>().0.to_vec(),
    }
}

fn obj(mesh: &Triangles) -> String {
    let mut text = String::new();
    for [x, y, z] in &mesh.vertices {
        // A string takes everything.
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for ends in &mesh.triangles {
        let [a, b, c] = ends.map(|end| end + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    text
}

fn ply(mesh: &Triangles) -> String {
    let (vertices, faces) = (mesh.vertices.len(), mesh.triangles.len());
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    );
    for [x, y, z] in &mesh.vertices {
        let _ = writeln!(text, "{x} {y} {z}");
    }
    for [a, b, c] in &mesh.triangles {
        let _ = writeln!(text, "3 {a} {b} {c}");
    }
    text
}

//! A model's surface: borrowed vertices and triangles, checked once.

use sha2::{Digest as _, Sha256};
use thiserror::Error;

use crate::math::Vector3;

/// Why vertices and triangles are not a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MeshError {
    /// There is nothing to draw.
    #[error("the model has no triangles")]
    Empty,
    /// A coordinate is NaN, infinite, or beyond 10 m.
    #[error("vertex {0} of the model is not finite or lies more than 10 m away; lengths are in mm")]
    Vertex(usize),
    /// A triangle names a vertex that is not there.
    #[error("triangle {0} of the model names a vertex that does not exist")]
    Index(usize),
    /// All vertices are one point.
    #[error("the model has no extent: all its vertices are the same point")]
    Point,
}

/// A triangle mesh in model coordinates, mm. Winding, holes and order do not matter.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a> {
    vertices: &'a [[f32; 3]],
    triangles: &'a [[u32; 3]],
    bounds: Bounds,
    digest: Digest<'a>,
}

/// How a mesh's digest is told. By a pointer to what computes it, so that a program whose meshes all come from files has none of
/// that: 8 KB of a microcontroller's flash.
#[derive(Clone, Copy, Debug)]
enum Digest<'a> {
    Known(&'a ModelDigest),
    By(fn(&Mesh<'_>) -> ModelDigest),
}

/// SHA-256 of a mesh's vertices and triangles as they are stored.
pub type ModelDigest = [u8; 32];

/// A sphere around all vertices, in model coordinates, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Middle of the box around the vertices.
    pub centre: Vector3,
    /// Distance from it to the farthest vertex.
    pub radius: f64,
}

impl Bounds {
    fn of(vertices: &[[f32; 3]]) -> Self {
        // Exact in 32 bits, which a microcontroller has.
        let mut low = [f32::INFINITY; 3];
        let mut high = [f32::NEG_INFINITY; 3];
        for vertex in vertices {
            for ((low, high), &x) in low.iter_mut().zip(&mut high).zip(vertex) {
                *low = if x < *low { x } else { *low };
                *high = if x > *high { x } else { *high };
            }
        }
        let centre = core::array::from_fn(|k| (f64::from(low[k]) + f64::from(high[k])) / 2.0);
        let squared = farthest_squared(vertices, &centre, [&low, &high]);
        Self {
            centre,
            radius: crate::math::sqrt(squared),
        }
    }
}

/// The square of the distance from `centre` to the vertex that is farthest. Most are so much nearer, as 32 bits tell, that 64 are not
/// asked: where the box lies so near the origin that these are digits enough.
fn farthest_squared(vertices: &[[f32; 3]], centre: &Vector3, [low, high]: [&[f32; 3]; 2]) -> f64 {
    let near = centre.map(|x| x as f32);
    // Of a difference that is more than a part in 256 of a number, rounding takes less than a part in 2^15.
    let is_near = low.iter().zip(high).all(|(low, high)| {
        let farthest = low.abs().max(high.abs());
        (high - low) * 256.0 > farthest
    });
    let (mut most, mut likely) = (0.0f64, 0.0f32);
    for vertex in vertices {
        let rough = vertex.iter().zip(&near).fold(0.0f32, |sum, (at, near)| {
            let off = at - near;
            sum + off * off
        });
        if is_near && rough < likely {
            continue;
        }
        let d: Vector3 = core::array::from_fn(|k| f64::from(vertex[k]) - centre[k]);
        let squared = crate::math::dot(&d, &d);
        if squared > most {
            most = squared;
            likely = squared as f32 * (1.0 - 1.0 / 1024.0);
        }
    }
    most
}

/// See [`Mesh::mark`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceMark(u64);

impl SurfaceMark {
    /// Of edges that are kept with their mesh in one file: nobody asks.
    pub(crate) const NONE: Self = Self(0);
}

impl<'a> Mesh<'a> {
    /// A mesh over vertices (mm, model coordinates) and triples of vertex indices.
    ///
    /// # Errors
    /// [`MeshError`] names the first vertex or triangle at fault.
    pub fn new(vertices: &'a [[f32; 3]], triangles: &'a [[u32; 3]]) -> Result<Self, MeshError> {
        Ok(Self {
            bounds: Self::check(vertices, triangles)?,
            vertices,
            triangles,
            digest: Digest::By(sha_256),
        })
    }

    /// Checks what [`Self::new`] takes.
    ///
    /// # Errors
    /// As that.
    pub(crate) fn check(
        vertices: &[[f32; 3]],
        triangles: &[[u32; 3]],
    ) -> Result<Bounds, MeshError> {
        if triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        let bounds = Self::check_vertices(vertices)?;
        let known = |t: &[u32; 3]| t.iter().all(|&v| (v as usize) < vertices.len());
        match triangles.iter().position(|t| !known(t)) {
            Some(index) => Err(MeshError::Index(index)),
            None => Ok(bounds),
        }
    }

    /// Checks the vertices alone.
    ///
    /// # Errors
    /// [`MeshError`].
    pub(crate) fn check_vertices(vertices: &[[f32; 3]]) -> Result<Bounds, MeshError> {
        // A NaN fails the comparison too.
        let possible = |v: &[f32; 3]| v.iter().all(|x| x.abs() <= 10_000.0);
        if let Some(index) = vertices.iter().position(|v| !possible(v)) {
            return Err(MeshError::Vertex(index));
        }
        let bounds = Bounds::of(vertices);
        if bounds.radius == 0.0 {
            return Err(MeshError::Point);
        }
        Ok(bounds)
    }

    /// What [`Mesh::new`] has checked before, of the same vertices and triangles.
    #[cfg(feature = "alloc")]
    pub(crate) fn checked(
        vertices: &'a [[f32; 3]],
        triangles: &'a [[u32; 3]],
        bounds: Bounds,
    ) -> Self {
        Self {
            vertices,
            triangles,
            bounds,
            digest: Digest::By(sha_256),
        }
    }

    /// The same of a file, which has its digest too.
    pub(crate) fn known(
        vertices: &'a [[f32; 3]],
        triangles: &'a [[u32; 3]],
        bounds: Bounds,
        digest: &'a ModelDigest,
    ) -> Self {
        Self {
            vertices,
            triangles,
            bounds,
            digest: Digest::Known(digest),
        }
    }

    /// Vertices, mm.
    #[must_use]
    pub fn vertices(&self) -> &'a [[f32; 3]] {
        self.vertices
    }

    /// Triangles as vertex indices, all in range.
    #[must_use]
    pub fn triangles(&self) -> &'a [[u32; 3]] {
        self.triangles
    }

    /// Centre of the bounding box, and the radius of the sphere about that centre which holds the model.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// By which edges are known to be this surface's. It tells surfaces apart that were mixed up, not ones that were made
    /// to be alike, and takes a hundredth of the time of [`Self::digest`].
    #[must_use]
    pub fn mark(&self) -> SurfaceMark {
        // FNV-1a, word by word.
        let mix = |hash: u64, word: u32| (hash ^ u64::from(word)).wrapping_mul(0x100_0000_01b3);
        let start = mix(0xcbf2_9ce4_8422_2325, self.vertices.len() as u32);
        let vertices = self.vertices.iter().flatten().map(|x| x.to_bits());
        let words = vertices.chain(self.triangles.iter().flatten().copied());
        SurfaceMark(words.fold(start, mix))
    }

    /// Digest of the geometry, which a library records to know its model again.
    #[must_use]
    pub fn digest(&self) -> ModelDigest {
        match self.digest {
            Digest::Known(&digest) => digest,
            Digest::By(compute) => compute(self),
        }
    }
}

fn sha_256(mesh: &Mesh<'_>) -> ModelDigest {
    let mut hash = Sha256::new();
    hash.update((mesh.vertices.len() as u64).to_le_bytes());
    for x in mesh.vertices.iter().flatten() {
        hash.update(x.to_le_bytes());
    }
    for index in mesh.triangles.iter().flatten() {
        hash.update(index.to_le_bytes());
    }
    hash.finalize().into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    properties! {
        /// Oracle: every vertex in 64 bits.
        #[test]
        fn the_sphere_is_that_of_every_vertex(
            points in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0f32), 1..60),
            size in (-4.5..1.8f32).prop_map(libm::exp10f),
            flat in proptest::bool::weighted(0.2),
            are_ends in any::<bool>(),
            origin in proptest::array::uniform3(prop_oneof![Just(0.0f32), -50.0..50.0f32, -300.0..300.0f32, -9_000.0..9_000.0f32]),
        ) {
            let place = |p: [f32; 3]| core::array::from_fn(|k| {
                let own = if flat && k == 1 { 0.0 } else { p[k] };
                own * size + origin[k]
            });
            // On a sphere many are nearly the farthest.
            let on_sphere = |p: [f32; 3]| {
                let length = libm::sqrtf(p.iter().map(|x| x * x).sum::<f32>()).max(1e-3);
                p.map(|x| x / length)
            };
            let inner = points.iter().copied();
            // About the middle of the sphere where its ends are among them: some are farther by no more than their rounding.
            let ends = [-1.0, 1.0].map(|end| crate::math::IDENTITY.map(|axis| axis.map(|x| end * x as f32)));
            let ends = ends.into_iter().flatten().filter(|_| are_ends);
            let vertices: std::vec::Vec<[f32; 3]> = ends.chain(inner.clone()).chain(inner.map(on_sphere)).map(place).collect();
            let along = |k: usize| vertices.iter().map(move |v| f64::from(v[k]));
            let centre: Vector3 = core::array::from_fn(|k| {
                (along(k).fold(f64::INFINITY, f64::min) + along(k).fold(f64::NEG_INFINITY, f64::max)) / 2.0
            });
            let farthest = vertices.iter().fold(0.0f64, |most, vertex| {
                let d: Vector3 = core::array::from_fn(|k| f64::from(vertex[k]) - centre[k]);
                most.max(crate::math::dot(&d, &d))
            });
            let bounds = Bounds::of(&vertices);
            prop_assert_eq!(bounds.centre, centre);
            prop_assert_eq!(bounds.radius, crate::math::sqrt(farthest));
        }
    }

    #[test]
    fn faults_are_named() {
        let v = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, f32::NAN]];
        let error = |v: &[[f32; 3]], t: &[[u32; 3]]| Mesh::new(v, t).map(|_| ()).err();
        assert_eq!(error(&v, &[]), Some(MeshError::Empty));
        assert_eq!(error(&v, &[[0, 1, 2]]), Some(MeshError::Vertex(2)));
        assert_eq!(error(&v[..2], &[[0, 1, 2]]), Some(MeshError::Index(0)));
        assert_eq!(error(&[[1.0; 3]; 3], &[[0, 1, 2]]), Some(MeshError::Point));
    }

    #[test]
    fn the_digest_knows_a_moved_vertex() {
        let mut v = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let before = Mesh::new(&v, &[[0, 1, 2]]).expect("valid").digest();
        v[2][2] = f32::MIN_POSITIVE;
        assert_ne!(before, Mesh::new(&v, &[[0, 1, 2]]).expect("valid").digest());
    }

    #[test]
    fn the_sphere_holds_the_box() {
        let v = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0]];
        let bounds = Mesh::new(&v, &[[0, 1, 2]]).expect("valid").bounds();
        assert_eq!(bounds.centre, [2.0, 1.5, 0.0]);
        assert_eq!(bounds.radius, 2.5);
    }
}

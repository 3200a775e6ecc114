//! Planes of near-symmetry of a part, found from its surface alone.
//!
//! The normal of a plane of symmetry is a principal axis of the surface, and that of a plane of
//! near-symmetry is near one unless two of the moments are nearly equal; there, directions
//! between the axes are tried too. From each such direction a plane is fitted so that the
//! surface's reflection falls on the surface (`symmetry/fit.rs`): first on the tangent planes of a sample
//! of points, then exactly. Areas weigh, not vertices, so the density of a mesh does not matter,
//! nor do winding and holes.

mod fit;
mod nearest;
mod round;
mod sample;
#[cfg(test)]
mod tests;
mod triangle;

pub use round::revolution;

use heapless::Vec;

use crate::math::{Vector3, add, dot, norm, scale, sin_cos, sqrt};
use crate::mesh::Model;
use crate::mesh::surface::Mesh;
use fit::{Fitted, Plane, Target};
use sample::Samples;

/// A plane in which a part is nearly its own mirror image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SymmetryPlane {
    /// A point of the plane in the middle of the part, model coordinates, mm: of the plane's
    /// points the nearest to the surface's centroid.
    pub point: Vector3,
    /// Unit normal, model coordinates; its largest component is positive.
    pub normal: Vector3,
    /// Root mean square distance of the reflected surface from the surface, mm.
    pub deviation_mm: f64,
}

/// A part that deviates from its reflection by no more than this part of its radius is nearly its own mirror image: trays do by
/// 0.003 at most, femoral components by 0.02 at least.
const NEARLY: f64 = 0.01;

/// Whether a part is so nearly its own mirror image in one of its planes of symmetry that its outlines hardly tell.
#[must_use]
pub fn is_nearly_symmetric(model: &Model<'_>, planes: &[SymmetryPlane]) -> bool {
    let limit = NEARLY * model.bounds().radius;
    planes.iter().any(|plane| plane.deviation_mm < limit)
}

/// Planes that are reported of a part at most.
pub const PLANES: usize = 3;

/// A plane is reported where its deviation is at most this part of the part's size, which is the
/// root mean square distance of the surface from its centroid.
///
/// Measured: tibial trays in their mediolateral plane 0.0001 and 0.003, femoral components 0.04
/// to 0.05; trays in their anteroposterior plane 0.08 to 0.11, the next best planes of femoral
/// components from 0.15. A plane too many costs a refinement, one that is missed may cost the
/// right pose, so the limit is generous.
pub const NEARLY_SYMMETRIC: f64 = 0.07;
/// The same for a part that is nearly symmetric in no plane: a tray made for one side of the body, or a scan that lacks a part of it. Without
/// any plane nobody would look at its mirror image, and no joint would be told by its axes.
pub const ROUGHLY_SYMMETRIC: f64 = 2.0 * NEARLY_SYMMETRIC;

/// Moments are nearly equal where the smaller is above this part of the larger. Femoral
/// components have 0.73 and 0.79, and their axes lie 20 and 25 degrees off their plane.
const NEARLY_EQUAL: f64 = 0.6;
/// Directions between two axes of nearly equal moments, degrees from the first.
const BETWEEN_DEG: [f64; 6] = [22.5, 45.0, 67.5, 112.5, 135.0, 157.5];
/// Directions that are tried at most: axes, between each two of them, and the diagonals.
const STARTS: usize = 3 + 3 * BETWEEN_DEG.len() + 4;
/// Steps of the coarse fit.
const COARSE_PASSES: usize = 10;
/// A coarse deviation above this many times the limit is hopeless. Measured, it exceeds the exact
/// one by up to 0.055 sizes, so planes within the limit stay below 1.8 times the limit.
const COARSE_FACTOR: f64 = 2.0;
/// Planes that are fitted exactly at most, and steps of each.
const EXACT_FITS: usize = 12;
const EXACT_PASSES: usize = 8;
/// Planes are the same within this angle, degrees, and perpendicular within that one.
const SAME_DEG: f64 = 15.0;
const PERPENDICULAR_DEG: f64 = 25.0;

impl SymmetryPlane {
    /// A point's mirror image, model coordinates, mm.
    #[must_use]
    pub fn reflect(&self, point: &Vector3) -> Vector3 {
        let height = dot(&self.normal, point) - dot(&self.normal, &self.point);
        add(point, &scale(&self.normal, -2.0 * height))
    }
}

/// The planes in which a part is nearly symmetric, best first; of a part that is so in none those in which it is
/// [roughly](ROUGHLY_SYMMETRIC), and empty without any.
///
/// Of more planes than [`PLANES`], as a prism or a body of revolution has them, the best is
/// reported with those that are perpendicular to it and to each other, then others.
///
/// The same for a part of any position and direction, whatever its mesh. It depends on the model
/// alone, so call it once a model: 20 to 50 ms for 12 000 triangles, proportional to their
/// number, and about 50 kB of stack.
#[must_use]
pub fn symmetry_planes(mesh: &Mesh<'_>) -> Vec<SymmetryPlane, PLANES> {
    let Some(samples) = Samples::new(mesh) else {
        return Vec::new();
    };
    let mut fitted = fits_within(NEARLY_SYMMETRIC * samples.size, mesh, &samples);
    if fitted.is_empty() {
        fitted = fits_within(ROUGHLY_SYMMETRIC * samples.size, mesh, &samples);
    }
    chosen(&fitted)
        .iter()
        .map(|fit| described(fit, &samples))
        .collect()
}

/// Planes that deviate by no more than a limit, mm, by rising deviation.
fn fits_within(limit: f64, mesh: &Mesh<'_>, samples: &Samples) -> Vec<Fitted, EXACT_FITS> {
    let mut fitted = exact_fits(mesh, samples, limit);
    fitted.retain(|fit| fit.squared <= limit * limit);
    fitted.sort_unstable_by(|a, b| a.squared.total_cmp(&b.squared));
    fitted
}

/// Directions to start from: the principal axes, then those between nearly equal ones.
fn starts(samples: &Samples) -> Vec<Vector3, STARTS> {
    let axes = &samples.axes;
    let equal = |a: usize, b: usize| samples.spread[b] > NEARLY_EQUAL * samples.spread[a];
    let between = [(0, 1), (1, 2), (0, 2)]
        .into_iter()
        .filter(|&(a, b)| equal(a, b))
        .flat_map(|(a, b)| {
            BETWEEN_DEG.map(|angle| {
                let (sine, cosine) = sin_cos(crate::math::radians(angle));
                add(&scale(&axes[a], cosine), &scale(&axes[b], sine))
            })
        });
    let diagonals = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]]
        .into_iter()
        .filter(|_| equal(0, 2))
        .map(|[first, second]| {
            let sum = add(&scale(&axes[0], first), &scale(&axes[1], second));
            let sum = add(&sum, &axes[2]);
            scale(&sum, 1.0 / norm(&sum))
        });
    axes.iter()
        .copied()
        .chain(between)
        .chain(diagonals)
        .collect()
}

/// Planes that the coarse fit finds promising, fitted exactly; each once.
fn exact_fits(mesh: &Mesh<'_>, samples: &Samples, limit: f64) -> Vec<Fitted, EXACT_FITS> {
    let coarse = Target {
        samples,
        surface: None,
    };
    let exact = Target {
        samples,
        surface: Some(mesh),
    };
    let mut promising: Vec<Fitted, STARTS> = starts(samples)
        .into_iter()
        .map(|normal| {
            let offset = 0.0;
            coarse.fit(Plane { normal, offset }, COARSE_PASSES, f64::INFINITY)
        })
        .collect();
    // The axes keep their places before the others: of a body of revolution they span all kinds.
    if let Some((_, others)) = promising.split_at_mut_checked(3) {
        others.sort_unstable_by(|a, b| a.squared.total_cmp(&b.squared));
    }
    let hopeless = COARSE_FACTOR * limit;
    let mut fitted: Vec<Fitted, EXACT_FITS> = Vec::new();
    for start in promising {
        let known = fitted
            .iter()
            .any(|fit| angle_cosine(fit, &start) > cosine(SAME_DEG));
        if fitted.is_full() || known || start.squared > hopeless * hopeless {
            continue;
        }
        // There is room, as just checked.
        let _ = fitted.push(exact.fit(start.plane, EXACT_PASSES, limit));
    }
    fitted
}

/// Of planes by rising deviation: first those perpendicular to all before, then others.
fn chosen(sorted: &[Fitted]) -> Vec<Fitted, PLANES> {
    let mut kept: Vec<Fitted, PLANES> = Vec::new();
    for most in [cosine(90.0 - PERPENDICULAR_DEG), cosine(SAME_DEG)] {
        for fit in sorted {
            if kept.iter().all(|other| angle_cosine(fit, other) <= most) {
                // Of more than there is room for, the first stay.
                let _ = kept.push(*fit);
            }
        }
    }
    kept.sort_unstable_by(|a, b| a.squared.total_cmp(&b.squared));
    kept
}

/// Cosine of the acute angle between two planes.
fn angle_cosine(a: &Fitted, b: &Fitted) -> f64 {
    dot(&a.plane.normal, &b.plane.normal).abs()
}

fn cosine(deg: f64) -> f64 {
    sin_cos(crate::math::radians(deg)).1
}

/// In model coordinates, with a sign that does not depend on the way there.
fn described(fit: &Fitted, samples: &Samples) -> SymmetryPlane {
    let Plane { normal, offset } = fit.plane;
    let largest = normal.iter().fold(
        0.0f64,
        |most, &x| if x.abs() > most.abs() { x } else { most },
    );
    SymmetryPlane {
        point: add(&samples.origin, &scale(&normal, offset)),
        normal: scale(&normal, if largest < 0.0 { -1.0 } else { 1.0 }),
        deviation_mm: sqrt(fit.squared),
    }
}

//! Which way along its axes a component is superior and anterior, from its shape.
//!
//! A femoral component seen from the side is a bow that opens towards the bone, upwards; its anterior flange is the longer
//! arm. A tray's plate lies on top of its keel, and its border is notched behind, for the ligament.

use super::{KneeComponent, mediolateral_axis, own_axes, superoinferior_axis};
use crate::math::{Vector3, add, cross, dot, norm, radians, scale, sin_cos, subtract};
use crate::mesh::surface::Mesh;
use crate::mesh::symmetry::SymmetryPlane;
use crate::pose::Pose;

/// The field's axes (x anterior, y superior, z to the patient's right) in a model's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnatomicalAxes {
    /// `model_from_field`, a rotation: its columns are the field's axes. `pose.compose(&axes.model_from_field)` is the pose
    /// of the model as it were with the field's axes.
    pub model_from_field: Pose,
    /// Whether the shape tells front from back. Where it does not, x and z may both have the other sign; a film in which
    /// the knee bends tells it, or a person.
    pub front_is_known: bool,
    /// Whether the axes are the file's own, in some order and direction.
    pub are_files_own: bool,
}

/// The anatomical axes of a component as its shape tells them; `planes` come from
/// [`crate::mesh::symmetry::symmetry_planes`]. Where the file's own
/// axes, in some order, lie within [`super::OWN_AXIS_DEG`] of those found, across the knee within [`super::OWN_ACROSS_DEG`], they are taken.
/// `None` where the shape has no plane of symmetry or no up.
#[must_use]
pub fn anatomical_axes(
    mesh: &Mesh<'_>,
    planes: &[SymmetryPlane],
    component: KneeComponent,
) -> Option<AnatomicalAxes> {
    let across = mediolateral_axis(mesh, planes)?;
    let up = match component {
        KneeComponent::Femur => opening(mesh, &across)?,
        KneeComponent::Tibia => above_the_keel(mesh, &superoinferior_axis(mesh, &across)?),
    };
    let up = square_to(&up, &across)?;
    let forward = cross(&up, &across);
    let (forward, front_is_known) = match component {
        KneeComponent::Femur => along_the_longer_arm(mesh, &forward, &up),
        KneeComponent::Tibia => away_from_the_notch(mesh, &forward, &across, &up),
    };
    let right = cross(&forward, &up);
    let found = Pose {
        rotation: core::array::from_fn(|k| [forward[k], up[k], right[k]]),
        translation: [0.0; 3],
    };
    let own = own_axes(&found);
    Some(AnatomicalAxes {
        model_from_field: own.unwrap_or(found),
        front_is_known,
        are_files_own: own.is_some(),
    })
}

/// The part of `axis` that is perpendicular to `other`, of length one.
fn square_to(axis: &Vector3, other: &Vector3) -> Option<Vector3> {
    let square = subtract(axis, &scale(other, dot(axis, other)));
    let length = norm(&square);
    (length > 1e-9).then(|| scale(&square, 1.0 / length))
}

pub(super) fn vertices<'m>(mesh: &Mesh<'m>) -> impl Iterator<Item = Vector3> + Clone + 'm {
    mesh.vertices().iter().map(|vertex| vertex.map(f64::from))
}

/// Middle, doubled area and normal times doubled area of every triangle.
pub(super) fn faces<'m>(
    mesh: &Mesh<'m>,
) -> impl Iterator<Item = (Vector3, f64, Vector3)> + Clone + 'm {
    let corners = mesh.vertices();
    mesh.triangles().iter().map(move |triangle| {
        let [a, b, c] = triangle.map(|vertex| corners[vertex as usize].map(f64::from));
        let normal = cross(&subtract(&b, &a), &subtract(&c, &a));
        let middle = scale(&add(&add(&a, &b), &c), 1.0 / 3.0);
        (middle, norm(&normal), normal)
    })
}

/// The first of two perpendicular directions turned towards the second, radians.
fn between(first: &Vector3, second: &Vector3, turn: f64) -> Vector3 {
    let (sin, cos) = sin_cos(turn);
    add(&scale(first, cos), &scale(second, sin))
}

/// Directions round the side view.
const AROUND: usize = 72;
/// The bone cut that faces upwards lies within this of the direction in which the bow opens, degrees.
const CUT_WITHIN_DEG: f64 = 35.0;
/// Faces of a cut lie within this of one direction, and are at least this part of the surface.
const CUT_COSINE: f64 = 0.9986;
const CUT_PART: f64 = 0.015;
/// The bow opens where its outline's middle is at least this far from its surface's, of its radius.
const OPEN_PART: f64 = 0.03;

/// The direction in which a femoral component opens: from the middle of its surface to the middle of its outline in the
/// side view, and, where a flat cut faces nearly that way, its normal.
fn opening(mesh: &Mesh<'_>, across: &Vector3) -> Option<Vector3> {
    let first = super::perpendicular(across);
    let second = cross(across, &first);
    let direction = |turn: f64| between(&first, &second, turn);
    let mut outline = [0.0; 3];
    for step in 0..AROUND {
        let along = direction(core::f64::consts::TAU * step as f64 / AROUND as f64);
        let far = |a: &Vector3, b: &Vector3| dot(a, &along).total_cmp(&dot(b, &along));
        outline = add(&outline, &vertices(mesh).max_by(far)?);
    }
    let outline = scale(&outline, 1.0 / AROUND as f64);
    let (sum, area) = faces(mesh).fold(([0.0; 3], 0.0), |(sum, all), (middle, area, _)| {
        (add(&sum, &scale(&middle, area)), all + area)
    });
    let out = subtract(&outline, &scale(&sum, 1.0 / area));
    let out = subtract(&out, &scale(across, dot(&out, across)));
    if norm(&out) < OPEN_PART * mesh.bounds().radius {
        return None;
    }
    let out = scale(&out, 1.0 / norm(&out));
    Some(cut_facing(mesh, &out, across, area).unwrap_or(out))
}

/// The direction near `out` that most of the surface faces, where enough does.
fn cut_facing(mesh: &Mesh<'_>, out: &Vector3, across: &Vector3, area: f64) -> Option<Vector3> {
    let aside = cross(across, out);
    let steps = CUT_WITHIN_DEG as i32;
    let facing = |along: &Vector3| {
        let near = faces(mesh).filter(|(_, area, normal)| {
            *area > 0.0 && dot(normal, along).abs() > CUT_COSINE * area
        });
        near.fold(([0.0; 3], 0.0), |(sum, all), (_, area, normal)| {
            let sign = if dot(&normal, along) < 0.0 { -1.0 } else { 1.0 };
            (add(&sum, &scale(&normal, sign)), all + area)
        })
    };
    let directions = (-steps..=steps).map(|step| between(out, &aside, radians(f64::from(step))));
    let best = directions.map(|along| facing(&along));
    let (sum, most) = best.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    (most > CUT_PART * area).then(|| scale(&sum, 1.0 / norm(&sum)))
}

/// A tray's axis so directed that its plate, which faces along it, is above the middle.
fn above_the_keel(mesh: &Mesh<'_>, axis: &Vector3) -> Vector3 {
    let (low, high) = reach(vertices(mesh), axis);
    let (sum, weight) = faces(mesh).fold((0.0, 0.0), |(sum, all), (middle, area, normal)| {
        let facing = if area > 0.0 {
            dot(&normal, axis) * dot(&normal, axis) / area
        } else {
            0.0
        };
        (sum + facing * dot(&middle, axis), all + facing)
    });
    let below = weight > 0.0 && sum / weight < (low + high) / 2.0;
    scale(axis, if below { -1.0 } else { 1.0 })
}

/// How far points reach along an axis.
fn reach(points: impl Iterator<Item = Vector3>, axis: &Vector3) -> (f64, f64) {
    points
        .map(|point| dot(&point, axis))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        })
}

/// Of two sides one is told from the other where they differ by more than this part of their size.
const TOLD_PART: f64 = 0.04;

/// The direction of the arm that reaches higher, and whether one does.
fn along_the_longer_arm(mesh: &Mesh<'_>, forward: &Vector3, up: &Vector3) -> (Vector3, bool) {
    let (back, front) = reach(vertices(mesh), forward);
    let middle = (back + front) / 2.0;
    let (low, high) = reach(vertices(mesh), up);
    let arm = |sign: f64| {
        let side = vertices(mesh).filter(|v| sign * (dot(v, forward) - middle) > 0.0);
        reach(side, up).1
    };
    directed(forward, arm(1.0) - arm(-1.0), high - low)
}

/// The direction in which a tray's border is not notched, and whether it is notched on one side alone.
fn away_from_the_notch(
    mesh: &Mesh<'_>,
    forward: &Vector3,
    across: &Vector3,
    up: &Vector3,
) -> (Vector3, bool) {
    /// The plate is the uppermost part of the tray, of its height; the notch lies within this part of the width, and the
    /// lobes beside it beyond this.
    const PLATE: f64 = 0.12;
    const NOTCH: f64 = 0.12;
    const LOBES: f64 = 0.25;
    let (low, high) = reach(vertices(mesh), up);
    let (left, right) = reach(vertices(mesh), across);
    let (back, front) = reach(vertices(mesh), forward);
    let (width, middle) = (right - left, (left + right) / 2.0);
    let plate = vertices(mesh).filter(|v| dot(v, up) > high - PLATE * (high - low));
    let beside = |v: &Vector3| (dot(v, across) - middle).abs() / width;
    let depth = |sign: f64| {
        let ahead = |v: &Vector3| sign * dot(v, forward);
        let most = |a: f64, v: Vector3| a.max(ahead(&v));
        let lobes = plate.clone().filter(|v| beside(v) > LOBES);
        let notch = plate.clone().filter(|v| beside(v) < NOTCH);
        lobes.fold(f64::NEG_INFINITY, most) - notch.fold(f64::NEG_INFINITY, most)
    };
    directed(forward, depth(-1.0) - depth(1.0), front - back)
}

/// An axis in the direction of the sign of `difference`, and whether that is large enough to tell.
fn directed(axis: &Vector3, difference: f64, size: f64) -> (Vector3, bool) {
    let sign = if difference < 0.0 { -1.0 } else { 1.0 };
    (scale(axis, sign), difference.abs() > TOLD_PART * size)
}

#[cfg(test)]
mod tests;

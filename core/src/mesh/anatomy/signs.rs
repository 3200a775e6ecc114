//! Which way along its axes a component is superior and anterior, from its shape.
//!
//! A femoral component seen from the side is a bow that opens towards the bone, upwards; its anterior flange is the longer
//! arm, and what stands between the arms a stem. A tray's plate lies on top of its keel, and its border is notched behind, for the ligament.

use super::cuts::above_the_distal_cut;
use super::faced::{between, faces, reach, vertices};
use super::{
    KneeComponent, is_as_wide_elsewhere, is_of_one_condyle, mediolateral_axis, own_axes,
    superoinferior_axis,
};
use crate::math::{Vector3, add, cross, dot, norm, scale, subtract};
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
/// `None` where the shape has no plane of symmetry or no up, as a plate on nothing, or the proportions of a component for one
/// condyle.
#[must_use]
pub fn anatomical_axes(
    mesh: &Mesh<'_>,
    planes: &[SymmetryPlane],
    component: KneeComponent,
) -> Option<AnatomicalAxes> {
    let across = mediolateral_axis(mesh, planes)?;
    let up = match component {
        KneeComponent::Femur if is_as_wide_elsewhere(mesh, planes, &across) => return None,
        KneeComponent::Femur => opening(mesh, &across)?,
        KneeComponent::Tibia => above_the_keel(mesh, &superoinferior_axis(mesh, &across)?)?,
    };
    let up = square_to(&up, &across)?;
    let forward = cross(&up, &across);
    if is_of_one_condyle(mesh, &forward, &across, component) {
        return None;
    }
    let (forward, front_is_known) = match component {
        KneeComponent::Femur => {
            let (forward, is_longer) = along_the_longer_arm(mesh, &forward, &up);
            let is_notched = is_notched_ahead(mesh, &forward, &across, &up);
            (forward, is_longer && !is_notched)
        }
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

/// Directions round the side view.
const AROUND: usize = 72;
/// The bow opens where its outline's middle is at least this far from its surface's, of its radius.
const OPEN_PART: f64 = 0.03;

/// The direction in which a femoral component opens, the normal of its distal cut, on the side to which the middle of its outline in
/// the side view lies from that of its surface.
fn opening(mesh: &Mesh<'_>, across: &Vector3) -> Option<Vector3> {
    let out = outwards(mesh, across)?;
    above_the_distal_cut(mesh, across, &out)
}

/// From the middle of the surface to that of the outline in the side view, mm; `None` where they are one.
fn outwards(mesh: &Mesh<'_>, across: &Vector3) -> Option<Vector3> {
    let first = super::perpendicular(across);
    let second = cross(across, &first);
    let mut outline = [0.0; 3];
    for step in 0..AROUND {
        let turn = core::f64::consts::TAU * step as f64 / AROUND as f64;
        let along = between(&first, &second, turn);
        let far = |a: &Vector3, b: &Vector3| dot(a, &along).total_cmp(&dot(b, &along));
        outline = add(&outline, &vertices(mesh).max_by(far)?);
    }
    let outline = scale(&outline, 1.0 / AROUND as f64);
    let (sum, area) = faces(mesh).fold(([0.0; 3], 0.0), |(sum, all), (middle, area, _)| {
        (add(&sum, &scale(&middle, area)), all + area)
    });
    let out = subtract(&outline, &scale(&sum, 1.0 / area));
    let out = subtract(&out, &scale(across, dot(&out, across)));
    (norm(&out) >= OPEN_PART * mesh.bounds().radius).then_some(out)
}

/// A tray's axis so directed that its plate, which faces along it, is above the middle; `None` where nothing hangs from it that tells.
fn above_the_keel(mesh: &Mesh<'_>, axis: &Vector3) -> Option<Vector3> {
    let (low, high) = reach(vertices(mesh), axis);
    let (sum, weight) = faces(mesh).fold((0.0, 0.0), |(sum, all), (middle, area, normal)| {
        let facing = if area > 0.0 {
            dot(&normal, axis) * dot(&normal, axis) / area
        } else {
            0.0
        };
        (sum + facing * dot(&middle, axis), all + facing)
    });
    let above = if weight > 0.0 {
        sum / weight - (low + high) / 2.0
    } else {
        0.0
    };
    let (up, is_known) = directed(axis, above, high - low);
    is_known.then_some(up)
}

/// Of two sides one is told from the other where they differ by more than this part of their size.
const TOLD_PART: f64 = 0.04;

/// The arms of a bow lie within this part of its depth from either end; what stands between them and reaches higher is a stem or a box.
const ARM_PART: f64 = 0.25;
/// A bow that is higher than so many times its depth has a stem, which may lean over an arm.
const TALL: f64 = 1.3;

/// The direction of the arm that reaches higher, and whether one does.
fn along_the_longer_arm(mesh: &Mesh<'_>, forward: &Vector3, up: &Vector3) -> (Vector3, bool) {
    let (back, front) = reach(vertices(mesh), forward);
    let (middle, depth) = ((back + front) / 2.0, front - back);
    let (low, high) = reach(vertices(mesh), up);
    let arms = |from: f64| {
        [1.0, -1.0].map(|sign| {
            let off = |v: &Vector3| sign * (dot(v, forward) - middle);
            reach(vertices(mesh).filter(|v| off(v) > from), up).1
        })
    };
    let [ahead, behind] = arms((0.5 - ARM_PART) * depth);
    let top = ahead.max(behind);
    if top < high {
        let is_tall = top - low > TALL * depth;
        let (forward, is_known) = directed(forward, ahead - behind, top - low);
        return (forward, is_known && !is_tall);
    }
    let [ahead, behind] = arms(0.0);
    let (forward, is_known) = directed(forward, ahead - behind, high - low);
    (forward, is_known && high - low <= TALL * depth)
}

/// Whether a bow is open in the middle of its width in front and not behind, as between condyles: its longer arm is no flange then.
fn is_notched_ahead(mesh: &Mesh<'_>, forward: &Vector3, across: &Vector3, up: &Vector3) -> bool {
    /// Of the width, to either side of its middle.
    const MIDDLE: f64 = 0.05;
    let (back, front) = reach(vertices(mesh), forward);
    let (left, right) = reach(vertices(mesh), across);
    let (low, high) = reach(vertices(mesh), up);
    let (middle, half) = ((left + right) / 2.0, MIDDLE * (right - left));
    let right_of = (*across, middle - half);
    let left_of = (scale(across, -1.0), -middle - half);
    let arm = |sign: f64| {
        let from = sign * (back + front) / 2.0 + (0.5 - ARM_PART) * (front - back);
        let halves = [(scale(forward, sign), from), right_of, left_of];
        reach_within(mesh, &halves, up).1
    };
    arm(-1.0) - arm(1.0) > TOLD_PART * (high - low)
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
    let opposite = scale(across, -1.0);
    let plate = (*up, high - PLATE * (high - low));
    let beyond = |part: f64| {
        [
            (*across, middle + part * width),
            (opposite, part * width - middle),
        ]
    };
    let [[one, other], [right_of, left_of]] = [beyond(LOBES), beyond(-NOTCH)];
    let lobes = [one, other].map(|lobe| reach_within(mesh, &[plate, lobe], forward));
    let lobes = (lobes[0].0.min(lobes[1].0), lobes[0].1.max(lobes[1].1));
    let notch = reach_within(mesh, &[plate, right_of, left_of], forward);
    let (behind, ahead) = (notch.0 - lobes.0, lobes.1 - notch.1);
    directed(forward, behind - ahead, front - back)
}

/// A direction, and how far along it a half of space begins, mm.
type HalfSpace = (Vector3, f64);

/// How far what of a surface lies within halves of space, three at most, reaches along an axis: of the surface, not of its vertices, which a
/// flat part has none of. A triangle that covers nothing is none of it, and may lie across a notch.
fn reach_within(mesh: &Mesh<'_>, halves: &[HalfSpace], axis: &Vector3) -> (f64, f64) {
    let corners = mesh.vertices();
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|vertex| corners[vertex as usize].map(f64::from));
        if cross(&subtract(&b, &a), &subtract(&c, &a)) == [0.0; 3] {
            continue;
        }
        let whole: Polygon = [a, b, c].into_iter().collect();
        let within = halves.iter().fold(whole, |part, half| clipped(&part, half));
        let (from, to) = reach(within.into_iter(), axis);
        (low, high) = (low.min(from), high.max(to));
    }
    (low, high)
}

/// A triangle of which up to three corners were cut off.
type Polygon = heapless::Vec<Vector3, 6>;

/// What of a convex polygon lies in a half of space.
fn clipped(polygon: &Polygon, (axis, least): &HalfSpace) -> Polygon {
    let mut kept = Polygon::new();
    let height = |point: &Vector3| dot(point, axis) - least;
    let next = polygon.iter().cycle().skip(1);
    for (point, next) in polygon.iter().zip(next) {
        let (here, there) = (height(point), height(next));
        // There is room: each half of space cuts off a corner at least for the two that it adds.
        if here >= 0.0 {
            let _ = kept.push(*point);
        }
        if (here < 0.0) != (there < 0.0) {
            let way = scale(&subtract(next, point), here / (here - there));
            let _ = kept.push(add(point, &way));
        }
    }
    kept
}

/// An axis in the direction of the sign of `difference`, and whether that is large enough to tell.
fn directed(axis: &Vector3, difference: f64, size: f64) -> (Vector3, bool) {
    let sign = if difference < 0.0 { -1.0 } else { 1.0 };
    (scale(axis, sign), difference.abs() > TOLD_PART * size)
}

#[cfg(test)]
mod tests;

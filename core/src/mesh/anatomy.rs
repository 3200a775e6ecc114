//! Which ways a component lies, found from its shape.
//!
//! CAD files have axes of any kind. A femoral component and a tray are nearly symmetric about the plane whose normal is
//! mediolateral, and most of a tray's surface is its plate, whose normal is superoinferior. [`field_axes`] tells that much
//! and no signs, for what does not depend on them; [`anatomical_axes`] tells which way is up and forwards too.

mod cuts;
mod faced;
#[cfg(test)]
mod fake;
mod kind;
mod signs;
mod words;

pub use kind::component_by_shape;
pub use signs::{AnatomicalAxes, anatomical_axes};
pub use words::AxesError;

use self::faced::most_faced;
use crate::math::eigen::eigen_symmetric;
use crate::math::{Matrix3, Vector3, cross, dot, norm, radians, scale, sin_cos, subtract};
use crate::mesh::surface::Mesh;
use crate::mesh::symmetry::SymmetryPlane;
use crate::pose::{Pose, geodesic_deg};

/// Most CAD axes are the anatomical ones in some order. What is found within this angle of one of the file's axes is taken
/// to be that axis, so that numbers agree with those of programs that take the file's axes as they are. Degrees.
pub const OWN_AXIS_DEG: f64 = 10.0;

/// The same across the knee, where shapes tell their axis to 3 degrees. Coronal tilt is taken along it, and by 2 degrees of that sides of the
/// mirror are chosen: with file axes that lay 9 degrees off all trays of a film were taken on the wrong side, and called good.
pub const OWN_ACROSS_DEG: f64 = 5.0;

/// Planes whose deviations differ by less than this factor are equally good, and the wider way across is mediolateral.
const AS_SYMMETRIC: f64 = 3.0;

/// The normal of the plane about which a component is most nearly symmetric, model coordinates; of planes about which it is
/// as symmetric that across which it is wider, as knees are. `planes` come from
/// [`crate::mesh::symmetry::symmetry_planes`]. `None` where there are none.
#[must_use]
pub fn mediolateral_axis(mesh: &Mesh<'_>, planes: &[SymmetryPlane]) -> Option<Vector3> {
    let alike = as_symmetric(mesh, planes);
    let widest = alike.max_by(|a, b| width(mesh, &a.normal).total_cmp(&width(mesh, &b.normal)));
    Some(upright(widest?.normal))
}

/// The planes about which a component is as nearly symmetric as about the best.
fn as_symmetric<'p>(
    mesh: &Mesh<'_>,
    planes: &'p [SymmetryPlane],
) -> impl Iterator<Item = &'p SymmetryPlane> {
    let best = planes.first().map_or(0.0, |plane| plane.deviation_mm);
    // A plane of a mesh that is symmetric by making deviates by rounding alone.
    let limit = AS_SYMMETRIC * best.max(1e-3 * mesh.bounds().radius);
    planes
        .iter()
        .filter(move |plane| plane.deviation_mm <= limit)
}

/// Across planes that are alike a component is told apart where it is narrower than this part of what it is across the widest.
const AS_WIDE: f64 = 0.9;

/// Whether a component is as symmetric about another plane than that across, and about as wide across it: where bows on long stems are as deep
/// as wide, that is the one from front to back.
fn is_as_wide_elsewhere(mesh: &Mesh<'_>, planes: &[SymmetryPlane], across: &Vector3) -> bool {
    let others =
        as_symmetric(mesh, planes).filter(|plane| dot(&plane.normal, across).abs() < ANOTHER);
    let least = AS_WIDE * width(mesh, across);
    let mut widths = others.map(|plane| width(mesh, &plane.normal));
    widths.any(|width| width > least)
}

/// Planes are two where their normals are 30 degrees apart: the cosine.
const ANOTHER: f64 = 0.866;

/// The normal of a tray's plate, perpendicular to `mediolateral`, model coordinates: the direction that most of its surface
/// faces, forwards or backwards, by area; a stem, which faces all round, does not turn it. `None` of a mesh without area.
#[must_use]
pub fn superoinferior_axis(mesh: &Mesh<'_>, mediolateral: &Vector3) -> Option<Vector3> {
    let mut tensor: Matrix3 = [[0.0; 3]; 3];
    let corner = |vertex: u32| mesh.vertices()[vertex as usize].map(f64::from);
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(corner);
        let doubled = cross(&subtract(&b, &a), &subtract(&c, &a));
        // The part that is not mediolateral.
        let across = scale(mediolateral, dot(&doubled, mediolateral));
        let normal = subtract(&doubled, &across);
        let area = norm(&doubled);
        if area > 0.0 {
            for (row, &x) in tensor.iter_mut().zip(&normal) {
                for (sum, &y) in row.iter_mut().zip(&normal) {
                    *sum += x * y / area;
                }
            }
        }
    }
    let ([largest, ..], [normal, ..]) = eigen_symmetric(&tensor);
    (largest > 0.0).then(|| upright(most_faced(mesh, mediolateral, normal)))
}

/// A component of a knee.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KneeComponent {
    /// The femoral component.
    Femur,
    /// The tray.
    Tibia,
}

/// The rotation from the field's axes (x anteroposterior, y superoinferior, z mediolateral) to the model's own, as far as the
/// shape tells them and without their signs; of a femoral component z alone, x and y being any that are perpendicular to it.
/// `pose.compose(&axes)` is then the pose of a model with the field's axes: what [`crate::finder::choice`] compares. The
/// identity for models that have these axes themselves; `None` where the shape has no plane of symmetry, and of a tray with the
/// proportions of one for a single condyle, whose plane is another.
#[must_use]
pub fn field_axes(
    mesh: &Mesh<'_>,
    planes: &[SymmetryPlane],
    component: KneeComponent,
) -> Option<Pose> {
    let z = mediolateral_axis(mesh, planes)?;
    let y = match component {
        KneeComponent::Tibia => superoinferior_axis(mesh, &z)?,
        KneeComponent::Femur => perpendicular(&z),
    };
    let x = cross(&y, &z);
    if component == KneeComponent::Tibia && is_of_one_condyle(mesh, &x, &z, component) {
        return None;
    }
    let found = Pose {
        rotation: core::array::from_fn(|row| [x[row], y[row], z[row]]),
        translation: [0.0; 3],
    };
    Some(own_axes(&found).unwrap_or(found))
}

/// Narrower than this part of its depth a femoral component is of one condyle: others are about as wide as deep.
const NARROW: f64 = 0.75;
/// A plate for one condyle is a D whose plane of symmetry is the wrong one. It is longer along its straight side, to these many times,
/// than a plate for both is wider than deep, and no longer than this, mm.
const SLENDER: f64 = 1.65;
const ONE_CONDYLE_MM: f64 = 62.0;

/// Whether a component has the proportions of one for a single condyle, whose axes its shape tells otherwise: the hinder arm of its bow is the
/// longer one, its bow opens forwards as well as upwards, and its plate is nearly symmetric from front to back.
fn is_of_one_condyle(
    mesh: &Mesh<'_>,
    forward: &Vector3,
    across: &Vector3,
    component: KneeComponent,
) -> bool {
    let [depth, width] = [forward, across].map(|axis| width(mesh, axis));
    match component {
        KneeComponent::Femur => width < NARROW * depth,
        KneeComponent::Tibia => width > SLENDER * depth && width < ONE_CONDYLE_MM,
    }
}

/// The file's own axes in the order and the directions that are nearest to those found, where all are within
/// [`OWN_AXIS_DEG`] of them, turned together, and that across the knee within [`OWN_ACROSS_DEG`].
fn own_axes(found: &Pose) -> Option<Pose> {
    let mut own = [[0.0; 3]; 3];
    for (own, row) in own.iter_mut().zip(&found.rotation) {
        let at = (0..3).max_by(|&a, &b| row[a].abs().total_cmp(&row[b].abs()))?;
        own[at] = if row[at] < 0.0 { -1.0 } else { 1.0 };
    }
    let own = Pose {
        rotation: own,
        ..*found
    };
    let near = own.is_rigid(1e-9) && geodesic_deg(&own.rotation, &found.rotation) < OWN_AXIS_DEG;
    let [own_across, across] = [&own, found].map(|pose| pose.rotation.map(|row| row[2]));
    let is_across = dot(&own_across, &across) > sin_cos(radians(OWN_ACROSS_DEG)).1;
    (near && is_across).then_some(own)
}

/// The file's y axis, or where that is too near to `axis` its x axis, made perpendicular to it.
fn perpendicular(axis: &Vector3) -> Vector3 {
    let own = if axis[1].abs() < 0.7 {
        [0.0, 1.0, 0.0]
    } else {
        [1.0, 0.0, 0.0]
    };
    let across = subtract(&own, &scale(axis, dot(&own, axis)));
    scale(&across, 1.0 / norm(&across))
}

/// How wide a mesh is along an axis, mm.
fn width(mesh: &Mesh<'_>, axis: &Vector3) -> f64 {
    let (low, high) = reach(mesh, axis);
    high - low
}

/// From where to where a mesh reaches along an axis, mm.
pub(crate) fn reach(mesh: &Mesh<'_>, axis: &Vector3) -> (f64, f64) {
    let along = mesh.vertices().iter().map(|v| dot(&v.map(f64::from), axis));
    along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    })
}

/// The axis or its opposite, so that its largest component is positive.
fn upright(axis: Vector3) -> Vector3 {
    let largest = axis.iter().fold(
        0.0f64,
        |most, x| if x.abs() > most.abs() { *x } else { most },
    );
    scale(&axis, if largest < 0.0 { -1.0 } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::edges::fake::add_box;
    use crate::mesh::symmetry::symmetry_planes;
    use crate::pose::{EulerPose, Pose};
    use proptest::prelude::*;
    use std::vec::Vec;

    /// A plate 50 x 4 x 76 mm (x anterior, y up, z lateral) with a notch behind and a keel.
    fn tray() -> (Vec<Vector3>, Vec<[u32; 3]>) {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for (low, high) in [
            ([-20.0, 0.0, -38.0], [25.0, 4.0, 38.0]),
            ([-25.0, 0.0, 12.0], [-20.0, 4.0, 38.0]),
            ([-25.0, 0.0, -38.0], [-20.0, 4.0, -12.0]),
            ([-8.0, -40.0, -5.0], [6.0, 0.0, 5.0]),
        ] {
            add_box(low, high, &mut vertices, &mut triangles);
        }
        let vertices = vertices.iter().map(|vertex| vertex.map(f64::from));
        (vertices.collect(), triangles)
    }

    properties! {
        #[test]
        fn the_axes_of_a_tray_move_with_it(
            angles in proptest::array::uniform3(-180.0..180.0f64),
            place in proptest::array::uniform3(-80.0..80.0f64),
        ) {
            let [z_rot_deg, x_rot_deg, y_rot_deg] = angles;
            let [x_mm, y_mm, z_mm] = place;
            let pose = Pose::from(EulerPose { x_mm, y_mm, z_mm, z_rot_deg, x_rot_deg, y_rot_deg });
            let (vertices, triangles) = tray();
            let vertices: Vec<[f32; 3]> =
                vertices.iter().map(|v| pose.transform(v).map(|x| x as f32)).collect();
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            let axes = field_axes(&mesh, &symmetry_planes(&mesh), KneeComponent::Tibia);
            let axes = axes.expect("a plane and a plate");
            // Axes near the file's own are taken to be those.
            let cosine = |k: usize| {
                let column = |pose: &Pose| pose.rotation.map(|row| row[k]);
                dot(&column(&axes), &column(&pose)).abs()
            };
            let least = |deg: f64| (deg + 0.5).to_radians().cos();
            prop_assert!((0..3).all(|k| cosine(k) > least(OWN_AXIS_DEG)), "{:?}", axes);
            prop_assert!(cosine(2) > least(OWN_ACROSS_DEG), "{:?}", axes);
        }
    }

    properties! {
        /// Oracle: angles of the turn and of the axis across, by which the file's axes in some order were turned.
        #[test]
        fn axes_near_the_files_own_are_those(
            turn in proptest::array::uniform3(-8.0..8.0f64), order in 0..3usize, signs in proptest::array::uniform2(prop_oneof![Just(-1.0), Just(1.0)]),
            swapped in any::<bool>(),
        ) {
            let axis = |k: usize| crate::math::IDENTITY[(k + order) % 3];
            let (first, second) = if swapped { (axis(1), axis(0)) } else { (axis(0), axis(1)) };
            let (x, y) = (scale(&first, signs[0]), scale(&second, signs[1]));
            let z = cross(&x, &y);
            let own: Matrix3 = core::array::from_fn(|row| [x[row], y[row], z[row]]);
            let turned = crate::math::multiply(&crate::math::rotation_by(&turn.map(radians)), &own);
            let found = Pose { rotation: turned, translation: [0.0; 3] };
            let turn_deg = norm(&turn);
            let across = turned.map(|row| row[2]);
            let across_deg = crate::math::degrees(crate::math::atan2(norm(&cross(&across, &z)), dot(&across, &z)));
            let is_near = turn_deg < OWN_AXIS_DEG && across_deg < OWN_ACROSS_DEG;
            prop_assert_eq!(own_axes(&found).map(|pose| pose.rotation), is_near.then_some(own));
        }

        #[test]
        fn what_is_perpendicular_to_an_axis_is_of_length_one(axis in proptest::array::uniform3(-1.0..1.0f64)) {
            prop_assume!(norm(&axis) > 0.1);
            let axis = scale(&axis, 1.0 / norm(&axis));
            let found = perpendicular(&axis);
            prop_assert!((norm(&found) - 1.0).abs() < 1e-9 && dot(&found, &axis).abs() < 1e-9);
            // An axis and its opposite are one, told by its largest component.
            let most = axis.iter().fold(0.0f64, |most, x| most.max(x.abs()));
            prop_assert!(upright(axis).contains(&most));
            prop_assert_eq!(upright(scale(&axis, -1.0)), upright(axis));
        }

        /// In whichever order planes are told, and however they are directed.
        #[test]
        fn across_is_the_wider_way_of_planes_that_are_alike(
            sides in proptest::array::uniform3(20.0..60.0f32), deviations in proptest::array::uniform3(prop_oneof![Just(0.0), 0.0..3.0f64]),
        ) {
            let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
            add_box([0.0; 3], sides, &mut vertices, &mut triangles);
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            let mut planes: Vec<SymmetryPlane> = (0..3)
                .map(|k| SymmetryPlane { point: [0.0; 3], normal: scale(&crate::math::IDENTITY[k], -1.0), deviation_mm: deviations[k] })
                .collect();
            planes.sort_by(|a, b| a.deviation_mm.total_cmp(&b.deviation_mm));
            let limit = 3.0 * planes[0].deviation_mm.max(1e-3 * mesh.bounds().radius);
            let alike = (0..3).filter(|&k| deviations[k] <= limit);
            let widest = alike.max_by(|&a, &b| sides[a].total_cmp(&sides[b])).expect("the best");
            prop_assert_eq!(mediolateral_axis(&mesh, &planes), Some(crate::math::IDENTITY[widest]));
            prop_assert_eq!(reach(&mesh, &crate::math::IDENTITY[widest]), (0.0, f64::from(sides[widest])));
            prop_assert_eq!(mediolateral_axis(&mesh, &[]), None);
        }
    }

    /// Across planes that differ, and about which it is as symmetric.
    #[test]
    fn where_a_part_is_as_wide_both_ways_across_is_one_of_two() {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        add_box([0.0; 3], [60.0, 99.0, 66.0], &mut vertices, &mut triangles);
        let mesh = Mesh::new(&vertices, &triangles).expect("valid");
        let plane = |normal: Vector3, deviation_mm: f64| SymmetryPlane {
            point: [0.0; 3],
            normal,
            deviation_mm,
        };
        let [x, _, z] = crate::math::IDENTITY;
        let best = plane(z, 0.1);
        let oblique = plane([0.3, 0.0, 0.95], 0.1);
        let told = |other: SymmetryPlane| is_as_wide_elsewhere(&mesh, &[best, other], &z);
        assert!(told(plane(x, 0.2)));
        assert!(!told(plane(x, 0.7)));
        assert!(!told(oblique));
        let narrow: Vec<_> = vertices.iter().map(|&[x, y, z]| [0.95 * x, y, z]).collect();
        let mesh = Mesh::new(&narrow, &triangles).expect("valid");
        assert!(!is_as_wide_elsewhere(&mesh, &[best, plane(x, 0.2)], &z));
    }

    /// Along x and z.
    #[test]
    fn a_component_has_the_proportions_of_one_condyle_below_a_width_of_its_depth() {
        let is = |depth: f32, width: f32, component| {
            let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
            add_box(
                [5.0, 0.0, 9.0],
                [5.0 + depth, 4.0, 9.0 + width],
                &mut vertices,
                &mut triangles,
            );
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            is_of_one_condyle(&mesh, &[1.0, 0.0, 0.0], &[0.0, 0.0, 1.0], component)
        };
        for (depth, width, narrow) in [(60.0, 44.9, true), (60.0, 45.1, false), (20.0, 60.0, false)]
        {
            assert_eq!(
                is(depth, width, KneeComponent::Femur),
                narrow,
                "{depth} x {width}"
            );
        }
        for (depth, width, slender) in [
            (30.0, 49.4, false),
            (30.0, 49.6, true),
            (30.0, 61.9, true),
            (30.0, 62.1, false),
            (60.0, 40.0, false),
        ] {
            assert_eq!(
                is(depth, width, KneeComponent::Tibia),
                slender,
                "{depth} x {width}"
            );
        }
    }

    /// Coronal tilt would be 8 degrees off, and choose sides of the mirror by that.
    #[test]
    fn a_file_that_leans_to_one_side_has_the_axes_of_its_shape() {
        let lean = Pose::from(EulerPose {
            x_rot_deg: 8.0,
            ..EulerPose::default()
        });
        let (vertices, triangles) = tray();
        let vertices: Vec<[f32; 3]> = vertices
            .iter()
            .map(|vertex| lean.transform(vertex).map(|x| x as f32))
            .collect();
        let mesh = Mesh::new(&vertices, &triangles).expect("valid");
        let axes = field_axes(&mesh, &symmetry_planes(&mesh), KneeComponent::Tibia);
        let axes = axes.expect("a plane and a plate");
        assert!(
            geodesic_deg(&axes.rotation, &lean.rotation) < 0.5,
            "{axes:?}"
        );
    }

    #[test]
    fn in_the_files_own_axes_they_are_exact() {
        let (vertices, triangles) = tray();
        for turn in 0..3 {
            let vertices: Vec<[f32; 3]> = vertices
                .iter()
                .map(|v| core::array::from_fn(|k| v[(k + turn) % 3] as f32))
                .collect();
            let mesh = Mesh::new(&vertices, &triangles).expect("valid");
            let unit =
                |at: usize| core::array::from_fn(|k| f64::from(u8::from((k + turn) % 3 == at)));
            let planes = symmetry_planes(&mesh);
            let axes = field_axes(&mesh, &planes, KneeComponent::Tibia).expect("axes");
            assert!(axes.is_rigid(1e-12) && (turn > 0 || axes == Pose::IDENTITY));
            let column = |k: usize| axes.rotation.map(|row| row[k]);
            assert_eq!((column(2), column(1)), (unit(2), unit(1)), "{turn}");
            let femur = field_axes(&mesh, &planes, KneeComponent::Femur).expect("axes");
            assert!(femur.is_rigid(1e-12) && (turn > 0 || femur == Pose::IDENTITY));
        }
    }
}

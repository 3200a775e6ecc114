//! Signs of axes, of parts that lie anywhere and whose axes are given with either sign.

use super::*;
use crate::math::apply;
use crate::mesh::anatomy::fake::{Design, Parts, designs};
use crate::mesh::anatomy::{OWN_AXIS_DEG, component_by_shape, field_axes};
use crate::mesh::edges::fake::{add_box, add_prism, ellipse, placed_within};
use crate::mesh::symmetry::symmetry_planes;
use crate::pose::{EulerPose, geodesic_deg};
use proptest::prelude::*;
use std::vec::Vec;

type Box3 = ([f32; 3], [f32; 3]);

/// Boxes in the field's axes: x anterior, y superior, z to the patient's right.
struct Part {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Part {
    fn of(boxes: &[Box3]) -> Self {
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        for &(low, high) in boxes {
            add_box(low, high, &mut vertices, &mut triangles);
        }
        Self {
            vertices,
            triangles,
        }
    }

    fn with(mut self, outline: &[[f32; 2]], heights: [f32; 2]) -> Self {
        add_prism(outline, heights, &mut self.vertices, &mut self.triangles);
        self
    }

    fn axes(&self, component: KneeComponent) -> Option<AnatomicalAxes> {
        let mesh = self.mesh();
        anatomical_axes(&mesh, &symmetry_planes(&mesh), component)
    }

    fn at(mut self, pose: &Pose) -> Self {
        for vertex in &mut self.vertices {
            *vertex = pose.transform(&vertex.map(f64::from)).map(|x| x as f32);
        }
        self
    }

    fn mesh(&self) -> Mesh<'_> {
        Mesh::new(&self.vertices, &self.triangles).expect("valid")
    }
}

/// A plate on a keel, of which a part behind is missing where it is notched.
fn tray(notch: f32) -> Part {
    Part::of(&[
        ([-20.0, 0.0, -38.0], [25.0, 4.0, 38.0]),
        ([-20.0 - notch, 0.0, 12.0], [-20.0, 4.0, 38.0]),
        ([-20.0 - notch, 0.0, -38.0], [-20.0, 4.0, -12.0]),
        ([-8.0, -40.0, -5.0], [6.0, 0.0, 5.0]),
    ])
}

/// A bow that opens upwards between a hinder arm of 40 mm and one of so many in front.
fn bow(front: f32) -> Part {
    Part::of(&[
        ([-20.0, 0.0, -30.0], [20.0, 6.0, 30.0]),
        ([14.0, 0.0, -30.0], [20.0, front, 30.0]),
        ([-20.0, 0.0, -30.0], [-14.0, 40.0, 30.0]),
    ])
}

/// A plate with a straight front, of whose vertices none lies in the middle but those of the notch behind.
const STRAIGHT_FRONT: [[f32; 2]; 12] = [
    [-14.0, 6.0],
    [-14.0, -6.0],
    [-25.0, -10.0],
    [-25.0, -30.0],
    [-15.0, -38.0],
    [15.0, -38.0],
    [25.0, -14.0],
    [25.0, 14.0],
    [15.0, 38.0],
    [-15.0, 38.0],
    [-25.0, 30.0],
    [-25.0, 10.0],
];

/// A tray for both condyles, 42 x 62 mm, without a notch.
fn oval() -> Part {
    Part::of(&[]).with(&ellipse([0.0; 2], [21.0, 31.0]), [0.0, 4.0])
}

/// A bow of one condyle, 20 mm wide, whose arm behind is the longer one.
fn narrow_bow() -> Part {
    Part::of(&[
        ([-24.0, 0.0, -10.0], [20.0, 6.0, 10.0]),
        ([-24.0, 0.0, -10.0], [-18.0, 26.0, 10.0]),
        ([14.0, 0.0, -10.0], [20.0, 12.0, 10.0]),
    ])
}

/// A plate for the lateral condyle, 48 mm deep and 27 mm wide: a D on a keel.
fn plate_of_one_condyle() -> Part {
    let arc = ellipse([0.0, -13.0], [24.0, 27.0]);
    let border: Vec<[f32; 2]> = arc.into_iter().filter(|at| at[1] > -13.1).collect();
    let keel = [[-12.0, -2.0], [12.0, -2.0], [12.0, 1.0], [-12.0, 1.0]];
    Part::of(&[])
        .with(&border, [0.0, 3.0])
        .with(&keel, [-9.0, 0.0])
}

/// Anterior, superior and right of a part at a pose.
fn axes(pose: &Pose) -> [Vector3; 3] {
    crate::math::IDENTITY.map(|axis| apply(&pose.rotation, &axis))
}

fn off(a: &Vector3, b: &Vector3) -> f64 {
    norm(&subtract(a, b))
}

properties! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_plate_is_above_its_keel_whichever_way_the_axis_is_given(pose in placed_within(80.0)) {
        let part = tray(5.0).at(&pose);
        let [_, up, _] = axes(&pose);
        for sign in [-1.0, 1.0] {
            let found = above_the_keel(&part.mesh(), &scale(&up, sign));
            prop_assert!(found.is_some_and(|found| off(&found, &up) < 1e-9));
        }
    }

    #[test]
    fn the_front_of_a_tray_is_away_from_its_notch(
        pose in placed_within(80.0), sign in prop_oneof![Just(-1.0), Just(1.0)], swapped in any::<bool>()
    ) {
        let [front, up, right] = axes(&pose);
        let across = scale(&right, if swapped { -1.0 } else { 1.0 });
        let (given, part) = (scale(&front, sign), tray(5.0).at(&pose));
        let (found, known) = away_from_the_notch(&part.mesh(), &given, &across, &up);
        prop_assert!(known && off(&found, &front) < 1e-9);
        // Of a tray 46 mm deep a notch of a twenty-fifth of that tells.
        for (notch, told) in [(0.0, false), (1.8, false), (2.0, true)] {
            let part = tray(notch).at(&pose);
            let (_, known) = away_from_the_notch(&part.mesh(), &given, &across, &up);
            prop_assert_eq!(known, told, "{}", notch);
        }
    }

    #[test]
    fn the_front_of_a_bow_is_its_longer_arm(pose in placed_within(80.0), sign in prop_oneof![Just(-1.0), Just(1.0)]) {
        let [front, up, _] = axes(&pose);
        let given = scale(&front, sign);
        // A twenty-fifth of its height tells.
        for (arm, told) in [(30.0, true), (38.3, true), (38.5, false), (41.5, false), (41.8, true), (50.0, true)] {
            let part = bow(arm).at(&pose);
            let (found, known) = along_the_longer_arm(&part.mesh(), &given, &up);
            prop_assert_eq!(known, told, "{}", arm);
            let expected = scale(&front, if arm < 40.0 { -1.0 } else { 1.0 });
            prop_assert!(off(&found, &expected) < 1e-9, "{}", arm);
        }
    }

    #[test]
    fn the_front_of_a_tray_is_where_its_surface_reaches_and_not_where_it_has_vertices(pose in placed_within(80.0)) {
        let [front, up, right] = axes(&pose);
        let part = Part::of(&[]).with(&STRAIGHT_FRONT, [0.0, 4.0]);
        let part = part.with(&ellipse([0.0; 2], [7.0; 2]), [-20.0, 0.0]).at(&pose);
        for sign in [-1.0, 1.0] {
            let (found, known) = away_from_the_notch(&part.mesh(), &scale(&front, sign), &right, &up);
            prop_assert!(known && off(&found, &front) < 1e-9);
        }
    }

    /// What hangs from a plate is neither a lobe nor in the notch, wherever it reaches, and what stands on it by a little leaves it the plate.
    #[test]
    fn the_front_of_a_tray_is_told_by_its_plate_alone(
        pose in placed_within(80.0), side in -30.0..30.0f32, from in -34.0..20.0f32, sign in prop_oneof![Just(-1.0), Just(1.0)],
    ) {
        let [front, up, right] = axes(&pose);
        let keel = ([from, -40.0, side - 5.0], [from + 20.0, -3.0, side + 5.0]);
        let mut part = tray(5.0);
        add_box(keel.0, keel.1, &mut part.vertices, &mut part.triangles);
        let rib = ([-5.0, 4.0, side - 1.0], [5.0, 5.0, side + 1.0]);
        add_box(rib.0, rib.1, &mut part.vertices, &mut part.triangles);
        let part = part.at(&pose);
        let (found, known) = away_from_the_notch(&part.mesh(), &scale(&front, sign), &right, &up);
        prop_assert!(known && off(&found, &front) < 1e-9);
    }

    /// Both parts of a polygon make it up, and lie on their sides.
    #[test]
    fn what_is_cut_off_is_what_is_left_out(
        vertices in proptest::array::uniform3(proptest::array::uniform3(-9.0..9.0f32)),
        halves in proptest::array::uniform3((proptest::array::uniform3(-1.0..1.0f64), -6.0..6.0f64)),
    ) {
        let area = |polygon: &Polygon| {
            let fan = polygon.windows(2).skip(1);
            let sum = fan.fold([0.0; 3], |sum, two| {
                add(&sum, &cross(&subtract(&two[0], &polygon[0]), &subtract(&two[1], &polygon[0])))
            });
            norm(&sum)
        };
        let [a, b, c] = vertices.map(|corner| corner.map(f64::from));
        let mut whole: Polygon = [a, b, c].into_iter().collect();
        for (axis, least) in halves {
            let own = clipped(&whole, &(axis, least));
            let other = clipped(&whole, &(scale(&axis, -1.0), -least));
            prop_assert!((area(&own) + area(&other) - area(&whole)).abs() < 1e-9);
            prop_assert!(own.iter().all(|point| dot(point, &axis) >= least - 1e-9));
            prop_assert!(other.iter().all(|point| dot(point, &axis) <= least + 1e-9));
            whole = own;
        }
        // How far it reaches along an axis, by all pieces of the triangle that lie within.
        let mesh = Mesh::new(&vertices, &[[0, 1, 2]]).expect("valid");
        let along = [0.6, 0.0, 0.8];
        let (low, high) = reach_within(&mesh, &halves, &along);
        for (s, t) in (0..=30).flat_map(|s| (0..=30 - s).map(move |t| (f64::from(s) / 30.0, f64::from(t) / 30.0))) {
            let point: Vector3 = core::array::from_fn(|k| a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]));
            let is_within = halves.iter().all(|(axis, least)| dot(&point, axis) >= *least);
            prop_assert!(!is_within || (low - 1e-9..=high + 1e-9).contains(&dot(&point, &along)));
        }
        let ends = whole.iter().map(|point| dot(point, &along));
        let (least, most) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        prop_assert!(whole.is_empty() || ((low - least).abs() < 1e-9 && (high - most).abs() < 1e-9));
    }

    /// Whichever arm it stands nearer to. One that leans over an arm hides it.
    #[test]
    fn a_stem_is_no_arm(pose in placed_within(80.0), at in -7.0..7.0f32, height in 52.0..200.0f32) {
        let [front, up, _] = axes(&pose);
        let stemmed = |at: f32| {
            let stem = ellipse([at, 0.0], [3.0; 2]);
            bow(46.0).with(&stem, [6.0, height]).at(&pose)
        };
        for sign in [-1.0, 1.0] {
            let given = scale(&front, sign);
            let (found, known) = along_the_longer_arm(&stemmed(at).mesh(), &given, &up);
            prop_assert!(known && off(&found, &front) < 1e-9);
            let (_, known) = along_the_longer_arm(&stemmed(-17.0).mesh(), &given, &up);
            prop_assert!(!known);
            // Arms of a bow that is so much higher than deep may be parts of a stem too.
            let tall = bow(60.0).with(&ellipse([0.0; 2], [3.0; 2]), [6.0, 80.0]).at(&pose);
            let (_, known) = along_the_longer_arm(&tall.mesh(), &given, &up);
            prop_assert!(!known);
        }
    }

    /// More of its surface faces forwards or backwards, but none of it one way.
    #[test]
    fn a_long_stem_and_a_keel_do_not_turn_a_tray(
        pose in placed_within(80.0), radius in 6.0..9.0f32, length in 60.0..200.0f32, leans in 0.0..6.0f64
    ) {
        let [_, up, across] = axes(&pose);
        let keel = [[0.0, -18.0], [0.0, 18.0], [-3.0, 18.0], [-3.0, -18.0]];
        let lean = Pose::from(EulerPose { z_rot_deg: leans, ..EulerPose::default() });
        let below = Part::of(&[]).with(&keel, [-25.0, 0.0]);
        let below = below.with(&ellipse([-2.0, 0.0], [radius; 2]), [-length, 0.0]).at(&lean);
        let mut part = oval();
        let first = part.vertices.len() as u32;
        part.vertices.extend(below.vertices);
        part.triangles.extend(below.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        let part = part.at(&pose);
        let axis = superoinferior_axis(&part.mesh(), &across).expect("a plate");
        prop_assert!(dot(&axis, &up).abs() > 0.99, "{:?}", axis);
        let axes = part.axes(KneeComponent::Tibia).expect("a plate on a keel");
        let found = axes.model_from_field.rotation.map(|row| row[1]);
        prop_assert!(dot(&found, &up) > 0.95, "{:?}", axes);
    }

    /// Along the cut that faces that way, so that the longer arm does not turn it; in metres as in millimetres.
    #[test]
    fn a_bow_opens_upwards_whichever_way_across_is_given(
        pose in placed_within(80.0), sign in prop_oneof![Just(-1.0), Just(1.0)], arm in 30.0..50.0f32, size in prop_oneof![Just(1.0f32), Just(1e-3)]
    ) {
        let [_, up, right] = axes(&pose);
        let mut part = bow(arm).at(&pose);
        part.vertices.iter_mut().flatten().for_each(|x| *x *= size);
        let found = opening(&part.mesh(), &scale(&right, sign));
        prop_assert!(found.is_some_and(|found| off(&found, &up) < 1e-4), "{:?}", found);
        let closed = Part::of(&[([-20.0, 0.0, -30.0], [20.0, 40.0, 30.0])]).at(&pose);
        prop_assert_eq!(opening(&closed.mesh(), &right), None);
    }
}

/// A design as a file may hold it: turned, of a right or a left knee, in metres, and with its triangles either way round.
fn filed(design: &Design, pose: &Pose, [is_left, is_turned]: [bool; 2], size: f32) -> Part {
    let Parts {
        mut vertices,
        mut triangles,
    } = design.parts();
    if is_left {
        vertices
            .iter_mut()
            .for_each(|vertex| vertex[2] = -vertex[2]);
    }
    if is_turned {
        triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    }
    let mut part = Part {
        vertices,
        triangles,
    }
    .at(pose);
    part.vertices.iter_mut().flatten().for_each(|x| *x *= size);
    part
}

/// How far the told axes are off those of a pose, degrees. Those near the file's own are those, so that it is asked of the shape's.
fn off_deg(found: &AnatomicalAxes, pose: &Pose) -> f64 {
    geodesic_deg(&found.model_from_field.rotation, &pose.rotation)
}

properties! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// With a box and without one, when a chamfer lies as near as the distal cut to where the bow opens as its surface is spread.
    #[test]
    fn components_for_both_condyles_tell_their_axes(
        design in designs(), pose in placed_within(80.0), kind in any::<[bool; 2]>(), size in prop_oneof![Just(1.0f32), Just(1e-3)],
    ) {
        let part = filed(&design, &pose, kind, size);
        let found = part.axes(KneeComponent::Femur);
        prop_assert!(found.is_some_and(|found| found.front_is_known), "{:?}", found);
        let off = found.map(|found| off_deg(&found, &pose));
        let limit = if found.is_some_and(|found| found.are_files_own) { OWN_AXIS_DEG + 3.0 } else { 3.0 };
        prop_assert!(off < Some(limit), "{:?}", off);
    }

    /// Where a design is no usual one, axes are right or are not told.
    #[test]
    fn of_uncommon_components_axes_are_right_or_not_told(
        design in designs(), radius in 30.0..60.0f64, flange in 30.0..60.0f64, gap in 12.0..26.0f64, stem in prop_oneof![Just(0.0), 20.0..140.0f64],
        pose in placed_within(80.0), kind in any::<[bool; 2]>(),
    ) {
        let radii = [design.radii[0], radius, design.radii[2]];
        let design = Design { radii, flange, gap, stem, ..design };
        let part = filed(&design, &pose, kind, 1.0);
        if let Some(found) = part.axes(KneeComponent::Femur) {
            let about = Pose::from(EulerPose { y_rot_deg: 180.0, ..EulerPose::default() });
            let off = off_deg(&found, &pose);
            let turned = off_deg(&found, &pose.compose(&about));
            let off = if found.front_is_known { off } else { off.min(turned) };
            let limit = if found.are_files_own { OWN_AXIS_DEG + 5.0 } else { 5.0 };
            prop_assert!(off < limit, "{}: {:?}", off, found);
        }
    }
}

properties! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// A line is none of the surface, though it lie across a notch: remarks say so.
    #[test]
    fn triangles_without_area_change_nothing(
        pose in placed_within(80.0), lines in proptest::collection::vec(0..23u32, 1..4),
    ) {
        for (part, component) in [(tray(5.0), KneeComponent::Tibia), (bow(50.0), KneeComponent::Femur)] {
            let part = part.at(&pose);
            let alone = part.mesh();
            let mut with_lines = part.triangles.clone();
            with_lines.extend(lines.iter().map(|&corner| [corner, corner, corner + 1]));
            let mesh = Mesh::new(&part.vertices, &with_lines).expect("valid");
            let planes = symmetry_planes(&alone);
            let axes = anatomical_axes(&alone, &planes, component);
            prop_assert!(axes.is_some());
            prop_assert_eq!(anatomical_axes(&mesh, &planes, component), axes);
            prop_assert_eq!(field_axes(&mesh, &planes, component), field_axes(&alone, &planes, component));
            prop_assert_eq!(component_by_shape(&mesh), component_by_shape(&alone));
        }
    }
}

#[test]
fn a_plate_on_nothing_has_no_up() {
    assert_eq!(oval().axes(KneeComponent::Tibia), None);
    let with_keel = oval().with(&ellipse([0.0; 2], [6.0; 2]), [-8.0, 0.0]);
    assert!(with_keel.axes(KneeComponent::Tibia).is_some());
}

/// Their planes of symmetry and longer arms are others than those of components for both condyles.
#[test]
fn components_for_one_condyle_do_not_tell_their_axes() {
    let (bow, plate) = (narrow_bow(), plate_of_one_condyle());
    assert_eq!(bow.axes(KneeComponent::Femur), None);
    assert_eq!(plate.axes(KneeComponent::Tibia), None);
    let directions = |part: &Part, component| {
        let mesh = part.mesh();
        field_axes(&mesh, &symmetry_planes(&mesh), component)
    };
    assert_eq!(directions(&plate, KneeComponent::Tibia), None);
    // Across the knee is right of a bow, and that is all that they say.
    assert!(directions(&bow, KneeComponent::Femur).is_some());
}

/// A bow that reaches higher in front, but between whose arms there it is open, is the other way round, or no bow.
#[test]
fn a_front_that_is_notched_is_not_told() {
    let halves = |from: f32, to: f32, top: f32| {
        [(-30.0, -8.0), (8.0, 30.0)].map(|(left, right)| ([from, 0.0, left], [to, top, right]))
    };
    let floor = ([-20.0, 0.0, -30.0], [20.0, 6.0, 30.0]);
    let solid = |from: f32, to: f32, top: f32| ([from, 0.0, -30.0], [to, top, 30.0]);
    let [one, other] = halves(-20.0, -14.0, 40.0);
    let usual = Part::of(&[floor, one, other, solid(14.0, 20.0, 46.0)]);
    let [one, other] = halves(14.0, 20.0, 46.0);
    let notched = Part::of(&[floor, one, other, solid(-20.0, -14.0, 40.0)]);
    for (part, told) in [(usual, true), (notched, false)] {
        let axes = part.axes(KneeComponent::Femur).expect("a bow");
        let front = axes.model_from_field.rotation.map(|row| row[0]);
        assert_eq!((front, axes.front_is_known), ([1.0, 0.0, 0.0], told));
    }
}

#[test]
fn what_is_square_to_an_axis_is_of_length_one_and_nothing_of_the_axis_itself() {
    let axis = [0.6, 0.8, 0.0];
    let square = square_to(&[1.0, 0.0, 0.0], &axis).expect("there is one");
    assert!(off(&square, &[0.8, -0.6, 0.0]) < 1e-12);
    assert_eq!(square_to(&axis, &axis), None);
}

#[test]
fn a_difference_tells_a_direction_by_its_sign_and_beyond_a_twenty_fifth_of_the_size() {
    let axis = [0.0, 1.0, 0.0];
    for (difference, known) in [(0.0, false), (3.9, false), (4.1, true)] {
        assert_eq!(directed(&axis, difference, 100.0), (axis, known));
    }
    assert_eq!(directed(&axis, -3.9, 100.0), ([0.0, -1.0, 0.0], false));
    assert_eq!(directed(&axis, -4.1, 100.0), ([0.0, -1.0, 0.0], true));
}

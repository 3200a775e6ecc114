//! Signs of axes, of parts that lie anywhere and whose axes are given with either sign.

use super::*;
use crate::math::apply;
use crate::mesh::edges::fake::{add_box, placed_within};
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
        // What the notch is measured at lies in the middle.
        ([-20.0, 0.0, -3.0], [25.0, 4.0, 3.0]),
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
            prop_assert!(off(&found, &up) < 1e-9);
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

    /// Along the cut that faces that way, so that the longer arm does not turn it.
    #[test]
    fn a_bow_opens_upwards_whichever_way_across_is_given(
        pose in placed_within(80.0), sign in prop_oneof![Just(-1.0), Just(1.0)], arm in 30.0..50.0f32
    ) {
        let [_, up, right] = axes(&pose);
        let part = bow(arm).at(&pose);
        let found = opening(&part.mesh(), &scale(&right, sign));
        prop_assert!(found.is_some_and(|found| off(&found, &up) < 1e-4), "{:?}", found);
        let closed = Part::of(&[([-20.0, 0.0, -30.0], [20.0, 40.0, 30.0])]).at(&pose);
        prop_assert_eq!(opening(&closed.mesh(), &right), None);
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

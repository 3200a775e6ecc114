use super::*;
use crate::joint::fake::{ACROSS, RADIUS, femur, pose, tray};
use crate::joint::kinematics::{Side, joint_axes};
use crate::math::{radians, sin_cos};
use proptest::prelude::*;

fn all(above: &Above<'_>) -> core::ops::Range<u32> {
    0..above.memory_needed() as u32
}

/// Balls keep their lowest points under their middles, however the femur is turned.
fn check(side: Side, tibia_from_femur: &Pose) {
    let (parts, tray) = (femur(), tray());
    let axes = joint_axes(&Pose::IDENTITY, side);
    let plate = Plate::of(&tray.mesh(), &axes, side).expect("a plate");
    let above = Above::new(parts.mesh(), &axes, plate);
    let found = above.lowest_points(tibia_from_femur, all(&above));
    for (point, toward) in [(found.medial, 1.0), (found.lateral, -1.0)] {
        // In joint axes: z is medial, x anterior in a left knee; the file's axes are the anatomical ones of either side.
        let middle = [side.forward() * 2.0, -1.0, toward * ACROSS];
        let [x, y, z] = tibia_from_femur.transform(&middle);
        assert!(
            (point.anterior_mm - side.forward() * x).abs() < 0.12,
            "{point:?}"
        );
        assert!((point.medial_mm - z).abs() < 0.12, "{point:?} {z}");
        // A ball of 48 rings is 0.05 mm flatter between its vertices.
        assert!(
            (point.height_mm - (y - RADIUS - 4.0)).abs() < 0.06,
            "{point:?}"
        );
    }
}

properties! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn balls_are_lowest_under_their_middles(
        flexion in -120.0..10.0f64, tilt in -8.0..8.0f64, turn in -15.0..15.0f64,
        place in proptest::array::uniform3(-10.0..10.0f64), left in any::<bool>(),
    ) {
        let side = if left { Side::Left } else { Side::Right };
        let pose = pose([place[0], 30.0 + place[1], place[2]], [flexion, tilt, turn]);
        check(side, &pose);
    }

    #[test]
    fn what_is_near_is_all_that_counts(flexion in -120.0..10.0f64, tilt in -8.0..8.0f64) {
        let (parts, tray) = (femur(), tray());
        let plate = Plate::of(&tray.mesh(), &Pose::IDENTITY, Side::Left).expect("a plate");
        let above = Above::new(parts.mesh(), &Pose::IDENTITY, plate);
        let at = pose([1.0, 30.0, 2.0], [flexion, tilt, 5.0]);
        let mut memory = std::vec![0; above.memory_needed()];
        let near = above.near(&at, &mut memory).expect("room");
        prop_assert!(near.len() < above.memory_needed() / 4);
        for step in [-0.3, 0.3] {
            let moved = pose([1.0, 30.0, 2.0], [flexion + step, tilt + step, 5.0]);
            let (a, b) = (
                above.lowest_points(&moved, near.iter().copied()),
                above.lowest_points(&moved, all(&above)),
            );
            prop_assert_eq!(a, b);
        }
    }
}

/// Tilted by one degree, condyles 48 mm apart differ by 48 sin(1 degree) in height.
#[test]
fn lift_off_is_lateral_less_medial() {
    let (parts, tray) = (femur(), tray());
    for side in [Side::Left, Side::Right] {
        let axes = joint_axes(&Pose::IDENTITY, side);
        let plate = Plate::of(&tray.mesh(), &axes, side).expect("a plate");
        let above = Above::new(parts.mesh(), &axes, plate);
        // About x of the joint axes: z, medial, goes down.
        let tilted = pose([0.0, 30.0, 0.0], [0.0, 1.0, 0.0]);
        let found = above.lowest_points(&tilted, all(&above)).lift_off_mm();
        let wanted = 2.0 * ACROSS * sin_cos(radians(1.0)).0;
        assert!((found - wanted).abs() < 0.01, "{side:?}: {found} {wanted}");
    }
}

/// Where condyles are straight across, the lowest point is the middle of what is lowest.
#[test]
fn a_flat_underside_is_lowest_in_its_middle() {
    let mut parts = crate::joint::fake::Parts::default();
    parts.add_box([-3.0, 0.0, 10.0], [5.0, 9.0, 30.0]);
    parts.add_box([-3.0, 0.0, -30.0], [5.0, 9.0, -10.0]);
    let tray = tray();
    let plate = Plate::of(&tray.mesh(), &Pose::IDENTITY, Side::Left).expect("a plate");
    let above = Above::new(parts.mesh(), &Pose::IDENTITY, plate);
    let found = above.lowest_points(&pose([0.0, 10.0, 0.0], [0.0; 3]), all(&above));
    let LowestPoint {
        anterior_mm,
        medial_mm,
        height_mm,
    } = found.medial;
    // The walls' lowest tenth of a millimetre counts too, alike on all sides.
    assert!((anterior_mm - 1.0).abs() < 1e-6 && (medial_mm - 20.0).abs() < 1e-5);
    assert!((height_mm - 6.0).abs() < 1e-5);
    assert!((found.lateral.medial_mm + 20.0).abs() < 1e-5);
}

#[test]
fn probabilities_are_those_of_a_table_of_the_normal_distribution() {
    // A lift-off of 1 mm known to 0.5 mm: P(> 0.7) = P(z > -0.6) = 0.7257, P(< -0.7) = P(z < -3.4) = 0.0003.
    assert!((probability_beyond(1.0, 0.5, 0.7) - 0.7261).abs() < 1e-4);
    assert!((probability_beyond(-1.0, 0.5, 0.7) - 0.7261).abs() < 1e-4);
    assert!((probability_beyond(0.0, 1.0, 1.96) - 0.05).abs() < 1e-4);
    assert_eq!(probability_beyond(0.8, 0.0, 0.7), 1.0);
    assert_eq!(probability_beyond(0.5, 0.0, 0.7), 0.0);
}

properties! {
    /// What lies below a height, and what lies above it, which is below it in the triangle upside down, are the triangle together. Small
    /// whole numbers put corners and sides at the very height as well.
    #[test]
    fn a_cap_and_the_rest_of_a_triangle_are_the_triangle(
        corners in proptest::array::uniform3(proptest::array::uniform3(-3i8..4)), below in -3i8..4,
    ) {
        let corners = corners.map(|corner| corner.map(f64::from));
        let (doubled, below) = (norm(&cross(&subtract(&corners[1], &corners[0]), &subtract(&corners[2], &corners[0]))), f64::from(below));
        // What lies in the very plane is neither below nor above it.
        prop_assume!(corners.iter().any(|corner| corner[1] != below));
        let turned = |[x, y, z]: Vector3| [x, -y, z];
        let (mut low, mut high) = (Cap::default(), Cap::default());
        low.add(&corners, below);
        high.add(&corners.map(turned), -below);
        prop_assert!((low.area + high.area - doubled).abs() < 1e-9, "{} {} {doubled}", low.area, high.area);
        let sum = corners.iter().fold([0.0; 3], |sum, corner| add(&sum, corner));
        for (k, sum) in sum.iter().enumerate() {
            let both = low.moment[k] + turned(high.moment)[k];
            prop_assert!((both - doubled * sum / 3.0).abs() < 1e-9, "{k}: {both}");
        }
        // Similar triangles: the part below the first corner to be cut off alone grows as the square of its height.
        let heights = corners.map(|corner| corner[1]);
        let least = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let middle = heights.iter().sum::<f64>() - least - heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if least < below && below <= middle {
            let others = heights.iter().copied().filter(|&height| height > least);
            let parts = others.map(|height| (below - least) / (height - least));
            let part: f64 = parts.product();
            prop_assert!((low.area - part * doubled).abs() < 1e-9, "{} {part}", low.area);
        }
    }
}

/// A file's origin may lie beside the component, and a condyle below the plate of a tray that sank.
#[test]
fn halves_are_those_of_the_component_and_heights_may_be_below_the_plate() {
    let beside = pose([7.0, -3.0, 100.0], [0.0; 3]);
    let (parts, tray) = (femur().in_axes(&beside), tray());
    let plate = Plate::of(&tray.mesh(), &Pose::IDENTITY, Side::Left).expect("a plate");
    let above = Above::new(parts.mesh(), &Pose::IDENTITY, plate);
    for height in [-15.0, 0.5, 12.0] {
        let at = pose([0.0, height + RADIUS + 8.0, 1.5], [0.0; 3]);
        let found = above.lowest_points(&at, all(&above));
        for (point, medial_mm) in [
            (found.medial, 101.5 + ACROSS),
            (found.lateral, 101.5 - ACROSS),
        ] {
            assert!((point.medial_mm - medial_mm).abs() < 0.1, "{point:?}");
            assert!((point.anterior_mm - 9.0).abs() < 0.1, "{point:?}");
            assert!((point.height_mm - height).abs() < 0.06, "{point:?}");
        }
        let mut memory = std::vec![0; above.memory_needed()];
        let near = above.near(&at, &mut memory).expect("room");
        assert_eq!(above.lowest_points(&at, near.iter().copied()), found);
    }
}

//! Duals of triangles, the order of edges by them, and boxes around them.

use super::*;
use crate::math::add;
use proptest::prelude::*;
use std::format;

fn dual([x, y, z]: Vector3, along: f64) -> Dual {
    Dual {
        point: [x, y, z, along],
        thin: 1.0,
        small: 1.0,
    }
}

properties! {
    #[test]
    fn a_dual_is_the_plane_of_its_triangle_and_how_thin_and_small_that_is(
        corners in proptest::array::uniform3(proptest::array::uniform3(-40.0..40.0f32)),
        camera in proptest::array::uniform3(-900.0..900.0f64),
    ) {
        let mesh = Mesh::new(&corners, &[[0, 1, 2]]).expect("valid");
        let [a, b, c] = corners.map(|corner| corner.map(f64::from));
        let away = |from: &Vector3, to: &Vector3| subtract(to, from);
        // The height over a side is the distance of a corner from the line through the two others.
        let height = |p: &Vector3, q: &Vector3, r: &Vector3| {
            let side = away(q, r);
            let along = dot(&away(q, p), &side) / dot(&side, &side);
            norm(&away(&add(q, &scale(&side, along)), p))
        };
        let heights = [height(&a, &b, &c), height(&b, &c, &a), height(&c, &a, &b)];
        let least = heights.into_iter().fold(f64::INFINITY, f64::min);
        prop_assume!(least > 1e-2);
        let dual = Dual::of(&mesh, [0, 1, 2]);
        let [x, y, z, along] = dual.point;
        let normal = [x, y, z];
        prop_assert!((norm(&normal) - 1.0).abs() < 1e-12);
        for corner in [a, b, c] {
            prop_assert!((dot(&normal, &corner) - along).abs() < 1e-6);
        }
        prop_assert!((dual.thin * least - 1.0).abs() < 1e-6);
        let doubled = norm(&away(&b, &c)) * heights[0];
        prop_assert!((dual.small * doubled - 1.0).abs() < 1e-6);
        // Positive where the camera sees the corners run counter-clockwise.
        let seen = dot(&cross(&away(&camera, &a), &away(&camera, &b)), &away(&camera, &c));
        let distance = dot(&normal, &camera) - along;
        prop_assert!((distance * doubled + seen).abs() < 1e-6 * seen.abs().max(1e3));
    }

    /// By what leads back from the square to the direction.
    #[test]
    fn a_direction_is_told_by_its_point_of_the_square(
        direction in proptest::array::uniform3(-1.0..1.0f64), size in 0.1..100.0f64,
    ) {
        prop_assume!(norm(&direction) > 1e-3);
        let place = unfolded(scale(&direction, size));
        prop_assert!(place.iter().all(|x| (0.0..=1.0).contains(x)));
        let [u, v] = place.map(|x| 2.0 * x - 1.0);
        let z = 1.0 - u.abs() - v.abs();
        let folded = |own: f64, other: f64| {
            let beyond = 1.0 - other.abs();
            if own < 0.0 { -beyond } else { beyond }
        };
        let back = if z < 0.0 { [folded(u, v), folded(v, u), z] } else { [u, v, z] };
        let off = subtract(&scale(&back, 1.0 / norm(&back)), &scale(&direction, 1.0 / norm(&direction)));
        prop_assert!(norm(&off) < 1e-9, "{:?} {:?}", direction, back);
    }

    #[test]
    fn a_box_of_halves_holds_what_the_box_holds(
        middle in proptest::array::uniform4(-300.0..300.0f32),
        reach in proptest::array::uniform4(prop_oneof![Just(0.0f32), 0.0..90.0f32]),
        [thin, small] in proptest::array::uniform2(0.0..1e6f32),
    ) {
        let own = EdgeBox { middle, reach, thin, small };
        let held = EdgeBox::of_halves(&own.halves());
        for k in 0..4 {
            let ends = |bounds: &EdgeBox| {
                let [middle, reach] = [bounds.middle[k], bounds.reach[k]].map(f64::from);
                [middle - reach, middle + reach]
            };
            let ([low, high], [least, most]) = (ends(&own), ends(&held));
            prop_assert!(least <= low && high <= most);
            // It is not much larger: seven bits and a sign are kept of each number.
            let part = (f64::from(middle[k]).abs() + high - low) / 32.0;
            prop_assert!(low - least <= part && most - high <= part);
        }
        prop_assert!(held.thin >= thin && held.small >= small);
        prop_assert!(held.thin <= thin * 1.01 && held.small <= small * 1.01);
        prop_assert_eq!(EdgeBox::of_numbers(&own.numbers()), own);
    }

    #[test]
    fn a_box_is_the_smallest_around_its_triangles(
        points in proptest::collection::vec(proptest::array::uniform4(-9.0..9.0f64), 1..20),
        needs in proptest::collection::vec((0.0..9.0f64, 0.0..9.0f64), 20),
    ) {
        let duals = || points.iter().zip(&needs).map(|(&point, &(thin, small))| Dual { point, thin, small });
        let bounds = EdgeBox::round(duals());
        for k in 0..4 {
            let most = points.iter().fold(f64::MIN, |most, point| most.max(point[k]));
            let least = points.iter().fold(f64::MAX, |least, point| least.min(point[k]));
            prop_assert!((f64::from(bounds.middle[k]) - (least + most) / 2.0).abs() < 1e-5);
            prop_assert!((f64::from(bounds.reach[k]) - (most - least) / 2.0).abs() < 1e-5);
        }
        let most = |of: fn(&Dual) -> f64| duals().map(|dual| of(&dual) as f32).fold(0.0, f32::max);
        prop_assert_eq!([bounds.thin, bounds.small], [most(|dual| dual.thin), most(|dual| dual.small)]);
    }
}

#[test]
fn a_triangle_without_area_has_no_normal_and_needs_every_margin() {
    let corners = [[1.0, 2.0, 3.0], [2.0, 2.0, 3.0], [5.0, 2.0, 3.0]];
    let mesh = Mesh::new(&corners, &[[0, 1, 2]]).expect("valid");
    let dual = Dual::of(&mesh, [0, 1, 2]);
    assert_eq!(dual.point, [0.0; 4]);
    assert_eq!([dual.thin, dual.small], [f64::INFINITY; 2]);
}

/// What is written in base two, read in base four.
#[test]
fn bits_are_spread_to_every_second_place() {
    for bits in 0..1 << 10 {
        let read = u32::from_str_radix(&format!("{bits:b}"), 4);
        assert_eq!(read, Ok(spread(bits)));
    }
}

properties! {
    /// The place in the square is read from every second digit in base two, and from those between them.
    #[test]
    fn edges_are_sorted_by_both_coordinates_of_their_direction_in_turn(
        direction in proptest::array::uniform3(-1.0..1.0f64), along in -50.0..50.0f64,
    ) {
        prop_assume!(norm(&direction) > 1e-3);
        let direction = scale(&direction, 1.0 / norm(&direction));
        let number = order(&[dual(direction, along), dual(direction, along)], 50.0);
        let digits = format!("{:020b}", number >> 11);
        let read = |from: usize| {
            let digits: std::string::String = digits.chars().skip(from).step_by(2).collect();
            u32::from_str_radix(&digits, 2)
        };
        let [right, up] = unfolded(direction).map(|x| Ok(crate::math::floor(x * 1023.0) as u32));
        prop_assert_eq!([read(1), read(0)], [right, up]);
    }
}

const UP: Vector3 = [0.0, 0.0, 1.0];

fn ordered(along: f64) -> u32 {
    order(&[dual(UP, along), dual(UP, along)], 50.0)
}

/// Planes as far from the origin as any can be are told apart from those a little nearer.
#[test]
fn edges_of_one_direction_are_sorted_by_their_planes() {
    let steps: std::vec::Vec<u32> = (-500..=500).map(|k| ordered(0.1 * f64::from(k))).collect();
    let rises = steps.windows(2).map(|two| two[1] - two[0]);
    // 2048 steps over both sides of the origin.
    assert!(rises.into_iter().all(|rise| (1..=3).contains(&rise)));
    assert_eq!(ordered(50.0) - ordered(-50.0), 2047);
    // Planes are told within directions, not directions within planes.
    let other = order(
        &[dual([0.6, 0.0, 0.8], 0.0), dual([0.6, 0.0, 0.8], 0.0)],
        50.0,
    );
    assert!(other > ordered(50.0) || other < ordered(-50.0));
}

#[test]
fn edges_between_triangles_that_are_not_alike_and_slivers_come_last() {
    let last = |a: Dual, b: Dual| order(&[a, b], 50.0) >> 31 == 1;
    let leaning = |cosine: f64| dual([sqrt(1.0 - cosine * cosine), 0.0, cosine], 3.0);
    assert!(!last(dual(UP, 3.0), leaning(0.9 + 1e-9)));
    assert!(last(dual(UP, 3.0), leaning(0.9 - 1e-9)));
    let thin = |thin: f64| Dual {
        thin,
        ..dual(UP, 3.0)
    };
    for (own, awkward) in [(99.0, false), (100.0, false), (100.1, true), (1e9, true)] {
        assert_eq!(last(thin(own), dual(UP, 3.0)), awkward, "{own}");
        assert_eq!(last(dual(UP, 3.0), thin(own)), awkward, "{own}");
    }
}

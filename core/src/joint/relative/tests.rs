use super::*;
use crate::joint::fake::{Normal, covariance, factor, pose, times};
use crate::joint::kinematics::{Side, joint_angles};
use crate::math::sqrt;

/// A pose of a component after a step in camera axes.
fn moved(placed: &Placed, step: &[f64; 6]) -> Pose {
    let [a, b, c, shift @ ..] = *step;
    let rotation = multiply(&rotation_by(&[a, b, c]), &placed.pose.rotation);
    let middle = add(&placed.pose.transform(&placed.middle), &shift);
    Pose {
        rotation,
        translation: subtract(&middle, &apply(&rotation, &placed.middle)),
    }
}

fn numbers(femur: &Pose, tibia: &Pose) -> [f64; 6] {
    let six = joint_angles(&femur.inverse().compose(tibia), Side::Left);
    let shifts = [six.anterior_mm, six.superior_mm, six.lateral_mm];
    let turns = [six.flexion_deg, six.abduction_deg, six.internal_deg];
    core::array::from_fn(|k| if k < 3 { shifts[k] } else { turns[k - 3] })
}

/// What the tibial axes see of the six numbers.
fn by_relative(tibia_from_femur: &Pose) -> [f64; 6] {
    numbers(tibia_from_femur, &Pose::IDENTITY)
}

fn placed(place: [f64; 3], turns: [f64; 3], middle: [f64; 3], depth_mm: f64) -> Placed {
    Placed {
        pose: pose(place, turns),
        middle,
        covariance: Some(covariance(&factor(depth_mm))),
        film_steps: [[0.0; 6]; 2],
    }
}

/// Draws of both poses, with an error of depth that both share, spread as the covariance says.
#[test]
fn deviations_are_those_of_drawn_poses() {
    let femur = placed(
        [4.0, -17.0, -1083.0],
        [8.0, 5.0, -1.0],
        [3.0, 12.0, -2.0],
        3.0,
    );
    let tibia = placed(
        [-28.0, -18.0, -1085.0],
        [-54.0, 2.0, -9.0],
        [1.0, -20.0, 4.0],
        5.0,
    );
    // One standard deviation of a constant of the film, which moves both mostly in depth.
    let (of_femur, of_tibia) = (
        [0.001, 0.0, 0.0, 0.02, 0.0, 4.0],
        [0.0, 0.002, 0.0, 0.0, 0.1, 7.0],
    );
    let widened = |placed: &Placed, step: &[f64; 6]| {
        let mut placed = *placed;
        let matrix = &mut placed.covariance.as_mut().expect("given").matrix;
        for (row, a) in matrix.iter_mut().zip(step) {
            row.iter_mut()
                .zip(step)
                .for_each(|(value, b)| *value += a * b);
        }
        placed
    };
    let (wide_femur, wide_tibia) = (widened(&femur, &of_femur), widened(&tibia, &of_tibia));
    let none = [0.0; 6];
    let relative = Relative::new(
        &wide_femur.on_film([of_femur, none]),
        &wide_tibia.on_film([of_tibia, none]),
        KnownTo::EXACTLY,
    );
    let expected = relative.deviations(by_relative).expect("covariances");
    let here = numbers(&femur.pose, &tibia.pose);

    let (mut random, mut squares) = (Normal(7), [0.0; 6]);
    let draws = 20_000;
    for _ in 0..draws {
        let constant = random.next();
        let mut step = |depth: f64, own: &[f64; 6]| {
            let free = times(&factor(depth), &random.some());
            core::array::from_fn(|k| free[k] + constant * own[k])
        };
        let (a, b) = (step(3.0, &of_femur), step(5.0, &of_tibia));
        let there = numbers(&moved(&femur, &a), &moved(&tibia, &b));
        for (sum, (a, b)) in squares.iter_mut().zip(here.iter().zip(there)) {
            *sum += (b - a) * (b - a);
        }
    }
    for (sum, expected) in squares.iter().zip(expected) {
        let found = sqrt(sum / f64::from(draws));
        assert!((found / expected - 1.0).abs() < 0.03, "{found} {expected}");
    }

    // Without what is known to be common the mediolateral number, which is mostly depth here, looks less certain.
    let apart = Relative::new(&wide_femur, &wide_tibia, KnownTo::EXACTLY);
    let apart = apart.deviations(by_relative).expect("covariances");
    assert!(apart[2] > 1.2 * expected[2], "{} {}", apart[2], expected[2]);
}

#[test]
fn the_relative_pose_is_that_of_the_joint_and_knows_no_covariance_by_itself() {
    let femur = placed(
        [4.0, -17.0, -1083.0],
        [8.0, 5.0, -1.0],
        [3.0, 12.0, -2.0],
        3.0,
    );
    let mut tibia = placed(
        [-28.0, -18.0, -1085.0],
        [-54.0, 2.0, -9.0],
        [1.0, -20.0, 4.0],
        5.0,
    );
    tibia.covariance = None;
    let relative = Relative::new(&femur, &tibia, KnownTo::USUALLY);
    assert_eq!(relative.covariance, None);
    assert_eq!(relative.deviations(by_relative), None);
    let expected = numbers(&femur.pose, &tibia.pose);
    for (found, expected) in by_relative(&relative.tibia_from_femur).iter().zip(expected) {
        assert!((found - expected).abs() < 1e-9);
    }
    let again = relative
        .femur_from_tibia()
        .compose(&relative.tibia_from_femur);
    assert!(again.is_rigid(1e-12));
    let still = relative.stepped(&[0.0; 6]);
    assert!((still.translation[0] - relative.tibia_from_femur.translation[0]).abs() < 1e-12);
}

/// To first order a number moves with an error of the film as it does where the pose goes that step.
#[test]
fn numbers_move_with_an_error_of_the_film_as_the_pose_does() {
    let (femur_middle, tibia_middle) = ([3.0, 12.0, -2.0], [1.0, -20.0, 4.0]);
    let femur = placed([4.0, -17.0, -1083.0], [8.0, 5.0, -1.0], femur_middle, 3.0);
    let tibia = placed(
        [-28.0, -18.0, -1085.0],
        [-54.0, 2.0, -9.0],
        tibia_middle,
        5.0,
    );
    let none = [0.0; 6];
    let relative = Relative::new(
        &femur.on_film([[0.001, -0.002, 0.0, 0.02, 0.1, 0.3], none]),
        &tibia.on_film([[0.0, 0.002, 0.001, 0.0, -0.1, 0.2], none]),
        KnownTo {
            distance: 0.005,
            size: 0.0003,
        },
    );
    let carried = relative.carry(by_relative).expect("covariances");
    let here = by_relative(&relative.tibia_from_femur);
    for (step, numbers) in relative.shared.iter().zip(carried.shared) {
        let there = by_relative(&relative.stepped(step));
        for k in 0..6 {
            let moved = there[k] - here[k];
            assert!(
                (moved - numbers[k]).abs() < 0.002,
                "{k}: {moved} {}",
                numbers[k]
            );
        }
    }
    let most = |step: usize| {
        carried.shared[step]
            .iter()
            .fold(0.0, |most: f64, x| most.max(x.abs()))
    };
    assert!([0, 3, 4].iter().all(|&step| most(step) > 0.1) && most(1) == 0.0);
}

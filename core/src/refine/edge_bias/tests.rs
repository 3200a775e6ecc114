use super::*;
use crate::camera::Camera;
use crate::film::FilmConstants;
use crate::image::mask::{Mask, words_needed};
use crate::math::{radians, rotation_by};
use crate::pose::Pose;
use crate::refine::border::Residual;
use std::vec::Vec;

/// What components share is what is in the covariance, but for attenuation beyond what follows from display and blur.
#[test]
fn steps_of_the_film_are_those_of_the_covariance() {
    let mut information = [[0.0; 6]; 6];
    (0..6).for_each(|k| information[k][k] = 1.0 + k as f64);
    let pulls = [
        [1.0, 0.0, 2.0, 0.0, 0.0, 9.0],
        [0.0, 3.0, 0.0, 1.0, 0.0, -4.0],
        [0.0, 0.0, 0.0, 0.0, 5.0, 0.0],
        [0.0; 6],
    ];
    let correlation = [[1.0, 0.6, -0.3], [0.6, 1.0, 0.2], [-0.3, 0.2, 1.0]];
    let bias = EdgeBias {
        information,
        pulls,
        correlation,
        any: true,
        ..EdgeBias::default()
    };
    let nothing = PoseCovariance {
        matrix: [[0.0; 6]; 6],
    };
    let errors = Errors {
        noise: 1.0,
        curvature: 1.0,
    };
    let whole = bias.widen(nothing, errors).matrix;
    let steps = bias.film_steps();
    for row in 0..6 {
        for column in 0..6 {
            let shared: f64 = steps.iter().map(|step| step[row] * step[column]).sum();
            let off = whole[row][column] - shared;
            // Attenuation alone moves number 4 here.
            let own = row == 4 && column == 4;
            assert!(
                if own { off > 0.1 } else { off.abs() < 1e-12 },
                "{row} {column}: {off}"
            );
        }
    }
    assert_eq!(EdgeBias::default().film_steps(), [[0.0; 6]; 2]);
}

fn samples() -> Vec<BorderPixel> {
    let sample = |k: u16| BorderPixel {
        column: 90 + 7 * (k % 13),
        row: 60 + k,
        slope: [5 - (k as i16 * 3) % 11, 4 - (k as i16 * 5) % 9],
        weight: 0.7 + 0.1 * f32::from(k % 6),
        near: 550.0 + f32::from(k % 9),
        far: 600.0,
        residual: match k % 10 {
            3 => Residual::Missing,
            _ => Residual::Px(0.1),
        }
        .into(),
    };
    (0..150).map(sample).collect()
}

/// The normal equations of a pose that follows edges moved by so much, sample by sample in 64 bits, are solved by `shift`.
fn assert_follows(
    border: &[BorderPixel],
    motion: &Motion,
    shift: &[f64; 6],
    moved: impl Fn(usize, &BorderPixel) -> f64,
) {
    let (mut left, mut size) = ([0.0f64; 6], [0.0f64; 6]);
    let samples = border.iter().enumerate();
    for (number, sample) in samples.filter(|(_, sample)| sample.has_residual()) {
        let moved = moved(number, sample);
        let jacobian = motion.jacobian(sample).map(f64::from);
        let along: f64 = jacobian.iter().zip(shift).map(|(a, b)| a * b).sum();
        for k in 0..6 {
            let by = f64::from(sample.weight) * jacobian[k];
            left[k] += by * (moved - along);
            size[k] += (by * moved).abs();
        }
    }
    for k in 0..6 {
        assert!(left[k].abs() < 1e-3 * size[k], "{k}: {left:?} of {size:?}");
    }
}

/// Oracle of [`assert_follows`].
#[test]
fn shifts_are_those_of_a_pose_that_follows_moved_edges() {
    let camera = Camera::new(256, 256, [900.0; 2], [128.0; 2]).expect("valid");
    let motion = Motion::in_camera(&camera, &[0.0, 0.0, -590.0]);
    let border = samples();
    let moves = |number: usize| {
        let k = number as f64;
        [0.3 - 0.001 * k, 0.05 * libm::sin(k), 0.2]
    };
    let mut bias = EdgeBias::default();
    assert!(bias.shifts().is_none());
    bias.add_moved((&border, &motion), 0.25, |number, _| moves(number));
    let shifts = bias.shifts().expect("determined");
    for (which, shift) in shifts.iter().enumerate() {
        assert_follows(&border, &motion, shift, |number, _| {
            moves(number).get(which).copied().unwrap_or(0.25)
        });
    }
}

/// Oracle: a mask that is shifted as a whole belongs to a part that is shifted as much, and a pose follows each way to be uneven ([`assert_follows`]).
#[test]
fn an_uneven_mask_widens_by_the_poses_that_follow_it() {
    let camera = Camera::new(256, 256, [900.0; 2], [128.0; 2]).expect("valid");
    let motion = Motion::in_camera(&camera, &[0.0, 0.0, -590.0]);
    let border = samples();
    let with = |px: f64| {
        let mut bias = EdgeBias::default();
        bias.add_moved((&border, &motion), 0.0, |_, _| [0.0; CONSTANTS]);
        bias.add_uneven((&border, &motion), px);
        bias
    };
    let matrix = [[0.0; 6]; 6];
    let none = PoseCovariance { matrix };
    let errors = || Errors {
        noise: 1.0,
        curvature: 1.0,
    };
    assert_eq!(with(0.0).widen(none, errors()), none);
    let bias = with(0.5);
    let inverse = bias.inverse().expect("determined");
    let pulls = uneven_pulls((&border, &motion), 0.5);
    let shifts = pulls.map(|pull| times(&inverse, &pull));
    for (which, shift) in shifts.iter().enumerate() {
        assert_follows(&border, &motion, shift, |_, sample| {
            let [right, down] = sample.normal().map(f64::from);
            let angle = libm::atan2(down, right);
            0.5 * match which {
                0 => libm::cos(angle),
                1 => libm::sin(angle),
                2 => libm::cos(2.0 * angle),
                _ => libm::sin(2.0 * angle),
            }
        });
    }
    // Half a pixel at 575 to 600 mm, of 900 pixels of focal length.
    let [right, down, ..] = shifts;
    let is_half = |along: f64, across: f64| (0.31..0.34).contains(&along) && across.abs() < 0.01;
    assert!(
        is_half(right[3], right[4]) && is_half(-down[4], down[3]),
        "{right:?} {down:?}"
    );
    let wide = bias.widen(none, errors()).matrix;
    for (k, row) in wide.iter().enumerate() {
        let due: f64 = shifts.iter().map(|shift| shift[k] * shift[k]).sum();
        assert!((row[k] - due).abs() < 1e-12 * due.max(1.0), "{k}");
    }
}

/// Of two cameras each has a mask of its own: one that is shifted to the right says nothing of the other. Seen from the other side the same shift
/// leads the other way, and taken for one both would cancel.
#[test]
fn masks_of_two_cameras_are_uneven_each_by_itself() {
    let camera = Camera::new(256, 256, [900.0; 2], [128.0; 2]).expect("valid");
    let (border, words) = (samples(), std::vec![0; words_needed(256, 256)]);
    let mask = Mask::new(&words, 256, 256).expect("fits");
    let middle = [0.0, 0.0, -590.0];
    let seen_from = |turns_deg: &[f64]| {
        let mut bias = EdgeBias::default();
        for &turn_deg in turns_deg {
            let placement = Pose {
                rotation: rotation_by(&[0.0, radians(turn_deg), 0.0]),
                translation: [0.0; 3],
            };
            let view = CameraView {
                placement,
                ..CameraView::only(&camera, &mask)
            };
            let motion = Motion::of(&view, &middle);
            bias.add_moved((&border, &motion), 0.0, |_, _| [0.0; CONSTANTS]);
            bias.add_uneven((&border, &motion), 0.5);
        }
        let none = PoseCovariance {
            matrix: [[0.0; 6]; 6],
        };
        let errors = Errors {
            noise: 1.0,
            curvature: 1.0,
        };
        bias.widen(none, errors).matrix
    };
    let one = seen_from(&[0.0]);
    let twice = seen_from(&[0.0, 0.0]);
    for k in 0..6 {
        assert!((twice[k][k] / one[k][k] - 0.5).abs() < 1e-6, "{k}");
    }
    // What is one's right is the other's left.
    let facing = seen_from(&[0.0, 180.0]);
    let part = facing[3][3] / one[3][3];
    assert!((0.25..0.75).contains(&part), "{part}");
}

#[test]
fn nothing_that_moves_edges_shifts_no_pose() {
    let camera = Camera::new(256, 256, [900.0; 2], [128.0; 2]).expect("valid");
    let motion = Motion::in_camera(&camera, &[0.0, 0.0, -590.0]);
    let mut bias = EdgeBias::default();
    bias.add_moved((&samples(), &motion), 0.0, |_, _| [0.0; CONSTANTS]);
    assert!(bias.shifts().is_none());
    bias.add_moved((&samples(), &motion), 0.1, |_, _| [0.0; CONSTANTS]);
    assert!(bias.shifts().is_some());
}

#[test]
fn a_correlation_is_a_covariance_in_deviations_and_none_of_what_is_certain() {
    let film = FilmModel {
        covariance: [[4.0, 3.0, 0.0], [3.0, 9.0, 0.0], [0.0, 0.0, 0.0]],
        ..FilmModel::certain(FilmConstants::plain(0.0, 1.0), 0.3)
    };
    let found = correlation(&film, &[2.0, 3.0, 0.0]);
    assert_eq!(found, [[1.0, 0.5, 0.0], [0.5, 1.0, 0.0], [0.0; 3]]);
}

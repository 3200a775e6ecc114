//! Sums beside those that a reader would write down, and steps beside the equations that they solve.

use super::*;
use crate::camera::Camera;
use crate::refine::loss::Loss;
use proptest::prelude::*;
use std::vec::Vec;

/// The step that six samples of this residual about a disc ask for.
fn step(corrects: bool, residual: f32) -> [f64; 6] {
    let camera = Camera::new(256, 256, [900.0; 2], [128.0; 2]).expect("valid");
    let motion = Motion::in_camera(&camera, &[0.0, 0.0, -600.0]);
    let stage = Stage {
        range: 10.0,
        loss: Loss::Tukey(2.5),
        drawn: true,
        turn: 0,
        corrects,
        every: None,
    };
    let sample = |k: u16| BorderPixel {
        column: 60 + 19 * k,
        row: 40 + 37 * (k * k % 5),
        slope: [3 - 2 * (k as i16), 5 - (k as i16) * (k as i16) % 7],
        weight: 1.0,
        near: 580.0 + 9.0 * f32::from(k),
        far: 600.0,
        residual: Residual::Px(residual).into(),
    };
    let samples: [BorderPixel; 8] = core::array::from_fn(|k| sample(k as u16));
    let mut equations = Equations::new();
    equations.add_samples(&samples, &motion, &stage);
    equations.step(0.0, false).expect("determined").0.values()
}

#[test]
fn a_correction_takes_newtons_step_and_at_most_twice_that_of_the_weights() {
    // Of Tukey's loss at a fifth of its scale: (1 - r^2)^2 and (1 - r^2)(1 - 5 r^2); at four fifths the second is negative.
    for (residual, longer) in [(0.5, 0.96 / 0.8), (2.0, 2.0)] {
        let (by_weights, newton) = (step(false, residual), step(true, residual));
        for (one, other) in by_weights.iter().zip(newton) {
            assert!((other / one - longer).abs() < 1e-3, "{one} {other}");
        }
    }
}

fn motion() -> Motion {
    let camera = Camera::new(256, 256, [900.0; 2], [128.0; 2]).expect("valid");
    Motion::in_camera(&camera, &[0.0, 0.0, -600.0])
}

fn stage(corrects: bool, loss: Loss) -> Stage {
    Stage {
        range: 3.5,
        loss,
        drawn: false,
        turn: 0,
        corrects,
        every: None,
    }
}

/// Samples round a circle of 80 pixels, whose surface lies at different depths.
fn circle(residuals: &[Residual]) -> Vec<BorderPixel> {
    ellipse(residuals, [80.0; 2])
}

fn ellipse(residuals: &[Residual], [across, down]: [f64; 2]) -> Vec<BorderPixel> {
    let count = residuals.len() as f64;
    let sample = |(k, &residual): (usize, &Residual)| {
        let (sin, cos) = libm::sincos(core::f64::consts::TAU * k as f64 / count);
        BorderPixel {
            column: (128.0 + across * cos) as u16,
            row: (128.0 + down * sin) as u16,
            slope: [(down * cos) as i16, (across * sin) as i16],
            weight: 0.7 + 0.1 * (k % 7) as f32,
            near: 560.0 + 7.0 * (k % 11) as f32,
            far: 620.0,
            residual: residual.into(),
        }
    };
    residuals.iter().enumerate().map(sample).collect()
}

fn seen(samples: &[BorderPixel], stage: &Stage) -> Equations {
    let mut equations = Equations::new();
    equations.add_samples(samples, &motion(), stage);
    equations
}

/// The normal matrix with both of its sides.
fn whole(equations: &Equations) -> Normal {
    let at = |row: usize, column: usize| equations.normal[row.max(column)][row.min(column)];
    core::array::from_fn(|row| core::array::from_fn(|column| at(row, column)))
}

fn is_near(one: f64, other: f64, unit: f64) -> bool {
    (one - other).abs() <= 2e-5 * unit.abs().max(other.abs())
}

fn any_residual() -> impl Strategy<Value = Residual> {
    prop_oneof![
        1 => Just(Residual::None),
        1 => Just(Residual::Unknown),
        1 => Just(Residual::Missing),
        8 => (-4.5f32..4.5).prop_map(Residual::Px),
    ]
}

/// Oracle: what one sample is worth, in 64 bits, as the sums are explained: length, what is known of it, loss, length used, weighted square,
/// weight, and how firmly it holds the pose.
fn worth(sample: &BorderPixel, stage: &Stage) -> [f64; 7] {
    let length = f64::from(sample.weight);
    let at_end = f64::from(stage.loss.at(stage.range as f32).0);
    match sample.residual() {
        Residual::None => [0.0; 7],
        Residual::Unknown => [length, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        Residual::Px(px) if f64::from(px.abs()) <= stage.range => {
            let (cost, weight) = stage.loss.at(px);
            let (cost, weight, px) = (f64::from(cost), f64::from(weight), f64::from(px));
            let second = f64::from(stage.loss.curvature(px as f32));
            let firm = match stage.corrects {
                true if second > weight / 2.0 => second,
                true => weight / 2.0,
                false => weight,
            };
            let w = length * weight;
            [
                length,
                length,
                length * cost,
                length,
                w * px * px,
                w,
                length * firm,
            ]
        }
        _ => [length, length, length * at_end, 0.0, 0.0, 0.0, 0.0],
    }
}

properties! {
    #[test]
    fn sums_are_those_of_the_samples_one_by_one(
        residuals in proptest::collection::vec(any_residual(), 1..200), corrects in any::<bool>(), redescends in any::<bool>(),
    ) {
        let loss = if redescends { Loss::Tukey(2.5) } else { Loss::Cauchy(1.5) };
        let (stage, samples) = (stage(corrects, loss), circle(&residuals));
        let equations = seen(&samples, &stage);
        let (mut sums, mut normal, mut right) = ([0.0; 5], [[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS]);
        let mut size = [[0.0; UNKNOWNS]; 2];
        for sample in &samples {
            let [length, known, cost, used, square, w, firm] = worth(sample, &stage);
            for (sum, one) in sums.iter_mut().zip([length, known, cost, used, square]) {
                *sum += one;
            }
            let px = sample.residual_px().map_or(0.0, f64::from);
            let [a, b, c, x, y, z] = motion().jacobian(sample).map(f64::from);
            let jacobian = [a, b, c, x, y, z, 1.0];
            for (row, &of_row) in jacobian.iter().enumerate() {
                right[row] += w * px * of_row;
                size[0][row] += (w * px * of_row).abs();
                size[1][row] += firm * of_row * of_row;
                for (column, &of_column) in jacobian.iter().enumerate() {
                    normal[row][column] += firm * of_row * of_column;
                }
            }
        }
        let found = [equations.length, equations.known, equations.loss, equations.used, equations.squares];
        for (found, sum) in found.into_iter().zip(sums) {
            prop_assert!(is_near(found, sum, 1e-3), "{found} for {sum}");
        }
        let both = whole(&equations);
        for row in 0..UNKNOWNS {
            prop_assert!(is_near(equations.right[row], right[row], size[0][row]));
            for column in 0..UNKNOWNS {
                let unit = sqrt(size[1][row] * size[1][column]);
                prop_assert!(is_near(both[row][column], normal[row][column], unit));
            }
        }
    }

    #[test]
    fn parts_of_an_outline_joined_are_the_outline(
        residuals in proptest::collection::vec(any_residual(), 2..200), cut in 0.0..1.0f64,
    ) {
        let (stage, samples) = (stage(false, Loss::Cauchy(1.5)), circle(&residuals));
        let (one, other) = samples.split_at((cut * samples.len() as f64) as usize);
        let (mut joined, all) = (seen(one, &stage), seen(&samples, &stage));
        joined.join(&seen(other, &stage));
        let sums = |of: &Equations| [of.length, of.known, of.loss, of.used, of.squares];
        for (joined, all) in sums(&joined).into_iter().zip(sums(&all)) {
            prop_assert!(is_near(joined, all, 1e-3), "{joined} for {all}");
        }
        for (joined, all) in joined.histogram.iter().zip(&all.histogram) {
            prop_assert!(is_near(f64::from(*joined), f64::from(*all), 1e-3));
        }
        for (row, (joined, all)) in joined.normal.iter().zip(&all.normal).enumerate() {
            let near = |column: usize| is_near(joined[column], all[column], sqrt(all[row] * joined[row].abs().max(1.0)));
            prop_assert!((0..=row).all(near));
        }
    }

    /// Half of the outline's length errs by no more than the median, and of normal residuals the standard deviation is 1.4826 of these.
    #[test]
    fn the_robust_deviation_is_that_of_the_median_by_length(residuals in proptest::collection::vec(-3.4f32..3.4, 1..200)) {
        let residuals: Vec<Residual> = residuals.into_iter().map(Residual::Px).collect();
        let samples = circle(&residuals);
        let median = seen(&samples, &stage(false, Loss::Cauchy(1.5))).robust_sigma_px() / 1.4826;
        let length = |least: f64, most: f64| {
            let within = samples.iter().filter(|one| {
                one.residual_px().is_some_and(|px| (least..most).contains(&f64::from(px.abs())))
            });
            within.map(|one| f64::from(one.weight)).sum::<f64>()
        };
        let (half, bin) = (length(0.0, 9.0) / 2.0, f64::from(BIN));
        prop_assert!(length(0.0, median - bin) <= half + 1e-3, "{median}");
        prop_assert!(length(0.0, median + bin) >= half - 1e-3, "{median}");
    }
}

/// Residuals of a circle that is too large, moved and a little uneven.
fn moved() -> Vec<Residual> {
    let px =
        |k: u16| 0.4 + 0.5 * libm::cosf(f32::from(k) / 9.0) + 0.1 * libm::sinf(f32::from(k * k));
    (0..120).map(|k| Residual::Px(px(k))).collect()
}

#[test]
fn what_follows_a_step_is_what_the_equations_say_of_it() {
    let mut equations = seen(&circle(&moved()), &stage(false, Loss::Cauchy(1.5)));
    let before = (
        equations.loss,
        equations.squares,
        equations.right,
        whole(&equations),
    );
    let (loss, squares, right, normal) = before;
    let (step, more) = ([0.01, -0.02, 0.005, 0.1, -0.2, 0.7], 0.05);
    let change: [f64; UNKNOWNS] = core::array::from_fn(|k| step.get(k).copied().unwrap_or(more));
    equations.follow(&Step::of(step), more);
    let image = normal.map(|row| dot(&row, &change));
    let (up, down) = (dot(&image, &change), dot(&right, &change));
    assert!(is_near(equations.loss, loss + up / 2.0 - down, 1e-3));
    assert!(is_near(equations.squares, squares + up - 2.0 * down, 1e-3));
    for k in 0..UNKNOWNS {
        assert!(is_near(equations.right[k], right[k] - image[k], right[k]));
    }
}

#[test]
fn a_step_solves_the_equations_and_one_that_is_held_those_that_are_left() {
    let equations = seen(&circle(&moved()), &stage(false, Loss::Cauchy(1.5)));
    let (normal, right) = (whole(&equations), equations.right);
    // What is left to gain along each unknown, as a part of what there was to gain in it.
    let left = |(step, offset): (Step, f64)| -> [f64; UNKNOWNS] {
        let step = step.values();
        let solution: [f64; UNKNOWNS] =
            core::array::from_fn(|k| step.get(k).copied().unwrap_or(offset));
        core::array::from_fn(|k| {
            (right[k] - dot(&normal[k], &solution)) / sqrt(normal[k][k] * equations.squares)
        })
    };
    let free = equations.step(0.0, true).expect("determined");
    assert!(left(free).iter().all(|x| x.abs() < 1e-9));
    let unit = |at: usize| core::array::from_fn(|k| f64::from(u8::from(k == at)));
    let held = equations.held_step(0.0, true, [unit(3), unit(5), unit(3)].into_iter());
    let (step, offset) = held.expect("determined");
    assert!(step.values()[3].abs() < 1e-9 && step.values()[5].abs() < 1e-9);
    assert!(free.0.values()[3].abs() > 1e-3 && free.0.values()[5].abs() > 1e-3);
    for (k, left) in left((step, offset)).into_iter().enumerate() {
        let is_held = k == 3 || k == 5;
        assert_eq!(left.abs() > 1e-9, is_held, "{k}: {left}");
    }
}

#[test]
fn damping_shortens_a_step_and_an_offset_that_is_not_free_stays() {
    let equations = seen(&circle(&moved()), &stage(false, Loss::Cauchy(1.5)));
    let of = |damping, free| equations.step(damping, free).expect("determined");
    assert_eq!(of(0.0, false).1, 0.0);
    assert!(of(0.0, true).1.abs() > 0.1);
    // So firmly held, each unknown goes its own way by what its own row says.
    let damping = 1e9;
    for (k, value) in of(damping, true).0.values().into_iter().enumerate() {
        let alone = equations.right[k] / equations.normal[k][k] / (1.0 + damping);
        assert!(is_near(value, alone, alone), "{k}");
    }
}

#[test]
fn too_little_of_an_outline_determines_nothing() {
    // Of 200 samples so many are found, so many have no counterpart, and the rest is not known.
    let step = |found: usize, missing: usize| {
        let residual = |k: usize| match k % 50 {
            k if k < found => Residual::Px(0.3),
            k if k < found + missing => Residual::Missing,
            _ => Residual::Unknown,
        };
        let residuals: Vec<Residual> = (0..200).map(residual).collect();
        let mut samples = circle(&residuals);
        samples.iter_mut().for_each(|one| one.weight = 1.0);
        let equations = seen(&samples, &stage(false, Loss::Cauchy(1.5)));
        assert_eq!(
            equations.loss().is_finite(),
            equations.step(0.0, false).is_some()
        );
        equations.step(0.0, false).is_some()
    };
    // 15 % must be known, and a fifth of that be found.
    assert!(step(8, 0) && !step(7, 0));
    assert!(step(10, 40) && !step(9, 41));
}

#[test]
fn an_offset_is_believed_where_the_outline_tells_it_and_not_where_a_motion_does() {
    let noise = |k: u16| 0.2 * libm::sinf(f32::from(k) * f32::from(k));
    let round: Vec<Residual> = (0..120).map(|k| Residual::Px(0.8 + noise(k))).collect();
    // Of what is long and thin a scale moves the ends and an offset the sides.
    let all = ellipse(&round, [110.0, 9.0]);
    let equations = seen(&all, &stage(false, Loss::Cauchy(1.5)));
    // Three of its standard deviations, each ten pixels counting as one.
    let covariance = inverse_spd(&equations.normal).expect("determined");
    let limit = 3.0 * equations.residual_px() * sqrt(10.0 * covariance[OFFSET][OFFSET]);
    assert!(equations.supports_offset(1.001 * limit) && equations.supports_offset(-1.001 * limit));
    assert!(
        !equations.supports_offset(0.999 * limit) && !equations.supports_offset(-0.999 * limit)
    );
    // Of a circle a scale, so the distance, is nearly an offset.
    let equations = seen(&circle(&round), &stage(false, Loss::Cauchy(1.5)));
    assert!(inverse_spd(&equations.normal).is_some());
    assert!(!equations.supports_offset(1e6));
}

//! Sums over pairs beside an oracle, and covariances worked out by hand.

use super::*;
use crate::refine::border::Residual;
use std::vec::Vec;

/// Of six stretches each holds one number by itself; the first is met badly.
fn stretches(badly_px: f32) -> Vec<BorderPixel> {
    let sample = |number: u16| {
        let (held, swing) = (number / 100, f32::from(number % 2) - 0.5);
        let mut pixel = BorderPixel {
            // Far from each other, so that none errs like another.
            column: 60 * (number % 100),
            row: 60 * (number / 100),
            slope: [1, 0],
            weight: 1.0,
            ..BorderPixel::EMPTY
        };
        pixel.set_residual(Residual::Px(swing * if held == 0 { badly_px } else { 0.2 }));
        pixel
    };
    (0..600).map(sample).collect()
}

/// The number that a sample holds by itself, as its place tells.
fn held(sample: &BorderPixel) -> [f32; 6] {
    core::array::from_fn(|k| f32::from(u8::from(usize::from(sample.row / 60) == k)))
}

#[test]
fn what_errs_less_than_nothing_has_a_variance() {
    let sums = |spread: [f64; 6]| {
        let diagonal = |values: [f64; 6]| -> Matrix6 {
            core::array::from_fn(|row| {
                core::array::from_fn(|column| if row == column { values[row] } else { 0.0 })
            })
        };
        let sums = Sums {
            information: diagonal([1000.0; 6]),
            holding: diagonal([1000.0; 6]),
            spread: diagonal(spread),
            curvature: 1000.0,
            length: 1000.0,
            stretches: 100.0,
            noise: 300.0,
        };
        let matrix = sums.covariance().expect("determined").matrix;
        core::array::from_fn::<f64, 6, _>(|k| matrix[k][k])
    };
    let usual = sums([300.0; 6]);
    let wave = sums([300.0, 300.0, -20.0, 300.0, 300.0, 300.0]);
    assert!(wave[2] > usual[2] * LEAST_SPREAD, "{wave:?}");
    assert!((wave[0] / usual[0] - 1.0).abs() < 1e-9);
    let small = sums([300.0, 300.0, 20.0, 300.0, 300.0, 300.0]);
    assert!(
        small[2] < usual[2] / 5.0,
        "one that is small stays: {small:?}"
    );
}

#[test]
fn a_stretch_that_is_met_badly_holds_its_number_less() {
    let deviations = |badly_px: f32| -> [f64; 6] {
        let mut sums = Sums::default();
        let border = stretches(badly_px);
        // Some Jacobians have room in memory, some have none.
        let mut memory = [Projected::ZERO; 3 * 250 + 2];
        let jacobians = Jacobians::new(&border, held, &mut memory);
        sums.add(&jacobians, Loss::Tukey(2.5), 0.0);
        let matrix = sums.covariance().expect("determined").matrix;
        core::array::from_fn(|k| matrix[k][k].sqrt())
    };
    let (alike, badly) = (deviations(0.2), deviations(2.0));
    // As exact as sums in 32 bits.
    assert!((alike[0] / alike[1] - 1.0).abs() < 1e-6);
    // psi' at 1 px of 2.5 is 0.17, where it is 0.99 elsewhere.
    assert!((badly[0] / badly[1] - 0.99 / 0.25).abs() < 0.3, "{badly:?}");
    // Where psi' is negative it must not hold the wrong way.
    let off = deviations(3.4);
    assert!(off.iter().all(|x| x.is_finite() && *x > 0.0), "{off:?}");
    assert!(off[0] / off[1] < 4.0 * (0.99 / 0.85), "{off:?}");
}

/// A trace that wanders, some of it without a counterpart.
fn wandering() -> Vec<BorderPixel> {
    let px = |k: u16| 0.6 * libm::sinf(f32::from(k) / 5.0) + 0.3 * libm::cosf(f32::from(k * k));
    let sample = |k: u16| BorderPixel {
        column: 30 + 2 * (k % 40),
        row: 30 + 3 * (k / 40),
        slope: [5, 2],
        weight: 0.8 + 0.1 * f32::from(k % 5),
        near: 500.0,
        far: 520.0,
        residual: match k % 17 {
            0 => Residual::Missing,
            _ => Residual::Px(px(k)),
        }
        .into(),
    };
    (0..160).map(sample).collect()
}

fn jacobian(sample: &BorderPixel) -> [f32; 6] {
    let (x, y) = (f32::from(sample.column), f32::from(sample.row));
    [1.0, x / 50.0, y / 30.0, x * y / 900.0, -0.5, x * x / 2000.0]
}

/// Oracle: every pair of samples both ways, in 64 bits.
fn over_all_pairs(border: &[BorderPixel], loss: Loss, alike: &Correlation) -> Sums {
    let add = |to: &mut Matrix6, one: &BorderPixel, other: &BorderPixel, by: f64| {
        let (a, b) = (jacobian(one).map(f64::from), jacobian(other).map(f64::from));
        for (row, a) in to.iter_mut().zip(a) {
            for (sum, b) in row.iter_mut().zip(b) {
                *sum += by * a * b;
            }
        }
    };
    let mut sums = Sums::default();
    for (index, one) in border.iter().enumerate() {
        let (Some(px), l) = (one.residual_px(), f64::from(one.weight)) else {
            continue;
        };
        let second = f64::from(loss.curvature(px));
        sums.length += l;
        sums.curvature += l * second;
        add(&mut sums.information, one, one, l);
        add(&mut sums.holding, one, one, l * second);
        add(&mut sums.spread, one, one, l * l * f64::from(alike.bins[0]));
        for (_, other, covariance) in alike.after(border, index) {
            let by = l * f64::from(other.weight) * f64::from(covariance);
            add(&mut sums.spread, one, other, by);
            add(&mut sums.spread, other, one, by);
        }
    }
    let stretch = f64::from(alike.stretch_px());
    sums.stretches = sums.length / stretch;
    sums.noise = sums.length * stretch * f64::from(alike.bins[0]);
    sums
}

#[test]
fn sums_are_those_over_all_pairs_that_err_alike() {
    let (border, loss) = (wandering(), Loss::Cauchy(1.5));
    let mut found = Sums::default();
    let mut memory = [Projected::ZERO; 3 * 70];
    found.add(&Jacobians::new(&border, jacobian, &mut memory), loss, 6.0);
    let wanted = over_all_pairs(&border, loss, &Correlation::of(&border, loss, 6.0));
    let numbers = |of: &Sums| [of.length, of.curvature, of.stretches, of.noise];
    for (found, wanted) in numbers(&found).into_iter().zip(numbers(&wanted)) {
        assert!((found / wanted - 1.0).abs() < 1e-5, "{found} for {wanted}");
    }
    let matrices = |of: &Sums| [of.information, of.holding, of.spread];
    for (found, wanted) in matrices(&found).into_iter().zip(matrices(&wanted)) {
        for row in 0..6 {
            for column in 0..6 {
                let unit = (wanted[row][row] * wanted[column][column]).abs().sqrt();
                let off = found[row][column] - wanted[row][column];
                assert!(off.abs() < 1e-4 * unit, "{row} {column}: {off}");
            }
        }
    }
}

/// Of numbers that are held apart, by hand: each pixel of length holds 0.8 and errs by 0.3 and rounding.
#[test]
fn a_covariance_is_what_errs_by_what_holds_twice_and_wider_for_few_stretches() {
    let matrix = |value: f64| -> Matrix6 {
        core::array::from_fn(|row| {
            core::array::from_fn(|column| if row == column { value } else { 0.0 })
        })
    };
    let variance = |stretches: f64| {
        let sums = Sums {
            information: matrix(1000.0),
            holding: matrix(800.0),
            spread: matrix(300.0),
            curvature: 800.0,
            length: 1000.0,
            stretches,
            noise: 300.0,
        };
        let errors = sums.errors();
        assert!((errors.curvature - 0.8).abs() < 1e-12);
        assert!((errors.noise - 0.3 - 0.25 / 12.0).abs() < 1e-12);
        sums.covariance().expect("determined").matrix[2][2]
    };
    let by_hand = |few: f64| (300.0 * few + 1000.0 * 0.25 / 12.0) / (800.0 * 800.0);
    for (stretches, freedom) in [(106.0, 100.0), (16.0, 10.0), (10.0, 4.0), (3.0, 4.0)] {
        let few = 1.0 + 4.4 / freedom + 9.0 / (freedom * freedom);
        assert!(
            (variance(stretches) / by_hand(few) - 1.0).abs() < 1e-9,
            "{stretches}"
        );
    }
}

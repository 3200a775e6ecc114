use std::vec;
use std::vec::Vec;

use super::*;
use crate::lattice::{
    number,
    tests::{distorted, plate},
};

/// A numbered plate distorted by `strength`, each centre off by up to `noise` px.
fn beads(strength: f64, noise: f64) -> Vec<Bead> {
    let mut seed = 11u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        noise * (f64::from(seed >> 8) / f64::from(1 << 23) - 1.0)
    };
    let truth = plate(strength);
    let mut beads: Vec<Bead> = truth
        .iter()
        .map(|&(_, at)| Bead::new([at[0] + random(), at[1] + random()], None))
        .collect();
    let mut queue = vec![0; beads.len()];
    number(&mut beads, &mut queue).expect("a lattice");
    beads
}

/// Root mean square distance of corrected places inside the plate from a copy of the ideal ones that may be moved, rotated
/// and scaled: no frame of a distortion grid can tell more.
fn missed(correction: &Distortion, strength: f64) -> f64 {
    let places: Vec<Bead> = (-20..=20)
        .flat_map(|i| (-20..=20).map(move |j| [i, j]))
        .filter(|[i, j]| i * i + j * j < 420)
        .map(|index| {
            let ideal = [
                512.0 + 20.0 * f64::from(index[0]),
                512.0 + 20.0 * f64::from(index[1]),
            ];
            Bead::new(
                correction.undistorted(distorted(ideal, strength)),
                Some(index),
            )
        })
        .collect();
    let lattice = UndistortedLattice::nearest_to(&places);
    root_mean_square(places.iter().map(|place| square(lattice.residual(place))))
}

#[test]
fn a_known_distortion_is_recovered_to_less_than_a_twentieth_of_a_pixel() {
    for strength in [0.0, 0.03, 0.06, 0.08] {
        let exact = fit(&mut beads(strength, 0.0), (1024, 1024)).expect("fits");
        assert!(
            missed(&exact.distortion, strength) < 0.05,
            "{strength}: {} px",
            missed(&exact.distortion, strength)
        );
        assert_eq!(exact.dropped, 0);
        let noisy = fit(&mut beads(strength, 0.1), (1024, 1024)).expect("fits");
        assert!(
            missed(&noisy.distortion, strength) < 0.05,
            "{strength}: {} px, noisy",
            missed(&noisy.distortion, strength)
        );
        // Uniform noise of +-0.1 in both coordinates is 0.082 px.
        assert!((0.06..0.1).contains(&noisy.after_px), "{}", noisy.after_px);
        assert!(strength < 0.01 || noisy.before_px > 1.0);
    }
}

#[test]
fn there_and_back_is_the_same_place() {
    let correction = fit(&mut beads(0.1, 0.05), (1024, 1024))
        .expect("fits")
        .distortion;
    for k in 0..100 {
        let at = [
            40.0 + 9.4 * f64::from(k),
            980.0 - 9.1 * f64::from((k * 37) % 100),
        ];
        let [column, row] = correction
            .distorted(correction.undistorted(at))
            .expect("inside");
        assert!((column - at[0]).abs() < 1e-6 && (row - at[1]).abs() < 1e-6);
    }
    let again = Distortion::from_numbers(&correction.numbers());
    assert_eq!(again, Ok(correction));
}

#[test]
fn cross_validation_takes_the_order_that_is_worth_it() {
    // Without distortion there is only noise in every order, and the lowest is chosen.
    assert_eq!(
        fit(&mut beads(0.0, 0.1), (1024, 1024))
            .expect("fits")
            .distortion
            .order(),
        3
    );
    // The inverse of a cubic distortion has higher terms: seen without noise.
    let strong = fit(&mut beads(0.08, 0.0), (1024, 1024)).expect("fits");
    assert_eq!(strong.distortion.order(), 5);
    let [three, four, five] = strong
        .left_out_px
        .map(|residual| residual.expect("enough beads"));
    assert!(
        five < 0.3 * three && five < 0.3 * four,
        "{three} {four} {five}"
    );
}

#[test]
fn beads_that_are_far_off_are_dropped_and_counted() {
    let mut some = beads(0.05, 0.05);
    for k in [40, 90, 200] {
        some[k].at[0] += 3.0;
    }
    let found = fit(&mut some, (1024, 1024)).expect("fits");
    assert_eq!(found.dropped, 3);
    assert!(found.after_px < 0.06 && missed(&found.distortion, 0.05) < 0.05);
}

#[test]
fn too_few_or_lined_up_beads_are_refused() {
    let mut few = beads(0.05, 0.0);
    few.truncate(15);
    assert!(matches!(
        fit(&mut few, (1024, 1024)),
        Err(DistortionError::FewBeads { .. })
    ));
    let mut line: Vec<Bead> = (0..40)
        .map(|i| Bead::new([f64::from(i) * 20.0 + 100.0, 300.0], Some([i, 0])))
        .collect();
    assert!(matches!(
        fit(&mut line, (1024, 1024)),
        Err(DistortionError::Degenerate { .. })
    ));
}

#[test]
fn marks_that_no_correction_brings_onto_a_lattice_are_refused() {
    let mut scattered = beads(0.05, 0.0);
    for (k, bead) in scattered.iter_mut().enumerate() {
        let turn = k as f64 * 2.4;
        bead.at = [
            bead.at[0] + 9.0 * f64::cos(turn),
            bead.at[1] + 9.0 * f64::sin(turn),
        ];
    }
    let found = fit(&mut scattered, (1024, 1024));
    assert!(
        matches!(found, Err(DistortionError::Irregular { residual_px, .. }) if residual_px > 5.0),
        "{found:?}"
    );
}

#[test]
fn numbers_that_are_no_correction_are_refused() {
    let good = fit(&mut beads(0.05, 0.0), (1024, 1024))
        .expect("fits")
        .distortion
        .numbers();
    assert!(Distortion::from_numbers(&good[1..]).is_err());
    for (place, value) in [
        (0, 9.0),
        (0, 2.5),
        (1, 0.0),
        (5, 0.0),
        (7, f64::NAN),
        (7, -1.0),
        (20, 1e9),
    ] {
        let mut bad = good;
        bad[place] = value;
        assert!(Distortion::from_numbers(&bad).is_err(), "{place}: {value}");
    }
}

use super::*;
use std::vec::Vec;

const MEASURED: Distances = Distances {
    spacing_mm: 12.0,
    source_to_detector_mm: 1200.0,
    source_to_plate_mm: 1000.0,
};

/// Beads of a plate tilted by degrees about x and y, seen by a camera of 0.35 mm pitch and this principal point (mm).
fn beads(tilt: [f64; 2], offset: [f64; 2], noise: f64) -> Vec<Bead> {
    drawn_beads(tilt, offset, noise, 5)
}

/// The same with noise by a seed, even within that many pixels to either side.
fn drawn_beads(tilt: [f64; 2], offset: [f64; 2], noise: f64, mut seed: u32) -> Vec<Bead> {
    let rotation = multiply(
        &rotation_by(&[tilt[0].to_radians(), 0.0, 0.0]),
        &multiply(
            &rotation_by(&[0.0, tilt[1].to_radians(), 0.0]),
            &rotation_by(&[0.0, 0.0, 0.2]),
        ),
    );
    let view = View {
        log_focal: f64::ln(1200.0 / 0.35),
        point: [512.0 + offset[0] / 0.35, 512.0 - offset[1] / 0.35],
        rotation,
        place: [8.0, -5.0, -1000.0],
        spacing: 12.0,
        middle: [0.0, 0.0],
    };
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        noise * (f64::from(seed >> 8) / f64::from(1 << 23) - 1.0)
    };
    let numbers = (-9..=9).flat_map(|i| (-9..=9).map(move |j| [i, j]));
    numbers
        .map(|index| {
            let ([column, row], _) = view.project(index);
            Bead::new([column + random(), row + random()], Some(index))
        })
        .collect()
}

#[test]
fn a_level_plate_gives_the_pitch_and_no_principal_point() {
    let found = camera(
        &beads([0.0, 0.0], [4.0, -2.0], 0.05),
        MEASURED,
        (1024, 1024),
    )
    .expect("fits");
    assert!((found.pitch_mm - 0.35).abs() < 1e-4, "{found:?}");
    assert!(!found.offset_is_measured, "{found:?}");
    assert!(
        found.tilt_deg < 0.5 && (0.03..0.06).contains(&found.residual_px),
        "{found:?}"
    );
    // The truth lies within the stated uncertainty.
    assert!(found.offset_mm[0].abs() < 10.0 && found.offset_deviation_mm[0] > 5.0);
}

#[test]
fn a_tilted_plate_gives_the_principal_point_too() {
    let found = camera(
        &beads([25.0, -20.0], [4.0, -2.0], 0.03),
        MEASURED,
        (1024, 1024),
    )
    .expect("fits");
    assert!(found.offset_is_measured, "{found:?}");
    for (axis, truth) in [4.0, -2.0].into_iter().enumerate() {
        let error = (found.offset_mm[axis] - truth).abs();
        assert!(
            error < 4.0 * found.offset_deviation_mm[axis] && error < 2.0,
            "{found:?}"
        );
    }
    assert!(
        (found.pitch_mm - 0.35).abs() < 4.0 * found.pitch_deviation_mm,
        "{found:?}"
    );
    assert!((found.tilt_deg - 31.6).abs() < 1.0, "{found:?}");
    let exact = camera(
        &beads([25.0, -20.0], [4.0, -2.0], 0.0),
        MEASURED,
        (1024, 1024),
    )
    .expect("fits");
    assert!(
        (exact.pitch_mm - 0.35).abs() < 1e-6 && (exact.offset_mm[0] - 4.0).abs() < 1e-2,
        "{exact:?}"
    );
}

/// Of many pictures of a plate pitch and principal point lie about the truth as far as is told.
#[test]
fn errors_are_as_large_as_their_standard_deviations_say() {
    const PICTURES: u32 = 60;
    let mut squares = [0.0; 3];
    for seed in 0..PICTURES {
        let beads = drawn_beads([25.0, -20.0], [4.0, -2.0], 0.1, 7919 * seed + 1);
        let found = camera(&beads, MEASURED, (1024, 1024)).expect("fits");
        let [x, y] = found.offset_mm;
        let [sd_x, sd_y] = found.offset_deviation_mm;
        let errors = [
            (found.pitch_mm - 0.35) / found.pitch_deviation_mm,
            (x - 4.0) / sd_x,
            (y + 2.0) / sd_y,
        ];
        for (sum, error) in squares.iter_mut().zip(errors) {
            *sum += error * error / f64::from(PICTURES);
        }
    }
    let all = squares.iter().sum::<f64>() / 3.0;
    assert!((0.8..1.25).contains(&sqrt(all)), "{squares:?}");
}

#[test]
fn impossible_lengths_and_lines_of_beads_are_refused() {
    let level = beads([0.0, 0.0], [0.0, 0.0], 0.0);
    let with = |change: fn(&mut Distances)| {
        let mut measured = MEASURED;
        change(&mut measured);
        camera(&level, measured, (1024, 1024))
    };
    assert!(matches!(
        with(|m| m.spacing_mm = 0.0),
        Err(DistortionError::Length { .. })
    ));
    assert!(matches!(
        with(|m| m.source_to_plate_mm = 1300.0),
        Err(DistortionError::Order { .. })
    ));
    assert!(matches!(
        camera(&level[..10], MEASURED, (1024, 1024)),
        Err(DistortionError::FewBeads { .. })
    ));
    let line: Vec<Bead> = level
        .iter()
        .copied()
        .filter(|bead| bead.index.is_some_and(|[i, _]| i == 0))
        .collect();
    let twice: Vec<Bead> = line.iter().chain(&line).copied().collect();
    assert!(camera(&twice, MEASURED, (1024, 1024)).is_err());
}

/// A pincushion of so many pixels at a corner of the frame.
fn distorted(beads: Vec<Bead>, corner_px: f64) -> Vec<Bead> {
    let moved = |bead: Bead| {
        let off = bead.at.map(|at| (at - 512.0) / 512.0);
        let grown = corner_px * (off[0] * off[0] + off[1] * off[1]) / 2.0 / 2.0_f64.sqrt();
        let at = [0, 1].map(|k| bead.at[k] + grown * off[k]);
        Bead::new(at, bead.index)
    };
    beads.into_iter().map(moved).collect()
}

#[test]
fn a_tilted_plate_is_told_from_a_distorted_picture_of_a_level_one() {
    let of = |beads: Vec<Bead>| camera(&beads, MEASURED, (1024, 1024)).expect("fits");
    for corner_px in [0.0, 8.0, 25.0] {
        for tilt in [0.0, 2.0] {
            let level = of(distorted(beads([tilt, 0.0], [4.0, -2.0], 0.05), corner_px));
            assert!(!level.is_tilted(), "{corner_px} px: {level:?}");
            assert_eq!(level.is_distorted(), corner_px > 0.0, "{level:?}");
        }
        let tilted = of(distorted(beads([10.0, 0.0], [4.0, -2.0], 0.05), corner_px));
        assert!(tilted.is_tilted(), "{corner_px} px: {tilted:?}");
    }
}

#[test]
fn beads_in_half_of_a_strongly_distorted_frame_may_look_tilted() {
    let of_half = |corner_px: f64| {
        let all = distorted(beads([0.0, 0.0], [4.0, -2.0], 0.05), corner_px);
        let half: Vec<Bead> = all.into_iter().filter(|bead| bead.at[0] < 512.0).collect();
        camera(&half, MEASURED, (1024, 1024)).expect("fits")
    };
    assert!(!of_half(14.0).is_tilted());
    assert!((of_half(25.0).tilt_deg - 4.6).abs() < 0.3);
}

/// Why it has to be told: the correction takes the tilt with the distortion, and what is left looks like a level plate's picture.
#[test]
fn the_correction_of_a_tilted_plate_makes_a_wrong_pitch_that_looks_exact() {
    for (tilt, off) in [(4.0, 0.0014), (10.0, 0.0079), (25.0, 0.049)] {
        let mut beads = beads([tilt, 0.0], [0.0, 0.0], 0.02);
        let taken = camera(&beads, MEASURED, (1024, 1024)).expect("fits");
        let corrected = crate::correction::fit(&mut beads, (1024, 1024)).expect("fits");
        for bead in &mut beads {
            *bead = Bead::new(corrected.distortion.undistorted(bead.at), bead.index);
        }
        let found = camera(&beads, MEASURED, (1024, 1024)).expect("fits");
        assert!(
            (found.pitch_mm / 0.35 - 1.0 - off).abs() < 0.1 * off,
            "{tilt} deg: {found:?}"
        );
        assert!(
            found.pitch_deviation_mm < 1e-4 && !found.is_distorted() && !found.is_tilted(),
            "{found:?}"
        );
        assert!(
            (taken.tilt_deg - tilt).abs() < 0.2 && (taken.pitch_mm - 0.35).abs() < 1e-3,
            "{taken:?}"
        );
    }
}

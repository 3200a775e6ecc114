use super::*;

use crate::joint::fake::pose;
use crate::pose::geodesic_deg;
use std::vec;
use std::vec::Vec;

fn smoothed(values: &[f64], cutoff_hz: f64, rate: f64) -> Vec<f64> {
    let filter = LowPass::new(cutoff_hz, rate).expect("possible");
    let mut values = values.to_vec();
    let mut memory = vec![0.0; LowPass::memory_needed(values.len())];
    filter.smooth(&mut values, &mut memory).expect("room");
    values
}

#[test]
fn a_cutoff_at_or_above_half_of_the_rate_is_refused() {
    assert!(matches!(
        LowPass::new(15.0, 30.0),
        Err(CutoffError::TooHigh { .. })
    ));
    assert!(matches!(
        LowPass::new(20.0, 30.0),
        Err(CutoffError::TooHigh { .. })
    ));
    assert!(matches!(
        LowPass::new(0.0, 30.0),
        Err(CutoffError::NotPositive { .. })
    ));
    assert!(matches!(
        LowPass::new(3.0, f64::NAN),
        Err(CutoffError::NotPositive { .. })
    ));
    assert!(LowPass::new(14.9, 30.0).is_ok());
}

/// At the cutoff the two passes keep the root of one half, slow waves stay, fast ones go, and none is late.
#[test]
fn it_halves_the_power_at_the_cutoff_without_lag() {
    let (rate, cutoff) = (30.0, 3.0);
    let wave = |hz: f64| -> Vec<f64> {
        (0..1200)
            .map(|k| libm::sin(core::f64::consts::TAU * hz * f64::from(k) / rate))
            .collect()
    };
    for (hz, kept) in [
        (0.3, 0.99995),
        (3.0, core::f64::consts::FRAC_1_SQRT_2),
        (12.0, 0.0002),
    ] {
        let (raw, filtered) = (wave(hz), smoothed(&wave(hz), cutoff, rate));
        let middle = 300..900;
        let both: f64 = middle.clone().map(|k| raw[k] * filtered[k]).sum();
        let own: f64 = middle.clone().map(|k| raw[k] * raw[k]).sum();
        assert!((both / own - kept).abs() < 2e-4, "{hz} Hz: {}", both / own);
        // What is not in step with the wave: nothing.
        let late: f64 = middle
            .map(|k| (filtered[k] - both / own * raw[k]).abs())
            .fold(0.0, f64::max);
        assert!(late < 1e-3, "{hz} Hz: {late}");
    }
}

#[test]
fn straight_lines_stay_and_runs_do_not_hear_of_each_other() {
    let line: Vec<f64> = (0..50).map(|k| 3.0 - 0.7 * f64::from(k)).collect();
    for (a, b) in line.iter().zip(smoothed(&line, 2.0, 15.0)) {
        assert!((a - b).abs() < 1e-5, "{a} {b}");
    }
    // Shorter than the filter remembers, too.
    for frames in 1..130 {
        let line: Vec<f64> = (0..frames).map(|k| 33.0 + 3.0 * f64::from(k)).collect();
        for (a, b) in line.iter().zip(smoothed(&line, 1.0, 30.0)) {
            let most = if frames <= 90 { 1e-9 } else { 1e-4 };
            assert!((a - b).abs() < most, "{frames}: {a} {b}");
        }
    }
    let run: Vec<f64> = (0..20).map(|k| libm::sin(f64::from(k * k))).collect();
    let joined: Vec<f64> = [
        &run[..],
        &[f64::NAN],
        &[5.0],
        &[f64::NAN, f64::NAN],
        &run[..7],
    ]
    .concat();
    let filtered = smoothed(&joined, 4.0, 30.0);
    assert_eq!(filtered[..20], smoothed(&run, 4.0, 30.0));
    assert!(filtered[20].is_nan() && filtered[22].is_nan());
    assert_eq!(
        (filtered[21], &filtered[24..]),
        (5.0, &smoothed(&run[..7], 4.0, 30.0)[..])
    );
}

/// Of a point of the model.
fn smooth_at(poses: &[Option<Pose>], middle: &Vector3) -> Vec<Option<Pose>> {
    let filter = LowPass::new(4.0, 30.0).expect("possible");
    let mut poses = poses.to_vec();
    let mut memory = vec![0.0; LowPass::pose_memory_needed(poses.len())];
    let smoothed = filter.smooth_poses(&mut poses, middle, &mut memory);
    smoothed.expect("room");
    poses
}

fn smooth(poses: &[Option<Pose>]) -> Vec<Option<Pose>> {
    smooth_at(poses, &[0.0; 3])
}

/// Frame 30 has no pose. Flexion passes the place where Euler's angles jump.
fn film() -> Vec<Option<Pose>> {
    (0..60u32)
        .map(|k| {
            let t = f64::from(k);
            let jitter = |seed: f64| 0.8 * libm::sin(seed * t * t);
            let turns = [
                150.0 + t + jitter(1.3),
                20.0 * libm::sin(t / 9.0),
                3.0 + jitter(2.1),
            ];
            (k != 30).then(|| pose([t + jitter(0.7), 4.0, -1000.0 + 3.0 * jitter(3.7)], turns))
        })
        .collect()
}

/// The filtered film is the same film in whatever axes it was filtered.
#[test]
fn axes_of_camera_and_model_drop_out() {
    let film = film();
    let plain = smooth(&film);
    assert!(plain[30].is_none() && plain[29].is_some());
    let camera = pose([0.0; 3], [40.0, -70.0, 110.0]);
    let model = pose([0.0; 3], [-95.0, 33.0, 10.0]);
    let moved: Vec<_> = film
        .iter()
        .map(|pose| pose.map(|pose| camera.compose(&pose).compose(&model)))
        .collect();
    let mut changed = 0.0f64;
    for ((a, b), raw) in plain.iter().zip(smooth(&moved)).zip(&film) {
        let (Some(a), Some(b), Some(raw)) = (a, b, raw) else {
            continue;
        };
        let a_there = camera.compose(a).compose(&model);
        assert!(geodesic_deg(&a_there.rotation, &b.rotation) < 1e-6);
        for (x, y) in a_there.translation.iter().zip(b.translation) {
            assert!((x - y).abs() < 1e-9);
        }
        assert!(a.is_rigid(1e-9));
        changed = changed.max(geodesic_deg(&a.rotation, &raw.rotation));
    }
    assert!(changed > 0.3, "{changed}");
}

/// Of a model whose file has its origin elsewhere, as one that was cut out of a scan, the filtered film is the same.
#[test]
fn the_origin_of_a_models_file_drops_out() {
    let film = film();
    let middle = [3.0, -8.0, 2.0];
    let plain = smooth_at(&film, &middle);
    let origin = pose([90.0, -250.0, 140.0], [20.0, -70.0, 15.0]);
    let there = |pose: &Option<Pose>| pose.map(|pose| pose.compose(&origin));
    let moved: Vec<_> = film.iter().map(there).collect();
    let found = smooth_at(&moved, &origin.inverse().transform(&middle));
    for (a, b) in plain.iter().map(there).zip(found) {
        let (Some(a), Some(b)) = (a, b) else {
            continue;
        };
        assert!(geodesic_deg(&a.rotation, &b.rotation) < 1e-6);
        for (x, y) in a.translation.iter().zip(b.translation) {
            assert!((x - y).abs() < 1e-9, "{x} {y}");
        }
    }
}

#[test]
fn about_one_axis_it_filters_the_angle() {
    let angles: Vec<f64> = (0..40)
        .map(|k| 100.0 + 2.5 * f64::from(k) + libm::sin(f64::from(k * k)))
        .collect();
    let film: Vec<_> = angles
        .iter()
        .map(|&z| Some(pose([1.0; 3], [z, 0.0, 0.0])))
        .collect();
    let wanted = smoothed(&angles, 4.0, 30.0);
    for (found, wanted) in smooth(&film).iter().flatten().zip(wanted) {
        let wanted = pose([1.0; 3], [wanted, 0.0, 0.0]);
        assert!(geodesic_deg(&found.rotation, &wanted.rotation) < 1e-6);
    }
}

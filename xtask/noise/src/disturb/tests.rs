//! What a disturbance does to shapes whose outline is known.

use super::*;

const SIDE: usize = 400;

fn drawn(side: usize, inside: impl Fn(f64, f64) -> bool) -> MaskBuffer {
    let mut buffer = MaskBuffer::new(side, side).unwrap();
    buffer.draw(|mask| {
        for row in 0..side {
            for column in 0..side {
                mask.set(column, row, inside(column as f64 + 0.5, row as f64 + 0.5));
            }
        }
    });
    buffer
}

fn disc(side: usize, centre: [f64; 2], radius: f64) -> MaskBuffer {
    drawn(side, |c, r| {
        libm::hypot(c - centre[0], r - centre[1]) < radius
    })
}

/// An L with sharp corners, one of them pointing inwards, and a square hole.
fn bracket() -> MaskBuffer {
    drawn(SIDE, |c, r| {
        let within = |v: f64, low: f64, high: f64| (low..high).contains(&v);
        let arm = within(c, 60.0, 340.0) && within(r, 60.0, 160.0);
        let foot = within(c, 60.0, 160.0) && within(r, 60.0, 330.0);
        let hole = within(c, 90.0, 130.0) && within(r, 90.0, 130.0);
        (arm || foot) && !hole
    })
}

/// What tracing and filling without any noise makes of a mask.
fn traced(mask: &MaskBuffer) -> MaskBuffer {
    let options = DisturbanceOptions::default();
    let curves = options.curves(&mask.mask(), 1).unwrap();
    let size = [mask.mask().width(), mask.mask().height()];
    options
        .jittered(&curves, size, &mut options.random(0))
        .unwrap()
}

fn jitter(jitter: f64, correlation: f64) -> DisturbanceOptions {
    DisturbanceOptions {
        jitter,
        correlation,
        ..DisturbanceOptions::default()
    }
}

fn hidden(fraction: f64) -> DisturbanceOptions {
    DisturbanceOptions {
        occlude: fraction,
        ..DisturbanceOptions::default()
    }
}

#[test]
fn tracing_without_noise_keeps_area_extremes_and_holes() {
    for centre in [[200.0, 200.0], [197.3, 201.8]] {
        for radius in [8.2, 40.0, 151.7] {
            let mask = disc(SIDE, centre, radius);
            let found = traced(&mask);
            let (area, kept) = (mask.mask().area() as f64, found.mask().area() as f64);
            // Under a fiftieth of a pixel of the radius, and no more than one pixel in 25 of the
            // border on the other side.
            let shift = (kept - area) / (std::f64::consts::TAU * radius);
            assert!(shift.abs() < 0.02, "radius {radius}: {shift} px");
            let differ = found.mask().unmatched(&mask.mask()).unwrap() as f64;
            assert!(differ < 0.25 * radius + 4.0, "radius {radius}: {differ}");
            assert_eq!(found.mask().bounds(), mask.mask().bounds(), "{radius}");
        }
    }
    let mask = bracket();
    let found = traced(&mask);
    // Ten corners; each may lose a pixel or two.
    assert!(found.mask().unmatched(&mask.mask()).unwrap() <= 20);
    assert_eq!(found.mask().bounds(), mask.mask().bounds());
    assert!(!found.mask().get(110, 110) && found.mask().get(80, 110));
}

#[test]
fn specks_and_what_the_frame_cuts_off_survive_tracing() {
    let mut mask = disc(SIDE, [0.0, 200.0], 90.0);
    let speck = drawn(SIDE, |c, r| {
        (c - 300.5).abs() < 0.9 && (r - 50.5).abs() < 0.9
    });
    assert_eq!(speck.mask().area(), 1);
    mask = mask.combined(&speck, |a, b| a | b).unwrap();
    let options = jitter(2.0, 10.0);
    let found = options.disturb(&mask.mask(), None, 3).unwrap().mask;
    // Along the frame's border nothing is moved: all pixels there but those near the crossings.
    assert!((120..280).all(|row| found.mask().get(0, row)));
    let plain = traced(&mask);
    assert!(plain.mask().get(300, 50) && !plain.mask().get(302, 50));
}

/// Radii of a mask at 720 directions from a centre, and the way between two, pixels.
fn radii(mask: &MaskBuffer, centre: [f64; 2], from: f64) -> Vec<f64> {
    let step = 0.02;
    let mask = mask.mask();
    let inside = |sine: f64, cosine: f64, radius: f64| {
        let (c, r) = (centre[0] + radius * cosine, centre[1] + radius * sine);
        mask.get(c as usize, r as usize)
    };
    let at = |k: u32| {
        let (sine, cosine) = libm::sincos(f64::from(k) * std::f64::consts::PI / 360.0);
        let steps = (0..2000).find(|&n| !inside(sine, cosine, from + step * f64::from(n)));
        from + step * f64::from(steps.unwrap())
    };
    (0..720).map(at).collect()
}

#[test]
fn a_discs_radius_is_displaced_as_was_asked_for() {
    let (centre, radius, deviation, length) = ([200.0, 200.0], 160.0, 1.5, 10.0);
    let options = jitter(deviation, length);
    let fine = disc(
        FINE * SIDE,
        centre.map(|c| c * FINE as f64),
        radius * FINE as f64,
    );
    let way = radius * std::f64::consts::PI / 360.0;
    // Whole numbers of directions nearest to 0, 10, 14 and 30 px.
    let lags = [0usize, 7, 10, 21];
    let (mut sums, mut mean, drawings) = ([0.0; 4], 0.0, 60);
    let curves = options.curves(&fine.mask(), FINE).unwrap();
    for frame in 0..drawings {
        let mut random = options.random(frame);
        let found = options
            .jittered(&curves, [SIDE, SIDE], &mut random)
            .unwrap();
        let radii = radii(&found, centre, radius - 20.0);
        let off = |k: usize| radii[k % 720] - radius;
        mean += (0..720).map(off).sum::<f64>() / (720.0 * drawings as f64);
        for (sum, lag) in sums.iter_mut().zip(lags) {
            let products = (0..720).map(|k| off(k) * off(k + lag));
            *sum += products.sum::<f64>() / (720.0 * drawings as f64);
        }
    }
    // About 60 * 1005 / 25 independent places: 2400, so 3 % of a variance is one standard error.
    assert!(mean.abs() < 0.12, "{mean}");
    let rounding = 1.0 / 12.0;
    for (sum, lag) in sums.iter().zip(lags) {
        let t = lag as f64 * way / length;
        let own = if lag == 0 { rounding } else { 0.0 };
        let wanted = deviation * deviation * libm::exp(-t * t / 2.0) + own;
        assert!((sum - wanted).abs() < 0.09 * 2.25, "{lag}: {sum} {wanted}");
    }
}

#[test]
fn outlines_that_cross_themselves_are_filled_and_not_given_up() {
    let mask = bracket();
    let clean = traced(&mask);
    // Steep noise at sharp corners: about every corner's normals cross.
    let options = jitter(4.0, 3.0);
    for frame in 0..20 {
        let found = options.disturb(&mask.mask(), None, frame).unwrap().mask;
        let differ = found.mask().unmatched(&clean.mask()).unwrap() as f64;
        // Mean of a normal number's absolute value: 0.8 standard deviations along 1260 px.
        let wanted = 0.8 * 4.0 * 1260.0;
        assert!((differ / wanted - 1.0).abs() < 0.3, "{differ} {wanted}");
        let area = found.mask().area() as f64 / mask.mask().area() as f64;
        assert!((area - 1.0).abs() < 0.05, "{area}");
    }
}

#[test]
fn occluders_hide_the_part_that_was_asked_for() {
    for (mask, fraction) in [(disc(SIDE, [190.0, 210.0], 120.0), 0.25), (bracket(), 0.3)] {
        let options = hidden(fraction);
        let curves = options.curves(&mask.mask(), 1).unwrap();
        let (mut solid, mut hollow) = (0, 0);
        for frame in 0..30 {
            let found = options.disturb(&mask.mask(), None, frame).unwrap();
            let unknown = found.unknown.unwrap();
            let (mut part, mut whole) = (0.0, 0.0);
            for curve in &curves {
                for (point, length) in curve.points.iter().zip(curve.lengths()) {
                    whole += length;
                    let (column, row) = (point.column as usize, point.row as usize);
                    part += length * f64::from(u8::from(unknown.mask().get(column, row)));
                }
            }
            assert!((part / whole - fraction).abs() < 0.03, "{}", part / whole);
            // Only what is hidden has changed.
            let known = |m: &MaskBuffer| m.combined(&unknown, |m, u| m & !u).unwrap();
            let (kept, before) = (known(&found.mask), known(&mask));
            assert_eq!(kept.mask().unmatched(&before.mask()), Some(0));
            solid += u32::from(found.mask.mask().area() > mask.mask().area());
            hollow += u32::from(found.mask.mask().area() < mask.mask().area());
        }
        assert!(solid >= 8 && hollow >= 8, "{solid} solid, {hollow} hollow");
    }
}

#[test]
fn one_seed_gives_one_disturbance_and_frames_differ() {
    let mask = disc(SIDE, [190.0, 210.0], 120.0);
    let options = DisturbanceOptions {
        occlude: 0.2,
        ..jitter(1.0, 10.0)
    };
    let words = |frame| {
        let found = options.disturb(&mask.mask(), None, frame).unwrap();
        found.mask.mask().words().to_vec()
    };
    assert_eq!(words(4), words(4));
    assert_ne!(words(4), words(5));
    let unmarked = DisturbanceOptions {
        unmarked: true,
        ..options
    };
    let found = unmarked.disturb(&mask.mask(), None, 4).unwrap();
    assert!(found.unknown.is_none());
    assert_eq!(found.mask.mask().words(), words(4));
    // What was unknown before stays so.
    let corner = disc(SIDE, [0.0, 0.0], 30.0);
    let found = unmarked
        .disturb(&mask.mask(), Some(&corner.mask()), 4)
        .unwrap();
    assert_eq!(found.unknown.unwrap().mask().words(), corner.mask().words());
}

#[test]
fn impossible_numbers_are_named() {
    let message = |options: DisturbanceOptions| options.check().unwrap_err().to_string();
    assert!(message(jitter(-1.0, 10.0)).contains("--jitter"));
    assert!(message(jitter(1.0, 0.0)).contains("--correlation"));
    assert!(message(hidden(f64::NAN)).contains("--occlude"));
    assert!(DisturbanceOptions::default().check().is_ok());
}

/// A seed without what it is for would change nothing, and nobody would know.
#[test]
fn a_seed_is_of_jitter_or_occluders() {
    use clap::Parser as _;
    #[derive(clap::Parser)]
    struct Line {
        #[command(flatten)]
        options: DisturbanceOptions,
    }
    let read = |words: &str| Line::try_parse_from(format!("x {words}").split_whitespace());
    for words in [
        "",
        "--jitter 1 --noise-seed 3",
        "--occlude 0.1 --noise-seed 3",
        "--jitter 1 --occlude 0.1",
    ] {
        assert!(read(words).is_ok(), "{words}");
    }
    let told = read("--noise-seed 3").err().map(|error| error.to_string());
    let told = told.expect("refused");
    assert!(
        told.contains("--jitter") && told.contains("--occlude"),
        "{told}"
    );
    let both = read("--jitter 1 --occlude 0.1 --noise-seed 3").map(|line| line.options);
    assert_eq!(
        both.map(|options| (options.jitter, options.noise_seed))
            .ok(),
        Some((1.0, 3))
    );
}

use super::*;
use std::vec;
use std::vec::Vec;

/// A frame of discs of depth 90 with soft edges on a slope of brightness, with noise of +-4.
fn picture(centres: &[(f64, f64)], radius: f64, bright: bool) -> Vec<u16> {
    let mut seed = 7u32;
    let mut pixels = vec![0u16; 200 * 160];
    for (index, pixel) in pixels.iter_mut().enumerate() {
        let (column, row) = ((index % 200) as f64 + 0.5, (index / 200) as f64 + 0.5);
        let mut grey = 400.0 + 0.5 * column - 0.3 * row;
        for &(c, r) in centres {
            let away = f64::hypot(column - c, row - r) - radius;
            let depth = 90.0 / (1.0 + f64::exp(2.0 * away));
            grey += if bright { depth } else { -depth };
        }
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *pixel = (grey + f64::from(seed >> 24) / 32.0 - 4.0) as u16;
    }
    pixels
}

const CENTRES: [(f64, f64); 20] = {
    let mut out = [(0.0, 0.0); 20];
    let mut k = 0;
    while k < 20 {
        out[k] = (25.3 + 37.1 * (k % 5) as f64, 24.7 + 36.43 * (k / 5) as f64);
        k += 1;
    }
    out
};

#[test]
fn centres_are_found_to_a_few_hundredths_of_a_pixel() {
    for bright in [false, true] {
        for radius in [3.0, 6.0] {
            let pixels = picture(&CENTRES, radius, bright);
            let frame = Frame::new(&pixels, 200, 160, 200).expect("fits");
            let mut sums = vec![0; sums_needed(200, 160)];
            let mut out = [Disc::default(); 64];
            let search = DiscSearch {
                radius_px: radius,
                bright,
            };
            let found = find(&frame, search, &mut sums, &mut out).expect("fits");
            assert_eq!(found, CENTRES.len(), "radius {radius}, bright {bright}");
            let mut squares = 0.0;
            for &(column, row) in &CENTRES {
                let away = out[..found]
                    .iter()
                    .map(|d| f64::hypot(d.column - column, d.row - row));
                let nearest = away.fold(f64::INFINITY, f64::min);
                assert!(nearest < 0.12, "{nearest} px at {column}, {row}");
                squares += nearest * nearest;
            }
            let rms = f64::sqrt(squares / CENTRES.len() as f64);
            assert!(rms < 0.06, "{rms} px RMS, radius {radius}");
        }
    }
}

#[test]
fn what_is_not_round_is_left_out() {
    let mut pixels = picture(&CENTRES[..19], 4.0, false);
    for row in 60..64 {
        for column in 60..110 {
            pixels[row * 200 + column] = 200;
        }
    }
    let frame = Frame::new(&pixels, 200, 160, 200).expect("fits");
    let mut sums = vec![0; sums_needed(200, 160)];
    let mut out = [Disc::default(); 64];
    let search = DiscSearch {
        radius_px: 4.0,
        bright: false,
    };
    let found = find(&frame, search, &mut sums, &mut out).expect("fits");
    for disc in &out[..found] {
        let known = CENTRES
            .iter()
            .any(|&(c, r)| f64::hypot(disc.column - c, disc.row - r) < 0.3);
        assert!(known, "{disc:?}");
    }
    assert!(found >= 17, "{found}: a bar may hide two beads, no more");
}

#[test]
fn short_memory_and_odd_radii_are_refused_and_an_empty_picture_holds_nothing() {
    let pixels = [100u8; 60 * 40];
    let frame = Frame::new(&pixels, 60, 40, 60).expect("fits");
    let mut out = [Disc::default(); 8];
    let search = |radius_px| DiscSearch {
        radius_px,
        bright: false,
    };
    let mut sums = vec![0; sums_needed(60, 40)];
    assert_eq!(find(&frame, search(3.0), &mut sums, &mut out), Ok(0));
    assert_eq!(find(&frame, search(60.0), &mut sums, &mut out), Ok(0));
    assert!(matches!(
        find(&frame, search(0.2), &mut sums, &mut out),
        Err(DistortionError::Radius(_))
    ));
    assert!(matches!(
        find(&frame, search(f64::NAN), &mut sums, &mut out),
        Err(DistortionError::Radius(_))
    ));
    assert!(matches!(
        find(&frame, search(3.0), &mut sums[..100], &mut out),
        Err(DistortionError::Memory(_))
    ));
}

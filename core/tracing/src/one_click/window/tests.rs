use super::*;
use crate::one_click::background::BACKGROUND;
use fluoropose::image::frame::Frame;
use fluoropose::image::mask::MaskMut;
use fluoropose::image::shuttered::Shuttered;

#[test]
fn a_window_is_cut_to_the_frame_and_numbers_its_pixels() {
    let window = Window::cut([-5.0, 3.2, 6.9, 99.0], (20, 10));
    let whole = Window {
        left: 0,
        top: 3,
        width: 7,
        height: 7,
    };
    assert_eq!(window, whole);
    assert_eq!(window.place(window.index(6.5, 4.5)), (6, 1));
    assert_eq!(window.index(50.0, -3.0), 6);
    let mut seen = std::vec::Vec::new();
    window.neighbours(0, |index| seen.push(index));
    window.neighbours(8, |index| seen.push(index));
    assert_eq!(seen, [1, 7, 1, 7, 9, 15]);
    assert_eq!(Window::cut([30.0, 0.0, 40.0, 1.0], (20, 10)).width, 1);
}

/// A dark square on a ramp, and the same frame with its greys inverted.
fn pixels(inverted: bool) -> std::vec::Vec<u16> {
    (0..64 * 64)
        .map(|k| {
            let (column, row) = (k % 64, k / 64);
            let inside = (20..40).contains(&column) && (20..40).contains(&row);
            let value = if inside { 900 } else { 3000 + 4 * column };
            if inverted { 4095 - value } else { value }
        })
        .collect()
}

#[test]
fn what_is_not_of_the_picture_is_no_step() {
    let grey = [5, 900, BLOCKED];
    let steps = [[0, 1], [1, 0], [0, 2], [2, 1], [1, 9]].map(|[a, b]| step_between(&grey, a, b));
    assert_eq!(steps, [895, -895, 0, 0, 0]);
}

#[test]
fn either_polarity_gives_the_same_picture() {
    let window = Window::cut([0.0, 0.0, 63.0, 63.0], (64, 64));
    let picture = |polarity: Polarity, inverted: bool| {
        let pixels = self::pixels(inverted);
        let frame = Frame::new(&pixels, 64, 64, 64).expect("fits");
        let mut grey = std::vec![0; window.pixels()];
        let mut histogram = [0; LEVELS];
        let how = Reading {
            polarity,
            smoothing: 2,
            against: None,
        };
        let step = levels(&frame, &window, how, None, &mut grey, &mut histogram);
        (grey, step)
    };
    let (dark, step) = picture(Polarity::DarkImplant, false);
    let (bright, other) = picture(Polarity::BrightImplant, true);
    assert_eq!(step, other);
    let differ = dark.iter().zip(&bright).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(differ <= Some(1), "{differ:?}");
    assert_eq!(dark[30 * 64 + 30], 0);
    // A level stands for the range of greys divided by the number of levels.
    assert!((step - (3252.0 - 900.0) / 1023.0).abs() < 0.1, "{step}");
}

#[test]
fn against_the_background_metal_is_alike_however_thick_the_limb_before_it() {
    const SIDE: usize = 96;
    // The limb grows thicker to the left, to a tenth of the light; metal takes three tenths of what is left.
    let inside = |k: usize| (20..76).contains(&(k % SIDE)) && (40..56).contains(&(k / SIDE));
    let pixels: std::vec::Vec<u16> = (0..SIDE * SIDE)
        .map(|k| {
            let limb = 40_000.0 * libm::pow(0.1, 1.0 - (k % SIDE) as f64 / SIDE as f64);
            (if inside(k) { 0.7 * limb } else { limb }) as u16
        })
        .collect();
    let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
    let window = Window::cut([0.0, 0.0, 95.0, 95.0], (SIDE, SIDE));
    let (mut grey, mut memory) = (std::vec![0; window.pixels()], [0; BACKGROUND]);
    let how = Reading {
        polarity: Polarity::DarkImplant,
        smoothing: 0,
        against: Some(40.0),
    };
    levels(&frame, &window, how, None, &mut grey, &mut memory);
    let step = |column: usize| {
        let at = |row: usize| f64::from(grey[row * SIDE + column]);
        at(20) - at(48)
    };
    let (thick, thin) = (step(28), step(68));
    assert!(thick > 0.5 * thin, "{thick} {thin}");
}

#[test]
fn what_is_behind_a_shutter_is_blocked_and_changes_nothing_before_it() {
    const SIDE: usize = 64;
    let window = Window::cut([0.0, 0.0, 63.0, 63.0], (SIDE, SIDE));
    let is_open = |k: usize| {
        let (right, down) = ((k % SIDE) as f64 - 30.0, (k / SIDE) as f64 - 33.0);
        libm::hypot(right, down) < 26.0
    };
    let mut words = [0; 2 * SIDE];
    let mut behind = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
    let covered = (0..SIDE * SIDE).filter(|&k| !is_open(k));
    covered.for_each(|k| behind.set(k % SIDE, k / SIDE, true));
    let how = Reading {
        polarity: Polarity::DarkImplant,
        smoothing: 2,
        against: Some(30.0),
    };
    let read = |beyond: u16, inverted: bool| {
        let mut pixels = self::pixels(inverted);
        let hidden = (0..SIDE * SIDE).filter(|&k| !is_open(k));
        hidden.for_each(|k| pixels[k] = beyond);
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
        let shuttered = Shuttered::new(frame, &words).expect("same size");
        let (mut grey, mut memory) = (std::vec![0; window.pixels()], [0; BACKGROUND]);
        let polarity = Polarity::of(inverted);
        let how = Reading { polarity, ..how };
        levels(&shuttered, &window, how, None, &mut grey, &mut memory);
        grey
    };
    for inverted in [false, true] {
        let grey = read(0, inverted);
        assert_eq!(grey, read(4095, inverted));
        for (k, &level) in grey.iter().enumerate() {
            assert_eq!(level == BLOCKED, !is_open(k), "{k}");
            let (column, row) = (k % SIDE, k / SIDE);
            let near_metal = (14..46).contains(&column) && (14..46).contains(&row);
            // The ramp is as bright at the shutter as elsewhere.
            assert!(level > 900 || near_metal, "{column} {row}: {level}");
        }
    }
}

#[test]
fn excluded_pixels_are_blocked_and_a_uniform_window_has_no_step() {
    let window = Window::cut([0.0, 0.0, 31.0, 3.0], (32, 4));
    let words = [0b10, 0, 0, 0];
    let excluded = Mask::new(&words, 32, 4).expect("valid");
    let pixels: [u8; 128] = core::array::from_fn(|k| k as u8);
    let frame = Frame::new(&pixels, 32, 4, 32).expect("fits");
    let (mut grey, mut histogram) = ([0; 128], [0; LEVELS]);
    let how = Reading {
        polarity: Polarity::DarkImplant,
        smoothing: 0,
        against: None,
    };
    assert!(
        levels(
            &frame,
            &window,
            how,
            Some(&excluded),
            &mut grey,
            &mut histogram
        ) > 0.0
    );
    assert_eq!(grey.iter().filter(|&&value| value == BLOCKED).count(), 1);
    assert_eq!(grey[1], BLOCKED);
    let flat = [7u8; 128];
    let frame = Frame::new(&flat, 32, 4, 32).expect("fits");
    assert_eq!(
        levels(&frame, &window, how, None, &mut grey, &mut histogram),
        0.0
    );
}

#[test]
fn logarithms_keep_the_ends_of_the_scale_and_the_part_of_light_that_metal_takes() {
    let mut grey = [0, 4000, 8000, 30_000, 60_000, u16::MAX];
    let old = grey;
    let steepest = to_logarithms(&mut grey);
    assert_eq!((grey[0], grey[5]), (0, u16::MAX));
    // A sixteenth of the scale is light that nothing takes.
    let light = |grey: u16| f64::from(grey) + f64::from(u16::MAX) / 16.0;
    let scale = f64::from(u16::MAX) / f64::ln(17.0);
    for (new, old) in grey.windows(2).zip(old.windows(2)) {
        let expected = scale * f64::ln(light(old[1]) / light(old[0]));
        assert!(
            (f64::from(new[1] - new[0]) - expected).abs() < 1.5,
            "{old:?}"
        );
    }
    assert!((steepest - scale / light(0)).abs() < 1e-9);
}

/// Oracle: row by row, then column by column, the last pixel again at each border.
#[test]
fn a_pass_of_the_filter_is_a_binomial_in_both_directions() {
    let window = Window {
        left: 3,
        top: 4,
        width: 7,
        height: 5,
    };
    let grey: std::vec::Vec<u16> = (0..35).map(|k| (k * k * 499 % 60_000) as u16).collect();
    let pass = |grey: &[u16], step: usize, at: fn(usize) -> usize, length: usize| {
        let mean = |k: usize| {
            let here = at(k);
            let before = if here == 0 { k } else { k - step };
            let after = if here + 1 == length { k } else { k + step };
            let [a, b, c] = [before, k, after].map(|k| u32::from(grey[k]));
            ((a + 2 * b + c + 2) / 4) as u16
        };
        (0..grey.len()).map(mean).collect::<std::vec::Vec<u16>>()
    };
    let rows = pass(&grey, 1, |k| k % 7, 7);
    let expected = pass(&rows, 7, |k| k / 7, 5);
    let mut found = grey;
    smooth(&mut found, &window);
    assert_eq!(found, expected);
}

#[test]
fn the_ends_of_the_scale_leave_out_a_few_pixels() {
    // Of 20 000 pixels ten at each end are few.
    let grey = |outside: usize| {
        let pixel = |k: usize| match k {
            k if k < outside => 0,
            k if k >= 20_000 - outside => 65_000,
            k => 10_000 + (k % 10_000) as u16,
        };
        (0..20_000).map(pixel).collect::<std::vec::Vec<u16>>()
    };
    let mut histogram = std::vec![7; 1024];
    let (dark, bright) = ends(&grey(5), &mut histogram);
    assert!((10_000 - 64..=10_000).contains(&dark), "{dark}");
    assert!((20_000 - 64..=20_000 + 64).contains(&bright), "{bright}");
    let (dark, bright) = ends(&grey(50), &mut histogram);
    assert_eq!(dark, 0);
    assert!(bright >= 65_000, "{bright}");
    // Of one value alone both ends are told.
    let (dark, bright) = ends(&[500; 100], &mut histogram);
    assert!(
        dark < bright && dark <= 500 && bright > 500,
        "{dark} {bright}"
    );
}

#[test]
fn what_is_not_of_the_picture_is_as_the_nearest_that_is() {
    let (columns, rows) = (7, 6);
    let window = Window {
        left: 0,
        top: 0,
        width: columns,
        height: rows,
    };
    let own = |index: usize| 100 + 3 * index as u16;
    // Some seen, by chance; more and fewer of them, and whole rows without any.
    for seed in 0..400_u32 {
        let mixed = |k: usize| (seed * 2_654_435 + k as u32 * 40_503).wrapping_mul(2_246_822_519);
        let is_seen = |k: usize| mixed(k / columns + 90) % 3 > 0 && mixed(k) >> 29 <= seed % 8;
        let mut grey: std::vec::Vec<u16> = (0..window.pixels()).map(own).collect();
        repeat_borders(&mut grey, &window, is_seen);
        let nearest = |row: usize| {
            let seen = (0..rows).filter(|row| (0..columns).any(|c| is_seen(row * columns + c)));
            // Of two as near the one below.
            seen.min_by_key(|&other| (other.abs_diff(row), rows - other))
        };
        for (index, &value) in grey.iter().enumerate() {
            let (column, row) = (index % columns, index / columns);
            let expected = nearest(row).map_or(index, |row| {
                let seen = (0..columns).filter(|c| is_seen(row * columns + c));
                let at = seen.min_by_key(|&other| (other.abs_diff(column), columns - other));
                row * columns + at.expect("the row has one")
            });
            assert_eq!(value, own(expected), "seed {seed}, {column}, {row}");
        }
    }
}

/// Oracle: of each pixel the nearest in its row that is seen, of rows without one the nearest row; of two as near the later one.
#[test]
fn what_is_not_seen_repeats_the_nearest_that_is() {
    let (width, height) = (9, 7);
    let window = Window {
        left: 0,
        top: 0,
        width,
        height,
    };
    let nearest = |at: usize, seen: &[usize]| {
        let away = |other: &&usize| (other.abs_diff(at), usize::MAX - **other);
        seen.iter().min_by_key(away).copied()
    };
    for case in 1..200usize {
        // Few rows have any, and few pixels of these.
        let is_seen = |index: usize| {
            let row = index / width;
            (row * row * 5 + case).is_multiple_of(3) && (index * index * 7 + case * index) % 5 < 2
        };
        let given: std::vec::Vec<u16> = (0..width * height).map(|k| 100 + k as u16).collect();
        let mut grey = given.clone();
        repeat_borders(&mut grey, &window, is_seen);
        let seen_in = |row: usize| -> std::vec::Vec<usize> {
            (0..width)
                .filter(|column| is_seen(row * width + column))
                .collect()
        };
        let rows: std::vec::Vec<usize> = (0..height)
            .filter(|&row| !seen_in(row).is_empty())
            .collect();
        for (index, &found) in grey.iter().enumerate() {
            let from = nearest(index / width, &rows)
                .and_then(|row| Some(row * width + nearest(index % width, &seen_in(row))?));
            assert_eq!(found, given[from.unwrap_or(index)], "{case}: {index}");
        }
    }
}

/// Oracle: greys counted one by one. As many as are cut off at either end lie beyond the scale, and with one bin less there were more.
#[test]
fn all_but_a_few_pixels_lie_on_the_scale() {
    for (few_dark, few_bright) in [(0, 0), (4, 5), (5, 4), (6, 6), (40, 0)] {
        let count = 10_000;
        let mut grey: std::vec::Vec<u16> = (0..count)
            .map(|k| 6400 + (k * 37 % 20_000) as u16)
            .collect();
        grey[..few_dark].fill(130);
        grey[count - few_bright..].fill(64_000);
        let (dark, bright) = ends(&grey, &mut [0; LEVELS]);
        let below = |level: u16| grey.iter().filter(|&&value| value < level).count();
        let above = |level: u16| grey.iter().filter(|&&value| value >= level).count();
        let few = count / 2000;
        assert!(below(dark) <= few && below(dark + 64) > few, "{dark}");
        assert!(above(bright) <= few && above(bright - 64) > few, "{bright}");
    }
    // Of one grey alone there is a scale too, up to the greatest.
    for value in [0, 700, u16::MAX] {
        let (dark, bright) = ends(&[value; 50], &mut [0; LEVELS]);
        assert!(dark <= value && bright > dark, "{value}");
    }
}

use super::*;
use crate::polyline::twice_area;
use crate::synthetic::SyntheticFrame;
use fluoropose::image::contour::first_crossing;
use fluoropose::image::frame::Frame;
use fluoropose::image::mask::MaskMut;
use fluoropose::memory::TooLittleMemory;
use proptest::prelude::*;
use std::vec::Vec;

/// The values of a smoothed frame and their scale.
fn smoothed(drawn: &SyntheticFrame) -> (Vec<u16>, crate::smoothed::Scale) {
    let pixels = drawn.eight_bit();
    let frame = Frame::new(&pixels, drawn.width, drawn.height, drawn.width).expect("fits");
    let mut cells = std::vec![0; pixels.len()];
    let scale = Smoothed::new(&frame, &mut cells).expect("fits").scale();
    (cells, scale)
}

fn outline(drawn: &SyntheticFrame, at: [f64; 2], threshold: &Threshold) -> Vec<Point> {
    let (cells, scale) = smoothed(drawn);
    let frame = Smoothed::from_cells(&cells, drawn.width, drawn.height, scale).expect("fits");
    outline_in(&frame, at, threshold)
}

fn outline_in(frame: &Smoothed<'_>, at: [f64; 2], threshold: &Threshold) -> Vec<Point> {
    let (words, points) = threshold_needed(frame.width(), frame.height());
    let mut words = std::vec![0; words];
    let mut line = std::vec![Vertex::default(); points];
    let mut marks = std::vec![false; points];
    let mut places = line.clone();
    let mut out = List::new(&mut places);
    let memory = ThresholdMemory {
        words: &mut words,
        line: &mut line,
        marks: &mut marks,
    };
    let at = Point::new(at[0], at[1]);
    let found = region_at(frame, at, threshold, memory, &mut out);
    assert_eq!(found.expect("valid").is_some(), !out.is_empty());
    out.as_slice().iter().map(|vertex| vertex.at).collect()
}

fn area(outline: &[Point]) -> f64 {
    twice_area(outline) / 2.0
}

const DARK: Threshold = Threshold {
    inside: Inside::Dark,
    level: 125.0,
    bridge: 0,
    tolerance: 0.2,
};

#[test]
fn a_disc_in_noise_is_found_to_a_part_of_a_pixel() {
    let mut drawn = SyntheticFrame::new(120, 100, 200.0);
    drawn.disc([57.3, 48.8], 30.0, 50.0);
    drawn.add_noise(6.0, 2);
    let found = outline(&drawn, [50.0, 50.0], &DARK);
    let off = |p: &Point| (p.column - 57.3).hypot(p.row - 48.8) - 30.0;
    let rms = (found.iter().map(|p| off(p).powi(2)).sum::<f64>() / found.len() as f64).sqrt();
    assert!(rms < 0.15 && found.len() < 120, "{rms} {}", found.len());
    // Smoothing draws the edge of a disc inwards by sigma^2 / 2 r.
    let ratio = area(&found) / (core::f64::consts::PI * 900.0);
    assert!((ratio - 1.0).abs() < 0.005, "{ratio}");
}

#[test]
fn an_inverted_frame_gives_the_same_outline() {
    let mut drawn = SyntheticFrame::new(90, 80, 200.0);
    drawn.plate([45.0, 40.0], [25.0, 8.0], 0.4, 50.0);
    let dark = outline(&drawn, [45.0, 40.0], &DARK);
    drawn.grey.iter_mut().for_each(|grey| *grey = 255.0 - *grey);
    let inverted = Threshold {
        inside: Inside::Bright,
        level: 130.0,
        ..DARK
    };
    let bright = outline(&drawn, [45.0, 40.0], &inverted);
    assert_eq!(dark.len(), bright.len());
    for (a, b) in dark.iter().zip(&bright) {
        assert!((a.column - b.column).hypot(a.row - b.row) < 0.02);
    }
}

#[test]
fn holes_are_filled_and_specks_left_alone() {
    let mut drawn = SyntheticFrame::new(120, 100, 200.0);
    drawn.plate([60.0, 50.0], [40.0, 20.0], 0.0, 50.0);
    let whole = area(&outline(&drawn, [60.0, 50.0], &DARK));
    drawn.disc([50.0, 50.0], 9.0, 220.0);
    drawn.disc([75.0, 45.0], 5.0, 220.0);
    drawn.disc([60.0, 10.0], 3.0, 20.0);
    // Between the two holes, and to the right of both.
    for at in [[65.0, 48.0], [95.0, 46.0], [30.0, 50.0]] {
        assert_eq!(area(&outline(&drawn, at, &DARK)), whole);
    }
    assert!((whole - 80.0 * 40.0).abs() < 20.0, "{whole}");
    // In the hole, three pixels from its border, there is a region near; in the middle of a large one there is none.
    assert!(outline(&drawn, [50.0, 50.0], &DARK).is_empty());
    assert_eq!(area(&outline(&drawn, [42.5, 50.0], &DARK)), whole);
}

#[test]
fn what_hangs_on_by_a_bridge_is_cut_off_and_corners_stay() {
    let mut drawn = SyntheticFrame::new(160, 100, 200.0);
    drawn.plate([50.0, 50.0], [30.0, 20.0], 0.0, 50.0);
    drawn.plate([120.0, 50.0], [25.0, 25.0], 0.0, 50.0);
    let alone = area(&outline(&drawn, [50.0, 50.0], &DARK));
    drawn.plate([90.0, 52.0], [20.0, 1.5], 0.0, 50.0);
    let joined = area(&outline(&drawn, [50.0, 50.0], &DARK));
    assert!(joined > alone + 2400.0, "{joined} {alone}");
    let bridge = Threshold { bridge: 2, ..DARK };
    let cut = outline(&drawn, [50.0, 50.0], &bridge);
    // A stump of some pixels may stay.
    assert!((area(&cut) - alone).abs() < 16.0, "{} {alone}", area(&cut));
    for corner in [(20.0, 30.0), (20.0, 70.0), (80.0, 30.0), (80.0, 70.0)] {
        let away = |p: &Point| (p.column - corner.0).hypot(p.row - corner.1);
        let nearest = cut.iter().map(away).fold(f64::MAX, f64::min);
        assert!(nearest < 1.5, "{nearest} from {corner:?}");
    }
    // A part that is itself thinner than a bridge is found as it is.
    let thin = Threshold { bridge: 9, ..DARK };
    let mut drawn = SyntheticFrame::new(100, 60, 200.0);
    drawn.plate([50.0, 30.0], [30.0, 5.0], 0.3, 50.0);
    let found = area(&outline(&drawn, [50.0, 30.0], &thin));
    assert!((found - 600.0).abs() < 10.0, "{found}");
}

#[test]
fn a_region_that_the_frame_cuts_ends_at_its_border() {
    let mut drawn = SyntheticFrame::new(60, 50, 200.0);
    drawn.disc([0.0, 25.0], 15.0, 50.0);
    for bridge in [0, 2] {
        let found = outline(&drawn, [3.0, 25.0], &Threshold { bridge, ..DARK });
        let least = found.iter().map(|p| p.column).fold(f64::MAX, f64::min);
        assert_eq!(least, 0.0);
        let half = core::f64::consts::PI * 225.0 / 2.0;
        assert!((area(&found) / half - 1.0).abs() < 0.02, "{}", area(&found));
    }
}

#[test]
fn nothing_and_specks_give_nothing_and_wrong_settings_are_said() {
    let mut drawn = SyntheticFrame::new(40, 30, 200.0);
    drawn.disc([20.0, 15.0], 1.6, 40.0);
    assert!(outline(&drawn, [20.0, 15.0], &DARK).is_empty());
    assert!(outline(&drawn, [5.0, 5.0], &DARK).is_empty());
    assert!(outline(&drawn, [f64::NAN, 1e300], &DARK).is_empty());
    for level in [-5.0, f64::NAN] {
        assert!(outline(&drawn, [20.0, 15.0], &Threshold { level, ..DARK }).is_empty());
    }
    let (cells, scale) = smoothed(&drawn);
    let frame = Smoothed::from_cells(&cells, 40, 30, scale).expect("fits");
    let memory = ThresholdMemory {
        words: &mut [0; 10],
        line: &mut [],
        marks: &mut [],
    };
    let mut out = List::new(&mut []);
    let short = region_at(&frame, Point::new(3.0, 3.0), &DARK, memory, &mut out);
    assert!(matches!(
        short,
        Err(TracingError::Memory(TooLittleMemory { what: "words", .. }))
    ));
}

#[test]
fn the_suggested_level_lies_on_the_edge() {
    let mut drawn = SyntheticFrame::new(160, 120, 210.0);
    // Bone of middle grey behind the implant, and a darker bar at the frame's border.
    drawn.disc([80.0, 60.0], 55.0, 150.0);
    drawn.disc([85.0, 60.0], 25.0, 40.0);
    drawn.plate([80.0, 118.0], [90.0, 6.0], 0.0, 10.0);
    drawn.add_noise(4.0, 8);
    let (cells, scale) = smoothed(&drawn);
    let smooth = Smoothed::from_cells(&cells, 160, 120, scale).expect("fits");
    let level = suggested_level(&smooth, Point::new(85.0, 60.0), Inside::Dark);
    let level = level.expect("there is one");
    assert!((70.0..125.0).contains(&level), "{level}");
    let found = outline(&drawn, [85.0, 60.0], &Threshold { level, ..DARK });
    assert!((area(&found) / (core::f64::consts::PI * 625.0) - 1.0).abs() < 0.05);
    assert_eq!(
        suggested_level(&smooth, Point::new(-9.0, 3.0), Inside::Dark),
        None
    );
}

/// Oracle: the pixels that a flood from outside, past the region of the seed, does not reach.
fn naive_area(inside: &[bool], width: usize, height: usize, seed: (usize, usize)) -> usize {
    let flood =
        |from: (isize, isize), steps: &[(isize, isize)], may: &dyn Fn(isize, isize) -> bool| {
            let mut seen = std::collections::BTreeSet::new();
            let mut waiting = std::vec![from];
            while let Some((column, row)) = waiting.pop() {
                if may(column, row) && seen.insert((column, row)) {
                    waiting.extend(
                        steps
                            .iter()
                            .map(|(right, down)| (column + right, row + down)),
                    );
                }
            }
            seen
        };
    let four = [(1, 0), (-1, 0), (0, 1), (0, -1)];
    let eight = [
        (1, 0),
        (-1, 0),
        (0, 1),
        (0, -1),
        (1, 1),
        (1, -1),
        (-1, 1),
        (-1, -1),
    ];
    let frame = |column: isize, row: isize| {
        (0..width as isize).contains(&column) && (0..height as isize).contains(&row)
    };
    let at = |column: isize, row: isize| inside[row as usize * width + column as usize];
    let seed = (seed.0 as isize, seed.1 as isize);
    let region = flood(seed, &four, &|c, r| frame(c, r) && at(c, r));
    let around = |c, r| (-1..=width as isize).contains(&c) && (-1..=height as isize).contains(&r);
    let outside = flood((-1, -1), &eight, &|c, r| {
        around(c, r) && !region.contains(&(c, r))
    });
    (width + 2) * (height + 2) - outside.len()
}

proptest! {
    #[test]
    fn the_border_encloses_the_region_and_its_holes(
        pixels in proptest::collection::vec(any::<u8>(), 24 * 18), seed in 0..24 * 18usize, level in 60..200u8
    ) {
        let cells: Vec<u16> = pixels.iter().map(|&grey| u16::from(grey) * 256).collect();
        let scale = crate::smoothed::Scale::of(255);
        let frame = Smoothed::from_cells(&cells, 24, 18, scale).expect("fits");
        let cut = Cut::new(&frame, Inside::Dark, f64::from(level));
        let inside: Vec<bool> = pixels.iter().map(|&grey| grey <= level).collect();
        prop_assume!(inside[seed]);
        let mut words = std::vec![0; words_needed(24, 18)];
        let mut mask = MaskMut::new(&mut words, 24, 18).expect("fits");
        cut.fill(&mut mask);
        let mask = mask.into_mask();
        for (at, &inside) in inside.iter().enumerate() {
            prop_assert_eq!(mask.get(at % 24, at / 24), inside);
        }
        let seed = (seed % 24, seed / 24);
        let start = region::outer_border(seed, |column, row| mask.get(column, row));
        let mut places = std::vec![Vertex::default(); 2000];
        let mut line = List::new(&mut places);
        let area = cut.follow(&mask, start, &mut line).expect("fits");
        prop_assert_eq!(area as usize, naive_area(&inside, 24, 18, seed));
        // The line through the crossings is simple.
        let crossing = first_crossing(line.len(), |k| line.as_slice()[k].at);
        prop_assert!(line.len() < 4 || crossing.is_none(), "{crossing:?}");
    }
}

#[test]
fn a_level_between_two_pixels_is_passed_where_a_slope_has_it() {
    let mut cells: Vec<u16> = Vec::new();
    for _ in 0..40 {
        cells.extend((0..60).map(|column: u16| 100 + 10 * column.saturating_sub(15)));
    }
    let drawn = SyntheticFrame::new(60, 40, 100.0);
    let (_, scale) = smoothed(&drawn);
    let frame = Smoothed::from_cells(&cells, 60, 40, scale).expect("fits");
    for (tenths, inside) in [(133, Inside::Dark), (217, Inside::Bright)] {
        let threshold = Threshold {
            inside,
            level: f64::from(tenths) / scale.per_grey(),
            tolerance: 0.0,
            ..DARK
        };
        let cut = Cut::new(&frame, inside, threshold.level);
        let at = if cut.holds(100) { 3.5 } else { 56.5 };
        let outline = outline_in(&frame, [at, 20.5], &threshold);
        // The middle of column 15 has 100, each next one 10 more.
        let passed = 15.5 + (f64::from(tenths) - 100.0) / 10.0;
        // At the frame's border the outline turns half a pixel before it.
        let inner = outline.iter();
        let near = inner.filter(|at| at.column > 1.0 && at.column < 59.0);
        let near = near.filter(|at| at.row > 1.0 && at.row < 39.0);
        let off: Vec<f64> = near.map(|at| (at.column - passed).abs()).collect();
        assert!(
            !off.is_empty() && off.iter().all(|&off| off < 0.02),
            "{off:?}"
        );
    }
}

#[test]
fn the_nearest_place_within_reach_is_found() {
    let near = |inside: &[(usize, usize)], column: f64, row: f64| {
        region::nearest_where((20, 10), Point::new(column, row), 3, |column, row| {
            inside.contains(&(column, row))
        })
    };
    let all = [(5, 5), (7, 6), (9, 5)];
    assert_eq!(near(&all, 7.9, 5.1), Some((7, 6)));
    assert_eq!(near(&all, 9.5, 5.5), Some((9, 5)));
    assert_eq!(near(&all, 2.0, 5.0), Some((5, 5)));
    assert_eq!(near(&all, 1.9, 5.0), None);
    assert_eq!(near(&[(0, 0)], -2.5, -0.5), Some((0, 0)));
    // What lies beyond the frame is never asked.
    let asked = |column, row| {
        assert!(column < 20 && row < 10);
        true
    };
    let corner = Point::new(21.5, 9.5);
    assert_eq!(
        region::nearest_where((20, 10), corner, 3, asked),
        Some((19, 9))
    );
}

proptest! {
    /// Oracle: the pixels that a flood from outside does not reach through what is not the region, by columns and rows as the region's own.
    #[test]
    fn an_outer_border_is_around_all_of_a_region(cells in proptest::collection::vec(proptest::bool::weighted(0.7), 12 * 9)) {
        const COLUMNS: usize = 12;
        const ROWS: usize = 9;
        let inside = |column: usize, row: usize| column < COLUMNS && row < ROWS && cells[row * COLUMNS + column];
        let beside = |(column, row): (usize, usize)| {
            [(column + 1, row), (column.wrapping_sub(1), row), (column, row + 1), (column, row.wrapping_sub(1))]
        };
        let mut known = std::vec![false; COLUMNS * ROWS];
        for seed in (0..COLUMNS * ROWS).filter(|&seed| cells[seed]) {
            let seed = (seed % COLUMNS, seed / COLUMNS);
            if known[seed.1 * COLUMNS + seed.0] {
                continue;
            }
            let mut region = std::vec![seed];
            let mut next = 0;
            while let Some(&at) = region.get(next) {
                let more = beside(at).into_iter().filter(|&(column, row)| inside(column, row));
                let more: Vec<_> = more.filter(|at| !region.contains(at)).collect();
                region.extend(more);
                next += 1;
            }
            region.iter().for_each(|&(column, row)| known[row * COLUMNS + column] = true);
            // With a frame of one cell around all, from which everything outside is reached, across corners too.
            let mut outside = std::vec![(0usize, 0usize)];
            let mut next = 0;
            while let Some(&(x, y)) = outside.get(next) {
                for (right, down) in (0..9).map(|k| (k % 3, k / 3)) {
                    let at = ((x + right).wrapping_sub(1), (y + down).wrapping_sub(1));
                    let is_region = at.0 > 0 && at.1 > 0 && region.contains(&(at.0 - 1, at.1 - 1));
                    if at.0 < COLUMNS + 2 && at.1 < ROWS + 2 && !is_region && !outside.contains(&at) {
                        outside.push(at);
                    }
                }
                next += 1;
            }
            let whole = (COLUMNS + 2) * (ROWS + 2) - outside.len();
            for &pixel in &region {
                let start = region::outer_border(pixel, inside);
                let (mut at, mut twice_area) = (start, 0);
                loop {
                    let next = at.step();
                    twice_area += at.column * next.row - at.row * next.column;
                    at = next.turn_where(inside);
                    if at == start {
                        break;
                    }
                }
                prop_assert_eq!(twice_area, 2 * whole as i64);
            }
        }
    }
}

/// Of a rectangle with a sharp border, whatever else is as sharp.
#[test]
fn a_region_of_fewer_than_a_hundred_pixels_suggests_no_level() {
    let scale = crate::smoothed::Scale::of(255);
    for (width, height, is_found) in [(10, 10, true), (9, 11, false), (8, 8, false), (5, 20, true)]
    {
        let inside = |column: usize, row: usize| {
            column.wrapping_sub(12) < width && row.wrapping_sub(7) < height
        };
        let cells: Vec<u16> = (0..50 * 40)
            .map(|k| if inside(k % 50, k / 50) { 9000 } else { 40_000 })
            .collect();
        let frame = Smoothed::from_cells(&cells, 50, 40, scale).expect("fits");
        let level = suggested_level(&frame, Point::new(13.5, 8.5), Inside::Dark);
        assert_eq!(level.is_some(), is_found, "{width} x {height}");
        let inverted: Vec<u16> = cells.iter().map(|cell| u16::MAX - cell).collect();
        let frame = Smoothed::from_cells(&inverted, 50, 40, scale).expect("fits");
        let level = suggested_level(&frame, Point::new(13.5, 8.5), Inside::Bright);
        assert_eq!(level.is_some(), is_found, "{width} x {height}");
    }
}

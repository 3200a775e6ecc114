use std::vec;
use std::vec::Vec;

use proptest::prelude::*;

use super::*;
use crate::image::mask::{Word, words_needed};

/// A mask with its own memory, its pixels chosen by column and row.
fn words_of(width: usize, height: usize, mut set: impl FnMut(usize, usize) -> bool) -> Vec<Word> {
    let mut words = vec![0; words_needed(width, height)];
    let mut mask = MaskMut::new(&mut words, width, height).expect("fits");
    for row in 0..height {
        for column in 0..width {
            mask.set(column, row, set(column, row));
        }
    }
    words
}

struct Answer {
    words: Vec<Word>,
    dropped: u64,
    looked: usize,
}

fn largest(words: &[Word], width: usize, height: usize) -> Answer {
    let (mut rest, mut out) = (vec![0; words.len()], vec![0; words.len()]);
    let mut looked = 0;
    let dropped = largest_counted(
        &Mask::new(words, width, height).expect("valid"),
        &mut MaskMut::new(&mut rest, width, height).expect("fits"),
        &mut MaskMut::new(&mut out, width, height).expect("fits"),
        &mut |more| looked += more,
    );
    Mask::new(&out, width, height).expect("nothing beyond the last column");
    Answer {
        words: out,
        dropped: dropped.expect("shapes agree"),
        looked,
    }
}

/// The slow way: a flood from each pixel that none has reached.
fn by_flooding(words: &[Word], width: usize, height: usize) -> (Vec<Word>, u64) {
    let mask = Mask::new(words, width, height).expect("valid");
    let mut region_of = vec![0; width * height];
    let mut areas = vec![0];
    for seed in 0..width * height {
        let mut waiting = vec![(seed % width, seed / width)];
        let mut area = 0;
        while let Some((column, row)) = waiting.pop() {
            if !mask.get(column, row) || region_of[row * width + column] != 0 {
                continue;
            }
            region_of[row * width + column] = areas.len();
            area += 1;
            waiting.extend([(column + 1, row), (column, row + 1)]);
            waiting.extend(column.checked_sub(1).map(|column| (column, row)));
            waiting.extend(row.checked_sub(1).map(|row| (column, row)));
        }
        if area > 0 {
            areas.push(area);
        }
    }
    let most = *areas.iter().max().expect("that of no region");
    let best = areas.iter().position(|&area| area == most);
    let of_best =
        |column: usize, row: usize| most > 0 && Some(region_of[row * width + column]) == best;
    (words_of(width, height, of_best), mask.area() - most)
}

/// A reproducible number for each pixel.
fn noise(column: usize, row: usize) -> u32 {
    let seed = (row as u32).wrapping_mul(0x9E37_79B9) ^ (column as u32).wrapping_mul(0x85EB_CA6B);
    let mixed = (seed ^ seed >> 15).wrapping_mul(0x2C1B_3C6D);
    (mixed ^ mixed >> 12).wrapping_mul(0x297A_2D39) >> 16
}

#[test]
fn the_largest_region_stays_and_specks_go() {
    // A spiral, a speck touching by a corner, a bar across words.
    let rows = [
        "#######.............................####",
        "#.....#",
        "#.###.#",
        "#.#.#.#",
        "#.#...#",
        "#.#####",
        "#......#",
        "#######.",
    ];
    let set = |column: usize, row: usize| {
        rows.get(row).and_then(|row| row.as_bytes().get(column)) == Some(&b'#')
    };
    let words = words_of(70, 12, set);
    let answer = largest(&words, 70, 12);
    assert_eq!(answer.dropped, 4 + 1);
    let out = Mask::new(&answer.words, 70, 12).expect("valid");
    assert_eq!(
        out.area(),
        Mask::new(&words, 70, 12).expect("valid").area() - 5
    );
    assert!(out.get(4, 3) && !out.get(7, 6));
}

#[test]
fn nothing_gives_nothing() {
    let answer = largest(&words_of(70, 12, |_, _| false), 70, 12);
    assert_eq!((answer.dropped, answer.words), (0, vec![0; 36]));
}

#[test]
fn memory_of_another_shape_is_refused() {
    let (words, mut a, mut b) = ([0; 4], [0; 4], [0; 4]);
    let mask = Mask::new(&words, 32, 4).expect("valid");
    let mut rest = MaskMut::new(&mut a, 32, 4).expect("fits");
    let mut out = MaskMut::new(&mut b, 31, 4).expect("fits");
    let refused = largest_region(&mask, &mut rest, &mut out);
    assert_eq!(refused, Err(MaskError::Sizes));
}

/// Whether the pixel at a column and row is set.
type Pattern = fn(usize, usize) -> bool;

/// A dozen looks a pixel, the frame of nested rings being the worst of these: a look at the frame for each region would take
/// thousands.
#[test]
fn many_regions_take_no_more_than_a_few_looks_a_pixel() {
    let side = 1024;
    let patterns: [(&str, Pattern); 5] = [
        ("half of all", |column, row| noise(column, row) < 1 << 15),
        ("a tenth", |column, row| noise(column, row) < 6554),
        ("a chessboard", |column, row| (column + row) % 2 == 0),
        ("rings", |column, row| {
            let from = |at: usize| at.min(1023 - at);
            from(column).min(from(row)) % 2 == 0
        }),
        ("holes", |column, row| {
            (column + row) % 2 == 0 || row % 2 == 0
        }),
    ];
    for (name, pattern) in patterns {
        let answer = largest(&words_of(side, side, pattern), side, side);
        std::println!("{name}: {} looks", answer.looked);
        assert!(
            answer.looked < 12 * side * side,
            "{name}: {}",
            answer.looked
        );
    }
}

properties! {
    #[test]
    fn it_is_the_one_that_floods_find(
        width in 1usize..100,
        height in 1usize..40,
        seed in any::<usize>(),
        share in 0u32..=1 << 16,
        scale in 1usize..5,
    ) {
        let set = |column: usize, row: usize| {
            noise((column / scale).wrapping_add(seed), row / scale) < share
        };
        let words = words_of(width, height, set);
        let answer = largest(&words, width, height);
        let (region, dropped) = by_flooding(&words, width, height);
        prop_assert_eq!(answer.dropped, dropped);
        prop_assert_eq!(answer.words, region);
    }
}

//! How much an image states to hold, against how much there is.
//!
//! The library reserves memory for what headers state. Every packet has a byte at least, so that an image cannot state more
//! packets than it has bytes; and what is known of blocks of coefficients is kept for each of its layers.

use super::codestream::{Side, Size, Styles};
use super::problem::damaged;
use crate::error::Problem;

/// Exponent of the side of a precinct where none is stated: larger than any image.
const WHOLE: u8 = 15;
/// Most times that an image is halved (T.800 A.6.1).
const MOST_LEVELS: u8 = 32;

/// Layers of blocks that an image may have for each of its bytes, and pixels for each layer of a block: encoders write
/// blocks of 64 x 64 pixels in some ten layers, or smaller ones in fewer.
const LAYERS_PER_BYTE: u64 = 16;
const PIXELS_PER_LAYER: u64 = 64;

/// Refuses an image of `length` bytes that states more than they can hold.
pub(super) fn check(length: usize, size: &Size, styles: &Styles<'_>) -> Result<(), Problem> {
    let (layers, components) = (u64::from(styles.layers), u64::from(size.components));
    let area = u64::from(size.width) * u64::from(size.height);
    for &(style, has_precincts) in &styles.components {
        let &[levels, width, height, _, _, ref precincts @ ..] = style else {
            return Err(damaged("a coding style is cut short"));
        };
        if levels > MOST_LEVELS {
            return Err(damaged(format!("it states {levels} levels")));
        }
        let exponents = |level: u8| match precincts.get(usize::from(level)) {
            Some(&exponents) if has_precincts => [exponents & 0x0F, exponents >> 4],
            _ => [WHOLE, WHOLE],
        };
        let precincts = (0..=levels).map(|resolution| {
            let [across, down] = exponents(resolution);
            let halved = levels - resolution;
            count(size.sides[0], halved, across) * count(size.sides[1], halved, down)
        });
        let precincts = components * precincts.sum::<u64>();
        if layers * precincts > length as u64 {
            return Err(damaged("it states more packets than it has bytes"));
        }
        // Exponents of a block's sides are stated without 2.
        let block = 1u64 << (u32::from(width & 0x0F) + u32::from(height & 0x0F) + 4);
        let blocks = 2 * components * area / block + 4 * precincts;
        let possible = LAYERS_PER_BYTE * length as u64 + components * area / PIXELS_PER_LAYER;
        if layers * blocks > possible {
            return Err(damaged(
                "it states more layers of blocks than it has bytes for",
            ));
        }
    }
    Ok(())
}

/// How many precincts there are in one direction, over all tiles, of an image that was halved some times (T.800 B.6).
fn count(side: Side, halved: u8, exponent: u8) -> u64 {
    let (start, end) = (u64::from(side.start), u64::from(side.end));
    let (first, tile) = (u64::from(side.tiles_start), u64::from(side.tile));
    let tiles = (start - first) / tile..(end.saturating_sub(first)).div_ceil(tile);
    let of_tile = |index: u64| {
        let reduced = |place: u64| place.clamp(start, end).div_ceil(1 << halved);
        let (from, to) = (
            reduced(first + index * tile),
            reduced(first + (index + 1) * tile),
        );
        match to > from {
            true => to.div_ceil(1 << exponent) - (from >> exponent),
            false => 0,
        }
    };
    tiles.map(of_tile).sum()
}

//! The picture of unmatched pixels.

use wasm_bindgen::prelude::*;
use web_sys::CanvasRenderingContext2d;

use crate::paint::{Rgba, opaque, put};

/// Outside both silhouettes, inside both, and where they differ: black on light, as in the source's figures.
const OUTSIDE: u32 = 0xF4_F4F1;
const INSIDE: u32 = 0xD3_D6D8;
const DIFFERS: u32 = 0;

/// Paints two canonical silhouettes of `size` x `size` pixels over each other, black where they differ.
///
/// # Errors
/// What the canvas throws.
#[wasm_bindgen(js_name = paintUnmatched)]
pub fn paint_unmatched(
    context: &CanvasRenderingContext2d,
    input: &[u8],
    view: &[u8],
    size: u32,
) -> Result<(), JsValue> {
    put(context, &compared(input, view), size as usize, 0, 0)
}

fn compared(input: &[u8], view: &[u8]) -> Vec<Rgba> {
    let [outside, inside, differs] = [OUTSIDE, INSIDE, DIFFERS].map(opaque);
    let pairs = input.iter().zip(view);
    let shade = |a: u8, b: u8, bit: usize| match (a >> bit & 1, b >> bit & 1) {
        (0, 0) => outside,
        (1, 1) => inside,
        _ => differs,
    };
    pairs
        .flat_map(|(&a, &b)| std::array::from_fn::<_, 8, _>(|bit| shade(a, b, bit)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_differing_pixels_are_black_and_the_lowest_bit_is_leftmost() {
        let pixels = compared(&[0b0000_0011], &[0b0000_0101]);
        let black = opaque(DIFFERS);
        let at = |value| {
            pixels
                .iter()
                .enumerate()
                .filter(move |(_, p)| **p == value)
                .map(|(i, _)| i)
        };
        assert_eq!(at(black).collect::<Vec<_>>(), [1, 2]);
        assert_eq!(at(opaque(INSIDE)).collect::<Vec<_>>(), [0]);
    }
}

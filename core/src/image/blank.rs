//! Frames that show nothing.

use super::grey::Grey;

/// Where a frame is said to show nothing. One sentence for whoever looks in vain, without its full stop.
pub const BLANK: &str = "the frame is empty: nearly all of it has one grey value";

/// Grey values that lie no farther apart than this are one, whatever the film.
pub const ONE_GREY: f64 = 2.0;

/// So many places along a row and along a column are looked at, as near to even as pixels allow.
const PLACES: usize = 256;
/// One of so many may have another grey value: letters are burnt into frames that show nothing else.
const OTHERS: usize = 200;

/// Whether a frame shows nothing: of places all over it, nearly all have their mean grey value, to `within` grey values. Pixels that nothing is
/// known of do not count.
#[must_use]
pub fn is_blank(frame: &dyn Grey, within: f64) -> bool {
    let size: [usize; 2] = frame.size().into();
    let along = |pixels: usize| (0..pixels).step_by(pixels.div_ceil(PLACES).max(1));
    let greys = || {
        along(size[1]).flat_map(move |row| {
            let at = move |column: usize| frame.at(column as f64 + 0.5, row as f64 + 0.5);
            along(size[0]).filter_map(at)
        })
    };
    let (sum, count) = greys().fold((0.0, 0_usize), |(sum, n), grey| (sum + grey, n + 1));
    let mean = sum / count.max(1) as f64;
    let others = greys().filter(|grey| (grey - mean).abs() > within).count();
    OTHERS * others <= count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::frame::Frame;

    const SIDE: usize = 320;

    fn is_blank_with(other: impl Fn(usize, usize) -> Option<u16>) -> bool {
        // Noise of one grey value.
        let pixels: std::vec::Vec<u16> = (0..SIDE * SIDE)
            .map(|at| other(at % SIDE, at / SIDE).unwrap_or(30 + (at * 7919 % 3) as u16))
            .collect();
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("a frame");
        is_blank(&frame, ONE_GREY)
    }

    #[test]
    fn noise_and_letters_are_nothing_and_a_small_part_or_a_slow_slope_is_something() {
        assert!(is_blank_with(|_, _| None));
        let letters = |column, row| (column < 40 && row < 10).then_some(255);
        assert!(is_blank_with(letters));
        let part = |column: usize, row: usize| {
            (column.abs_diff(90) < 20 && row.abs_diff(90) < 20).then_some(90)
        };
        assert!(!is_blank_with(part));
        assert!(!is_blank_with(|column, _| Some(30 + (column / 20) as u16)));
    }
}

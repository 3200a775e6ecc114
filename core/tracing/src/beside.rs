//! What of a frame is another component's.

use fluoropose::image::mask::{Mask, MaskMut};

use crate::morphology::widen;

/// How far the edges of a component reach beyond its silhouette, pixels: they are as wide as the film's blur and the filter that finds
/// edges.
pub const REACH: usize = 4;

/// Sets in `hidden` what a component covers, `drawn` being its silhouette, and what its edges reach beyond that: nothing is known there of
/// the edges of the other one. Where both touch there is no edge at all.
pub fn hide(drawn: &Mask<'_>, hidden: &mut MaskMut<'_>) {
    widen(drawn, REACH, hidden);
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::image::mask::words_needed;
    use std::vec;

    #[test]
    fn a_pixel_hides_a_square_that_the_frame_cuts_off_and_what_was_hidden_stays() {
        let (width, height) = (40, 20);
        let mask = |set: &[[usize; 2]]| {
            let mut words = vec![0; words_needed(width, height)];
            let mut mask = MaskMut::new(&mut words, width, height).expect("valid");
            set.iter().for_each(|&[x, y]| mask.set(x, y, true));
            words
        };
        let drawn = mask(&[[20, 1]]);
        let mut hidden = mask(&[[3, 15]]);
        let mut hidden = MaskMut::onto(&mut hidden, width, height).expect("valid");
        hide(
            &Mask::new(&drawn, width, height).expect("valid"),
            &mut hidden,
        );
        // Nine columns; rows 0 to 5.
        assert_eq!(hidden.as_mask().area(), 9 * 6 + 1);
        assert!(hidden.as_mask().get(16, 5) && !hidden.as_mask().get(15, 5));
    }
}

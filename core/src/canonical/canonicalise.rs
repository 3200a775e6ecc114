//! From a silhouette to its canonical form.

use super::form::{CanonicalError, CanonicalForm, CanonicalSpec};
use super::sampler::Sampler;
use crate::image::mask::{Mask, MaskError, MaskMut, WORD_BITS, Word};
use crate::math::{atan2, sqrt};

/// Area, centroid, axis and scale of a silhouette, from integer moments.
fn measure(mask: &Mask<'_>, area: u32, aspect: f64) -> Result<CanonicalForm, CanonicalError> {
    let moments = mask.moments();
    if moments.area == 0 {
        return Err(MaskError::Empty.into());
    }
    let [cc, cr, rr] = moments.covariance();
    let (xx, xy, yy) = (cc, -cr * aspect, rr * aspect * aspect);
    let spread = sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy);
    if xx + yy == 0.0 {
        return Err(CanonicalError::Pixel);
    }
    // A disc has every axis, and any serves: level, as `atan2` has it of nothing. Heads, cups and buttons are round from somewhere.
    Ok(CanonicalForm {
        area_px: moments.area,
        centroid: moments.centroid(),
        // Hu, Visual pattern recognition by moment invariants, IRE Trans. IT-8, 1962.
        angle: 0.5 * atan2(2.0 * xy, xx - yy),
        scale: sqrt(f64::from(area) / (moments.area as f64 * aspect)),
        aspect,
        elongation: spread / (xx + yy),
        clipped: false,
    })
}

/// Brings `mask` to canonical form. `aspect` is the height of a pixel divided by its width
/// ([`crate::camera::Camera::aspect`]); `out` is borrowed for the canonical bits and has
/// [`CanonicalSpec::words_needed`] words.
///
/// Each canonical pixel reads the silhouette at its centre by bilinear interpolation of the four
/// nearest pixels and is set when at least half of that weight is: the border lies where it
/// would be between pixels, not at the nearest one.
///
/// # Errors
/// [`CanonicalError`] for an empty mask, one of a single pixel, or memory of the wrong length.
pub fn canonicalise(
    mask: &Mask<'_>,
    spec: &CanonicalSpec,
    aspect: f64,
    out: &mut [Word],
) -> Result<CanonicalForm, CanonicalError> {
    let mut form = measure(mask, spec.area(), aspect)?;
    let mut canonical = MaskMut::new(out, spec.size(), spec.size())?;
    Sampler::new(&form).draw(mask, &mut canonical);
    form.clipped = touches_border(&canonical.into_mask());
    Ok(form)
}

fn touches_border(canonical: &Mask<'_>) -> bool {
    let last = canonical.height() - 1;
    (0..=last).any(|row| {
        let words = canonical.row(row);
        let outermost = if row == 0 || row == last {
            words.iter().fold(0, |sum, word| sum | word)
        } else {
            let end = words.last().map_or(0, |word| word >> (WORD_BITS - 1));
            words.first().map_or(0, |word| word & 1) | end
        };
        outermost != 0
    })
}

/// Rotates a canonical mask by 180 degrees, exactly: the other direction of its principal axis.
///
/// Where the slices differ in length, the words that both have are written.
pub fn reverse(canonical: &[Word], out: &mut [Word]) {
    for (to, from) in out.iter_mut().zip(canonical.iter().rev()) {
        *to = from.reverse_bits();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::contour::Outline;
    use crate::image::contour::Point;
    use crate::image::mask::words_needed;
    use proptest::prelude::*;

    const SIDE: usize = 480;

    /// A shape without symmetry, rotated, scaled and shifted.
    fn shape(deg: f64, size: f64, at: (f64, f64), aspect: f64) -> std::vec::Vec<Word> {
        let corners = [
            (-1.0, -0.4),
            (0.2, -0.5),
            (1.1, -0.1),
            (0.9, 0.45),
            (0.0, 0.2),
            (-0.8, 0.5),
        ];
        let (s, c) = libm::sincos(deg.to_radians());
        let points = corners.map(|(x, y): (f64, f64)| Point {
            column: at.0 + size * (c * x - s * y),
            row: at.1 - size * (s * x + c * y) / aspect,
        });
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        mask.fill_outline(&Outline::new(&points, SIDE, SIDE).expect("simple"));
        words
    }

    fn form_of(words: &[Word], aspect: f64, out: &mut [Word]) -> CanonicalForm {
        let mask = Mask::new(words, SIDE, SIDE).expect("valid");
        canonicalise(&mask, &CanonicalSpec::default(), aspect, out).expect("has a form")
    }

    fn unmatched(a: &[Word], b: &[Word]) -> u32 {
        a.iter().zip(b).map(|(a, b)| (a ^ b).count_ones()).sum()
    }

    properties! {
        /// The stated bound of invariance: 250 of 15 000 pixels for shapes of at least 90
        /// pixels half length (half a pixel along a border of about 500).
        #[test]
        fn turned_shifted_and_scaled_shapes_have_one_form(
            deg in -180.0..180.0f64,
            size in 90.0..140.0f64,
            dx in -20.0..20.0f64,
            dy in -20.0..20.0f64,
            aspect in 0.8..1.25f64,
        ) {
            let spec = CanonicalSpec::default();
            let (mut a, mut b) = (std::vec![0; spec.words_needed()], std::vec![0; spec.words_needed()]);
            let first = form_of(&shape(0.0, 110.0, (240.0, 240.0), 1.0), 1.0, &mut a);
            let second = form_of(&shape(deg, size, (240.0 + dx, 240.0 + dy), aspect), aspect, &mut b);
            let mut rotated = std::vec![0; b.len()];
            reverse(&b, &mut rotated);
            let (straight, reversed) = (unmatched(&a, &b), unmatched(&a, &rotated));
            prop_assert!(straight.min(reversed) < 250, "{} {}", straight, reversed);
            // The record gives back what was done.
            let turn = second.angle - first.angle + if reversed < straight { core::f64::consts::PI } else { 0.0 };
            let error = crate::math::wrap(turn - deg.to_radians(), 2.0 * core::f64::consts::PI);
            prop_assert!(error.abs() < 0.006, "angle off by {} rad", error);
            let ratio = first.scale / second.scale / (size / 110.0);
            prop_assert!((ratio - 1.0).abs() < 0.003, "scale off by {}", ratio);
        }
    }

    #[test]
    fn the_area_is_the_one_asked_for() {
        let spec = CanonicalSpec::default();
        let mut out = std::vec![0; spec.words_needed()];
        let form = form_of(&shape(33.0, 120.0, (240.0, 240.0), 1.0), 1.0, &mut out);
        let area = Mask::new(&out, 256, 256).expect("valid").area();
        assert!((area as f64 - 15_000.0).abs() < 40.0, "{area}");
        assert!(!form.clipped);
    }

    #[test]
    fn reversing_twice_changes_nothing() {
        let spec = CanonicalSpec::default();
        let mut out = std::vec![0; spec.words_needed()];
        form_of(&shape(70.0, 120.0, (240.0, 240.0), 1.0), 1.0, &mut out);
        let (mut once, mut twice) = (out.clone(), out.clone());
        reverse(&out, &mut once);
        reverse(&once, &mut twice);
        assert_eq!(out, twice);
        let (a, b) = (Mask::new(&out, 256, 256), Mask::new(&once, 256, 256));
        let (a, b) = (a.expect("valid"), b.expect("valid"));
        for row in 0..256 {
            for column in 0..256 {
                assert_eq!(a.get(column, row), b.get(255 - column, 255 - row));
            }
        }
    }

    /// What is as wide in all directions to the last bit has a form all the same, and is where it is.
    #[test]
    fn what_has_no_longer_axis_has_a_form() {
        let spec = CanonicalSpec::default();
        let mut out = std::vec![0; spec.words_needed()];
        for is_round in [false, true] {
            let mut words = std::vec![0; words_needed(SIDE, SIDE)];
            let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("valid");
            for (column, row) in (0..60).flat_map(|column| (0..60).map(move |row| (column, row))) {
                let (x, y) = (2 * column - 59i32, 2 * row - 59i32);
                if !is_round || x * x + y * y < 59 * 59 {
                    mask.set(column as usize + 100, row as usize + 120, true);
                }
            }
            let form = canonicalise(&mask.into_mask(), &spec, 1.0, &mut out).expect("a form");
            assert_eq!((form.elongation, form.angle), (0.0, 0.0));
            assert_eq!((form.centroid.column, form.centroid.row), (130.0, 150.0));
            let area = Mask::new(&out, 256, 256).expect("valid").area();
            // A row of pixels more or less.
            assert!((area as f64 - 15_000.0).abs() < 140.0, "{area}");
        }
    }

    #[test]
    fn nothing_has_no_form() {
        let spec = CanonicalSpec::default();
        let words = std::vec![0; words_needed(SIDE, SIDE)];
        let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
        let mut out = std::vec![0; spec.words_needed()];
        assert_eq!(
            canonicalise(&mask, &spec, 1.0, &mut out),
            Err(MaskError::Empty.into())
        );
        let mut one = words.clone();
        one[0] = 1;
        let mask = Mask::new(&one, SIDE, SIDE).expect("valid");
        assert_eq!(
            canonicalise(&mask, &spec, 1.0, &mut out),
            Err(CanonicalError::Pixel)
        );
        assert!(CanonicalSpec::new(100, 1000).is_err());
        assert!(CanonicalSpec::new(64, 3000).is_err());
    }
}

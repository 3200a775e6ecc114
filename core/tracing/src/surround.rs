//! What is painted around a picture, as bright as can be: beyond a round field on a negative, beside a film that was turned.
//!
//! Its border is sharper than any metal's, so that whatever is told from the sharpest of borders is told wrongly near it, and a limb between it and
//! air that is white too is a dark thing like metal. Air is none: a limb grows thin towards it.

use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::memory::{TooLittleMemory, first};
use fluoropose::refine::{ImageTarget, Polarity};

/// What is no farther from the brightest grey value than this part of the frame's range is as bright.
const AS_BRIGHT: f64 = 1.0 / 64.0;
/// So many pixels beyond its border the picture is darker by this part of the range: its border is sharp.
const BORDER: usize = 3;
const STEP: f64 = 0.5;
/// The part of a frame that a surround covers at least, and the part that is darker within it: less is an implant in nothing but air.
const LEAST: f64 = 0.02;
const SHOWN: f64 = 0.2;

/// Writes what is not known of a frame and its surround into `words`; `None` where it has no surround.
///
/// # Errors
/// [`TooLittleMemory`] where there are fewer than [`words_needed`] for a mask of the frame's size.
pub(crate) fn surround<'m>(
    image: &ImageTarget<'_>,
    words: &'m mut [Word],
) -> Result<Option<Mask<'m>>, TooLittleMemory> {
    let (width, height) = image.frame.size();
    let words = first("words", words_needed(width, height), words)?;
    words.fill(0);
    let mask = MaskMut::new(words, width, height).ok();
    let Some((mut mask, brightness)) = mask.zip(Brightness::of(image, [width, height])) else {
        return Ok(None);
    };
    cover_runs(&mut mask, &brightness);
    let (mut covered, mut shown) = (0, 0);
    for place in places([width, height]) {
        let [column, row] = place;
        let is_covered = mask.as_mask().get(column, row);
        covered += usize::from(is_covered);
        shown += usize::from(!is_covered && !brightness.is_bright(place));
        if brightness.is_unknown(place) {
            mask.set(column, row, true);
        }
    }
    let part = |count: usize| count as f64 / (width * height).max(1) as f64;
    let is_surround = part(covered) >= LEAST && part(shown) >= SHOWN;
    Ok(is_surround.then(|| mask.into_mask()))
}

/// Sets what of each row and column is bright from the frame's border on and ends sharply.
fn cover_runs(mask: &mut MaskMut<'_>, brightness: &Brightness<'_>) {
    let sides = [mask.as_mask().width(), mask.as_mask().height()];
    for (along, across) in [(0, 1), (1, 0)] {
        for line in 0..sides[across] {
            for from_end in [false, true] {
                let place = |at: usize| {
                    let mut place = [line; 2];
                    place[along] = if from_end { sides[along] - 1 - at } else { at };
                    place
                };
                for at in 0..brightness.run(sides[along], place) {
                    let [column, row] = place(at);
                    mask.set(column, row, true);
                }
            }
        }
    }
}

fn places([width, height]: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
    (0..height).flat_map(move |row| (0..width).map(move |column| [column, row]))
}

/// How bright a frame is, where metal is dark.
struct Brightness<'i> {
    image: &'i ImageTarget<'i>,
    brightest: f64,
    range: f64,
}

impl<'i> Brightness<'i> {
    /// `None` of a frame that is uniform or not known anywhere.
    fn of(image: &'i ImageTarget<'i>, size: [usize; 2]) -> Option<Self> {
        let unit = Self {
            image,
            brightest: 0.0,
            range: 1.0,
        };
        let mut ends = (f64::INFINITY, f64::NEG_INFINITY);
        for value in places(size).filter_map(|place| unit.at(place)) {
            ends = (value.min(ends.0), value.max(ends.1));
        }
        let (brightest, range) = (ends.1, ends.1 - ends.0);
        (range > 0.0 && range.is_finite()).then_some(Self {
            brightest,
            range,
            ..unit
        })
    }

    fn is_unknown(&self, [column, row]: [usize; 2]) -> bool {
        let unknown = self.image.unknown;
        unknown.is_some_and(|unknown| unknown.get(column, row))
    }

    fn at(&self, place: [usize; 2]) -> Option<f64> {
        let [column, row] = place.map(|at| at as f64 + 0.5);
        let value = self.image.frame.at(column, row);
        let value = value.filter(|_| !self.is_unknown(place))?;
        Some(match self.image.polarity {
            Polarity::DarkImplant => value,
            Polarity::BrightImplant => -value,
        })
    }

    /// By how much a pixel is darker than the brightest, as a part of the range.
    fn darker(&self, place: [usize; 2]) -> Option<f64> {
        Some((self.brightest - self.at(place)?) / self.range)
    }

    fn is_bright(&self, place: [usize; 2]) -> bool {
        self.darker(place).is_some_and(|by| by <= AS_BRIGHT)
    }

    /// How many of the first of `count` pixels, one after the other from the frame's border, are the surround with its border: none where it is
    /// not sharp, or all are as bright.
    fn run(&self, count: usize, place: impl Fn(usize) -> [usize; 2]) -> usize {
        let is_bright = |at: &usize| self.is_bright(place(*at));
        let length = (0..count).take_while(is_bright).count();
        let beyond = length + BORDER;
        let is_sharp = || self.darker(place(beyond - 1)).is_some_and(|by| by >= STEP);
        match length > 0 && beyond <= count && is_sharp() {
            true => beyond - 1,
            false => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::image::frame::Frame;

    const SIDE: usize = 120;

    /// What is covered of a picture with this brightness by column and row, and of its negative.
    fn covered(
        brightness: impl Fn(f64, f64) -> f64,
        unknown: Option<&Mask<'_>>,
    ) -> Option<std::vec::Vec<bool>> {
        let of = |polarity: Polarity| {
            let grey = |k: usize| {
                let value = brightness((k % SIDE) as f64, (k / SIDE) as f64).clamp(0.0, 1.0);
                let value = (value * 4000.0) as u16;
                if polarity == Polarity::DarkImplant {
                    value
                } else {
                    4000 - value
                }
            };
            let pixels: std::vec::Vec<u16> = (0..SIDE * SIDE).map(grey).collect();
            let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
            let image = ImageTarget {
                frame: &frame,
                unknown,
                polarity,
                film: None,
            };
            let mut words = std::vec![7; words_needed(SIDE, SIDE)];
            assert!(surround(&image, &mut words[1..]).is_err());
            let mask = surround(&image, &mut words).expect("enough words")?;
            Some(
                (0..SIDE * SIDE)
                    .map(|k| mask.get(k % SIDE, k / SIDE))
                    .collect(),
            )
        };
        let told = of(Polarity::DarkImplant);
        assert_eq!(told, of(Polarity::BrightImplant));
        told
    }

    /// Air to the left, a limb that grows thin towards it, and metal in it.
    fn film(column: f64, row: f64) -> f64 {
        let limb = 1.0 - 0.7 * ((column - 25.0) / 30.0).clamp(0.0, 1.0);
        if (column - 70.0).abs() < 12.0 && (row - 60.0).abs() < 20.0 {
            0.1
        } else {
            limb
        }
    }

    #[test]
    fn what_is_painted_around_a_field_is_its_surround_and_air_is_not() {
        let off = |column: f64, row: f64| libm::hypot(column - 60.0, row - 60.0);
        let round = |column: f64, row: f64| {
            if off(column, row) > 62.0 {
                1.0
            } else {
                film(column, row)
            }
        };
        let mask = covered(round, None).expect("a surround");
        let at = |column: usize, row: usize| mask[row * SIDE + column];
        assert!(at(SIDE - 1, 0) && at(SIDE - 1, SIDE - 1) && at(SIDE - 4, SIDE - 2));
        for (column, row) in [(0, 60), (10, 50), (30, 60), (62, 60), (SIDE - 9, 60)] {
            assert!(!at(column, row), "{column} {row}");
        }
        assert!(covered(film, None).is_none());
    }

    #[test]
    fn metal_in_air_is_no_picture_in_a_surround_and_a_grey_wall_is_none() {
        let alone = |column: f64, row: f64| {
            if libm::hypot(column - 60.0, row - 60.0) < 25.0 {
                0.0
            } else {
                1.0
            }
        };
        assert!(covered(alone, None).is_none());
        assert!(covered(|_, _| 0.5, None).is_none());
        let one = |column: f64, row: f64| if column < 1.0 && row < 40.0 { 1.0 } else { 0.2 };
        assert!(covered(one, None).is_none(), "too small");
    }

    #[test]
    fn what_is_unknown_stays_unknown_and_ends_a_surround() {
        let mut words = std::vec![0; words_needed(SIDE, SIDE)];
        let mut unknown = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
        (0..40).for_each(|row| unknown.fill_span(row, 100, 104));
        let unknown = unknown.into_mask();
        let beside = |column: f64, _: f64| if column > 90.0 { 1.0 } else { 0.2 };
        let mask = covered(beside, Some(&unknown)).expect("a surround");
        let at = |column: usize, row: usize| mask[row * SIDE + column];
        assert!(
            at(102, 20) && !at(110, 20) && at(110, 60) && at(91, 60) && at(89, 60) && !at(87, 60)
        );
    }
}

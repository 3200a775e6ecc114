//! Values of the elements that attributes are read from. They stay where they are in the file.

use std::ops::Range;

use super::element::{Element, UNDEFINED, Walker};
use super::tags::representation;

/// Where the value of an element is.
#[derive(Debug, Clone)]
pub(super) struct Found {
    tag: u32,
    representation: [u8; 2],
    value: Range<usize>,
    big_endian: bool,
}

impl Found {
    /// An element that attributes are read from, if it lies inside the file.
    pub(super) fn of(walker: &Walker<'_>, element: &Element) -> Option<Self> {
        let known = representation(element.tag)?;
        if element.length == UNDEFINED {
            return None;
        }
        let stated = element.representation.filter(|stated| stated != b"UN");
        Some(Self {
            tag: element.tag,
            representation: stated.unwrap_or(known),
            value: element.range(walker.bytes).ok()?,
            big_endian: walker.big_endian && element.representation != Some(*b"UN"),
        })
    }
}

/// Values of some elements of a file.
#[derive(Clone, Copy)]
pub(super) struct Values<'a> {
    pub bytes: &'a [u8],
    pub found: &'a [Found],
}

impl<'a> Values<'a> {
    /// What was found of a tag, the last if there are several, and its bytes.
    fn element(&self, tag: u32) -> Option<(&'a Found, &'a [u8])> {
        let found = self.found.iter().rfind(|found| found.tag == tag)?;
        Some((found, self.bytes.get(found.value.clone())?))
    }

    /// All numbers of a value; NaN for each that is none.
    pub(super) fn numbers(&self, tag: u32) -> Option<Vec<f64>> {
        let (found, bytes) = self.element(tag)?;
        let big = found.big_endian;
        Some(match &found.representation {
            b"US" | b"OW" | b"OB" => words(bytes, big).map(f64::from).collect(),
            b"SS" => words(bytes, big)
                .map(|word| word.cast_signed().into())
                .collect(),
            b"UL" => each(bytes, big)
                .map(|word| u32::from_le_bytes(word).into())
                .collect(),
            b"SL" => each(bytes, big)
                .map(|word| i32::from_le_bytes(word).into())
                .collect(),
            b"FL" => each(bytes, big)
                .map(|word| f32::from_le_bytes(word).into())
                .collect(),
            b"FD" => each(bytes, big).map(f64::from_le_bytes).collect(),
            _ => {
                let text = std::str::from_utf8(bytes).ok()?;
                let number = |word| trimmed(word).parse().unwrap_or(f64::NAN);
                text.split('\\').map(number).collect()
            }
        })
    }

    /// All numbers of a value, where there are no more than so many.
    pub(super) fn numbers_up_to(&self, tag: u32, most: usize) -> Option<Vec<f64>> {
        let (_, bytes) = self.element(tag)?;
        // A number of a list of text takes 13 bytes at most, one of binary 8: longer values are not read for being refused.
        let is_long = bytes.len() > 13 * most;
        let numbers = (!is_long).then(|| self.numbers(tag))??;
        (numbers.len() <= most).then_some(numbers)
    }

    pub(super) fn finite(&self, tag: u32) -> Option<f64> {
        let first = self.numbers(tag)?.first().copied();
        first.filter(|v| v.is_finite())
    }

    /// A distance: finite and above zero.
    pub(super) fn positive(&self, tag: u32) -> Option<f64> {
        self.finite(tag).filter(|&v| v > 0.0)
    }

    /// Two distances, both finite and above zero.
    pub(super) fn positive_pair(&self, tag: u32) -> Option<[f64; 2]> {
        let pair: [f64; 2] = self.numbers(tag)?.try_into().ok()?;
        pair.iter()
            .all(|v| v.is_finite() && *v > 0.0)
            .then_some(pair)
    }

    pub(super) fn text(&self, tag: u32) -> Option<&'a str> {
        let (_, bytes) = self.element(tag)?;
        std::str::from_utf8(bytes).ok().map(trimmed)
    }

    /// The words of a table of `count` entries of up to 8 bits, packed or each in a word of its own, or of 16 bits.
    pub(super) fn table(&self, tag: u32, count: usize) -> Option<Vec<u16>> {
        let (found, bytes) = self.element(tag)?;
        Some(match bytes.len() >= 2 * count {
            true => words(bytes, found.big_endian).collect(),
            // Packed bytes come in words, too.
            false if found.big_endian && found.representation == *b"OW" => {
                let pairs = bytes.as_chunks::<2>().0.iter();
                pairs
                    .flat_map(|&[low, high]| [high.into(), low.into()])
                    .collect()
            }
            false => bytes.iter().map(|&byte| byte.into()).collect(),
        })
    }
}

/// Without padding.
fn trimmed(text: &str) -> &str {
    text.trim_matches(|c: char| c == '\0' || c.is_whitespace())
}

/// Numbers of so many bytes, in little endian order.
fn each<const N: usize>(bytes: &[u8], big_endian: bool) -> impl Iterator<Item = [u8; N]> {
    let ordered = move |mut word: [u8; N]| {
        if big_endian {
            word.reverse();
        }
        word
    };
    bytes.as_chunks().0.iter().copied().map(ordered)
}

fn words(bytes: &[u8], big_endian: bool) -> impl Iterator<Item = u16> {
    each(bytes, big_endian).map(u16::from_le_bytes)
}

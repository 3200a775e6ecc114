//! The header of an array.

use half::f16;

use super::problem::{damaged, not_read};
use crate::error::Problem;

pub(crate) const MARK: &[u8] = b"\x93NUMPY";

/// Longest header that is read, bytes: NumPy itself believes no longer one.
const MAX_HEADER: usize = 10_000;

pub(super) struct Header {
    pub(super) number: Number,
    /// The first axis goes fastest.
    pub(super) is_by_columns: bool,
    pub(super) shape: Vec<usize>,
    /// Where the numbers begin.
    pub(super) length: usize,
}

impl Header {
    pub(super) fn of(bytes: &[u8]) -> Result<Self, Problem> {
        let cut = || damaged("its header is cut short");
        let versioned = &bytes.get(MARK.len()..).ok_or_else(cut)?;
        let &[major, _, a, b, ..] = *versioned else {
            return Err(cut());
        };
        let (start, length) = match (major, versioned) {
            (1, _) => (4, u16::from_le_bytes([a, b]).into()),
            (2 | 3, &&[_, _, _, _, c, d, ..]) => (6, u32::from_le_bytes([a, b, c, d])),
            (2 | 3, _) => return Err(cut()),
            _ => return Err(not_read(format!("an array of version {major}"))),
        };
        let length = length as usize;
        if length > MAX_HEADER {
            return Err(damaged("it states a header of a length that none has"));
        }
        let text = versioned.get(start..start + length).ok_or_else(cut)?;
        let text = String::from_utf8_lossy(text);
        let value = |key: &str| value(&text, key).ok_or_else(|| damaged(&no_word_on(key)));
        Ok(Self {
            number: Number::of(value("descr")?)?,
            is_by_columns: value("fortran_order")?.starts_with("True"),
            shape: shape(value("shape")?).ok_or_else(|| damaged("its shape is none"))?,
            length: MARK.len() + start + length,
        })
    }
}

fn no_word_on(key: &str) -> String {
    format!("its header has no \"{key}\"")
}

/// What follows a key of a Python dictionary.
fn value<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    ['\'', '"'].iter().find_map(|quote| {
        let (_, behind) = text.split_once(&format!("{quote}{key}{quote}"))?;
        Some(behind.trim_start().strip_prefix(':')?.trim_start())
    })
}

/// A tuple of whole numbers.
fn shape(text: &str) -> Option<Vec<usize>> {
    let (inside, _) = text.strip_prefix('(')?.split_once(')')?;
    let sides = inside.split(',').map(str::trim);
    let sides = sides.filter(|side| !side.is_empty());
    // Python 2 marked long numbers.
    sides
        .map(|side| side.trim_end_matches('L').parse().ok())
        .collect()
}

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Number {
    kind: NumberKind,
    bytes: usize,
    is_big_endian: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NumberKind {
    Truth,
    Unsigned,
    Signed,
    Float,
}

impl Number {
    /// Of a type as NumPy writes it: `'<u2'`.
    fn of(descr: &str) -> Result<Self, Problem> {
        let quoted = descr.strip_prefix(['\'', '"']);
        let word = quoted.and_then(|rest| rest.split(['\'', '"']).next());
        let word = word.ok_or_else(|| not_read("records".to_owned()))?;
        Self::named(word).ok_or_else(|| not_read(format!("values of the type {word}")))
    }

    fn named(word: &str) -> Option<Self> {
        let rest = word.trim_start_matches(['<', '>', '|', '=']);
        let (kind, bytes) = (rest.get(..1)?, rest.get(1..)?.parse().ok()?);
        let kind = match (kind, bytes) {
            ("b", 1) => NumberKind::Truth,
            ("u", 1 | 2 | 4 | 8) => NumberKind::Unsigned,
            ("i", 1 | 2 | 4 | 8) => NumberKind::Signed,
            ("f", 2 | 4 | 8) => NumberKind::Float,
            _ => return None,
        };
        Some(Self {
            kind,
            bytes,
            is_big_endian: word.starts_with('>'),
        })
    }

    pub(super) fn bytes(self) -> usize {
        self.bytes
    }

    /// Whether all its values are pixels as they are.
    pub(super) fn fits(self) -> bool {
        match self.kind {
            NumberKind::Truth => true,
            NumberKind::Unsigned => self.bytes <= 2,
            NumberKind::Signed | NumberKind::Float => false,
        }
    }

    /// Whether all its values are whole.
    pub(super) fn is_whole(self) -> bool {
        self.kind != NumberKind::Float
    }

    /// The first of some bytes, which are there; what is true is white.
    pub(super) fn read(self, bytes: &[u8]) -> f64 {
        let mut word = [0; 8];
        let own = &bytes[..self.bytes];
        if self.is_big_endian {
            let reversed = word.iter_mut().zip(own.iter().rev());
            reversed.for_each(|(to, from)| *to = *from);
        } else {
            word[..self.bytes].copy_from_slice(own);
        }
        let whole = u64::from_le_bytes(word);
        let unused = 64 - 8 * self.bytes as u32;
        match (self.kind, self.bytes) {
            (NumberKind::Truth, _) => f64::from(u8::from(whole != 0)) * 255.0,
            (NumberKind::Unsigned, _) => whole as f64,
            (NumberKind::Signed, _) => ((whole << unused).cast_signed() >> unused) as f64,
            (NumberKind::Float, 2) => f16::from_bits(whole as u16).to_f64(),
            (NumberKind::Float, 4) => f32::from_bits(whole as u32).into(),
            (NumberKind::Float, _) => f64::from_bits(whole),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_read_as_it_was_stored() {
        let read = |word: &str, bytes: &[u8]| Number::named(word).unwrap().read(bytes);
        assert_eq!(read("|b1", &[1]), 255.0);
        assert_eq!(read("|u1", &[200]), 200.0);
        assert_eq!(read("|i1", &(-3i8).to_le_bytes()), -3.0);
        assert_eq!(read("<u2", &[1, 2]), 513.0);
        assert_eq!(read(">u2", &[1, 2]), 258.0);
        assert_eq!(read(">i2", &(-300i16).to_be_bytes()), -300.0);
        assert_eq!(read("<i4", &(-70_000i32).to_le_bytes()), -70_000.0);
        assert_eq!(read("<i8", &(-5i64).to_le_bytes()), -5.0);
        assert_eq!(read("<f2", &f16::from_f32(0.75).to_le_bytes()), 0.75);
        assert_eq!(read(">f4", &0.1f32.to_be_bytes()), f64::from(0.1f32));
        assert_eq!(read("<f8", &(-0.3f64).to_le_bytes()), -0.3);
        for other in ["<c8", "<U3", "|O", "<f16", "<i3", "", "<", "u"] {
            assert_eq!(Number::named(other), None, "{other}");
        }
    }
}

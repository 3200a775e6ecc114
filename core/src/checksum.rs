//! The checksum of every file that is kept: CRC-32 (ISO-HDLC), four bytes at a time.
//!
//! By a table of one byte a processor without a unit for it takes ten instructions a byte, by four tables half of that.

/// The polynomial, its highest power first.
const POLYNOMIAL: u32 = 0xedb8_8320;

/// What a byte does to the sum that 0, 1, 2 and 3 bytes follow.
type Tables = [[u32; 256]; 4];

static TABLES: Tables = tables();

const fn tables() -> Tables {
    let mut tables = [[0; 256]; 4];
    let mut byte = 0;
    while byte < 256 {
        let mut sum = byte as u32;
        let mut shifted = 0;
        // Bit by bit, a byte and then zeros behind it.
        while shifted < 32 {
            sum = (sum >> 1) ^ (POLYNOMIAL & (sum & 1).wrapping_neg());
            shifted += 1;
            if shifted % 8 == 0 {
                tables[shifted / 8 - 1][byte] = sum;
            }
        }
        byte += 1;
    }
    tables
}

/// A checksum of bytes that come one part after another.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Checksum(u32);

impl Checksum {
    /// Of no bytes.
    pub(crate) const EMPTY: Self = Self(u32::MAX);

    /// Adds bytes that follow those before.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(crate) fn add(&mut self, bytes: &[u8]) {
        // Words where they begin: some processors read no others.
        let (before, words, after) = bytemuck::pod_align_to::<u8, u32>(bytes);
        let sum = one_by_one(self.0, before);
        let sum = words.iter().fold(sum, |sum, &word| {
            let [a, b, c, d] = (sum ^ u32::from_le(word)).to_le_bytes();
            let [last, third, second, first] = &TABLES;
            first[usize::from(a)]
                ^ second[usize::from(b)]
                ^ third[usize::from(c)]
                ^ last[usize::from(d)]
        });
        self.0 = one_by_one(sum, after);
    }

    /// The sum of what was added.
    pub(crate) fn finish(self) -> u32 {
        !self.0
    }
}

/// The checksum of parts that follow one another.
pub(crate) fn checksum<const N: usize>(parts: [&[u8]; N]) -> u32 {
    let mut sum = Checksum::EMPTY;
    parts.iter().for_each(|part| sum.add(part));
    sum.finish()
}

fn one_by_one(sum: u32, bytes: &[u8]) -> u32 {
    bytes.iter().fold(sum, |sum, &byte| {
        (sum >> 8) ^ TABLES[0][usize::from(sum as u8 ^ byte)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crc::{CRC_32_ISO_HDLC, Crc};
    use proptest::prelude::*;

    properties! {
        #[test]
        fn it_is_the_sum_that_others_make(
            bytes in proptest::collection::vec(any::<u8>(), 0..200),
            start in 0usize..9,
            between in 0usize..200,
        ) {
            let bytes = &bytes[start.min(bytes.len())..];
            let naive = Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(bytes);
            let (before, after) = bytes.split_at(between.min(bytes.len()));
            prop_assert_eq!(checksum([before, after]), naive);
        }
    }
}

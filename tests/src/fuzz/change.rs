//! Changes of files at random, the same for the same seed.

use super::Seed;

/// Xorshift of 64 bits.
pub struct Random(u64);

impl Random {
    /// Another series for each seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// The next one, of 53 bits.
    pub fn draw(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 >> 11
    }

    /// One below `most`.
    pub fn below(&mut self, most: usize) -> usize {
        (self.draw() % most.max(1) as u64) as usize
    }
}

/// Numbers that mean something as a count, a length or a side.
const NUMBERS: [u32; 10] = [
    0,
    1,
    2,
    0x10,
    0x7F,
    0xFF,
    0x2000,
    0xFFFF,
    0x7FFF_FFFF,
    u32::MAX,
];

/// One to six changes, half of them near the beginning, where headers are.
pub fn changed(whole: &[u8], seeds: &[Seed], random: &mut Random) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    for _ in 0..1 + random.below(6) {
        let near = [bytes.len(), bytes.len().min(400)][random.below(2)];
        let at = random.below(near);
        let end = (at + 1 + random.below(32)).min(bytes.len());
        let number = NUMBERS[random.below(NUMBERS.len())];
        match random.below(8) {
            0 => overwrite(&mut bytes, at, &[random.draw() as u8]),
            1 => overwrite(&mut bytes, at, &(number as u16).to_be_bytes()),
            2 => overwrite(&mut bytes, at, &(number as u16).to_le_bytes()),
            3 => overwrite(&mut bytes, at, &number.to_be_bytes()),
            4 => overwrite(&mut bytes, at, &number.to_le_bytes()),
            5 => bytes.truncate(at),
            6 => {
                let other = &seeds[random.below(seeds.len())].bytes;
                let from = random.below(other.len());
                let part = &other[from..(from + end.saturating_sub(at)).min(other.len())];
                overwrite(&mut bytes, at, part);
            }
            _ => {
                let part = bytes.get(at..end).unwrap_or_default().to_vec();
                bytes.splice(at..at, part);
            }
        }
    }
    bytes
}

fn overwrite(bytes: &mut [u8], at: usize, new: &[u8]) {
    for (place, value) in bytes.iter_mut().skip(at).zip(new) {
        *place = *value;
    }
}

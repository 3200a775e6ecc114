//! Lossless JPEG (process 14) by hand, after ITU-T T.81 annex H.

/// Bits in the making, with a zero after each byte of ones.
#[derive(Default)]
struct Bits {
    bytes: Vec<u8>,
    held: u32,
    count: u32,
}

impl Bits {
    fn push(&mut self, value: u32, length: u32) {
        for bit in (0..length).rev() {
            self.held = self.held << 1 | (value >> bit & 1);
            self.count += 1;
            if self.count == 8 {
                self.bytes.push(self.held as u8);
                if self.held as u8 == 0xFF {
                    self.bytes.push(0);
                }
                (self.held, self.count) = (0, 0);
            }
        }
    }

    fn finish(mut self) -> Vec<u8> {
        while self.count != 0 {
            self.push(1, 1);
        }
        self.bytes
    }
}

/// How an image is coded.
#[derive(Clone, Copy)]
pub(crate) struct Coding {
    /// Bits of a sample.
    pub precision: u8,
    /// Predictor 1 to 7 (table H.1).
    pub predictor: u8,
    /// Bits that are left out at the lower end.
    pub shift: u8,
    /// Rows between restart marks; 0 for none.
    pub restart_rows: u16,
}

/// A grey image of `precision` bits, with what X-ray units write: the first predictor and nothing else.
pub(crate) fn jpeg(width: u16, height: u16, precision: u8, pixels: &[u16]) -> Vec<u8> {
    let coding = Coding {
        precision,
        predictor: 1,
        shift: 0,
        restart_rows: 0,
    };
    coded(width, height, &[pixels], coding)
}

/// An image of one component or more, each a plane of pixels; all in one scan.
pub(crate) fn coded(width: u16, height: u16, planes: &[&[u16]], coding: Coding) -> Vec<u8> {
    let Coding {
        precision,
        predictor,
        shift,
        restart_rows,
    } = coding;
    let mut file = vec![0xFF, 0xD8];
    // 17 categories, each a code of five bits in order.
    file.extend([0xFF, 0xC4, 0, 19 + 17, 0, 0, 0, 0, 0, 17]);
    file.extend([0; 11]);
    file.extend(0..17u8);
    if restart_rows > 0 {
        file.extend([0xFF, 0xDD, 0, 4]);
        file.extend((restart_rows * width).to_be_bytes());
    }
    let count = planes.len() as u8;
    file.extend([0xFF, 0xC3, 0, 8 + 3 * count, precision]);
    file.extend(height.to_be_bytes());
    file.extend(width.to_be_bytes());
    file.push(count);
    file.extend((1..=count).flat_map(|id| [id, 0x11, 0]));
    file.extend([0xFF, 0xDA, 0, 6 + 2 * count, count]);
    file.extend((1..=count).flat_map(|id| [id, 0]));
    file.extend([predictor, 0, shift]);
    let width = usize::from(width);
    let interval = if restart_rows == 0 {
        usize::MAX
    } else {
        restart_rows.into()
    };
    let shifted: Vec<Vec<i32>> = planes
        .iter()
        .map(|plane| plane.iter().map(|&p| i32::from(p >> shift)).collect())
        .collect();
    let mut bits = Bits::default();
    for row in 0..usize::from(height) {
        if row > 0 && row % interval == 0 {
            file.extend(std::mem::take(&mut bits).finish());
            file.extend([0xFF, 0xD0 + ((row / interval - 1) % 8) as u8]);
        }
        for column in 0..width {
            for plane in &shifted {
                let at = row * width + column;
                let begins = row % interval == 0;
                let predicted = match (column, begins) {
                    (0, true) => 1 << (precision - shift - 1),
                    (_, true) => plane[at - 1],
                    (0, false) => plane[at - width],
                    _ => predict(
                        predictor,
                        plane[at - 1],
                        plane[at - width],
                        plane[at - width - 1],
                    ),
                };
                put(&mut bits, (plane[at] - predicted) as u16 as i16);
            }
        }
    }
    file.extend(bits.finish());
    file.extend([0xFF, 0xD9]);
    file
}

fn predict(predictor: u8, a: i32, b: i32, c: i32) -> i32 {
    match predictor {
        1 => a,
        2 => b,
        3 => c,
        4 => a + b - c,
        5 => a + ((b - c) >> 1),
        6 => b + ((a - c) >> 1),
        _ => (a + b) >> 1,
    }
}

fn put(bits: &mut Bits, difference: i16) {
    let difference = i32::from(difference);
    let category = 32 - difference.unsigned_abs().leading_zeros();
    bits.push(category, 5);
    if category < 16 {
        let coded = if difference < 0 {
            difference - 1
        } else {
            difference
        };
        bits.push(coded as u32 & ((1 << category) - 1), category);
    }
}

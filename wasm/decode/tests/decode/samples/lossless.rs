//! A lossless JPEG (process 14, first predictor) by hand, after ITU-T T.81 annex H: what X-ray units write.

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

/// A grey image of `precision` bits.
pub(crate) fn jpeg(width: u16, height: u16, precision: u8, pixels: &[u16]) -> Vec<u8> {
    let mut file = vec![0xFF, 0xD8];
    // 17 categories, each a code of five bits in order.
    file.extend([0xFF, 0xC4, 0, 19 + 17, 0, 0, 0, 0, 0, 17]);
    file.extend([0; 11]);
    file.extend(0..17u8);
    file.extend([0xFF, 0xC3, 0, 11, precision]);
    file.extend(height.to_be_bytes());
    file.extend(width.to_be_bytes());
    file.extend([1, 1, 0x11, 0]);
    file.extend([0xFF, 0xDA, 0, 8, 1, 1, 0, 1, 0, 0]);
    let mut bits = Bits::default();
    for (index, &pixel) in pixels.iter().enumerate() {
        let width = usize::from(width);
        let predicted = match (index % width, index / width) {
            (0, 0) => 1 << (precision - 1),
            (0, _) => pixels[index - width],
            _ => pixels[index - 1],
        };
        let difference = i32::from(pixel.wrapping_sub(predicted).cast_signed());
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
    file.extend(bits.finish());
    file.extend([0xFF, 0xD9]);
    file
}

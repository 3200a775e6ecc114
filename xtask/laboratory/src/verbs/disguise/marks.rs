//! Words and a ruler, as a system burns them into its pictures.

/// Letters of five columns and seven rows, a row a number: K, N, E, E, blank, L.
const LETTERS: [[u8; 7]; 6] = [
    [
        0b10001, 0b10010, 0b10100, 0b11000, 0b10100, 0b10010, 0b10001,
    ],
    [
        0b10001, 0b11001, 0b10101, 0b10101, 0b10011, 0b10001, 0b10001,
    ],
    [
        0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b11111,
    ],
    [
        0b11111, 0b10000, 0b10000, 0b11110, 0b10000, 0b10000, 0b11111,
    ],
    [0; 7],
    [
        0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b11111,
    ],
];

/// White words in the corner left above of intensities row by row, and a white ruler along the lower border.
pub(super) fn burn_in(pixels: &mut [f64], (width, height): (usize, usize)) {
    // A dot of a letter is so many pixels wide.
    let dot = (width.min(height) / 256).max(1);
    let mut white = |column: usize, row: usize| {
        if column < width && row < height {
            pixels[row * width + column] = 1.0;
        }
    };
    for (place, letter) in LETTERS.iter().enumerate() {
        for (row, bits) in letter.iter().enumerate() {
            for column in (0..5).filter(|column| bits >> (4 - column) & 1 == 1) {
                for k in 0..dot * dot {
                    white(
                        (4 + 6 * place + column) * dot + k % dot,
                        (4 + row) * dot + k / dot,
                    );
                }
            }
        }
    }
    let (foot, tick) = (height.saturating_sub(6 * dot), 10 * dot);
    for column in width / 4..3 * width / 4 {
        let high = match (column - width / 4) % tick {
            0 if (column - width / 4) / tick % 5 == 0 => 10 * dot,
            0 => 5 * dot,
            _ => 1,
        };
        (0..high).for_each(|up| white(column, foot.saturating_sub(up)));
    }
}

//! Median filter of a grey frame: the remedy of Walker et al. 1996 for quantum mottle before tracing.

use crate::image::frame::{Frame, FrameError, Pixel};

/// The square window of a median filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Window {
    /// 3 x 3 pixels.
    Three,
    /// 5 x 5 pixels.
    Five,
}

/// Writes the median of each pixel's neighbourhood to `out` (`width * height` pixels, no gaps).
/// Beyond the border the frame's nearest pixel is taken.
///
/// # Errors
/// [`FrameError::BufferTooShort`] when `out` is.
pub fn median_filter<P: Pixel>(
    frame: &Frame<'_, P>,
    window: Window,
    out: &mut [P],
) -> Result<(), FrameError> {
    let needed = frame.width() * frame.height();
    if out.len() < needed {
        return Err(FrameError::BufferTooShort {
            needed,
            given: out.len(),
        });
    }
    for (row, target) in out
        .chunks_exact_mut(frame.width())
        .take(frame.height())
        .enumerate()
    {
        for (column, pixel) in target.iter_mut().enumerate() {
            *pixel = match window {
                Window::Three => median_at::<P, 9>(frame, column, row, 1),
                Window::Five => median_at::<P, 25>(frame, column, row, 2),
            };
        }
    }
    Ok(())
}

fn median_at<P: Pixel, const AREA: usize>(
    frame: &Frame<'_, P>,
    column: usize,
    row: usize,
    reach: isize,
) -> P {
    let side = 2 * reach + 1;
    let mut values: [P; AREA] = core::array::from_fn(|k| {
        let (down, right) = (k as isize / side, k as isize % side);
        frame.nearest(column as isize + right - reach, row as isize + down - reach)
    });
    *values.select_nth_unstable(AREA / 2).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_sorting_everything() {
        let mut seed = 1u32;
        let pixels: [u16; 63] = core::array::from_fn(|_| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 16) as u16
        });
        let frame = Frame::new(&pixels, 9, 7, 9).expect("fits");
        for (window, reach) in [(Window::Three, 1isize), (Window::Five, 2)] {
            let mut out = [0u16; 63];
            median_filter(&frame, window, &mut out).expect("fits");
            for row in 0..7isize {
                for column in 0..9isize {
                    let mut all: heapless::Vec<u16, 25> = heapless::Vec::new();
                    for r in row - reach..=row + reach {
                        for c in column - reach..=column + reach {
                            let index = r.clamp(0, 6) * 9 + c.clamp(0, 8);
                            all.push(pixels[index as usize]).expect("25 at most");
                        }
                    }
                    all.sort_unstable();
                    assert_eq!(out[(row * 9 + column) as usize], all[all.len() / 2]);
                }
            }
        }
    }

    #[test]
    fn a_speck_goes_and_an_edge_stays() {
        let mut pixels = [10u8; 49];
        for row in pixels.chunks_exact_mut(7) {
            row[4..].fill(200);
        }
        pixels[3 * 7 + 1] = 255;
        let frame = Frame::new(&pixels, 7, 7, 7).expect("fits");
        let mut out = [0u8; 49];
        median_filter(&frame, Window::Three, &mut out).expect("fits");
        for row in out.chunks_exact(7) {
            assert_eq!(row, [10, 10, 10, 10, 200, 200, 200]);
        }
    }
}

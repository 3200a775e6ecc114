//! A frame as it would be without distortion: each pixel of the straight frame is looked up where the polynomial says it
//! was, by cubic interpolation.

use super::distortion::Distortion;
use fluoropose::image::frame::{Frame, Pixel};
use fluoropose::math::{floor, round};

/// Where each pixel of one row of the straight frame is in the frame as taken: column and row, NaN where it is nowhere.
///
/// `out` holds as many places as are wanted, from the left. The map of a correction is the same for all its frames.
pub fn map_row(distortion: &Distortion, row: usize, out: &mut [[f32; 2]]) {
    let mut shift = [0.0; 2];
    for (column, place) in out.iter_mut().enumerate() {
        let straight = [column as f64 + 0.5, row as f64 + 0.5];
        // The neighbour to the left was moved nearly alike.
        let guess = [straight[0] + shift[0], straight[1] + shift[1]];
        let found = distortion
            .bent_from(straight, guess)
            .or_else(|| distortion.bent(straight));
        *place = found.map_or([f32::NAN; 2], |[column, row]| [column as f32, row as f32]);
        shift = found.map_or([0.0; 2], |[column, row]| {
            [column - straight[0], row - straight[1]]
        });
    }
}

/// Grey values at the places of a row's map (Catmull and Rom's cubic); black where the frame has none.
pub fn resample_row<P: Pixel>(frame: &Frame<'_, P>, map: &[[f32; 2]], out: &mut [P]) {
    for (place, pixel) in map.iter().zip(out) {
        *pixel = at(frame, *place);
    }
}

fn at<P: Pixel>(frame: &Frame<'_, P>, [column, row]: [f32; 2]) -> P {
    let (column, row) = (f64::from(column), f64::from(row));
    let inside = (0.0..=frame.width() as f64).contains(&column)
        && (0.0..=frame.height() as f64).contains(&row);
    if !inside {
        return P::default();
    }
    let (column, row) = (column - 0.5, row - 0.5);
    let (left, above) = (floor(column), floor(row));
    let (across, along) = (weights(column - left), weights(row - above));
    let mut value = 0.0;
    for (k, weight) in along.iter().enumerate() {
        let mut inner = 0.0;
        for (l, share) in across.iter().enumerate() {
            let grey: u32 = frame
                .nearest(
                    left as isize + l as isize - 1,
                    above as isize + k as isize - 1,
                )
                .into();
            inner += share * f64::from(grey);
        }
        value += weight * inner;
    }
    P::from_u32(round(value.max(0.0)) as u32)
}

/// Shares of the four samples about a place that lies `t` after the second.
fn weights(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        (-t + 2.0 * t2 - t3) / 2.0,
        (2.0 - 5.0 * t2 + 3.0 * t3) / 2.0,
        (t + 4.0 * t2 - 3.0 * t3) / 2.0,
        (t3 - t2) / 2.0,
    ]
}

#[cfg(test)]
mod tests {
    use super::super::distortion::NUMBERS;
    use super::*;
    use std::vec;

    /// The correction that moves every place by so much.
    fn shift(right: f64, down: f64) -> Distortion {
        let mut numbers = [0.0; NUMBERS];
        numbers[..6].copy_from_slice(&[3.0, 40.0, 30.0, 20.0, 15.0, 10.0]);
        numbers[6..9].copy_from_slice(&[right / 10.0, 1.0, 0.0]);
        numbers[27..30].copy_from_slice(&[down / 10.0, 0.0, 1.0]);
        Distortion::from_numbers(&numbers).expect("a correction")
    }

    #[test]
    fn a_shift_by_whole_pixels_moves_them_unchanged_and_one_by_halves_a_ramp() {
        let pixels: [u16; 1200] =
            core::array::from_fn(|k| 100 * (k % 40) as u16 + 7 * (k / 40) as u16);
        let frame = Frame::new(&pixels, 40, 30, 40).expect("fits");
        let mut map = vec![[0.0; 2]; 40];
        let mut out = vec![0u16; 40];
        map_row(&shift(3.0, -2.0), 10, &mut map);
        resample_row(&frame, &map, &mut out);
        assert_eq!(out[3..], pixels[12 * 40..12 * 40 + 37]);
        assert_eq!(out[..3], [0; 3]);
        map_row(&shift(0.5, 0.0), 10, &mut map);
        resample_row(&frame, &map, &mut out);
        for (column, &grey) in out.iter().enumerate().take(38).skip(3) {
            assert_eq!(grey, 100 * column as u16 - 50 + 70);
        }
    }
}

//! Undistorted frames: each pixel is read at its place in the frame as taken, by cubic interpolation.

use crate::distortion::Distortion;
use fluoropose::image::frame::{Frame, Pixel};
use fluoropose::math::{floor, round};

/// Writes for the first pixels of row `row` of the undistorted frame, one for each place in `out`, their places (column,
/// row) in the frame as taken, px; NaN where there is none.
///
/// The places are the same for all frames that a correction is applied to.
pub fn map_row(distortion: &Distortion, row: usize, out: &mut [[f32; 2]]) {
    let mut shift = [0.0; 2];
    for (column, place) in out.iter_mut().enumerate() {
        let undistorted = [column as f64 + 0.5, row as f64 + 0.5];
        // The neighbour to the left was moved nearly alike.
        let guess = [undistorted[0] + shift[0], undistorted[1] + shift[1]];
        let found = distortion
            .distorted_from(undistorted, guess)
            .or_else(|| distortion.distorted(undistorted));
        *place = found.map_or([f32::NAN; 2], |[column, row]| [column as f32, row as f32]);
        shift = found.map_or([0.0; 2], |[column, row]| {
            [column - undistorted[0], row - undistorted[1]]
        });
    }
}

/// Writes the grey values at the places that [`map_row`] gave, by the cubic of Catmull and Rom (*A class of local
/// interpolating splines*, 1974); 0 where there is no place.
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
        for (l, factor) in across.iter().enumerate() {
            let grey: u32 = frame
                .nearest(
                    left as isize + l as isize - 1,
                    above as isize + k as isize - 1,
                )
                .into();
            inner += factor * f64::from(grey);
        }
        value += weight * inner;
    }
    P::from_u32(round(value.max(0.0)) as u32)
}

/// Weights of four samples for a place that lies `t` after the second.
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
    use super::*;
    use crate::distortion::NUMBERS;
    use std::vec;

    /// The correction that moves every place to the right and down by these distances, px.
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

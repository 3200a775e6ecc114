//! A ruler with opaque marks on the detector.

use super::plane::Plane;

/// The ruler's left side and width, parts of the frame's width; it runs from a fifth to four fifths of the frame's height.
const LEFT: f64 = 0.24;
const WIDTH: f64 = 0.05;
const REACH: std::ops::Range<f64> = 0.2..0.8;
/// Marks in that reach; each fifth one is as long as the ruler is wide, the others half.
const MARKS: usize = 60;
/// What passes the ruler and a mark.
const BODY: f64 = 0.93;
const MARK: f64 = 0.1;

/// Lays the ruler over a transmission picture.
pub(super) fn lay(picture: &mut Plane) {
    let (width, height) = (picture.width, picture.height);
    let pitch = (REACH.end - REACH.start) / MARKS as f64;
    let rows = picture.values.chunks_mut(width).enumerate();
    for (row, pixels) in rows {
        let down = (row as f64 + 0.5) / height as f64;
        if !REACH.contains(&down) {
            continue;
        }
        let place = (down - REACH.start) / pitch;
        let long = (place as usize).is_multiple_of(5);
        for (column, pixel) in pixels.iter_mut().enumerate() {
            let across = ((column as f64 + 0.5) / width as f64 - LEFT) / WIDTH;
            if !(0.0..1.0).contains(&across) {
                continue;
            }
            let marked = place.fract() < 0.25 && (long || across < 0.5);
            *pixel *= if marked { MARK } else { BODY };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ruler_has_its_marks_and_leaves_the_rest_alone() {
        let mut picture = Plane {
            width: 200,
            height: 1000,
            values: vec![1.0; 200 * 1000],
        };
        lay(&mut picture);
        let at = |column: usize, row: usize| picture.values[row * 200 + column];
        let edges = (1..1000).filter(|&row| at(50, row) == MARK && at(50, row - 1) != MARK);
        assert_eq!(edges.count(), MARKS);
        assert_eq!([at(100, 500), at(50, 100)], [1.0, 1.0]);
    }
}

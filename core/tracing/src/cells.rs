//! A whole frame in cells of some pixels each: enough to see where something lies, and soon looked at.

use fluoropose::camera::Camera;
use fluoropose::image::contour::Point;
use fluoropose::image::grey::Grey;

/// The frame is read at so many places along its longer side.
const CELLS: usize = 256;

/// How a frame is cut into cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cells {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// The side of each, pixels.
    pub(crate) side: f64,
}

impl Cells {
    /// Those of frames of a camera.
    pub(crate) fn of(camera: &Camera) -> Self {
        let (width, height) = (camera.width() as f64, camera.height() as f64);
        let side = (width.max(height) / CELLS as f64).max(1.0);
        Self {
            columns: (width / side) as usize,
            rows: (height / side) as usize,
            side,
        }
    }

    pub(crate) fn count(&self) -> usize {
        self.columns * self.rows
    }

    /// The middle of a cell.
    pub(crate) fn middle(&self, column: usize, row: usize) -> Point {
        let at = |cell: usize| (cell as f64 + 0.5) * self.side;
        Point::new(at(column), at(row))
    }

    /// The mean of four readings in a cell; `None` where one of them is not of the picture.
    pub(crate) fn grey(&self, frame: &dyn Grey, column: usize, row: usize) -> Option<f64> {
        let places = [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)];
        let (width, height) = frame.size();
        let [left, top] = [column, row].map(|at| at as f64 * self.side);
        let read = |(right, down): (f64, f64)| {
            let column = (left + right * self.side).clamp(0.5, width as f64 - 0.5);
            let row = (top + down * self.side).clamp(0.5, height as f64 - 0.5);
            frame.at(column, row)
        };
        let mut sum = 0.0;
        for place in places {
            sum += read(place)?;
        }
        Some(sum / 4.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::image::frame::Frame;

    #[test]
    fn a_cell_has_the_grey_of_its_middle_where_the_picture_is_a_slope() {
        let (width, height) = (640, 400);
        let pixels: std::vec::Vec<u16> = (0..width * height)
            .map(|k| (20 * (k % width) + 50 * (k / width)) as u16)
            .collect();
        let frame = Frame::new(&pixels, width, height, width).expect("fits");
        let camera = Camera::new(width, height, [2000.0; 2], [320.0, 200.0]).expect("valid");
        let cells = Cells::of(&camera);
        assert_eq!((cells.columns, cells.rows, cells.side), (256, 160, 2.5));
        for (column, row) in [(1, 1), (100, 30), (254, 158)] {
            let at = cells.middle(column, row);
            let slope = 20.0 * (at.column - 0.5) + 50.0 * (at.row - 0.5);
            let grey = cells.grey(&frame, column, row).expect("in the picture");
            assert!((grey - slope).abs() < 0.01, "{grey}, {slope}");
        }
        // No part of a pixel beyond it is asked.
        assert!(cells.grey(&frame, 0, 0).is_some_and(|grey| grey >= 0.0));
    }
}

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

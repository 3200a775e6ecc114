//! Places in an image.

/// A point of the image plane in continuous coordinates: the centre of the first pixel is
/// (0.5, 0.5), `row` grows downwards. Laid out as C has two doubles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Point {
    /// Pixels to the right of the frame's left border.
    pub column: f64,
    /// Pixels below the frame's upper border.
    pub row: f64,
}

impl Point {
    /// The point at a column and row.
    #[must_use]
    pub fn new(column: f64, row: f64) -> Self {
        Self { column, row }
    }

    pub(super) fn is_finite(self) -> bool {
        self.column.is_finite() && self.row.is_finite()
    }
}

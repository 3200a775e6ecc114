//! The state of every frame, at the end.

use fluoropose::follow::{Cell, Conclusion, conclude, fill_gaps};

use super::part::Part;
use super::sides::Margins;

/// Judges a component's frames. `depths` are those of the other component.
pub(super) fn judge(
    part: &Part<'_>,
    cells: &[Cell],
    margins: &Margins,
    depths: &[Option<f64>],
    interpolate: usize,
) -> Vec<Conclusion> {
    let mut film = conclude(cells, margins, depths, &part.middle());
    fill_gaps(&mut film, interpolate, &part.middle());
    film
}

//! The state of every frame, at the end.

use fluoropose::follow::{Cell, Conclusion, Distrust, conclude, fill_gaps};

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
    // Right or not, they are not those of the component whose name they bear.
    if let Some(shape) = part.other_shape() {
        let all = film.iter_mut();
        all.for_each(|one| one.distrust(Distrust::Shape(shape)));
    }
    film
}

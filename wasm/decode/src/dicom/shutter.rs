//! Display shutters (DICOM PS3.3 C.7.6.11). Rows and columns are counted from 1, and those stated as edges are open.

use super::tags::{
    SHUTTER, SHUTTER_BOTTOM, SHUTTER_CENTRE, SHUTTER_CORNERS, SHUTTER_LEFT, SHUTTER_RADIUS,
    SHUTTER_RIGHT, SHUTTER_TOP,
};
use super::values::Values;
use crate::shutter::{MAX_CORNERS, Shape, Shutter};

/// What a file says of a shutter.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Stated {
    /// Where it is.
    Known(Shutter),
    /// There is one and it is not known where: its numbers are missing or too many, or it is a bitmap.
    Unknown,
}

/// The shutter that elements state; `None` where they state none.
pub(super) fn read(values: Values<'_>) -> Option<Stated> {
    let words = values.text(SHUTTER).filter(|words| !words.is_empty())?;
    let shapes: Option<Vec<Shape>> = words
        .split('\\')
        .take(4)
        .map(|word| shape(values, word.trim()))
        .collect();
    Some(shapes.map_or(Stated::Unknown, |shapes| Stated::Known(Shutter::of(shapes))))
}

fn shape(values: Values<'_>, word: &str) -> Option<Shape> {
    // The centre of the pixel with the number 1 is at 0.5.
    let place = |number: f64| number - 0.5;
    let numbers = |tag, most| {
        let numbers = values.numbers_up_to(tag, most)?;
        numbers.iter().all(|v| v.is_finite()).then_some(numbers)
    };
    match word {
        "RECTANGULAR" => {
            let edge = |tag| values.finite(tag).map(place);
            let (left, top) = (edge(SHUTTER_LEFT)?, edge(SHUTTER_TOP)?);
            let (right, bottom) = (edge(SHUTTER_RIGHT)?, edge(SHUTTER_BOTTOM)?);
            Some(Shape::Rectangle([left, top, right, bottom]))
        }
        "CIRCULAR" => {
            let &[row, column] = numbers(SHUTTER_CENTRE, 2)?.as_slice() else {
                return None;
            };
            let radius = values.positive(SHUTTER_RADIUS)?;
            Some(Shape::Circle([place(column), place(row), radius]))
        }
        "POLYGONAL" => {
            let numbers = numbers(SHUTTER_CORNERS, 2 * MAX_CORNERS)?;
            let (corners, rest) = numbers.as_chunks::<2>();
            let corners = corners.iter().map(|corner| corner.map(place));
            let corners: Vec<[f64; 2]> = corners.map(|[row, column]| [column, row]).collect();
            (corners.len() >= 3 && rest.is_empty()).then_some(Shape::Polygon(corners))
        }
        _ => None,
    }
}

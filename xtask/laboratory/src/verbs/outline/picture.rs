//! A picture of an answer: the frame, the outlines of mask and answer, and the prompt.

use std::path::Path;

use anyhow::Result;
use fluoropose::image::grey::Grey;
use fluoropose::image::mask::Mask;
use fluoropose_phantom::picture::write_colour;
use fluoropose_tracing::one_click::Prompt;

/// Pixels round mask and answer that are shown.
const MARGIN: usize = 40;
/// Each pixel is drawn so many times as wide and high.
const ZOOM: usize = 2;

/// Green for the mask, red for the answer, yellow for the prompt.
const COLOURS: [[u8; 3]; 3] = [[0, 220, 0], [255, 60, 40], [255, 220, 0]];

/// Writes the picture as PNG.
///
/// # Errors
/// Names the file that cannot be written.
pub(super) fn write(
    path: &Path,
    frame: &dyn Grey,
    mask: &Mask<'_>,
    answer: &Mask<'_>,
    prompt: &Prompt,
) -> Result<()> {
    let (left, top, right, bottom) = shown(mask, answer);
    let (width, height) = (ZOOM * (right - left), ZOOM * (bottom - top));
    let place = |x: usize, y: usize| (left + x / ZOOM, top + y / ZOOM);
    let grey = |column: usize, row: usize| {
        frame
            .at(column as f64 + 0.5, row as f64 + 0.5)
            .unwrap_or(0.0)
    };
    let inside = (top..bottom).flat_map(|row| (left..right).map(move |column| (column, row)));
    let (low, high) = inside.fold((f64::MAX, f64::MIN), |(low, high), (column, row)| {
        let value = grey(column, row);
        (low.min(value), high.max(value))
    });
    let colour = |x: usize, y: usize| {
        let (column, row) = place(x, y);
        if on_prompt(prompt, column, row) {
            return COLOURS[2];
        }
        for (mask, colour) in [(answer, COLOURS[1]), (mask, COLOURS[0])] {
            if is_border(mask, column, row) {
                return colour;
            }
        }
        let shade = 255.0 * (grey(column, row) - low) / (high - low).max(1.0);
        [shade as u8; 3]
    };
    let picture: Vec<[u8; 3]> = (0..width * height)
        .map(|k| colour(k % width, k / width))
        .collect();
    write_colour(path, (width, height), &picture)
}

/// Left, top, right and bottom of what is shown.
fn shown(mask: &Mask<'_>, answer: &Mask<'_>) -> (usize, usize, usize, usize) {
    let [(c, r), (d, s)] = [mask.bounds(), answer.bounds()];
    (
        c.start.min(d.start).saturating_sub(MARGIN),
        r.start.min(s.start).saturating_sub(MARGIN),
        (c.end.max(d.end) + MARGIN).min(mask.width()),
        (r.end.max(s.end) + MARGIN).min(mask.height()),
    )
}

fn is_border(mask: &Mask<'_>, column: usize, row: usize) -> bool {
    let set = |c: usize, r: usize| mask.get(c, r);
    let round = set(column.wrapping_sub(1), row)
        && set(column + 1, row)
        && set(column, row.wrapping_sub(1))
        && set(column, row + 1);
    set(column, row) && !round
}

fn on_prompt(prompt: &Prompt, column: usize, row: usize) -> bool {
    let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
    match prompt {
        Prompt::Click(at) => (at.column - x).abs() <= 1.5 && (at.row - y).abs() <= 1.5,
        Prompt::Box(low, high) => {
            let (across, down) = (low.column..high.column, low.row..high.row);
            let edge = |at: f64, side: f64| (at - side).abs() <= 0.5;
            (across.contains(&x) && (edge(y, low.row) || edge(y, high.row)))
                || (down.contains(&y) && (edge(x, low.column) || edge(x, high.column)))
        }
    }
}

//! Pictures of a film: the X-ray with the models' outlines laid on, and the curves running beside it.

mod curve;
mod ground;
mod inks;

use crate::drawing::{Anchor, Colour, Drawing, Dress, Stroke};
use crate::film::JointFilm;
use crate::letters::Font;
use crate::picture::Picture;
use curve::Curve;
use inks::{GROUND, QUIET, TEXT};

/// Okabe and Ito's: told apart by colour-blind people, and the same in the page.
const COMPONENTS: [Colour; 2] = [Colour([0x56, 0xb4, 0xe9]), Colour([0xe6, 0x9f, 0x00])];
/// Rows of a picture: frames that are larger are drawn smaller, much smaller ones larger.
const ROWS: [usize; 2] = [480, 1080];
/// Width of what stands beside the frame, and its heading's height, as parts of the picture's height.
const BESIDE: f64 = 0.56;
const HEADING: f64 = 0.16;
/// Size of the lines that say why a frame is doubtful, as a part of the picture's height in percent, and how many there may be.
const NOTE: f64 = 1.6;
const NOTES: usize = 4;

/// A frame as it is shown.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'s> {
    /// Grey from black to white, row by row.
    pub grey: &'s [u8],
    /// Corners (column, row) of the outlines of the femoral and of the tibial component, on the frame's pixels; none without a pose.
    pub outlines: [Option<&'s [[f64; 2]]>; 2],
}

/// A film whose pictures are drawn one by one.
pub struct Overlay<'f> {
    film: &'f JointFilm,
    /// Columns and rows of the frames.
    frame: [usize; 2],
    /// Pixels of the picture for one of the frame.
    scale: f64,
    curves: Vec<Curve>,
    /// What all pictures have.
    still: Picture,
}

impl<'f> Overlay<'f> {
    /// A film of frames of a size, columns and rows.
    #[must_use]
    pub fn new(film: &'f JointFilm, frame: [usize; 2]) -> Self {
        let [columns, rows] = frame.map(|side| side.max(1));
        let height = even(rows.clamp(ROWS[0], ROWS[1]) as f64);
        let scale = height as f64 / rows as f64;
        let across = even(columns as f64 * scale);
        let width = across + even(BESIDE * height as f64);
        let unit = height as f64 / 100.0;
        let left = across as f64 + 3.0 * unit;
        let area = [left, width as f64 - 3.0 * unit];
        let down = [HEADING * height as f64, height as f64 - 2.0 * unit];
        let curves = curve::of(film, area, down, unit);
        let mut drawing = Drawing::default();
        curves.iter().for_each(|curve| curve.draw(&mut drawing));
        let mut still = Picture::plain([width, height], GROUND);
        still.draw(&drawing.marks, 1.0);
        Self {
            film,
            frame: [columns, rows],
            scale,
            curves,
            still,
        }
    }

    /// A frame, from 0, as it is shown.
    #[must_use]
    pub fn picture(&self, index: usize, shown: &Shown<'_>) -> Picture {
        let mut picture = self.still.clone();
        let size = self.frame.map(|side| even(side as f64 * self.scale));
        ground::lay(&mut picture, size, shown.grey, self.frame);
        let mut drawing = Drawing::default();
        for (corners, colour) in shown.outlines.iter().zip(COMPONENTS) {
            let Some(corners) = corners.filter(|corners| corners.len() > 2) else {
                continue;
            };
            // Nothing of it lies beside the frame.
            let place = |at: &[f64; 2]| {
                let [x, y] = at.map(|x| x * self.scale);
                [x.min(size[0] as f64), y]
            };
            let around: Vec<[f64; 2]> = corners.iter().map(place).collect();
            // A dark line below it: the frame may be as bright as it is.
            let below = Stroke::of(Colour::grey(0), 3.6).fainter(0.5);
            for stroke in [below, Stroke::of(colour, 1.8)] {
                drawing.shape(&around, Dress::hollow(stroke));
            }
        }
        self.heading(&mut drawing, index, shown);
        self.curves
            .iter()
            .for_each(|curve| curve.here(&mut drawing, index));
        picture.draw(&drawing.marks, 1.0);
        picture
    }

    fn heading(&self, drawing: &mut Drawing, index: usize, shown: &Shown<'_>) {
        let [width, height] = self.still.size().map(|side| side as f64);
        let unit = height / 100.0;
        let left = even(self.frame[0] as f64 * self.scale) as f64 + 3.0 * unit;
        let wide = width - left - 3.0 * unit;
        let count = self.film.rows.len();
        let row = self.film.rows.get(index);
        let number = row.map_or(index + 1, |row| row.number);
        let mut words = |y: f64, size: f64, colour, text: &str| {
            let text = cut(text, wide / (size * unit));
            drawing.tinted([left, y * unit], Anchor::Start, size * unit, colour, &text);
        };
        words(3.4, 2.0, QUIET, &self.film.name);
        words(7.2, 3.2, TEXT, &format!("Frame {number} of {count}"));
        let missing = shown.outlines.iter().zip(["Femur", "Tibia"]);
        let missing = missing.filter(|(outline, _)| outline.is_none());
        let missing = missing.map(|(_, name)| format!("{name}: no pose"));
        let doubt = row.and_then(|row| row.doubt.clone());
        let notes = missing.chain(doubt.map(|doubt| format!("doubtful: {doubt}")));
        let lines = notes.flat_map(|note| broken(&note, wide / (NOTE * unit)));
        for (at, line) in most(lines.collect(), NOTES).iter().enumerate() {
            words(10.0 + 1.8 * at as f64, NOTE, QUIET, line);
        }
        if let Some(rate) = self.film.frames_per_s {
            let time = format!("{:.2} s", (number - 1) as f64 / rate);
            let at = [left + wide, 7.2 * unit];
            drawing.tinted(at, Anchor::End, 2.4 * unit, TEXT, &time);
        }
    }
}

/// Words as lines that are no longer than their place, in their size, broken between words.
fn broken(text: &str, wide: f64) -> Vec<String> {
    let width = |text: &str| Font::of(false).map_or(0.0, |font| font.width(text));
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(&format!("{line} {word}")) <= wide => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The first few lines; where there are more, the last of them says so.
fn most(mut lines: Vec<String>, count: usize) -> Vec<String> {
    if lines.len() > count {
        lines.truncate(count);
        if let Some(last) = lines.last_mut() {
            last.push('\u{2026}');
        }
    }
    lines
}

/// Words that are too long for their place, in their size, are cut.
fn cut(text: &str, wide: f64) -> String {
    let width = |text: &str| Font::of(false).map_or(0.0, |font| font.width(text));
    if width(text) <= wide {
        return text.to_owned();
    }
    let mut shown = text.to_owned();
    while shown.pop().is_some() {
        let all = format!("{}\u{2026}", shown.trim_end());
        if width(&all) <= wide {
            return all;
        }
    }
    shown
}

/// Films have even sides.
fn even(side: f64) -> usize {
    2 * (side / 2.0).round() as usize
}

#[cfg(test)]
mod tests;

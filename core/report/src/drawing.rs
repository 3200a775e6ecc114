//! A drawing as it is put together: marks that are written as SVG, PDF or pixels.
//!
//! Own code, some two hundred lines, instead of a plotting crate: `plotters` draws for pixels, so it has no groups, classes or
//! titles, by which a page finds a frame's point and a printer a figure's parts, and it must measure fonts that an SVG does not have.

use std::fmt::Display;

/// A colour, eight bits for red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Colour(pub(crate) [u8; 3]);

/// Of words and axes.
pub(crate) const BLACK: Colour = Colour::grey(0x11);
pub(crate) const WHITE: Colour = Colour::grey(0xff);

impl Colour {
    pub(crate) const fn grey(level: u8) -> Self {
        Self([level; 3])
    }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) colour: Colour,
    pub(crate) width: f64,
    /// Lengths of dashes and gaps; none for a whole line.
    pub(crate) dashes: &'static [f64],
    pub(crate) opacity: f64,
}

impl Stroke {
    pub(crate) const fn of(colour: Colour, width: f64) -> Self {
        Self {
            colour,
            width,
            dashes: &[],
            opacity: 1.0,
        }
    }

    pub(crate) const fn dashed(self, dashes: &'static [f64]) -> Self {
        Self { dashes, ..self }
    }

    pub(crate) const fn fainter(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

/// How a shape is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Dress {
    /// Colour and opacity of what is inside.
    pub(crate) fill: Option<(Colour, f64)>,
    /// The line around it.
    pub(crate) border: Option<Stroke>,
}

impl Dress {
    pub(crate) const fn filled(colour: Colour) -> Self {
        Self::faint(colour, 1.0)
    }

    pub(crate) const fn faint(colour: Colour, opacity: f64) -> Self {
        Self {
            fill: Some((colour, opacity)),
            border: None,
        }
    }

    pub(crate) const fn hollow(border: Stroke) -> Self {
        Self {
            fill: None,
            border: Some(border),
        }
    }

    pub(crate) const fn within(self, border: Stroke) -> Self {
        Self {
            border: Some(border),
            ..self
        }
    }
}

/// Where a text stands relative to its point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// Words on one line.
#[derive(Clone, Debug)]
pub(crate) struct Words {
    pub(crate) at: [f64; 2],
    pub(crate) anchor: Anchor,
    pub(crate) size: f64,
    pub(crate) bold: bool,
    /// Whether they run upwards.
    pub(crate) upwards: bool,
    pub(crate) colour: Colour,
    pub(crate) text: String,
}

/// One mark of a drawing, in its own units, x to the right and y down.
#[derive(Clone, Debug)]
pub(crate) enum Mark {
    /// A group of a class begins.
    Open(&'static str),
    /// It ends.
    Close,
    /// A line through points.
    Line(Vec<[f64; 2]>, Stroke),
    /// A polygon.
    Shape(Vec<[f64; 2]>, Dress),
    /// A circle with a title, which a page shows where the pointer is.
    Point {
        at: [f64; 2],
        radius: f64,
        dress: Dress,
        title: String,
    },
    /// A square of this half side.
    Square {
        at: [f64; 2],
        half: f64,
        dress: Dress,
    },
    Words(Words),
}

/// Marks in the order in which they are drawn.
#[derive(Default)]
pub(crate) struct Drawing {
    pub(crate) marks: Vec<Mark>,
}

impl Drawing {
    /// Opens a group of a class.
    pub(crate) fn open(&mut self, class: &'static str) {
        self.marks.push(Mark::Open(class));
    }

    pub(crate) fn close(&mut self) {
        self.marks.push(Mark::Close);
    }

    pub(crate) fn line(&mut self, points: &[[f64; 2]], stroke: Stroke) {
        self.marks.push(Mark::Line(points.to_vec(), stroke));
    }

    pub(crate) fn shape(&mut self, points: &[[f64; 2]], dress: Dress) {
        self.marks.push(Mark::Shape(points.to_vec(), dress));
    }

    pub(crate) fn point(&mut self, at: [f64; 2], radius: f64, dress: Dress, title: &str) {
        let title = title.to_owned();
        self.marks.push(Mark::Point {
            at,
            radius,
            dress,
            title,
        });
    }

    pub(crate) fn square(&mut self, at: [f64; 2], half: f64, dress: Dress) {
        self.marks.push(Mark::Square { at, half, dress });
    }

    pub(crate) fn words(&mut self, at: [f64; 2], anchor: Anchor, size: f64, text: impl Display) {
        self.write(at, anchor, size, text, [false, false]);
    }

    /// Words in a colour.
    #[cfg(feature = "png")]
    pub(crate) fn tinted(
        &mut self,
        at: [f64; 2],
        anchor: Anchor,
        size: f64,
        colour: Colour,
        text: &str,
    ) {
        self.words(at, anchor, size, text);
        if let Some(Mark::Words(words)) = self.marks.last_mut() {
            words.colour = colour;
        }
    }

    pub(crate) fn bold(&mut self, at: [f64; 2], size: f64, text: impl Display) {
        self.write(at, Anchor::Start, size, text, [true, false]);
    }

    /// Words that run upwards, centred on a point.
    pub(crate) fn upwards(&mut self, at: [f64; 2], size: f64, text: &str) {
        self.write(at, Anchor::Middle, size, text, [false, true]);
    }

    fn write(
        &mut self,
        at: [f64; 2],
        anchor: Anchor,
        size: f64,
        text: impl Display,
        [bold, upwards]: [bool; 2],
    ) {
        self.marks.push(Mark::Words(Words {
            at,
            anchor,
            size,
            bold,
            upwards,
            colour: BLACK,
            text: text.to_string(),
        }));
    }

    /// The whole drawing: its size in its own units, its width in print, and what it shows in words.
    pub(crate) fn finish(self, size: [f64; 2], width_mm: f64, title: String) -> Figure {
        Figure {
            marks: self.marks,
            size,
            width_mm,
            title,
        }
    }
}

/// A drawing that is finished, to be written as SVG, PDF or PNG.
#[derive(Clone, Debug)]
pub struct Figure {
    pub(crate) marks: Vec<Mark>,
    pub(crate) size: [f64; 2],
    pub(crate) width_mm: f64,
    pub(crate) title: String,
}

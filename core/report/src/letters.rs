//! Letters of figures that are pictures: outlines of a font that comes along, because a machine may have none.

use std::sync::OnceLock;

use ttf_parser::{Face, OutlineBuilder};
use zeno::{Command, Vector};

/// A weight of the font.
pub(crate) struct Font {
    face: Face<'static>,
    /// Of the letters' size, for one unit of the font.
    unit: f32,
}

impl Font {
    /// Arimo, as wide as Helvetica; none where the file that comes along is damaged.
    pub(crate) fn of(bold: bool) -> Option<&'static Self> {
        static PLAIN: OnceLock<Option<Font>> = OnceLock::new();
        static BOLD: OnceLock<Option<Font>> = OnceLock::new();
        let font = match bold {
            true => BOLD.get_or_init(|| Self::parse(include_bytes!("../fonts/Arimo-Bold.ttf"))),
            false => {
                PLAIN.get_or_init(|| Self::parse(include_bytes!("../fonts/Arimo-Regular.ttf")))
            }
        };
        font.as_ref()
    }

    fn parse(file: &'static [u8]) -> Option<Self> {
        let face = Face::parse(file, 0).ok()?;
        let unit = 1.0 / f32::from(face.units_per_em());
        Some(Self { face, unit })
    }

    /// How wide words are, in their size.
    pub(crate) fn width(&self, text: &str) -> f64 {
        text.chars()
            .map(|letter| f64::from(self.step(letter)))
            .sum()
    }

    /// Outlines of words from the left, at the size of 1, y down.
    pub(crate) fn outlines(&self, text: &str) -> Vec<Command> {
        let mut outlines = Outlines {
            commands: Vec::new(),
            unit: self.unit,
            right: 0.0,
        };
        for letter in text.chars() {
            self.face.outline_glyph(self.glyph(letter), &mut outlines);
            outlines.right += self.step(letter);
        }
        outlines.commands
    }

    fn step(&self, letter: char) -> f32 {
        let units = self.face.glyph_hor_advance(self.glyph(letter));
        f32::from(units.unwrap_or(0)) * self.unit
    }

    /// Letters that the font does not have are question marks, as in PDF.
    fn glyph(&self, letter: char) -> ttf_parser::GlyphId {
        let known = self.face.glyph_index(letter);
        known
            .or_else(|| self.face.glyph_index('?'))
            .unwrap_or_default()
    }
}

struct Outlines {
    commands: Vec<Command>,
    unit: f32,
    /// Where the next letter begins.
    right: f32,
}

impl Outlines {
    fn at(&self, x: f32, y: f32) -> Vector {
        Vector::new(self.right + x * self.unit, -y * self.unit)
    }
}

impl OutlineBuilder for Outlines {
    fn move_to(&mut self, x: f32, y: f32) {
        self.commands.push(Command::MoveTo(self.at(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.commands.push(Command::LineTo(self.at(x, y)));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let (beside, to) = (self.at(x1, y1), self.at(x, y));
        self.commands.push(Command::QuadTo(beside, to));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let [a, b, to] = [(x1, y1), (x2, y2), (x, y)].map(|(x, y)| self.at(x, y));
        self.commands.push(Command::CurveTo(a, b, to));
    }

    fn close(&mut self) {
        self.commands.push(Command::Close);
    }
}

//! Drawings as PDF: one page of the size that a figure has in print.
//!
//! Lines stay lines and letters stay letters: they are Helvetica, one of the fonts that every reader of PDF has
//! (ISO 32000-1, 9.6.2.2), so no font is embedded.

use pdf_writer::types::LineJoinStyle;
use pdf_writer::{Content, Name, Pdf, Rect, Ref, Str, TextStr};

use crate::drawing::{Anchor, Colour, Dress, Figure, Mark, Stroke, Words};

/// Points of a printer in a millimetre.
const POINTS_PER_MM: f64 = 72.0 / 25.4;
/// Where the control points of a quarter of a circle lie, in its radius.
const QUARTER: f64 = 0.552_284_75;
const PLAIN: Name<'static> = Name(b"Plain");
const BOLD: Name<'static> = Name(b"Bold");

impl Figure {
    /// As PDF. Letters that are not in the Windows code page 1252 are question marks; titles of points are left out.
    #[must_use]
    pub fn pdf(&self) -> Vec<u8> {
        let [catalog, pages, page, plain, bold, content, info] =
            [1, 2, 3, 4, 5, 6, 7].map(Ref::new);
        let mut page_of = PageOf::new(self.size, self.width_mm);
        self.marks.iter().for_each(|mark| page_of.draw(mark));
        let mut pdf = Pdf::new();
        pdf.catalog(catalog).pages(pages);
        pdf.pages(pages).kids([page]).count(1);
        for (font, name) in [(plain, "Helvetica"), (bold, "Helvetica-Bold")] {
            let mut font = pdf.type1_font(font);
            font.base_font(Name(name.as_bytes()));
            font.encoding_predefined(Name(b"WinAnsiEncoding"));
        }
        let first = info.get() + 1;
        let opacities: Vec<(String, Ref)> = (first..)
            .zip(&page_of.opacities)
            .map(|(id, &percent)| (state_name(percent), Ref::new(id)))
            .collect();
        for ((_, id), &percent) in opacities.iter().zip(&page_of.opacities) {
            let part = f32::from(percent) / 100.0;
            let mut state = pdf.ext_graphics(*id);
            state.stroking_alpha(part).non_stroking_alpha(part);
        }
        {
            let [right, top] = page_of.size;
            let mut page = pdf.page(page);
            page.media_box(Rect::new(0.0, 0.0, right, top));
            page.parent(pages).contents(content);
            let mut resources = page.resources();
            resources.fonts().pair(PLAIN, plain).pair(BOLD, bold);
            let mut states = resources.ext_g_states();
            for (name, id) in &opacities {
                states.pair(Name(name.as_bytes()), *id);
            }
        }
        pdf.stream(content, page_of.content.finish().as_slice());
        pdf.document_info(info).title(TextStr(&self.title));
        pdf.finish()
    }
}

/// How a state of graphics with an opacity, percent, is called.
fn state_name(percent: u8) -> String {
    format!("Opacity{percent}")
}

/// The page as it is drawn.
struct PageOf {
    content: Content,
    /// Points.
    size: [f32; 2],
    /// Percent, each once.
    opacities: Vec<u8>,
}

impl PageOf {
    /// In the drawing's units, y downwards.
    fn new([width, height]: [f64; 2], width_mm: f64) -> Self {
        let scale = width_mm * POINTS_PER_MM / width;
        let size = [width, height].map(|side| (side * scale) as f32);
        let mut content = Content::new();
        let scale = scale as f32;
        content.transform([scale, 0.0, 0.0, -scale, 0.0, size[1]]);
        content.set_line_join(LineJoinStyle::RoundJoin);
        Self {
            content,
            size,
            opacities: Vec::new(),
        }
    }

    fn draw(&mut self, mark: &Mark) {
        match mark {
            Mark::Open(_) | Mark::Close => {}
            Mark::Line(points, stroke) => {
                self.content.save_state();
                self.stroke(stroke);
                self.path(points);
                self.content.stroke().restore_state();
            }
            Mark::Shape(points, dress) => self.dressed(dress, |page| {
                page.path(points);
                page.content.close_path();
            }),
            Mark::Point {
                at, radius, dress, ..
            } => self.dressed(dress, |page| page.circle(*at, *radius)),
            Mark::Square {
                at: [x, y],
                half,
                dress,
            } => self.dressed(dress, |page| {
                let [left, top, side] = [x - half, y - half, 2.0 * half].map(|x| x as f32);
                page.content.rect(left, top, side, side);
            }),
            Mark::Words(words) => self.write(words),
        }
    }

    /// A shape, filled and then bordered, as SVG does it.
    fn dressed(&mut self, dress: &Dress, shape: impl Fn(&mut Self)) {
        if let Some((colour, part)) = dress.fill {
            self.content.save_state();
            self.fill(colour);
            self.opacity(part);
            shape(self);
            self.content.fill_nonzero().restore_state();
        }
        if let Some(border) = &dress.border {
            self.content.save_state();
            self.stroke(border);
            shape(self);
            self.content.stroke().restore_state();
        }
    }

    fn fill(&mut self, colour: Colour) {
        let [red, green, blue] = parts(colour);
        self.content.set_fill_rgb(red, green, blue);
    }

    fn stroke(&mut self, stroke: &Stroke) {
        let [red, green, blue] = parts(stroke.colour);
        self.content.set_stroke_rgb(red, green, blue);
        self.content.set_line_width(stroke.width as f32);
        let dashes = stroke.dashes.iter().map(|&length| length as f32);
        self.content.set_dash_pattern(dashes, 0.0);
        self.opacity(stroke.opacity);
    }

    fn opacity(&mut self, part: f64) {
        let percent = (100.0 * part).round() as u8;
        if percent >= 100 {
            return;
        }
        if !self.opacities.contains(&percent) {
            self.opacities.push(percent);
        }
        let name = state_name(percent);
        self.content.set_parameters(Name(name.as_bytes()));
    }

    fn path(&mut self, points: &[[f64; 2]]) {
        for (number, point) in points.iter().enumerate() {
            let [x, y] = point.map(|x| x as f32);
            match number {
                0 => self.content.move_to(x, y),
                _ => self.content.line_to(x, y),
            };
        }
    }

    fn circle(&mut self, [x, y]: [f64; 2], radius: f64) {
        let at = |right: f64, down: f64| [x + radius * right, y + radius * down].map(|x| x as f32);
        let [right, down] = at(1.0, 0.0);
        self.content.move_to(right, down);
        for (from, to) in [
            ([1.0, 0.0], [0.0, 1.0]),
            ([0.0, 1.0], [-1.0, 0.0]),
            ([-1.0, 0.0], [0.0, -1.0]),
            ([0.0, -1.0], [1.0, 0.0]),
        ] {
            let beside = |one: [f64; 2], other: [f64; 2]| {
                at(one[0] + QUARTER * other[0], one[1] + QUARTER * other[1])
            };
            let ([x1, y1], [x2, y2]) = (beside(from, to), beside(to, from));
            let [x3, y3] = at(to[0], to[1]);
            self.content.cubic_to(x1, y1, x2, y2, x3, y3);
        }
        self.content.close_path();
    }

    fn write(&mut self, words: &Words) {
        let letters: Vec<u8> = words.text.chars().map(code).collect();
        let length = width_of(&words.text);
        let before = match words.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5,
            Anchor::End => 1.0,
        };
        let before = before * length * words.size;
        let [x, y] = words.at;
        // Upright again, since the page's y points down.
        let matrix = match words.upwards {
            true => [0.0, -1.0, -1.0, 0.0, x, y + before],
            false => [1.0, 0.0, 0.0, -1.0, x - before, y],
        };
        let font = if words.bold { BOLD } else { PLAIN };
        self.content.save_state();
        self.fill(words.colour);
        self.content
            .begin_text()
            .set_font(font, words.size as f32)
            .set_text_matrix(matrix.map(|x| x as f32))
            .show(Str(&letters))
            .end_text()
            .restore_state();
    }
}

fn parts(Colour(colour): Colour) -> [f32; 3] {
    colour.map(|level| f32::from(level) / 255.0)
}

/// A letter in the Windows code page 1252.
fn code(letter: char) -> u8 {
    match letter {
        ' '..='~' | '\u{a0}'..='\u{ff}' => u8::try_from(u32::from(letter)).unwrap_or(b'?'),
        // The minus sign is not in it; this is as wide, but for a thirtieth of the letters' size.
        '\u{2212}' | '\u{2013}' => 0x96,
        '\u{2014}' => 0x97,
        '\u{2018}' => 0x91,
        '\u{2019}' => 0x92,
        '\u{201c}' => 0x93,
        '\u{201d}' => 0x94,
        _ => b'?',
    }
}

/// How wide words are, in their size.
pub(crate) fn width_of(text: &str) -> f64 {
    text.chars().map(|letter| width(code(letter))).sum()
}

/// How wide a letter of Helvetica is, in the letters' size: from its metrics as they were published, others as wide as a digit.
fn width(code: u8) -> f64 {
    let thousandths = match code {
        b'i' | b'j' | b'l' => 222,
        b'|' => 260,
        b' ' | b'!' | b',' | b'.' | b'/' | b':' | b';' | b'I' | b'[' | b']' | b'\\' | b'f'
        | b't' | 0xa0 => 278,
        b'\'' => 191,
        b'`' | b'(' | b')' | b'-' | b'r' => 333,
        b'"' => 355,
        b'*' => 389,
        0xb0 => 400,
        b'^' => 469,
        b'{' | b'}' => 334,
        b'c' | b'k' | b's' | b'v' | b'x' | b'y' | b'z' | b'J' => 500,
        b'+' | b'<' | b'=' | b'>' | b'~' | 0xb1 => 584,
        b'F' | b'T' | b'Z' => 611,
        b'&' | b'A' | b'B' | b'E' | b'K' | b'P' | b'S' | b'V' | b'X' | b'Y' => 667,
        b'C' | b'D' | b'H' | b'N' | b'R' | b'U' | b'w' => 722,
        b'G' | b'O' | b'Q' => 778,
        b'm' | b'M' => 833,
        b'%' => 889,
        b'W' => 944,
        b'@' => 1015,
        0x97 => 1000,
        _ => 556,
    };
    f64::from(thousandths) / 1000.0
}

#[cfg(test)]
mod tests;

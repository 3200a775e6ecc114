//! Drawings as pixels, and as PNG.

use png::{BitDepth, ColorType, Compression, Encoder, PixelDimensions, Unit};
use zeno::{Command, Join, Mask, PathBuilder, Style, Transform, Vector};

use crate::drawing::{Anchor, Colour, Dress, Figure, Mark, Stroke, WHITE, Words};
use crate::letters::Font;

/// Dots an inch that journals ask of drawings with lines and words.
const DPI: f64 = 600.0;
const MM_PER_INCH: f64 = 25.4;

/// A picture in colour, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    size: [usize; 2],
    pixels: Vec<[u8; 3]>,
    /// Dots a metre, where it has a size in print.
    dots_per_m: Option<u32>,
}

impl Figure {
    /// As PNG of the size that it has in print, at 600 dots an inch.
    #[must_use]
    pub fn png(&self) -> Vec<u8> {
        let [width, height] = self.size;
        let width_px = (self.width_mm / MM_PER_INCH * DPI).round();
        let height_px = (self.width_mm * height / width / MM_PER_INCH * DPI).round();
        let mut picture = Picture::plain([width_px as usize, height_px as usize], WHITE);
        picture.dots_per_m = Some((DPI / MM_PER_INCH * 1000.0).round() as u32);
        picture.draw(&self.marks, width_px / width);
        picture.png()
    }
}

impl Picture {
    /// All of one colour; columns and rows.
    pub(crate) fn plain(size: [usize; 2], Colour(colour): Colour) -> Self {
        Self {
            size,
            pixels: [colour].repeat(size[0] * size[1]),
            dots_per_m: None,
        }
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Red, green and blue, row by row.
    #[must_use]
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    pub(crate) fn pixels_mut(&mut self) -> &mut [[u8; 3]] {
        &mut self.pixels
    }

    /// As PNG; nothing where it has no pixels.
    #[must_use]
    pub fn png(&self) -> Vec<u8> {
        let mut out = Vec::new();
        match self.encode(&mut out) {
            Ok(()) => out,
            // Memory takes all that is written.
            Err(_) => Vec::new(),
        }
    }

    fn encode(&self, out: &mut Vec<u8>) -> Result<(), png::EncodingError> {
        let [width, height] = self
            .size
            .map(|side| u32::try_from(side).unwrap_or(u32::MAX));
        let mut encoder = Encoder::new(out, width, height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::Fast);
        encoder.set_pixel_dims(self.dots_per_m.map(|dots| PixelDimensions {
            xppu: dots,
            yppu: dots,
            unit: Unit::Meter,
        }));
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        writer.finish()
    }

    /// Draws marks, one of whose units is `scale` pixels.
    pub(crate) fn draw(&mut self, marks: &[Mark], scale: f64) {
        marks.iter().for_each(|mark| self.mark(mark, scale));
    }

    fn mark(&mut self, mark: &Mark, scale: f64) {
        match mark {
            Mark::Open(_) | Mark::Close => {}
            Mark::Line(points, stroke) => self.stroke(&line(points, scale), stroke, scale),
            Mark::Shape(points, dress) => {
                let mut path = line(points, scale);
                path.push(Command::Close);
                self.dressed(&path, dress, scale);
            }
            Mark::Point {
                at, radius, dress, ..
            } => {
                let mut path = Vec::new();
                path.add_circle(place(*at, scale), (radius * scale) as f32);
                self.dressed(&path, dress, scale);
            }
            Mark::Square {
                at: [x, y],
                half,
                dress,
            } => {
                let mut path = Vec::new();
                let side = (2.0 * half * scale) as f32;
                path.add_rect(place([x - half, y - half], scale), side, side);
                self.dressed(&path, dress, scale);
            }
            Mark::Words(words) => self.write(words, scale),
        }
    }

    /// Filled and then bordered, as SVG does it.
    fn dressed(&mut self, path: &[Command], dress: &Dress, scale: f64) {
        if let Some((colour, part)) = dress.fill {
            self.paint(path, Style::default(), None, (colour, part));
        }
        if let Some(border) = &dress.border {
            self.stroke(path, border, scale);
        }
    }

    fn stroke(&mut self, path: &[Command], stroke: &Stroke, scale: f64) {
        let dashes = stroke.dashes.iter().map(|length| (length * scale) as f32);
        let dashes: Vec<f32> = dashes.collect();
        let mut style = zeno::Stroke::new((stroke.width * scale) as f32);
        style.join(Join::Round).dash(&dashes, 0.0);
        self.paint(path, style.into(), None, (stroke.colour, stroke.opacity));
    }

    fn write(&mut self, words: &Words, scale: f64) {
        let Some(font) = Font::of(words.bold) else {
            return;
        };
        let before = match words.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5,
            Anchor::End => 1.0,
        };
        let size = words.size * scale;
        let before = before * font.width(&words.text) * size;
        let [x, y] = words.at.map(|x| x * scale);
        // What is right of a letter's beginning goes to the right, or up; what is below it goes down, or to the right.
        let [right_x, right_y, down_x, down_y, x, y] = match words.upwards {
            true => [0.0, -size, size, 0.0, x, y + before],
            false => [size, 0.0, 0.0, size, x - before, y],
        }
        .map(|x| x as f32);
        let turned = Transform::new(right_x, right_y, down_x, down_y, x, y);
        let outlines = font.outlines(&words.text);
        let style = Style::default();
        self.paint(&outlines, style, Some(turned), (words.colour, 1.0));
    }

    /// Lays a colour where a path covers the picture, as much as it covers of each pixel.
    fn paint(
        &mut self,
        path: &[Command],
        style: Style<'_>,
        to_pixels: Option<Transform>,
        (Colour(colour), opacity): (Colour, f64),
    ) {
        let bounds = zeno::bounds(path, style, to_pixels);
        let [width, height] = self.size;
        // What reaches beyond the picture is not drawn, and needs no memory; what is no number is nowhere.
        let within = |from: f32, to: f32, side: usize| {
            let from = from.floor().max(0.0) as usize;
            let to = (to.ceil().max(0.0) as usize).min(side);
            (from < to).then(|| (from, to - from))
        };
        let across = within(bounds.min.x, bounds.max.x, width);
        let down = within(bounds.min.y, bounds.max.y, height);
        let Some(((left, columns), (top, rows))) = across.zip(down) else {
            return;
        };
        let (cover, _) = Mask::new(path)
            .style(style)
            .transform(to_pixels)
            .offset(Vector::new(-(left as f32), -(top as f32)))
            .size(columns as u32, rows as u32)
            .render();
        let opacity = (opacity * 255.0).round() as u32;
        for (row, cover) in cover.chunks_exact(columns).enumerate() {
            let first = (top + row) * width + left;
            for (pixel, &cover) in self.pixels[first..first + columns].iter_mut().zip(cover) {
                if cover > 0 {
                    blend(pixel, colour, u32::from(cover) * opacity);
                }
            }
        }
    }
}

/// `part`: of 255 x 255.
fn blend(pixel: &mut [u8; 3], colour: [u8; 3], part: u32) {
    const WHOLE: u32 = 255 * 255;
    if part == WHOLE {
        *pixel = colour;
        return;
    }
    for (below, above) in pixel.iter_mut().zip(colour) {
        let mixed = u32::from(above) * part + u32::from(*below) * (WHOLE - part);
        *below = ((mixed + WHOLE / 2) / WHOLE) as u8;
    }
}

/// Pixels beyond which nothing has to be told apart: the masks' numbers are 24 bits before the point.
const FAR: f64 = 20_000.0;

fn place(at: [f64; 2], scale: f64) -> Vector {
    let [x, y] = at.map(|x| (x * scale).clamp(-FAR, FAR) as f32);
    Vector::new(x, y)
}

fn line(points: &[[f64; 2]], scale: f64) -> Vec<Command> {
    let known = points.iter().filter(|at| at.iter().all(|x| x.is_finite()));
    known
        .enumerate()
        .map(|(number, &at)| match number {
            0 => Command::MoveTo(place(at, scale)),
            _ => Command::LineTo(place(at, scale)),
        })
        .collect()
}

#[cfg(test)]
mod tests;

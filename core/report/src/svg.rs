//! Elements and axes of a drawing, as SVG text.
//!
//! Own code, some two hundred lines, instead of a plotting crate: `plotters` draws for pixels, so it has no groups, classes or
//! titles, by which a page finds a frame's point and a printer a figure's parts, and it must measure fonts that an SVG does not have.

use std::fmt::{Display, Write as _};

/// Text as it may stand in an element or an attribute.
pub(crate) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // XML has no such letters.
            '\u{0}'..='\u{8}'
            | '\u{b}'
            | '\u{c}'
            | '\u{e}'..='\u{1f}'
            | '\u{fffe}'
            | '\u{ffff}' => out.push('\u{fffd}'),
            other => out.push(other),
        }
    }
    out
}

/// A number in a drawing: a hundredth of a unit is finer than any printer.
pub(crate) fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" | "" => "0".to_owned(),
        other => other.to_owned(),
    }
}

/// A drawing as it is put together.
#[derive(Default)]
pub(crate) struct Drawing {
    text: String,
}

/// Where a text stands relative to its point.
#[derive(Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl Drawing {
    /// Opens a group of a class.
    pub(crate) fn open(&mut self, class: &str) {
        let _ = writeln!(self.text, "<g class=\"{class}\">");
    }

    pub(crate) fn close(&mut self) {
        self.text.push_str("</g>\n");
    }

    /// A line through points, with attributes.
    pub(crate) fn line(&mut self, points: &[[f64; 2]], attributes: &str) {
        let places = places(points);
        let _ = writeln!(
            self.text,
            "<polyline fill=\"none\" {attributes} points=\"{places}\"/>"
        );
    }

    /// A filled shape.
    pub(crate) fn shape(&mut self, points: &[[f64; 2]], attributes: &str) {
        let places = places(points);
        let _ = writeln!(self.text, "<polygon {attributes} points=\"{places}\"/>");
    }

    /// A circle with a title, which a page shows where the pointer is.
    pub(crate) fn point(&mut self, [x, y]: [f64; 2], radius: f64, attributes: &str, title: &str) {
        let (x, y, r) = (short(x), short(y), short(radius));
        let title = match title {
            "" => String::new(),
            some => format!("<title>{}</title>", escaped(some)),
        };
        let _ = writeln!(
            self.text,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" {attributes}>{title}</circle>"
        );
    }

    pub(crate) fn square(&mut self, [x, y]: [f64; 2], half: f64, attributes: &str) {
        let (x, y, size) = (short(x - half), short(y - half), short(2.0 * half));
        let _ = writeln!(
            self.text,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{size}\" height=\"{size}\" {attributes}/>"
        );
    }

    pub(crate) fn words(
        &mut self,
        [x, y]: [f64; 2],
        anchor: Anchor,
        size: f64,
        text: impl Display,
    ) {
        self.words_with([x, y], anchor, size, "", text);
    }

    pub(crate) fn words_with(
        &mut self,
        [x, y]: [f64; 2],
        anchor: Anchor,
        size: f64,
        attributes: &str,
        text: impl Display,
    ) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let (x, y, text) = (short(x), short(y), escaped(&text.to_string()));
        let size = short(size);
        let _ = writeln!(
            self.text,
            "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-size=\"{size}\" {attributes}>{text}</text>"
        );
    }

    /// Words that run upwards, centred on a point.
    pub(crate) fn upwards(&mut self, [x, y]: [f64; 2], size: f64, text: &str) {
        let turned = format!("transform=\"rotate(-90 {} {})\"", short(x), short(y));
        self.words_with([x, y], Anchor::Middle, size, &turned, text);
    }

    /// The whole drawing: its size in its own units, its width in print, and what it shows in words.
    pub(crate) fn finish(self, [width, height]: [f64; 2], width_mm: f64, title: &str) -> String {
        let (w, h) = (short(width), short(height));
        let height_mm = short(width_mm * height / width);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{width_mm}mm\" height=\"{height_mm}mm\" \
             role=\"img\" font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" fill=\"#111\" stroke-linejoin=\"round\">\n\
             <title>{}</title>\n<rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n{}</svg>\n",
            escaped(title),
            self.text
        )
    }
}

fn places(points: &[[f64; 2]]) -> String {
    let places: Vec<String> = points
        .iter()
        .map(|[x, y]| format!("{},{}", short(*x), short(*y)))
        .collect();
    places.join(" ")
}

/// One axis: from numbers to places in the drawing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) step: f64,
}

impl Scale {
    /// An axis over numbers, ended at marks, some `marks` of them. Without numbers it is one from 0 to 1.
    pub(crate) fn over(values: impl Iterator<Item = f64>, marks: f64, from: f64, to: f64) -> Self {
        let known = values.filter(|value| value.is_finite());
        let (low, high) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let step = step_for((high - low).max(1e-3) / marks);
        let (first, last) = ((low / step).floor(), (high / step).ceil());
        let last = if last > first { last } else { first + 1.0 };
        Self {
            low: first * step,
            high: last * step,
            from,
            to,
            step,
        }
    }

    pub(crate) fn at(&self, value: f64) -> f64 {
        self.from + (value - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    pub(crate) fn marks(&self) -> impl Iterator<Item = (f64, String)> {
        let count = ((self.high - self.low) / self.step).round() as i32;
        let places = if self.step < 1.0 { 1 } else { 0 };
        let Self { low, step, .. } = *self;
        (0..=count).map(move |k| {
            let value = low + f64::from(k) * step;
            let value = if value.abs() < 1e-9 { 0.0 } else { value };
            (value, format!("{value:.places$}").replace('-', "\u{2212}"))
        })
    }
}

/// The next of 1, 2 and 5 times a power of ten.
fn step_for(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0];
    let next = steps.into_iter().find(|step| step * power >= 0.999 * least);
    next.unwrap_or(10.0) * power
}

/// A plot: two axes and the frame they span.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plot {
    pub(crate) x: Scale,
    pub(crate) y: Scale,
}

impl Plot {
    pub(crate) fn place(&self, x: f64, y: f64) -> [f64; 2] {
        [self.x.at(x), self.y.at(y)]
    }

    /// Axes with marks and labels; `below` says whether the numbers of the x axis are written.
    pub(crate) fn axes(&self, drawing: &mut Drawing, labels: [&str; 2], below: bool) {
        const INK: &str = "stroke=\"#111\" stroke-width=\"0.8\"";
        let (left, right, bottom, top) = (self.x.from, self.x.to, self.y.from, self.y.to);
        drawing.open("axes");
        if self.y.low < 0.0 && self.y.high > 0.0 {
            let zero = self.y.at(0.0);
            drawing.line(
                &[[left, zero], [right, zero]],
                "stroke=\"#bbb\" stroke-width=\"0.6\"",
            );
        }
        drawing.line(&[[left, top], [left, bottom], [right, bottom]], INK);
        for (value, text) in self.x.marks() {
            let x = self.x.at(value);
            drawing.line(&[[x, bottom], [x, bottom + 4.0]], INK);
            if below {
                drawing.words([x, bottom + 16.0], Anchor::Middle, 11.0, text);
            }
        }
        for (value, text) in self.y.marks() {
            let y = self.y.at(value);
            drawing.line(&[[left - 4.0, y], [left, y]], INK);
            drawing.words([left - 7.0, y + 4.0], Anchor::End, 11.0, text);
        }
        if below {
            let middle = (left + right) / 2.0;
            drawing.words([middle, bottom + 33.0], Anchor::Middle, 12.0, labels[0]);
        }
        drawing.upwards([left - 36.0, (top + bottom) / 2.0], 12.0, labels[1]);
        drawing.close();
    }
}

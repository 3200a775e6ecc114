//! Drawings as SVG text.

use std::fmt::Write as _;

use crate::drawing::{Anchor, BLACK, Colour, Dress, Figure, Mark, Stroke, WHITE, Words};

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

impl Figure {
    /// As SVG of the size that it has in print.
    #[must_use]
    pub fn svg(&self) -> String {
        let [width, height] = self.size;
        let (w, h) = (short(width), short(height));
        let width_mm = self.width_mm;
        let height_mm = short(width_mm * height / width);
        let (ink, paper) = (hex(BLACK), hex(WHITE));
        let title = escaped(&self.title);
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{width_mm}mm\" height=\"{height_mm}mm\" \
             role=\"img\" font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" fill=\"{ink}\" stroke-linejoin=\"round\">\n\
             <title>{title}</title>\n<rect width=\"{w}\" height=\"{h}\" fill=\"{paper}\"/>\n"
        );
        self.marks.iter().for_each(|mark| write(mark, &mut out));
        out.push_str("</svg>\n");
        out
    }
}

fn write(mark: &Mark, out: &mut String) {
    // Writing to a string does not fail.
    let _ = match mark {
        Mark::Open(class) => writeln!(out, "<g class=\"{class}\">"),
        Mark::Close => writeln!(out, "</g>"),
        Mark::Line(points, stroke) => {
            let (stroke, places) = (line_of(stroke), places(points));
            writeln!(out, "<polyline fill=\"none\"{stroke} points=\"{places}\"/>")
        }
        Mark::Shape(points, dress) => {
            let (dress, places) = (dress_of(dress), places(points));
            writeln!(out, "<polygon{dress} points=\"{places}\"/>")
        }
        Mark::Point {
            at: [x, y],
            radius,
            dress,
            title,
        } => {
            let (x, y, r) = (short(*x), short(*y), short(*radius));
            let dress = dress_of(dress);
            let title = match title.as_str() {
                "" => String::new(),
                some => format!("<title>{}</title>", escaped(some)),
            };
            writeln!(
                out,
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\"{dress}>{title}</circle>"
            )
        }
        Mark::Square {
            at: [x, y],
            half,
            dress,
        } => {
            let (x, y, size) = (short(x - half), short(y - half), short(2.0 * half));
            let dress = dress_of(dress);
            writeln!(
                out,
                "<rect x=\"{x}\" y=\"{y}\" width=\"{size}\" height=\"{size}\"{dress}/>"
            )
        }
        Mark::Words(words) => write_words(words, out),
    };
}

fn write_words(words: &Words, out: &mut String) -> std::fmt::Result {
    let anchor = match words.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let [x, y] = words.at.map(short);
    let (size, text) = (short(words.size), escaped(&words.text));
    let bold = if words.bold {
        " font-weight=\"bold\""
    } else {
        ""
    };
    let colour = match words.colour {
        // The whole drawing's.
        BLACK => String::new(),
        other => format!(" fill=\"{}\"", hex(other)),
    };
    let turned = match words.upwards {
        true => format!(" transform=\"rotate(-90 {x} {y})\""),
        false => String::new(),
    };
    writeln!(
        out,
        "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-size=\"{size}\"{bold}{colour}{turned}>{text}</text>"
    )
}

fn hex(Colour([red, green, blue]): Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn opacity(of: &str, part: f64) -> String {
    match part < 1.0 {
        true => format!(" {of}-opacity=\"{part}\""),
        false => String::new(),
    }
}

fn line_of(stroke: &Stroke) -> String {
    let (colour, width) = (hex(stroke.colour), stroke.width);
    let dashes: Vec<String> = stroke.dashes.iter().map(f64::to_string).collect();
    let dashes = match dashes.as_slice() {
        [] => String::new(),
        some => format!(" stroke-dasharray=\"{}\"", some.join(" ")),
    };
    let faint = opacity("stroke", stroke.opacity);
    format!(" stroke=\"{colour}\" stroke-width=\"{width}\"{dashes}{faint}")
}

fn dress_of(dress: &Dress) -> String {
    let fill = match dress.fill {
        Some((colour, part)) => format!(" fill=\"{}\"{}", hex(colour), opacity("fill", part)),
        None => " fill=\"none\"".to_owned(),
    };
    let border = dress.border.as_ref().map(line_of).unwrap_or_default();
    fill + &border
}

fn places(points: &[[f64; 2]]) -> String {
    let places: Vec<String> = points
        .iter()
        .map(|[x, y]| format!("{},{}", short(*x), short(*y)))
        .collect();
    places.join(" ")
}

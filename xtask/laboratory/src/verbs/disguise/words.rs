//! A disguise in words.

use std::fmt;

use super::plan::{Curve, Field, Frames, Kind, Marks, Mesh, Models, Plan, Tone, View};

/// Adds to a list what holds.
fn say(parts: &mut Vec<String>, holds: bool, words: impl Into<String>) {
    if holds {
        parts.push(words.into());
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::new();
        self.frames.say(&mut parts);
        self.view.say(&mut parts);
        self.tone.say(&mut parts);
        self.marks.say(&mut parts);
        self.models.say(&mut parts);
        f.write_str(&parts.join(", "))
    }
}

impl Kind {
    fn words(self) -> &'static str {
        match self {
            Self::Png8 => "PNG 8 bit",
            Self::Png16 => "PNG 16 bit",
            Self::Tiff8 => "TIFF 8 bit",
            Self::Tiff12 => "TIFF 12 of 16 bit",
            Self::Jpeg85 => "JPEG",
            Self::Dicom8 => "DICOM 8 bit",
            Self::Dicom12 => "DICOM 12 bit",
            Self::Dicom16 => "DICOM 16 bit",
            Self::Dicom12Inverse => "DICOM 12 bit, white is 0",
        }
    }
}

impl Frames {
    fn say(&self, parts: &mut Vec<String>) {
        say(parts, true, self.kind.words());
        let (every, first) = (self.every, self.first + 1);
        say(parts, every > 1, format!("every frame of {every}"));
        let count = self.count;
        say(parts, count > 0, format!("{count} at most from {first}"));
        say(parts, self.backwards, "backwards");
    }
}

impl View {
    fn say(&self, parts: &mut Vec<String>) {
        let ([width, height], scale) = (self.size, self.scale);
        say(parts, width > 0, format!("{width} x {height}"));
        let is_scaled = (scale - 1.0).abs() > 1e-9;
        say(parts, is_scaled, format!("scaled by {scale}"));
        let is_square = (self.aspect - 1.0).abs() < 1e-9;
        say(parts, !is_square, format!("pixels of {} to 1", self.aspect));
        say(parts, self.mirrored, "mirrored");
        let turn = self.turn_deg;
        say(parts, turn != 0.0, format!("rolled by {turn} degrees"));
        if let Some([x, y]) = self.middle {
            let is_near = [x, y].iter().any(|at| !(0.3..=0.7).contains(at));
            say(
                parts,
                is_near,
                format!("knee at {x} of width, {y} of height"),
            );
        }
    }
}

impl Tone {
    fn say(&self, parts: &mut Vec<String>) {
        match self.curve {
            Curve::Same => {}
            Curve::Gamma(power) => parts.push(format!("gamma {power}")),
            Curve::Log(k) => parts.push(format!("logarithm of 1 + {k} v")),
            Curve::Clipped(_) => parts.push("steep and clipped".to_owned()),
        }
        say(parts, self.negative, "negative");
        let contrast = self.contrast;
        say(parts, contrast < 1.0, format!("contrast {contrast}"));
        let (blur, noise) = (self.blur_px, self.noise);
        say(parts, blur > 0.0, format!("blurred by {blur} px"));
        say(parts, noise > 0.0, format!("noise {noise}"));
        let levels = self.levels;
        say(parts, levels > 0, format!("{levels} grey levels"));
    }
}

impl Marks {
    fn say(&self, parts: &mut Vec<String>) {
        match self.field {
            Field::Whole => {}
            Field::Round(radius) => parts.push(format!("round field of {radius}")),
            Field::Shutters(part) => parts.push(format!("shutters of {part}")),
        }
        say(parts, self.white_surround, "white surround");
        say(parts, self.words, "words and ruler");
    }
}

impl Models {
    fn say(&self, parts: &mut Vec<String>) {
        let mesh = match self.mesh {
            Mesh::Stl => "STL",
            Mesh::Obj => "OBJ",
            Mesh::Ply => "PLY",
        };
        say(parts, true, mesh);
        say(parts, self.turned, "other axes");
        let unit = self.unit_mm;
        say(parts, unit != 1.0, format!("unit of {unit} mm"));
        say(parts, self.unwelded, "not welded");
        let (flipped, doubled) = (100.0 * self.flipped, 100.0 * self.doubled);
        say(parts, flipped > 0.0, format!("{flipped:.0} % wound back"));
        say(parts, doubled > 0.0, format!("{doubled:.0} % twice"));
        let only = self.only.as_ref();
        parts.extend(only.map(|only| format!("{only} alone")));
    }
}

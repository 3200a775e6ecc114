//! Whether a disguise that somebody stated can be drawn: its numbers, and the names of its frames.

use std::ops::RangeInclusive;

use anyhow::{Result, ensure};

use super::plan::{Curve, Field, Frames, Plan};
use crate::files::check_file_name;

/// Digits of a frame's number at most.
const DIGITS: usize = 20;
/// Blur at most, pixels: it takes memory by its width.
const BLUR_PX: f64 = 100.0;

impl Plan {
    /// Whether all of it can be drawn.
    ///
    /// # Errors
    /// Names the key, what it is and what it may be.
    pub(super) fn check(&self) -> Result<()> {
        self.frames.check()?;
        let (tone, models) = (&self.tone, &self.models);
        let part = 0.0..=1.0;
        let above_0 = f64::MIN_POSITIVE..=1e6;
        within("tone.contrast", tone.contrast, &part)?;
        within("tone.blur_px", tone.blur_px, &(0.0..=BLUR_PX))?;
        within("tone.noise", tone.noise, &part)?;
        match tone.curve {
            Curve::Same => {}
            Curve::Gamma(power) => within("tone.curve.gamma", power, &above_0)?,
            Curve::Log(k) => within("tone.curve.log", k, &above_0)?,
            Curve::Clipped(ends) => ends
                .into_iter()
                .try_for_each(|end| within("tone.curve.clipped", end, &part))?,
        }
        match self.marks.field {
            Field::Whole => {}
            Field::Round(radius) => within("marks.field.round", radius, &above_0)?,
            Field::Shutters(of) => within("marks.field.shutters", of, &(0.0..=0.5))?,
        }
        within("models.unit_mm", models.unit_mm, &above_0)?;
        within("models.flipped", models.flipped, &part)?;
        within("models.doubled", models.doubled, &part)
    }
}

impl Frames {
    /// Whether its names are those of files in one folder.
    fn check(&self) -> Result<()> {
        let digits = self.digits;
        ensure!(
            digits <= DIGITS,
            "frames.digits is {digits}; it must be at most {DIGITS}"
        );
        check_file_name(&format!("{}.{}", self.name(0), self.kind.ending()))
    }
}

fn within(key: &str, value: f64, range: &RangeInclusive<f64>) -> Result<()> {
    let (least, most) = (range.start(), range.end());
    let from = match *least == f64::MIN_POSITIVE {
        true => "above 0".to_owned(),
        false => format!("{least}"),
    };
    ensure!(
        range.contains(&value),
        "{key} is {value}; it must be {from} to {most}"
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_seeds_draw_can_be_drawn_and_what_cannot_is_named() {
        for seed in 0..200 {
            Plan::drawn(seed, 61, (1024, 1024)).check().unwrap();
        }
        let told = |text: &str| {
            let plan: Plan = toml::from_str(text).unwrap();
            plan.check()
                .map_or_else(|error| error.to_string(), |()| String::new())
        };
        for (text, key) in [
            ("frames.prefix = '../out-'", "no name for a file"),
            ("frames.prefix = '/tmp/a'", "no name for a file"),
            ("frames.digits = 70000", "frames.digits is 70000"),
            ("tone.blur_px = 1e9", "tone.blur_px is 1000000000"),
            ("tone.noise = nan", "tone.noise is NaN"),
            ("tone.curve = { gamma = 0.0 }", "tone.curve.gamma is 0"),
            ("marks.field = { round = -1.0 }", "marks.field.round is -1"),
            ("models.unit_mm = 0.0", "must be above 0"),
            ("models.flipped = 7.0", "models.flipped is 7"),
        ] {
            assert!(told(text).contains(key), "{text}: {}", told(text));
        }
    }
}

//! Numbers as the command line writes them.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, Result, bail, ensure};
use clap::builder::{PathBufValueParser, PossibleValuesParser, TypedValueParser};
use fluoropose::library::ViewAxis;
use fluoropose::refine::Polarity;
use fluoropose_phantom::implant::Side;

/// How frames show metal; where it is not said, they tell it themselves.
#[derive(clap::Args, Clone, Copy, Debug, Default)]
pub struct Shown {
    /// Implants are brighter than what surrounds them, as on a radiograph's film [default: told by the frames]
    #[arg(long)]
    pub bright_implant: bool,
    /// Implants are darker than what surrounds them [default: told by the frames]
    #[arg(long, conflicts_with = "bright_implant")]
    pub dark_implant: bool,
}

impl Shown {
    /// What was said, if anything.
    #[must_use]
    pub fn stated(self) -> Option<Polarity> {
        match (self.bright_implant, self.dark_implant) {
            (true, _) => Some(Polarity::BrightImplant),
            (false, true) => Some(Polarity::DarkImplant),
            (false, false) => None,
        }
    }

    /// What frames told.
    #[must_use]
    pub fn told(polarity: Polarity) -> Self {
        Self {
            bright_implant: polarity == Polarity::BrightImplant,
            dark_implant: polarity == Polarity::DarkImplant,
        }
    }
}

/// What most of them say; nothing of none.
pub fn most(votes: impl IntoIterator<Item = Polarity>) -> Option<Polarity> {
    let (mut bright, mut all) = (0, 0);
    for vote in votes {
        all += 1;
        bright += usize::from(vote == Polarity::BrightImplant);
    }
    (all > 0).then(|| Polarity::of(2 * bright > all))
}

/// A range of rotations, `first:last:step` in degrees.
#[derive(Clone, Copy, Debug)]
pub struct Range(pub ViewAxis);

impl FromStr for Range {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let numbers: Result<Vec<f64>, _> = text.split(':').map(str::parse).collect();
        let numbers = numbers.with_context(|| format!("'{text}' is not first:last:step"))?;
        let &[first, last, step] = numbers.as_slice() else {
            bail!("'{text}' is not first:last:step");
        };
        let steps = (last - first) / step;
        if !(step > 0.0 && (0.0..4096.0).contains(&steps)) {
            bail!("'{text}': the step must be positive and lead from first to last");
        }
        ensure!(
            (steps - steps.round()).abs() < 1e-6,
            "'{text}': steps of {step} lead from {first} to {}, not to {last}",
            first + steps.floor() * step
        );
        Ok(Self(ViewAxis {
            first,
            step,
            count: steps.round() as usize + 1,
        }))
    }
}

/// A pair of numbers, `x,y`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pair(pub [f64; 2]);

impl FromStr for Pair {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        match numbers
            .with_context(|| format!("'{text}' is not x,y"))?
            .as_slice()
        {
            &[x, y] => Ok(Self([x, y])),
            _ => bail!("'{text}' is not x,y"),
        }
    }
}

/// Reads a number above 0, as frames a second.
///
/// # Errors
/// Says what it has to be.
pub fn above_0(text: &str) -> Result<f64> {
    let number = text.parse().ok();
    let number = number.filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.with_context(|| format!("'{text}' is no number above 0"))
}

/// Reads how many there are to be, at least one.
///
/// # Errors
/// Says what it has to be.
pub fn at_least_1(text: &str) -> Result<usize> {
    let number = text.parse().ok().filter(|&number: &usize| number > 0);
    number.with_context(|| format!("'{text}' is no whole number above 0"))
}

/// Reads the path of a study file, or of the folder that holds it as `study.toml`.
pub fn study_files() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().map(|path| match path.is_dir() {
        true => path.join("study.toml"),
        false => path,
    })
}

/// Reads `left` or `right`.
pub fn sides() -> impl TypedValueParser<Value = Side> {
    PossibleValuesParser::new(["left", "right"]).try_map(|side| side.parse::<Side>())
}

/// The side of the body as the core has it.
pub fn of_body(side: Side) -> fluoropose::Side {
    match side {
        Side::Left => fluoropose::Side::Left,
        Side::Right => fluoropose::Side::Right,
    }
}

/// Seeds from one to another.
#[derive(Clone, Debug, PartialEq)]
pub struct Seeds(RangeInclusive<u64>);

impl Seeds {
    /// Each with its folder: `out` itself where there is but one, else a folder there.
    pub fn folders(&self, out: &Path) -> impl Iterator<Item = (u64, PathBuf)> {
        let is_one = self.0.start() == self.0.end();
        let folder = move |seed: u64| match is_one {
            true => out.to_owned(),
            false => out.join(seed.to_string()),
        };
        self.0.clone().map(move |seed| (seed, folder(seed)))
    }
}

impl FromStr for Seeds {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let (first, last) = text.split_once("..").unwrap_or((text, text));
        let what = || format!("'{text}' is neither a number nor two as in 1..12");
        let (first, last) = (
            first.parse().with_context(what)?,
            last.parse().with_context(what)?,
        );
        ensure!(first <= last, "'{text}' holds no seed");
        Ok(Self(first..=last))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_end_where_they_are_said_to_end() {
        let count = |text: &str| text.parse::<Range>().map(|Range(axis)| axis.count).ok();
        assert_eq!(count("-15:15:1"), Some(31));
        assert_eq!(count("-1:1:0.1"), Some(21));
        assert_eq!(count("0:1:0.333333333333333"), Some(4));
        assert_eq!(count("7:7:1"), Some(1));
        for wrong in ["1:-1:1", "0:1:0", "0:1:nan", "0:9000:1", "0:1", "a:1:1"] {
            assert_eq!(count(wrong), None, "{wrong}");
        }
        let told = "-4:4:3".parse::<Range>().unwrap_err().to_string();
        assert!(told.contains("from -4 to 2, not to 4"), "{told}");
    }

    #[test]
    fn counts_are_whole_and_above_0() {
        assert_eq!(at_least_1("12").ok(), Some(12));
        for wrong in ["0", "-1", "1.5", ""] {
            assert!(at_least_1(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn rates_are_above_0() {
        assert_eq!(above_0("7.5").ok(), Some(7.5));
        for wrong in ["0", "-1", "nan", "inf", "7,5", ""] {
            assert!(above_0(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn seeds_are_one_or_all_from_one_to_another() {
        assert_eq!("7".parse::<Seeds>().unwrap(), Seeds(7..=7));
        assert_eq!("3..9".parse::<Seeds>().unwrap(), Seeds(3..=9));
        let folders = |seeds: Seeds| {
            let folders = seeds.folders(Path::new("out"));
            folders.map(|(_, folder)| folder).collect::<Vec<_>>()
        };
        assert_eq!(folders(Seeds(7..=7)), [Path::new("out")]);
        assert_eq!(folders(Seeds(8..=9)), ["out/8", "out/9"].map(Path::new));
        for wrong in ["", "a", "3..", "9..3", "1..2..3"] {
            assert!(wrong.parse::<Seeds>().is_err(), "{wrong}");
        }
    }
}

//! What is asked of `track`.

use std::path::PathBuf;
use std::str::FromStr;

use anyhow::{Context, Result, ensure};
use fluoropose::refine::Polarity;

use crate::options::Pair;
use crate::progress::Stop;

/// What is asked of `track`.
pub struct Request {
    /// Study file.
    pub study: PathBuf,
    /// Folder for what is found.
    pub out: PathBuf,
    /// Clicks into components.
    pub clicks: Vec<Click>,
    /// Poses that a person fixed.
    pub fixed: Vec<FixedPoses>,
    /// Whether implants are darker or brighter than what surrounds them; the film tells it where it is not said.
    pub polarity: Option<Polarity>,
    /// Longest gap that is filled, frames.
    pub interpolate: usize,
    /// Whether what was done before is left out.
    pub anew: bool,
    /// Whether nothing is said of the progress.
    pub quiet: bool,
    /// A wish to stop before the end: what was done is kept.
    pub stop: Stop,
}

impl Request {
    /// The components that clicks and fixed poses name.
    pub(super) fn components(&self) -> impl Iterator<Item = &str> {
        let clicks = self.clicks.iter().map(|one| one.component.as_str());
        clicks.chain(self.fixed.iter().map(|one| one.component.as_str()))
    }
}

/// A click into a component, `COMPONENT:FRAME:COLUMN,ROW`.
#[derive(Clone, Debug, PartialEq)]
pub struct Click {
    /// The component's name.
    pub component: String,
    /// The frame, from 0.
    pub frame: usize,
    /// Column and row, pixels.
    pub place: [f64; 2],
}

impl FromStr for Click {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let what = || format!("'{text}' is not COMPONENT:FRAME:COLUMN,ROW");
        let mut parts = text.rsplitn(3, ':');
        let (place, frame) = (parts.next(), parts.next());
        let (place, frame) = place.zip(frame).with_context(what)?;
        let component = parts.next().with_context(what)?;
        let number: usize = frame.parse().with_context(what)?;
        ensure!(number >= 1, "'{text}': frames are counted from 1");
        let Pair(place) = place.parse::<Pair>().with_context(what)?;
        Ok(Self {
            component: component.to_owned(),
            frame: number - 1,
            place,
        })
    }
}

/// Poses of a component that a person fixed, `COMPONENT=FILE`.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedPoses {
    /// The component's name.
    pub component: String,
    /// Pose file, a row a frame, NaN where nothing is fixed.
    pub file: PathBuf,
}

impl FromStr for FixedPoses {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let (component, file) = text
            .split_once('=')
            .with_context(|| format!("'{text}' is not COMPONENT=FILE"))?;
        Ok(Self {
            component: component.to_owned(),
            file: file.into(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clicks_and_fixed_poses_are_read_and_frames_counted_from_1() {
        let click: Click = "the: femur:12:512.5,400".parse().unwrap();
        assert_eq!((click.component.as_str(), click.frame), ("the: femur", 11));
        assert_eq!(click.place, [512.5, 400.0]);
        for wrong in ["femur:1", "femur:0:3,4", "femur:x:3,4", "femur:1:3"] {
            assert!(wrong.parse::<Click>().is_err(), "{wrong}");
        }
        let fixed: FixedPoses = "tibia=a=b.jts".parse().unwrap();
        assert_eq!(fixed.file, PathBuf::from("a=b.jts"));
        assert!("tibia".parse::<FixedPoses>().is_err());
    }
}

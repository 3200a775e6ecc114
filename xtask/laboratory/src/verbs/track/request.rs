//! What is asked of `track`.

use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;

use anyhow::{Context, Result, bail, ensure};
use fluoropose::pose::Pose;
use fluoropose::refine::Polarity;

use crate::files::{Film, read_poses_of};
use crate::options::Pair;
use crate::progress::Stop;

/// What a run tells while it goes on.
pub enum Told {
    /// What has to be known of what was given, a sentence.
    Remark(String),
    /// What is taken for granted of every film alike, a sentence: for whoever reads along, and no warning.
    Taken(String),
    /// What was just done or is begun.
    Step {
        /// In a few words; frames are counted from 1.
        what: String,
        /// So many frames of components have been looked at,
        done: usize,
        /// of so many.
        of: usize,
    },
}

/// Who hears it, on whatever thread it comes.
pub type Listener = Arc<dyn Fn(Told) + Send + Sync>;

/// What is asked of `track`.
pub struct Request {
    /// Study file.
    pub study: PathBuf,
    /// Folder for what is found.
    pub out: PathBuf,
    /// Clicks into components.
    pub clicks: Vec<Click>,
    /// Poses that a person fixed.
    pub fixed: Vec<Fixed>,
    /// Whether implants are darker or brighter than what surrounds them; the film tells it where it is not said.
    pub polarity: Option<Polarity>,
    /// Longest gap that is filled, frames.
    pub interpolate: usize,
    /// Whether what was done before is left out.
    pub anew: bool,
    /// Who hears what the run tells.
    pub listener: Listener,
    /// A wish to stop before the end: what was done is kept.
    pub stop: Stop,
}

impl Request {
    /// The components that clicks and fixed poses name.
    pub(super) fn components(&self) -> impl Iterator<Item = &str> {
        let clicks = self.clicks.iter().map(|one| one.component.as_str());
        clicks.chain(self.fixed.iter().map(|one| one.component.as_str()))
    }

    /// Refuses clicks that are not on the film, and fixed poses of another one.
    pub(super) fn check(&self, film: &Film) -> Result<()> {
        let count = film.count();
        for fixed in &self.fixed {
            let (called, rows) = (&fixed.called, fixed.poses.len());
            ensure!(
                rows == count,
                "{called}: there are {rows} rows, but the film has {count} frames"
            );
        }
        check_once(&self.fixed)?;
        let (width, height) = film.size();
        for Click {
            called,
            frame,
            place: [column, row],
            ..
        } in &self.clicks
        {
            ensure!(
                *frame < count,
                "{called}: there is no such frame, the film has {count}"
            );
            // The frame's last pixels end there.
            let is_within = |place: f64, side: usize| (0.0..side as f64).contains(&place);
            ensure!(
                is_within(*column, width) && is_within(*row, height),
                "{called}: column {column}, row {row} is not on the frame, which has {width} columns and {height} rows, counted from 0"
            );
        }
        Ok(())
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
    /// What it is called in messages.
    pub called: String,
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
            called: format!("click {text}"),
        })
    }
}

/// Poses of a component that a person fixed.
#[derive(Clone, Debug, PartialEq)]
pub struct Fixed {
    /// The component's name.
    pub component: String,
    /// A row a frame; `None` where nothing is fixed.
    pub poses: Vec<Option<Pose>>,
    /// What they are called in messages.
    pub called: String,
}

/// Refuses a frame of a component that two files fix: one of them would change.
fn check_once(fixed: &[Fixed]) -> Result<()> {
    for (at, one) in fixed.iter().enumerate() {
        for other in &fixed[..at] {
            let mut frames = one.poses.iter().zip(&other.poses);
            let both = frames.position(|(a, b)| a.is_some() && b.is_some());
            if let Some(frame) = both.filter(|_| one.component == other.component) {
                bail!(
                    "{} and {} both fix {} in frame {}: write NaN there in one of them",
                    other.called,
                    one.called,
                    one.component,
                    frame + 1
                );
            }
        }
    }
    Ok(())
}

/// Poses of a component that a person fixed, `COMPONENT=FILE`.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedPoses {
    /// The component's name.
    pub component: String,
    /// Pose file, a row a frame, NaN where nothing is fixed.
    pub file: PathBuf,
}

impl FixedPoses {
    /// Reads the file, for the frames of a folder: a table beside it may tell another order of rows.
    ///
    /// # Errors
    /// Names the file and the line; for poses of other frames.
    pub fn read(&self, frames: &Path) -> Result<Fixed> {
        Ok(Fixed {
            component: self.component.clone(),
            poses: read_poses_of(&self.file, Some(frames))?,
            called: self.file.display().to_string(),
        })
    }
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
    fn several_files_may_fix_a_component_but_none_of_its_frames_twice() {
        let fixed = |component: &str, called: &str, frames: [bool; 3]| Fixed {
            component: component.to_owned(),
            poses: frames.map(|is| is.then_some(Pose::IDENTITY)).into(),
            called: called.to_owned(),
        };
        let first = fixed("femur", "a.jts", [true, false, true]);
        let between = fixed("femur", "b.jts", [false, true, false]);
        let of_other = fixed("tibia", "c.jts", [true; 3]);
        check_once(&[first.clone(), between, of_other]).expect("once");
        let again = fixed("femur", "d.jts", [false, true, true]);
        let told = check_once(&[first, again]).expect_err("twice").to_string();
        let words = "a.jts and d.jts both fix femur in frame 3";
        assert!(told.contains(words), "{told}");
    }

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

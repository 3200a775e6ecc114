//! From the masks of a sequence to a pose in each frame: what a folder of masks and masks in memory have in common.

use anyhow::{Context, Result};
use fluoropose::joint::beside::{Lying, Middles};
use fluoropose::math::Vector3;
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;

use super::decide::{Decision, Known, decide};
use super::mirrored::doubt_mirrored;
use super::report::{FrameReport, report};
use crate::files::{Role, Uncertain};
use crate::finding::{
    EdgeOptions, Filmed, Finder, FrameFound, Method, Stated, axes_of, bring_onto_frames, find_poses,
};
use crate::progress::Stop;
use crate::sequence::Sequence;

/// How the poses of a sequence are found and chosen.
pub struct Posing<'p> {
    /// A library, its model and the camera of the frames; its own method does not count.
    pub finder: &'p Finder<'p>,
    /// How poses are found.
    pub method: Method,
    /// How edges are looked for.
    pub edges: EdgeOptions,
    /// The other component, where its poses are known.
    pub beside: Option<Beside<'p>>,
    /// What is doubtful of the model as the component that it is given as, a sentence: all poses are doubtful then.
    pub doubt: Option<String>,
    /// A wish to stop before the end.
    pub stop: Stop,
}

/// The other component of a knee in the same frames.
pub struct Beside<'p> {
    /// Which one the component itself is.
    pub role: Role,
    /// The other's poses, a row a frame.
    pub poses: Vec<Option<Pose>>,
    /// Rows of those that are doubtful themselves: they rule out no pose.
    pub doubtful: Vec<usize>,
    /// The other's model: tilts are then taken in the axes that both shapes tell, else in those of the files.
    pub model: Option<Model<'p>>,
}

/// What was found in a sequence, and what was chosen.
pub struct Posed {
    /// All that was found, a row a frame.
    pub found: Vec<FrameFound>,
    /// What was chosen.
    pub decisions: Vec<Option<Decision>>,
    /// What the frames tell of their film, in words, for the method image.
    pub film: Option<String>,
    middle: Vector3,
    doubt: Option<String>,
}

impl Posing<'_> {
    /// Finds the poses of a sequence and chooses among them.
    ///
    /// # Errors
    /// For shapes that do not tell their axes where these are needed, and where the work was to stop.
    pub fn run(&self, sequence: Sequence<'_>) -> Result<Posed> {
        let onto_frames = self.method == Method::Image;
        // Outlines first: they tell the film.
        let method = if onto_frames {
            Method::Refined
        } else {
            self.method
        };
        let finder = self
            .finder
            .clone()
            .with_method(method)
            .with_edges(self.edges)
            .stopped_by(self.stop.clone());
        let mut found = find_poses(&finder, &sequence);
        self.stop.check()?;
        let film = onto_frames.then(|| self.onto_the_frames(sequence, &mut found));
        self.stop.check()?;
        let (counterparts, axes) = match &self.beside {
            Some(beside) => (
                beside.counterparts()?,
                beside.axes_of(&self.finder.model())?,
            ),
            None => (Vec::new(), Pose::IDENTITY),
        };
        let mut decisions = decide(&found, &counterparts, &axes)?;
        if let Some(beside) = &self.beside {
            beside.doubt_mirrored(&self.finder.model(), &mut decisions)?;
        }
        Ok(Posed {
            decisions,
            found,
            film,
            middle: self.finder.model().bounds().centre,
            doubt: self.doubt.clone(),
        })
    }

    /// Brings poses onto the frames of a sequence; what these tell of their film.
    fn onto_the_frames(&self, sequence: Sequence<'_>, found: &mut Vec<FrameFound>) -> String {
        let filmed = Filmed {
            name: "metal",
            model: self.finder.model(),
            sequence,
            edges: self.edges,
            found,
            square_px: 1,
        };
        bring_onto_frames(&mut [filmed], &Stated::default()).words
    }
}

impl Beside<'_> {
    fn counterparts(&self) -> Result<Vec<Option<Known>>> {
        let axes = match &self.model {
            Some(model) => shape_axes(model, self.role.other())?,
            None => Pose::IDENTITY,
        };
        let against = |(row, pose): (usize, &Option<Pose>)| {
            pose.map(|pose| Known {
                counterpart: self.role.against(pose.compose(&axes)),
                is_doubtful: self.doubtful.contains(&row),
            })
        };
        Ok(self.poses.iter().enumerate().map(against).collect())
    }

    /// Doubts poses where both components lie beside each other as in no knee. Without the other's model that is not known.
    fn doubt_mirrored(&self, own: &Model<'_>, decisions: &mut [Option<Decision>]) -> Result<()> {
        let Some(other) = &self.model else {
            return Ok(());
        };
        let lying = |decision: &Option<Decision>| decision.as_ref().and_then(Decision::lying);
        let poses: Vec<Option<Lying>> = decisions.iter().map(lying).collect();
        let others = self.poses.iter().map(|pose| pose.map(Lying::from));
        let others: Vec<Option<Lying>> = others.collect();
        let (own_axes, other_axes) = (
            shape_axes(own, self.role)?,
            shape_axes(other, self.role.other())?,
        );
        let own = ((*own.mesh(), &own_axes), &poses);
        let other = ((*other.mesh(), &other_axes), &others);
        let (femur, tibia) = match self.role {
            Role::Femur => (own, other),
            Role::Tibia => (other, own),
        };
        let told = Middles::new(femur.0, tibia.0);
        let told = told.map(|middles| middles.judge_poses(femur.1, tibia.1));
        // Whoever gave the other's poses knows them.
        let good = vec![true; decisions.len()];
        doubt_mirrored(decisions, &good, &told.unwrap_or_default());
        Ok(())
    }

    /// The rotation from the field's axes to the model's, where the other component's are known too.
    fn axes_of(&self, model: &Model<'_>) -> Result<Pose> {
        match self.model {
            Some(_) => shape_axes(model, self.role),
            None => Ok(Pose::IDENTITY),
        }
    }
}

impl Posed {
    /// The poses, a row a frame.
    pub fn poses(&self) -> Vec<Option<Pose>> {
        let pose = |decision: &Option<Decision>| decision.and_then(|decision| decision.pose());
        self.decisions.iter().map(pose).collect()
    }

    /// How uncertain each pose is that has a covariance, a row a frame.
    pub fn uncertain(&self) -> impl Iterator<Item = Option<Uncertain>> {
        uncertain(&self.decisions, self.film.is_some())
    }

    /// The table of the sequence.
    pub fn report(&self) -> Vec<FrameReport> {
        let mut rows = report(&self.found, &self.decisions, &self.middle);
        if let Some(doubt) = &self.doubt {
            rows.iter_mut().for_each(|row| row.distrust(doubt));
        }
        rows
    }
}

/// How uncertain each pose is that has a covariance, a row a frame; `on_frames`: where poses were brought onto frames, whose film has a part
/// in it that candidates do not keep apart. Masks have none.
pub fn uncertain(
    decisions: &[Option<Decision>],
    on_frames: bool,
) -> impl Iterator<Item = Option<Uncertain>> {
    let film_steps = (!on_frames).then_some([[0.0; 6]; 2]);
    decisions.iter().map(move |decision| {
        let posed = decision.as_ref().filter(|one| one.pose().is_some())?;
        Some(Uncertain {
            covariance: posed.chosen.covariance?,
            film_steps,
        })
    })
}

fn shape_axes(model: &Model<'_>, role: Role) -> Result<Pose> {
    let axes = axes_of(model, role, None)?;
    let axes = axes.with_context(|| format!("the shape of the {role:?} does not tell its axes: without --counterpart-model those of the files are taken"))?;
    Ok(axes.model_from_field)
}

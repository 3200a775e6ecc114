//! A component followed through a film: frames come one by one, as they are asked for.

mod film_reader;
mod seen;

use fluoropose::film::FilmModel;
use fluoropose::follow::{Conclusion, Following, FramePose, KnownFemur};
use fluoropose::math::Vector3;
use fluoropose::pose::{EulerPose, Pose};
use seen::Seen;
use wasm_bindgen::prelude::*;

pub use film_reader::FilmReader;

use crate::film::film_model;
use crate::squares::square_px;
use crate::uncertainty::{Uncertainty, uncertainty};
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use fluoropose_page::pose_numbers::{axes_from, from_numbers, to_numbers};

/// Numbers of a pose.
const NUMBERS: usize = 6;

/// Follows a component from poses that are known in some frames; see the core's `Following`.
#[wasm_bindgen]
pub struct FilmFollower {
    following: Following,
    seen: Seen,
    /// Poses that were given: the first one that is looked at tells whether the implant is dark.
    given: Vec<(usize, Pose)>,
    film: Option<FilmModel>,
    /// As it was before sides were chosen.
    undecided: Option<Following>,
}

#[wasm_bindgen]
impl FilmFollower {
    /// Over the frames `first` to `last` of a film of `frames`, all of the size that the calibration text is for. `film` is what the
    /// film makes of the component, as `FilmFacts.model` gives it, or empty.
    ///
    /// # Errors
    /// The core's sentence about the model or the calibration, and a sentence about the film.
    #[wasm_bindgen(constructor)]
    #[expect(
        clippy::too_many_arguments,
        reason = "they cross into JavaScript one by one"
    )]
    pub fn new(
        vertices: Vec<f32>,
        triangles: Vec<u32>,
        calibration: &str,
        width: u32,
        height: u32,
        frames: usize,
        first: usize,
        last: usize,
        film: &[f64],
    ) -> Result<FilmFollower, JsError> {
        let film = film_model(film)?;
        let side = square_px(film.as_ref());
        let seen = Seen::new((vertices, triangles), calibration, (width, height), side)?;
        Ok(Self {
            following: Following::new(seen.middle(), frames, first..last + 1),
            seen,
            given: Vec::new(),
            film,
            undecided: None,
        })
    }

    /// Gives the pose (six numbers) of a frame. One that is `fixed` a person gave: it never changes.
    ///
    /// # Errors
    /// A sentence where they are not six finite numbers.
    pub fn give(&mut self, frame: usize, pose: &[f64], fixed: bool) -> Result<(), JsError> {
        let pose = Pose::from(from_numbers(pose)?);
        self.following.give(frame, pose, fixed);
        self.given.push((frame, pose));
        Ok(())
    }

    /// From now on frames are also asked for that are to be searched as a whole, where the component was lost.
    #[wasm_bindgen(js_name = searchWhereLost)]
    pub fn search_where_lost(&mut self) {
        self.following.search_where_lost();
    }

    /// Whether the frame that is wanted is to be searched as a whole: `searched` takes the answer, not `take`.
    #[wasm_bindgen(getter, js_name = isSearch)]
    pub fn is_search(&self) -> bool {
        self.following.is_search()
    }

    /// The six numbers of the other component's pose in the frame that is to be searched, where the component is to be looked for beside that;
    /// nothing where the whole frame is.
    pub fn beside(&self) -> Option<Vec<f64>> {
        let pose = *self.following.beside()?;
        Some(to_numbers(&EulerPose::from(pose)).to_vec())
    }

    /// Whether metal is brighter than what surrounds it, as the first frame with a known pose told.
    #[wasm_bindgen(getter, js_name = isBright)]
    pub fn is_bright(&self) -> bool {
        self.seen.is_bright()
    }

    /// What came of searching the frame that was asked for: the six numbers of the pose that was found there, or nothing.
    ///
    /// # Errors
    /// A sentence where they are not six finite numbers.
    pub fn searched(&mut self, pose: Option<Vec<f64>>) -> Result<(), JsError> {
        let pose = pose.map(|pose| from_numbers(&pose)).transpose()?;
        self.following.searched(pose.map(Pose::from));
        Ok(())
    }

    /// The frame that is to be looked at next; nothing where this part of the work is done.
    pub fn wanted(&mut self) -> Option<usize> {
        self.following.wanted()
    }

    /// Looks at the frame that was asked for; gives its pose, where one was found.
    ///
    /// # Errors
    /// The core's sentence about a pose that was given and cannot be drawn.
    pub fn take(&mut self, frame: &FrameImage) -> Result<Option<Vec<f64>>, JsError> {
        let following = &mut self.following;
        let wanted = following.wanted();
        let given = self.given.iter().find(|(at, _)| Some(*at) == wanted);
        let given = given.map(|(_, pose)| pose);
        let found = self
            .seen
            .look(frame, (given, self.film), |subject, image, memory| {
                following.take(subject, image, memory).map_err(sentence)
            })??;
        Ok(found.map(|found| to_numbers(&EulerPose::from(found.pose)).to_vec()))
    }

    /// Begins to look at frames from both sides of the mirror, which `chooseSides` goes on from.
    #[wasm_bindgen(js_name = seeSides)]
    pub fn see_sides(&mut self) {
        self.following.see_sides();
    }

    /// Begins the second part: which side of the mirror is the right one. A tibia is told by the femoral poses (six numbers a
    /// frame, not finite where there is none) with the axes of both (nine numbers each, as `axes_from` takes them); without them
    /// the edges alone decide.
    ///
    /// # Errors
    /// A sentence where axes are no right-handed frame.
    #[wasm_bindgen(js_name = chooseSides)]
    pub fn choose_sides(
        &mut self,
        femurs: &[f64],
        femoral_axes: &[f64],
        own_axes: &[f64],
    ) -> Result<(), JsError> {
        let femur = known_femur(femurs, femoral_axes, own_axes)?;
        self.undecided = Some(self.following.clone());
        self.following.choose_sides(femur);
        Ok(())
    }

    /// After sides were chosen by what was known of the femur then, and all was done: with what is known of it now the same is done,
    /// or, where that is not so, the second part begins anew. Whether it stands as it is.
    ///
    /// # Errors
    /// As of `chooseSides`.
    #[wasm_bindgen(js_name = standsWith)]
    pub fn stands_with(
        &mut self,
        femurs: &[f64],
        femoral_axes: &[f64],
        own_axes: &[f64],
    ) -> Result<bool, JsError> {
        let femur = known_femur(femurs, femoral_axes, own_axes)?;
        if self.following.stands_with(femur.clone()) {
            return Ok(true);
        }
        if let Some(undecided) = &self.undecided {
            self.following = undecided.clone();
            self.following.choose_sides(femur);
        }
        Ok(false)
    }

    /// Once all is done, begins to look for the component where it is lost, or lies on other edges, beside the other one in frames in which that is good
    /// (`other`: six numbers a frame, not finite elsewhere; its `middles`). The femur is that of `chooseSides`, as far as it is known by now.
    ///
    /// # Errors
    /// As of `chooseSides`.
    #[wasm_bindgen(js_name = lookBeside)]
    pub fn look_beside(
        &mut self,
        other: &[f64],
        other_middles: &[f64],
        femurs: &[f64],
        femoral_axes: &[f64],
        own_axes: &[f64],
    ) -> Result<(), JsError> {
        let femur = known_femur(femurs, femoral_axes, own_axes)?;
        let poses = other.as_chunks().0.iter().map(known_pose);
        let other = (poses.collect(), &*known_middles(other_middles));
        self.following.look_beside(other, femur);
        Ok(())
    }

    /// The six numbers of each frame in which the component is good, with the other component's `middles`, or none of them; not finite elsewhere.
    pub fn good(&self, other_middles: &[f64]) -> Vec<f64> {
        let good = self.following.good(&known_middles(other_middles));
        let numbers = |found: &Option<FramePose>| match found {
            Some(found) => to_numbers(&EulerPose::from(found.pose)),
            None => [f64::NAN; NUMBERS],
        };
        good.iter().flat_map(numbers).collect()
    }

    /// The frames that are asked whether the constants of the film stand: seven numbers each, the frame's and the six of its pose.
    #[wasm_bindgen(js_name = toAsk)]
    pub fn to_ask(&self, other_middles: &[f64]) -> Vec<f64> {
        let asked = self.following.to_ask(&known_middles(other_middles));
        let numbers = |(frame, pose): (usize, Pose)| {
            let pose = to_numbers(&EulerPose::from(pose));
            [frame as f64].into_iter().chain(pose)
        };
        asked.into_iter().flat_map(numbers).collect()
    }

    /// Ends the work before all is done: what was seen until then counts.
    pub fn stop(&mut self) {
        self.following.stop();
    }

    /// Begins to look at frames from the other side of the mirror too, once all else is done: the answer has it as their rival.
    #[wasm_bindgen(js_name = compareSides)]
    pub fn compare_sides(&mut self, frames: Vec<usize>) {
        self.following.compare_sides(frames.into_iter());
    }

    /// Where the component is in each frame in which it is to be trusted, three numbers each, mm in the camera's frame; not numbers elsewhere.
    pub fn middles(&self) -> Vec<f64> {
        let middles = self.following.middles();
        let numbers = |middle: &Option<Vector3>| middle.unwrap_or([f64::NAN; 3]);
        middles.iter().flat_map(numbers).collect()
    }

    /// The answer, with the other component's `middles`, or none of them.
    pub fn conclude(&self, other_middles: &[f64]) -> FollowedFilm {
        let middles = known_middles(other_middles);
        let cells = self.following.cells();
        let side = square_px(self.film.as_ref());
        let frames = self.following.conclude(&middles);
        let frames = frames.iter().map(|one| one.in_pixels(side)).collect();
        let in_pixels = |found: &FramePose| found.in_pixels(side);
        let middle = self.seen.middle();
        let uncertainties = cells.iter().map(|cell| {
            let found = cell.found()?;
            Some(uncertainty(
                &found.covariance?,
                &found.film_steps,
                &found.pose,
                &middle,
            ))
        });
        FollowedFilm {
            residuals: cells
                .iter()
                .map(|cell| Some(in_pixels(cell.found()?).misfit_px))
                .collect(),
            uncertainties: uncertainties.collect(),
            rivals: (0..cells.len())
                .map(|frame| self.following.rival(frame).map(in_pixels))
                .collect(),
            frames,
        }
    }
}

fn known_middles(numbers: &[f64]) -> Vec<Option<Vector3>> {
    let is_known = |middle: &Vector3| middle.iter().all(|mm| mm.is_finite());
    let middles = numbers.as_chunks().0.iter();
    middles
        .map(|&middle| Some(middle).filter(is_known))
        .collect()
}

fn known_pose(numbers: &[f64; NUMBERS]) -> Option<Pose> {
    let known = numbers.iter().all(|number| number.is_finite());
    let pose = known.then(|| from_numbers(numbers).ok()).flatten();
    pose.map(Pose::from)
}

/// The femur as `chooseSides` takes it; nothing where there are no poses.
fn known_femur(
    poses: &[f64],
    axes: &[f64],
    own_axes: &[f64],
) -> Result<Option<KnownFemur>, JsError> {
    if poses.is_empty() {
        return Ok(None);
    }
    let field = axes_from(axes)?;
    let pose = |numbers: &[f64; NUMBERS]| Some(known_pose(numbers)?.compose(&field));
    let poses = poses.as_chunks().0.iter().map(pose).collect();
    let axes = axes_from(own_axes)?;
    Ok(Some(KnownFemur { poses, axes }))
}

/// What became of every frame.
#[wasm_bindgen]
pub struct FollowedFilm {
    frames: Vec<Conclusion>,
    residuals: Vec<Option<f64>>,
    uncertainties: Vec<Option<Uncertainty>>,
    rivals: Vec<Option<FramePose>>,
}

#[wasm_bindgen]
impl FollowedFilm {
    /// `fixed`, `followed`, `doubtful`, `untrackable` or `unsolved`.
    pub fn state(&self, frame: usize) -> Option<String> {
        Some(self.frames.get(frame)?.state.word().to_owned())
    }

    /// Why, in a sentence without its full stop.
    pub fn because(&self, frame: usize) -> Option<String> {
        Some(self.frames.get(frame)?.to_string())
    }

    /// Six numbers, where there is a pose.
    pub fn pose(&self, frame: usize) -> Option<Vec<f64>> {
        let pose = self.frames.get(frame)?.pose?;
        Some(to_numbers(&EulerPose::from(pose)).to_vec())
    }

    /// As `Match.uncertainty`, where it is known.
    pub fn uncertainty(&self, frame: usize) -> Option<Vec<f64>> {
        let uncertainty = (*self.uncertainties.get(frame)?)?;
        Some(uncertainty.to_vec())
    }

    /// What remains between outline and edges, pixels: by what poses of a frame are compared, as in the commands' `track.csv`.
    pub fn residual(&self, frame: usize) -> Option<f64> {
        *self.residuals.get(frame)?
    }

    /// Six numbers of the pose on the other side of the mirror, where it was compared.
    pub fn rival(&self, frame: usize) -> Option<Vec<f64>> {
        let rival = (*self.rivals.get(frame)?)?;
        Some(to_numbers(&EulerPose::from(rival.pose)).to_vec())
    }

    /// The same of that one.
    #[wasm_bindgen(js_name = rivalResidual)]
    pub fn rival_residual(&self, frame: usize) -> Option<f64> {
        Some((*self.rivals.get(frame)?)?.misfit_px)
    }

    /// How bad a frame is: above 1 it is doubtful, and the worst have the most.
    pub fn badness(&self, frame: usize) -> Option<f64> {
        Some(self.frames.get(frame)?.badness)
    }
}

//! Poses on the edges of a grey frame: corrected by its film, judged, and the outline that they have there.

use fluoropose::camera::Camera;
use fluoropose::film::profile::PROFILE_NUMBERS;
use fluoropose::film::{FilmModel, FilmProfile, pool::profiles_of_each};
use fluoropose::finder::{Candidate as FinderCandidate, Doubt, OTHER_DEG, look_beyond};
use fluoropose::image::border::follow_border;
use fluoropose::image::contour::Contour;
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::image::region::largest_region;
use fluoropose::math::{multiply, transpose};
use fluoropose::pose::{EulerPose, Pose, geodesic_deg, view_rotation};
use fluoropose::refine::{CameraView, ImageTarget, Polarity, Refined};
use wasm_bindgen::prelude::*;

use super::answer::{FAIR, OneClickAnswer};
use super::from_here::{HiddenPixels, model_of};
use super::{Matcher, OFFERED, RIVAL_WITHIN};
use crate::exchange::simplified;
use crate::film::film_model;
use crate::found::{Candidate, Match};
use crate::squares::{look_in_squares, of_pixels, square_px};
use crate::working_model::Assessed;
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use fluoropose_page::pose_numbers::{from_numbers, to_numbers};

/// The outline that is handed out stays so near to the silhouette, pixels.
const TOLERANCE: f64 = 0.5;
/// Of a pose.
const NUMBERS: usize = 6;
/// Corners of a border that a silhouette may have.
const BORDER_CORNERS: usize = 16_384;

/// A grey frame, and what is known of it.
pub(super) struct Seen<'s> {
    pub(super) frame: &'s FrameImage,
    pub(super) camera: &'s Camera,
    pub(super) polarity: Polarity,
    /// Pixels whose edges are not the implant's.
    pub(super) unknown: Option<&'s [Word]>,
    /// What its film makes of the implant.
    pub(super) film: Option<FilmModel>,
    /// The largest usual misfit on it, pixels.
    pub(super) usual: Option<f64>,
}

impl Seen<'_> {
    /// What is doubtful of a pose that leaves more than is usual.
    fn doubt(&self, refined: &Refined) -> Option<Doubt> {
        let (limit_px, px) = (self.usual?, misfit(refined));
        (px > limit_px).then_some(Doubt::Unusual { px, limit_px })
    }

    /// Calls `with` with what the camera saw.
    pub(super) fn look<T>(
        &self,
        with: impl FnOnce(CameraView<'_>) -> Result<T, JsError>,
    ) -> Result<T, JsError> {
        let side = square_px(self.film.as_ref());
        self.look_in(side, with)
    }

    /// The same in squares with sides of so many pixels.
    fn look_in<T>(
        &self,
        side: usize,
        with: impl FnOnce(CameraView<'_>) -> Result<T, JsError>,
    ) -> Result<T, JsError> {
        look_in_squares(
            side,
            self.frame,
            self.camera,
            self.unknown,
            |frame, camera, unknown| {
                let target = ImageTarget {
                    frame,
                    unknown,
                    polarity: self.polarity,
                    film: self.film,
                };
                with(CameraView::only(camera, target))
            },
        )
    }
}

/// A pose that was refined on a frame.
#[derive(Clone, Copy)]
pub(super) struct OnFrame {
    pub(super) refined: Refined,
    /// What led to it.
    pub(super) start: Pose,
    /// Part of the outline that lies on edges of the right sign, 0 to 1.
    pub(super) support: f64,
}

#[wasm_bindgen]
impl Matcher {
    /// Profiles of a frame across the model's outline at a pose (six numbers), as `FilmStudy` takes them, in squares with sides of so many
    /// pixels (1: as they are). The pose need only be near.
    ///
    /// # Errors
    /// The core's sentence about a pose at which the model cannot be drawn.
    #[wasm_bindgen(js_name = filmProfiles)]
    pub fn film_profiles(
        &mut self,
        frame: &FrameImage,
        hidden: &HiddenPixels,
        pose: &[f64],
        side: usize,
    ) -> Result<Vec<f32>, JsError> {
        let pose = Pose::from(from_numbers(pose)?);
        let seen = self.seen(frame, hidden, &pose, None)?;
        let mut profiles = vec![FilmProfile::default(); profiles_of_each(1)];
        let model = model_of(&mut self.model)?;
        let read = seen.look_in(side, |view| {
            model.film_profiles(&pose, &view, &mut profiles)
        })?;
        let mut numbers = Vec::with_capacity(read * PROFILE_NUMBERS);
        profiles[..read]
            .iter()
            .for_each(|profile| numbers.extend(profile.numbers()));
        Ok(numbers)
    }

    /// Brings poses that were refined on a frame (six numbers each) to where its film puts the edges (`film` as `FilmFacts.model`
    /// gives it): each with its outline, how sure it is and how far to be trusted, in the order given (`OneClickAnswer.from`), but
    /// for those that cannot be corrected. `supports` are the parts of their outlines on edges. After them come others that explain
    /// the frame as well or better: mirror images, and, where the `chosen` one leaves more than is `usual` (as `usualMisfit` gives
    /// it), poses around it.
    ///
    /// # Errors
    /// The core's sentence about why none can be corrected, or one about the numbers.
    #[wasm_bindgen(js_name = correctOnFrame)]
    #[allow(
        clippy::too_many_arguments,
        reason = "JavaScript passes arrays and handles, one by one"
    )]
    pub fn correct_on_frame(
        &mut self,
        frame: &FrameImage,
        hidden: &HiddenPixels,
        poses: &[f64],
        supports: &[f64],
        chosen: usize,
        film: &[f64],
        usual: Option<f64>,
    ) -> Result<OneClickAnswer, JsError> {
        let given = given_poses(poses, supports)?;
        let Some(own) = given.get(chosen) else {
            return Err(JsError::new("There is no chosen pose to correct"));
        };
        let seen = Seen {
            usual,
            ..self.seen(frame, hidden, &own.start, film_model(film)?)?
        };
        let mut found = self.corrected(&given, &seen)?;
        stand_for(&own.start, &mut found);
        let from = |one: &OnFrame| given.iter().position(|given| given.start == one.start);
        let (mut known, mut more): (Vec<_>, Vec<_>) =
            found.into_iter().partition(|one| from(one).is_some());
        known.sort_by_key(from);
        if let Some(own) = known.iter().find(|one| from(one) == Some(chosen)) {
            more.extend(self.around(own, &seen)?);
        }
        let least = known.iter().chain(&more).map(|one| misfit(&one.refined));
        let limit = RIVAL_WITHIN * least.fold(f64::INFINITY, f64::min);
        more.retain(|one| misfit(&one.refined) <= limit);
        let places = known.iter().map(from).collect();
        known.extend(more.into_iter().take(OFFERED));
        self.answer(&known, places, &seen)
    }
}

/// Where another pose came to where the chosen one did, and the better of both is left, that is the chosen one.
fn stand_for(chosen: &Pose, found: &mut [OnFrame]) {
    if found.iter().any(|one| one.start == *chosen) {
        return;
    }
    let turn_deg = |one: &OnFrame| geodesic_deg(&one.refined.pose.rotation, &chosen.rotation);
    let near = found.iter_mut().filter(|one| turn_deg(one) < OTHER_DEG);
    if let Some(one) = near.min_by(|a, b| turn_deg(a).total_cmp(&turn_deg(b))) {
        one.start = *chosen;
    }
}

/// Poses that were refined on a frame before, as they were kept.
fn given_poses(poses: &[f64], supports: &[f64]) -> Result<Vec<OnFrame>, JsError> {
    let mut given = Vec::new();
    for (number, pose) in poses.chunks(NUMBERS).enumerate() {
        let start = Pose::from(from_numbers(pose)?);
        given.push(OnFrame {
            refined: Refined::at(start),
            start,
            support: supports.get(number).copied().unwrap_or(1.0),
        });
    }
    Ok(given)
}

impl Matcher {
    fn seen<'s>(
        &mut self,
        frame: &'s FrameImage,
        hidden: &'s HiddenPixels,
        pose: &Pose,
        film: Option<FilmModel>,
    ) -> Result<Seen<'s>, JsError> {
        let model = model_of(&mut self.model)?;
        let camera = &hidden.camera;
        Ok(Seen {
            polarity: frame.look(|frame| model.polarity(pose, camera, frame))?,
            frame,
            camera,
            unknown: Some(&hidden.words),
            film,
            usual: None,
        })
    }

    /// Poses that were found in a frame's own pixels, as its film puts the edges where that is read in squares.
    pub(super) fn in_squares(
        &mut self,
        found: Vec<OnFrame>,
        seen: &Seen<'_>,
    ) -> Result<Vec<OnFrame>, JsError> {
        match of_pixels(seen.film) {
            Some(_) => Ok(found),
            None => self.corrected(&found, seen),
        }
    }

    /// Poses that were refined on a frame as its film puts the edges, where that is known, and mirror images of the best.
    fn corrected(&mut self, given: &[OnFrame], seen: &Seen<'_>) -> Result<Vec<OnFrame>, JsError> {
        if seen.film.is_none() {
            return Ok(given.to_vec());
        }
        let refined: Vec<Refined> = given.iter().map(|one| one.refined).collect();
        let model = model_of(&mut self.model)?;
        let found = seen.look(|view| model.correct(&refined, view))?;
        let support = |start: &Pose| Some(given.iter().find(|one| one.start == *start)?.support);
        Ok(found
            .iter()
            .filter_map(|one| on_frame(one, support(&one.start)))
            .collect())
    }

    /// Poses on a frame as candidates with their outlines; `places` are those of the first ones among poses that were given.
    fn answer(
        &mut self,
        poses: &[OnFrame],
        places: Vec<Option<usize>>,
        seen: &Seen<'_>,
    ) -> Result<OneClickAnswer, JsError> {
        let mut answer = OneClickAnswer {
            supports: poses.iter().map(|one| one.support).collect(),
            places,
            ..OneClickAnswer::new(seen.film.is_some())
        };
        let mut candidates = Vec::new();
        for one in poses {
            candidates.push(self.on_frame(one, seen)?);
            let outline = self.outline_at(&one.refined.pose, seen.camera)?;
            answer.outlines.push(outline);
        }
        answer.matched = Some(Match {
            compared: candidates.len(),
            candidates,
            clipped: false,
            partial: false,
            chosen: None,
        });
        Ok(answer)
    }

    /// A pose that was found on a frame, refined there, and its mirror images.
    pub(super) fn given_pose(
        &mut self,
        pose: &Pose,
        seen: &Seen<'_>,
    ) -> Result<Vec<OnFrame>, JsError> {
        let model = model_of(&mut self.model)?;
        let found = seen.look(|view| model.with_mirror_images(pose, view))?;
        Ok(found.iter().filter_map(|one| on_frame(one, None)).collect())
    }

    /// Poses around one that leaves more than is usual on its film, or of which nothing tells that ([`look_beyond`]).
    pub(super) fn around(
        &mut self,
        one: &OnFrame,
        seen: &Seen<'_>,
    ) -> Result<Vec<OnFrame>, JsError> {
        let model = model_of(&mut self.model)?;
        let side = square_px(seen.film.as_ref()) as f64;
        // What remains is in sides of squares until it is handed out.
        let (usual, remains) = (seen.usual.map(|px| px / side), misfit(&one.refined));
        let beyond = look_beyond(usual, remains, model.is_nearly_symmetric());
        let (Some(enough), Some(_)) = (beyond, seen.film) else {
            return Ok(Vec::new());
        };
        let found = seen.look(|view| model.look_around(&one.refined, view, enough))?;
        Ok(found.iter().filter_map(|one| on_frame(one, None)).collect())
    }

    /// A refined pose as the page reads it.
    pub(super) fn on_frame(
        &mut self,
        one: &OnFrame,
        seen: &Seen<'_>,
    ) -> Result<Candidate, JsError> {
        let model = model_of(&mut self.model)?;
        let assessed = seen.look(|view| model.assess(&one.refined, view))?;
        let assessed = supported(assessed, one.support);
        let refined = one.refined.in_pixels(square_px(seen.film.as_ref()));
        let pose = &one.refined.pose;
        let (view, at_border) = self.view_of(pose)?;
        Ok(Candidate {
            pose: to_numbers(&EulerPose::from(*pose)),
            unmatched: None,
            drawn: None,
            residual_px: Some(refined.residual_px),
            misfit: Some(misfit(&refined)),
            verdict: Some(assessed.verdict().or_doubt(seen.doubt(&refined))),
            uncertainty: assessed.uncertainty,
            start: Some(to_numbers(&EulerPose::from(one.start))),
            view,
            at_border,
            input: Vec::new(),
            library: Vec::new(),
        })
    }

    /// The model's silhouette at a pose as an outline: columns and rows by turns.
    pub(super) fn outline_at(&mut self, pose: &Pose, camera: &Camera) -> Result<Vec<f64>, JsError> {
        let (width, height) = (camera.width(), camera.height());
        let model = model_of(&mut self.model)?;
        let drawn = model.drawn_at(pose, camera)?;
        outline_of(&Mask::new(drawn, width, height).map_err(sentence)?)
    }

    /// The library's view of a pose (rotations about x and y, degrees), and whether it lies at the border of the library
    /// or beyond.
    fn view_of(&mut self, pose: &Pose) -> Result<([f64; 2], bool), JsError> {
        let info = *self.library.borrow_dependent().info();
        let ray = pose.transform(&info.reference);
        let rotation = multiply(&transpose(&view_rotation(&ray)), &pose.rotation);
        let seen = EulerPose::from(Pose { rotation, ..*pose });
        let view = [seen.x_rot_deg, seen.y_rot_deg];
        let axes = [info.grid.x, info.grid.y];
        let inner = view.iter().zip(axes).all(|(&at, axis)| {
            let last = axis.at(axis.count.saturating_sub(1) as f64);
            axis.first < at && at < last
        });
        Ok((view, !inner && self.has_border()))
    }
}

/// A candidate with the part of its outline on edges, where that was measured when it was found.
fn on_frame(found: &FinderCandidate, support: Option<f64>) -> Option<OnFrame> {
    Some(OnFrame {
        refined: found.refined?,
        start: found.start,
        support: support.unwrap_or(found.fit.met),
    })
}

/// By what poses on a frame are compared, as the finder compares its candidates: it counts outline that lies on no edge.
pub(super) fn misfit(refined: &Refined) -> f64 {
    (2.0 * refined.loss).sqrt()
}

/// What else lies near an outline is no counterpart where only a little of its length lies on strong edges of the right
/// polarity.
fn supported(mut assessed: Assessed, part: f64) -> Assessed {
    if part < FAIR {
        assessed.fit.met = assessed.fit.met.min(part);
    }
    assessed
}

/// The outline of a mask's largest region with few points: columns and rows by turns.
pub(super) fn outline_of(mask: &Mask<'_>) -> Result<Vec<f64>, JsError> {
    let (width, height) = (mask.width(), mask.height());
    let mut memory: [Vec<Word>; 2] = std::array::from_fn(|_| vec![0; words_needed(width, height)]);
    let [a, b] = &mut memory;
    let [mut rest, mut largest] = [
        MaskMut::new(a, width, height).map_err(sentence)?,
        MaskMut::new(b, width, height).map_err(sentence)?,
    ];
    largest_region(mask, &mut rest, &mut largest).map_err(sentence)?;
    let mut border = Box::<Contour<BORDER_CORNERS>>::default();
    follow_border(&largest.as_mask(), border.as_mut()).map_err(sentence)?;
    let points = simplified(&border, TOLERANCE, [width, height])?;
    Ok(points.iter().flat_map(|p| [p.column, p.row]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chosen_pose_that_came_to_another_is_that_one_and_no_third() {
        let turned = |x_rot_deg| {
            Pose::from(EulerPose {
                x_rot_deg,
                z_mm: -900.0,
                ..EulerPose::default()
            })
        };
        let corrected = |from: f64, to: f64| OnFrame {
            refined: Refined::at(turned(to)),
            start: turned(from),
            support: 1.0,
        };
        let chosen = turned(0.0);
        let places = |mut found: Vec<OnFrame>| {
            stand_for(&chosen, &mut found);
            found.iter().position(|one| one.start == chosen)
        };
        assert_eq!(
            places(vec![corrected(30.0, 29.0), corrected(2.0, 1.0)]),
            Some(1)
        );
        assert_eq!(
            places(vec![corrected(2.0, 1.0), corrected(0.0, 1.5)]),
            Some(1)
        );
        // It could not be corrected, and nothing is where it was.
        assert_eq!(places(vec![corrected(30.0, 29.0)]), None);
    }
}

//! Other poses around one that a known film explains badly.
//!
//! A tray's wall is thin, and in a soft or scattered frame the strongest edges along it are those of its recess: a model farther
//! away and turned lies on them. Where the film is known the model as drawn has those edges too, so that little remains at the
//! right pose, and several times as much at the others. Starts nearer and farther, turned to all sides, and mirrored, are
//! compared with the frame; the best of each distance are refined, and it is seen what leaves least.

use heapless::Vec;

use super::candidate::{CANDIDATES, Candidate, is_same, keep_once, misfit_of};
use super::nearby::about;
use crate::camera::Camera;
use crate::math::{radians, scale};
use crate::mesh::Model;
use crate::mesh::mirror::mirror_pose;
use crate::mesh::symmetry::SymmetryPlane;
use crate::pose::Pose;
use crate::refine::{
    CameraView, ImageTarget, RefineError, RefineMemory, RefineOptions, Refined, assess, fit_at,
    refine,
};
use crate::shortlist::keep;

/// Starts lie at these multiples of a pose's distance: an inner rim puts it up to a tenth too far.
const DISTANCES: [f64; 5] = [1.0, 0.98, 0.96, 0.94, 1.02];
/// And are turned about the camera's x and y axes by up to this number of steps to either side, each of so many degrees.
const TURNS: i32 = 2;
const TURN_DEG: [f64; 2] = [4.0, 5.0];
/// Starts of one distance that are refined, and those of all.
const OF_A_DISTANCE: usize = 2;
const STARTS: usize = 24;
/// Poses that are found, at most.
const FOUND: usize = 4;

/// Looks for a pose around the best of the candidates that its film, which `image` has, explains better; gives all of them, best
/// first. At a misfit of `enough_px` no farther start is tried.
///
/// # Errors
/// [`RefineError`] where memory is too short.
pub fn look_around(
    model: &Model<'_>,
    (camera, image): (&Camera, ImageTarget<'_>),
    planes: &[SymmetryPlane],
    candidates: &[Candidate],
    (options, enough_px): (RefineOptions, f64),
    memory: &mut RefineMemory<'_>,
) -> Result<Vec<Candidate, CANDIDATES>, RefineError> {
    let mut all: Vec<Candidate, CANDIDATES> = Vec::new();
    for candidate in candidates {
        keep(&mut all, *candidate, Candidate::misfit);
    }
    let Some(best) = all.first().copied() else {
        return Ok(all);
    };
    let mut around = Around {
        model,
        view: CameraView::only(camera, image),
        planes,
        options,
        memory,
        found: Vec::new(),
    };
    for start in around.starts(&best.pose)? {
        around.refine(&start)?;
        if around
            .found
            .first()
            .is_some_and(|(_, least)| misfit_of(least) <= enough_px)
        {
            break;
        }
    }
    around.refine_mirror_images()?;
    let found = around.assessed(&best)?;
    for candidate in found {
        keep_once(&mut all, candidate);
    }
    Ok(all)
}

struct Around<'a, 'm> {
    model: &'a Model<'a>,
    view: CameraView<'a>,
    planes: &'a [SymmetryPlane],
    options: RefineOptions,
    memory: &'a mut RefineMemory<'m>,
    /// Starts and what became of them, by rising loss, each pose once.
    found: Vec<(Pose, Refined), FOUND>,
}

impl Around<'_, '_> {
    /// Starts around a pose and its mirror images, the best fits first.
    fn starts(&mut self, pose: &Pose) -> Result<Vec<Pose, STARTS>, RefineError> {
        let mut starts: Vec<(f64, Pose), STARTS> = Vec::new();
        let bases =
            core::iter::once(*pose).chain(self.planes.iter().map(|plane| mirror_pose(pose, plane)));
        for base in bases {
            for distance in DISTANCES {
                for start in self.of_a_distance(&base, distance)? {
                    keep(&mut starts, start, |&(misfit_px, _)| misfit_px);
                }
            }
        }
        Ok(starts.into_iter().map(|(_, pose)| pose).collect())
    }

    fn of_a_distance(
        &mut self,
        base: &Pose,
        distance: f64,
    ) -> Result<Vec<(f64, Pose), OF_A_DISTANCE>, RefineError> {
        let middle = self.model.bounds().centre;
        let shift = scale(&base.transform(&middle), distance - 1.0);
        let mut best = Vec::new();
        for x in -TURNS..=TURNS {
            for y in -TURNS..=TURNS {
                let turn = [
                    radians(TURN_DEG[0] * f64::from(x)),
                    radians(TURN_DEG[1] * f64::from(y)),
                    0.0,
                ];
                let start = about(&middle, base, &turn, shift);
                // Where the model cannot be drawn is no start.
                let fit = fit_at(self.model, &[self.view], &start, self.memory);
                if let Some(fit) = RefineError::passed_over(fit)? {
                    keep(&mut best, (fit.misfit_px, start), |&(misfit_px, _)| {
                        misfit_px
                    });
                }
            }
        }
        Ok(best)
    }

    /// Refines a start; one that leads nowhere is no rival.
    fn refine(&mut self, start: &Pose) -> Result<(), RefineError> {
        let tried = refine(self.model, &[self.view], start, self.options, self.memory);
        let Some(refined) = RefineError::passed_over(tried)? else {
            return Ok(());
        };
        let same = |(_, other): &(Pose, Refined)| is_same(&other.pose, &refined.pose);
        if self
            .found
            .iter()
            .any(|other| same(other) && other.1.loss <= refined.loss)
        {
            return Ok(());
        }
        self.found.retain(|other| !same(other));
        keep(&mut self.found, (*start, refined), |(_, refined)| {
            refined.loss
        });
        Ok(())
    }

    fn refine_mirror_images(&mut self) -> Result<(), RefineError> {
        if let Some((_, best)) = self.found.first().copied() {
            for plane in self.planes {
                self.refine(&mirror_pose(&best.pose, plane))?;
            }
        }
        Ok(())
    }

    fn assessed(&mut self, best: &Candidate) -> Result<Vec<Candidate, FOUND>, RefineError> {
        let Self {
            model,
            view,
            memory,
            ..
        } = self;
        let found = self.found.iter();
        let one = |(start, refined): &(Pose, Refined)| {
            let assessment = assess(model, &[*view], refined, memory)?;
            Ok(Candidate {
                pose: refined.pose,
                start: *start,
                located: best.located,
                refined: Some(*refined),
                covariance: assessment.covariance,
                fit: assessment.fit,
            })
        };
        found.map(one).collect()
    }
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::finder::candidate::SAME_DEG;
    use crate::finder::fake::{SIDE, camera, crank, drawn, placed};
    use crate::image::mask::Mask;
    use crate::image::silhouette::Silhouette;
    use crate::math::{norm, subtract};
    use crate::pose::geodesic_deg;
    use crate::refine::RefineBuffers;

    /// Does something around what is seen of the crank at a pose.
    fn around_seen<T>(
        right: &Pose,
        planes: &[SymmetryPlane],
        act: impl FnOnce(&mut Around<'_, '_>) -> T,
    ) -> T {
        let (model, camera) = (crank(), camera());
        let words = drawn(&model, &camera, right);
        let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
        let (mut buffers, model) = (RefineBuffers::default(), model.as_model());
        let mut memory = buffers.borrow(&model, &camera);
        act(&mut Around {
            model: &model,
            view: CameraView::only(&camera, Silhouette::from(&mask)),
            planes,
            options: RefineOptions::default(),
            memory: &mut memory,
            found: Vec::new(),
        })
    }

    #[test]
    fn starts_that_lead_to_one_pose_find_it_once_and_one_that_leads_nowhere_nothing() {
        let right = placed([20.0, 30.0, 0.0], [0.0; 3]);
        around_seen(&right, &[], |around| {
            let behind = placed([0.0; 3], [0.0, 0.0, 2000.0]);
            around.refine(&behind).expect("room");
            assert!(around.found.is_empty());
            let starts =
                [[21.5, 29.0, 1.0], [19.0, 31.5, -1.0]].map(|turn| placed(turn, [1.0, -1.0, 5.0]));
            for start in &starts {
                around.refine(start).expect("room");
            }
            let [(start, refined)] = around.found[..] else {
                panic!("one pose: {:?}", around.found);
            };
            assert!(starts.contains(&start));
            assert!(geodesic_deg(&refined.pose.rotation, &right.rotation) < SAME_DEG);
            // What is there already, and leaves more, makes room for what leaves less.
            around.found[0].1.loss = 1e3;
            around.found[0].0 = behind;
            around.refine(&start).expect("room");
            let lost = around.found.iter().any(|(from, _)| *from == behind);
            assert!(around.found.len() == 1 && !lost);
        });
    }

    /// Of each distance the best starts, whichever way these are turned; all of them lie on the ray through the middle.
    #[test]
    fn the_right_pose_is_among_the_starts_around_one_that_lies_too_far() {
        let base = placed([20.0, 30.0, 0.0], [30.0, 10.0, -20.0]);
        let middle = crank().as_model().bounds().centre;
        let at = |distance: f64, [x, y]: [f64; 2]| {
            let shift = scale(&base.transform(&middle), distance - 1.0);
            about(&middle, &base, &[radians(x), radians(y), 0.0], shift)
        };
        for (distance, turn_deg) in [(1.0, [0.0, 0.0]), (0.96, [4.0, -10.0]), (1.02, [-8.0, 5.0])] {
            let right = at(distance, turn_deg);
            let starts = around_seen(&right, &[], |around| around.starts(&base)).expect("room");
            assert_eq!(starts.len(), DISTANCES.len() * OF_A_DISTANCE);
            // Nothing fits better than the right one.
            let off = subtract(&starts[0].translation, &right.translation);
            let deg = geodesic_deg(&starts[0].rotation, &right.rotation);
            assert!(norm(&off) < 1e-6 && deg < 1e-6, "{distance}: {deg}");
            let ray = base.transform(&middle);
            for distance in DISTANCES {
                let there = |start: &&Pose| {
                    let off = subtract(&start.transform(&middle), &scale(&ray, distance));
                    norm(&off) < 1e-6
                };
                assert_eq!(starts.iter().filter(there).count(), OF_A_DISTANCE);
            }
        }
    }

    #[test]
    fn what_was_found_is_assessed_with_its_start_and_what_led_to_the_best() {
        let right = placed([20.0, 30.0, 0.0], [0.0; 3]);
        let start = placed([21.0, 29.0, 1.0], [0.0; 3]);
        let best = Candidate {
            pose: start,
            start,
            located: Some(crate::finder::fake::located(9)),
            refined: None,
            covariance: None,
            fit: crate::refine::Fit::default(),
        };
        let (found, assessed) = around_seen(&right, &[], |around| {
            around.refine(&start).expect("room");
            (around.found.clone(), around.assessed(&best))
        });
        let assessed = assessed.expect("in front");
        assert_eq!((found.len(), assessed.len()), (1, 1));
        let one = assessed[0];
        assert_eq!((one.start, one.located), (start, best.located));
        assert_eq!((one.pose, one.refined), (found[0].1.pose, Some(found[0].1)));
        assert!(one.covariance.is_some() && one.fit.met > 0.9, "{one:?}");
        assert!((one.misfit() - misfit_of(&found[0].1)).abs() < 1e-12);
    }
}

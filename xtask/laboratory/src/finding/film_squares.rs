//! Frames in the squares of pixels that their film is read in (the core's `SquareChoice`), and what they tell of it there.

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::film::estimate::MOST_COMPONENTS;
use fluoropose::film::pool::profiles_of_each;
use fluoropose::film::{FilmModel, FilmPool, FilmProfile, SquareChoice};
use fluoropose::pose::Pose;
use fluoropose::refine::{ImageTarget, RefineBuffers, film_profiles};
use rayon::prelude::*;

use super::film::FrameFound;
use super::filmed::{Filmed, Stated};

/// Finds the squares, and tells the parts.
pub(super) fn choose_squares(parts: &mut [Filmed<'_>], stated: &Stated) {
    let (mut choice, given) = match stated {
        Stated::Part(given) => (SquareChoice::new(given.blur_px), *given),
        Stated::Whole(constants, _) => (
            SquareChoice::new(Some(constants.blur_px)),
            Default::default(),
        ),
    };
    while let Some(side) = choice.wanted() {
        let told = read(parts, side, SquareChoice::FRAMES).estimate(given);
        choice.take(told.map(|film| film.constants.blur_px));
    }
    for part in parts {
        part.square_px = choice.square_px();
    }
}

/// Profiles of all components, in squares with sides of so many pixels, in the first `most` frames in which they have poses.
pub(super) fn read(parts: &[Filmed<'_>], side: usize, most: usize) -> FilmPool {
    let parts = &parts[..parts.len().min(MOST_COMPONENTS)];
    let posed = |part: &Filmed<'_>| -> Vec<(usize, Pose)> {
        let best =
            |(frame, found): (usize, &FrameFound)| Some((frame, found.candidates.first()?.pose));
        let all = part.found.iter().enumerate();
        all.filter_map(best).take(most).collect()
    };
    let posed: Vec<_> = parts.iter().map(posed).collect();
    let each = profiles_of_each(posed.iter().map(Vec::len).sum());
    let mut pool = FilmPool::in_squares(side);
    for ((component, part), posed) in (0..).zip(parts).zip(&posed) {
        let read = |buffers: &mut RefineBuffers, &(frame, pose): &(usize, Pose)| {
            let names = (component, frame as u16);
            let read = part.profiles(side, &pose, names, each, buffers);
            (frame as u16, read.unwrap_or_default())
        };
        let read = posed.par_iter().map_init(RefineBuffers::default, read);
        for (frame, profiles) in read.collect::<Vec<_>>() {
            pool.take(component, frame, profiles);
        }
    }
    pool
}

impl Filmed<'_> {
    /// Calls `look` with the camera and the grey frame, in the squares that the film is read in, and what it makes of the component.
    ///
    /// # Errors
    /// For a frame that is not there, and those of `look`.
    pub(super) fn see<T>(
        &self,
        frame: usize,
        film: Option<FilmModel>,
        look: impl FnOnce(&Camera, ImageTarget<'_>) -> Result<T>,
    ) -> Result<T> {
        self.see_in(self.square_px, frame, film, look)
    }

    fn see_in<T>(
        &self,
        side: usize,
        frame: usize,
        film: Option<FilmModel>,
        look: impl FnOnce(&Camera, ImageTarget<'_>) -> Result<T>,
    ) -> Result<T> {
        self.sequence
            .look_in(side, frame, |camera, frame, unknown| {
                let image = ImageTarget {
                    frame,
                    unknown,
                    polarity: self.edges.shown.stated().unwrap_or_default(),
                    film,
                };
                look(camera, image)
            })
    }

    fn profiles(
        &self,
        side: usize,
        pose: &Pose,
        names: (u8, u16),
        count: usize,
        buffers: &mut RefineBuffers,
    ) -> Result<Vec<FilmProfile>> {
        self.see_in(side, usize::from(names.1), None, |camera, image| {
            let mut memory = buffers.borrow(&self.model, camera);
            let mut profiles = vec![FilmProfile::default(); count];
            let read = film_profiles(
                &self.model,
                camera,
                pose,
                &image,
                names,
                &mut memory,
                &mut profiles,
            )?;
            profiles.truncate(read);
            Ok(profiles)
        })
    }
}

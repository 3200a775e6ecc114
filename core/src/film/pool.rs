//! Profiles of all frames and components of a study, and the constants of its film from them.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use super::clipped::Clipped;
use super::estimate::standing::{is_other, leads_elsewhere};
use super::estimate::{FilmEstimate, MOST_COMPONENTS, clipped, estimate_with};
use super::given::GivenFilm;
use super::model::FilmModel;
use super::profile::FilmProfile;

/// Profiles of one frame and component; fewer of a long film.
const PROFILES: usize = 96;
const LEAST: usize = 12;
/// Profiles of all frames together, at most.
const ALL: usize = 6000;

/// How many profiles of each frame and component are worth reading where there are so many of them.
#[must_use]
pub fn profiles_of_each(poses: usize) -> usize {
    (ALL / poses.max(1)).clamp(LEAST, PROFILES)
}

/// The profiles of a study as they become known, each frame and component once.
#[derive(Clone, Debug)]
pub struct FilmPool {
    read: BTreeMap<(u8, u16), Vec<FilmProfile>>,
    square_px: usize,
}

/// Of profiles in the file's own pixels.
impl Default for FilmPool {
    fn default() -> Self {
        Self::in_squares(1)
    }
}

impl FilmPool {
    /// Of profiles that are read in squares with sides of so many pixels ([`FilmConstants::square_px`](super::FilmConstants::square_px)).
    #[must_use]
    pub fn in_squares(square_px: usize) -> Self {
        Self {
            read: BTreeMap::new(),
            square_px,
        }
    }

    /// Takes the profiles of a frame and component, whose names they bear, in place of those it had.
    pub fn take(&mut self, component: u8, frame: u16, profiles: Vec<FilmProfile>) {
        if profiles.is_empty() || usize::from(component) >= MOST_COMPONENTS {
            self.forget(component, frame);
        } else {
            self.read.insert((component, frame), profiles);
        }
    }

    /// Forgets those of a frame and component: there is no pose any more.
    pub fn forget(&mut self, component: u8, frame: u16) {
        self.read.remove(&(component, frame));
    }

    /// Whether anything is known of a component.
    #[must_use]
    pub fn knows(&self, component: u8) -> bool {
        self.read.keys().any(|&(known, _)| known == component)
    }

    /// Whether constants that are known, `models` of the components by their numbers, stand: these profiles lead to no others from there, more than
    /// three standard deviations away.
    #[must_use]
    pub fn stands_by(&self, models: &[FilmModel], given: GivenFilm) -> bool {
        let mut profiles: Vec<FilmProfile> = self.read.values().flatten().copied().collect();
        !leads_elsewhere(&mut profiles, models, given.in_squares(self.square_px))
    }

    /// The constants by these profiles, where those that are known do not [stand](Self::stands_by): the film that was followed with them is to be
    /// followed again. `None` where they stand, where all profiles lead to no others than they are by the deviations of both, and where these do not tell.
    #[must_use]
    pub fn learnt_again(&self, models: &[FilmModel], given: GivenFilm) -> Option<FilmEstimate> {
        match self.stands_by(models, given) {
            true => None,
            false => self.estimate(given).filter(|found| is_other(models, found)),
        }
    }

    /// The constants of the film that all of it was taken on; `None` where the profiles do not tell.
    #[must_use]
    pub fn estimate(&self, given: GivenFilm) -> Option<FilmEstimate> {
        let mut profiles: Vec<FilmProfile> = self.read.values().flatten().copied().collect();
        let components = self.read.keys().map(|&(component, _)| component).max();
        let given = given.in_squares(self.square_px);
        let mut found = estimate_with(&mut profiles, 1 + usize::from(components?), given)?;
        found.constants.square_px = self.square_px;
        Some(found)
    }

    /// Where grey values were cut off, so that the profiles do not tell; `None` where they were not.
    #[must_use]
    pub fn clipped(&self) -> Option<Clipped> {
        let profiles: Vec<FilmProfile> = self.read.values().flatten().copied().collect();
        clipped(&profiles)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_and_component_is_known_once_until_it_is_forgotten() {
        let mut pool = FilmPool::default();
        pool.take(1, 7, alloc::vec![FilmProfile::default(); 30]);
        pool.take(1, 7, alloc::vec![FilmProfile::default(); 20]);
        assert!(pool.knows(1) && !pool.knows(0));
        assert_eq!(pool.read.values().map(Vec::len).sum::<usize>(), 20);
        pool.forget(1, 7);
        assert!(!pool.knows(1));
        assert_eq!(pool.estimate(GivenFilm::default()), None);
        pool.take(1, 7, Vec::new());
        assert!(!pool.knows(1));
    }

    #[test]
    fn long_films_give_fewer_profiles_of_each_frame() {
        assert_eq!(profiles_of_each(0), PROFILES);
        assert_eq!(profiles_of_each(32), PROFILES);
        assert_eq!(profiles_of_each(122), 49);
        assert_eq!(profiles_of_each(4000), LEAST);
    }

    #[test]
    fn profiles_survive_the_way_through_numbers() {
        let mut profile = FilmProfile::default();
        (profile.mean[3], profile.variance[4]) = (1.5, 2.5);
        (profile.paths[80], profile.outline) = (3.5, -0.25);
        let again = FilmProfile::of_numbers((2, 9), &profile.numbers());
        let named = FilmProfile {
            component: 2,
            frame: 9,
            ..profile
        };
        assert_eq!(again, named);
    }
}

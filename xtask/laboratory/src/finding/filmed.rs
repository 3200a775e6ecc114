//! Components on the frames of a film, and what a person states of it.

use fluoropose::film::{FilmConstants, FilmModel, GivenFilm};
use fluoropose::mesh::Model;

use super::film::FrameFound;
use super::finder::EdgeOptions;
use crate::files::StatedFilm;
use crate::sequence::Sequence;

/// One component in the frames of a sequence, and what was found there.
pub struct Filmed<'f> {
    /// What it is called.
    pub name: &'f str,
    /// Its model.
    pub model: Model<'f>,
    /// The frames.
    pub sequence: Sequence<'f>,
    /// How edges are looked for.
    pub edges: EdgeOptions,
    /// Poses that the outlines led to, and then those on the frames.
    pub found: &'f mut Vec<FrameFound>,
    /// Side of the squares that the film is read in, pixels; 1 until the frames tell.
    pub square_px: usize,
}

/// What a person states of the film of components.
#[derive(Clone, Debug)]
pub enum Stated {
    /// In part: the rest is estimated.
    Part(GivenFilm),
    /// All of its constants, and what it makes of each component, where its attenuation is stated.
    Whole(FilmConstants, Vec<Option<FilmModel>>),
}

/// Films of pixels as they are seen in squares.
pub fn in_squares(models: &[Option<FilmModel>], side: usize) -> Vec<Option<FilmModel>> {
    let seen = |film: &FilmModel| FilmModel {
        constants: film.constants.in_squares(side),
        ..*film
    };
    models.iter().map(|film| film.as_ref().map(seen)).collect()
}

impl Default for Stated {
    /// Nothing is stated.
    fn default() -> Self {
        Self::Part(GivenFilm::default())
    }
}

impl Stated {
    /// Of components with these attenuations, per mm.
    pub fn of(film: Option<StatedFilm>, attenuations: &[Option<f64>]) -> Self {
        let Some(constants) = film.and_then(|film| film.constants()) else {
            return Self::Part(film.map_or(GivenFilm::default(), |film| film.given()));
        };
        let model =
            |attenuation: &Option<f64>| Some(FilmModel::certain(constants, (*attenuation)?));
        Self::Whole(constants, attenuations.iter().map(model).collect())
    }
}

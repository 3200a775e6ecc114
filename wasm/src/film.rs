//! The constants of a film, from profiles that other workers read.

use fluoropose::film::profile::PROFILE_NUMBERS;
use fluoropose::film::{
    DisplayKind, FilmConstants, FilmEstimate, FilmModel, FilmPool, FilmProfile, GivenFilm,
    MetalContrast, Sharpening, SquareChoice,
};
use fluoropose::finder::FilmMisfits;
use wasm_bindgen::prelude::*;

/// The profiles of a study, and what they tell of its film.
#[wasm_bindgen]
#[derive(Default)]
pub struct FilmStudy {
    pool: FilmPool,
    known: Vec<FilmModel>,
}

#[wasm_bindgen]
impl FilmStudy {
    /// Knows nothing yet.
    #[wasm_bindgen(constructor)]
    #[must_use]
    pub fn new() -> FilmStudy {
        Self::default()
    }

    /// The same for profiles that are read in squares with sides of so many pixels.
    #[wasm_bindgen(js_name = inSquares)]
    #[must_use]
    pub fn in_squares(side: usize) -> FilmStudy {
        Self {
            pool: FilmPool::in_squares(side),
            ..Self::default()
        }
    }

    /// The largest usual misfit of a component's poses on a film, pixels, by those of the same component in other frames and those
    /// of other components; nothing where they do not tell.
    #[wasm_bindgen(js_name = usualMisfit)]
    #[must_use]
    pub fn usual_misfit(own: &[f64], others: &[f64]) -> Option<f64> {
        FilmMisfits { own, others }.limit_px()
    }

    /// Takes the profiles of a component (0 femur, 1 tibia) and a frame, as `filmProfiles` gives them; they take the place of
    /// those it had. None at all are forgotten.
    pub fn take(&mut self, component: u8, frame: u16, numbers: &[f32]) {
        let of = |numbers| FilmProfile::of_numbers((component, frame), numbers);
        let profiles = numbers.as_chunks::<PROFILE_NUMBERS>().0.iter().map(of);
        self.pool.take(component, frame, profiles.collect());
    }

    /// The constants; nothing where the profiles do not tell. `display` (`linear`, `between` or `logarithmic`) and `blur_px` are
    /// what a person states.
    ///
    /// # Errors
    /// A sentence about what is stated.
    pub fn estimate(
        &self,
        display: Option<String>,
        blur_px: Option<f64>,
    ) -> Result<Option<FilmFacts>, JsError> {
        let found = self.pool.estimate(given(display, blur_px)?);
        Ok(found.map(|estimate| self.facts(estimate)))
    }

    /// That grey values were cut off, so that the profiles tell no constants, as a person would say it, without a full stop; nothing where they were
    /// not.
    #[must_use]
    pub fn clipped(&self) -> Option<String> {
        self.pool.clipped().map(|clipped| clipped.to_string())
    }

    /// Says with what a component was followed, as `FilmFacts.model` gives it; one component after the other.
    ///
    /// # Errors
    /// A sentence about the numbers.
    pub fn know(&mut self, film: &[f64]) -> Result<(), JsError> {
        self.known.extend(film_model(film)?);
        Ok(())
    }

    /// The constants by the profiles of frames that were followed, where those that are known of the components do not stand. Nothing where they do.
    ///
    /// # Errors
    /// A sentence about what is stated.
    #[wasm_bindgen(js_name = learntAgain)]
    pub fn learnt_again(
        &self,
        display: Option<String>,
        blur_px: Option<f64>,
    ) -> Result<Option<FilmFacts>, JsError> {
        let found = self
            .pool
            .learnt_again(&self.known, given(display, blur_px)?);
        Ok(found.map(|estimate| self.facts(estimate)))
    }
}

impl FilmStudy {
    fn facts(&self, estimate: FilmEstimate) -> FilmFacts {
        let knows = [0, 1].map(|component| self.pool.knows(component));
        FilmFacts { estimate, knows }
    }
}

/// Finds the squares of pixels that a film is read in; see the core's `SquareChoice`.
#[wasm_bindgen]
pub struct FilmSquares(SquareChoice);

#[wasm_bindgen]
impl FilmSquares {
    /// Of a film of which a person states the blur, pixels of the frames, or not.
    #[wasm_bindgen(constructor)]
    #[must_use]
    pub fn new(stated_blur_px: Option<f64>) -> FilmSquares {
        Self(SquareChoice::new(stated_blur_px))
    }

    /// Of each component so many frames are to be read, the first whose pose is known.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn frames(&self) -> usize {
        SquareChoice::FRAMES
    }

    /// The side of the squares to read profiles in next, pixels; nothing once it is known.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn wanted(&self) -> Option<usize> {
        self.0.wanted()
    }

    /// Takes what the profiles that were read in these squares tell, or that they tell nothing.
    pub fn take(&mut self, facts: Option<FilmFacts>) {
        let blur = |facts: FilmFacts| facts.estimate.constants.blur_px;
        self.0.take(facts.map(blur));
    }

    /// The side of the squares that are well so far, pixels.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn side(&self) -> usize {
        self.0.square_px()
    }
}

/// What a person states of a film.
fn given(display: Option<String>, blur_px: Option<f64>) -> Result<GivenFilm, JsError> {
    let display = display.as_deref().map(kind).transpose()?;
    if blur_px.is_some_and(|blur_px| blur_px.is_nan() || blur_px <= 0.0) {
        return Err(JsError::new("The blur of a film is a number above zero"));
    }
    Ok(GivenFilm { display, blur_px })
}

fn kind(word: &str) -> Result<DisplayKind, JsError> {
    DisplayKind::of_word(word).ok_or_else(|| {
        JsError::new(&format!(
            "A display is linear, between or logarithmic, not {word:?}"
        ))
    })
}

/// What somebody who states all of a film's constants says, as a person would say it, without a full stop. `curvature` is one
/// divided by grey values, `blur_px` the standard deviation of everything that blurs, pixels.
#[wasm_bindgen(js_name = statedFilmWords)]
#[must_use]
pub fn stated_film_words(curvature: f64, blur_px: f64) -> String {
    FilmConstants::plain(curvature, blur_px).to_string()
}

/// What a film makes of a component by constants that are stated, as [`FilmFacts::model`] has it: read in the squares that the blur tells.
///
/// # Errors
/// A sentence about the numbers.
#[wasm_bindgen(js_name = statedFilm)]
pub fn stated_film(curvature: f64, blur_px: f64, attenuation: f64) -> Result<Vec<f64>, JsError> {
    let model = film_model(&[curvature, blur_px, attenuation])?;
    let side = SquareChoice::new(Some(blur_px)).square_px();
    let in_squares = |model: FilmModel| FilmModel {
        constants: model.constants.in_squares(side),
        ..model
    };
    Ok(model.map_or(Vec::new(), |model| numbers_of(&in_squares(model))))
}

/// The constants of a film.
#[wasm_bindgen]
pub struct FilmFacts {
    estimate: FilmEstimate,
    knows: [bool; 2],
}

#[wasm_bindgen]
impl FilmFacts {
    /// As a person would say it, without a full stop.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn words(&self) -> String {
        self.estimate.to_string()
    }

    /// Standard deviation of everything that blurs, pixels of the frames.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn blur(&self) -> f64 {
        let constants = &self.estimate.constants;
        constants.blur_px * constants.square_px as f64
    }

    /// Curvature of the display times the contrast of metal: 0 linear, from 1 on logarithmic.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn curved(&self) -> f64 {
        self.estimate.constants.curvature * self.estimate.contrast
    }

    /// Profiles that were believed.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn profiles(&self) -> usize {
        self.estimate.profiles
    }

    /// Seventeen numbers: curvature, blur, a component's attenuation, and their covariance row by row; amount and radius of
    /// enhanced edges, and what the component's metal shows: grey values between both of its sides and the part that passes it; the side of the
    /// squares that the film is read in, pixels, which blur and radius are in.
    /// Nothing where no frame of that component was read.
    #[must_use]
    pub fn model(&self, component: usize) -> Option<Vec<f64>> {
        let known = self.knows.get(component).copied().unwrap_or(false);
        known.then(|| numbers_of(&self.estimate.model(component)))
    }
}

fn numbers_of(model: &FilmModel) -> Vec<f64> {
    let FilmConstants {
        curvature,
        blur_px,
        sharpening: Sharpening { amount, radius_px },
        square_px,
    } = model.constants;
    let MetalContrast { grey, passed } = model.contrast;
    let constants = [curvature, blur_px, model.attenuation];
    constants
        .iter()
        .chain(model.covariance.as_flattened())
        .chain(&[amount, radius_px, grey, passed, square_px as f64])
        .copied()
        .collect()
}

/// What a film makes of a component: seventeen numbers as [`FilmFacts::model`] has them, the first sixteen of a film that is read as it is, the
/// first twelve where no edges were enhanced either, or the first three, which are then taken as they are. Nothing where there are none.
pub(crate) fn film_model(numbers: &[f64]) -> Result<Option<FilmModel>, JsError> {
    let (constants, covariance) = match *numbers {
        [] => return Ok(None),
        [curvature, blur_px, attenuation, ref covariance @ ..] => {
            ([curvature, blur_px, attenuation], covariance)
        }
        _ => return Err(wrong_count(numbers)),
    };
    if !numbers.iter().all(|number| number.is_finite())
        || constants[1] <= 0.0
        || constants[2] <= 0.0
    {
        return Err(JsError::new(
            "Of a film the curvature, the blur (px) and the attenuation (1/mm) are stated; the last two are above zero",
        ));
    }
    let [curvature, blur_px, attenuation] = constants;
    let mut model = FilmModel::certain(FilmConstants::plain(curvature, blur_px), attenuation);
    match covariance.as_chunks::<3>() {
        ([], []) => {}
        ([a, b, c], []) => model.covariance = [*a, *b, *c],
        ([a, b, c, [amount, radius_px, grey]], [passed, square @ ..]) => {
            if let [side] = *square {
                model.constants.square_px = whole_side(side)?;
            }
            model.covariance = [*a, *b, *c];
            let [amount, radius_px, grey, passed] = [*amount, *radius_px, *grey, *passed];
            model.constants.sharpening = Sharpening { amount, radius_px };
            model.contrast = MetalContrast { grey, passed };
        }
        _ => return Err(wrong_count(numbers)),
    }
    Ok(Some(model))
}

/// Sides of squares are no longer than this, pixels.
const MOST_SIDE: f64 = 64.0;

fn whole_side(side: f64) -> Result<usize, JsError> {
    let is_one = side.fract() == 0.0 && (1.0..=MOST_SIDE).contains(&side);
    let told = || JsError::new("A film is read in squares of 1 to 64 pixels a side");
    is_one.then_some(side as usize).ok_or_else(told)
}

fn wrong_count(numbers: &[f64]) -> JsError {
    JsError::new(&format!(
        "A film has 3, 12, 16 or 17 numbers, but {} were given",
        numbers.len()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_of_a_film_survives_the_way_through_numbers() {
        let constants = FilmConstants::plain(0.02, 1.3);
        let mut model = FilmModel::certain(constants, 0.4);
        assert_eq!(film_model(&[0.02, 1.3, 0.4]).ok(), Some(Some(model)));
        model.covariance = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]];
        assert_eq!(
            film_model(&numbers_of(&model)[..12]).ok(),
            Some(Some(model))
        );
        model.constants.sharpening = Sharpening {
            amount: 0.8,
            radius_px: 3.0,
        };
        model.contrast = MetalContrast {
            grey: 60.0,
            passed: 0.2,
        };
        assert_eq!(
            film_model(&numbers_of(&model)[..16]).ok(),
            Some(Some(model))
        );
        model.constants.square_px = 2;
        assert_eq!(film_model(&numbers_of(&model)).ok(), Some(Some(model)));
        let stated = stated_film(0.02, 3.0, 0.4).ok().unwrap();
        assert_eq!(stated[..3], [0.02, 1.5, 0.4]);
        assert_eq!(stated[16], 2.0);
        assert_eq!(stated_film(0.02, 1.3, 0.4).ok().unwrap()[16], 1.0);
        assert_eq!(film_model(&[]).ok(), Some(None));
    }

    #[test]
    fn profiles_that_nobody_read_tell_nothing() {
        let mut study = FilmStudy::new();
        study.take(0, 3, &[0.0; 2 * PROFILE_NUMBERS]);
        let told = study.estimate(Some("between".to_owned()), Some(1.0));
        assert!(told.is_ok_and(|told| told.is_none()));
    }
}

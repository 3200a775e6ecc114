//! What was found in a frame as numbers, so that a file can keep it to the last bit.

use fluoropose::film::{FilmConstants, FilmModel, MetalContrast, Sharpening};
use fluoropose::follow::{Contrast, FramePose, Looked, Missing};
use fluoropose::pose::Pose;
use fluoropose::pose::covariance::PoseCovariance;
use fluoropose::refine::Fit;

/// Something that is kept as numbers.
pub(super) trait Record: Sized {
    fn numbers(&self) -> Vec<f64>;
    fn from_numbers(numbers: &[f64]) -> Option<Self>;
}

/// Numbers read one after the other.
struct Reader<'n>(&'n [f64]);

impl Reader<'_> {
    fn one(&mut self) -> Option<f64> {
        let (&one, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(one)
    }

    fn some<const N: usize>(&mut self) -> Option<[f64; N]> {
        let (some, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*some)
    }
}

/// What is written of every fit.
fn fit_of(reader: &mut Reader<'_>) -> Option<Fit> {
    let [
        known,
        beyond,
        met,
        residual_px,
        misfit_px,
        apart,
        size_px,
        behind_mm,
        depth_mm,
    ] = reader.some()?;
    Some(Fit {
        known,
        beyond,
        met,
        residual_px,
        misfit_px,
        apart_px: (!apart.is_nan()).then_some(apart),
        size_px,
        behind_mm,
        depth_mm,
        implausible_width_mm: 0.0,
        square_px: 1,
    })
}

impl Record for FramePose {
    fn numbers(&self) -> Vec<f64> {
        let mut numbers = Vec::with_capacity(72);
        numbers.extend(self.pose.rotation.iter().flatten());
        numbers.extend(self.pose.translation);
        numbers.push(f64::from(u8::from(self.covariance.is_some())));
        if let Some(covariance) = &self.covariance {
            numbers.extend(covariance.matrix.iter().flatten());
        }
        let fit = &self.fit;
        let apart = fit.apart_px.unwrap_or(f64::NAN);
        numbers.extend([fit.known, fit.beyond, fit.met]);
        numbers.extend([fit.residual_px, fit.misfit_px, apart]);
        let contrast = &self.contrast;
        numbers.extend([fit.size_px, fit.behind_mm, fit.depth_mm]);
        numbers.extend([self.misfit_px, contrast.step]);
        numbers.extend([contrast.strength, contrast.known]);
        numbers.extend(self.film_steps.iter().flatten());
        if fit.implausible_width_mm > 0.0 {
            numbers.push(fit.implausible_width_mm);
        }
        numbers
    }

    fn from_numbers(numbers: &[f64]) -> Option<Self> {
        let mut reader = Reader(numbers);
        let rotation: [f64; 9] = reader.some()?;
        let pose = Pose {
            rotation: std::array::from_fn(|row| std::array::from_fn(|k| rotation[3 * row + k])),
            translation: reader.some()?,
        };
        let covariance = match reader.one()? > 0.0 {
            true => {
                let all: [f64; 36] = reader.some()?;
                let row = |row: usize| std::array::from_fn(|k| all[6 * row + k]);
                Some(PoseCovariance {
                    matrix: std::array::from_fn(row),
                })
            }
            false => None,
        };
        let mut fit = fit_of(&mut reader)?;
        let misfit_px = reader.one()?;
        let [step, strength, known] = reader.some()?;
        let film_steps: [[f64; 6]; 2] = [reader.some()?, reader.some()?];
        // Written of such models alone.
        if !reader.0.is_empty() {
            fit.implausible_width_mm = reader.one()?;
        }
        reader.0.is_empty().then_some(Self {
            pose,
            covariance,
            film_steps,
            fit,
            misfit_px,
            contrast: Contrast {
                step,
                strength,
                known,
            },
        })
    }
}

impl<R: Record> Record for Option<R> {
    fn numbers(&self) -> Vec<f64> {
        self.as_ref().map_or(Vec::new(), R::numbers)
    }

    fn from_numbers(numbers: &[f64]) -> Option<Self> {
        match numbers.is_empty() {
            true => Some(None),
            false => R::from_numbers(numbers).map(Some),
        }
    }
}

impl Record for Looked {
    fn numbers(&self) -> Vec<f64> {
        let flag = |flag: bool| f64::from(u8::from(flag));
        let (which, rest) = match &self.found {
            Ok(found) => (0.0, found.numbers()),
            Err(Missing::Outside) => (1.0, Vec::new()),
            Err(Missing::Hidden) => (2.0, Vec::new()),
            Err(Missing::Blank) => (3.0, Vec::new()),
        };
        let mut numbers = vec![flag(self.ordinary), flag(self.searched), self.known, which];
        numbers.extend(rest);
        numbers
    }

    fn from_numbers(numbers: &[f64]) -> Option<Self> {
        let mut reader = Reader(numbers);
        let [ordinary, searched, known, which] = reader.some()?;
        let found = match which as u8 {
            0 => Ok(FramePose::from_numbers(reader.0)?),
            1 => Err(Missing::Outside),
            3 => Err(Missing::Blank),
            _ => Err(Missing::Hidden),
        };
        Some(Self {
            found,
            ordinary: ordinary > 0.0,
            searched: searched > 0.0,
            known,
        })
    }
}

/// Which poses something was learnt from.
#[derive(PartialEq, Eq)]
pub(super) struct LearntFrom(pub(super) u32);

impl Record for LearntFrom {
    fn numbers(&self) -> Vec<f64> {
        vec![f64::from(self.0)]
    }

    fn from_numbers(numbers: &[f64]) -> Option<Self> {
        match *numbers {
            [mark] => Some(Self(mark as u32)),
            _ => None,
        }
    }
}

/// The blur that profiles tell, where they tell one.
pub(super) struct Blur(pub(super) Option<f64>);

impl Record for Blur {
    fn numbers(&self) -> Vec<f64> {
        self.0.into_iter().collect()
    }

    fn from_numbers(numbers: &[f64]) -> Option<Self> {
        match *numbers {
            [] => Some(Self(None)),
            [blur] => Some(Self(Some(blur))),
            _ => None,
        }
    }
}

/// What a film makes of each component of a study.
pub(super) struct Films(pub(super) Vec<FilmModel>);

/// Numbers of a component.
const OF_A_FILM: usize = 17;

impl Record for Films {
    fn numbers(&self) -> Vec<f64> {
        let of = |film: &FilmModel| {
            let FilmConstants {
                curvature,
                blur_px,
                sharpening: Sharpening { amount, radius_px },
                square_px,
            } = film.constants;
            let MetalContrast { grey, passed } = film.contrast;
            let mut numbers = vec![curvature, blur_px, film.attenuation];
            numbers.extend(film.covariance.iter().flatten());
            numbers.extend([amount, radius_px, grey, passed, square_px as f64]);
            numbers
        };
        self.0.iter().flat_map(of).collect()
    }

    fn from_numbers(numbers: &[f64]) -> Option<Self> {
        let of = |numbers: &[f64]| {
            let mut reader = Reader(numbers);
            let [curvature, blur_px, attenuation] = reader.some()?;
            let covariance: [f64; 9] = reader.some()?;
            let [amount, radius_px, grey, passed, square_px] = reader.some()?;
            Some(FilmModel {
                constants: FilmConstants {
                    curvature,
                    blur_px,
                    sharpening: Sharpening { amount, radius_px },
                    square_px: square_px as usize,
                },
                attenuation,
                contrast: MetalContrast { grey, passed },
                covariance: std::array::from_fn(|row| {
                    std::array::from_fn(|k| covariance[3 * row + k])
                }),
            })
        };
        let films: Option<Vec<FilmModel>> = numbers.chunks(OF_A_FILM).map(of).collect();
        films.map(Self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_comes_back_to_the_last_bit() {
        let mut found = FramePose {
            pose: Pose {
                translation: [0.1, -0.2, -1000.0 / 3.0],
                ..Pose::IDENTITY
            },
            covariance: Some(PoseCovariance {
                matrix: std::array::from_fn(|row| std::array::from_fn(|k| (row * 6 + k) as f64)),
            }),
            film_steps: [[0.1; 6], [-1.0 / 3.0; 6]],
            fit: Fit {
                met: 1.0 / 3.0,
                depth_mm: 1000.0 / 3.0,
                square_px: 1,
                ..Fit::default()
            },
            misfit_px: 0.3,
            contrast: Contrast::default(),
        };
        for covariance in [found.covariance, None] {
            found.covariance = covariance;
            for found in [
                Ok(found),
                Err(Missing::Hidden),
                Err(Missing::Outside),
                Err(Missing::Blank),
            ] {
                let looked = Looked {
                    found,
                    ordinary: true,
                    searched: false,
                    known: 0.7,
                };
                assert_eq!(Looked::from_numbers(&looked.numbers()), Some(looked));
            }
            let some = Some(found);
            assert_eq!(
                Option::<FramePose>::from_numbers(&some.numbers()),
                Some(some)
            );
        }
        assert_eq!(FramePose::from_numbers(&[1.0; 5]), None);
    }
}

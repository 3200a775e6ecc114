//! How much darker a frame is inside of a model's outline than outside: whether there is metal at all.
//!
//! Residuals do not tell: noise and texture have an edge near every line. But noise is not darker on the same side all
//! along an outline.

use super::subject::Subject;
use super::thinned::Thinned;
use crate::image::profile::grey_across;
use crate::pose::Pose;
use crate::refine::{
    ImageTarget, OutlineSample, Polarity, RefineError, RefineMemory, outline_samples,
};

/// Places of the readings on each side of the outline, pixels from it.
const READINGS: [f64; 3] = [2.0, 3.0, 4.0];
/// Samples that are kept of an outline; of a longer one every second, every fourth and so on.
const SAMPLES: usize = 512;
/// A full step is exceeded along this part of the outline: where another leg passes, all steps are smaller.
const FULL: f64 = 0.25;

/// The step of grey values along an outline.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contrast {
    /// Step that is exceeded along a quarter of the outline, grey values, positive where metal is inside.
    pub step: f64,
    /// Mean of the steps, each divided by that one and cut to 0..1: 0 where nothing lies on an edge of metal, 1 where
    /// everything lies on a full one.
    pub strength: f64,
    /// Part of the outline of which the frame says anything.
    pub known: f64,
}

/// Measures the step along the outline of the model at a pose.
///
/// # Errors
/// [`RefineError`] where the model cannot be drawn at the pose.
pub fn contrast(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    pose: &Pose,
    memory: &mut RefineMemory<'_>,
) -> Result<Contrast, RefineError> {
    let mut thinned = Thinned::<f64, SAMPLES>::new();
    let (mut known, mut all) = (0usize, 0usize);
    let (model, camera) = (subject.model, subject.camera);
    outline_samples(model, camera, pose, memory, |sample| {
        if !thinned.counts_next() {
            return;
        }
        all += 1;
        if let Some(step) = step_at(image, sample) {
            known += 1;
            thinned.keep(step);
        }
    })?;
    let mut steps = thinned.into_kept();
    steps.sort_unstable_by(f64::total_cmp);
    let at = ((1.0 - FULL) * steps.len() as f64) as usize;
    let step = steps.get(at).copied().unwrap_or(0.0);
    let full = step.max(f64::MIN_POSITIVE);
    let sum: f64 = steps.iter().map(|step| (step / full).clamp(0.0, 1.0)).sum();
    Ok(Contrast {
        step,
        strength: sum / steps.len().max(1) as f64,
        known: known as f64 / all.max(1) as f64,
    })
}

/// How much brighter it is outside than inside, or darker of a bright implant; `None` where that is not known.
fn step_at(image: &ImageTarget<'_>, sample: &OutlineSample) -> Option<f64> {
    let place = [sample.column, sample.row];
    let unknown = image.unknown.is_some_and(|unknown| {
        let [column, row] = place.map(|at| at.max(0.0) as usize);
        unknown.get(column, row)
    });
    if unknown {
        return None;
    }
    let mut sum = 0.0;
    for t in READINGS {
        let grey = |t: f64| grey_across(image.frame, place, sample.normal, &[1.0], t);
        sum += grey(t)? - grey(-t)?;
    }
    let step = sum / READINGS.len() as f64;
    Some(match image.polarity {
        Polarity::DarkImplant => step,
        Polarity::BrightImplant => -step,
    })
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::finder::fake::{BESIDE, METAL, SIDE, camera, crank, drawn, grey, placed};
    use crate::image::frame::Frame;
    use crate::image::mask::Mask;
    use crate::refine::RefineBuffers;

    /// What a frame of the crank at one pose says of another; unknown where the mask of a third covers it.
    fn contrast_at(
        [seen, asked]: [&Pose; 2],
        hidden: Option<&Pose>,
        polarity: Polarity,
    ) -> (Contrast, f64) {
        let (model, camera) = (crank(), camera());
        let pixels = grey(&model, &camera, seen);
        let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("valid");
        let words = hidden.map(|pose| drawn(&model, &camera, pose));
        let unknown = words
            .as_ref()
            .map(|words| Mask::new(words, SIDE, SIDE).expect("valid"));
        let image = ImageTarget {
            frame: &frame,
            unknown: unknown.as_ref(),
            polarity,
            film: None,
        };
        let (mut buffers, model) = (RefineBuffers::default(), model.as_model());
        let mut memory = buffers.borrow(&model, &camera);
        let subject = Subject::new(&model, &[], &camera);
        let found = contrast(&subject, &image, asked, &mut memory).expect("in front");
        let (mut known, mut all) = (0, 0);
        outline_samples(&model, &camera, asked, &mut memory, |sample| {
            let [column, row] = [sample.column, sample.row].map(|at| at as usize);
            all += 1;
            known += u32::from(unknown.is_none_or(|unknown| !unknown.get(column, row)));
        })
        .expect("in front");
        (found, f64::from(known) / f64::from(all))
    }

    #[test]
    fn all_along_its_outline_a_part_has_a_full_step_and_elsewhere_hardly_any() {
        let at = placed([20.0, 30.0, 5.0], [0.0; 3]);
        let full = f64::from(BESIDE - METAL);
        let (here, _) = contrast_at([&at; 2], None, Polarity::DarkImplant);
        assert!(
            (here.step - full).abs() < 1e-9 && here.strength > 0.9,
            "{here:?}"
        );
        assert_eq!(here.known, 1.0);
        let (bright, _) = contrast_at([&at; 2], None, Polarity::BrightImplant);
        assert!(bright.step < 0.0 && bright.strength < 0.1, "{bright:?}");
        // Turned by a quarter, most of it lies beside any edge.
        let turned = placed([20.0, 30.0, 95.0], [0.0; 3]);
        let (elsewhere, _) = contrast_at([&at, &turned], None, Polarity::DarkImplant);
        assert!(
            elsewhere.strength < 0.5 * here.strength || elsewhere.step < 0.5 * full,
            "{elsewhere:?}"
        );
    }

    /// The outline is short enough that each of its samples counts.
    #[test]
    fn what_is_known_of_an_outline_is_the_part_that_nothing_hides() {
        let at = placed([20.0, 30.0, 5.0], [0.0; 3]);
        for shift in [[30.0, 10.0, 0.0], [-45.0, 5.0, 40.0]] {
            let other = placed([0.0, 0.0, 40.0], shift);
            let (found, known) = contrast_at([&at; 2], Some(&other), Polarity::DarkImplant);
            assert!(known > 0.2 && known < 0.9, "{known}");
            assert_eq!(found.known, known);
        }
    }
}

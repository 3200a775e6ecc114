//! Which of several refined poses is chosen, and why, in words.

use fluoropose::finder::choice::{
    Choice, ChoiceContext, Counterpart, OpenRival, Reason, RivalPose, choose,
};
use fluoropose::finder::{Away, Doubt, Found, Limits, Verdict, contenders, judge};
use fluoropose::pose::Pose;
use wasm_bindgen::prelude::*;

use crate::uncertainty::{UPPER, Uncertainty, covariance_of, tells_apart};
use fluoropose_page::pose_numbers::{axes_from, from_numbers};

/// What is known round a frame's component: the other component in the frame, and the same one in neighbouring frames.
/// Only poses that can be relied on belong here.
#[wasm_bindgen]
#[derive(Default)]
pub struct Surroundings {
    /// In the field's axes.
    counterpart: Option<Counterpart>,
    neighbours: Vec<Pose>,
    /// Poses that had been found where a person set another.
    rivals: Vec<Pose>,
    /// Those of the component that is chosen for; without them they are its file's own.
    model_from_field: Option<Pose>,
}

#[wasm_bindgen]
impl Surroundings {
    /// Nothing is known.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Surroundings {
        Self::default()
    }

    /// The anatomical axes of the component's model (nine numbers, as `axes_from` takes them), in which its tilt is taken.
    ///
    /// # Errors
    /// A sentence where they are no right-handed frame.
    #[wasm_bindgen(js_name = setAxes)]
    pub fn set_axes(&mut self, axes: &[f64]) -> Result<(), JsError> {
        self.model_from_field = Some(axes_from(axes)?);
        Ok(())
    }

    /// The femoral component is known and a tibial pose is to be chosen; without `axes` its file has the field's.
    ///
    /// # Errors
    /// A sentence where `pose` is not six finite numbers, or the axes are no right-handed frame.
    #[wasm_bindgen(js_name = setFemur)]
    pub fn set_femur(&mut self, pose: &[f64], axes: Option<Vec<f64>>) -> Result<(), JsError> {
        self.counterpart = Some(Counterpart::Femur(in_field_axes(pose, axes)?));
        Ok(())
    }

    /// The tibial component is known and a femoral pose is to be chosen.
    ///
    /// # Errors
    /// As of `set_femur`.
    #[wasm_bindgen(js_name = setTibia)]
    pub fn set_tibia(&mut self, pose: &[f64], axes: Option<Vec<f64>>) -> Result<(), JsError> {
        self.counterpart = Some(Counterpart::Tibia(in_field_axes(pose, axes)?));
        Ok(())
    }

    /// The pose of the same component in the frame before or after.
    ///
    /// # Errors
    /// As of `set_femur`.
    #[wasm_bindgen(js_name = addNeighbour)]
    pub fn add_neighbour(&mut self, pose: &[f64]) -> Result<(), JsError> {
        self.neighbours.push(from_numbers(pose)?.into());
        Ok(())
    }

    /// A pose that had been found where a person set another.
    ///
    /// # Errors
    /// As of `set_femur`.
    #[wasm_bindgen(js_name = addRival)]
    pub fn add_rival(&mut self, pose: &[f64]) -> Result<(), JsError> {
        self.rivals.push(from_numbers(pose)?.into());
        Ok(())
    }
}

fn in_field_axes(pose: &[f64], axes: Option<Vec<f64>>) -> Result<Pose, JsError> {
    let pose = Pose::from(from_numbers(pose)?);
    Ok(match axes {
        Some(axes) => pose.compose(&axes_from(&axes)?),
        None => pose,
    })
}

impl Surroundings {
    /// Chooses among poses of the model.
    fn choose(&self, candidates: &[RivalPose]) -> Option<Choice> {
        let field = |pose: &Pose| match &self.model_from_field {
            Some(axes) => pose.compose(axes),
            None => *pose,
        };
        let candidates: Vec<RivalPose> = candidates
            .iter()
            .map(|candidate| RivalPose {
                pose: field(&candidate.pose),
                ..*candidate
            })
            .collect();
        let neighbours: Vec<Pose> = self.neighbours.iter().map(field).collect();
        let context = ChoiceContext {
            counterpart: self.counterpart,
            is_counterpart_doubtful: false,
            neighbours: &neighbours,
        };
        choose(&candidates, &context)
    }

    /// Poses that had been found where a person set another.
    pub(crate) fn rivals(&self) -> &[Pose] {
        &self.rivals
    }

    /// What speaks against the first of some poses, in a sentence without its full stop: another that is likelier or as likely, or the joint. Nothing where all others
    /// are ruled out.
    pub(crate) fn against(&self, all: &[RivalPose]) -> Option<String> {
        let own = all.first()?;
        let choice = self.choose(all)?;
        if choice.index == 0 {
            return doubt_among(all, &choice).map(|doubt| doubt.to_string());
        }
        let other = all.get(choice.index)?;
        if choice.open.is_some_and(|open| open.index == 0) {
            return Some(Doubt::open(&own.pose, &other.pose, other.residual_px).to_string());
        }
        let away = Away::between(&own.pose, &other.pose);
        let reason = self.explain_reason(&choice.reason);
        let reason = reason.trim_end_matches('.');
        Some(format!(
            "the pose that had been found, {away} away, is likelier ({reason})"
        ))
    }

    /// Why a pose was chosen, in a sentence or two.
    fn explain(&self, choice: &Choice) -> String {
        let reason = self.explain_reason(&choice.reason);
        match choice.open {
            Some(open) if choice.reason.is_decided() => {
                format!(
                    "{reason} Another pose is possible too: residual {:.2} px.",
                    open.other_px
                )
            }
            _ => reason,
        }
    }

    fn explain_reason(&self, reason: &Reason) -> String {
        let other = match self.counterpart {
            Some(Counterpart::Tibia(_)) => "tibia",
            _ => "femur",
        };
        match *reason {
            Reason::Only => "The only pose found.".to_owned(),
            Reason::Residual {
                chosen_px,
                other_px,
            } if other_px.is_finite() => {
                format!(
                    "It fits best: residual {chosen_px:.2} px, of the other pose {other_px:.2} px."
                )
            }
            Reason::Residual { chosen_px, .. } => {
                format!("It fits best: residual {chosen_px:.2} px; the others do not fit at all.")
            }
            Reason::Knee {
                chosen_deg,
                other_deg,
            } => format!(
                "It goes with the {other}: their mediolateral axes are {chosen_deg:.0}° apart, with the other pose {other_deg:.0}°, which no knee does."
            ),
            Reason::Tilt {
                chosen_deg,
                other_deg,
            } => format!(
                "It goes with the {other}: its coronal tilt against it is {}°, with the other pose {}°.",
                tenths(chosen_deg),
                tenths(other_deg)
            ),
            Reason::Turn {
                chosen_deg,
                other_deg,
            } => format!(
                "It goes with the neighbouring frames: turned {}° from them, the other pose {}°.",
                tenths(chosen_deg),
                tenths(other_deg)
            ),
            Reason::Film { saved_deg } => format!(
                "It goes with the neighbouring frames: with another pose the film jumps by {}° more.",
                tenths(saved_deg)
            ),
            Reason::Undecided {
                chosen_px,
                other_px,
            } => format!(
                "Not decided: the residuals are {chosen_px:.2} and {other_px:.2} px, and nothing else tells the poses apart."
            ),
        }
    }
}

/// A magnitude to a tenth: on which side a tilt is says nothing here.
fn tenths(degrees: f64) -> String {
    format!("{:.1}", degrees.abs())
}

/// Which pose was chosen.
#[wasm_bindgen]
pub struct Chosen {
    choice: Choice,
    sentence: String,
    doubt: Option<Doubt>,
    verdict: Option<Verdict>,
}

#[wasm_bindgen]
impl Chosen {
    /// Its number among those given.
    #[wasm_bindgen(getter)]
    pub fn index(&self) -> usize {
        self.choice.index
    }

    /// Whether anything spoke for it besides a slightly smaller residual: then others may rest on it.
    #[wasm_bindgen(getter)]
    pub fn decided(&self) -> bool {
        self.choice.reason.is_decided()
    }

    /// Why, in a sentence or two.
    #[wasm_bindgen(getter)]
    pub fn sentence(&self) -> String {
        self.sentence.clone()
    }

    /// What is doubtful about it, in a sentence without its full stop: another pose fits as well. Nothing where the others
    /// were ruled out.
    #[wasm_bindgen(getter)]
    pub fn doubt(&self) -> Option<String> {
        self.doubt.as_ref().map(ToString::to_string)
    }
}

impl Chosen {
    /// `is_another` says of the chosen one and another whether they are two, by the plus-minus of the first.
    pub(crate) fn among(
        candidates: &[RivalPose],
        around: &Surroundings,
        is_another: impl Fn(usize, usize) -> bool,
    ) -> Option<Self> {
        let choice = around.choose(candidates)?;
        let other = |open: &OpenRival| is_another(choice.index, open.index);
        let told = Choice {
            open: choice.open.filter(other),
            ..choice
        };
        Some(Self {
            choice,
            sentence: around.explain(&choice),
            doubt: doubt_among(candidates, &told),
            verdict: None,
        })
    }

    /// The choice among what was found for a frame, with its verdict.
    pub(crate) fn of(found: &Found, around: &Surroundings) -> Option<Self> {
        let choice = around.choose(&contenders(&found.candidates))?;
        let verdict = judge(&found.candidates, &choice, &Limits::USUAL)?;
        Some(Self {
            choice,
            sentence: around.explain(&choice),
            doubt: None,
            verdict: Some(verdict),
        })
    }

    /// The same choice where the pose that is open is no other one, by the plus-minus of the chosen.
    pub(crate) fn without_open(self) -> Self {
        Self {
            doubt: Doubt::no_knee(&self.choice),
            ..self
        }
    }

    /// The same choice with a verdict: that on the chosen pose alone, and what other poses do.
    pub(crate) fn judged(self, alone: Verdict) -> Self {
        Self {
            verdict: Some(alone.or_doubt(self.doubt)),
            ..self
        }
    }

    /// How far the choice is to be trusted, where that is known: the word for it, and why.
    pub(crate) fn verdict(&self) -> Option<(&'static str, String)> {
        let verdict = self.verdict?;
        Some((verdict.word(), verdict.to_string()))
    }

    /// The best of the poses that nothing ruled out.
    pub(crate) fn open(&self) -> Option<usize> {
        self.choice.open.map(|open| open.index)
    }
}

/// What [`fluoropose::finder::judge`] says of a choice beside the fit.
fn doubt_among(candidates: &[RivalPose], choice: &Choice) -> Option<Doubt> {
    Doubt::no_knee(choice).or_else(|| open_among(candidates, choice))
}

fn open_among(candidates: &[RivalPose], choice: &Choice) -> Option<Doubt> {
    let open = choice.open?;
    let (chosen, other) = (candidates.get(choice.index)?, candidates.get(open.index)?);
    Some(Doubt::open(&chosen.pose, &other.pose, other.residual_px))
}

/// Chooses among refined poses (six numbers each, one after another) with their misfits in pixels, when more has become
/// known round them; nothing where there is none. `uncertainties` are those of the poses as they were handed out, NaN where there is none, and
/// `middle` that of the model's box, mm, or nothing where the model is not there.
///
/// # Errors
/// A sentence where a pose is not six finite numbers.
#[wasm_bindgen(js_name = choosePose)]
pub fn choose_pose(
    poses: &[f64],
    misfits: &[f64],
    uncertainties: &[f64],
    middle: &[f64],
    around: &Surroundings,
) -> Result<Option<Chosen>, JsError> {
    let candidates = poses
        .chunks(6)
        .zip(misfits)
        .map(|(pose, &residual_px)| {
            Ok(RivalPose {
                pose: from_numbers(pose)?.into(),
                residual_px,
            })
        })
        .collect::<Result<Vec<_>, JsError>>()?;
    let middle = <[f64; 3]>::try_from(middle).ok();
    let is_another = |chosen: usize, other: usize| {
        let known = uncertainties.get(size_of::<Uncertainty>() / 8 * chosen + 6..);
        let upper = known.and_then(<[f64]>::first_chunk);
        let is_known = |upper: &&[f64; UPPER]| upper.iter().all(|x| x.is_finite());
        let covariance = upper.filter(is_known).map(covariance_of);
        match (
            middle,
            covariance,
            candidates.get(chosen),
            candidates.get(other),
        ) {
            (Some(middle), Some(covariance), Some(own), Some(other)) => {
                tells_apart(&covariance, [&own.pose, &other.pose], &middle)
            }
            _ => true,
        }
    };
    Ok(Chosen::among(&candidates, around, is_another))
}

#[cfg(test)]
mod tests;

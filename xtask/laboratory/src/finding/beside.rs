//! The joint's other component, where a frame's edges are looked at.

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::image::mask::{Mask, MaskMut};
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_tracing::beside;

use crate::files::MaskBuffer;

/// A component, and where it is in each frame, as far as that is known.
#[derive(Clone, Debug)]
pub struct Beside<'m> {
    /// Its model.
    pub model: Model<'m>,
    /// The frames.
    pub poses: Vec<Option<Pose>>,
}

/// What a component covers at a pose, and what its edges reach beyond that.
///
/// # Errors
/// For a pose that cannot be drawn.
pub fn covered(model: &Model<'_>, camera: &Camera, pose: &Pose) -> Result<MaskBuffer> {
    let mut hidden = MaskBuffer::new(camera.width(), camera.height())?;
    hidden.draw(|hidden| cover(model, camera, pose, hidden))?;
    Ok(hidden)
}

/// What of a frame is not to be looked at: the components beside the one that is, where they are known, and what is `unknown` besides.
/// `None` where that is nothing.
///
/// # Errors
/// For a pose that cannot be drawn.
pub fn hidden(
    beside: &[Beside<'_>],
    camera: &Camera,
    frame: usize,
    unknown: Option<&Mask<'_>>,
) -> Result<Option<MaskBuffer>> {
    let pose = |one: &Beside<'_>| one.poses.get(frame).copied().flatten();
    let known: Vec<(Model<'_>, Pose)> = beside
        .iter()
        .filter_map(|one| Some((one.model, pose(one)?)))
        .collect();
    if known.is_empty() {
        return Ok(unknown.map(MaskBuffer::copy_of));
    }
    let mut hidden = match unknown {
        Some(unknown) => MaskBuffer::copy_of(unknown),
        None => MaskBuffer::new(camera.width(), camera.height())?,
    };
    for (model, pose) in known {
        hidden.draw_onto(|hidden| cover(&model, camera, &pose, hidden))?;
    }
    Ok(Some(hidden))
}

fn cover(model: &Model<'_>, camera: &Camera, pose: &Pose, hidden: &mut MaskMut<'_>) -> Result<()> {
    let mut scratch = vec![Projected::default(); scratch_needed(model)];
    let mut drawn = MaskBuffer::new(camera.width(), camera.height())?;
    drawn.draw(|mask| render(model, camera, pose, &mut scratch, mask))?;
    beside::hide(&drawn.mask(), hidden);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose_phantom::implant::{Parameters, femur};

    use crate::files::owned;

    #[test]
    fn what_is_unknown_besides_and_every_other_component_stay_hidden() {
        let owned = owned(femur(&Parameters::default()).expect("drawn")).expect("a model");
        let camera =
            Camera::from_principal_distance(256, 256, 1200.0, 1.2, [0.0; 2]).expect("valid");
        let at = |x_mm: f64| Pose {
            translation: [x_mm, 0.0, -1000.0],
            ..Pose::IDENTITY
        };
        let beside = [-60.0, 60.0].map(|x_mm| Beside {
            model: owned.as_model(),
            poses: vec![Some(at(x_mm)), None],
        });
        let mut unknown = MaskBuffer::new(256, 256).expect("valid");
        unknown.draw(|mask| mask.set(5, 250, true));
        let unknown = unknown.mask();
        let all = hidden(&beside, &camera, 0, Some(&unknown)).expect("drawn");
        let all = all.expect("something is hidden");
        let one = |x_mm: f64| covered(&owned.as_model(), &camera, &at(x_mm)).expect("drawn");
        let both = one(-60.0)
            .combined(&one(60.0), |a, b| a | b)
            .expect("alike");
        assert!(both.mask().area() > 2000);
        let wanted = both.combined(&MaskBuffer::copy_of(&unknown), |a, b| a | b);
        assert_eq!(all.mask().words(), wanted.expect("alike").mask().words());
        // Where no other one is known, only what was unknown is.
        let rest = hidden(&beside, &camera, 1, Some(&unknown)).expect("drawn");
        assert_eq!(rest.map(|rest| rest.mask().area()), Some(1));
        assert!(hidden(&beside, &camera, 1, None).expect("drawn").is_none());
    }
}

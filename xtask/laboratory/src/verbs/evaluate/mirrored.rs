//! Components of a study that lie beside each other as in no knee: their masks may be mirrored.

use anyhow::Result;
use fluoropose::finder::{FlippedFit, FlippedKnee};
use fluoropose::joint::beside::{Beside, Middles};
use fluoropose::mesh::Model;
use fluoropose::mesh::anatomy::KneeComponent;
use fluoropose::refine::{CameraView, RefineBuffers, RefineOptions};
use fluoropose_report::counted;

use super::found::{Found, Part};
use crate::choice::{are_good, doubt_mirrored, fit_flipped};
use crate::files::Role;

/// Doubts poses of both components where these lie beside each other as in no knee, source by source, and says so.
pub(super) fn doubt_parts(parts: &mut [Part<'_>]) -> Result<()> {
    let at = |role| {
        let is = |part: &Part<'_>| part.component.role() == Some(role);
        parts.iter().position(is)
    };
    let (Some(femur), Some(tibia)) = (at(Role::Femur), at(Role::Tibia)) else {
        return Ok(());
    };
    let Ok([femur, tibia]) = parts.get_disjoint_mut([femur, tibia]) else {
        return Ok(());
    };
    let (Some(femoral), Some(tibial)) = (femur.axes()?, tibia.axes()?) else {
        return Ok(());
    };
    let meshes = [&femur.model, &tibia.model].map(|model| *model.as_model().mesh());
    let Some(middles) = Middles::new((meshes[0], &femoral), (meshes[1], &tibial)) else {
        return Ok(());
    };
    for number in 0..femur.found.len() {
        let source = femur.found[number].source.clone();
        let Some(other) = tibia.found.iter().position(|found| found.source == source) else {
            continue;
        };
        let found = [&femur.found[number], &tibia.found[other]];
        let poses = found.map(Found::poses);
        let lying = found.map(Found::lying);
        let mut told = middles.judge_poses(&lying[0], &lying[1]);
        let apart = middles.apart_of(&poses[0], &poses[1]);
        let models = [femur.model.as_model(), tibia.model.as_model()];
        if let Some(knee) = FlippedKnee::new((&models[0], &femoral), (&models[1], &tibial)) {
            let fits = look_flipped(&knee, &models, found, &apart)?;
            knee.judge(&mut told, &apart, &fits);
        }
        say(&source, &told);
        let good = [&femur.found[number], &tibia.found[other]].map(|of| are_good(&of.decisions));
        doubt_mirrored(&mut femur.found[number].decisions, &good[1], &told);
        doubt_mirrored(&mut tibia.found[other].decisions, &good[0], &told);
    }
    Ok(())
}

/// Looks at some of the frames as if their pictures were flipped.
fn look_flipped(
    knee: &FlippedKnee,
    models: &[Model<'_>; 2],
    found: [&Found; 2],
    apart: &[f64],
) -> Result<Vec<Option<[FlippedFit; 2]>>> {
    fit_flipped(apart, |component, frame| {
        let number = usize::from(component == KneeComponent::Tibia);
        let Some(pose) = found[number].poses()[frame] else {
            return Ok(None);
        };
        let camera = found[number].camera;
        found[number].masks()?.look(frame, |seen| {
            let view = CameraView::only(&camera, seen.silhouette);
            let (own, options) = ((&models[number], &pose), RefineOptions::default());
            let mut buffers = RefineBuffers::default();
            Ok(knee.fit(component, own, view, options, &mut buffers))
        })
    })
}

/// Says what is told, once.
fn say(source: &str, told: &[Option<Beside>]) {
    let known = told.iter().flatten();
    if let Some(first) = known.clone().next() {
        eprintln!(
            "{source}: doubtful in {}: {first}",
            counted(known.count(), "frame")
        );
    }
}

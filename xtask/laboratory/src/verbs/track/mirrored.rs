//! Components of a film that lie beside each other as in no knee: its frames may be mirrored.

use anyhow::Result;
use fluoropose::finder::{FlippedFit, FlippedKnee};
use fluoropose::follow::Cell;
use fluoropose::joint::beside::{Beside, Lying, Middles};
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::refine::{CameraView, RefineBuffers, RefineOptions};

use super::part::Part;
use super::request::Told;
use super::run::Run;
use crate::choice::fit_flipped;
use crate::files::Role;

/// What is told of each frame; nothing where the film does not have one knee, or its axes are not known.
pub(super) fn beside(
    run: &Run<'_>,
    parts: &[Part<'_>],
    films: &[Vec<Cell>],
) -> Result<Vec<Option<Beside>>> {
    let known = |role| {
        let at = parts.iter().position(|part| part.role() == Some(role))?;
        let lying = lying(&films[at]);
        Some((&parts[at], parts[at].axes?, poses(&films[at]), lying))
    };
    let (Some(femur), Some(tibia)) = (known(Role::Femur), known(Role::Tibia)) else {
        return Ok(Vec::new());
    };
    let models = [femur.0.model(), tibia.0.model()];
    let meshes = models.map(|model| *model.mesh());
    let Some(middles) = Middles::new((meshes[0], &femur.1), (meshes[1], &tibia.1)) else {
        return Ok(Vec::new());
    };
    let mut told = middles.judge_poses(&femur.3, &tibia.3);
    let apart = middles.apart_of(&femur.2, &tibia.2);
    if let Some(knee) = FlippedKnee::new((&models[0], &femur.1), (&models[1], &tibia.1)) {
        let both = [(femur.0, &femur.2), (tibia.0, &tibia.2)];
        let fits = look_flipped(run, &knee, both, &apart)?;
        knee.judge(&mut told, &apart, &fits);
    }
    say(run, &told);
    Ok(told)
}

/// Says what is told of the film, or of the first frame, once.
fn say(run: &Run<'_>, told: &[Option<Beside>]) {
    let known = told.iter().enumerate();
    let mut known = known.filter_map(|(frame, told)| Some((frame, (*told)?)));
    if let Some((frame, first)) = known.next() {
        let more = match known.count() {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let remark = format!("frame {}{more}: {first}", frame + 1);
        (run.request.listener)(Told::Remark(remark));
    }
}

fn lying(film: &[Cell]) -> Vec<Option<Lying>> {
    let lying = |cell: &Cell| {
        let found = cell.found()?;
        Some(Lying::new(found.pose, found.covariance.as_ref()))
    };
    film.iter().map(lying).collect()
}

fn poses(film: &[Cell]) -> Vec<Option<Pose>> {
    let pose = |cell: &Cell| cell.found().map(|found| found.pose);
    film.iter().map(pose).collect()
}

/// Looks at some of the frames as if they were flipped.
fn look_flipped(
    run: &Run<'_>,
    knee: &FlippedKnee,
    both: [(&Part<'_>, &Vec<Option<Pose>>); 2],
    apart: &[f64],
) -> Result<Vec<Option<[FlippedFit; 2]>>> {
    fit_flipped(apart, |component, frame| {
        let of = |(part, _): &&(&Part<'_>, _)| part.role().map(Role::component) == Some(component);
        let Some((part, Some(pose))) = both
            .iter()
            .find(of)
            .map(|(part, poses)| (part, poses[frame]))
        else {
            return Ok(None);
        };
        let model: Model<'_> = part.model();
        part.see(run.film, frame, |_, image, _| {
            let view = CameraView::only(&part.camera, *image);
            let mut buffers = RefineBuffers::default();
            knee.fit(
                component,
                (&model, &pose),
                view,
                RefineOptions::default(),
                &mut buffers,
            )
        })
    })
}

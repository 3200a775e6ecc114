//! Which of many implants is it, beside the time of one.

use anyhow::{Context, Result, ensure};
use fluoropose::camera::Camera;
use fluoropose::canonical::{CanonicalSpec, canonicalise, reverse};
use fluoropose::image::mask::Word;
use fluoropose::library::Library;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose::search::{
    Catalogue, CatalogueMemory, Leaf, Query, catalogue_needed, identify_bytes_needed,
    query_bytes_needed,
};

use super::row::{Row, median, timed};
use crate::files::{MaskBuffer, owned};
use crate::finding::{ViewOptions, build_library};
use crate::progress::{announce, progress};
use fluoropose::mesh::OwnedModel;
use fluoropose_phantom::implant::{self, Parameters, Triangles};

/// Implants that are looked for, and how often.
const LOOKED_FOR: usize = 20;
const ROUNDS: usize = 5;
const DISTANCE_MM: f64 = 1080.0;

/// The time to identify an implant among `count`, beside `count` times that of a catalogue of one. The answer is
/// compared with searching every library.
pub(super) fn measure(count: usize, camera: Camera) -> Result<Row> {
    announce("building the catalogue");
    let surfaces: Vec<OwnedModel> = (0..count).map(implant).collect::<Result<_>>()?;
    let bar = progress(count, "implants");
    let mut files = Vec::new();
    for surface in &surfaces {
        let options = ViewOptions::window([0.0, 0.0]);
        files.push(build_library(surface.as_model(), camera, &options, DISTANCE_MM)?.bytes);
        bar.inc(1);
    }
    bar.finish_and_clear();
    let libraries = files.iter().map(|bytes| Library::open(bytes));
    let libraries: Vec<Library<'_>> = libraries.collect::<Result<_, _>>()?;
    announce("identifying implants");
    let spec = CanonicalSpec::default();
    let step = (count / LOOKED_FOR).max(1);
    let mut hunt = Hunt::new(spec);
    let (mut all, mut one, mut same) = (Vec::new(), Vec::new(), true);
    for wanted in (0..count).step_by(step) {
        let silhouette = silhouette(&surfaces[wanted], &camera, wanted, &spec)?;
        let (times, found) = hunt.identify(&libraries, &silhouette, ROUNDS)?;
        all.extend(times);
        one.extend(
            hunt.identify(&libraries[wanted..=wanted], &silhouette, ROUNDS)?
                .0,
        );
        // The exact answer of every library alone.
        let alone = (0..count).map(|number| {
            let library = &libraries[number..=number];
            let (_, (_, unmatched)) = hunt.identify(library, &silhouette, 1)?;
            Ok((unmatched, number))
        });
        let best = alone.collect::<Result<Vec<_>>>()?.into_iter().min();
        same &= best == Some((found.1, found.0));
    }
    let work = format!("which of {count} implants, exact, one thread");
    let peer = format!("{count} x a catalogue of one");
    let theirs = (count as f64 * median(one), same);
    Ok(Row::new(&work, median(all), &peer, Some(theirs)))
}

/// The built-in parts, stretched differently in three directions: other shapes, not only other sizes.
fn implant(number: usize) -> Result<OwnedModel> {
    let parameters = Parameters {
        resolution: 0.5,
        ..Parameters::default()
    };
    let made = if number.is_multiple_of(2) {
        implant::femur(&parameters)?
    } else {
        implant::tibia(&parameters)?
    };
    let stretch = [0.414_213, 0.618_034, 0.732_051]
        .map(|step: f64| (0.85 + 0.3 * (number as f64 * step).fract()) as f32);
    let vertices = made.vertices.iter();
    let vertices = vertices.map(|vertex| std::array::from_fn(|k| vertex[k] * stretch[k]));
    owned(Triangles {
        vertices: vertices.collect(),
        triangles: made.triangles,
    })
}

/// The canonical silhouette of an implant at a pose between the views.
fn silhouette(
    surface: &OwnedModel,
    camera: &Camera,
    number: usize,
    spec: &CanonicalSpec,
) -> Result<Vec<Word>> {
    let mesh = surface.as_model();
    let share = |step: f64| 2.0 * (number as f64 * step).fract() - 1.0;
    let pose = Pose::from(EulerPose {
        z_mm: -DISTANCE_MM,
        z_rot_deg: 40.0 * share(0.271_828),
        x_rot_deg: 12.0 * share(0.314_159),
        y_rot_deg: 16.0 * share(0.577_216),
        ..EulerPose::default()
    });
    let mut drawn = MaskBuffer::new(camera.width(), camera.height())?;
    let mut scratch = vec![Projected::default(); scratch_needed(&mesh)];
    drawn.draw(|mask| render(&mesh, camera, &pose, &mut scratch, mask))?;
    let mut words = vec![0; spec.words_needed()];
    canonicalise(&drawn.mask(), spec, camera.aspect(), &mut words)?;
    Ok(words)
}

/// Working memory of identification.
struct Hunt {
    spec: CanonicalSpec,
    turned: Vec<Word>,
    query: Vec<u8>,
    bytes: Vec<u8>,
}

impl Hunt {
    fn new(spec: CanonicalSpec) -> Self {
        Self {
            spec,
            turned: vec![0; spec.words_needed()],
            query: vec![0; query_bytes_needed(&spec)],
            bytes: vec![0; identify_bytes_needed(&spec)],
        }
    }

    /// Milliseconds of each round, and the implant found with its unmatched pixels. Making the silhouette ready is part
    /// of the work, making the catalogue's tree is not.
    fn identify(
        &mut self,
        libraries: &[Library<'_>],
        silhouette: &[Word],
        rounds: usize,
    ) -> Result<(Vec<f64>, (usize, u32))> {
        let needs = catalogue_needed(libraries);
        let (mut leaves, mut boxes) = (vec![Leaf::default(); needs.leaves], vec![0; needs.boxes]);
        let (mut places, mut scratch) = (vec![0; needs.places], vec![0; needs.scratch]);
        let memory = CatalogueMemory {
            leaves: &mut leaves,
            boxes: &mut boxes,
            places: &mut places,
            scratch: &mut scratch,
        };
        let catalogue = Catalogue::new(libraries, memory)?;
        let kernels = fluoropose_kernels::fastest();
        let mut times = Vec::new();
        let mut answer = None;
        for _ in 0..rounds {
            let (ms, found) = timed(|| -> Result<_> {
                reverse(silhouette, &mut self.turned);
                let query = Query::new(&self.spec, silhouette, &self.turned, &mut self.query)?;
                Ok(catalogue.identify::<1>(&query, &kernels, &mut self.bytes)?)
            });
            let best = *found?.first().context("the catalogue has no view")?;
            let this = (best.library, best.best.unmatched);
            ensure!(
                answer.is_none_or(|before| before == this),
                "two searches differ"
            );
            answer = Some(this);
            times.push(ms);
        }
        Ok((times, answer.context("nothing was looked for")?))
    }
}

//! The same on a grey frame: its film, given and estimated, and poses by it.

use std::fmt::Write as _;

use fluoropose::film::{
    FilmConstants, FilmEstimate, FilmModel, FilmPool, FilmProfile, GivenFilm, SquareChoice,
};
use fluoropose::finder::{Candidate, FinderBuffers, Goal, correct_candidates, find};
use fluoropose::image::contour::Outline;
use fluoropose::image::frame::Frame;
use fluoropose::image::mask::Mask;
use fluoropose::image::silhouette::Silhouette;
use fluoropose::library::Library;
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::{
    ImageTarget, Polarity, RefineMemory, RefineOptions, Refined, film_profiles,
};
use fluoropose::search::kernels::Kernels;
use fluoropose::{Camera, Component, Model};
use fluoropose_laboratory::files::MaskBuffer;

use super::{Case, Part, SIDE, calibration, six};

/// What a person knows of the film.
const GIVEN: [f64; 3] = [0.004, 0.8, 0.3];
/// Profiles that are read.
const PROFILES: usize = 96;

/// So far round each pixel a sharp and a soft frame look, pixels.
const SHARP: usize = 2;
const SOFT: usize = 4;

/// A frame that anybody draws alike, of whole numbers: dark where the outline is filled, by how many of the pixels round each are.
fn frame_of(mask: &Mask<'_>, reach: usize) -> Vec<u8> {
    let wide = 2 * reach + 1;
    let mut pixels = vec![0; SIDE * SIDE];
    for (number, pixel) in pixels.iter_mut().enumerate() {
        let (column, row) = (number % SIDE, number / SIDE);
        let inside = |at: usize| {
            let (right, down) = (
                (column + at % wide).wrapping_sub(reach),
                (row + at / wide).wrapping_sub(reach),
            );
            right < SIDE && down < SIDE && mask.get(right, down)
        };
        let covered = (0..wide * wide).filter(|&at| inside(at)).count();
        *pixel = 210 - (150 * covered / (wide * wide)) as u8;
    }
    pixels
}

/// What is found on a frame.
struct OnFrame {
    /// By the film that is given.
    best: Pose,
    /// What profiles there tell of it.
    film: FilmEstimate,
    /// The pose by that film.
    corrected: Pose,
}

/// Calls `with` with what is found on a frame, by a film where that is known.
fn found_on<T>(
    part: &Part,
    (mask, frame): (&Mask<'_>, &Frame<'_, u8>),
    film: Option<FilmModel>,
    with: impl FnOnce(&Component<'_>, &Camera, &[Candidate], &mut RefineMemory<'_>) -> T,
) -> T {
    let camera = calibration().camera(SIDE, SIDE).expect("a camera");
    let library = Library::open(&part.library).expect("a library");
    let model = part.model.as_model();
    let planes = symmetry_planes(model.mesh());
    let component = Component {
        library: &library,
        model: &model,
        planes: &planes,
    };
    let mut buffers = FinderBuffers::default();
    let mut memory = buffers.borrow(&component, &camera, Kernels::PORTABLE);
    let (silhouette, options) = (Silhouette::from(mask), RefineOptions::default());
    let goal = Goal::Image(dark(frame, film));
    let found = find(&component, &camera, &silhouette, goal, options, &mut memory);
    let candidates = found.expect("candidates").candidates;
    with(&component, &camera, &candidates, &mut memory.refine)
}

fn look(part: &Part, mask: &Mask<'_>) -> OnFrame {
    let pixels = frame_of(mask, SHARP);
    let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
    let [curvature, blur_px, attenuation] = GIVEN;
    let given = FilmModel::certain(FilmConstants::plain(curvature, blur_px), attenuation);
    found_on(
        part,
        (mask, &frame),
        Some(given),
        |of, camera, candidates, memory| {
            let (first, best) = (candidates[0], candidates[0].pose);
            let film =
                film_at(of.model, camera, &best, &dark(&frame, None), 1, memory).expect("told");
            // As it was kept: six numbers.
            let kept = Candidate {
                refined: Some(Refined::at(EulerPose::from(best).into())),
                ..first
            };
            let (seen, options) = (
                (camera, dark(&frame, Some(film.model(0)))),
                RefineOptions::default(),
            );
            let corrected = correct_candidates(of.model, seen, of.planes, &[kept], options, memory);
            OnFrame {
                best,
                film,
                corrected: corrected.expect("corrected")[0].pose,
            }
        },
    )
}

fn film_at(
    model: &Model<'_>,
    camera: &Camera,
    pose: &Pose,
    image: &ImageTarget<'_>,
    side: usize,
    memory: &mut RefineMemory<'_>,
) -> Option<FilmEstimate> {
    let mut profiles = vec![FilmProfile::default(); PROFILES];
    let read = film_profiles(model, camera, pose, image, (0, 0), memory, &mut profiles);
    profiles.truncate(read.expect("drawn"));
    let mut pool = FilmPool::in_squares(side);
    pool.take(0, 0, profiles);
    pool.estimate(GivenFilm::default())
}

/// What is found on a soft frame, whose film is read in squares of two pixels: that, and the pose by it.
fn look_in_squares(part: &Part, mask: &Mask<'_>) -> (FilmEstimate, Pose) {
    let pixels = frame_of(mask, SOFT);
    let frame = Frame::new(&pixels, SIDE, SIDE, SIDE).expect("fits");
    let mut choice = SquareChoice::new(None);
    let told = found_on(
        part,
        (mask, &frame),
        None,
        |of, camera, candidates, memory| {
            let mut told = None;
            while let Some(side) = choice.wanted() {
                let (wide, squares) = (SIDE / side, frame.reduced(side).expect("fits"));
                let squares = Frame::new(&squares, wide, wide, wide).expect("fits");
                let camera = camera.reduced(side).expect("fits");
                let best = candidates[0].pose;
                let film = film_at(
                    of.model,
                    &camera,
                    &best,
                    &dark(&squares, None),
                    side,
                    memory,
                );
                choice.take(film.as_ref().map(|film| film.constants.blur_px));
                let Some(film) = film.filter(|_| choice.square_px() == side) else {
                    continue;
                };
                let seen = (&camera, dark(&squares, Some(film.model(0))));
                let options = RefineOptions::default();
                let corrected =
                    correct_candidates(of.model, seen, &[], candidates, options, memory);
                told = Some((film, corrected.expect("corrected")[0].pose));
            }
            told
        },
    );
    assert_eq!(choice.square_px(), 2);
    told.expect("finer than its blur")
}

fn dark<'f>(frame: &'f Frame<'f, u8>, film: Option<FilmModel>) -> ImageTarget<'f> {
    ImageTarget {
        frame,
        unknown: None,
        polarity: Polarity::DarkImplant,
        film,
    }
}

/// The same as JSON.
pub(super) fn found(part: &Part, case: &Case) -> String {
    let outline = Outline::new(&case.outline, SIDE, SIDE).expect("simple");
    let mut mask = MaskBuffer::new(SIDE, SIDE).expect("possible");
    mask.draw(|mask| mask.fill_outline(&outline));
    let OnFrame {
        best,
        film,
        corrected,
    } = look(part, &mask.mask());
    let points = case.outline.iter();
    let points = points.map(|p| format!("[{}, {}]", p.column, p.row));
    let constants = film.model(0);
    let FilmConstants {
        curvature, blur_px, ..
    } = constants.constants;
    let constants = [curvature, blur_px, constants.attenuation];
    let mut text = String::new();
    let _ = writeln!(text, "    \"name\": \"{}\",", case.name);
    let _ = writeln!(text, "    \"model\": \"{}\",", part.name);
    let _ = writeln!(
        text,
        "    \"outline\": [{}],",
        points.collect::<Vec<_>>().join(", ")
    );
    let _ = writeln!(text, "    \"given\": {GIVEN:?},");
    let _ = writeln!(text, "    \"pose\": {},", six(best));
    let _ = writeln!(text, "    \"words\": \"{film}\",");
    let _ = writeln!(text, "    \"constants\": {constants:?},");
    let _ = writeln!(text, "    \"corrected\": {},", six(corrected));
    let (film, pose) = look_in_squares(part, &mask.mask());
    let _ = writeln!(text, "    \"soft\": {{");
    let _ = writeln!(text, "      \"reach\": {SOFT},");
    let _ = writeln!(text, "      \"words\": \"{film}\",");
    let _ = write!(text, "      \"pose\": {}\n    }}", six(pose));
    format!("{{\n{text}\n  }}")
}

//! An implant in one file for a microcontroller: with the smallest library after which refinement ends where it should, and
//! the finest surface that fits.

use std::path::Path;
use std::str::FromStr;

use anyhow::{Context, Result, ensure};
use fluoropose::camera::Camera;
use fluoropose::canonical::CanonicalSpec;
use fluoropose::finder::{Component, FinderBuffers, Goal, find};
use fluoropose::image::mask::{MaskMut, words_needed};
use fluoropose::implant::ArenaNeeds;
use fluoropose::library::{Library, ViewAxis, ViewGrid};
use fluoropose::math::{Matrix3, apply, cross, multiply, norm, rotation_by, scale};
use fluoropose::mesh::Model;
use fluoropose::mesh::symmetry::SymmetryPlane;
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose::{Mask, RefineOptions, Silhouette};
use fluoropose_kernels::fastest;
use fluoropose_phantom::whole;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::surface::Surface;
use crate::exit;
use crate::finding::build_views;

/// Bytes, as `256K`, `1M` or a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bytes(pub(super) usize);

impl FromStr for Bytes {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let (number, unit) = match text.strip_suffix(['K', 'k']) {
            Some(number) => (number, 1024),
            None => match text.strip_suffix(['M', 'm']) {
                Some(number) => (number, 1024 * 1024),
                None => (text, 1),
            },
        };
        let number: usize = number
            .trim()
            .parse()
            .ok()
            .context("this is no number of bytes, such as 256K")?;
        let bytes = number
            .checked_mul(unit)
            .context("there is no memory of so many bytes")?;
        Ok(Self(bytes))
    }
}

/// Canonical frames, pixels, and steps between views, degrees, the smallest library first. After the last refinement ends as
/// after any finer one.
const LIBRARIES: [(usize, f64); 6] = [
    (64, 5.0),
    (64, 2.5),
    (128, 5.0),
    (128, 2.5),
    (128, 1.0),
    (256, 1.0),
];
/// The same of all directions, of which there are fifty times as many: steps of a degree would be 64 800 views.
const AROUND: [(usize, f64); 5] = [(64, 10.0), (64, 5.0), (64, 2.5), (128, 5.0), (128, 2.5)];
/// Side and area of the usual canonical frame: the others hold the same part.
const USUAL: CanonicalSpec = CanonicalSpec::USUAL;
/// Poses that are drawn and found again: of so many some are missed where one in a hundred is.
const POSES: u64 = 360;
/// Of a library of all directions two of three poses look this nearly along the normal of a plane of symmetry, degrees: from the side, as knees
/// are filmed, where a nearly symmetric implant is told worst.
const SIDEWAYS_DEG: f64 = 8.0;
/// Farther than this from the true pose, degrees, it was not found.
const MISSED_DEG: f64 = 0.5;
/// Directions stay this far from the end of a window of views, degrees.
const MARGIN_DEG: f64 = 3.5;
/// How far poses lie off the frame's middle, as part of its sides, and off the library's distance, mm.
const ASIDE: f64 = 0.25;
const ALONG_MM: f64 = 40.0;
/// A surface is looked at closely where its triangles, at as many bytes each as the whole model's, take this much of the room.
const NEARLY: f64 = 1.1;
/// Pixels of the part of the frame that the table's memory is for, each side; and of the longest outline.
const PART: usize = 224;
const OUTLINE: usize = 900;

/// What is to be made.
pub(super) struct Order<'o> {
    pub(super) model: Model<'o>,
    pub(super) camera: Camera,
    pub(super) grid: ViewGrid,
    pub(super) distance: f64,
    pub(super) flash: usize,
}

impl Order<'_> {
    /// Those that are tried, the smallest first.
    fn libraries(&self) -> &'static [(usize, f64)] {
        match self.grid.is_around() {
            true => &AROUND,
            false => &LIBRARIES,
        }
    }
}

/// One row of the table.
struct Trial {
    size: usize,
    step: f64,
    file: Vec<u8>,
    views: usize,
    library_bytes: usize,
    missed: usize,
    before_deg: f64,
    after_deg: f64,
}

/// Chooses, prints the tables of the model and of the surface that is taken, and writes the file. Returns the code to exit with.
pub(super) fn run(order: &Order<'_>, out: &Path) -> Result<u8> {
    let whole = Surface::whole(&order.model)?;
    let silhouettes = silhouettes(order, &whole.planes)?;
    let of_whole = trials(order, &whole, &silhouettes)?;
    let with_whole = of_whole.iter().map(|trial| trial.missed).min();
    let with_whole = with_whole.unwrap_or_default();
    let number = chosen(&of_whole, order.flash);
    print(&whole, &of_whole, number, order.flash);
    if let Some(number) = number {
        return write(&of_whole[number], with_whole, out);
    }
    let surface = finest_that_fits(order, &of_whole[0])?;
    let of_surface = trials(order, &surface, &silhouettes)?;
    let number = chosen(&of_surface, order.flash);
    print(&surface, &of_surface, number, order.flash);
    let number = number.context("the surface that fits was made anew and does not")?;
    write(&of_surface[number], with_whole, out)
}

/// The finest coarser surface that fits with the smallest library; `smallest` is the whole model's trial of that library.
fn finest_that_fits(order: &Order<'_>, smallest: &Trial) -> Result<Surface> {
    let surface_bytes = smallest.file.len() - smallest.library_bytes;
    let each = surface_bytes as f64 / order.model.triangles().len() as f64;
    let room = order.flash.saturating_sub(smallest.library_bytes) as f64;
    let may = |triangles: usize| each * triangles as f64 <= NEARLY * room;
    let fits = |surface: &Surface| {
        let file = surface.file(&library_of(order, surface, order.libraries()[0])?)?;
        Ok(file.len() <= order.flash)
    };
    Surface::finest_that_fits(&order.model, may, fits).with_context(|| {
        format!(
            "--flash gives {} bytes; the smallest library takes {}, the model's whole surface {surface_bytes} more",
            order.flash, smallest.library_bytes
        )
    })
}

/// The smallest of the libraries that fit with which the fewest poses are missed.
fn chosen(trials: &[Trial], flash: usize) -> Option<usize> {
    let fits = |trial: &&Trial| trial.file.len() <= flash;
    let least = trials.iter().filter(fits).map(|trial| trial.missed).min()?;
    trials
        .iter()
        .position(|trial| fits(&trial) && trial.missed == least)
}

/// Writes what was chosen, and says so where it misses poses.
fn write(chosen: &Trial, with_whole: usize, out: &Path) -> Result<u8> {
    whole::write(out, &chosen.file)?;
    println!("{}: {} bytes", out.display(), chosen.file.len());
    let Some(told) = told(chosen.missed, with_whole) else {
        return Ok(0);
    };
    println!("{told}");
    Ok(exit::DOUBTFUL)
}

/// What is to be said of poses that are missed; `None` where there are none.
fn told(missed: usize, with_whole: usize) -> Option<String> {
    if missed == 0 {
        return None;
    }
    let remedy = match missed > with_whole {
        true => format!(
            "with a finer library, or the model's whole surface, it would be {with_whole}: give more flash (--flash)"
        ),
        false => "no fewer with any library of the model's whole surface: its outline looks alike from several sides there, or the views' \
range is too narrow (--x, --y)"
            .to_owned(),
    };
    Some(format!(
        "doubtful: with this file {missed} of {POSES} poses are missed, more than {MISSED_DEG} degrees off; {remedy}"
    ))
}

/// Poses and the silhouettes of the model itself at them, in all of the camera's frame.
fn silhouettes(order: &Order<'_>, planes: &[SymmetryPlane]) -> Result<Vec<(Pose, Vec<u32>)>> {
    let (width, height) = (order.camera.width(), order.camera.height());
    let mut random = ChaCha8Rng::seed_from_u64(18);
    let mut scratch = vec![Projected::default(); scratch_needed(&order.model)];
    let mut drawn = Vec::new();
    for number in 0..20 * POSES {
        let plane = planes
            .first()
            .filter(|_| number % 3 != 0 && order.grid.is_around());
        let pose = draw_pose(order, plane, &mut random);
        let mut words = vec![0; words_needed(width, height)];
        let mut mask = MaskMut::new(&mut words, width, height)?;
        if render(&order.model, &order.camera, &pose, &mut scratch, &mut mask).is_err() {
            continue;
        }
        let (columns, rows) = mask.as_mask().bounds();
        let whole = columns.start > 0 && rows.start > 0 && columns.end < width && rows.end < height;
        if whole && !columns.is_empty() {
            drawn.push((pose, words));
        }
        if drawn.len() as u64 == POSES {
            break;
        }
    }
    ensure!(
        !drawn.is_empty(),
        "the frame holds the implant at no pose: check --frame and the calibration"
    );
    Ok(drawn)
}

fn draw_pose(order: &Order<'_>, plane: Option<&SymmetryPlane>, random: &mut ChaCha8Rng) -> Pose {
    let camera = &order.camera;
    let [width, height] = [camera.width(), camera.height()].map(|side| side as f64);
    let [fx, fy] = camera.focal();
    let mut draw = |reach: f64| reach * random.random_range(-1.0..=1.0f64);
    let mut angle = |axis: &ViewAxis| {
        let reach = axis.step * (axis.count - 1) as f64 / 2.0;
        axis.first + reach + draw((reach - MARGIN_DEG).max(0.0))
    };
    let (x_rot_deg, y_rot_deg) = (angle(&order.grid.x), angle(&order.grid.y));
    let mut pose = Pose::from(EulerPose {
        x_mm: draw(ASIDE * width / fx * order.distance),
        y_mm: draw(ASIDE * height / fy * order.distance),
        z_mm: draw(ALONG_MM) - order.distance,
        z_rot_deg: draw(180.0),
        x_rot_deg,
        y_rot_deg,
    });
    if let Some(plane) = plane {
        pose.rotation = sideways(plane, pose.rotation, &mut draw);
    }
    let middle = apply(&pose.rotation, &order.model.centre());
    for (place, middle) in pose.translation.iter_mut().zip(middle) {
        *place -= middle;
    }
    pose
}

/// A rotation about the line of sight away from one that has a plane's normal nearly along that line.
fn sideways(plane: &SymmetryPlane, any: Matrix3, draw: &mut impl FnMut(f64) -> f64) -> Matrix3 {
    let normal = apply(&any, &plane.normal);
    let end = if normal[2] < 0.0 { -1.0 } else { 1.0 };
    let axis = cross(&normal, &[0.0, 0.0, end]);
    let onto = match norm(&axis) {
        0.0 => axis,
        length => scale(&axis, (length.min(1.0)).asin() / length),
    };
    let tilt = [0, 1].map(|_| draw(SIDEWAYS_DEG.to_radians()));
    let [onto, tilt] = [onto, [tilt[0], tilt[1], 0.0]].map(|turn| rotation_by(&turn));
    multiply(&tilt, &multiply(&onto, &any))
}

/// The same directions in other steps.
fn stepped(grid: &ViewGrid, step: f64) -> ViewGrid {
    if grid.is_around() {
        return ViewGrid::sphere(step);
    }
    let axis = |axis: &ViewAxis| {
        let reach = axis.step * (axis.count - 1) as f64;
        let count = (reach / step).ceil() as usize + 1;
        let beyond = (step * (count - 1) as f64 - reach) / 2.0;
        ViewAxis {
            first: axis.first - beyond,
            step,
            count,
        }
    };
    ViewGrid {
        x: axis(&grid.x),
        y: axis(&grid.y),
    }
}

/// Every library of a surface, tried.
fn trials(
    order: &Order<'_>,
    surface: &Surface,
    silhouettes: &[(Pose, Vec<u32>)],
) -> Result<Vec<Trial>> {
    let trial = |&kind| trial(order, surface, kind, silhouettes);
    order.libraries().iter().map(trial).collect()
}

/// The bytes of a library of a surface.
fn library_of(order: &Order<'_>, surface: &Surface, (size, step): (usize, f64)) -> Result<Vec<u8>> {
    let part = (size * size) as f64 / (USUAL.size() * USUAL.size()) as f64;
    let canonical = CanonicalSpec::new(size, (f64::from(USUAL.area()) * part).round() as u32)?;
    let grid = stepped(&order.grid, step);
    let model = surface.model.as_model();
    Ok(build_views(model, order.camera, canonical, grid, order.distance)?.bytes)
}

fn trial(
    order: &Order<'_>,
    surface: &Surface,
    (size, step): (usize, f64),
    silhouettes: &[(Pose, Vec<u32>)],
) -> Result<Trial> {
    let bytes = library_of(order, surface, (size, step))?;
    let library = Library::open(&bytes)?;
    let component = Component {
        library: &library,
        model: &surface.model.as_model(),
        planes: &surface.planes,
    };
    let off = |goal: fn() -> Goal<'static>| errors(order, &component, goal, silhouettes);
    let (before, after) = (off(|| Goal::Library), off(|| Goal::Outline));
    let found: Vec<f64> = after
        .iter()
        .copied()
        .filter(|&off| off <= MISSED_DEG)
        .collect();
    Ok(Trial {
        size,
        step,
        views: library.views(),
        library_bytes: bytes.len(),
        missed: after.len() - found.len(),
        before_deg: median(before),
        after_deg: median(found),
        file: surface.file(&bytes)?,
    })
}

/// How far the best pose is from the true one, degrees; infinitely where none is found.
fn errors(
    order: &Order<'_>,
    component: &Component<'_>,
    goal: fn() -> Goal<'static>,
    silhouettes: &[(Pose, Vec<u32>)],
) -> Vec<f64> {
    let (width, height) = (order.camera.width(), order.camera.height());
    let off = |buffers: &mut FinderBuffers, (truth, words): &(Pose, Vec<u32>)| {
        let mask = Mask::new(words, width, height).ok()?;
        let mut memory = buffers.borrow(component, &order.camera, fastest());
        let silhouette = Silhouette::from(&mask);
        let options = RefineOptions::default();
        let found = find(
            component,
            &order.camera,
            &silhouette,
            goal(),
            options,
            &mut memory,
        )
        .ok()?;
        let best = found.candidates.first()?;
        Some(geodesic_deg(&best.pose.rotation, &truth.rotation))
    };
    let poses = silhouettes.par_iter();
    let off = |buffers: &mut FinderBuffers, one| off(buffers, one).unwrap_or(f64::INFINITY);
    poses.map_init(FinderBuffers::default, off).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn print(surface: &Surface, trials: &[Trial], chosen: Option<usize>, flash: usize) {
    println!(
        "surface: {} triangles, {} vertices, the model's vertices at most {:.2} mm off it",
        surface.model.as_model().triangles().len(),
        surface.model.as_model().vertices().len(),
        surface.deviation_mm
    );
    println!(
        "frame  step deg   views  library B   file B  off before, after deg  missed of {POSES}  RAM B (outlines of {OUTLINE} px in {PART} x {PART})"
    );
    for (number, trial) in trials.iter().enumerate() {
        let Trial {
            size,
            step,
            views,
            library_bytes,
            missed,
            before_deg,
            after_deg,
            file,
        } = trial;
        let mark = match (chosen == Some(number), file.len() <= flash) {
            (true, _) if *missed > 0 => "  chosen, though it misses poses",
            (true, _) => "  chosen",
            (false, false) => "  too large",
            (false, true) => "",
        };
        println!(
            "{size:5}  {step:8.1}  {views:6}  {library_bytes:9}  {:7}  {before_deg:10.2}  {after_deg:9.3}  {missed:12}  {:6}{mark}",
            file.len(),
            memory(file),
        );
    }
}

/// What `finder_arena` takes for a part of the frame.
fn memory(file: &[u8]) -> usize {
    let needs = ArenaNeeds::of(file, PART, PART);
    needs.bytes_for(OUTLINE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_read_as_engineers_write_them() {
        let bytes = |text: &str| text.parse::<Bytes>().ok();
        assert_eq!(bytes("256K"), Some(Bytes(262_144)));
        assert_eq!(bytes("1M"), Some(Bytes(1_048_576)));
        assert_eq!(bytes("9000"), Some(Bytes(9000)));
        assert_eq!(bytes("a lot"), None);
    }

    fn trial_of(bytes: usize, missed: usize) -> Trial {
        Trial {
            size: 64,
            step: 5.0,
            file: vec![0; bytes],
            views: 1,
            library_bytes: 1,
            missed,
            before_deg: 1.0,
            after_deg: 0.1,
        }
    }

    #[test]
    fn of_the_libraries_that_fit_the_smallest_with_the_fewest_misses_is_chosen() {
        let trials = [(10, 3), (20, 1), (30, 1), (40, 0)].map(|(b, m)| trial_of(b, m));
        assert_eq!(chosen(&trials, 30), Some(1), "the last does not fit");
        assert_eq!(chosen(&trials, 40), Some(3));
        assert_eq!(chosen(&trials, 10), Some(0));
        assert_eq!(chosen(&trials, 9), None);
    }

    #[test]
    fn poses_that_are_missed_are_told() {
        assert_eq!(told(0, 0), None);
        let flash = told(26, 0).expect("it is told");
        assert!(flash.contains("26 of 360 poses are missed") && flash.contains("--flash"));
        let views = told(2, 2).expect("it is told");
        assert!(views.contains("--x, --y"), "{views}");
    }

    #[test]
    fn other_steps_leave_no_direction_out() {
        let grid = ViewGrid::default();
        for (_, step) in LIBRARIES {
            let coarse = stepped(&grid, step);
            for (own, coarse) in [(grid.x, coarse.x), (grid.y, coarse.y)] {
                let last = |axis: &ViewAxis| axis.at((axis.count - 1) as f64);
                assert!(coarse.first <= own.first + 1e-9 && last(&coarse) >= last(&own) - 1e-9);
                assert_eq!(coarse.step, step);
            }
        }
    }

    #[test]
    fn from_the_side_the_normal_is_nearly_the_viewing_direction() {
        let plane = SymmetryPlane {
            point: [0.0; 3],
            normal: [0.6, 0.0, 0.8],
            deviation_mm: 0.0,
        };
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut draw = |reach: f64| reach * random.random_range(-1.0..=1.0f64);
        for _ in 0..50 {
            let any = rotation_by(&[draw(3.0), draw(3.0), draw(3.0)]);
            let normal = apply(&sideways(&plane, any, &mut draw), &plane.normal);
            assert!(
                normal[2].abs() > (1.5 * SIDEWAYS_DEG).to_radians().cos(),
                "{normal:?}"
            );
        }
    }
}

use super::*;
use fluoropose::camera::Camera;
use fluoropose::canonical::CanonicalSpec;
use fluoropose::film::LineMemory;
use fluoropose::finder::Component;
use fluoropose::image::contour::Point;
use fluoropose::image::frame::Frame;
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::library::Library;
use fluoropose::library::{Builder, ViewAxis, ViewGrid, ViewScratch};
use fluoropose::locate::{Workspace, workspace_needed};
use fluoropose::mesh::Model;
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::refine::{BorderPixel, Polarity, RefineError, RefineMemory, places_needed};
use fluoropose::render::{Projected, render};
use fluoropose::search::kernels::Kernels;
use std::vec::Vec;

pub(crate) const SIDE: usize = 384;

/// A tray with a stem and a tab: no symmetry, and parts of some width.
pub(crate) fn model() -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let boxes = [
        ([-36.0, -8.0, -22.0], [36.0, 8.0, 22.0]),
        ([-9.0, 8.0, -9.0], [9.0, 40.0, 9.0]),
        ([24.0, -22.0, -12.0], [36.0, -8.0, 16.0]),
    ];
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (low, high) in boxes {
        let first = vertices.len() as u32;
        for corner in 0..8 {
            let pick = |k: usize| [low, high][corner >> k & 1][k];
            vertices.push([pick(0), pick(1), pick(2)]);
        }
        let faces = [
            [0, 1, 3, 2],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 3, 7, 6],
            [0, 2, 6, 4],
            [1, 3, 7, 5],
        ];
        for [a, b, c, d] in faces {
            triangles.push([a, b, c].map(|v| first + v));
            triangles.push([a, c, d].map(|v| first + v));
        }
    }
    (vertices, triangles)
}

pub(crate) fn camera() -> Camera {
    Camera::new(SIDE, SIDE, [1800.0, 1800.0], [192.0, 192.0]).expect("valid")
}

pub(crate) fn library(model: Model<'_>, distance_mm: f64) -> Vec<u8> {
    let axis = ViewAxis {
        first: -8.0,
        step: 2.0,
        count: 9,
    };
    let (grid, canonical) = (ViewGrid { x: axis, y: axis }, CanonicalSpec::default());
    let builder = Builder::new(model, camera(), canonical, grid, distance_mm).expect("possible");
    let mut bytes = std::vec![0; builder.bytes_needed()];
    let mut scratch = ViewScratch {
        projected: &mut std::vec![Projected::default(); builder.projected_needed()],
        render: &mut std::vec![0; builder.render_words_needed()],
        canonical: &mut std::vec![0; canonical.words_needed()],
    };
    builder.build(&mut bytes, &mut scratch).expect("renders");
    bytes
}

pub(crate) fn pose() -> Pose {
    Pose::from(EulerPose {
        x_mm: 6.0,
        y_mm: -9.0,
        z_mm: -1040.0,
        z_rot_deg: 31.0,
        x_rot_deg: -3.5,
        y_rot_deg: 4.6,
    })
}

/// The silhouette of a model at a pose.
pub(crate) fn silhouette(model: &Model<'_>, pose: &Pose) -> Vec<Word> {
    let mut words = std::vec![0; words_needed(SIDE, SIDE)];
    let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
    let mut scratch = std::vec![Projected::default(); model.vertices().len()];
    render(model, &camera(), pose, &mut scratch, &mut mask).expect("in front");
    words
}

/// A noisy, blurred frame of the implant on tissue that grows darker to one side. `cluttered`: a
/// line that crosses it, as of a sheet, leads to another implant that is as dark.
fn drawn(model: &Model<'_>, cluttered: bool) -> Vec<u16> {
    drawn_with_wall(model, cluttered, 0.0)
}

/// The same, the implant's lower side thin for so many pixels: a wall that lets light through.
fn drawn_with_wall(model: &Model<'_>, cluttered: bool, wall: f64) -> Vec<u16> {
    let (sin, cos) = libm::sincos(31f64.to_radians());
    let is_thin = |mask: &Mask<'_>, column: usize, row: usize| {
        let below = (column as f64 + wall * sin, row as f64 + wall * cos);
        !mask.get(below.0 as usize, below.1 as usize)
    };
    let words = silhouette(model, &pose());
    let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
    let dark = |column: usize, row: usize| {
        let other = (300..360).contains(&column) && (60..260).contains(&row);
        let line = (column + 3 * row).abs_diff(900) < 12 && column > 60;
        match () {
            () if wall > 0.0 && mask.get(column, row) && is_thin(&mask, column, row) => 1800.0,
            () if mask.get(column, row) || (cluttered && other) => 900.0,
            () if cluttered && line => 1500.0,
            () => 2600.0 - 1.5 * row as f64 - 0.8 * column as f64,
        }
    };
    let blurred = |column: usize, row: usize| {
        let mut sum = 0.0;
        for (c, r) in (0..9).map(|k| (k % 3, k / 3)) {
            let weight = [1.0, 2.0, 1.0][c] * [1.0, 2.0, 1.0][r] / 16.0;
            let at = |at: usize, step: usize| (at + step).saturating_sub(1).min(SIDE - 1);
            sum += weight * dark(at(column, c), at(row, r));
        }
        sum
    };
    let mut state = 1u32;
    let mut noise = || {
        let mut sum = 0.0;
        for _ in 0..4 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            sum += f64::from(state >> 16) / 65_536.0 - 0.5;
        }
        80.0 * sum
    };
    (0..SIDE * SIDE)
        .map(|k| (blurred(k % SIDE, k / SIDE) + noise()) as u16)
        .collect()
}

/// A model with its library.
struct Bench {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    library: Vec<u8>,
    /// Whether it is looked for farther away too.
    farther: bool,
    /// Border pixels of an outline that there is memory for.
    border: usize,
}

impl Bench {
    fn new() -> Self {
        Self::with_library_at(1000.0)
    }

    fn with_library_at(distance_mm: f64) -> Self {
        let (vertices, triangles) = model();
        let model = Model::from_triangles(&vertices, &triangles).expect("valid");
        let library = library(model, distance_mm);
        Self {
            vertices,
            triangles,
            library,
            farther: false,
            border: 4096,
        }
    }

    fn model(&self) -> Model<'_> {
        Model::from_triangles(&self.vertices, &self.triangles).expect("valid")
    }

    /// The work for a prompt, done to the end, and the region where there is no component.
    fn work(
        &self,
        pixels: &[u16],
        prompt: Prompt,
        polarity: Polarity,
        with_component: bool,
    ) -> Result<(OneClick, Vec<Word>), OneClickError> {
        self.work_with_reserve(pixels, prompt, polarity, with_component, 0)
    }

    /// The same in memory that is longer than needed by `reserve` and not empty.
    fn work_with_reserve(
        &self,
        pixels: &[u16],
        prompt: Prompt,
        polarity: Polarity,
        with_component: bool,
        reserve: usize,
    ) -> Result<(OneClick, Vec<Word>), OneClickError> {
        let (model, camera) = (self.model(), camera());
        let library = Library::open(&self.library).expect("valid");
        let frame = Frame::new(pixels, SIDE, SIDE, SIDE).expect("fits");
        let observation = Observation {
            frame: &frame,
            camera: &camera,
            polarity,
            excluded: None,
            beside: None,
            film: None,
        };
        let component = Component {
            library: &library,
            model: &model,
            planes: &[],
        };
        let component = with_component.then_some(&component);
        let mut work = OneClick::new(prompt, &camera, component)?;
        if let Some(component) = component.filter(|_| self.farther) {
            work = work.or_farther(&camera, component);
        }
        let (needs, locating) = (work.needs(&camera), workspace_needed(&library));
        let mut memory = OneClickMemory {
            grey: &mut std::vec![3; needs.pixels + reserve],
            reached: &mut std::vec![3; needs.pixels + reserve],
            distance: &mut std::vec![3; needs.pixels + reserve],
            marks: &mut std::vec![3; needs.pixels + reserve],
            links: &mut std::vec![3; needs.links + reserve],
            statistics: &mut std::vec![3; needs.statistics + reserve],
            words: &mut std::vec![3; needs.words + reserve],
            workspace: Workspace {
                canonical: &mut std::vec![0; locating.words],
                rotated: &mut std::vec![0; locating.words],
                scores: &mut std::vec![0; locating.scores],
                bytes: &mut std::vec![0; locating.bytes],
                kernels: Kernels::PORTABLE,
            },
            refine: RefineMemory {
                projected: &mut std::vec![Projected::default(); model.vertices().len()],
                drawn: &mut std::vec![0; words_needed(SIDE, SIDE)],
                places: &mut std::vec![0; places_needed(SIDE)],
                border: &mut std::vec![BorderPixel::default(); self.border],
                film: LineMemory::default(),
            },
        };
        let step = |work: &mut OneClick, memory: &mut OneClickMemory<'_>| {
            work.step(&observation, component, memory)
        };
        until_done(&mut work, &mut memory, step)?;
        let region = match component {
            Some(_) => Vec::new(),
            None => work
                .draw_region(&observation, &mut memory)?
                .words()
                .to_vec(),
        };
        Ok((work, region))
    }
}

/// Takes all steps; progress never falls.
fn until_done(
    work: &mut OneClick,
    memory: &mut OneClickMemory<'_>,
    step: impl Fn(&mut OneClick, &mut OneClickMemory<'_>) -> Result<bool, OneClickError>,
) -> Result<(), OneClickError> {
    let mut before = 0.0;
    while step(work, memory)? {
        let (Progress::Regions(done) | Progress::Poses(done)) = work.progress() else {
            panic!("there is more to do");
        };
        assert!((before..1.0).contains(&done), "{before} {done}");
        before = done;
    }
    assert_eq!(work.progress(), Progress::Done);
    Ok(())
}

fn overlap(a: &[Word], b: &[Word]) -> f64 {
    let count = |rule: fn(Word, Word) -> Word| -> u32 {
        a.iter()
            .zip(b)
            .map(|(&a, &b)| rule(a, b).count_ones())
            .sum()
    };
    f64::from(count(|a, b| a & b)) / f64::from(count(|a, b| a | b))
}

/// A click on the stem, one on the tray and a rough box.
fn prompts() -> [Prompt; 3] {
    let at = |x: f64, y: f64| {
        let point = pose().transform(&[x, y, 0.0]);
        camera().project(&point).expect("in front")
    };
    [
        Prompt::Click(at(0.0, 25.0)),
        Prompt::Click(at(-28.0, 1.0)),
        Prompt::Box(Point::new(115.0, 105.0), Point::new(290.0, 290.0)),
    ]
}

#[test]
fn a_click_or_a_box_leads_to_outline_and_pose() {
    let bench = Bench::new();
    let model = bench.model();
    let truth = silhouette(&model, &pose());
    for cluttered in [false, true] {
        let pixels = drawn(&model, cluttered);
        for prompt in prompts() {
            let found = bench.work(&pixels, prompt, Polarity::DarkImplant, true);
            let (work, _) = found.expect("an answer");
            let best = &work.answers()[0];
            let turn = geodesic_deg(&best.refined.pose.rotation, &pose().rotation);
            let iou = overlap(&silhouette(&model, &best.refined.pose), &truth);
            let what = std::format!("{prompt:?}, cluttered {cluttered}");
            assert!(turn < 0.7 && iou > 0.97, "{what}: {turn} deg, {iou}");
            assert!(best.support.fraction > 0.8, "{what}: {:?}", best.support);
        }
    }
}

/// Poses whose outlines are shorter than the right one's would be left over, and the best of these taken.
#[test]
fn with_too_little_memory_for_an_outline_nothing_is_found_and_the_memory_is_named() {
    let mut bench = Bench::new();
    let pixels = drawn(&bench.model(), false);
    let polarity = Polarity::DarkImplant;
    let mut refused = 0;
    let (plenty, _) = bench
        .work(&pixels, prompts()[0], polarity, true)
        .expect("an answer");
    for border in (400..900).step_by(50) {
        bench.border = border;
        match bench.work(&pixels, prompts()[0], polarity, true) {
            Ok((found, _)) => {
                let poses = |work: &OneClick| {
                    work.answers()
                        .iter()
                        .map(|answer| answer.refined.pose)
                        .collect::<Vec<_>>()
                };
                assert_eq!(poses(&found), poses(&plenty), "{border}");
            }
            Err(OneClickError::Refine(RefineError::Memory(short))) => {
                assert_eq!((short.what, short.given), ("border pixels", border));
                refused += 1;
            }
            Err(other) => panic!("{border}: {other}"),
        }
    }
    assert!((1..10).contains(&refused), "{refused} refused");
}

/// The wall of a tray lets light through: what is dark has a sharp edge of its own, and the model fits inside of it, farther
/// away and tilted. This wall is so faint that the frame's edges do not hold the model on it; its pose is the first rival.
#[test]
fn a_wall_that_lets_light_through_is_a_rival_at_least() {
    let bench = Bench::new();
    let model = bench.model();
    let truth = silhouette(&model, &pose());
    let pixels = drawn_with_wall(&model, false, 7.0);
    for prompt in [prompts()[0], prompts()[2]] {
        let found = bench.work(&pixels, prompt, Polarity::DarkImplant, true);
        let (work, _) = found.expect("an answer");
        let rivals = work.answers().iter().take(2).map(|answer| {
            let found = &answer.refined.pose;
            let turn = geodesic_deg(&found.rotation, &pose().rotation);
            (turn, overlap(&silhouette(&model, found), &truth))
        });
        let rivals: Vec<(f64, f64)> = rivals.collect();
        let right = |&(turn, iou): &(f64, f64)| turn < 6.0 && iou > 0.92;
        assert!(rivals.iter().any(right), "{prompt:?}: {rivals:?}");
    }
}

#[test]
fn a_frame_with_inverted_greys_gives_the_same() {
    let bench = Bench::new();
    let model = bench.model();
    let bright: Vec<u16> = drawn(&model, true).iter().map(|grey| 4095 - grey).collect();
    let found = bench.work(&bright, prompts()[1], Polarity::BrightImplant, true);
    let (work, _) = found.expect("an answer");
    let rotation = &work.answers()[0].refined.pose.rotation;
    assert!(geodesic_deg(rotation, &pose().rotation) < 0.7);
}

#[test]
fn without_a_component_the_region_is_the_outline() {
    let bench = Bench::new();
    let model = bench.model();
    let pixels = drawn(&model, false);
    for prompt in prompts() {
        let found = bench.work(&pixels, prompt, Polarity::DarkImplant, false);
        let (work, region) = found.expect("a region");
        assert!(work.answers().is_empty());
        let iou = overlap(&region, &silhouette(&model, &pose()));
        assert!(iou > 0.95, "{prompt:?}: {iou}");
    }
}

#[test]
fn longer_memory_gives_the_same() {
    let bench = Bench::new();
    let pixels = drawn(&bench.model(), true);
    for (prompt, with_component) in [(prompts()[0], true), (prompts()[2], false)] {
        let [exact, longer] = [0, 1000].map(|reserve| {
            let polarity = Polarity::DarkImplant;
            bench.work_with_reserve(&pixels, prompt, polarity, with_component, reserve)
        });
        let [(a, region), (b, other)] = [exact.expect("done"), longer.expect("done")];
        assert_eq!((a.answers(), a.starts()), (b.answers(), b.starts()));
        assert_eq!(region, other);
    }
}

/// The implant lies 1.6 times as far away as its library.
#[test]
fn what_nothing_near_explains_is_looked_for_farther_away() {
    let mut bench = Bench::with_library_at(650.0);
    let pixels = drawn(&bench.model(), false);
    for prompt in [prompts()[0], prompts()[2]] {
        bench.farther = false;
        let near = bench.work(&pixels, prompt, Polarity::DarkImplant, true);
        let wrong = |(work, _): (OneClick, Vec<Word>)| {
            let found = work.answers()[0].refined.pose;
            geodesic_deg(&found.rotation, &pose().rotation) > 2.0
        };
        assert!(near.map_or(true, wrong), "{prompt:?}");
        bench.farther = true;
        let found = bench.work(&pixels, prompt, Polarity::DarkImplant, true);
        let (work, _) = found.expect("an answer");
        let turn = geodesic_deg(&work.answers()[0].refined.pose.rotation, &pose().rotation);
        assert!(turn < 0.7, "{prompt:?}: {turn} deg");
    }
    let flat = std::vec![700u16; SIDE * SIDE];
    let error = bench.work(&flat, prompts()[0], Polarity::DarkImplant, true);
    assert_eq!(error.err(), Some(OneClickError::Blank));
}

#[test]
fn where_there_is_no_implant_a_sentence_says_so() {
    let bench = Bench::new();
    let pixels = drawn(&bench.model(), true);
    let click = |column, row| {
        let prompt = Prompt::Click(Point::new(column, row));
        bench
            .work(&pixels, prompt, Polarity::DarkImplant, true)
            .err()
    };
    assert_eq!(click(-3.0, 10.0), Some(OneClickError::Outside));
    let nothing = [Some(OneClickError::NoRegion), Some(OneClickError::NoFit)];
    assert!(nothing.contains(&click(40.0, 340.0)));
    let flat = std::vec![700u16; SIDE * SIDE];
    let prompt = Prompt::Click(Point::new(200.0, 200.0));
    let error = bench.work(&flat, prompt, Polarity::DarkImplant, true).err();
    assert_eq!(error, Some(OneClickError::Blank));
    let noise: Vec<u16> = (0..SIDE * SIDE).map(|at| (at * 7919 % 3) as u16).collect();
    let error = bench
        .work(&noise, prompt, Polarity::DarkImplant, true)
        .err();
    assert_eq!(error, Some(OneClickError::Blank));
    let slope: Vec<u16> = (0..SIDE * SIDE).map(|at| (at % SIDE) as u16).collect();
    let error = bench
        .work(&slope, prompt, Polarity::DarkImplant, true)
        .err();
    assert!(nothing.contains(&error));
}

#[test]
fn the_window_holds_the_component_and_no_more() {
    let bench = Bench::new();
    let (model, camera) = (bench.model(), camera());
    let needs = OneClick::new(prompts()[0], &camera, None)
        .expect("inside")
        .needs(&camera);
    assert_eq!(needs.pixels, SIDE * SIDE);
    let library = Library::open(&bench.library).expect("valid");
    let component = Component {
        library: &library,
        model: &model,
        planes: &[],
    };
    // The window around a click holds the component at its nearest, and no more.
    let click = Prompt::Click(Point::new(0.0, 0.0));
    let needs = OneClick::new(click, &camera, Some(&component))
        .expect("inside")
        .needs(&camera);
    let extent = 2.0 * model.bounds().radius * 1800.0 / 700.0;
    assert_eq!(needs.pixels, (extent as usize + 1).pow(2).min(SIDE * SIDE));
}

//! An implant, drawn frames of it, and the work on them.

use super::super::*;
use fluoropose::camera::Camera;
use fluoropose::canonical::CanonicalSpec;
use fluoropose::film::LineMemory;
use fluoropose::finder::Component;
use fluoropose::image::contour::Point;
use fluoropose::image::frame::Frame;
use fluoropose::image::grey::Grey;
use fluoropose::image::mask::{Mask, MaskMut, Word, words_needed};
use fluoropose::library::Library;
use fluoropose::library::{Builder, ViewAxis, ViewGrid, ViewScratch};
use fluoropose::locate::{Workspace, workspace_needed};
use fluoropose::mesh::Model;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::{BorderPixel, Polarity, RefineMemory, places_needed};
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
pub(super) fn drawn(model: &Model<'_>, cluttered: bool) -> Vec<u16> {
    drawn_with_wall(model, cluttered, 0.0)
}

/// The same, the implant's lower side thin for so many pixels: a wall that lets light through.
pub(super) fn drawn_with_wall(model: &Model<'_>, cluttered: bool, wall: f64) -> Vec<u16> {
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

/// A frame of which nothing else is known.
pub(crate) fn seen<'f>(
    frame: &'f dyn Grey,
    camera: &'f Camera,
    polarity: Polarity,
) -> Observation<'f> {
    Observation {
        frame,
        camera,
        polarity,
        excluded: None,
        beside: None,
        film: None,
    }
}

/// A component without symmetry planes.
pub(crate) fn component<'c>(library: &'c Library<'c>, model: &'c Model<'c>) -> Component<'c> {
    Component {
        library,
        model,
        planes: &[],
    }
}

/// Memory for the work that is not empty.
pub(crate) struct Lent {
    pixels: [Vec<u16>; 3],
    marks: Vec<u8>,
    numbers: [Vec<u32>; 2],
    words: [Vec<Word>; 4],
    scores: Vec<u32>,
    bytes: Vec<u8>,
    projected: Vec<Projected>,
    places: Vec<u16>,
    border: Vec<BorderPixel>,
}

impl Lent {
    /// As much as is needed and so much more.
    pub(crate) fn new(
        needs: &OneClickNeeds,
        library: &Library<'_>,
        bench: &Bench,
        reserve: usize,
    ) -> Self {
        let locating = workspace_needed(library);
        let pixels = needs.pixels + reserve;
        let words = [needs.words + reserve, locating.words, locating.words];
        let [own, canonical, rotated] = words.map(|words| std::vec![3; words]);
        Self {
            pixels: [(); 3].map(|()| std::vec![3; pixels]),
            marks: std::vec![3; pixels],
            numbers: [needs.links, needs.statistics].map(|length| std::vec![3; length + reserve]),
            words: [
                own,
                canonical,
                rotated,
                std::vec![0; words_needed(SIDE, SIDE)],
            ],
            scores: std::vec![0; locating.scores],
            bytes: std::vec![0; locating.bytes],
            projected: std::vec![Projected::default(); bench.vertices.len()],
            places: std::vec![0; places_needed(SIDE)],
            border: std::vec![BorderPixel::default(); bench.border],
        }
    }

    pub(crate) fn borrow(&mut self) -> OneClickMemory<'_> {
        let [grey, reached, distance] = &mut self.pixels;
        let [links, statistics] = &mut self.numbers;
        let [words, canonical, rotated, drawn] = &mut self.words;
        OneClickMemory {
            grey,
            reached,
            distance,
            marks: &mut self.marks,
            links,
            statistics,
            words,
            workspace: Workspace {
                canonical,
                rotated,
                scores: &mut self.scores,
                bytes: &mut self.bytes,
                kernels: Kernels::PORTABLE,
            },
            refine: RefineMemory {
                projected: &mut self.projected,
                drawn,
                places: &mut self.places,
                border: &mut self.border,
                film: LineMemory::default(),
            },
        }
    }
}

/// A model with its library.
pub(crate) struct Bench {
    vertices: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    pub(crate) library: Vec<u8>,
    /// Whether it is looked for farther away too.
    pub(super) farther: bool,
    /// Border pixels of an outline that there is memory for.
    pub(super) border: usize,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self::with_library_at(1000.0)
    }

    pub(super) fn with_library_at(distance_mm: f64) -> Self {
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

    pub(crate) fn model(&self) -> Model<'_> {
        Model::from_triangles(&self.vertices, &self.triangles).expect("valid")
    }

    /// The work for a prompt, done to the end, and the region where there is no component.
    pub(super) fn work(
        &self,
        pixels: &[u16],
        prompt: Prompt,
        polarity: Polarity,
        with_component: bool,
    ) -> Result<(OneClick, Vec<Word>), OneClickError> {
        self.work_with_reserve(pixels, prompt, polarity, with_component, 0)
    }

    /// The same in memory that is longer than needed by `reserve` and not empty.
    pub(super) fn work_with_reserve(
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
        let observation = seen(&frame, &camera, polarity);
        let component = component(&library, &model);
        let component = with_component.then_some(&component);
        let mut work = OneClick::new(prompt, &camera, component)?;
        if let Some(component) = component.filter(|_| self.farther) {
            work = work.or_farther(&camera, component);
        }
        let mut lent = Lent::new(&work.needs(&camera), &library, self, reserve);
        let mut memory = lent.borrow();
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

/// A click on the stem, one on the tray and a rough box.
pub(crate) fn prompts() -> [Prompt; 3] {
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

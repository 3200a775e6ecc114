//! This machine at the core's work, beside what a user would otherwise take, in one run on the same data.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use fluoropose::camera::Camera;
use fluoropose::canonical::{CanonicalSpec, canonicalise, reverse};
use fluoropose::image::mask::Word;
use fluoropose::image::silhouette::Silhouette;
use fluoropose::library::Library;
use fluoropose::mesh::Model;
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose::search::scores_needed;
use fluoropose::search::{
    Directions, Query, ViewSearch, ViewSearchMemory, query_bytes_needed, search_bytes_needed,
};

use super::catalogue;
use super::peers::Peers;
use super::row::{Row, median, timed};
use crate::files::{MaskBuffer, owned};
use crate::finding::{Finder, Method, ViewOptions, build_library};
use crate::progress::announce;
use crate::sequence::Seen;
use fluoropose_phantom::implant::{self, Parameters};

/// Silhouettes that are looked for, and poses that are drawn.
const CASES: usize = 8;
/// Times that each is, in turn with the peers.
const ROUNDS: usize = 15;
/// Drawings of a turn; the peers have the same number.
const DRAWINGS: usize = 5;
/// The frame of one silhouette, and how far the model is from the focus, mm.
const SIDE: usize = 256;
const DISTANCE_MM: f64 = 1080.0;
/// Libraries built, of which the median counts.
const BUILDS: usize = 9;

/// All rows. `implants` is how many the catalogue has, `work` the folder of the peers and of the data that all share.
pub(super) fn measure(implants: usize, work: &Path) -> Result<Vec<Row>> {
    announce("building a library");
    let surface = owned(implant::femur(&Parameters::default())?)?;
    let mesh = surface.as_model();
    let camera = Camera::from_principal_distance(1024, 1024, 1200.0, 0.373, [0.0, 0.0])?;
    let options = ViewOptions::window([0.0, 0.0]);
    let built = build_library(mesh, camera, &options, DISTANCE_MM)?;
    let library = Library::open(&built.bytes)?;
    println!(
        "{} views of {} triangles: {} bytes a view",
        library.views(),
        mesh.triangles().len(),
        built.bytes.len() / library.views()
    );
    let bench = Bench::new(mesh, library, camera, work.join("data"))?;
    let mut peers = Peers::start(&bench.folder, &work.join("peers"));
    if let Err(error) = &peers {
        eprintln!("peers are left out: {error:#}");
    }
    let mut rows = bench.searches(&mut peers)?;
    rows.extend(bench.silhouettes(&mut peers)?);
    let builds = (0..BUILDS).map(|_| build_library(mesh, camera, &options, DISTANCE_MM));
    let builds = builds.map(|built| built.map(|built| 1000.0 * built.took.as_secs_f64()));
    let whole = median(builds.collect::<Result<_>>()?);
    rows.push(bench.library_row(&rows, whole));
    rows.push(bench.refined(&built.bytes)?);
    rows.push(catalogue::measure(implants, camera)?);
    Ok(rows)
}

/// A peer's times and whether it always agreed; why not, where it could not be run.
struct Peer<'p> {
    name: &'p str,
    shown: &'p str,
    times: Vec<f64>,
    agreed: bool,
    failed: Option<String>,
}

impl<'p> Peer<'p> {
    fn new(&(name, shown): &(&'p str, &'p str)) -> Self {
        Self {
            name,
            shown,
            times: Vec::new(),
            agreed: true,
            failed: None,
        }
    }

    fn row(self, work: &str, ours: f64) -> Row {
        let shown = match &self.failed {
            Some(why) => format!("{} (could not be run: {why})", self.shown),
            None => self.shown.to_owned(),
        };
        let theirs = self
            .failed
            .is_none()
            .then(|| (median(self.times), self.agreed));
        Row::new(work, ours, &shown, theirs)
    }
}

struct Bench<'b> {
    mesh: Model<'b>,
    library: Library<'b>,
    camera: Camera,
    /// Of one silhouette.
    small: Camera,
    poses: Vec<Pose>,
    /// Canonical silhouettes.
    queries: Vec<Vec<Word>>,
    /// All views, plain.
    views: Vec<Word>,
    /// Where the peers find their data.
    folder: PathBuf,
}

impl<'b> Bench<'b> {
    fn new(mesh: Model<'b>, library: Library<'b>, camera: Camera, folder: PathBuf) -> Result<Self> {
        let spec = library.info().canonical;
        let radius = mesh.bounds().radius;
        // The model's sphere just fits.
        let focal = 0.48 * SIDE as f64 * DISTANCE_MM / radius;
        let small = Camera::new(SIDE, SIDE, [focal; 2], [SIDE as f64 / 2.0; 2])?;
        let poses: Vec<Pose> = (0..CASES).map(|case| pose(case, &mesh)).collect();
        let mut queries = Vec::new();
        for pose in &poses {
            let drawn = draw(&mesh, &camera, pose)?;
            let mut words = vec![0; spec.words_needed()];
            canonicalise(&drawn.mask(), &spec, camera.aspect(), &mut words)?;
            queries.push(words);
        }
        let mut views = vec![0; library.views() * spec.words_needed()];
        for (view, words) in views.chunks_mut(spec.words_needed()).enumerate() {
            library.draw(view, words);
        }
        fs::create_dir_all(&folder)?;
        let bench = Self {
            mesh,
            library,
            camera,
            small,
            poses,
            queries,
            views,
            folder,
        };
        bench.write()?;
        Ok(bench)
    }

    /// The same data for the peers.
    fn write(&self) -> Result<()> {
        let bytes = |words: &[Word]| {
            words
                .iter()
                .flat_map(|word| word.to_le_bytes())
                .collect::<Vec<u8>>()
        };
        let write = |name: &str, bytes: &[u8]| {
            fs::write(self.folder.join(name), bytes).with_context(|| format!("cannot write {name}"))
        };
        write("views.bin", &bytes(&self.views))?;
        write("queries.bin", &bytes(&self.queries.concat()))?;
        write(
            "triangles.bin",
            &bytes(self.mesh.triangles().as_flattened()),
        )?;
        let vertices = self.mesh.vertices().as_flattened();
        let vertices: Vec<u8> = vertices.iter().flat_map(|x| x.to_le_bytes()).collect();
        write("vertices.bin", &vertices)?;
        let rows = |pose: &Pose| -> Vec<f64> {
            let row = |k: usize| pose.rotation[k].into_iter().chain([pose.translation[k]]);
            (0..3).flat_map(row).collect()
        };
        let poses: Vec<Vec<f64>> = self.poses.iter().map(rows).collect();
        let scene =
            serde_json::json!({ "side": SIDE, "focal": self.small.focal()[0], "poses": poses });
        write("scene.json", scene.to_string().as_bytes())
    }

    /// The exact best of all views, one thread, the silhouette as it is.
    fn searches(&self, peers: &mut Result<Peers>) -> Result<Vec<Row>> {
        const WORK: &str = "exact best of 1271 views, one thread";
        const PEERS: [(&str, &str); 4] = [
            ("faiss", "FAISS IndexBinaryFlat"),
            ("usearch", "USearch exact Hamming"),
            ("opencv", "OpenCV NORM_HAMMING"),
            ("numpy", "NumPy"),
        ];
        announce("looking for silhouettes");
        let mut memory = SearchBuffers::new(&self.library);
        let mut others: Vec<Peer<'_>> = PEERS.iter().map(Peer::new).collect();
        let (mut ours, mut reading) = (Vec::new(), Vec::new());
        for case in (0..ROUNDS).flat_map(|_| 0..CASES) {
            let (ms, found) = timed(|| memory.best(&self.library, &self.queries[case]));
            let found = found?;
            ours.push(ms);
            reading.push(timed(|| read_once(&self.views)).0);
            let Ok(peers) = peers else { continue };
            for peer in &mut others {
                match peers.ask::<[u32; 2]>(peer.name, case) {
                    Ok(theirs) => {
                        peer.times.push(theirs.ms);
                        peer.agreed &= theirs.answer == found;
                    }
                    Err(error) => peer.failed = Some(format!("{error:#}")),
                }
            }
        }
        let ours = median(ours);
        let asked = peers.is_ok();
        let mut rows: Vec<Row> = others
            .into_iter()
            .filter(|_| asked)
            .map(|peer| peer.row(WORK, ours))
            .collect();
        let reading = Some((median(reading), true));
        rows.push(Row::new(
            WORK,
            ours,
            "reading the plain library once",
            reading,
        ));
        Ok(rows)
    }

    /// One silhouette, 256 x 256, one thread. Each draws it some times in its turn, as who builds a
    /// library or refines a pose does, and the median counts.
    fn silhouettes(&self, peers: &mut Result<Peers>) -> Result<Vec<Row>> {
        const WORK: &str = "one silhouette, 256 x 256";
        const PEERS: [(&str, &str); 2] = [
            ("vtk", "VTK, off-screen on the CPU"),
            ("opencv-triangles", "OpenCV, each triangle filled"),
        ];
        announce("drawing silhouettes");
        let mut others: Vec<Peer<'_>> = PEERS.iter().map(Peer::new).collect();
        let mut ours = Vec::new();
        let mut scratch = vec![Projected::default(); scratch_needed(&self.mesh)];
        for case in (0..ROUNDS).flat_map(|_| 0..CASES) {
            let mut drawn = MaskBuffer::new(SIDE, SIDE)?;
            let pose = &self.poses[case];
            let mut turn = Vec::new();
            for _ in 0..DRAWINGS {
                let (ms, result) = timed(|| {
                    drawn.draw(|mask| render(&self.mesh, &self.small, pose, &mut scratch, mask))
                });
                result?;
                turn.push(ms);
            }
            ours.push(median(turn));
            let Ok(peers) = peers else { continue };
            for peer in others.iter_mut().filter(|peer| peer.failed.is_none()) {
                match peers.ask::<PathBuf>(peer.name, case) {
                    Ok(theirs) => {
                        peer.times.push(theirs.ms);
                        peer.agreed &= looks_alike(&drawn, &theirs.answer)?;
                    }
                    Err(error) => peer.failed = Some(format!("{error:#}")),
                }
            }
        }
        let ours = median(ours);
        let rows = others.into_iter().map(|peer| peer.row(WORK, ours));
        Ok(rows.filter(|_| peers.is_ok()).collect())
    }

    /// The whole library on all cores, beside as many of VTK's silhouettes.
    fn library_row(&self, rows: &[Row], ours_ms: f64) -> Row {
        let drawn = rows.iter().find(|row| row.peer.starts_with("VTK"));
        let one = drawn.and_then(|row| row.peer_ms.zip(row.same_answer));
        let all = one.map(|(ms, same)| (ms * self.library.views() as f64, same));
        Row::new(
            "library of 1271 views, all cores",
            ours_ms,
            "VTK: 1271 x its one silhouette",
            all,
        )
    }

    /// From a mask to refined poses, mirror candidates among them.
    fn refined(&self, library: &[u8]) -> Result<Row> {
        announce("refining poses");
        let mut finder = Finder::open(library, self.mesh, self.camera, Method::Refined)?;
        let mut times = Vec::new();
        for (case, pose) in (0..3).flat_map(|_| self.poses.iter().enumerate()) {
            let drawn = draw(&self.mesh, &self.camera, pose)?;
            let mask = drawn.mask();
            let (ms, found) = timed(|| finder.all(&Seen::from(Silhouette::from(&mask))));
            ensure!(
                !found?.candidates.is_empty(),
                "silhouette {case} has no pose"
            );
            times.push(ms);
        }
        let work = "mask of 1024 x 1024 to refined poses, mirror candidates and regions of 95 % among them";
        Ok(Row::new(work, median(times), "none", None))
    }
}

/// Working memory of a search.
pub(super) struct SearchBuffers {
    spec: CanonicalSpec,
    turned: Vec<Word>,
    query: Vec<u8>,
    bounds: Vec<u32>,
    sketches: Vec<u8>,
}

impl SearchBuffers {
    pub(super) fn new(library: &Library<'_>) -> Self {
        let spec = library.info().canonical;
        Self {
            spec,
            turned: vec![0; spec.words_needed()],
            query: vec![0; query_bytes_needed(&spec)],
            bounds: vec![0; scores_needed(library.views())],
            sketches: vec![0; search_bytes_needed(&spec)],
        }
    }

    /// The best view and its unmatched pixels; making the silhouette ready is part of the work.
    pub(super) fn best(&mut self, library: &Library<'_>, straight: &[Word]) -> Result<[u32; 2]> {
        reverse(straight, &mut self.turned);
        let query = Query::new(&self.spec, straight, &self.turned, &mut self.query)?;
        let memory = ViewSearchMemory {
            bounds: &mut self.bounds,
            sketches: &mut self.sketches,
        };
        let kernels = fluoropose_kernels::fastest();
        let best =
            ViewSearch::new(library, &query, &kernels, memory)?.best::<1>(Directions::Straight);
        let best = best.first().context("the library has no view")?;
        Ok([best.view as u32, best.unmatched])
    }
}

/// Reads every word.
fn read_once(words: &[Word]) -> u64 {
    let (pairs, rest) = words.as_chunks::<2>();
    let rest: u64 = rest.iter().map(|&word| u64::from(word)).sum();
    pairs
        .iter()
        .map(|&[low, high]| u64::from(low) | u64::from(high) << 32)
        .fold(rest, u64::wrapping_add)
}

/// The model's silhouette.
fn draw(mesh: &Model<'_>, camera: &Camera, pose: &Pose) -> Result<MaskBuffer> {
    let mut drawn = MaskBuffer::new(camera.width(), camera.height())?;
    let mut scratch = vec![Projected::default(); scratch_needed(mesh)];
    drawn.draw(|mask| render(mesh, camera, pose, &mut scratch, mask))?;
    Ok(drawn)
}

/// Poses within the library's range, the middle of the model on the optical axis.
fn pose(case: usize, mesh: &Model<'_>) -> Pose {
    // Steps of irrational length spread over the range without order.
    let spread = |step: f64, range: f64| range * (2.0 * (case as f64 * step).fract() - 1.0);
    let turned = Pose::from(EulerPose {
        z_rot_deg: spread(0.414_213, 40.0),
        x_rot_deg: spread(0.618_034, 12.0),
        y_rot_deg: spread(0.732_051, 16.0),
        ..EulerPose::default()
    });
    let [x, y, z] = turned.transform(&mesh.bounds().centre);
    Pose {
        translation: [-x, -y, -z - DISTANCE_MM],
        ..turned
    }
}

/// Whether a peer's pixels are ours, but for pixels at the outline: rasterisers differ in what they do with those that
/// an edge crosses.
fn looks_alike(ours: &MaskBuffer, theirs: &Path) -> Result<bool> {
    let pixels = fs::read(theirs)?;
    ensure!(
        pixels.len() == SIDE * SIDE,
        "{} pixels were drawn",
        pixels.len()
    );
    let mask = ours.mask();
    let alike = |(at, &pixel): (usize, &u8)| {
        let (column, row) = (at % SIDE, at / SIDE);
        let near = (row.saturating_sub(1)..=row + 1).flat_map(|row| {
            (column.saturating_sub(1)..=column + 1).map(move |column| (column, row))
        });
        near.into_iter()
            .any(|(column, row)| mask.get(column, row) == (pixel > 0))
    };
    Ok(pixels.iter().enumerate().all(alike))
}

//! Verb `identify`: which implant of a catalogue a silhouette is of, and its pose.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use fluoropose::camera::Camera;
use fluoropose::canonical::{CanonicalSpec, canonicalise, reverse};
use fluoropose::library::Library;
use fluoropose::locate::{Workspace, locate, workspace_needed};
use fluoropose::pose::EulerPose;
use fluoropose::search::{
    Catalogue, CatalogueMemory, Identified, Leaf, Query, catalogue_needed, identify_bytes_needed,
    query_bytes_needed,
};

use fluoropose_report::counted;

use crate::exit;
use crate::files::{MaskBuffer, files_in, name_of, read, read_calibration};
use crate::sequence::{Folders, Source};

/// Implants that are told of each mask.
const TOLD: usize = 3;
/// An implant fits where no larger part of the silhouette differs. Clean masks of six components of three studies differed by 2 to 11.2 percent
/// from their own, by 12 and more from any other.
const FITS: f64 = 0.115;

/// Options of `identify`.
#[derive(clap::Args)]
#[command(
    after_help = "Every library of the folder is one implant. The search is exact: it finds what comparing the mask with every view of \
every library would, and leaves out only what cannot be better. A canonical silhouette tells nothing of an implant's size; the pose's depth does. Told are the parts \
of the canonical silhouette that differ: of a clean mask 2 to 11 percent from its own implant. More than 11.5 is called no fit: another implant, or a poor mask; the \
command exits with 3 then. A tray's pose may be its mirror image's: `pose` tells both.\n\n\
Example:\n  cargo xtask identify --libraries catalogue --calibration calibration.txt --masks masks/femur"
)]
pub struct Args {
    /// Folder of library files from `cargo xtask library`, all of one canonical size and area
    #[arg(long, value_name = "DIR")]
    libraries: PathBuf,
    /// Calibration of the frames: JT_INTCALIB or a camera matrix (MayaCam 2.0, OpenCV, ROS, MATLAB)
    #[arg(long)]
    calibration: PathBuf,
    /// Folder of mask images
    #[arg(long)]
    masks: PathBuf,
}

/// Runs the verb; the code to exit with.
///
/// # Errors
/// For files that cannot be read or do not go together, masks of several sizes, and masks without a canonical form.
pub fn run(args: Args) -> Result<u8> {
    let calibration = read_calibration(&args.calibration)?;
    let files = files_in(&args.libraries)?;
    let contents: Vec<Vec<u8>> = files.iter().map(|file| read(file)).collect::<Result<_>>()?;
    let libraries = files
        .iter()
        .zip(&contents)
        .map(|(file, bytes)| Library::open(bytes).with_context(|| file.display().to_string()))
        .collect::<Result<Vec<_>>>()?;
    let needs = catalogue_needed(&libraries);
    let memory = CatalogueMemory {
        leaves: &mut vec![Leaf::default(); needs.leaves],
        boxes: &mut vec![0; needs.boxes],
        places: &mut vec![0; needs.places],
        scratch: &mut vec![0; needs.scratch],
    };
    let catalogue = Catalogue::new(&libraries, memory)?;
    let mut memory = Memory::new(&catalogue.spec());
    let folders = Folders {
        masks: &args.masks,
        unknown: None,
        frames: None,
    };
    let source = Source::read(&folders, &calibration)?;
    let area = f64::from(catalogue.spec().area());
    let mut all_fit = true;
    for (path, mask) in &source.masks {
        let start = Instant::now();
        let found = memory.identify(&catalogue, &source.camera, mask)?;
        let took = start.elapsed();
        println!(
            "{}: looked for among {} in {took:.1?}",
            name_of(path),
            counted(libraries.len(), "implant")
        );
        for one in &found {
            println!(
                "  {}: {:.1} % differ ({} of {area} pixels)",
                name_of(&files[one.library]),
                100.0 * f64::from(one.best.unmatched) / area,
                one.best.unmatched
            );
        }
        let Some(best) = found.first() else {
            bail!("the catalogue has no view");
        };
        if f64::from(best.best.unmatched) > FITS * area {
            all_fit = false;
            println!("  none fits: is it an implant that is not among these, or is the mask poor?");
        }
        println!(
            "  {}",
            pose_line(&libraries[best.library], &source.camera, mask)?
        );
    }
    Ok(if all_fit { 0 } else { exit::DOUBTFUL })
}

/// Working memory for one mask after another.
struct Memory {
    canonical: Vec<u32>,
    turned: Vec<u32>,
    query: Vec<u8>,
    bytes: Vec<u8>,
}

impl Memory {
    fn new(spec: &CanonicalSpec) -> Self {
        Self {
            canonical: vec![0; spec.words_needed()],
            turned: vec![0; spec.words_needed()],
            query: vec![0; query_bytes_needed(spec)],
            bytes: vec![0; identify_bytes_needed(spec)],
        }
    }

    fn identify(
        &mut self,
        catalogue: &Catalogue<'_>,
        camera: &Camera,
        mask: &MaskBuffer,
    ) -> Result<Vec<Identified>> {
        let spec = catalogue.spec();
        let mask = mask.mask();
        canonicalise(&mask, &spec, camera.aspect(), &mut self.canonical)?;
        reverse(&self.canonical, &mut self.turned);
        let query = Query::new(&spec, &self.canonical, &self.turned, &mut self.query)?;
        let kernels = fluoropose_kernels::fastest();
        let found = catalogue.identify::<TOLD>(&query, &kernels, &mut self.bytes)?;
        Ok(found.to_vec())
    }
}

/// The pose by the library that fits best.
fn pose_line(library: &Library<'_>, camera: &Camera, mask: &MaskBuffer) -> Result<String> {
    let mask = mask.mask();
    let needs = workspace_needed(library);
    let work = Workspace {
        canonical: &mut vec![0; needs.words],
        rotated: &mut vec![0; needs.words],
        scores: &mut vec![0; needs.scores],
        bytes: &mut vec![0; needs.bytes],
        kernels: fluoropose_kernels::fastest(),
    };
    let found = locate::<1>(&mask, camera, library, work)?;
    let located = found
        .poses
        .first()
        .context("the best library has no pose")?;
    let pose = EulerPose::from(located.pose);
    Ok(format!(
        "x {:.2}, y {:.2}, z {:.1} mm; z {:.2}, x {:.2}, y {:.2} deg",
        pose.x_mm, pose.y_mm, pose.z_mm, pose.z_rot_deg, pose.x_rot_deg, pose.y_rot_deg
    ))
}

//! Verb `library`: renders the views of a model into a library file.

use std::path::{Path, PathBuf};

use anyhow::Result;
use fluoropose::image::mask::WORD_BITS;
use fluoropose::library::Library;
use fluoropose_phantom::picture::write_grey;
use fluoropose_phantom::whole;

use crate::files::{camera_for, check_outputs, read_calibration, read_model};

use crate::finding::{ViewOptions, build_library};

use crate::options::Pair;

mod deviation;
mod firmware;
mod surface;

use firmware::{Bytes, Order};

/// What a library is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Purpose {
    /// One file for a microcontroller: the smallest library after which refinement ends at the right poses, the surface and its
    /// edges, planes of symmetry, and what memory all of it takes
    Firmware,
}

/// Options of `library`.
#[derive(clap::Args)]
#[command(
    after_help = "A library holds the silhouettes of one component in canonical form: from all sides, 2.5 degrees apart, or over \
the out-of-plane rotations that --nominal, --x and --y name (1 degree apart: 31 x 41 = 1271 views). The page opens it; \
so does firmware, in place. With --for firmware canonical frame and steps are chosen by what refinement needs.\n\n\
Example:\n  cargo xtask library --model femur.stl --calibration calibration.txt --out femur.library --sheet views.png"
)]
pub struct Args {
    /// The implant's model: STL (binary or ASCII), OBJ or PLY, in mm
    #[arg(long)]
    model: PathBuf,
    /// Calibration: JT_INTCALIB or a camera matrix (MayaCam 2.0, OpenCV, ROS, MATLAB)
    #[arg(long)]
    calibration: PathBuf,
    /// Width and height of the frames, pixels; only recorded, but poses are tried in them with --for firmware. 1024,1024 if not given, but a camera matrix has its own
    #[arg(long, value_name = "W,H")]
    frame: Option<Pair>,
    #[command(flatten)]
    views: ViewOptions,
    /// What it is for, where not for the page
    #[arg(
        long = "for",
        value_name = "PURPOSE",
        requires = "flash",
        conflicts_with_all = ["area", "size", "sheet"]
    )]
    purpose: Option<Purpose>,
    /// With --for firmware: most bytes of the file, as 256K
    #[arg(long, value_name = "BYTES", requires = "purpose")]
    flash: Option<Bytes>,
    /// Library file to write
    #[arg(long)]
    out: PathBuf,
    /// Write a picture of all views too: x to the right, y downwards
    #[arg(long, value_name = "PNG")]
    sheet: Option<PathBuf>,
}

/// Runs the verb. Returns the code to exit with.
///
/// # Errors
/// For files that cannot be read or written and views that cannot be rendered.
pub fn run(args: Args) -> Result<u8> {
    let outputs = [
        ("--out", Some(&*args.out)),
        ("--sheet", args.sheet.as_deref()),
    ];
    check_outputs(
        &outputs,
        [&args.model, &args.calibration].map(|path| Some(&**path)),
    )?;
    let model = read_model(&args.model)?;
    let calibration = read_calibration(&args.calibration)?;
    let camera = camera_for(&calibration, args.frame)?;
    let distance = args.views.distance_for(&calibration);
    if let (Some(Purpose::Firmware), Some(Bytes(flash))) = (args.purpose, args.flash) {
        let order = Order {
            model: model.as_model(),
            camera,
            grid: args.views.grid(),
            distance,
            flash,
        };
        return firmware::run(&order, &args.out);
    }
    let built = build_library(model.as_model(), camera, &args.views, distance)?;
    whole::write(&args.out, &built.bytes)?;
    let library = Library::open(&built.bytes)?;
    if let Some(sheet) = &args.sheet {
        write_sheet(&library, sheet)?;
    }
    println!(
        "{}: {} views of {} triangles at {distance} mm, {:.1} MB, in {:.2} s",
        args.out.display(),
        library.views(),
        model.as_model().triangles().len(),
        built.bytes.len() as f64 / 1e6,
        built.took.as_secs_f64()
    );
    Ok(0)
}

/// Side of a view on the contact sheet, pixels.
const THUMBNAIL: usize = 64;

/// All views as one picture: a thumbnail each, grey by coverage, x to the right, y downwards.
fn write_sheet(library: &Library<'_>, path: &Path) -> Result<()> {
    let grid = library.info().grid;
    let size = library.info().canonical.size();
    let (columns, rows) = (grid.x.count * THUMBNAIL, grid.y.count * THUMBNAIL);
    let words = library.info().canonical.words_needed();
    let mut views = vec![vec![0; words]; library.views()];
    for (view, words) in views.iter_mut().enumerate() {
        library.draw(view, words);
    }
    let shade = |x: usize, y: usize| -> u8 {
        let words = &views[grid.view(x / THUMBNAIL, y / THUMBNAIL)];
        let block = |at: usize| {
            let first = at % THUMBNAIL * size / THUMBNAIL;
            first..(first + size / THUMBNAIL).max(first + 1)
        };
        let (across, down) = (block(x), block(y));
        let area = across.len() * down.len();
        let set = down
            .flat_map(|row| across.clone().map(move |column| row * size + column))
            .filter(|bit| words[bit / WORD_BITS] >> (bit % WORD_BITS) & 1 == 1)
            .count();
        let line = x.is_multiple_of(THUMBNAIL) || y.is_multiple_of(THUMBNAIL);
        if line {
            96
        } else {
            (255 - 255 * set / area) as u8
        }
    };
    let sheet: Vec<u8> = (0..columns * rows)
        .map(|k| shade(k % columns, k / columns))
        .collect();
    write_grey(path, (columns, rows), &sheet)
}

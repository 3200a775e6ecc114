//! Verb `calibrate`: camera and distortion from a picture of a bead grid.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use fluoropose::camera::calibration::Calibration;
use fluoropose::image::frame::Frame;
use fluoropose_decode::{FrameFile, GreyFrame, Pixels};
use fluoropose_distortion::automatic::distortion_grid;
use fluoropose_distortion::correction::{Corrected, ORDERS, fit};
use fluoropose_distortion::lattice::Bead;
use fluoropose_distortion::plate::{Distances, PlateCamera, camera};
use fluoropose_report::plus_minus;

use crate::exit;
use crate::files::{name_of, read, write_distortion, write_text};

/// Options of `calibrate`.
#[derive(clap::Args)]
#[command(
    after_help = "The grid is a flat plate of round beads or holes in a square pattern. With --distortion a polynomial correction is fitted \
and written (its order, 3 to 5, by cross-validation); the camera is then that of the straightened picture, so frames must go through \
`cargo xtask undistort` before they are traced; the plate has to be level with the detector for that (to 4 degrees), because its perspective would be taken for \
distortion. Without --distortion a tilted plate shows the principal point too. With the spacing and both distances the calibration is written to --out. The command \
exits with 3 where the calibration is doubtful: of a distorted picture that was not corrected, or of a corrected one of a tilted plate.\n\n\
Example:\n  cargo xtask calibrate --grid plate.dcm --distortion plate.json --spacing 10 --source-to-detector 1200 --source-to-plate 1150 \
--out calibration.txt"
)]
pub struct Args {
    /// Frame of the grid: PNG, JPEG, JPEG 2000, TIFF, BMP, DICOM or a NumPy array
    #[arg(long)]
    grid: PathBuf,
    /// Which frame of the file, from 1
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    frame: u32,
    /// Radius of the beads, px; any, where it is left out
    #[arg(long)]
    radius: Option<f64>,
    /// The beads are brighter than what is round them
    #[arg(long)]
    bright: bool,
    /// Correction of distortion to write (JSON)
    #[arg(long)]
    distortion: Option<PathBuf>,
    /// Between neighbouring beads, mm
    #[arg(long, requires = "out")]
    spacing: Option<f64>,
    /// From the X-ray source to the detector, mm
    #[arg(long, requires = "spacing")]
    source_to_detector: Option<f64>,
    /// From the X-ray source to the middle of the plate, mm
    #[arg(long, requires = "spacing")]
    source_to_plate: Option<f64>,
    /// Calibration to write (JT_INTCALIB)
    #[arg(long, requires_all = ["spacing", "source_to_detector", "source_to_plate"])]
    out: Option<PathBuf>,
}

/// Runs the verb; the code to exit with.
///
/// # Errors
/// For a picture without a grid, impossible lengths, and files that cannot be read or written.
pub fn run(args: Args) -> Result<u8> {
    let name = name_of(&args.grid);
    let picture = FrameFile::open(read(&args.grid)?, &name)?.frame(args.frame as usize - 1)?;
    let size = (picture.width as usize, picture.height as usize);
    let mut beads = beads_of(&picture, args.bright, args.radius).with_context(|| name.clone())?;
    let as_taken = beads.clone();
    if let Some(path) = &args.distortion {
        let corrected = fit(&mut beads, size).with_context(|| name.clone())?;
        describe_distortion(&corrected, &beads);
        write_distortion(path, &corrected, &name)?;
        for bead in &mut beads {
            *bead = Bead::new(corrected.distortion.undistorted(bead.at), bead.index);
        }
    }
    match (
        args.spacing,
        args.source_to_detector,
        args.source_to_plate,
        &args.out,
    ) {
        (Some(spacing_mm), Some(source_to_detector_mm), Some(source_to_plate_mm), Some(out)) => {
            let measured = Distances {
                spacing_mm,
                source_to_detector_mm,
                source_to_plate_mm,
            };
            let see = |beads: &[Bead]| camera(beads, measured, size).with_context(|| name.clone());
            let found = see(&beads)?;
            describe_camera(&found);
            write_camera(out, &found, measured)?;
            let as_taken = args.distortion.is_some().then(|| see(&as_taken));
            let doubt = doubt(&found, as_taken.transpose()?.as_ref());
            doubt.iter().for_each(|doubt| eprintln!("{doubt}"));
            Ok(doubt.map_or(0, |_| exit::DOUBTFUL))
        }
        _ => Ok(0),
    }
}

/// The numbered beads of a picture.
///
/// # Errors
/// When there is no grid.
pub fn beads_of(picture: &GreyFrame, bright: bool, radius: Option<f64>) -> Result<Vec<Bead>> {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let (found, mut beads) = match &picture.pixels {
        Pixels::U8(pixels) => {
            distortion_grid(&Frame::new(pixels, width, height, width)?, bright, radius)?
        }
        Pixels::U16(pixels) => {
            distortion_grid(&Frame::new(pixels, width, height, width)?, bright, radius)?
        }
    };
    beads.retain(|bead| bead.index.is_some());
    println!(
        "{} beads of {:.1} px radius in a lattice, {:.1} px apart; {} other marks left out",
        found.numbered,
        found.radius_px,
        found.step_px,
        found.marks - found.numbered
    );
    Ok(beads)
}

fn describe_distortion(corrected: &Corrected, beads: &[Bead]) {
    let reach = |axis: usize| {
        let used = beads.iter().filter(|bead| bead.index.is_some());
        let places = used.map(|bead| bead.at[axis]);
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
            (at.min(low), at.max(high))
        });
        format!("{low:.0} to {high:.0}")
    };
    println!(
        "distortion: {:.3} px RMS before, {:.3} px after a correction of order {}; {} beads used, {} dropped; largest shift {:.1} px within their radius; they reach \
         over columns {} and rows {}: beyond them the correction is extrapolated",
        corrected.before_px,
        corrected.after_px,
        corrected.distortion.order(),
        corrected.used,
        corrected.dropped,
        corrected.distortion.largest_shift_px(),
        reach(0),
        reach(1)
    );
    let told = ORDERS
        .iter()
        .zip(corrected.left_out_px)
        .map(|(order, residual)| {
            let residual = residual.map_or("too few beads".to_owned(), |px| format!("{px:.3} px"));
            format!("order {order} {residual}")
        });
    println!("cross-validated: {}", told.collect::<Vec<_>>().join(", "));
}

fn describe_camera(found: &PlateCamera) {
    println!(
        "pixel pitch {} mm (and the relative error of the distances); {} beads, {:.3} px residual; plate tilted {:.1} deg",
        plus_minus(found.pitch_mm, found.pitch_deviation_mm, 5),
        found.used,
        found.residual_px,
        found.tilt_deg
    );
    match found.offset_is_measured {
        true => println!(
            "principal point {}, {} mm from the frame's middle",
            plus_minus(found.offset_mm[0], found.offset_deviation_mm[0], 2),
            plus_minus(found.offset_mm[1], found.offset_deviation_mm[1], 2)
        ),
        false => println!(
            "principal point: the frame's middle is taken, a plate this level does not show it"
        ),
    }
}

/// What is doubtful of a camera; `as_taken` is that of the beads before they were straightened.
fn doubt(found: &PlateCamera, as_taken: Option<&PlateCamera>) -> Option<String> {
    match as_taken {
        None => found.is_distorted().then(|| {
            format!(
                "the picture is distorted by {:.2} px (RMS): correct it first (--distortion), or the pitch is that of the middle at best",
                found.residual_px
            )
        }),
        // Straightened, a tilted plate looks level.
        Some(as_taken) => as_taken.is_tilted().then(|| {
            format!(
                "the plate is tilted by {:.0} degrees, which the correction takes for distortion: the pitch is off by {:.1} percent where the picture is not distorted. \
                 Take the plate level with the detector, or leave --distortion out where the picture is not distorted",
                as_taken.tilt_deg,
                100.0 * (found.pitch_mm / as_taken.pitch_mm - 1.0).abs()
            )
        }),
    }
}

fn write_camera(path: &Path, found: &PlateCamera, measured: Distances) -> Result<()> {
    let calibration = Calibration::PrincipalDistance {
        distance: measured.source_to_detector_mm,
        offset: if found.offset_is_measured {
            found.offset_mm
        } else {
            [0.0; 2]
        },
        pitch: found.pitch_mm,
    };
    write_text(path, &calibration.to_string())
}

//! Building libraries on all cores.

use std::str::FromStr;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use fluoropose::camera::Camera;
use fluoropose::camera::calibration::Calibration;
use fluoropose::canonical::CanonicalSpec;
use fluoropose::library::{BuildError, Builder, Grid, GridAxis, ViewScratch};
use fluoropose::mesh::Model;
use fluoropose::render::Projected;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

/// Where the object is expected when nothing says so: this part of the way from the focus to
/// the detector, as in a usual knee study.
const USUAL_DEPTH: f64 = 0.9;
/// The same where the calibration does not tell the detector's distance, mm.
const USUAL_DISTANCE_MM: f64 = 1000.0;

/// A range of rotations, `first:last:step` in degrees.
#[derive(Clone, Copy, Debug)]
pub struct Range(pub GridAxis);

impl FromStr for Range {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let numbers: Result<Vec<f64>, _> = text.split(':').map(str::parse).collect();
        let numbers = numbers.with_context(|| format!("'{text}' is not first:last:step"))?;
        let &[first, last, step] = numbers.as_slice() else {
            bail!("'{text}' is not first:last:step");
        };
        let steps = (last - first) / step;
        if !(step > 0.0 && (0.0..4096.0).contains(&steps)) {
            bail!("'{text}': the step must be positive and lead from first to last");
        }
        Ok(Self(GridAxis {
            first,
            step,
            count: (steps + 1e-9) as usize + 1,
        }))
    }
}

/// A pair of numbers, `x,y`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pair(pub [f64; 2]);

impl FromStr for Pair {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        match numbers
            .with_context(|| format!("'{text}' is not x,y"))?
            .as_slice()
        {
            &[x, y] => Ok(Self([x, y])),
            _ => bail!("'{text}' is not x,y"),
        }
    }
}

/// The camera of a calibration for frames of a size; a camera matrix has its own.
///
/// # Errors
/// Those of [`Calibration::camera`].
pub fn camera_for(calibration: &Calibration, Pair([width, height]): Pair) -> Result<Camera> {
    let (width, height) = match *calibration {
        Calibration::CameraMatrix { size, .. } => size,
        _ => (width as usize, height as usize),
    };
    Ok(calibration.camera(width, height)?)
}

/// Which views a library holds.
#[derive(clap::Args, Clone, Copy, Debug)]
pub struct ViewOptions {
    /// Rotations about x and y of the nominal view, degrees: the ranges below are about it
    #[arg(
        long,
        value_name = "X,Y",
        default_value = "0,0",
        allow_hyphen_values = true
    )]
    pub nominal: Pair,
    /// Rotations about x, degrees, as first:last:step
    #[arg(long, default_value = "-15:15:1", allow_hyphen_values = true)]
    pub x: Range,
    /// Rotations about y, degrees, as first:last:step
    #[arg(long, default_value = "-20:20:1", allow_hyphen_values = true)]
    pub y: Range,
    /// Distance from the focus to the object in the views, mm [default: 0.9 of the principal
    /// distance, or 1000 where the calibration does not tell it]
    #[arg(long, value_name = "MM")]
    pub distance: Option<f64>,
    /// Area of a canonical silhouette, pixels
    #[arg(long, value_name = "PX", default_value_t = 15_000)]
    pub area: u32,
    /// Side of the canonical frame, pixels; a multiple of 32
    #[arg(long, value_name = "PX", default_value_t = 256)]
    pub size: usize,
}

impl Default for ViewOptions {
    fn default() -> Self {
        let grid = Grid::default();
        Self {
            nominal: Pair::default(),
            x: Range(grid.x),
            y: Range(grid.y),
            distance: None,
            area: CanonicalSpec::default().area(),
            size: CanonicalSpec::default().size(),
        }
    }
}

impl ViewOptions {
    /// The grid about the nominal view.
    pub fn grid(&self) -> Grid {
        let Pair([x, y]) = self.nominal;
        Grid {
            x: self.x.0.shifted(x),
            y: self.y.0.shifted(y),
        }
    }

    /// The distance asked for, or the usual one for a calibration, mm.
    pub fn distance_for(&self, calibration: &Calibration) -> f64 {
        let usual = calibration
            .principal_distance()
            .map_or(USUAL_DISTANCE_MM, |distance| USUAL_DEPTH * distance);
        self.distance.unwrap_or(usual)
    }
}

/// A finished library and how long it took.
pub struct Built {
    /// The library's bytes.
    pub bytes: Vec<u8>,
    /// Wall time.
    pub took: Duration,
}

/// A progress bar that counts `what`.
pub fn progress(length: usize, what: &str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {elapsed} (left {eta})")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length as u64)
        .with_style(style)
        .with_message(what.to_owned())
}

/// Renders all views of a mesh on all cores.
///
/// # Errors
/// Those of the core's builder.
pub fn build_library(
    mesh: Model<'_>,
    camera: Camera,
    options: &ViewOptions,
    distance: f64,
) -> Result<Built> {
    let start = Instant::now();
    let canonical = CanonicalSpec::new(options.size, options.area)?;
    let builder = Builder::new(mesh, camera, canonical, options.grid(), distance)?;
    let bar = progress(builder.views(), "views");
    let memory = || {
        (
            vec![Projected::default(); builder.projected_needed()],
            vec![0; builder.render_words_needed()],
            vec![0; canonical.words_needed()],
            vec![0; builder.packed_most()],
        )
    };
    let pack = |(projected, render, canonical, out): &mut (Vec<_>, Vec<_>, Vec<_>, Vec<u8>),
                view| {
        let mut scratch = ViewScratch {
            projected,
            render,
            canonical,
        };
        bar.inc(1);
        let length = builder.pack_view(view, &mut scratch, out)?;
        Ok::<_, BuildError>(out[..length].to_vec())
    };
    let views = (0..builder.views()).into_par_iter();
    let packed = views
        .map_init(memory, pack)
        .collect::<Result<Vec<_>, _>>()?;
    let packed: Vec<&[u8]> = packed.iter().map(Vec::as_slice).collect();
    let assembly = builder.assemble(&packed)?;
    let mut bytes = vec![0; assembly.bytes_needed()];
    assembly.write(&mut vec![0; canonical.words_needed()], &mut bytes)?;
    bar.finish_and_clear();
    Ok(Built {
        bytes,
        took: start.elapsed(),
    })
}

//! Building libraries on all cores.

use std::time::{Duration, Instant};

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::canonical::CanonicalSpec;
use fluoropose::library::{BuildError, Builder, ViewGrid, ViewScratch};
use fluoropose::mesh::{Model, coarser};
use fluoropose::render::Projected;
use rayon::prelude::*;

use super::views::ViewOptions;
use crate::progress::progress;

/// A finished library and how long it took.
pub struct Built {
    /// The library's bytes.
    pub bytes: Vec<u8>,
    /// Wall time.
    pub took: Duration,
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
    build_views(mesh, camera, options.canonical()?, options.grid(), distance)
}

/// The same of any grid of views in any canonical frame.
///
/// # Errors
/// Those of the core's builder.
pub fn build_views(
    mesh: Model<'_>,
    camera: Camera,
    canonical: CanonicalSpec,
    grid: ViewGrid,
    distance: f64,
) -> Result<Built> {
    let start = Instant::now();
    let builder = Builder::new(mesh, camera, canonical, grid, distance)?;
    let coarse = coarser(&mesh, builder.detail_mm());
    let builder = match &coarse {
        Some(coarse) => Builder::standing_for(*builder.info(), coarse.as_model())?,
        None => builder,
    };
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

//! Verb `models`: writes the built-in implants as STL.

use crate::options::sides;
use anyhow::{Context, Result};
use fluoropose_phantom::implant::{self, Parameters, SIZES_MM, Side, Size, check};
use fluoropose_phantom::stl;
use std::fs;
use std::path::PathBuf;

/// Options of `models`.
#[derive(clap::Args)]
#[command(
    after_help = "Writes DIR/femur.stl and DIR/tibia.stl: binary, watertight, in mm. Axes of a left part: x anterior, y proximal, \
z to the patient's right (medial), so that an unturned model shows a lateral view. A right part is mirrored in x.\n\n\
Examples:\n  cargo xtask models\n  cargo xtask models --side right --size 3 --out implants\n  \
cargo xtask models --width 72.5 --resolution 2"
)]
pub(crate) struct Args {
    /// Left or right knee
    #[arg(long, value_parser = sides(), default_value = "left")]
    side: Side,
    /// Size number, 1 (58 mm wide) to 8 (81 mm wide)
    #[arg(long, default_value_t = 5, conflicts_with = "width")]
    size: usize,
    /// Mediolateral width in mm, instead of a size number
    #[arg(long, value_name = "MM")]
    width: Option<f64>,
    /// Mesh density, 0.5 to 4: 1 gives a femur of about 12 000 triangles
    #[arg(long, default_value_t = 1.0)]
    resolution: f64,
    /// Folder to write to; made if absent
    #[arg(long, default_value = "models")]
    out: PathBuf,
}

/// Runs the verb.
pub(crate) fn run(args: Args) -> Result<()> {
    let size = match args.width {
        Some(width) => Size::from_width_mm(width)?,
        None => Size::numbered(args.size)?,
    };
    let parameters = Parameters {
        side: args.side,
        size,
        resolution: args.resolution,
    };
    fs::create_dir_all(&args.out)
        .with_context(|| format!("cannot make the folder {}", args.out.display()))?;
    for (name, mesh) in [
        ("femur", implant::femur(&parameters)?),
        ("tibia", implant::tibia(&parameters)?),
    ] {
        let volume = check::closed_volume(&mesh)
            .with_context(|| format!("the {name} cannot be used at this size"))?;
        let path = args.out.join(format!("{name}.stl"));
        stl::write_file(&mesh, &path)?;
        println!(
            "{}: {} {name}, {} mm wide, {} triangles, {:.1} cm^3",
            path.display(),
            args.side,
            size.width_mm(),
            mesh.triangles.len(),
            volume / 1000.0
        );
    }
    println!(
        "sizes in mm: {}",
        SIZES_MM.map(|width| width.to_string()).join(", ")
    );
    Ok(())
}

//! Verb `report`: a study's joint motion as table, files, figure and report.

mod knee;
mod sources;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use fluoropose::joint::COLUMNS;
use fluoropose_report::{Facts, JointFilm, figure, html, write};

use crate::files::{Study, write_text};
use knee::{Filtering, Knee};
use sources::Sources;

/// Options of `report`.
#[derive(clap::Args)]
#[command(
    after_help = "Files in the folder: joint.csv (every number of every frame, with standard deviations and doubts), figure.svg, report.html, \
COMPONENT.jtak and joint.tra (the poses), cycle (a 101-point row of each number, for statistical parametric mapping), and joint.mot where the \
frames a second are known.\n\n\
Poses are COMPONENT.jts in the folder of --poses, as `track` writes them, or without it the study's references. Standard deviations need \
COMPONENT.covariances.csv beside them, and doubts track.csv; `track` writes both.\n\n\
Examples:\n  cargo xtask report --study study.toml --poses tracked --out report\n  \
cargo xtask report --study study.toml --poses tracked --out report --fps 15 --cutoff 3"
)]
pub struct Args {
    /// Study file with the models of a femoral and of a tibial component, and the side
    #[arg(long)]
    study: PathBuf,
    /// Folder of the poses; without it the study's references
    #[arg(long, value_name = "DIR")]
    poses: Option<PathBuf>,
    /// Folder for what is written; made if absent
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Frames a second; without it those that the study states
    #[arg(long, value_name = "HZ")]
    fps: Option<f64>,
    /// Cutoff of a filter whose numbers stand beside the others in joint.csv
    #[arg(long, value_name = "HZ")]
    cutoff: Option<f64>,
}

/// Runs the verb.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn run(args: Args) -> Result<()> {
    let study = Study::read(&args.study)?;
    let sources = Sources::read(&args.study, &study, args.poses.as_deref())?;
    let filtering = Filtering::new(args.fps.or(study.frames_per_s), args.cutoff)?;
    let knee = Knee::new(&study, &sources)?;
    let film = knee.film(&sources, &filtering)?;
    let facts = facts(&knee, &sources);
    std::fs::create_dir_all(&args.out)
        .with_context(|| format!("cannot make the folder {}", args.out.display()))?;
    write_all(&args.out, &film, &sources, &facts)?;
    print(&args.out, &film);
    Ok(())
}

fn write_all(out: &Path, film: &JointFilm, sources: &Sources, facts: &Facts) -> Result<()> {
    write_text(&out.join("joint.csv"), &write::table(film))?;
    write_text(&out.join("figure.svg"), &figure(film))?;
    write_text(&out.join("report.html"), &html(film, facts))?;
    let bodies = [&sources.femur, &sources.tibia];
    for body in bodies {
        let name = out.join(format!("{}.jtak", body.name));
        write_text(&name, &write::jtak(&body.poses))?;
    }
    let poses = bodies.map(|body| body.poses.as_slice());
    write_text(&out.join("joint.tra"), &write::tra(&poses))?;
    if film.frames_per_s.is_some() {
        write_text(&out.join("joint.mot"), &write::mot(film)?)?;
    }
    let cycle = out.join("cycle");
    std::fs::create_dir_all(&cycle).context("cannot make the folder cycle")?;
    for (number, column) in COLUMNS.iter().enumerate() {
        let name = cycle.join(format!("{}.csv", column.name));
        write_text(&name, &write::matrix(&[film], number))?;
    }
    Ok(())
}

fn facts(knee: &Knee, sources: &Sources) -> Facts {
    let mut facts = Facts {
        inputs: sources.inputs.clone(),
        remarks: knee.remarks.clone(),
        ..Facts::default()
    };
    facts.set_axes("femoral", &knee.femur_axes);
    facts.set_axes("tibial", &knee.tibia_axes);
    facts.set("poses", sources.whose.as_str());
    facts
}

fn print(out: &Path, film: &JointFilm) {
    println!(
        "{}: {} of {} frames have a joint, {} are doubtful",
        film.name,
        film.posed(),
        film.rows.len(),
        film.doubtful()
    );
    for told in film.impossibilities() {
        println!("{told}");
    }
    if !film.has_deviations() {
        println!("no standard deviations: the poses come without covariances");
    }
    if film.frames_per_s.is_none() {
        println!("no joint.mot: it needs times (--fps, or frames_per_s in the study)");
    }
    println!("{}", out.join("report.html").display());
}

#[cfg(test)]
mod tests;

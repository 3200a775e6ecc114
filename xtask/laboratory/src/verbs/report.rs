//! Verb `report`: a study's joint motion as table, files, figure and report.

mod group;
pub mod knee;
mod out;
mod overlay;
pub mod sources;

use std::path::{Path, PathBuf};

use anyhow::Result;
use fluoropose::mesh::anatomy::AnatomicalAxes;
use fluoropose_report::{Facts, JointFilm, ORIGINS, figure, html, write};

use crate::exit;
use crate::files::{Study, stated_frames_per_s, write_figure, write_text};
use crate::finding::say_axes;
use crate::options::{above_0, of_body, study_files};
use knee::{Filtering, Knee};
use out::{make_folder, write_cycles};
use sources::Sources;

/// Options of `report`.
#[derive(clap::Args)]
#[command(
    after_help = "Files in the folder: joint.csv (every number of every frame, with standard deviations and doubts), the figure (figure.svg, .pdf and .png), report.html, \
COMPONENT.jtak and joint.tra (the poses), cycle (a 101-point row of each number, for statistical parametric mapping), and joint.mot where the \
frames a second are known. With --overlay a folder overlay of the frames with both outlines laid on and the curves beside, a PNG for each frame, and \
the film of them, overlay.webm, 10 pictures a second where nobody said how many.\n\n\
Poses are COMPONENT.jts in the folder of --poses, as `track` writes them, or without it the study's references. Standard deviations need \
COMPONENT.covariances.csv beside them, doubts and checks track.csv: `track` writes them, and the page packs them (Poses, For commands); of masks `pose` writes the former, and `pose --report COMPONENT.csv` verdicts.\n\n\
Of a group, which is made from the joint.csv of several reports: group.csv (mean and standard deviation over knees at steps of 10 degrees of \
flexion, each knee first), the figure (figure.svg, .pdf and .png), and cycle (a row a film).\n\n\
Examples:\n  cargo xtask report --study study.toml --poses tracked --out report\n  \
cargo xtask report --study study.toml --poses tracked --out report --fps 15 --cutoff 3 --overlay\n  \
cargo xtask report --group p1=a/joint.csv p1=b/joint.csv p2=c/joint.csv --out group"
)]
pub struct Args {
    /// Study file, or its folder, with the models of a femoral and of a tibial component, and the side
    #[arg(long, required_unless_present = "group", value_parser = study_files())]
    pub study: Option<PathBuf>,
    /// Instead of a study: knees that are published together, each table joint.csv with the name of its knee; a knee may have several
    #[arg(long, value_name = "KNEE=FILE", num_args = 1.., conflicts_with_all = ["study", "poses", "fps", "cutoff"])]
    pub group: Vec<String>,
    /// Folder of the poses, COMPONENT.jts each, with track.csv, or tables of `pose --report` as COMPONENT.csv, for their verdicts; without it the study's references
    #[arg(long, value_name = "DIR")]
    pub poses: Option<PathBuf>,
    /// Folder for what is written; made if absent
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Frames a second, of the frames at hand, in place of what the study or its DICOM frames state
    #[arg(long, value_name = "HZ", value_parser = above_0)]
    pub fps: Option<f64>,
    /// Cutoff of a filter whose numbers stand beside the others in joint.csv
    #[arg(long, value_name = "HZ", value_parser = above_0)]
    pub cutoff: Option<f64>,
    /// Also the frames with outlines and curves, as pictures and as a film; the study has to name its frames
    #[arg(long, conflicts_with = "group")]
    pub overlay: bool,
}

/// Runs the verb; the code to exit with.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn run(args: Args) -> Result<u8> {
    let Some(study) = &args.study else {
        return group::run(&args.group, &args.out).map(|()| 0);
    };
    let Reported {
        film,
        axes,
        remarks,
    } = report(study, &args)?;
    remarks.iter().for_each(|remark| eprintln!("{remark}"));
    for (name, axes) in ["femoral", "tibial"].into_iter().zip(&axes) {
        say_axes(name, axes);
    }
    print(&args.out, &film);
    if film.posed() == 0 {
        eprintln!(
            "no frame has poses of both components: there are no numbers of a joint in these files"
        );
        return Ok(exit::NOTHING_FOUND);
    }
    Ok(match film.impossibilities().is_empty() {
        true => 0,
        false => exit::DOUBTFUL,
    })
}

/// What the files of a study are made from.
pub struct Reported {
    film: JointFilm,
    /// The femoral and the tibial ones, in which its numbers are.
    axes: [AnatomicalAxes; 2],
    /// What a reader of the report has to know.
    remarks: Vec<String>,
}

impl Reported {
    /// Frames whose joint is doubtful, from 0.
    pub fn doubtful_frames(&self) -> impl Iterator<Item = usize> {
        self.film.doubts().map(|(row, _)| row.number - 1)
    }
}

/// Writes the files of a study; what they are made from comes back.
///
/// # Errors
/// As of [`run`].
pub fn report(file: &Path, args: &Args) -> Result<Reported> {
    let study = Study::read(file)?;
    let sources = Sources::read(file, &study, args.poses.as_deref())?;
    let of_files = sources.femur.of_file.iter().chain(&sources.tibia.of_file);
    of_files.for_each(|remark| eprintln!("{remark}"));
    let filtering = Filtering::new(frames_per_s(args.fps, &study), args.cutoff)?;
    let knee = Knee::new(&study.name, of_body(study.known_side()?), &sources)?;
    let film = knee.film(&sources, &filtering)?;
    let facts = facts(&knee, &sources);
    make_folder(&args.out)?;
    write_all(&args.out, &film, &sources, &facts)?;
    if args.overlay {
        overlay::write(&args.out, &study, &film, &sources)?;
    }
    let axes = [knee.femur_axes, knee.tibia_axes];
    Ok(Reported {
        film,
        axes,
        remarks: knee.remarks,
    })
}

/// What is told of a study's joint that no knee has, by the poses in a folder; nothing where the study does not have one joint.
pub fn impossible(file: &Path, poses: &Path) -> Vec<String> {
    let film = || -> Result<JointFilm> {
        let study = Study::read_quietly(file)?;
        let sources = Sources::read(file, &study, Some(poses))?;
        let knee = Knee::new(&study.name, of_body(study.known_side()?), &sources)?;
        knee.film(&sources, &Filtering::new(None, None)?)
    };
    film().map_or_else(|_| Vec::new(), |film| film.impossibilities())
}

/// Frames a second as a study states them, or as its frames do.
pub fn own_frames_per_s(study: &Study) -> Option<f64> {
    // Frames that are not at hand tell no times.
    let of_frames = |folder: &PathBuf| stated_frames_per_s(folder).unwrap_or_default();
    study
        .frames_per_s
        .or_else(|| study.frames.as_ref().and_then(of_frames))
}

/// As asked for, or as the study or its frames state it. What is asked for against these is said.
fn frames_per_s(asked: Option<f64>, study: &Study) -> Option<f64> {
    let stated = own_frames_per_s(study);
    if let (Some(asked), Some(stated)) = (asked, stated)
        && asked != stated
    {
        eprintln!("{asked} frames a second, as --fps says; the study or its frames state {stated}");
    }
    asked.or(stated)
}

fn write_all(out: &Path, film: &JointFilm, sources: &Sources, facts: &Facts) -> Result<()> {
    write_text(&out.join("joint.csv"), &write::table(film))?;
    write_figure(out, "figure", &figure(film))?;
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
    write_cycles(out, &[film])
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
    for (component, words) in &sources.film {
        facts.set(&format!("film, {component}"), words.as_str());
    }
    facts
}

fn print(out: &Path, film: &JointFilm) {
    println!(
        "{}: {} of {} frames have a joint, {}",
        film.name,
        film.posed(),
        film.rows.len(),
        film.doubtful_told()
    );
    let verdicts = film.verdicts_told();
    let told = film.impossibilities().into_iter().chain(verdicts);
    for told in told.chain(film.origins_told()) {
        println!("{told}");
    }
    println!("translations: {ORIGINS}");
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

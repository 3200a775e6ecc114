//! Verb `disguise`: a study's film as others would have taken it, with its truth; and how it is followed then.

mod clicks;
mod draw;
mod frame_file;
mod lens;
mod marks;
mod mesh;
mod picture;
mod plan;
mod possible;
mod words;
mod write;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use crate::files::{Component, Film, Study, check_outputs, read_text, write_json};
use crate::options::{Seeds, at_least_1, study_files};
use crate::verbs::compare::COLUMNS;
use crate::verbs::measured_film::{HEADING, Words, follow};

pub use lens::{Axes, Lens};
pub use plan::{Curve, Field, Frames, Kind, Marks, Mesh, Models, Plan, Tone, View};
pub use write::disguise;

/// Options of `disguise`.
#[derive(clap::Args)]
#[command(
    after_help = format!("What holds only on the data at hand is not done. A seed draws how the same film would come from elsewhere: frames turned, mirrored, of another size and cut, so that the \
principal point moves; other grey values, noise, blur, fields, words burnt in; every n-th frame, backwards, under other names, in other formats; models in other axes, formats and windings. Frames \
and models are mirrored together, and the side changes. What was drawn is printed, and stands in DIR/disguise.toml, which --as reads, changed or not; what is left out there stays as it is.\n\n\
Files in the folder: study.toml, calibration.txt, frames, COMPONENT.jts (the references in the new axes), the models, and masks of the components at these poses.\n\n\
--track follows the film, without a click or with --click from a drawn place within each component, and prints a row for each component: {COLUMNS} CPU s is the processor time of all of it.\n\n\
Examples:\n  cargo xtask disguise --study study.toml --out other --seed 7\n  cargo xtask disguise --study study.toml --out others --seed 1..12 --track --json rows.json")
)]
pub struct Args {
    /// Study file, or its folder
    #[arg(long, value_parser = study_files())]
    study: PathBuf,
    /// Folder to write to; of several seeds each has a folder there
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// What draws the disguise; A..B for all from A to B
    #[arg(long, value_name = "N", required_unless_present = "stated")]
    seed: Option<Seeds>,
    /// The disguise, as a disguise.toml states it
    #[arg(long = "as", value_name = "FILE", conflicts_with = "seed")]
    stated: Option<PathBuf>,
    /// Only this component
    #[arg(long, value_name = "COMPONENT")]
    only: Option<String>,
    /// At most so many frames
    #[arg(long, value_name = "N", value_parser = at_least_1)]
    frames: Option<usize>,
    /// Follow each film, and compare it with its truth
    #[arg(long)]
    track: bool,
    /// Follow from a click into each component
    #[arg(long, requires = "track")]
    click: bool,
    /// Write the rows as JSON
    #[arg(long, value_name = "FILE", requires = "track")]
    json: Option<PathBuf>,
}

/// Runs the verb.
///
/// # Errors
/// For files that are missing, unreadable or do not belong together.
pub fn run(args: Args) -> Result<()> {
    check_outputs(
        &[("--json", args.json.as_deref())],
        [Some(&*args.study), args.stated.as_deref()],
    )?;
    // What it says of its keys is said once, however many seeds there are.
    let study = Study::read(&args.study)?;
    let is_known = |one: &Component| {
        one.reference.is_some() && args.only.as_ref().is_none_or(|only| *only == one.name)
    };
    ensure!(
        !args.track || study.components.iter().any(is_known),
        "--track compares with the truth, and no component of {} that is asked for has a reference: name the file of its poses",
        args.study.display()
    );
    let mut rows = Vec::new();
    if args.track {
        println!("{HEADING}");
    }
    for (plan, out) in plans(&args)? {
        disguise(&args.study, &plan, &out)?;
        match args.track {
            false => println!("{}: {plan}", out.display()),
            true => {
                let clicks = match args.click {
                    true => clicks::within_each(&out, plan.seed)?,
                    false => Vec::new(),
                };
                let film = Words::Disguise(plan.to_string());
                let measured = follow(&out, clicks, plan.seed, &film);
                rows.extend(measured.with_context(|| out.display().to_string())?);
                // Hours of work are kept where a later one ends it.
                write_json(args.json.as_deref(), &rows)?;
            }
        }
    }
    Ok(())
}

/// What is asked for, each with its folder.
fn plans(args: &Args) -> Result<Vec<(Plan, PathBuf)>> {
    let mut plans = Vec::new();
    if let Some(file) = &args.stated {
        let plan = toml::from_str(&read_text(file)?);
        plans.push((
            plan.with_context(|| file.display().to_string())?,
            args.out.clone(),
        ));
    }
    if let Some(seeds) = &args.seed {
        let (count, size) = size_of(&args.study)?;
        let drawn = |(seed, folder)| (Plan::drawn(seed, count, size), folder);
        plans.extend(seeds.folders(&args.out).map(drawn));
    }
    for (plan, _) in &mut plans {
        plan.frames.count = args.frames.unwrap_or(plan.frames.count);
        if args.only.is_some() {
            plan.models.only.clone_from(&args.only);
        }
    }
    Ok(plans)
}

/// Number and size of a study's frames.
fn size_of(study: &Path) -> Result<(usize, (usize, usize))> {
    let film = Film::read(Study::read_quietly(study)?.frames_folder()?)?;
    Ok((film.count(), film.size()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_draws_the_same_again_and_a_file_states_it_whole() {
        let mut words = std::collections::BTreeSet::new();
        for seed in 0..50 {
            let plan = Plan::drawn(seed, 61, (1024, 1024));
            assert_eq!(plan, Plan::drawn(seed, 61, (1024, 1024)));
            let read: Plan = toml::from_str(&toml::to_string(&plan).unwrap()).unwrap();
            assert_eq!(read, plan);
            words.insert(plan.to_string());
        }
        assert_eq!(words.len(), 50);
        assert_eq!(toml::from_str::<Plan>("").unwrap(), Plan::default());
    }
}

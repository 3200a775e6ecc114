//! Verb `collect`: the results of a batch put together, knee first and then group.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use fluoropose_report::cell::{plain, quoted};
use fluoropose_report::cohorts::{figure, table};
use fluoropose_report::levels::FilmLevels;
use fluoropose_report::{Group, Knee, counted, read};

use crate::exit;
use crate::files::{PoseRows, Study, csv_fields, read_text, write_figure, write_text};
use crate::verbs::batch::{Entry, JOINT, Manifest, failure_of, read_list};

/// Options of `collect`.
#[derive(clap::Args)]
#[command(
    after_help = "Of the list's studies that `batch` has done: groups.csv (each knee's mean over its films at steps of 10 degrees of flexion, and, \
where the column knee says `mean of the group`, each group's mean and standard deviation over its knees: a knee counts once however many films it has), groups.svg, groups.pdf and groups.png, and doubtful.csv (every frame \
that is not good, with its reason). Doubtful frames are in none of the means.\n\n\
It exits with 0 where all studies of the list are in it, and with 6 where some have no results (not done, failed, or of another study, calibration or other clicks than the list names now: which, and why, is told): what \
the others give is written then. With 1 and 2 nothing is written.\n\n\
Example:\n  cargo xtask collect studies.csv --results results --out group"
)]
pub struct Args {
    /// List of studies (CSV), as of `batch`: with the columns knee and group
    list: PathBuf,
    /// Folder of results, as `batch` wrote it
    #[arg(long, value_name = "DIR")]
    results: PathBuf,
    /// Folder for what is written; made if absent
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Put results of different versions or settings together all the same
    #[arg(long)]
    mixed: bool,
}

/// A study's results.
struct Done<'e> {
    entry: &'e Entry,
    manifest: Manifest,
}

/// Runs the verb; the code to exit with.
///
/// # Errors
/// For files that cannot be read or written, results of different versions or settings, and no results.
pub fn run(args: Args) -> Result<u8> {
    let entries = read_list(&args.list)?;
    let (mut done, mut missing) = (Vec::new(), Vec::new());
    for entry in &entries {
        match Manifest::read(&args.results.join(&entry.name))? {
            Some(manifest) if is_of(&manifest, entry)? => done.push(Done { entry, manifest }),
            Some(_) => missing.push((entry.name.as_str(), Some(OF_OTHERS.to_owned()))),
            None => missing.push((entry.name.as_str(), failure_of(&args.results, &entry.name))),
        }
    }
    if done.is_empty() {
        let why = missing
            .iter()
            .find_map(|(name, why)| Some((name, why.as_ref()?)));
        let why = why.map_or(String::new(), |(name, why)| format!("; {name}: {why}"));
        bail!(
            "{} holds no results of these studies{why}",
            args.results.display()
        );
    }
    if !args.mixed {
        alike(&done)?;
    }
    for one in &done {
        check_order(one.entry, &args.results)?;
    }
    check_once(done.iter().map(|one| one.entry))?;
    let groups = groups(&done, &args.results)?;
    if let Some(fault) = groups.iter().flat_map(Group::knees).find_map(Knee::fault) {
        bail!("{fault}: name each knee in the list");
    }
    let doubtful = doubtful(&done, &args.results)?;
    std::fs::create_dir_all(&args.out)
        .with_context(|| format!("cannot make the folder {}", args.out.display()))?;
    write_text(&args.out.join("groups.csv"), &table(&groups))?;
    write_figure(&args.out, "groups", &figure(&groups))?;
    write_text(&args.out.join("doubtful.csv"), &doubtful)?;
    for group in &groups {
        println!("{}: {}", group.name, counted(group.knees().len(), "knee"));
        for told in group.told() {
            println!("{}: {told}", group.name);
        }
    }
    match doubtful.lines().count() - 1 {
        1 => println!("1 frame is not good"),
        more => println!("{more} frames are not good"),
    }
    if missing.is_empty() {
        return Ok(0);
    }
    println!(
        "{} of {} studies have no results",
        missing.len(),
        entries.len()
    );
    for (name, why) in missing {
        println!("{name}: {}", why.as_deref().unwrap_or("not done"));
    }
    Ok(exit::NOT_DONE)
}

/// Why results are left out that another study gave, or this one with other clicks.
const OF_OTHERS: &str = "the list names another study than its results are of, or its file, calibration or clicks have changed: do it again with batch";

/// Whether results are those of the study that the list names, as far as that is at hand.
fn is_of(manifest: &Manifest, entry: &Entry) -> Result<bool> {
    let study = Study::read_quietly(&entry.study);
    let study = study.ok().filter(|study| study.calibration.is_file());
    study.map_or(Ok(true), |study| manifest.inputs.are_of(entry, &study))
}

/// Refuses results whose rows are not of the frames as they stand now, as far as these are at hand: films that were followed in another order
/// were followed wrongly.
fn check_order(entry: &Entry, results: &Path) -> Result<()> {
    let Ok(study) = Study::read_quietly(&entry.study) else {
        return Ok(());
    };
    let folder = results.join(&entry.name);
    let other = PoseRows::of(&folder, study.frames.as_deref());
    let other = other.with_context(|| format!("the study {}", entry.name))?;
    ensure!(
        other.is_none(),
        "the study {}: its frames stood in another order when {} was written: do it again with batch",
        entry.name,
        folder.display()
    );
    Ok(())
}

/// Refuses a film that counts twice: a study under two names, as far as it is at hand.
fn check_once<'e>(entries: impl Iterator<Item = &'e Entry>) -> Result<()> {
    let mut known: BTreeMap<PathBuf, &str> = BTreeMap::new();
    for entry in entries {
        let place = entry.study.canonicalize();
        let before = place
            .ok()
            .and_then(|place| known.insert(place, &entry.name));
        if let Some(before) = before {
            bail!(
                "the studies {before} and {} are one, {}: a film counts once",
                entry.name,
                entry.study.display()
            );
        }
    }
    Ok(())
}

/// Refuses what was not made by one program in one way.
fn alike(done: &[Done<'_>]) -> Result<()> {
    let ways: BTreeSet<String> = done
        .iter()
        .map(|one| {
            format!(
                "version {}, {:?}",
                one.manifest.inputs.version, one.manifest.inputs.settings
            )
        })
        .collect();
    ensure!(
        ways.len() == 1,
        "the results were made in different ways: do them again with batch, or say --mixed:\n  {}",
        ways.into_iter().collect::<Vec<_>>().join("\n  ")
    );
    ensure!(
        done.iter()
            .all(|one| !one.manifest.inputs.settings.rehearsal),
        "these are results of a rehearsal: nothing was looked for"
    );
    Ok(())
}

/// In the order of names, so that the list's order does not matter.
fn groups(done: &[Done<'_>], results: &Path) -> Result<Vec<Group>> {
    let mut films: BTreeMap<&str, BTreeMap<&str, Vec<FilmLevels>>> = BTreeMap::new();
    let mut whose: BTreeMap<&str, &str> = BTreeMap::new();
    let mut sorted: Vec<&Done<'_>> = done.iter().collect();
    sorted.sort_by_key(|one| &one.entry.name);
    for Done { entry, .. } in sorted {
        let path = results.join(&entry.name).join(JOINT);
        if !path.is_file() {
            eprintln!("{}: no joint, because it has no two components", entry.name);
            continue;
        }
        let before = whose.insert(&entry.knee, &entry.group);
        if before.is_some_and(|before| before != entry.group) {
            bail!("the knee {} is in two groups", entry.knee);
        }
        let film =
            read::film(&read_text(&path)?).with_context(|| format!("in {}", path.display()))?;
        let knees = films.entry(&entry.group).or_default();
        let own = knees.entry(&entry.knee).or_default();
        // Films themselves would fill the memory by the thousand.
        own.push(FilmLevels::of(&film));
    }
    let group = |(name, knees): (&str, BTreeMap<&str, Vec<FilmLevels>>)| {
        let knee = |(name, films): (&str, Vec<FilmLevels>)| Knee {
            name: name.to_owned(),
            films,
        };
        Group::new(name.to_owned(), knees.into_iter().map(knee).collect())
    };
    Ok(films.into_iter().map(group).collect())
}

/// What is not good of all studies, a row each.
fn doubtful(done: &[Done<'_>], results: &Path) -> Result<String> {
    let mut out = String::from("study,frame,component,state,verdict,because\n");
    for Done { entry, .. } in done {
        let folder = results.join(&entry.name);
        let named = quoted(plain(&entry.name));
        for row in not_good(&folder)? {
            out.push_str(&format!("{named},{row}\n"));
        }
    }
    Ok(out)
}

/// The rows of a study's `track.csv` that are not good, and its joints that are doubtful though no pose of their frame is.
fn not_good(folder: &Path) -> Result<Vec<String>> {
    let path = folder.join("track.csv");
    let (mut rows, mut told) = (Vec::new(), BTreeSet::new());
    for line in read_text(&path)?.lines().skip(1) {
        let fields = csv_fields(line);
        let [frame, component, state, verdict, because, ..] = fields.as_slice() else {
            bail!("{}: a row is cut off", path.display());
        };
        if verdict != "good" {
            let [component, because] = [component, because].map(|text| quoted(plain(text)));
            rows.push(format!("{frame},{component},{state},{verdict},{because}"));
            told.insert(frame.clone());
        }
    }
    let joint = folder.join(JOINT);
    if !joint.is_file() {
        return Ok(rows);
    }
    let film = read::film(&read_text(&joint)?);
    let film = film.with_context(|| format!("in {}", joint.display()))?;
    for (row, doubt) in film.doubts() {
        let frame = row.number.to_string();
        if !told.contains(&frame) {
            let because = quoted(plain(doubt));
            rows.push(format!("{frame},\"joint\",,doubtful,{because}"));
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use fluoropose::Side;
    use fluoropose::joint::JointFrame;
    use fluoropose::joint::numbers::NUMBERS;
    use fluoropose::joint::shared::ERRORS;
    use fluoropose_report::{JointFilm, JointRow, write};

    use super::*;
    use crate::verbs::batch::{Inputs, Settings};

    #[test]
    fn results_of_another_order_of_frames_are_refused() {
        let place = std::env::temp_dir().join(format!("fluoropose-others-{}", std::process::id()));
        let write = |name: &str, text: &str| {
            let path = place.join(name);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            std::fs::write(path, text).expect("a file");
        };
        write(
            "k/study.toml",
            "name = 'k'\ncalibration = 'c.txt'\nframes = 'frames'\n[[component]]\nname = 'femur'\nmodel = 'f.stl'\n",
        );
        for name in ["f1.png", "f2.png", "f10.png"] {
            write(&format!("k/frames/{name}"), "");
        }
        write("list.csv", "study\nk\n");
        let entry = &read_list(&place.join("list.csv")).expect("a list")[0];
        let results = place.join("results");
        let check = |files: [&str; 3]| {
            let row = |(row, name): (i32, &str)| format!("{row},femur,followed,good,,{name}\n");
            let rows: String = (1..).zip(files).map(row).collect();
            let table = format!("frame,component,state,verdict,because,file\n{rows}");
            write("results/k/track.csv", &table);
            check_order(entry, &results)
        };
        check(["f1.png", "f2.png", "f10.png"]).expect("the same order");
        let told = check(["f1.png", "f10.png", "f2.png"]).expect_err("by letters");
        std::fs::remove_dir_all(&place).expect("it was there");
        assert!(
            told.to_string().contains("do it again with batch"),
            "{told}"
        );
    }

    /// A list whose names went to other studies, or whose clicks were mended.
    #[test]
    fn results_of_another_study_than_the_list_names_are_none_of_its_own() {
        let place = std::env::temp_dir().join(format!("fluoropose-whose-{}", std::process::id()));
        for name in ["a", "b"] {
            let folder = place.join(name);
            std::fs::create_dir_all(&folder).expect("a folder");
            let study = format!(
                "name = '{name}'\ncalibration = 'c.txt'\n[[component]]\nname = 'femur'\nmodel = 'f.stl'\n"
            );
            std::fs::write(folder.join("study.toml"), study).expect("a file");
            std::fs::write(folder.join("c.txt"), "JT_INTCALIB\n1000\n0\n0\n0.3\n").expect("a file");
        }
        let digest = |file: &str| {
            let bytes = std::fs::read(place.join(file)).expect("a file");
            crate::files::sha256(&bytes)
        };
        let sha256 = [("study", "a/study.toml"), ("calibration", "a/c.txt")];
        let manifest = Manifest {
            name: "a".to_owned(),
            inputs: Inputs {
                version: String::new(),
                settings: Settings::default(),
                clicks: vec!["click femur:1:5,6".to_owned()],
                sha256: sha256
                    .map(|(what, file)| (what.to_owned(), digest(file)))
                    .into(),
                frames: (0, 0),
            },
            frames: 0,
            doubtful: 0,
            outputs: BTreeMap::new(),
        };
        let is_of_row = |row: &str| {
            let list = place.join("list.csv");
            std::fs::write(&list, format!("name,study,click\n{row}\n")).expect("a file");
            is_of(&manifest, &read_list(&list).expect("a list")[0]).expect("files")
        };
        assert!(is_of_row("a,a,\"femur:1:5,6\""));
        assert!(!is_of_row("a,b,\"femur:1:5,6\""));
        assert!(!is_of_row("a,a,\"femur:1:50,60\"") && !is_of_row("a,a,"));
        // What is not at hand tells nothing.
        assert!(is_of_row("a,elsewhere,"));
        std::fs::write(place.join("a/c.txt"), "JT_INTCALIB\n1000\n0\n0\n0.4\n").expect("a file");
        assert!(!is_of_row("a,a,\"femur:1:5,6\""));
        std::fs::remove_dir_all(&place).expect("it was there");
    }

    #[test]
    fn a_film_under_two_names_is_refused() {
        let place = std::env::temp_dir().join(format!("fluoropose-twice-{}", std::process::id()));
        for name in ["a", "b"] {
            std::fs::create_dir_all(place.join(name)).expect("a folder");
            std::fs::write(place.join(name).join("study.toml"), "").expect("a file");
        }
        let check = |rows: &str| {
            let list = place.join("list.csv");
            std::fs::write(&list, format!("study,name\n{rows}")).expect("a file");
            let list = read_list(&list).expect("a list");
            check_once(list.iter()).map_err(|error| error.to_string())
        };
        assert_eq!(check("a,first\nb,second\n"), Ok(()));
        // What is not at hand tells nothing.
        assert_eq!(check("gone,first\ngone,second\n"), Ok(()));
        let told = check("a,first\nb/../a/study.toml,second\n").expect_err("one film");
        std::fs::remove_dir_all(&place).expect("it was there");
        assert!(
            told.contains("the studies first and second are one"),
            "{told}"
        );
    }

    #[test]
    fn a_joint_that_no_knee_has_is_told_though_its_poses_are_good() {
        let folder = std::env::temp_dir().join(format!("fluoropose-joints-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let track = "frame,component,state,verdict,because\n1,femur,followed,good,\n2,femur,doubtful,doubtful,\"a rim\"\n3,femur,followed,good,\n";
        std::fs::write(folder.join("track.csv"), track).expect("a file");
        let alone = not_good(&folder).expect("a table");
        assert_eq!(alone, ["2,\"femur\",doubtful,doubtful,\"a rim\""]);
        let joint = JointFrame {
            numbers: [0.0; NUMBERS],
            deviations: None,
            shared: [[0.0; NUMBERS]; ERRORS],
        };
        let row = |number, doubt: Option<&str>| {
            JointRow::new(number, Some(joint), doubt.map(str::to_owned))
        };
        let film = JointFilm {
            name: "k".to_owned(),
            side: Side::Left,
            plate_depth_mm: 0.0,
            plate_width_mm: 0.0,
            plate_outline: Vec::new(),
            frames_per_s: None,
            cutoff_hz: None,
            remarks: Vec::new(),
            has_verdicts: true,
            rows: vec![row(1, None), row(2, Some("a rim")), row(3, Some("80 mm"))],
        };
        std::fs::write(folder.join(JOINT), write::table(&film)).expect("a file");
        let both = not_good(&folder).expect("tables");
        std::fs::remove_dir_all(&folder).expect("it was there");
        assert_eq!(both[1..], ["3,\"joint\",,doubtful,\"80 mm\""]);
    }
}

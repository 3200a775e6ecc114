//! Batches of small synthetic studies, by the program itself: parts, a broken study, a task that is killed, and what is put together.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::thread;
use std::time::{Duration, Instant};

use fluoropose_phantom::implant::Side;
use fluoropose_phantom::sequence::{self, Implants, Options};

/// A folder of its own with two studies of two frames each, and one whose calibration is missing.
struct Studies(PathBuf);

impl Drop for Studies {
    fn drop(&mut self) {
        // What cannot be removed stays in the folder of temporary files.
        let _ = fs::remove_dir_all(&self.0);
    }
}

impl Studies {
    fn make() -> Self {
        let folder = std::env::temp_dir().join(format!("fluoropose-batch-{}", std::process::id()));
        let mut list = String::from("study,knee,group,fixed\n");
        for (name, seed) in [("a", 3), ("b", 4)] {
            let options = Options {
                frames: 4,
                seed,
                pixels: 256,
                implants: Some(Implants::built_in(Side::Left, 0.5).expect("possible")),
                ..Options::default()
            };
            let study = folder.join(name);
            sequence::write(&options, &study).expect("a study");
            keep_two_frames(&study).expect("a shorter film");
            // Known from the start, so that little is to be done; what remains is checked and judged as in any film.
            list.push_str(&format!(
                "{name},knee {name},all,femur={name}/femur.jts;tibia={name}/tibia.jts\n"
            ));
        }
        fs::create_dir_all(folder.join("broken")).expect("a folder");
        let study = fs::read_to_string(folder.join("a/study.toml")).expect("a study");
        fs::write(folder.join("broken/study.toml"), study).expect("a broken study");
        list.push_str("broken,knee c,all,\n");
        fs::write(folder.join("studies.csv"), list).expect("a list");
        Self(folder)
    }

    fn batch(&self, out: &str, options: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fluoropose"));
        command
            .arg("batch")
            .arg(self.0.join("studies.csv"))
            .arg("--out")
            .arg(self.0.join(out))
            .args(options);
        for name in ["ID", "COUNT", "MIN", "STEP"] {
            command.env_remove(format!("SLURM_ARRAY_TASK_{name}"));
        }
        command
    }

    fn collect(&self, out: &str, options: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fluoropose"));
        command
            .arg("collect")
            .arg(self.0.join("studies.csv"))
            .arg("--results")
            .arg(self.0.join(out))
            .arg("--out")
            .arg(self.0.join("group"))
            .args(options);
        command.output().expect("it runs")
    }

    fn results(&self, out: &str, name: &str) -> BTreeMap<String, Vec<u8>> {
        let mut files = BTreeMap::new();
        gather(&self.0.join(out).join(name), "", &mut files);
        assert!(
            files.contains_key("manifest.json"),
            "{out}/{name} is not done"
        );
        files
    }
}

/// Every stage of the work has something to do on two frames. Of four over the whole bend, they are near enough for the joint to be known between them.
fn keep_two_frames(study: &Path) -> std::io::Result<()> {
    for frame in ["frames/0003.png", "frames/0004.png"] {
        fs::remove_file(study.join(frame))?;
    }
    for poses in ["femur.jts", "tibia.jts"] {
        let text = fs::read_to_string(study.join(poses))?;
        let kept: Vec<&str> = text.lines().take(4).collect();
        fs::write(study.join(poses), kept.join("\n"))?;
    }
    Ok(())
}

fn gather(folder: &Path, before: &str, files: &mut BTreeMap<String, Vec<u8>>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = format!(
            "{before}{}",
            path.file_name().expect("a name").to_string_lossy()
        );
        if path.is_dir() {
            gather(&path, &format!("{name}/"), files);
        } else {
            files.insert(name, fs::read(&path).expect("a file"));
        }
    }
}

fn run(mut command: Command) -> (i32, String) {
    let output = command.output().expect("it runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned()
        + &String::from_utf8_lossy(&output.stderr);
    (output.status.code().expect("a code"), text)
}

#[test]
fn parts_and_interrupted_tasks_give_what_one_task_gives() {
    let studies = Studies::make();
    let (code, said) = run(studies.batch("whole", &[]));
    assert_eq!(code, 4, "a broken study stops no other: {said}");
    assert!(said.contains("done 2, failed 1"), "{said}");
    let whole = ["a", "b"].map(|name| studies.results("whole", name));
    assert!(whole[0].contains_key("joint.csv"));
    assert_ne!(whole[0]["femur.jts"], whole[1]["femur.jts"]);
    what_is_given_fits_the_film(&studies);
    what_is_done_is_not_done_again(&studies);
    shards_are_one(&studies, &whole);
    killed_is_uninterrupted(&studies, &whole);
    they_are_put_together(&studies);
}

/// What was pointed at or fixed must be of the film.
fn what_is_given_fits_the_film(studies: &Studies) {
    let track = |words: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fluoropose"));
        command
            .arg("track")
            .arg("--study")
            .arg(studies.0.join("a/study.toml"));
        command
            .arg("--out")
            .arg(studies.0.join("refused"))
            .args(words);
        run(command)
    };
    for (words, why) in [
        (
            ["--click", "femur:1:5000,20"],
            "click femur:1:5000,20: column 5000, row 20 is not on the frame, which has 256 columns and 256 rows",
        ),
        (["--click", "femur:1:20,-3"], "row -3 is not on the frame"),
        (["--click", "femur:1:nan,3"], "nan"),
        (
            ["--click", "tibia:5:20,20"],
            "click tibia:5:20,20: there is no such frame, the film has 2",
        ),
    ] {
        let (code, said) = track(&words);
        assert!(code != 0 && said.contains(why), "{said}");
    }
    let poses = fs::read_to_string(studies.0.join("a/femur.jts")).expect("poses");
    let less: Vec<&str> = poses.lines().take(3).collect();
    let file = studies.0.join("less.jts");
    fs::write(&file, less.join("\n")).expect("poses");
    let (code, said) = track(&["--fixed", &format!("femur={}", file.display())]);
    assert!(
        code == 1 && said.contains("less.jts: there are 1 rows, but the film has 2 frames"),
        "{said}"
    );
    assert!(!studies.0.join("refused/journal.txt").exists());
}

fn what_is_done_is_not_done_again(studies: &Studies) {
    let manifest = studies.0.join("whole/a/manifest.json");
    let written = || {
        fs::metadata(&manifest)
            .and_then(|about| about.modified())
            .expect("a time")
    };
    let before = written();
    let (code, said) = run(studies.batch("whole", &["--only", "unfinished", "--verify"]));
    assert_eq!((code, written()), (4, before), "{said}");
    // What failed is not tried again, so that nothing is said of it but its state.
    assert!(!said.contains("calibration.txt"), "{said}");
    let (_, said) = run(studies.batch("whole", &["--only", "failed"]));
    assert!(said.contains("calibration.txt"), "{said}");
    let (code, said) = run(studies.batch("whole", &["--status", "--partition", "slice:1/3"]));
    assert_eq!(code, 0, "{said}");
    assert!(said.starts_with("a\tdone\t2 frames"), "{said}");
    // Other settings make other results.
    let (code, said) = run(studies.batch("whole", &["--status", "--fps", "15"]));
    assert_eq!((code, said.matches("outdated").count()), (6, 3), "{said}");
}

fn shards_are_one(studies: &Studies, whole: &[BTreeMap<String, Vec<u8>>; 2]) {
    let first = studies.batch("parts", &["--partition", "slice:1/2"]);
    let mut second = studies.batch("parts", &[]);
    for (name, value) in [("ID", "7"), ("COUNT", "2"), ("MIN", "6")] {
        second.env(format!("SLURM_ARRAY_TASK_{name}"), value);
    }
    let beside = thread::spawn(move || run(second));
    let (code, said) = run(first);
    assert_eq!(code, 4, "the broken study is the first part's: {said}");
    let (code, said) = beside.join().expect("it ends");
    assert_eq!(code, 0, "{said}");
    for (name, whole) in ["a", "b"].iter().zip(whole) {
        assert!(studies.results("parts", name) == *whole, "{name} differs");
    }
}

fn killed_is_uninterrupted(studies: &Studies, whole: &[BTreeMap<String, Vec<u8>>; 2]) {
    let only_a = ["--partition", "slice:1/3"];
    let mut child = studies.batch("killed", &only_a).spawn().expect("it runs");
    let journal = studies.0.join("killed/.aside/a/journal.txt");
    let steps = || fs::read_to_string(&journal).map_or(0, |text| text.lines().count());
    let begun = Instant::now();
    while steps() < 2 && begun.elapsed() < Duration::from_secs(120) {
        thread::sleep(Duration::from_millis(2));
    }
    // Signal 9 where there are signals.
    child.kill().expect("it is killed");
    child.wait().expect("it ends");
    assert!(
        !studies.0.join("killed/a").exists(),
        "it was too quick to be killed"
    );
    let (code, said) = run(studies.batch("killed", &["--partition", "slice:1/3", "--status"]));
    // Only where the system tells which processes there are is it known that this one is gone.
    let word = match Path::new("/proc/self").exists() {
        true => "a\tabandoned\tby process",
        false => "a\tclaimed\tby process",
    };
    assert_eq!((code, said.contains(word)), (6, true), "{said}");
    let before = steps();
    assert!(before >= 2, "it was killed before its first step");
    let (code, said) = run(studies.batch("killed", &only_a));
    assert_eq!(code, 0, "{said}");
    assert!(studies.results("killed", "a") == whole[0], "it differs");
    let left = |folder: &str| {
        fs::read_dir(studies.0.join("killed").join(folder))
            .expect("a folder")
            .count()
    };
    assert_eq!((left(".aside"), left(".claims")), (0, 0));
}

fn they_are_put_together(studies: &Studies) {
    let output = studies.collect("whole", &[]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(
        output.status.code(),
        Some(6),
        "one study is missing: {said}"
    );
    assert!(said.contains("all: 2 knees"), "{said}");
    assert!(said.contains("1 of 3 studies have no results"), "{said}");
    assert!(
        said.contains("broken: ") && said.contains("calibration.txt"),
        "{said}"
    );
    let read = |name: &str| fs::read_to_string(studies.0.join("group").join(name)).expect("a file");
    assert!(read("groups.csv").contains("\n\"all\",\"mean of the group\",10,"));
    assert!(read("groups.svg").contains("all (n = 2)"));
    let pdf = fs::read(studies.0.join("group/groups.pdf")).expect("a file");
    assert!(pdf.starts_with(b"%PDF-"));
    let png = fs::read(studies.0.join("group/groups.png")).expect("a file");
    assert!(png.starts_with(b"\x89PNG"));
    assert_eq!(read("doubtful.csv").lines().count(), 1);
    let manifest = studies.0.join("whole/b/manifest.json");
    let text = fs::read_to_string(&manifest).expect("a manifest");
    let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(text.contains(&version));
    fs::write(&manifest, text.replace(&version, "\"version\": \"0.0.0\""))
        .expect("another version");
    let output = studies.collect("whole", &[]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        !output.status.success() && said.contains("--mixed"),
        "{said}"
    );
    assert_eq!(
        studies.collect("whole", &["--mixed"]).status.code(),
        Some(6)
    );
    let list = studies.0.join("studies.csv");
    let text = fs::read_to_string(&list).expect("a list");
    let rows = text.lines().filter(|row| !row.starts_with("broken"));
    fs::write(&list, rows.collect::<Vec<_>>().join("\n")).expect("a list");
    assert_eq!(
        studies.collect("whole", &["--mixed"]).status.code(),
        Some(0)
    );
}

#[test]
fn a_rehearsal_goes_all_the_way_and_finds_nothing() {
    let folder = std::env::temp_dir().join(format!("fluoropose-rehearsal-{}", std::process::id()));
    fs::create_dir_all(folder.join("frames")).expect("a folder");
    fs::write(folder.join("frames/1.png"), "no picture").expect("a frame");
    for name in ["calibration.txt", "femur.stl"] {
        fs::write(folder.join(name), name).expect("a file");
    }
    let study = "name = 'x'\ncalibration = 'calibration.txt'\nframes = 'frames'\n[[component]]\nname = 'femur'\nmodel = 'femur.stl'\n";
    fs::write(folder.join("study.toml"), study).expect("a study");
    let names = (0..20).map(|number| format!("study.toml,s{number}\n"));
    fs::write(
        folder.join("list.csv"),
        String::from("study,name\n") + &names.collect::<String>(),
    )
    .expect("a list");
    let fluoropose = |words: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fluoropose"));
        run({
            command.args(words).current_dir(&folder);
            command
        })
    };
    let (code, said) = fluoropose(&[
        "batch",
        "list.csv",
        "--out",
        "out",
        "--rehearse",
        "--partition",
        "hash:1/1",
    ]);
    assert_eq!(code, 0, "{said}");
    assert!(said.ends_with("20 studies: done 20\n"), "{said}");
    let (code, said) = fluoropose(&["collect", "list.csv", "--results", "out", "--out", "group"]);
    assert_eq!((code, said.contains("rehearsal")), (1, true), "{said}");
    fs::remove_dir_all(folder).expect("it can be removed");
}

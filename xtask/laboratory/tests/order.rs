//! Frames that are numbered without zeros before, and what evaluates and reports them, by the program itself.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use fluoropose_phantom::implant::Side;
use fluoropose_phantom::sequence::{self, Implants, Options};

/// The frames' names, in their order, and the same by letters, as commands took them once.
const NAMES: [&str; 3] = ["f1.png", "f2.png", "f10.png"];
const BY_LETTERS: [usize; 3] = [0, 2, 1];

/// A study of three frames in a folder of its own.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        // What cannot be removed stays in the folder of temporary files.
        let _ = fs::remove_dir_all(&self.0);
    }
}

impl Folder {
    fn new(name: &str) -> Self {
        let name = format!("fluoropose-{name}-{}", std::process::id());
        let folder = Self(std::env::temp_dir().join(name));
        let options = Options {
            frames: NAMES.len(),
            seed: 3,
            pixels: 256,
            implants: Some(Implants::built_in(Side::Left, 0.5).expect("possible")),
            ..Options::default()
        };
        sequence::write(&options, &folder.0).expect("a study");
        for pictures in ["frames", "masks/femur", "masks/tibia"] {
            for (number, name) in (1..).zip(NAMES) {
                let pictures = folder.0.join(pictures);
                let old = pictures.join(format!("{number:04}.png"));
                fs::rename(old, pictures.join(name)).expect("a frame");
            }
        }
        fs::write(folder.0.join("frames/Thumbs.db"), "of Windows").expect("a file");
        folder
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).expect(name)
    }

    /// A folder of the known poses, their rows in an order of the frames, with the table that says so.
    fn poses(&self, name: &str, order: [usize; 3]) {
        let folder = self.0.join(name);
        fs::create_dir_all(&folder).expect("a folder");
        let mut table = String::from("frame,component,state,verdict,because,file,frame_of_file\n");
        for component in ["femur", "tibia"] {
            let known = self.read(&format!("{component}.jts"));
            let lines: Vec<&str> = known.lines().collect();
            let (heading, rows) = lines.split_at(lines.len() - NAMES.len());
            let mut text = format!("{}\n", heading.join("\n"));
            for (row, frame) in (1..).zip(order) {
                text += &format!("{}\n", rows[frame]);
                let name = NAMES[frame];
                table +=
                    &format!("{row},\"{component}\",followed,good,\"of {name}\",\"{name}\",1\n");
            }
            fs::write(folder.join(format!("{component}.jts")), text).expect("poses");
        }
        fs::write(folder.join("track.csv"), table).expect("a table");
    }

    fn run(&self, words: &[&str]) -> (i32, String) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fluoropose"));
        let output = command.args(words).current_dir(&self.0).output();
        let Output {
            status,
            stdout,
            stderr,
        } = output.expect("it runs");
        let said = [stdout, stderr].map(|said| String::from_utf8_lossy(&said).into_owned());
        (status.code().expect("a code"), said.concat())
    }
}

#[test]
fn poses_are_put_to_the_frames_that_their_table_names() {
    let folder = Folder::new("order");
    folder.poses("right", [0, 1, 2]);
    folder.poses("letters", BY_LETTERS);
    let report = |poses: &str| {
        // The study's folder stands for its file.
        let words = ["report", "--study", ".", "--out", poses, "--poses", poses];
        let (code, said) = folder.run(&words);
        assert_eq!(code, 0, "{said}");
        let joint = folder.read(&format!("{poses}/joint.csv"));
        assert!(joint.contains("field_*, gs_*: origins are"), "{joint}");
        (said, joint)
    };
    let (said, right) = report("right");
    assert!(!said.contains("another order"), "{said}");
    let (said, letters) = report("letters");
    assert!(
        said.contains("letters: its rows stand in another order"),
        "{said}"
    );
    assert_eq!(right, letters);
    compared(&folder);

    let table = folder
        .read("letters/track.csv")
        .replace("f10.png", "f12.png");
    fs::write(folder.0.join("letters/track.csv"), table).expect("a table");
    for words in [
        &["report", "--study", ".", "--out", "o", "--poses", "letters"][..],
        &[
            "track",
            "--study",
            ".",
            "--out",
            "o",
            "--fixed",
            "femur=letters/femur.jts",
        ],
    ] {
        let (code, said) = folder.run(words);
        assert!(code == 1 && said.contains("of the file f12.png"), "{said}");
    }
}

/// A pose of the second row, which is of the last frame, is wrong and called doubtful: by frames none is wrong and good.
fn compared(folder: &Folder) {
    let [table, poses] = ["track.csv", "femur.jts"].map(|name| format!("letters/{name}"));
    let good = "2,\"femur\",followed,good,\"of f10.png\"";
    let (states, known) = (folder.read(&table), folder.read(&poses));
    let doubtful = states.replace(good, &good.replace("followed,good", "doubtful,doubtful"));
    assert_ne!(states, doubtful);
    let mut lines: Vec<String> = known.lines().map(str::to_owned).collect();
    let second = lines.len() - NAMES.len() + 1;
    let (x, rest) = lines[second].split_once(',').expect("numbers");
    let moved = x.trim().parse::<f64>().expect("a number") + 20.0;
    lines[second] = format!("{moved},{rest}");
    fs::write(folder.0.join(&table), doubtful).expect("a table");
    fs::write(folder.0.join(&poses), lines.join("\n") + "\n").expect("poses");

    let words = [
        "compare", "--study", ".", "--poses", "letters", "--with", "right",
    ];
    let (code, said) = folder.run(&words);
    assert!(
        code == 0 && !said.contains("wrong and called good"),
        "{said}"
    );
    assert!(
        said.contains("| femur | 3 | 0.00 | 0.00 | 1 | 0 |"),
        "{said}"
    );
    fs::write(folder.0.join(&table), states).expect("a table");
    let (_, said) = folder.run(&words);
    assert!(
        said.contains("femur: wrong and called good in frames 3"),
        "{said}"
    );
    fs::write(folder.0.join(&poses), known).expect("poses");
}

#[test]
fn a_film_is_followed_by_the_frames_numbers() {
    let folder = Folder::new("followed");
    folder.poses("letters", BY_LETTERS);
    let fixed = ["femur", "tibia"].map(|name| format!("{name}=letters/{name}.jts"));
    let words = ["track", "--study", ".", "--out", "out"];
    let fixed = ["--fixed", &fixed[0], "--fixed", &fixed[1]];
    let (code, said) = folder.run(&[&words[..], &fixed].concat());
    assert_eq!(code, 0, "{said}");
    let numbers = |text: String| -> Vec<f64> {
        let cells = text.split([',', '\n']).map(str::trim);
        cells.flat_map(str::parse).collect()
    };
    for name in ["femur.jts", "tibia.jts"] {
        let (found, known) = (folder.read(&format!("out/{name}")), folder.read(name));
        let (found, known) = (numbers(found), numbers(known));
        assert_eq!(found.len(), 6 * NAMES.len());
        let alike = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-4;
        assert!(found.iter().zip(&known).all(alike), "{found:?} {known:?}");
    }
    let table = folder.read("out/track.csv");
    let files = table.lines().skip(1).step_by(2);
    let files: Vec<&str> = files.flat_map(|line| line.rsplit(',').nth(1)).collect();
    assert_eq!(files, NAMES.map(|name| format!("{name:?}")));
}

#[test]
fn evaluate_says_when_there_is_nothing_and_makes_its_folder() {
    let folder = Folder::new("evaluated");
    let study = folder.read("study.toml");
    let lines = study.lines().filter(|line| !line.contains("masks"));
    let without: String = lines.map(|line| format!("{line}\n")).collect();
    fs::write(folder.0.join("without.toml"), without).expect("a study");
    let (code, said) = folder.run(&["evaluate", "--study", "without.toml"]);
    assert!(
        code == 1 && said.contains("names nothing to evaluate"),
        "{said}"
    );
    let of_femur = study.split("[[component]]").take(2).collect::<Vec<_>>();
    fs::write(folder.0.join("femur.toml"), of_femur.join("[[component]]")).expect("a study");
    let words = ["evaluate", "--study", "femur.toml", "--poses", "new/poses"];
    let (code, said) = folder.run(&words);
    assert_eq!(code, 0, "{said}");
    assert!(folder.0.join("new/poses/femur-truth.jts").is_file());
    assert!(
        folder
            .0
            .join("new/poses/femur-truth.covariances.csv")
            .is_file()
    );
    writes_only_where_it_is_told(&folder, &study);
}

/// Without references there is nothing to compare, and poses go nowhere unless somebody says where.
fn writes_only_where_it_is_told(folder: &Folder, study: &str) {
    let lines = study.lines().filter(|line| !line.starts_with("reference"));
    let without: String = lines.map(|line| format!("{line}\n")).collect();
    fs::write(folder.0.join("without.toml"), without).expect("a study");
    let names = || -> Vec<_> {
        let entries = fs::read_dir(&folder.0).expect("a folder").flatten();
        entries.map(|entry| entry.file_name()).collect()
    };
    let before = names();
    let (code, said) = folder.run(&["evaluate", "--study", "without.toml"]);
    assert!(code == 1 && said.contains("by --poses"), "{said}");
    assert_eq!(names(), before);
    let words = ["evaluate", "--study", "without.toml", "--poses", "found"];
    let (code, said) = folder.run(&words);
    let told = said.contains("poses are written to found and compared with nothing");
    assert!(code == 0 && told, "{said}");
    assert!(folder.0.join("found/tibia-truth.jts").is_file());
}

/// What `pose` writes of masks is enough for the joint's standard deviations.
#[test]
fn poses_of_masks_are_reported_with_their_deviations() {
    let folder = Folder::new("reported");
    for name in ["femur", "tibia"] {
        let [model, library, masks, out, table] = [
            format!("{name}.stl"),
            format!("{name}.library"),
            format!("masks/{name}"),
            format!("found/{name}.jts"),
            format!("found/{name}.csv"),
        ];
        fs::create_dir_all(folder.0.join("found")).expect("a folder");
        let of = ["--model", &model, "--calibration", "calibration.txt"];
        let build = [
            &["library", "--out", &library, "--frame", "256,256"][..],
            &of,
        ]
        .concat();
        let (code, said) = folder.run(&build);
        assert_eq!(code, 0, "{said}");
        let find = ["pose", "--library", &library, "--masks", &masks];
        let to = ["--out", &out, "--report", &table, "--method", "refined"];
        let (code, said) = folder.run(&[&find[..], &of, &to].concat());
        assert!(code == 0 || code == 3, "{said}");
    }
    let words = ["report", "--study", ".", "--poses", "found", "--out", "r"];
    let (_, said) = folder.run(&words);
    assert!(!said.contains("no standard deviations"), "{said}");
    // Of masks nothing is the film's: both components err by themselves.
    assert!(!said.contains("counts twice"), "{said}");
    let joint = folder.read("r/joint.csv");
    let mut lines = joint.lines().filter(|line| !line.starts_with('#'));
    let heading: Vec<&str> = lines.next().expect("a heading").split(',').collect();
    let at = heading.iter().position(|name| name.starts_with("sd_"));
    let at = at.unwrap_or_else(|| panic!("deviations: {heading:?}"));
    let first: Vec<&str> = lines.next().expect("a row").split(',').collect();
    assert!(first[at].parse::<f64>().is_ok_and(|sd| sd > 0.0), "{joint}");
}

#[test]
fn frames_are_no_masks() {
    let folder = Folder::new("grey");
    let study = folder.read("study.toml");
    let frames = study.replace("masks/femur", "frames");
    fs::write(folder.0.join("grey.toml"), frames).expect("a study");
    let (code, said) = folder.run(&["evaluate", "--study", "grey.toml"]);
    assert_eq!(code, 1, "{said}");
    assert!(
        said.contains("f1.png: this is a grey picture and no mask"),
        "{said}"
    );
}

//! The command as a shell meets it: closed pipes, Ctrl-C, and the codes that it exits with.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use fluoropose_phantom::implant::Parameters;
use fluoropose_phantom::implant::Side;
use fluoropose_phantom::sequence::{self, Implants, Options};
use fluoropose_phantom::{implant, picture, stl};

/// A folder of its own.
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
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(&folder).expect("a folder");
        Self(folder)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).expect("a file");
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).expect("a file")
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fluoropose"));
        command.args(words).current_dir(&self.0);
        command
    }

    fn run(&self, words: &[&str]) -> (i32, String) {
        let Output {
            status,
            stdout,
            stderr,
        } = self.command(words).output().expect("it runs");
        let said = [stdout, stderr].map(|said| String::from_utf8_lossy(&said).into_owned());
        (status.code().expect("a code"), said.concat())
    }
}

#[cfg(unix)]
#[test]
fn whoever_stops_reading_ends_the_command_without_a_word() {
    use std::os::unix::process::ExitStatusExt as _;
    let folder = Folder::new("pipe");
    let rows = (0..500).map(|number| format!("study.toml,s{number}\n"));
    folder.write(
        "list.csv",
        &(String::from("study,name\n") + &rows.collect::<String>()),
    );
    let mut command = folder.command(&["batch", "list.csv", "--out", "out", "--status"]);
    let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("it runs");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert_eq!(
        (output.status.code(), output.status.signal()),
        (None, Some(13))
    );
}

#[cfg(unix)]
#[test]
fn whoever_ends_the_command_is_told_what_is_kept_and_how_to_go_on() {
    use std::os::unix::process::ExitStatusExt as _;
    use std::time::{Duration, Instant};
    let folder = Folder::new("stopped");
    let options = Options {
        frames: 4,
        seed: 3,
        pixels: 256,
        implants: Some(Implants::built_in(Side::Left, 0.5).expect("possible")),
        ..Options::default()
    };
    sequence::write(&options, &folder.0).expect("a study");
    folder.write("list.csv", "study,name\nstudy.toml,a\n");
    for (words, journal, said) in [
        (
            &["track", "--study", "study.toml", "--out", "tracked"][..],
            "tracked/journal.txt",
            "stopped: what was done is kept in tracked; the same command goes on from there",
        ),
        (
            &["batch", "list.csv", "--out", "out"][..],
            "out/.aside/a/journal.txt",
            "stopped: finished studies are in out, the one in hand is kept in out/.aside/; the same command goes on",
        ),
    ] {
        let child = folder.command(words).stderr(Stdio::piped()).spawn();
        let child = child.expect("it runs");
        let begun = Instant::now();
        while !folder.0.join(journal).exists() && begun.elapsed() < Duration::from_secs(120) {
            std::thread::sleep(Duration::from_millis(5));
        }
        // As Ctrl-C, which is ignored by what runs in the background of a script, and so perhaps by this test.
        let kill = Command::new("kill")
            .args(["-TERM", &child.id().to_string()])
            .status();
        assert!(kill.expect("it runs").success());
        let output = child.wait_with_output().expect("it ends");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(stderr.contains(said), "{stderr}");
        assert_eq!(output.status.signal(), Some(15), "{stderr}");
    }
}

#[test]
fn every_verbs_help_ends_with_the_codes() {
    let folder = Folder::new("help");
    for words in [
        &["--help"][..],
        &["track", "--help"],
        &["library", "--help"],
        &["batch", "--help"],
    ] {
        let (code, said) = folder.run(words);
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(code, 0);
        for word in [
            "130 Ctrl-C",
            "137 killed",
            "141 nobody reads",
            "3 done, but numbers",
        ] {
            assert!(said.contains(word), "{said}");
        }
    }
    let (_, said) = folder.run(&["batch", "--help"]);
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("with --status too: 0 all done;"), "{said}");
}

/// Models of a knee, and poses of so many frames: the tray lies below the femoral component, and both are upright.
fn knee(folder: &Folder, frames: usize) {
    for name in ["femur", "tibia"] {
        let made = match name {
            "femur" => implant::femur(&Parameters::default()),
            _ => implant::tibia(&Parameters::default()),
        };
        let path = folder.0.join(format!("{name}.stl"));
        stl::write_file(&made.expect("usual"), &path).expect("a file");
    }
    let jts = |y: f64| {
        format!(
            "JT_EULER_312\n{}",
            format!("0,{y},-1000,0,0,0\n").repeat(frames)
        )
    };
    folder.write("above.jts", &jts(0.0));
    folder.write("below.jts", &jts(-30.0));
}

/// The verb that turns two files of poses into a joint's table.
fn joint<'a>(femur: &'a str, tibia: &'a str, out: &'a str) -> Vec<&'a str> {
    let poses = ["kinematics", "--femur", femur, "--tibia", tibia];
    let models = ["--femur-model", "femur.stl", "--tibia-model", "tibia.stl"];
    [&poses[..], &models, &["--side", "left", "--out", out]].concat()
}

#[cfg(unix)]
#[test]
fn an_output_is_the_old_one_or_the_new_one_whenever_the_command_is_killed() {
    use std::time::{Duration, Instant};
    let folder = Folder::new("killed");
    knee(&folder, 400);
    let begun = Instant::now();
    assert_eq!(
        folder.run(&joint("above.jts", "below.jts", "joint.csv")).0,
        0
    );
    let took = begun.elapsed();
    let new = folder.read("joint.csv");
    // Later and later, up to its usual end and beyond.
    for twelfth in 1..=14 {
        folder.write("joint.csv", "old");
        let words = joint("above.jts", "below.jts", "joint.csv");
        let mut command = folder.command(&words);
        let mut child = command.stdout(Stdio::null()).spawn().expect("it runs");
        std::thread::sleep(took * twelfth / 12 + Duration::from_micros(70 * u64::from(twelfth)));
        // It may have ended.
        let _ = child.kill();
        child.wait().expect("it ends");
        let found = folder.read("joint.csv");
        assert!(found == "old" || found == new, "{} bytes", found.len());
    }
}

#[cfg(unix)]
#[test]
fn a_full_disk_is_said_and_leaves_what_was_there() {
    let folder = Folder::new("full");
    knee(&folder, 200);
    folder.write("joint.csv", "old");
    // A file may have 512 bytes, and who writes more is told so rather than ended.
    let shell = "trap '' XFSZ; ulimit -f 1; exec \"$@\"";
    for out in ["joint.csv", "other.csv", "/proc/joint.csv", "no/joint.csv"] {
        let mut command = Command::new("sh");
        command.args(["-c", shell, "sh", env!("CARGO_BIN_EXE_fluoropose")]);
        command.args(joint("above.jts", "below.jts", out));
        let output = command.current_dir(&folder.0).output().expect("it runs");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains(&format!("cannot write {out}")), "{said}");
    }
    assert_eq!(folder.read("joint.csv"), "old");
    let mut names: Vec<_> = fs::read_dir(&folder.0)
        .expect("a folder")
        .map(|entry| entry.expect("a name").file_name())
        .collect();
    names.sort();
    let models = ["femur.stl", "joint.csv", "tibia.stl"];
    assert_eq!(names, [&["above.jts", "below.jts"][..], &models].concat());
}

#[test]
fn a_joint_that_no_knee_has_is_told_by_code_and_table() {
    let folder = Folder::new("swapped");
    knee(&folder, 2);
    let joint = |femur: &str, tibia: &str| folder.run(&joint(femur, tibia, "joint.csv"));
    let (code, said) = joint("above.jts", "below.jts");
    assert_eq!(code, 0, "{said}");
    let table = folder.read("joint.csv");
    assert!(table.starts_with("# translations: origins are"), "{table}");
    assert!(
        table.contains("\nframe,rel_x_mm") && !table.contains("# origins"),
        "{table}"
    );
    let (code, said) = joint("below.jts", "above.jts");
    assert_eq!(code, 3, "{said}");
    let table = folder.read("joint.csv");
    assert!(
        table.starts_with("# doubtful: frame 1 and 1 more: "),
        "{table}"
    );
    assert!(table.contains("\nframe,rel_x_mm"), "{table}");
}

#[test]
fn report_says_as_kinematics_does_that_axes_are_those_of_the_shape() {
    let folder = Folder::new("axes");
    knee(&folder, 1);
    let component = |name: &str, poses: &str| {
        format!("[[component]]\nname = '{name}'\nmodel = '{name}.stl'\nreference = '{poses}.jts'\n")
    };
    let (femur, tibia) = (component("femur", "above"), component("tibia", "below"));
    folder.write("calibration.txt", "JT_INTCALIB\n1200\n0\n0\n0.4\n");
    folder.write(
        "study.toml",
        &format!("name = 'x'\nside = 'left'\ncalibration = 'calibration.txt'\n{femur}{tibia}"),
    );
    let both = || {
        let (_, kinematics) = folder.run(&joint("above.jts", "below.jts", "joint.csv"));
        let (_, report) = folder.run(&["report", "--study", "study.toml", "--out", "out"]);
        [kinematics, report]
    };
    let told = "the femoral file's axes are more than 10 degrees off those of its shape";
    for said in both() {
        assert!(
            said.contains("femoral anterior, superior, right: x y z"),
            "{said}"
        );
        assert!(!said.contains(told), "{said}");
    }
    turn(&folder.0.join("femur.stl"));
    for said in both() {
        assert!(said.contains(told), "{said}");
    }
}

/// Turns a binary STL file by 120 degrees about the axis between its three, and by some more out of them.
fn turn(path: &Path) {
    let mut bytes = fs::read(path).expect("a file");
    let (sine, cosine) = 0.5_f32.sin_cos();
    for triangle in bytes[84..].chunks_exact_mut(50) {
        for point in triangle[..48].chunks_exact_mut(12) {
            let at = |k: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| point[4 * k + byte]));
            let (x, y, z) = (at(1), at(2), at(0));
            let turned = [cosine * x - sine * y, sine * x + cosine * y, z];
            let turned: Vec<u8> = turned.into_iter().flat_map(f32::to_le_bytes).collect();
            point.copy_from_slice(&turned);
        }
    }
    fs::write(path, bytes).expect("a file");
}

#[test]
fn translations_of_far_origins_are_marked_and_are_no_doubt() {
    let folder = Folder::new("origins");
    knee(&folder, 2);
    // As poses of a tibial file whose origin lies 86 mm in front of the tray.
    folder.write(
        "far.jts",
        "JT_EULER_312\n86,-30,-1000,0,0,0\nNaN,NaN,NaN,NaN,NaN,NaN\n",
    );
    let words = [
        "kinematics",
        "--femur",
        "above.jts",
        "--tibia",
        "far.jts",
        "--side",
        "right",
    ];
    let (code, said) = folder.run(&[&words[..], &["--out", "joint.csv"]].concat());
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("frame 1: a translation is"), "{said}");
    let table = folder.read("joint.csv");
    assert!(
        table.starts_with("# origins: frame 1: a translation is 86 mm"),
        "{table}"
    );
}

#[test]
fn a_film_without_an_implant_exits_with_its_own_code() {
    let folder = Folder::new("nothing");
    let (femur, side) = (implant::femur(&Parameters::default()), 192);
    stl::write_file(&femur.expect("usual"), &folder.0.join("femur.stl")).expect("a file");
    fs::create_dir_all(folder.0.join("frames")).expect("a folder");
    for frame in 0..2 {
        let path = folder.0.join(format!("frames/{frame}.png"));
        picture::write_grey(&path, (side, side), &vec![150; side * side]).expect("a frame");
    }
    folder.write("calibration.txt", "JT_INTCALIB\n1200\n0\n0\n2\n");
    let study = "name = 'x'\ncalibration = 'calibration.txt'\nframes = 'frames'\n\
        [[component]]\nname = 'femur'\nmodel = 'femur.stl'\n";
    folder.write("study.toml", study);
    let (code, said) = folder.run(&["track", "--study", "study.toml", "--out", "tracked"]);
    assert_eq!(code, 7, "{said}");
    let taken = "192 x 192 pixels are taken for the whole frame, 384 x 384 mm of the detector";
    assert!(said.contains(taken), "{said}");
    let table = folder.read("tracked/track.csv");
    let last = table.lines().last().expect("a row");
    assert!(last.ends_with(",\"1.png\",1"), "{table}");
    let why = fluoropose::image::blank::BLANK;
    assert_eq!(table.matches(why).count(), 2, "{table}");
    // What is found without a click that leads nowhere does not take its place.
    let kept = "kept as it was\n";
    folder.write("tracked/track.csv", kept);
    let vain = ["track", "--study", "study.toml", "--out", "tracked"];
    let vain = [&vain[..], &["--click", "femur:1:5,5"]].concat();
    let (code, said) = folder.run(&vain);
    let told = "femur:1:5,5: the click leads to no pose; what tracked holds stays as it was";
    assert!(code == 1 && said.contains(told), "{code}: {said}");
    assert_eq!(folder.read("tracked/track.csv"), kept);
    folder.write("inches.toml", &format!("{study}unit = 'in'\n"));
    let (code, said) = folder.run(&["track", "--study", "inches.toml", "--out", "inches"]);
    let named = "femur.stl, read with unit = \"in\" (under its [[component]] in the study): the distance of";
    assert!(
        code == 1 && said.contains("the component femur, ") && said.contains(named),
        "{code}: {said}"
    );
    let beyond = format!("femur:1:{side},20");
    let track = [
        "track",
        "--study",
        "study.toml",
        "--out",
        "t",
        "--click",
        &beyond,
    ];
    let (code, said) = folder.run(&track);
    assert!(
        code == 1 && said.contains("column 192, row 20 is not on the frame"),
        "{said}"
    );
    assert!(!Path::new(&folder.0.join("t")).exists());
}

const POSE: &str = "pose --library l --model m --calibration c --masks k";
const LIBRARY: &str = "library --model m --calibration c";
/// What cannot be meant, and a part of what is said of it; `POSE` and `LIBRARY` stand for what most begin with.
const REFUSED: [(&str, &str); 16] = [
    (
        "POSE --out p.jts --frames f",
        "looked at by --method image alone",
    ),
    (
        "POSE --out p.jts --dark-implant",
        "for --method image, not library",
    ),
    (
        "POSE --out p.jts --edge-offset",
        "by --method refined and image",
    ),
    (
        "POSE --out p.csv --report ./p.csv",
        "--out and --report both name",
    ),
    ("POSE --out no/p.jts", "cannot write no/p.jts"),
    (
        "POSE --out p.jts --report no/p.csv",
        "cannot write no/p.csv",
    ),
    ("POSE --out m", "--out names m, which is read too"),
    ("LIBRARY --out m", "--out names m, which is read too"),
    ("LIBRARY --out l --sheet l", "--out and --sheet both name"),
    (
        "LIBRARY --out l --for firmware --flash 9K --sheet s",
        "cannot be used with",
    ),
    ("LIBRARY --out l --x=-4:4:3", "lead from -4 to 2, not to 4"),
    ("evaluate --study s --centred", "is of --method refined"),
    ("evaluate --study s --json no/a", "cannot write no/a"),
    (
        "compare --study s --poses p --json s",
        "--json names s, which is",
    ),
    (
        "outline --study s --component f --frame 0",
        "no whole number above 0",
    ),
    (
        "disguise --study s --out d --seed 1 --frames 0",
        "no whole number",
    ),
];

/// Nothing of what is named is there: whatever is read first would be told.
#[test]
fn what_would_be_left_out_or_written_over_is_refused_before_any_work() {
    let folder = Folder::new("refused");
    for (words, why) in REFUSED {
        let words = words.replace("POSE", POSE).replace("LIBRARY", LIBRARY);
        let (code, said) = folder.run(&words.split(' ').collect::<Vec<_>>());
        assert!(
            said.contains(why) && (1..=2).contains(&code),
            "{words}: {code} {said}"
        );
    }
    assert_eq!(fs::read_dir(&folder.0).expect("a folder").count(), 0);
}

#[test]
fn a_key_that_leaves_a_component_out_of_the_comparison_is_told() {
    let folder = Folder::new("misspelt");
    let component = "[[component]]\nname = 'femur'\nmodel = 'f.stl'\nrefrence = 'f.jts'\n";
    folder.write(
        "study.toml",
        &format!("name = 'a'\ncalibration = 'c.txt'\n{component}"),
    );
    let (code, said) = folder.run(&["compare", "--study", ".", "--poses", "."]);
    assert!(code == 1 && said.contains("was reference meant?"), "{said}");
}

/// Rows of a table would be of nothing: following takes hours before that is known.
#[test]
fn a_truth_is_asked_for_before_a_disguise_is_followed() {
    let folder = Folder::new("truth");
    let study = "name = 'a'\ncalibration = 'c.txt'\nframes = 'f'\n[[component]]\nname = 'femur'\nmodel = 'f.stl'\n";
    folder.write("study.toml", study);
    let words = "disguise --study . --out d --seed 1 --track";
    let (code, said) = folder.run(&words.split(' ').collect::<Vec<_>>());
    assert!(code == 1 && said.contains("has a reference"), "{said}");
}

/// Its folder holds the reference poses under the names that found ones have.
#[test]
fn found_poses_are_not_written_over_those_of_the_study() {
    let folder = Folder::new("over");
    let options = Options {
        frames: 1,
        pixels: 64,
        implants: Some(Implants::built_in(Side::Left, 0.5).expect("possible")),
        ..Options::default()
    };
    sequence::write(&options, &folder.0).expect("a study");
    let before = folder.read("femur.jts");
    let (code, said) = folder.run(&["track", "--study", ".", "--out", "."]);
    assert!(code == 1 && said.contains("which is read too"), "{said}");
    assert_eq!(folder.read("femur.jts"), before);
}

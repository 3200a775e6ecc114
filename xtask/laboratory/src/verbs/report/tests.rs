//! The verb on built-in implants that turn about a known place.

use fluoropose::pose::EulerPose;
use fluoropose::pose::jts;
use fluoropose::{Pose, Side};
use fluoropose_phantom::implant::{self, Parameters, femur, tibia};
use fluoropose_phantom::stl;
use fluoropose_report::read;

use super::*;

const FRAMES: usize = 24;
/// To medial of the tray's middle, mm.
const PIVOT: f64 = 15.0;

fn pose(place: [f64; 3], turns: [f64; 3]) -> Pose {
    let ([x_mm, y_mm, z_mm], [z_rot_deg, x_rot_deg, y_rot_deg]) = (place, turns);
    EulerPose {
        x_mm,
        y_mm,
        z_mm,
        z_rot_deg,
        x_rot_deg,
        y_rot_deg,
    }
    .into()
}

/// A left knee at 30 degrees that turns by 12 about a place on the plate; frame 7 has no femur. While it flexed, its lowest points
/// would wander on the condyles, and the lines would meet elsewhere.
fn poses() -> [Vec<Option<EulerPose>>; 2] {
    let camera = pose([10.0, -20.0, -900.0], [12.0, 4.0, -3.0]);
    let mut both = [Vec::new(), Vec::new()];
    for frame in 0..FRAMES {
        let part = frame as f64 / (FRAMES - 1) as f64;
        let about = pose([0.0, 0.0, PIVOT], [0.0, 0.0, 12.0 * (part - 0.5)]);
        let back = pose([0.0, 0.0, -PIVOT], [0.0; 3]);
        let flexed = pose([2.0, 30.0, 0.0], [30.0, 0.0, 0.0]);
        let femur = camera.compose(&about).compose(&back).compose(&flexed);
        both[0].push((frame != 6).then(|| EulerPose::from(femur)));
        both[1].push(Some(EulerPose::from(camera)));
    }
    both
}

fn write_poses(folder: &Path, name: &str, poses: &[Option<EulerPose>]) {
    let mut text = String::new();
    jts::write_heading(&mut text).unwrap();
    for pose in poses {
        jts::write_row(&mut text, pose.as_ref()).unwrap();
    }
    std::fs::write(folder.join(format!("{name}.jts")), text).unwrap();
}

/// Frame 3 is doubtful, and in frame 5 both poses are checked.
fn track() -> String {
    let mut table = String::from("frame,component,state,verdict,because,checked\n");
    for frame in 1..=FRAMES {
        for name in ["femur", "tibia"] {
            let (word, because) = match (frame, name) {
                (3, "tibia") => ("doubtful,doubtful", "a rim, perhaps"),
                (7, "femur") => ("untrackable,none", "no edge"),
                _ => ("followed,good", "fits"),
            };
            let is_checked = frame == 5 || (frame, name) == (3, "femur");
            let checked = u8::from(is_checked);
            table += &format!("{frame},\"{name}\",{word},\"{because}\",{checked}\r\n");
        }
    }
    table
}

fn write_study(folder: &Path) {
    let parameters = Parameters {
        side: implant::Side::Left,
        ..Parameters::default()
    };
    for (name, mesh) in [("femur", femur(&parameters)), ("tibia", tibia(&parameters))] {
        stl::write_file(&mesh.unwrap(), &folder.join(format!("{name}.stl"))).unwrap();
    }
    for (name, poses) in ["femur", "tibia"].into_iter().zip(poses()) {
        write_poses(folder, name, &poses);
        // A tenth of a degree, and 0.1 mm but for depth.
        let mut table = String::from("frame,c11\n");
        for frame in 1..=FRAMES {
            let deviations = [0.002, 0.002, 0.002, 0.1, 0.1, 1.5];
            let entry = |k: usize| match k / 6 == k % 6 {
                true => (deviations[k % 6] * deviations[k % 6]).to_string(),
                false => "0".to_owned(),
            };
            let entries: Vec<String> = (0..36).map(entry).collect();
            table.push_str(&format!("{frame},{}\n", entries.join(",")));
        }
        std::fs::write(folder.join(format!("{name}.covariances.csv")), table).unwrap();
    }
    std::fs::write(folder.join("track.csv"), track()).unwrap();
    let film =
        "component,and so on\n\"femur\",0.0062,0.001,1.4,0.07,1.83,0.18,0.8,2.5\n\"tibia\",odd\n";
    std::fs::write(folder.join("film.csv"), film).unwrap();
    std::fs::write(
        folder.join("calibration.txt"),
        "JT_INTCALIB\n1000\n0\n0\n0.3\n",
    )
    .unwrap();
    let study = "name = 'pivot'\nside = 'left'\ncalibration = 'calibration.txt'\n\
        [[component]]\nname = 'femur'\nmodel = 'femur.stl'\n[[component]]\nname = 'tibia'\nmodel = 'tibia.stl'\n";
    std::fs::write(folder.join("study.toml"), study).unwrap();
}

#[test]
fn a_known_pivot_a_gap_and_a_doubt_come_through() {
    let folder = std::env::temp_dir().join(format!("fluoropose-report-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    write_study(&folder);
    let args = |cutoff| Args {
        study: Some(folder.join("study.toml")),
        group: Vec::new(),
        poses: Some(folder.clone()),
        out: folder.join("out"),
        fps: Some(15.0),
        cutoff: Some(cutoff),
        overlay: false,
    };
    run(args(3.0)).unwrap();
    let text = |name: &str| std::fs::read_to_string(folder.join("out").join(name)).unwrap();
    let table = read::table(&text("joint.csv")).unwrap();
    let column = |name: &str| table.column(name).unwrap();
    assert_eq!(table.rows.len(), FRAMES);
    let (flexion, gap) = (column("flexion_deg"), 6);
    assert!((flexion[0] - 30.0).abs() < 0.1 && (flexion[20] - 30.0).abs() < 0.1);
    let checked: Vec<f64> = (0..FRAMES).map(|frame| f64::from(frame == 4)).collect();
    assert_eq!(column("checked"), checked);
    assert!(flexion[gap].is_nan() && column("lift_off_mm")[gap].is_nan());
    assert!(
        column("sd_field_medial_mm")
            .iter()
            .filter(|sd| **sd > 1.5)
            .count()
            == FRAMES - 1
    );
    // Nothing was there to filter: a smooth film keeps its numbers.
    let filtered = column("filtered_flexion_deg");
    assert!((filtered[12] - flexion[12]).abs() < 0.05 && filtered[gap].is_nan());
    let mot = read::mot(&text("joint.mot")).unwrap();
    assert_eq!(mot.column("flexion_deg").unwrap()[3], flexion[3]);
    assert_eq!(read::tra(&text("joint.tra")).unwrap()[0][gap], None);
    let report = text("report.html");
    for words in [
        "tibia doubtful: a rim, perhaps",
        "empty everywhere: 7",
        "femoral covariances",
        "film, femur",
        "blur 1.40 ± 0.07 px",
        "3 Hz",
    ] {
        assert!(report.contains(words), "{words}");
    }
    check_centre(&text("figure.svg"), column);
    let pdf = std::fs::read(folder.join("out/figure.pdf")).unwrap();
    assert!(pdf.starts_with(b"%PDF-"));
    check_group(&folder, column);
    read_by_another_program(&folder.join("out"));
    assert!(run(args(7.5)).unwrap_err().to_string().contains("half"));
    check_filter(&folder, args(3.0));
    check_overlay(&folder, args(3.0));
    check_impossible(&folder);
    std::fs::remove_dir_all(&folder).unwrap();
}

/// What is doubtful has no filtered numbers, wherever it lies, and no part in those beside it.
fn check_filter(folder: &Path, args: Args) {
    let filtered = || {
        let table = std::fs::read_to_string(folder.join("out/joint.csv")).unwrap();
        read::table(&table)
            .unwrap()
            .column("filtered_flexion_deg")
            .unwrap()
    };
    let before = filtered();
    let [_, mut tibia] = poses();
    let away = pose([0.0; 3], [40.0, 0.0, 0.0]);
    tibia[2] = tibia[2].map(|known| Pose::from(known).compose(&away).into());
    write_poses(folder, "tibia", &tibia);
    run(args).unwrap();
    assert!(before[2].is_nan() && before[3].is_finite());
    assert_eq!(format!("{:?}", filtered()), format!("{before:?}"));
    write_poses(folder, "tibia", &poses()[1]);
}

/// Frames that the study names get their outlines and curves; as many as there are poses.
fn check_overlay(folder: &Path, args: Args) {
    const SIDE: usize = 300;
    let frames = folder.join("frames");
    std::fs::create_dir_all(&frames).unwrap();
    let grey: Vec<u8> = (0..SIDE * SIDE).map(|k| (k % 100) as u8).collect();
    for frame in 0..FRAMES {
        let name = frames.join(format!("{frame:02}.png"));
        fluoropose_phantom::picture::write_grey(&name, (SIDE, SIDE), &grey).unwrap();
    }
    let study = folder.join("study.toml");
    let text = std::fs::read_to_string(&study).unwrap();
    std::fs::write(&study, format!("frames = 'frames'\n{text}")).unwrap();
    let again = || Args {
        study: args.study.clone(),
        group: Vec::new(),
        poses: args.poses.clone(),
        out: args.out.clone(),
        overlay: true,
        ..args
    };
    run(again()).unwrap();
    let picture = |number: usize| {
        let name = format!("out/overlay/frame_{number:04}.png");
        fluoropose_decode::decode_frames(&std::fs::read(folder.join(name)).unwrap(), "picture")
            .unwrap()
            .remove(0)
    };
    let (whole, gap) = (picture(1), picture(7));
    assert_eq!((whole.width, whole.height), (480 + 268, 480));
    // The frame that has no femur has no outline of it.
    assert_ne!(whole.pixels, gap.pixels);
    let (third, aside) = (frames.join("03.png"), folder.join("03.png"));
    std::fs::rename(&third, &aside).unwrap();
    // Without the overlay too: rows would be other frames'.
    for overlay in [true, false] {
        let told = run(Args { overlay, ..again() }).unwrap_err().to_string();
        assert!(told.contains("23 frames and 24 poses"), "{told}");
    }
    std::fs::rename(aside, third).unwrap();
}

/// A tray upside down is told, a joint is not, nor anything of a study without one.
fn check_impossible(folder: &Path) {
    let study = folder.join("study.toml");
    assert!(impossible(&study, folder).is_empty());
    let [_, mut tibia] = poses();
    let over = pose([0.0; 3], [170.0, 0.0, 0.0]);
    for row in &mut tibia {
        *row = row.map(|row| EulerPose::from(Pose::from(row).compose(&over)));
    }
    write_poses(folder, "tibia", &tibia);
    assert!(!impossible(&study, folder).is_empty());
    std::fs::remove_file(folder.join("tibia.jts")).unwrap();
    assert!(impossible(&study, folder).is_empty());
}

/// A program that shares no code with this one reads all files, where the machine has a Python.
fn read_by_another_program(out: &Path) {
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../tests/golden/joint_files.py"
    );
    let python = std::process::Command::new("python3")
        .args([script, out.to_str().unwrap(), "--field-axes"])
        .output();
    match python {
        Ok(said) => {
            let text =
                [said.stdout, said.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
            assert!(
                said.status.success() && text[0].starts_with("read"),
                "{text:?}"
            );
            eprintln!("{}", text[0].trim());
        }
        Err(none) => eprintln!("the files are not read by another program: no python3 ({none})"),
    }
}

/// The film taken as two knees: what both have is the mean, without any spread.
fn check_group(folder: &Path, column: impl Fn(&str) -> Vec<f64>) {
    let tables = ["joint.csv", "second.csv", "third.csv"].map(|name| folder.join("out").join(name));
    let text = std::fs::read_to_string(&tables[0]).unwrap();
    tables[1..]
        .iter()
        .for_each(|table| std::fs::write(table, &text).unwrap());
    let named = |knee: &str, table: usize| format!("{knee}={}", tables[table].display());
    let args = |group: Vec<String>| Args {
        study: None,
        group,
        poses: None,
        out: folder.join("group"),
        fps: None,
        cutoff: None,
        overlay: false,
    };
    run(args(vec![named("p1", 0), named("p2", 1), named("p2", 2)])).unwrap();
    let text = std::fs::read_to_string(folder.join("group/group.csv")).unwrap();
    let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let [names, row] = rows[..] else {
        panic!("{text}")
    };
    let at = |name: &str| {
        let at = names.split(',').position(|other| other == name).unwrap();
        row.split(',').nth(at).unwrap().parse::<f64>().unwrap()
    };
    assert_eq!(
        (at("flexion_step_deg"), at("n"), at("sd_lift_off_mm")),
        (30.0, 2.0, 0.0)
    );
    let all = column("medial_ap_mm");
    let known = all.iter().filter(|x| x.is_finite());
    let (low, high) = known.fold((f64::MAX, f64::MIN), |(low, high), &x| {
        (low.min(x), high.max(x))
    });
    assert!((low..=high).contains(&at("mean_medial_ap_mm")));
    let cycle = std::fs::read_to_string(folder.join("group/cycle/flexion_deg.csv")).unwrap();
    assert_eq!(
        cycle.lines().filter(|line| !line.starts_with('#')).count(),
        3
    );
    let refused = |tables: Vec<String>| format!("{:#}", run(args(tables)).unwrap_err());
    assert!(refused(vec![named("p1", 0), named("p2", 0)]).contains("is named twice"));
    let other = std::fs::read_to_string(&tables[0]).unwrap();
    let other = other.replace("; knee: left;", "; knee: right;");
    std::fs::write(&tables[1], other).unwrap();
    let two_sides = refused(vec![named("p1", 0), named("p1", 1)]);
    assert!(
        two_sides.contains("a left one in the film pivot and a right one"),
        "{two_sides}"
    );
    let unnamed = run(args(vec![tables[0].display().to_string()])).unwrap_err();
    assert!(unnamed.to_string().contains("whose knee"));
}

/// The centre that the figure tells.
fn check_centre(figure: &str, column: impl Fn(&str) -> Vec<f64>) {
    let words = figure
        .split("centre of rotation ")
        .nth(1)
        .unwrap()
        .split('<')
        .next()
        .unwrap();
    let numbers: Vec<f64> = words
        .split(' ')
        .filter_map(|word| word.parse().ok())
        .collect();
    let [anterior, _, across, _] = numbers[..] else {
        panic!("{words}")
    };
    assert!((across - PIVOT).abs() < 0.2, "{words}");
    // The condyles lie in front of the axis, and the lines meet where that is nearest to them.
    let ends = [
        "medial_across_mm",
        "lateral_across_mm",
        "medial_ap_mm",
        "lateral_ap_mm",
    ];
    let [m, l, front, rear] = ends.map(|name| column(name)[FRAMES / 2]);
    let on_the_line = front + (rear - front) * (PIVOT - m) / (l - m);
    assert!(
        (anterior - on_the_line).abs() < 0.3,
        "{words} for {on_the_line}"
    );
    assert!(words.ends_with("medial"), "{words}");
}

#[test]
fn a_side_that_the_femur_is_not_made_for_is_told() {
    let folder = std::env::temp_dir().join(format!("fluoropose-side-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    write_study(&folder);
    let file = folder.join("study.toml");
    let study = Study::read(&file).unwrap();
    let sources = Sources::read(&file, &study, Some(&folder)).unwrap();
    let told = |side| {
        let knee = Knee::new("a knee", side, &sources).unwrap();
        let of_side = |remark: &&String| remark.contains("flange is higher at its left half");
        knee.remarks.iter().filter(of_side).count()
    };
    assert_eq!([Side::Left, Side::Right].map(told), [0, 1]);
    std::fs::remove_dir_all(folder).unwrap();
}

//! A drawn plate, distorted as an image intensifier bends it, through the verbs `calibrate` and `undistort`.
#![allow(clippy::unwrap_used, reason = "it fails the test")]

use std::path::{Path, PathBuf};

use fluoropose::camera::calibration::Calibration;
use fluoropose_decode::decode_frames;
use fluoropose_laboratory::verbs::calibrate::beads_of;
use fluoropose_phantom::picture::write_grey;

const SIDE: usize = 768;
const SPACING_PX: f64 = 36.0;
const PART: usize = 260;

/// Pin-cushion of five percent at the edge: the picture of an ideal place.
fn distorted(column: f64, row: f64) -> (f64, f64) {
    let (x, y) = ((column - 380.0) / 384.0, (row - 390.0) / 384.0);
    let grow = 1.0 + 0.05 * (x * x + y * y);
    (380.0 + 384.0 * grow * x, 390.0 + 384.0 * grow * y)
}

/// A plate of dark beads of 5 px radius.
fn plate() -> Vec<u8> {
    let mut picture = vec![180; SIDE * SIDE];
    for i in -12..=12 {
        for j in -12..=12 {
            let (column, row) = distorted(
                384.0 + SPACING_PX * f64::from(i),
                384.0 + SPACING_PX * f64::from(j),
            );
            for r in (row - 9.0) as i64..(row + 10.0) as i64 {
                for c in (column - 9.0) as i64..(column + 10.0) as i64 {
                    let (Ok(x), Ok(y)) = (usize::try_from(c), usize::try_from(r)) else {
                        continue;
                    };
                    if x >= SIDE || y >= SIDE {
                        continue;
                    }
                    let away = (x as f64 + 0.5 - column).hypot(y as f64 + 0.5 - row) - 5.0;
                    let shade = 180.0 - 110.0 / (1.0 + (2.0 * away).exp());
                    picture[y * SIDE + x] = shade.round() as u8;
                }
            }
        }
    }
    picture
}

/// Its upper left corner, which holds enough beads for a lattice.
fn part_of(picture: &[u8]) -> Vec<u8> {
    let rows = picture.chunks(SIDE).take(PART);
    rows.flat_map(|row| row[..PART].to_vec()).collect()
}

fn fluoropose(arguments: &[&str]) -> String {
    let done = std::process::Command::new(env!("CARGO_BIN_EXE_fluoropose"))
        .args(arguments)
        .output()
        .unwrap();
    let (out, error) = (
        String::from_utf8(done.stdout).unwrap(),
        String::from_utf8(done.stderr).unwrap(),
    );
    assert!(done.status.success(), "{out}{error}");
    out
}

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("fluoropose-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// What lies between dark beads is a lattice of bright marks.
#[test]
fn a_plate_of_dark_beads_is_refused_where_bright_ones_are_looked_for() {
    let folder = folder("calibrate-bright");
    let (grid, out) = (folder.join("plate.png"), folder.join("calibration.txt"));
    write_grey(&grid, (PART, PART), &part_of(&plate())).unwrap();
    let done = std::process::Command::new(env!("CARGO_BIN_EXE_fluoropose"))
        .args(["calibrate", "--bright", "--spacing", "10"])
        .args(["--source-to-detector", "1200", "--source-to-plate", "1000"])
        .args(["--grid", text(&grid), "--out", text(&out)])
        .output()
        .unwrap();
    let error = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(1), "{error}");
    assert!(
        error.contains("brighter or darker") || error.contains("beads are bright"),
        "{error}"
    );
    assert!(!out.exists());
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_plate_gives_camera_and_correction_and_the_correction_makes_it_straight() {
    let folder = folder("calibrate");
    let (frames, out) = (folder.join("frames"), folder.join("straight"));
    std::fs::create_dir_all(&frames).unwrap();
    let (grid, json, calibration) = (
        frames.join("plate.png"),
        folder.join("plate.json"),
        folder.join("calibration.txt"),
    );
    write_grey(&grid, (SIDE, SIDE), &plate()).unwrap();
    let lengths = [
        "--spacing",
        "10",
        "--source-to-detector",
        "1200",
        "--source-to-plate",
        "1000",
    ];
    let files = ["--distortion", text(&json), "--out", text(&calibration)];
    fluoropose(&[&["calibrate", "--grid", text(&grid)][..], &lengths, &files].concat());
    let Calibration::PrincipalDistance {
        distance,
        offset,
        pitch,
    } = Calibration::parse(&std::fs::read_to_string(&calibration).unwrap()).unwrap()
    else {
        panic!("a principal distance");
    };
    assert_eq!((distance, offset), (1200.0, [0.0; 2]));
    // 10 mm at 1000 of 1200 mm are 12 mm at the detector; the straight lattice is up to a few percent wider than the ideal one.
    assert!((12.0 / pitch / SPACING_PX - 1.0).abs() < 0.06, "{pitch}");
    fluoropose(&[
        "undistort",
        "--distortion",
        text(&json),
        "--frames",
        text(&frames),
        "--out",
        text(&out),
    ]);
    let straight = decode_frames(&std::fs::read(out.join("plate.png")).unwrap(), "plate.png")
        .unwrap()
        .remove(0);
    let beads = beads_of(&straight, false, None).unwrap();
    assert!(beads.len() > 300, "{} beads", beads.len());
    let lattice = fluoropose_distortion::correction::UndistortedLattice::nearest_to(&beads);
    let squares: f64 = beads
        .iter()
        .map(|bead| lattice.residual(bead).unwrap())
        .map(|[c, r]| c * c + r * r)
        .sum();
    let residual = (squares / beads.len() as f64).sqrt();
    assert!(residual < 0.05, "{residual} px RMS");
    std::fs::remove_dir_all(folder).unwrap();
}

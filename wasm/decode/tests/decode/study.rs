//! The real study, where it is present: `FLUOROPOSE_STUDIES`, or `../shared/studies` beside the repository.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use fluoropose_decode::{Pixels, decode_frames, decode_mask, decode_model};

fn left8() -> Option<PathBuf> {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/studies");
    let studies = std::env::var_os("FLUOROPOSE_STUDIES").map_or(default, PathBuf::from);
    let folder = studies.join("left8");
    if folder.is_dir() {
        return Some(folder);
    }
    skipped("there is no study left8 (set FLUOROPOSE_STUDIES)");
    None
}

/// Says that the running test checks nothing: `cargo xtask test` counts these lines.
fn skipped(why: &str) {
    let thread = std::thread::current();
    let line = format!("SKIPPED: {}: {why}\n", thread.name().unwrap_or("a test"));
    print!("{line}");
    let Some(notes) = std::env::var_os("FLUOROPOSE_SKIPPED") else {
        return;
    };
    let notes = fs::OpenOptions::new().append(true).create(true).open(notes);
    notes.unwrap().write_all(line.as_bytes()).unwrap();
}

fn read(path: &Path) -> (Vec<u8>, String) {
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    (fs::read(path).unwrap(), name)
}

fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == extension))
        .collect();
    found.sort();
    found
}

#[test]
fn models_are_whole() {
    let Some(folder) = left8() else { return };
    let models = files(&folder, "stl");
    assert!(!models.is_empty());
    for path in models {
        let (bytes, name) = read(&path);
        let model = decode_model(&bytes, &name).unwrap();
        // These are ASCII: each triangle begins with the word `facet`.
        let text = String::from_utf8(bytes).unwrap();
        let stated = text.matches("facet normal").count();
        println!(
            "{name}: {} vertices, {} of {stated} triangles",
            model.vertices.len(),
            model.triangles.len()
        );
        assert!(model.triangles.len() <= stated && model.triangles.len() * 100 > stated * 99);
        // A closed surface has half as many vertices as triangles, give or take its holes and handles.
        let ratio = model.vertices.len() as f64 / model.triangles.len() as f64;
        assert!((0.45..0.55).contains(&ratio), "{name}: {ratio}");
    }
}

#[test]
fn frames_are_grey_bytes() {
    let Some(folder) = left8() else { return };
    let frames = files(&folder.join("frames"), "tif");
    assert_eq!(frames.len(), 16);
    for path in frames {
        let (bytes, name) = read(&path);
        let decoded = decode_frames(&bytes, &name).unwrap();
        assert_eq!(decoded.len(), 1);
        assert_eq!((decoded[0].width, decoded[0].height), (1024, 1024));
        let Pixels::U8(pixels) = &decoded[0].pixels else {
            panic!("{name} is not bytes")
        };
        assert_eq!(pixels.len(), 1 << 20);
        assert!(pixels.iter().any(|&p| p != pixels[0]));
    }
}

#[test]
fn cut_files_are_refused() {
    let Some(folder) = left8() else { return };
    let frame = files(&folder.join("frames"), "tif").remove(0);
    let models = files(&folder, "stl");
    for path in models.iter().chain([&frame]) {
        let (bytes, name) = read(path);
        for part in 0..40 {
            let cut = &bytes[..bytes.len() * part / 40];
            assert!(decode_frames(cut, &name).is_err(), "{name}: {part}/40");
            assert!(decode_model(cut, &name).is_err(), "{name}: {part}/40");
        }
    }
}

#[test]
fn masks_cover_an_implant() {
    let Some(folder) = left8() else { return };
    for part in ["labels/fem", "labels/tib", "cnn/fem", "cnn/tib"] {
        let masks = files(&folder.join(part), "tif");
        assert_eq!(masks.len(), 16);
        for path in masks {
            let (bytes, name) = read(&path);
            let mask = decode_mask(&bytes, &name).unwrap();
            assert_eq!((mask.width, mask.height), (1024, 1024));
            println!("{name}: {} pixels", mask.area());
            assert!(
                (5_000..200_000).contains(&mask.area()),
                "{name}: {}",
                mask.area()
            );
        }
    }
}

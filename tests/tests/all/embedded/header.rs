//! The C header is the library's: functions, statuses, and how structs are laid out.

use std::collections::BTreeMap;

use fluoropose::Point;
use fluoropose_embedded::{
    CalibrationNumbers, CameraNumbers, CandidateNumbers, FoundNumbers, Room, Status,
};

const HEADER: &str = include_str!("../../../../core/embedded/include/fluoropose.h");
const EXPORTS: &str = include_str!("../../../../core/embedded/src/exports.rs");

/// The words between two others, over and over.
fn between<'t>(text: &'t str, before: &'t str, after: &'t str) -> impl Iterator<Item = &'t str> {
    text.split(before)
        .skip(1)
        .filter_map(move |rest| rest.split(after).next())
}

#[test]
fn the_headers_functions_are_the_librarys() {
    let parameters = |list: &str| {
        let list = list.split(')').next().unwrap_or_default();
        list.split(',').filter(|one| !one.trim().is_empty()).count()
    };
    let exported: BTreeMap<&str, usize> = between(EXPORTS, "pub unsafe extern \"C\" fn ", "->")
        .filter_map(|one| one.split_once('('))
        .map(|(name, rest)| (name, parameters(rest)))
        .collect();
    assert_eq!(EXPORTS.matches("no_mangle").count(), exported.len());
    let code: String = HEADER
        .split("/*")
        .map(|rest| rest.split_once("*/").map_or(rest, |(_, code)| code))
        .collect();
    let declared: BTreeMap<&str, usize> = code
        .split(';')
        .filter_map(|one| one.split_once('('))
        .filter_map(|(head, rest)| Some((head.rsplit_once("fluoropose_")?.1, parameters(rest))))
        .collect();
    let exported: BTreeMap<&str, usize> = exported
        .into_iter()
        .filter_map(|(name, count)| Some((name.strip_prefix("fluoropose_")?, count)))
        .collect();
    assert_eq!(declared, exported);
    assert_eq!(declared.len(), 15);
    for (name, status) in [
        ("OK", Status::Ok),
        ("POINTER", Status::Pointer),
        ("MEMORY", Status::Memory),
        ("IMPLANT", Status::Implant),
        ("CAMERA", Status::Camera),
        ("OUTLINE", Status::Outline),
        ("ROWS", Status::Rows),
        ("SILHOUETTE", Status::Silhouette),
        ("NO_POSE", Status::NoPose),
        ("ORDER", Status::Order),
        ("MORE", Status::More),
        ("NEAR", Status::Near),
    ] {
        let line = format!("#define FLUOROPOSE_{name} {}", status as i32);
        let mut lines = code.lines().map(str::trim_end);
        assert!(lines.any(|other| other == line), "{line}");
    }
}

/// Names and places of a struct's fields, as C lays them out, and its length.
fn layout(name: &str) -> (Vec<(String, usize)>, usize) {
    let body = between(HEADER, "typedef struct {", "}")
        .zip(between(HEADER, "typedef struct {", ";\n\n").map(|one| one.rsplit("} ").next()))
        .find(|(_, own)| *own == Some(name));
    let (body, _) = body.expect("it is declared");
    let (mut at, mut fields, mut largest) = (0usize, Vec::new(), 1);
    for line in body
        .lines()
        .filter_map(|line| line.trim().split(';').next())
    {
        let Some((kind, field)) = line.split_once(' ') else {
            continue;
        };
        let size = if kind == "double" { 8 } else { 4 };
        assert!(["double", "uint32_t"].contains(&kind), "{kind}");
        let mut parts = field.split(['[', ']']).filter(|part| !part.is_empty());
        let field = parts.next().expect("a name");
        let count: usize = parts
            .map(|part| part.parse::<usize>().expect("a number"))
            .product();
        at = at.next_multiple_of(size);
        fields.push((field.to_string(), at));
        at += size * count;
        largest = largest.max(size);
    }
    (fields, at.next_multiple_of(largest))
}

macro_rules! laid_out {
    ($name:literal, $type:ty, $($field:ident),*) => {
        let fields = [$((stringify!($field).to_string(), std::mem::offset_of!($type, $field))),*];
        assert_eq!(layout($name), (fields.to_vec(), size_of::<$type>()));
    };
}

#[test]
fn the_headers_structs_are_laid_out_as_the_librarys() {
    laid_out!("fluoropose_room", Room, columns, rows, border, runs);
    laid_out!(
        "fluoropose_camera",
        CameraNumbers,
        width,
        height,
        fx,
        fy,
        cx,
        cy
    );
    laid_out!(
        "fluoropose_calibration",
        CalibrationNumbers,
        width,
        height,
        distance_mm,
        pitch_mm,
        right_mm,
        up_mm
    );
    laid_out!("fluoropose_point", Point, column, row);
    laid_out!(
        "fluoropose_found",
        FoundNumbers,
        verdict,
        candidates,
        chosen,
        part
    );
    laid_out!(
        "fluoropose_candidate",
        CandidateNumbers,
        rotation,
        translation_mm,
        rotations_deg,
        covariance,
        misfit_px,
        met,
        drawings,
        has_covariance
    );
}

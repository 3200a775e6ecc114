use super::*;
use crate::camera::Camera;
use crate::canonical::CanonicalSpec;
use crate::image::mask::{Mask, Word};
use crate::image::mask::{MaskMut, words_needed};
use crate::image::silhouette::Silhouette;
use crate::library::Library;
use crate::library::{Builder, ViewAxis, ViewGrid, ViewScratch};
use crate::locate::rerank::Reranked;
use crate::memory::TooLittleMemory;
use crate::mesh::Model;
use crate::pose::{EulerPose, Pose, geodesic_deg};
use crate::render::RenderError;
use crate::render::{Projected, render};
use heapless::Vec;

const SIDE: usize = 512;

/// A crank of four boxes: no symmetry, and an outline with some corners.
fn crank() -> (std::vec::Vec<[f32; 3]>, std::vec::Vec<[u32; 3]>) {
    let boxes = [
        ([-40.0, -12.0, -15.0], [40.0, 12.0, 15.0]),
        ([18.0, 0.0, -10.0], [40.0, 45.0, 8.0]),
        ([-40.0, -38.0, -6.0], [-25.0, 0.0, 14.0]),
        ([-10.0, 5.0, -25.0], [5.0, 24.0, 10.0]),
    ];
    let (mut vertices, mut triangles) = (std::vec::Vec::new(), std::vec::Vec::new());
    for (low, high) in boxes {
        let first = vertices.len() as u32;
        for corner in 0..8 {
            let pick = |k: usize| {
                if corner >> k & 1 == 1 {
                    high[k]
                } else {
                    low[k]
                }
            };
            vertices.push([pick(0), pick(1), pick(2)]);
        }
        for [a, b, c, d] in [
            [0, 1, 3, 2],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 3, 7, 6],
            [0, 2, 6, 4],
            [1, 3, 7, 5],
        ] {
            triangles.push([a, b, c].map(|v| first + v));
            triangles.push([a, c, d].map(|v| first + v));
        }
    }
    (vertices, triangles)
}

fn camera() -> Camera {
    Camera::new(SIDE, SIDE, [1800.0, 1800.0], [256.0, 256.0]).expect("valid")
}

fn library(model: Model<'_>) -> std::vec::Vec<u8> {
    let axis = ViewAxis {
        first: -8.0,
        step: 2.0,
        count: 9,
    };
    let (grid, canonical) = (ViewGrid { x: axis, y: axis }, CanonicalSpec::default());
    let builder = Builder::new(model, camera(), canonical, grid, 1000.0).expect("possible");
    let mut bytes = std::vec![0; builder.bytes_needed()];
    let mut scratch = ViewScratch {
        projected: &mut std::vec![Projected::default(); builder.projected_needed()],
        render: &mut std::vec![0; builder.render_words_needed()],
        canonical: &mut std::vec![0; canonical.words_needed()],
    };
    builder.build(&mut bytes, &mut scratch).expect("renders");
    bytes
}

fn draw(model: &Model<'_>, pose: &Pose) -> std::vec::Vec<Word> {
    let mut words = std::vec![0; words_needed(SIDE, SIDE)];
    let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
    let mut scratch = std::vec![Projected::default(); model.vertices().len()];
    render(model, &camera(), pose, &mut scratch, &mut mask).expect("in front");
    words
}

/// Columns `from..to` of a frame.
fn band(from: i64, to: i64) -> std::vec::Vec<Word> {
    let mut words = std::vec![0; words_needed(SIDE, SIDE)];
    let mut mask = MaskMut::new(&mut words, SIDE, SIDE).expect("fits");
    for row in 0..SIDE {
        mask.fill_span(row, from, to);
    }
    words
}

/// Memory of the lengths asked for, one word less of what `short` names.
fn locate(
    silhouette: &Silhouette<'_>,
    camera: &Camera,
    library: &Library<'_>,
    model: &Model<'_>,
    short: &str,
) -> Result<Vec<Reranked, 4>, PartialError> {
    let needs = partial_needed(library, camera, model);
    let less = |what: &str, needed: usize| needed - usize::from(what == short);
    let memory = PartialMemory {
        words: &mut std::vec![0; less("words", needs.words)],
        sides: &mut std::vec![PixelSide::default(); less("sides", needs.sides)],
        points: &mut std::vec![OutlinePoint::default(); less("points", needs.points)],
        cells: &mut std::vec![0; less("cells", needs.cells)],
        numbers: &mut std::vec![0.0; less("numbers", needs.numbers)],
        hypotheses: &mut std::vec![Hypothesis::default(); less("hypotheses", needs.hypotheses)],
        projected: &mut std::vec![Projected::default(); less("projected vertices", needs.projected)],
    };
    locate_partial(silhouette, camera, library, model, memory)
}

fn pose() -> Pose {
    Pose::from(EulerPose {
        x_mm: 9.0,
        y_mm: -14.0,
        z_mm: -930.0,
        z_rot_deg: 128.0,
        x_rot_deg: 4.6,
        y_rot_deg: -3.3,
    })
}

fn assert_found(found: &Reranked, pose: &Pose, what: &str) {
    let off = geodesic_deg(&found.located.pose.rotation, &pose.rotation);
    assert!(off < 4.0, "{what}: {off} deg");
    for (k, limit) in [3.0, 3.0, 40.0].into_iter().enumerate() {
        let off = found.located.pose.translation[k] - pose.translation[k];
        assert!(off.abs() < limit, "{what}: {off} mm along axis {k}");
    }
}

#[test]
fn a_pose_is_found_from_what_an_occluder_leaves() {
    let (vertices, triangles) = crank();
    let model = Model::from_triangles(&vertices, &triangles).expect("valid");
    let bytes = library(model);
    let library = Library::open(&bytes).expect("valid");
    let words = draw(&model, &pose());
    let hidden = band(250, 330);
    for solid in [false, true] {
        let seen: std::vec::Vec<Word> = words
            .iter()
            .zip(&hidden)
            .map(|(set, hidden)| if solid { set | hidden } else { set & !hidden })
            .collect();
        let mask = Mask::new(&seen, SIDE, SIDE).expect("valid");
        let unknown = Mask::new(&hidden, SIDE, SIDE).expect("valid");
        let silhouette = Silhouette::new(&mask, &unknown).expect("one size");
        assert!(known_fraction(&silhouette).is_partial());
        let found = locate(&silhouette, &camera(), &library, &model, "").expect("found");
        assert_found(&found[0], &pose(), if solid { "solid" } else { "clear" });
    }
    let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
    let whole = Silhouette::from(&mask);
    let found = locate(&whole, &camera(), &library, &model, "").expect("found");
    assert_found(&found[0], &pose(), "whole");
}

#[test]
fn a_pose_is_found_where_the_frame_cuts_the_object_off() {
    let (vertices, triangles) = crank();
    let model = Model::from_triangles(&vertices, &triangles).expect("valid");
    let bytes = library(model);
    let library = Library::open(&bytes).expect("valid");
    let mut cut = pose();
    cut.translation[0] = 117.0;
    let words = draw(&model, &cut);
    let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
    let silhouette = Silhouette::from(&mask);
    assert!(known_fraction(&silhouette).cut > 20);
    let found = locate(&silhouette, &camera(), &library, &model, "").expect("found");
    assert_found(&found[0], &cut, "cut");
}

#[test]
fn what_cannot_be_done_is_said() {
    let (vertices, triangles) = crank();
    let model = Model::from_triangles(&vertices, &triangles).expect("valid");
    let bytes = library(model);
    let library = Library::open(&bytes).expect("valid");
    let words = draw(&model, &pose());
    let mask = Mask::new(&words, SIDE, SIDE).expect("valid");
    let whole = Silhouette::from(&mask);
    for what in [
        "words",
        "sides",
        "points",
        "cells",
        "numbers",
        "hypotheses",
        "projected vertices",
    ] {
        let error = locate(&whole, &camera(), &library, &model, what).expect_err("short");
        let named = matches!(error, PartialError::Memory(TooLittleMemory { what: named, needed, given })
            if named == what && given + 1 == needed);
        assert!(named, "{what}: {error}");
    }
    let other = Camera::new(SIDE, 400, [1800.0; 2], [256.0; 2]).expect("valid");
    let error = locate(&whole, &other, &library, &model, "");
    assert_eq!(error, Err(PartialError::Render(RenderError::Size)));
    for (from, to) in [(0, SIDE as i64), (0, 340)] {
        let hidden = band(from, to);
        let unknown = Mask::new(&hidden, SIDE, SIDE).expect("valid");
        let silhouette = Silhouette::new(&mask, &unknown).expect("one size");
        let error = locate(&silhouette, &camera(), &library, &model, "").expect_err("unknown");
        let expected = match (from, to) {
            (0, 340) => matches!(error, PartialError::TooShort { known, needed } if known < needed),
            _ => matches!(error, PartialError::NothingKnown { .. }),
        };
        assert!(expected, "{error}");
    }
    // A chessboard is all outline.
    let squares: std::vec::Vec<Word> = (0..words.len())
        .map(|at| {
            if (at / (SIDE / 32)).is_multiple_of(2) {
                0x5555_5555
            } else {
                0xaaaa_aaaa
            }
        })
        .collect();
    let mask = Mask::new(&squares, SIDE, SIDE).expect("valid");
    // Each square alone is no piece; diagonals that touch are kept apart.
    let error = locate(&Silhouette::from(&mask), &camera(), &library, &model, "");
    assert!(matches!(error, Err(PartialError::NothingKnown { .. })));
    let bars: std::vec::Vec<Word> = std::vec![0x5555_5555; words.len()];
    let mask = Mask::new(&bars, SIDE, SIDE).expect("valid");
    let error = locate(&Silhouette::from(&mask), &camera(), &library, &model, "");
    assert!(matches!(error, Err(PartialError::TooRough(_))));
}

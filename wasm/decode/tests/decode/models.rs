use fluoropose_decode::{Model, Problem, decode_model};

use crate::samples::models::{
    TRIANGLES, VERTICES, obj, ply_ascii, ply_big_double, ply_header, ply_little, stl_ascii,
    stl_binary,
};

fn model(bytes: impl AsRef<[u8]>) -> Model {
    decode_model(bytes.as_ref(), "m").unwrap_or_else(|error| panic!("{error}"))
}

fn refused(bytes: impl AsRef<[u8]>) -> Problem {
    decode_model(bytes.as_ref(), "m").unwrap_err().problem
}

/// The corners of each triangle, which do not depend on the order of vertices.
fn corners(model: &Model) -> Vec<[[f32; 3]; 3]> {
    let place = |i: u32| model.vertices[i as usize];
    model.triangles.iter().map(|t| t.map(place)).collect()
}

fn assert_tetrahedron(model: &Model) {
    let due: Vec<_> = TRIANGLES
        .iter()
        .map(|t| t.map(|i| VERTICES[i as usize]))
        .collect();
    assert_eq!(corners(model), due);
    assert_eq!(model.vertices.len(), 4);
}

#[test]
fn obj_lines_go_on_behind_a_backslash_but_comments_do_not() {
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n";
    for faces in [
        "f 1 2 3\nf 1 3 4\nf 3 4 5 \\",
        "f 1 2 3\nf 1 3 \\\n4\nf 3 4 5 \\\n",
        "# from C:\\models\\\nf 1 2 3\nf 1 3 4\nf 3 4 5\n",
    ] {
        assert_eq!(
            model(format!("{corners}{faces}").as_bytes())
                .triangles
                .len(),
            3,
            "{faces}"
        );
    }
}

#[test]
fn every_format_gives_the_tetrahedron() {
    assert_tetrahedron(&model(stl_binary("made by hand")));
    assert_tetrahedron(&model(stl_ascii()));
    assert_tetrahedron(&model(obj()));
    assert_tetrahedron(&model(ply_ascii()));
    assert_tetrahedron(&model(ply_little()));
    assert_tetrahedron(&model(ply_big_double()));
}

#[test]
fn a_binary_stl_may_call_itself_solid() {
    assert_tetrahedron(&model(stl_binary("solid facet endsolid")));
    assert_tetrahedron(&model(stl_binary("solid\nfacet normal 0 0 0\n")));
}

#[test]
fn ascii_stl_is_read_generously() {
    assert_tetrahedron(&model(stl_ascii().to_uppercase()));
    assert_tetrahedron(&model(stl_ascii().replace('\n', "\r\n\r\n")));
    assert_tetrahedron(&model(stl_ascii().replacen(
        "solid tetrahedron",
        "solid",
        1,
    )));
    let mut latin = stl_ascii().into_bytes();
    latin.splice(6..6, [0xE9, 0xFF, b' ']);
    assert_tetrahedron(&model(latin));
}

#[test]
fn several_solids_become_one_model() {
    let moved = stl_ascii().replace("vertex ", "vertex 1");
    let model = model(stl_ascii() + "\n" + &moved + "\n");
    assert_eq!(model.triangles.len(), 8);
    assert_eq!(model.vertices.len(), 8);
}

#[test]
fn a_coordinate_that_is_no_number_is_told_with_its_line() {
    let refused = |text: String| decode_model(text.into_bytes(), "knee.stl").unwrap_err();
    let text = stl_ascii();
    let line = 1 + text
        .lines()
        .take_while(|line| !line.contains("vertex"))
        .count();
    let comma = refused(text.replacen("vertex 0", "vertex 0,5", 1)).to_string();
    assert!(
        comma.contains(&format!("line {line} has '0,5")) && comma.contains("not a comma"),
        "{comma}"
    );
    let word = refused(text.replacen("vertex 0", "vertex x", 1)).to_string();
    assert!(
        word.contains(&format!("line {line} has 'x")) && !word.contains("comma"),
        "{word}"
    );
}

#[test]
fn a_model_in_another_form_is_to_be_exported_as_a_mesh() {
    for (bytes, name) in [
        (&b"ISO-10303-21;"[..], "knee.txt"),
        (b"PK\x03\x04", "knee.3mf"),
        (b"glTF\x02\0\0\0", "knee"),
    ] {
        let error = decode_model(bytes, name).unwrap_err();
        assert_eq!(error.problem, Problem::OtherModel);
        assert!(error.to_string().contains("STL, OBJ or PLY"), "{error}");
    }
}

#[test]
fn a_wrong_number_of_triangles_is_told() {
    let mut file = stl_binary("x");
    file[80] = 5;
    assert_eq!(
        decode_model(&file, "knee.stl").unwrap_err().to_string(),
        "knee.stl: this STL file is damaged or incomplete: it states 5 triangles, which take 334 bytes, and has 284 \
         bytes. Copy or export it again."
    );
    file[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let problem = decode_model(&file, "knee.stl").unwrap_err().problem;
    assert_eq!(
        problem,
        Problem::TooManyTriangles {
            triangles: u32::MAX.into()
        }
    );
}

#[test]
fn filling_after_the_last_triangle_is_left_out_and_noted() {
    for filling in [vec![0; 1], vec![0; 4096], b"\r\n".to_vec(), vec![7; 49]] {
        let mut file = stl_binary("x");
        file.extend(&filling);
        let model = decode_model(&file, "knee.stl").unwrap();
        assert_tetrahedron(&model);
        let note = format!(
            "{} bytes after the last of its 4 triangles were left out.",
            filling.len()
        );
        assert_eq!(model.notes, [note]);
    }
    assert!(model(stl_binary("x")).notes.is_empty());
    let by_name = |file: &[u8]| decode_model(file, "knee.stl").unwrap_err().problem;
    // What may be a triangle that the header does not count is no filling.
    let mut more = stl_binary("x");
    more.extend([7; 50]);
    assert!(matches!(by_name(&more), Problem::Damaged { .. }));
    // A header that was never filled in.
    let mut uncounted = stl_binary("x");
    uncounted[80..84].fill(0);
    assert!(matches!(by_name(&uncounted), Problem::Damaged { .. }));
}

#[test]
fn an_stl_of_nothing_is_an_empty_model() {
    assert_eq!(refused([0; 84]), Problem::EmptyModel);
    assert_eq!(refused("solid x\nendsolid x\n"), Problem::EmptyModel);
    assert_eq!(
        decode_model(b"", "x.stl").unwrap_err().problem,
        Problem::Empty
    );
}

#[test]
fn zero_is_zero_whatever_its_sign_and_slivers_are_dropped() {
    let text = "v -0 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 3 4\nf 1 2 3\nf 2 4 3\nf 1 1 3\n";
    let model = model(text);
    // The second triangle has two corners at the origin; the last vertex belongs to none.
    assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 1]]);
    assert_eq!(
        model.vertices,
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    );
    assert!(
        model
            .vertices
            .as_flattened()
            .iter()
            .all(|c| c.to_bits() != (-0.0f32).to_bits())
    );
    assert_eq!(
        refused("v 0 0 0\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"),
        Problem::EmptyModel
    );
}

#[test]
fn obj_polygons_become_fans_and_objects_are_merged() {
    let text = "mtllib x.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0 1\nv 0 1 0 0.5 0.5 0.5\nv -1 0.5 0\nvt 0 0\nvn 0 0 1\n\
                usemtl none\nf 1/1/1 2//1 3/1 4\ng b\ns off\nf -5 -3 \\\n -2 -1 # back\nl 1 2\nf 1 2 3 4 5\n";
    let model = model(text);
    assert_eq!(model.vertices.len(), 5);
    let due = [
        [0, 1, 2],
        [0, 2, 3],
        [0, 2, 3],
        [0, 3, 4],
        [0, 1, 2],
        [0, 2, 3],
        [0, 3, 4],
    ];
    assert_eq!(model.triangles, due);
}

#[test]
fn obj_with_wrong_indices_is_refused() {
    for face in [
        "f 1 2 4",
        "f 0 1 2",
        "f -4 1 2",
        "f 1 2",
        "f",
        "f a b c",
        "f 1 2 99999999999999999999",
        "f -9223372036854775808 1 2",
    ] {
        let problem = refused(format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{face}\n"));
        assert!(
            matches!(problem, Problem::Damaged { .. }),
            "{face}: {problem}"
        );
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let problem = refused("v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(problem, Problem::NonFiniteVertex { vertex: 1 });
    let mut file = stl_binary("x");
    file[96..100].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert_eq!(refused(file), Problem::NonFiniteVertex { vertex: 0 });
    let mut file = ply_little();
    let first = ply_header("binary_little_endian", "float", "int").len();
    file[first..first + 4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(refused(file), Problem::NonFiniteVertex { vertex: 0 });
    assert!(matches!(
        refused(stl_ascii().replace("8.25", "1e99")),
        Problem::Damaged { .. }
    ));
}

#[test]
fn ply_faces_of_many_corners_become_fans() {
    let text = "ply\r\nformat ascii 1.0\r\nelement vertex 5\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n\
                element face 1\r\nproperty list uchar int vertex_index\r\nend_header\r\n0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n\
                -1 0.5 0\r\n5 0 1 2 3 4\r\n";
    assert_eq!(model(text).triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
}

#[test]
fn ply_with_wrong_faces_is_refused() {
    let problem = refused(ply_ascii().replace("3 1 2 3", "3 1 2 4"));
    assert_eq!(
        problem,
        Problem::VertexIndex {
            index: 4,
            vertices: 4
        }
    );
    let problem = refused(ply_ascii().replace("3 1 2 3", "3 1 2 -1"));
    assert_eq!(
        problem,
        Problem::VertexIndex {
            index: -1,
            vertices: 4
        }
    );
    for (from, to) in [
        ("3 1 2 3", "2 1 2"),
        ("3 1 2 3", "3 1 2"),
        ("float z", "float w"),
        ("element face 4", "element face 400000"),
    ] {
        let problem = refused(ply_ascii().replace(from, to));
        assert!(
            matches!(problem, Problem::Damaged { .. }),
            "{to}: {problem}"
        );
    }
    let problem = refused(ply_ascii().replace("element face 4", "element face 40000000"));
    assert_eq!(
        problem,
        Problem::TooManyTriangles {
            triangles: 40_000_000
        }
    );
    let problem = refused(ply_ascii().replace("element vertex 4", "element vertex 40000000"));
    assert_eq!(
        problem,
        Problem::TooManyVertices {
            vertices: 40_000_000
        }
    );
}

#[test]
fn files_that_are_not_models_are_named() {
    assert_eq!(
        refused("JT_INTCALIB\n1198\n"),
        Problem::NotAModel {
            found: "a calibration"
        }
    );
    assert_eq!(
        refused("hello"),
        Problem::NotAModel {
            found: "a file of an unknown kind"
        }
    );
}

//! The same tetrahedron in every model format.

pub(crate) const VERTICES: [[f32; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [10.0, 0.5, 0.0],
    [0.0, 8.25, -1.0],
    [1.5, 2.0, 12.0],
];
pub(crate) const TRIANGLES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

fn corners() -> impl Iterator<Item = [[f32; 3]; 3]> {
    TRIANGLES.iter().map(|t| t.map(|i| VERTICES[i as usize]))
}

/// A binary STL with this text at the start of its header.
pub(crate) fn stl_binary(title: &str) -> Vec<u8> {
    let mut file = title.as_bytes().to_vec();
    file.resize(80, 0);
    file.extend((TRIANGLES.len() as u32).to_le_bytes());
    for triangle in corners() {
        file.extend([0; 12]);
        file.extend(triangle.as_flattened().iter().flat_map(|c| c.to_le_bytes()));
        file.extend([0, 0]);
    }
    file
}

pub(crate) fn stl_ascii() -> String {
    let mut file = "solid tetrahedron\n".to_owned();
    for triangle in corners() {
        file += "facet normal 0 0 0\n outer loop\n";
        for [x, y, z] in triangle {
            file += &format!("  vertex {x} {y:e} {z}\n");
        }
        file += " endloop\nendfacet\n";
    }
    file + "endsolid tetrahedron"
}

pub(crate) fn obj() -> String {
    let vertices = VERTICES
        .map(|[x, y, z]| format!("v {x} {y} {z}\n"))
        .concat();
    let faces = TRIANGLES
        .map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1))
        .concat();
    format!("# a tetrahedron\no tetrahedron\n{vertices}{faces}")
}

/// The header of a PLY with this encoding, scalar type of coordinates and type of corners.
pub(crate) fn ply_header(encoding: &str, coordinate: &str, corner: &str) -> String {
    format!(
        "ply\nformat {encoding} 1.0\ncomment by hand\nelement vertex 4\nproperty {coordinate} x\n\
         property {coordinate} y\nproperty {coordinate} z\nproperty uchar quality\nelement face 4\n\
         property list uchar {corner} vertex_indices\nend_header\n"
    )
}

pub(crate) fn ply_ascii() -> String {
    let vertices = VERTICES
        .map(|[x, y, z]| format!("{x} {y} {z} 7\n"))
        .concat();
    let faces = TRIANGLES
        .map(|[a, b, c]| format!("3 {a} {b} {c}\n"))
        .concat();
    ply_header("ascii", "float", "int") + &vertices + &faces
}

pub(crate) fn ply_little() -> Vec<u8> {
    let mut file = ply_header("binary_little_endian", "float", "int").into_bytes();
    for vertex in VERTICES {
        file.extend(vertex.iter().flat_map(|c| c.to_le_bytes()));
        file.push(7);
    }
    for triangle in TRIANGLES {
        file.push(3);
        file.extend(triangle.iter().flat_map(|c| c.to_le_bytes()));
    }
    file
}

/// Big endian, coordinates in double precision, corners of 16 bits.
pub(crate) fn ply_big_double() -> Vec<u8> {
    let mut file = ply_header("binary_big_endian", "double", "ushort").into_bytes();
    for vertex in VERTICES {
        file.extend(vertex.iter().flat_map(|&c| f64::from(c).to_be_bytes()));
        file.push(7);
    }
    for triangle in TRIANGLES {
        file.push(3);
        file.extend(triangle.iter().flat_map(|&c| (c as u16).to_be_bytes()));
    }
    file
}

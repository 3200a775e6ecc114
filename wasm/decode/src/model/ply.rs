//! PLY, ASCII and binary of either byte order: vertices and faces.

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};

use super::raw::{Raw, check_triangles, check_vertices};
use crate::error::Problem;
use crate::limits::MAX_VERTICES;

const FORMAT: &str = "PLY";

/// One element of any kind; what is not a position or a list of corners is ignored.
struct Element {
    position: [Option<f64>; 3],
    corners: Vec<i64>,
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self {
            position: [None; 3],
            corners: Vec::new(),
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let axis = ["x", "y", "z"].iter().position(|axis| *axis == name);
        if let Some(axis) = axis {
            self.position[axis] = number(&property);
        } else if is_corner_list(name) {
            self.corners = whole_numbers(property);
        } else {
            return PropertyAccessResult::Ignored;
        }
        PropertyAccessResult::Set
    }
}

fn is_corner_list(name: &str) -> bool {
    matches!(name, "vertex_indices" | "vertex_index")
}

fn number(property: &Property) -> Option<f64> {
    Some(match *property {
        Property::Char(v) => v.into(),
        Property::UChar(v) => v.into(),
        Property::Short(v) => v.into(),
        Property::UShort(v) => v.into(),
        Property::Int(v) => v.into(),
        Property::UInt(v) => v.into(),
        Property::Float(v) => v.into(),
        Property::Double(v) => v,
        _ => return None,
    })
}

/// The numbers of a list; empty for anything else (a list of fractions, a single number).
fn whole_numbers(property: Property) -> Vec<i64> {
    fn widened<T: Into<i64>>(list: Vec<T>) -> Vec<i64> {
        list.into_iter().map(Into::into).collect()
    }
    match property {
        Property::ListChar(v) => widened(v),
        Property::ListUChar(v) => widened(v),
        Property::ListShort(v) => widened(v),
        Property::ListUShort(v) => widened(v),
        Property::ListInt(v) => widened(v),
        Property::ListUInt(v) => widened(v),
        _ => Vec::new(),
    }
}

/// Reads vertices and faces; faces of more than three corners become fans.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, Problem> {
    let failed = |e: ply_rs_bw::parser::ParseError| Problem::damaged(FORMAT, e.to_string());
    let parser = Parser::<Element>::new();
    let mut reader = Reader::new(bytes);
    let header = parser.read_header(&mut reader).map_err(failed)?;
    let mut raw = Raw::default();
    let mut faces = Vec::new();
    for definition in header.elements.values() {
        check_count(definition, header.encoding, reader.get_ref().len())?;
        let elements = parser
            .read_payload_for_element(&mut reader, definition, &header)
            .map_err(failed)?;
        match definition.name.as_str() {
            "vertex" => raw.vertices = positions(&elements)?,
            "face" => faces = elements,
            _ => {}
        }
    }
    for (index, face) in faces.iter().enumerate() {
        let corners = corners(face, index, raw.vertices.len())?;
        raw.push_face(&corners)?;
    }
    Ok(raw)
}

/// Refuses more elements than the rest of the file could hold.
fn check_count(definition: &ElementDef, encoding: Encoding, left: usize) -> Result<(), Problem> {
    let stated = definition.count;
    match definition.name.as_str() {
        "vertex" => check_vertices(stated)?,
        "face" => check_triangles(stated)?,
        _ => {}
    }
    let least: usize = match encoding {
        // A line each, its break included; the last may lack it.
        Encoding::Ascii => 2 * definition.properties.len(),
        _ => definition
            .properties
            .values()
            .map(|p| least_bytes(&p.data_type))
            .sum(),
    };
    let possible =
        stated == 0 || (least > 0 && stated <= MAX_VERTICES && (stated - 1) <= left / least);
    match possible {
        true => Ok(()),
        false => Err(Problem::damaged(
            FORMAT,
            format!(
                "it states {stated} of '{}' and has {left} bytes left for them",
                definition.name
            ),
        )),
    }
}

/// The fewest bytes that a property takes in a binary file.
fn least_bytes(kind: &PropertyType) -> usize {
    let (PropertyType::Scalar(scalar) | PropertyType::List(scalar, _)) = kind;
    match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}

fn positions(elements: &[Element]) -> Result<Vec<[f32; 3]>, Problem> {
    let position = |element: &Element| match element.position {
        [Some(x), Some(y), Some(z)] => Ok([x as f32, y as f32, z as f32]),
        _ => Err(Problem::damaged(FORMAT, "its vertices lack x, y or z")),
    };
    elements.iter().map(position).collect()
}

fn corners(face: &Element, index: usize, vertices: usize) -> Result<Vec<u32>, Problem> {
    if face.corners.len() < 3 {
        let detail = format!("face {} has fewer than three corners", index + 1);
        return Err(Problem::damaged(FORMAT, detail));
    }
    let corner = |&corner: &i64| match u32::try_from(corner) {
        Ok(corner) if (corner as usize) < vertices => Ok(corner),
        _ => Err(Problem::VertexIndex {
            index: corner,
            vertices,
        }),
    };
    face.corners.iter().map(corner).collect()
}

//! STL, binary and ASCII.
//!
//! Some exporters pad a binary file to a block, or end it with a few bytes of their own. Bytes after the last triangle are
//! left out, and a note says so, if they cannot be triangles: any number of zeros and blanks, or fewer bytes than a
//! triangle has. Anything else may be triangles that the header does not count, and is refused: a model with a missing part
//! gives a wrong pose.

use std::borrow::Cow;
use std::io::Cursor;

use stl_io::{Triangle, create_stl_reader};

use super::raw::{Raw, check_triangles};
use crate::error::Problem;
use crate::sniff::stl_form::{
    HEADER, PER_TRIANGLE, binary_length, is_ascii, is_binary, stated_triangles,
};

const FORMAT: &str = "STL";
/// Reads the triangles.
pub(super) fn read(bytes: Cow<'_, [u8]>) -> Result<Raw, Problem> {
    match is_ascii(&bytes) && !is_binary(&bytes, bytes.len()) {
        true => read_ascii(&bytes),
        false => read_binary(bytes),
    }
}

/// Whether bytes after the last triangle cannot be triangles.
fn is_filling(rest: &[u8]) -> bool {
    (rest.len() as u64) < PER_TRIANGLE
        || rest
            .iter()
            .all(|byte| matches!(byte, 0 | b' ' | b'\r' | b'\n'))
}

fn read_binary(bytes: Cow<'_, [u8]>) -> Result<Raw, Problem> {
    let count = stated_triangles(&bytes)
        .ok_or_else(|| Problem::damaged(FORMAT, "it is shorter than its header"))?;
    check_triangles(count as usize)?;
    let needed = binary_length(count);
    let counted = usize::try_from(needed)
        .ok()
        .and_then(|needed| bytes.split_at_checked(needed));
    let Some((counted, rest)) = counted
        .filter(|(_, rest)| count > 0 && is_filling(rest) || rest.is_empty())
        .map(|(counted, rest)| (counted.len(), rest.len()))
    else {
        let found = bytes.len();
        return Err(Problem::damaged(
            FORMAT,
            format!(
                "it states {count} triangles, which take {needed} bytes, and has {found} bytes"
            ),
        ));
    };
    // An empty line as header: the library takes `solid ` there for the ASCII form.
    let mut content = bytes.into_owned();
    content.truncate(counted);
    content[..HEADER].fill(b'\n');
    let mut raw = Raw::default();
    push_solid(content, &mut raw)?;
    if rest > 0 {
        raw.notes.push(format!(
            "{rest} bytes after the last of its {count} triangles were left out."
        ));
    }
    Ok(raw)
}

/// Reads every solid of an ASCII file; keywords may be in capitals.
fn read_ascii(bytes: &[u8]) -> Result<Raw, Problem> {
    let text = String::from_utf8_lossy(bytes).to_ascii_lowercase();
    let mut raw = Raw::default();
    let mut solid: Option<String> = None;
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        check_corner(number + 1, line)?;
        match (line.split_ascii_whitespace().next(), &mut solid) {
            (None, _) => {}
            // The library wants a name; names are of no use here and may be in any encoding.
            (Some("solid"), None) => solid = Some("solid model\n".to_owned()),
            (Some("endsolid"), Some(_)) => {
                let mut whole = solid.take().unwrap_or_default();
                whole.push_str("endsolid model\n");
                push_solid(whole.into_bytes(), &mut raw)?;
            }
            (Some(_), Some(body)) => {
                body.push_str(line);
                body.push('\n');
            }
            (Some(_), None) => {
                let shown: String = line.chars().take(40).collect();
                let detail = format!("there is '{shown}' outside of any solid");
                return Err(Problem::damaged(FORMAT, detail));
            }
        }
    }
    match solid {
        Some(_) => Err(Problem::damaged(FORMAT, "it ends before the word endsolid")),
        None => Ok(raw),
    }
}

/// The library does not say where a corner has something else than three numbers.
fn check_corner(number: usize, line: &str) -> Result<(), Problem> {
    let mut words = line.split_ascii_whitespace();
    if words.next() != Some("vertex") {
        return Ok(());
    }
    match words.find(|word| word.parse::<f32>().is_err()) {
        None => Ok(()),
        Some(word) => {
            let shown: String = word.chars().take(40).collect();
            let comma = match word.contains(',') {
                true => "; numbers want a point, not a comma",
                false => "",
            };
            let detail =
                format!("line {number} has '{shown}' where a coordinate is expected{comma}");
            Err(Problem::damaged(FORMAT, detail))
        }
    }
}

/// Lets the library read one solid.
fn push_solid(content: Vec<u8>, raw: &mut Raw) -> Result<(), Problem> {
    let mut cursor = Cursor::new(content);
    let failed = |e: std::io::Error| Problem::damaged(FORMAT, e.to_string());
    for triangle in create_stl_reader(&mut cursor).map_err(failed)? {
        let Triangle { vertices, .. } = triangle.map_err(failed)?;
        // Within u32: the number of triangles is bounded before and after.
        let first = raw.vertices.len() as u32;
        raw.vertices.extend(vertices.map(|v| v.0));
        raw.push_face(&[first, first + 1, first + 2])?;
    }
    Ok(())
}

//! Wavefront OBJ: vertices and faces of all its objects.
//!
//! The file is first reduced to `v` and `f` lines with positions alone. That is all a silhouette needs, and it
//! keeps the rest (texture and normal indices, materials, names in any encoding), which the library does not check
//! as strictly, away from it.

use std::fmt::Write;

use tobj::{LoadError, LoadOptions};

use super::raw::{Raw, check_triangles, check_vertices};
use crate::error::Problem;

const FORMAT: &str = "OBJ";

/// Reads positions and faces; faces of more than three corners become fans.
pub(super) fn read(bytes: &[u8]) -> Result<Raw, Problem> {
    let text = String::from_utf8_lossy(bytes);
    let reduced = reduce(&text)?;
    let options = LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..LoadOptions::default()
    };
    let no_materials = |_: &std::path::Path| Err(LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut reduced.as_bytes(), &options, no_materials)
        .map_err(|e| Problem::damaged(FORMAT, e.to_string()))?;
    let mut raw = Raw::default();
    for model in models {
        // Within u32: vertices are bounded by `reduce`.
        let first = raw.vertices.len() as u32;
        raw.vertices
            .extend_from_slice(model.mesh.positions.as_chunks().0);
        let triangles = model.mesh.indices.as_chunks::<3>().0;
        raw.triangles
            .extend(triangles.iter().map(|t| t.map(|i| first + i)));
    }
    Ok(raw)
}

/// The positions and faces of a file, a line each, with lines that a backslash continues joined.
fn reduce(text: &str) -> Result<String, Problem> {
    let (mut reduced, mut joined) = (String::new(), String::new());
    let (mut vertices, mut triangles) = (0, 0);
    let mut lines = text.lines().enumerate().peekable();
    while let Some((number, line)) = lines.next() {
        let line = line.trim_end();
        let is_comment = joined.is_empty() && line.trim_start().starts_with('#');
        if let Some(begun) = line.strip_suffix('\\').filter(|_| !is_comment) {
            joined.push_str(begun);
            joined.push(' ');
            // Behind the last line nothing comes that would go on with it.
            if lines.peek().is_some() {
                continue;
            }
        } else {
            joined.push_str(line);
        }
        let mut words = joined.split_ascii_whitespace();
        let wrong = |what| Problem::damaged(FORMAT, format!("line {} {what}", number + 1));
        match words.next() {
            Some("v") => {
                vertices += 1;
                push_position(words, &mut reduced).ok_or_else(|| wrong("is not three numbers"))?;
            }
            Some("f") => {
                let corners = push_face(words, vertices, &mut reduced)
                    .ok_or_else(|| wrong("names a vertex that is not there or too few"))?;
                triangles += corners - 2;
            }
            _ => {}
        }
        joined.clear();
        check_vertices(vertices)?;
        check_triangles(triangles)?;
    }
    Ok(reduced)
}

/// Copies the first three numbers of a `v` line; a weight or a colour may follow and is left out.
fn push_position<'a>(words: impl Iterator<Item = &'a str>, reduced: &mut String) -> Option<()> {
    let mut count = 0;
    reduced.push('v');
    for word in words.take(3) {
        word.parse::<f32>().ok()?;
        write!(reduced, " {word}").ok()?;
        count += 1;
    }
    reduced.push('\n');
    (count == 3).then_some(())
}

/// Copies the position index of each corner of an `f` line, made absolute; gives the number of corners.
fn push_face<'a>(
    words: impl Iterator<Item = &'a str>,
    vertices: usize,
    reduced: &mut String,
) -> Option<usize> {
    let mut count = 0;
    reduced.push('f');
    for word in words.take_while(|word| !word.starts_with('#')) {
        let stated: i64 = word.split('/').next()?.parse().ok()?;
        // Positive from 1, negative from the last vertex so far.
        let absolute = match stated {
            ..0 => stated.checked_add_unsigned(vertices as u64)? + 1,
            _ => stated,
        };
        (absolute >= 1).then_some(())?;
        write!(reduced, " {absolute}").ok()?;
        count += 1;
    }
    reduced.push('\n');
    (count >= 3).then_some(count)
}

//! Binary or ASCII: the two forms of STL.
//!
//! Length tells which of the two a file is, not the first word: a binary header may begin with `solid`.

/// Bytes before the number of triangles of a binary file.
pub(crate) const HEADER: usize = 80;
/// Bytes before the first triangle.
const PREFIX: usize = HEADER + 4;
/// Bytes of a triangle.
pub(crate) const PER_TRIANGLE: u64 = 50;

/// The number of triangles that a binary file states.
pub(crate) fn stated_triangles(bytes: &[u8]) -> Option<u32> {
    let field = bytes.get(HEADER..PREFIX)?;
    Some(u32::from_le_bytes(field.try_into().ok()?))
}

/// Whether a file with this head and `length` bytes in all is exactly as long as a binary file of the triangles that it
/// states.
pub(crate) fn is_binary(head: &[u8], length: usize) -> bool {
    stated_triangles(head).is_some_and(|count| binary_length(count) == length as u64)
}

/// Whether the content begins like the ASCII form: the word `solid`, then text with `facet` or `endsolid`.
pub(crate) fn is_ascii(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(1024)]).to_ascii_lowercase();
    let text = text.trim_start();
    text.starts_with("solid") && (text.contains("facet") || text.contains("endsolid"))
}

/// Bytes of a binary file of this number of triangles.
pub(crate) fn binary_length(triangles: u32) -> u64 {
    PREFIX as u64 + PER_TRIANGLE * u64::from(triangles)
}

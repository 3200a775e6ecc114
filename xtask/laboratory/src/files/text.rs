//! Files and folders as they are: bytes, text, JSON, names.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use fluoropose_report::Figure;
use sha2::{Digest, Sha256};

/// Reads a whole file.
///
/// # Errors
/// Names the file.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).with_context(|| format!("cannot read {}", path.display()))
}

/// Reads a text file.
///
/// # Errors
/// Names the file.
pub fn read_text(path: &Path) -> Result<String> {
    let text = String::from_utf8(read(path)?).ok();
    text.with_context(|| format!("{} is no text", path.display()))
}

/// The name of a file without its folder.
pub fn name_of(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// The files of a folder in name order: the order of the frames.
///
/// # Errors
/// When the folder cannot be listed or holds no file.
pub fn files_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries =
        fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<_>>()?;
    files.retain(|path| path.is_file() && !name_of(path).starts_with('.'));
    files.sort();
    if files.is_empty() {
        bail!("{} holds no files", folder.display());
    }
    Ok(files)
}

/// Writes a text file.
///
/// # Errors
/// Names the file.
pub fn write_text(path: &Path, text: &str) -> Result<()> {
    write_bytes(path, text.as_bytes())
}

/// Writes bytes.
///
/// # Errors
/// Names the file.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    fs::write(path, bytes).with_context(|| format!("cannot write {}", path.display()))
}

/// Writes a figure as SVG, as PDF and as PNG.
///
/// # Errors
/// Names the file.
pub fn write_figure(folder: &Path, stem: &str, figure: &Figure) -> Result<()> {
    write_text(&folder.join(format!("{stem}.svg")), &figure.svg())?;
    write_bytes(&folder.join(format!("{stem}.pdf")), &figure.pdf())?;
    write_bytes(&folder.join(format!("{stem}.png")), &figure.png())
}

/// Writes a table as JSON where `--json` asked for it.
///
/// # Errors
/// Names the file.
pub fn write_json(path: Option<&Path>, table: &impl serde::Serialize) -> Result<()> {
    let Some(path) = path else { return Ok(()) };
    let mut text = serde_json::to_string_pretty(table)?;
    text.push('\n');
    write_text(path, &text)
}

/// Fields of a line of a table, some in quotes.
pub fn csv_fields(line: &str) -> Vec<String> {
    let (mut fields, mut field, mut quoted) = (Vec::new(), String::new(), false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            // Two within quotes are one.
            '"' if quoted && letters.next_if_eq(&'"').is_some() => field.push('"'),
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(std::mem::take(&mut field)),
            other => field.push(other),
        }
    }
    fields.push(field);
    fields
}

/// SHA-256 of some bytes, hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    let digest: [u8; 32] = Sha256::digest(bytes).into();
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_read_back_as_they_were_quoted() {
        use fluoropose_report::cell::{plain, quoted};
        let texts = ["=1,\"2\"", "a \"mask\", of two", "", "\"", "plain"];
        let line = texts.map(quoted).join(",");
        let fields = csv_fields(&line);
        assert_eq!(
            fields.iter().map(|field| plain(field)).collect::<Vec<_>>(),
            texts
        );
    }
}

//! Files and folders as they are: bytes, text, JSON, names.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};
use fluoropose_phantom::whole;
use fluoropose_report::Figure;
use sha2::{Digest, Sha256};

/// Reads a whole file.
///
/// # Errors
/// Names the file; also where somebody wrote it meanwhile, because what was read may be half of each.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    let cannot = || format!("cannot read {}", path.display());
    let mut file = File::open(path).with_context(cannot)?;
    let whole = |file: &mut File| {
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map(|_| bytes)
    };
    match at_rest(&mut file, whole).with_context(cannot)? {
        Some(bytes) => Ok(bytes),
        None => bail!("{} was written while it was read", path.display()),
    }
}

/// What `reading` gives; `None` where the file was written meanwhile, as far as its length and time tell.
fn at_rest(
    file: &mut File,
    reading: impl FnOnce(&mut File) -> io::Result<Vec<u8>>,
) -> io::Result<Option<Vec<u8>>> {
    let state = |file: &File| -> io::Result<_> {
        let there = file.metadata()?;
        Ok((there.is_file(), there.len(), there.modified().ok()))
    };
    let before = state(file)?;
    let bytes = reading(file)?;
    let (is_file, length, _) = before;
    let is_same = state(file)? == before && bytes.len() as u64 == length;
    // Pipes have no length, and what a system makes up as it is read says that it has none.
    Ok((is_same || !is_file || length == 0).then_some(bytes))
}

/// Reads a text file.
///
/// # Errors
/// Names the file.
pub fn read_text(path: &Path) -> Result<String> {
    text_of(read(path)?).with_context(|| path.display().to_string())
}

/// The text of some bytes.
///
/// # Errors
/// Says in which other form they are, and what to do.
pub(super) fn text_of(bytes: Vec<u8>) -> Result<String> {
    const WIDE: [[u8; 2]; 2] = [[0xFF, 0xFE], [0xFE, 0xFF]];
    if WIDE.iter().any(|mark| bytes.starts_with(mark)) {
        bail!("this is text in UTF-16, which editors call Unicode: save it as UTF-8");
    }
    String::from_utf8(bytes).map_err(|error| {
        let (place, bytes) = (error.utf8_error().valid_up_to(), error.as_bytes());
        let before = &bytes[..place];
        if bytes.contains(&0) {
            return anyhow!("this is no text");
        }
        let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
        anyhow!("line {line} has a letter that is not in UTF-8, as ones with marks above them: save the file as UTF-8")
    })
}

/// The name of a file without its folder.
pub fn name_of(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// Writes a text file.
///
/// # Errors
/// Names the file.
pub fn write_text(path: &Path, text: &str) -> Result<()> {
    whole::write(path, text)
}

/// Writes bytes.
///
/// # Errors
/// Names the file.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    whole::write(path, bytes)
}

/// Writes a figure as SVG, as PDF and as PNG.
///
/// # Errors
/// Names the file.
pub fn write_figure(folder: &Path, stem: &str, figure: &Figure) -> Result<()> {
    write_text(&folder.join(format!("{stem}.svg")), &figure.svg())?;
    whole::write(&folder.join(format!("{stem}.pdf")), figure.pdf())?;
    whole::write(&folder.join(format!("{stem}.png")), figure.png())
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
    use std::fs;

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

    #[test]
    fn text_in_another_form_is_told_with_what_to_do() {
        let told = |bytes: &[u8]| text_of(bytes.to_vec()).unwrap_err().to_string();
        assert!(told(b"\xFF\xFEJ\0T\0").contains("UTF-16"));
        let latin = told(b"name = 's'\n# R\xF6hre\n");
        assert!(
            latin.starts_with("line 2 has a letter that is not in UTF-8"),
            "{latin}"
        );
        assert_eq!(told(b"\x89PNG\r\n\0\0"), "this is no text");
        assert_eq!(text_of("Röhre".into()).unwrap(), "Röhre");
    }

    #[test]
    fn what_is_written_while_it_is_read_is_no_file() {
        let name = format!("fluoropose-rest-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        for more in ["", "more"] {
            fs::write(&path, "text").unwrap();
            let found = at_rest(&mut File::open(&path).unwrap(), |file| {
                let mut bytes = vec![0; 4];
                file.read_exact(&mut bytes)?;
                if !more.is_empty() {
                    fs::write(&path, more.repeat(2))?;
                }
                Ok(bytes)
            });
            assert_eq!(found.unwrap().is_some(), more.is_empty(), "{more}");
        }
        assert_eq!(read(&path).unwrap(), b"moremore");
        fs::remove_file(path).unwrap();
    }
}

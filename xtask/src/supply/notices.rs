//! What stands beside every package: the parts of others in it, with their licences.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use super::parts::Part;
use super::sbom;

/// Name of the list for people.
pub(crate) const NOTICES: &str = "THIRD-PARTY.txt";
/// Name of the list for programs: CycloneDX.
pub(crate) const SBOM: &str = "sbom.cdx.json";

/// Writes both lists into a folder; `product` is what they are of.
///
/// Errors where a licence's text or a list cannot be read or written.
pub(crate) fn write(folder: &Path, product: &str, parts: &[Part]) -> Result<()> {
    let put = |name: &str, text: String| {
        let path = folder.join(name);
        fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))
    };
    put(NOTICES, text(product, parts)?)?;
    put(SBOM, sbom::text(product, parts)?)
}

/// A line for each part, then the texts of the licences as the packages have them, each once.
///
/// Errors where a text cannot be read.
pub(crate) fn text(product: &str, parts: &[Part]) -> Result<String> {
    // By their words, as many differ in their line breaks alone.
    let mut texts: BTreeMap<String, (String, Vec<String>)> = BTreeMap::new();
    let mut list = format!(
        "Parts of others in {product}, unchanged: name, version, licence by its SPDX identifier. Their licences' texts follow.\n\n"
    );
    for part in parts {
        let name = format!("{} {}", part.name, part.version);
        let own = own_texts(part)?;
        let none = if own.is_empty() {
            " (no text in its package)"
        } else {
            ""
        };
        list += &format!("{name}, {}: {}{none}\n", part.kind, part.licence);
        for text in own {
            let words: Vec<&str> = text.split_whitespace().collect();
            let known = texts.entry(words.join(" "));
            known.or_insert((text, Vec::new())).1.push(name.clone());
        }
    }
    for (text, names) in texts.into_values() {
        list += &format!("\n{}\n{}\n\n{text}\n", "=".repeat(80), names.join(", "));
    }
    Ok(list)
}

/// The files of a package that are licences or notices by their names.
fn own_texts(part: &Part) -> Result<Vec<String>> {
    let entries = part.folder.as_deref().and_then(|at| fs::read_dir(at).ok());
    let paths = entries
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path());
    let mut paths: Vec<_> = paths
        .filter(|path| path.is_file() && is_licence(path))
        .collect();
    paths.sort();
    let read = |path: std::path::PathBuf| -> Result<String> {
        let bytes = fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let text = String::from_utf8_lossy(&bytes).replace('\r', "");
        Ok(text.trim_end().to_owned())
    };
    let mut texts: Vec<String> = paths.into_iter().map(read).collect::<Result<_>>()?;
    texts.dedup();
    Ok(texts)
}

fn is_licence(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.to_uppercase();
    let begins = [
        "LICENSE",
        "LICENCE",
        "COPYING",
        "COPYRIGHT",
        "NOTICE",
        "UNLICENSE",
    ];
    begins.iter().any(|word| name.starts_with(word)) && !name.ends_with(".RS")
}

/// The list as a comment at the end of a page that is one file.
///
/// Errors as [`text`].
pub(crate) fn comment(product: &str, parts: &[Part]) -> Result<String> {
    // Two hyphens could end it.
    let text = text(product, parts)?
        .replace("--", "- ")
        .replace('>', "&gt;");
    Ok(format!("<!--\n{text}-->\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_text_stands_once_and_no_path_of_the_machine_anywhere() {
        let folder =
            std::env::temp_dir().join(format!("fluoropose-notices-{}", std::process::id()));
        let mut parts = Vec::new();
        for (name, text) in [
            ("a", "the text\r\n"),
            ("b", "the\ntext"),
            ("c", "-->another"),
        ] {
            let own = folder.join(name);
            fs::create_dir_all(&own).unwrap();
            fs::write(own.join("LICENSE-MIT"), text).unwrap();
            fs::write(own.join("lib.rs"), "no licence").unwrap();
            parts.push(Part {
                kind: "cargo",
                name: name.to_owned(),
                version: "1.2.3".to_owned(),
                licence: "MIT".to_owned(),
                digest: Some(("SHA-256", "00".to_owned())),
                folder: Some(own),
                from_registry: true,
            });
        }
        write(&folder, "the test", &parts).unwrap();
        let text = fs::read_to_string(folder.join(NOTICES)).unwrap();
        assert_eq!(text.matches("the text").count(), 1, "{text}");
        assert!(text.contains("\na 1.2.3, b 1.2.3\n") && text.contains("c 1.2.3, cargo: MIT\n"));
        assert!(!text.contains("no licence"));
        let bill = fs::read_to_string(folder.join(SBOM)).unwrap();
        let machine = folder.to_string_lossy();
        assert!(!text.contains(&*machine) && !bill.contains(&*machine));
        let comment = comment("the test", &parts).unwrap();
        assert_eq!(comment.matches("-->").count(), 1, "{comment}");
        fs::remove_dir_all(folder).unwrap();
    }
}

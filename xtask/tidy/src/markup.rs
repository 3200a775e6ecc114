//! Ways to make markup or a program out of text, which no script of the page may use: a file's name would become a part of the page.

use std::path::Path;

use anyhow::{Context, Result};

/// Written in parts, so that they are not found here.
const WAYS: [&str; 8] = [
    concat!("inner", "HTML"),
    concat!("outer", "HTML"),
    concat!("setHTML", "Unsafe"),
    concat!("insertAdjacent", "HTML"),
    concat!("createContextual", "Fragment"),
    concat!("document", ".write"),
    concat!("src", "doc"),
    concat!("new ", "Function("),
];

/// An error for each such way in the page's own scripts.
pub fn errors(root: &Path, files: &[String]) -> Result<Vec<String>> {
    let mut errors = Vec::new();
    let scripts = files.iter().filter(|file| is_page_script(file));
    for file in scripts {
        let text = std::fs::read_to_string(root.join(file));
        let text = text.with_context(|| format!("cannot read {file}"))?;
        for (line, way) in ways(&text) {
            errors.push(format!(
                "{file}:{line} uses {way}: text of a file would become markup"
            ));
        }
    }
    Ok(errors)
}

fn is_page_script(file: &str) -> bool {
    let of_page = [
        "web/src/",
        "web/npm/",
        "web/service_worker/",
        "web/embedded/",
    ];
    of_page.iter().any(|folder| file.starts_with(folder))
        && [".ts", ".tsx", ".js", ".mjs"]
            .iter()
            .any(|ending| file.ends_with(ending))
}

fn ways(text: &str) -> impl Iterator<Item = (usize, &'static str)> + '_ {
    text.lines().enumerate().flat_map(|(at, line)| {
        let lower = line.to_lowercase();
        let found = WAYS
            .into_iter()
            .filter(move |way| lower.contains(&way.to_lowercase()));
        found.map(move |way| (at + 1, way))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_way_is_found_in_the_pages_scripts_alone() {
        for way in WAYS {
            let text = format!("const a = 1;\nhost.{way} = name;\n");
            assert_eq!(ways(&text).collect::<Vec<_>>(), [(2, way)]);
        }
        let preact = format!(
            "<p dangerouslySet{}={{x}} />",
            WAYS[0].replacen('i', "I", 1)
        );
        assert_eq!(ways(&preact).count(), 1);
        assert_eq!(
            ways("host.textContent = name; parser.parseFromString(text)").count(),
            0
        );
        assert!(is_page_script("web/src/sheets/sheet.tsx"));
        assert!(!is_page_script("web/tests/sheet.ts") && !is_page_script("web/src/style.css"));
    }
}

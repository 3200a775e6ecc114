//! Notes of work to come, in any file of text.

use std::path::Path;

use anyhow::{Context, Result};

const ENDINGS: [&str; 12] = [
    ".css", ".html", ".js", ".md", ".mjs", ".py", ".rs", ".sh", ".toml", ".ts", ".tsx", ".yml",
];
/// Not written in one piece, so that it is not found here.
const NOTE: &str = concat!("TO", "DO");

/// An error for each line with such a note.
pub fn errors(root: &Path, files: &[String]) -> Result<Vec<String>> {
    let mut errors = Vec::new();
    for file in files
        .iter()
        .filter(|file| ENDINGS.iter().any(|ending| file.ends_with(ending)))
    {
        let bytes =
            std::fs::read(root.join(file)).with_context(|| format!("cannot read {file}"))?;
        errors.extend(
            lines_with_note(&String::from_utf8_lossy(&bytes))
                .map(|line| format!("{file}:{line} has {NOTE}")),
        );
    }
    Ok(errors)
}

fn lines_with_note(text: &str) -> impl Iterator<Item = usize> + '_ {
    let is_whole = |line: &str, at: usize| {
        let around = [
            line[..at].chars().next_back(),
            line[at + NOTE.len()..].chars().next(),
        ];
        !around.into_iter().flatten().any(char::is_alphanumeric)
    };
    let has = move |line: &str| line.match_indices(NOTE).any(|(at, _)| is_whole(line, at));
    text.lines()
        .enumerate()
        .filter(move |(_, line)| has(line))
        .map(|(line, _)| line + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_are_found_as_whole_words() {
        let text = format!("fine\n// {NOTE}: later\nx{NOTE}S\n{NOTE}");
        assert_eq!(lines_with_note(&text).collect::<Vec<_>>(), [2, 4]);
    }
}

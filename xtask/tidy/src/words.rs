//! Words that have been replaced and must not come back.
//!
//! A line of `words.txt` reads `Tally -> threshold statistics`: the word that is gone, and what is written instead.
//! It is found as whole parts of a name, whatever their case: `best_tally` and `TallyOfRows`, not `totally`.

use anyhow::{Context, Result};

/// A word that is gone.
#[derive(Debug)]
struct Gone {
    word: String,
    parts: Vec<String>,
    instead: String,
}

/// The words that are gone.
#[derive(Debug, Default)]
pub struct Words {
    gone: Vec<Gone>,
}

impl Words {
    /// Reads a `words.txt`.
    ///
    /// Errors when a line has no `->`.
    pub fn parse(text: &str) -> Result<Self> {
        let lines = text
            .lines()
            .map(|line| line.split('#').next().unwrap_or_default().trim());
        let gone = lines.filter(|line| !line.is_empty()).map(|line| {
            let (word, instead) = line
                .split_once("->")
                .with_context(|| format!("no `->` in `{line}`"))?;
            let word = word.trim().to_string();
            let instead = instead.trim().to_string();
            Ok(Gone {
                parts: parts(&word),
                word,
                instead,
            })
        });
        Ok(Self {
            gone: gone.collect::<Result<_>>()?,
        })
    }

    /// What is wrong with a name, if anything is.
    pub fn fault(&self, name: &str) -> Option<String> {
        if self.gone.is_empty() {
            return None;
        }
        let own = parts(name);
        let stands_in = |gone: &&Gone| {
            own.windows(gone.parts.len())
                .any(|parts| parts == gone.parts)
        };
        let gone = self.gone.iter().find(stands_in)?;
        Some(format!(
            "`{name}`: `{}` is called {} here",
            gone.word, gone.instead
        ))
    }
}

/// The parts of a name in lower case: `one_click`, `OneClick` and `ONE_CLICK` have the same.
fn parts(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let mut parts = vec![String::new()];
    for (at, letter) in letters.iter().enumerate() {
        let before = at.checked_sub(1).map(|at| letters[at]);
        let small_before =
            before.is_some_and(|letter| letter.is_lowercase() || letter.is_numeric());
        let small_after = letters
            .get(at + 1)
            .is_some_and(|letter| letter.is_lowercase());
        let starts = letter.is_uppercase() && (small_before || small_after);
        if starts || !letter.is_alphanumeric() {
            parts.push(String::new());
        }
        if let (true, Some(part)) = (letter.is_alphanumeric(), parts.last_mut()) {
            part.extend(letter.to_lowercase());
        }
    }
    parts.retain(|part| !part.is_empty());
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_split_at_capitals_and_underscores() {
        for name in [
            "one_click2_html",
            "OneClick2HTML",
            "ONE_CLICK2_HTML",
            "oneClick2Html",
        ] {
            assert_eq!(parts(name), ["one", "click2", "html"], "{name}");
        }
        assert_eq!(parts("HTMLElement"), ["html", "element"]);
    }

    #[test]
    fn a_word_that_is_gone_is_found_as_whole_parts() {
        let words = Words::parse(
            "# none\nTally -> threshold statistics # why\nstraight_films -> undistorted films",
        )
        .unwrap();
        for name in [
            "Tally",
            "best_tally",
            "TallyOfRows",
            "straightFilms",
            "STRAIGHT_FILMS",
        ] {
            assert!(words.fault(name).is_some(), "{name}");
        }
        for name in ["totally", "tallying", "films_straight", "straight"] {
            assert!(words.fault(name).is_none(), "{name}");
        }
        let told = words.fault("best_tally").unwrap();
        assert_eq!(
            told,
            "`best_tally`: `Tally` is called threshold statistics here"
        );
        assert!(Words::parse("Tally").is_err());
    }
}

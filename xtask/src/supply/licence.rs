//! Which licences what comes from elsewhere may have.

use anyhow::{Result, bail, ensure};

/// Licences that ask for no more than their text and a name, and one that asks for its own files' sources, which are used unchanged
/// and are public (MPL-2.0).
const ALLOWED: [&str; 12] = [
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "IJG",
    "ISC",
    "MIT",
    "MPL-2.0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// A stated licence as an SPDX expression: older crates write a slash where they mean OR.
pub(crate) fn expression(stated: &str) -> String {
    stated
        .split('/')
        .map(str::trim)
        .collect::<Vec<_>>()
        .join(" OR ")
}

/// Whether what is licensed so may be used: one of each OR, all of each AND.
///
/// Errors where the words are no SPDX expression.
pub(crate) fn is_allowed(expression: &str) -> Result<bool> {
    let spaced = expression.replace('(', " ( ").replace(')', " ) ");
    let mut words = spaced.split_whitespace().peekable();
    let allowed = any(&mut words)?;
    ensure!(words.next().is_none(), "`{expression}` is no expression");
    Ok(allowed)
}

type Words<'w> = std::iter::Peekable<std::str::SplitWhitespace<'w>>;

fn any(words: &mut Words<'_>) -> Result<bool> {
    let mut allowed = all(words)?;
    while words.next_if_eq(&"OR").is_some() {
        allowed |= all(words)?;
    }
    Ok(allowed)
}

fn all(words: &mut Words<'_>) -> Result<bool> {
    let mut allowed = one(words)?;
    while words.next_if_eq(&"AND").is_some() {
        allowed &= one(words)?;
    }
    Ok(allowed)
}

fn one(words: &mut Words<'_>) -> Result<bool> {
    match words.next() {
        Some("(") => {
            let inner = any(words)?;
            ensure!(words.next() == Some(")"), "a bracket is open");
            Ok(inner)
        }
        Some(name) if !matches!(name, ")" | "OR" | "AND" | "WITH") => {
            let exception = words.next_if_eq(&"WITH").and_then(|_| words.next());
            let whole = exception.map_or(name.to_owned(), |exception| {
                format!("{name} WITH {exception}")
            });
            Ok(ALLOWED.contains(&whole.as_str()))
        }
        other => bail!("`{}` stands for no licence", other.unwrap_or_default()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_of_each_or_and_all_of_each_and() {
        for (stated, allowed) in [
            ("MIT", true),
            ("MIT/Apache-2.0", true),
            ("GPL-3.0-only", false),
            ("Apache-2.0 OR GPL-2.0-only", true),
            ("(MIT OR Apache-2.0) AND Unicode-3.0", true),
            ("MIT AND GPL-2.0-only", false),
            ("MIT OR GPL-2.0-only AND LGPL-3.0-only", true),
            ("(MIT OR GPL-2.0-only) AND LGPL-3.0-only", false),
            ("Apache-2.0 WITH LLVM-exception", true),
            ("MIT WITH LLVM-exception", false),
        ] {
            assert_eq!(
                is_allowed(&expression(stated)).unwrap(),
                allowed,
                "{stated}"
            );
        }
    }

    #[test]
    fn what_is_no_expression_is_an_error() {
        for stated in ["", "MIT OR", "(MIT", "MIT Apache-2.0", "OR MIT", "MIT)"] {
            assert!(is_allowed(stated).is_err(), "{stated}");
        }
    }
}

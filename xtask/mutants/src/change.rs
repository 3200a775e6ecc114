//! One change of a source, as text: what is put before and behind a place of it.

use std::fmt;
use std::ops::Range;

/// A change of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Change {
    /// The file, below the repository's root.
    pub(crate) file: String,
    /// Its line, from 1.
    pub(crate) line: usize,
    /// The function around it.
    pub(crate) function: String,
    /// What is done, in words.
    pub(crate) what: String,
    /// How it is written.
    pub(crate) edit: Edit,
}

/// How a change is written beside what it changes. All ranges are of bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Edit {
    /// An expression is another where the change counts.
    Instead {
        /// The expression as it is.
        of: Range<usize>,
        /// What takes its place.
        other: String,
    },
    /// A function returns at once, from the beginning of its body.
    Return {
        /// Behind the brace that opens the body.
        at: usize,
        /// What it returns.
        value: String,
    },
    /// An arm of a match is never taken.
    Never {
        /// Behind its pattern, or behind the `if` of its guard.
        at: usize,
        /// Where its guard ends.
        guard_end: Option<usize>,
    },
}

impl Edit {
    /// From where to where it is written beside.
    pub(crate) fn range(&self) -> Range<usize> {
        match self {
            Self::Instead { of, .. } => of.clone(),
            Self::Return { at, .. } => *at..*at,
            Self::Never { at, guard_end } => *at..guard_end.unwrap_or(*at),
        }
    }
}

impl fmt::Display for Change {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            file,
            line,
            function,
            what,
            ..
        } = self;
        write!(out, "{file}:{line}: {what} in {function}")
    }
}

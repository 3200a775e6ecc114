//! Matching: unmatched pixels between a canonical silhouette and every view of a library.
//!
//! The naive oracle, view by view and bit by bit, that tests hold [`crate::search`] against.

use crate::canonical::reverse;
use crate::image::mask::Word;
use crate::library::Library;
use crate::memory::{check_length, first};
use crate::search::scores::{MatchError, Scores};

/// Compares a canonical silhouette with every view, as it is and rotated by 180 degrees.
///
/// `canonical` comes from [`crate::canonical::canonicalise`] with the library's own
/// [`crate::canonical::CanonicalSpec`]; `rotated` is working memory of the same length; `scores`
/// has [`scores_needed`] numbers.
///
/// # Errors
/// [`MatchError::Memory`] for a wrong length.
pub(crate) fn score<'s>(
    library: &Library<'_>,
    canonical: &[Word],
    rotated: &mut [Word],
    scores: &'s mut [u32],
) -> Result<Scores<'s>, MatchError> {
    let words = library.info().canonical.words_needed();
    check_length("words of canonical mask", words, canonical.len())?;
    let canonical = canonical.get(..words).unwrap_or_default();
    let rotated = first("words of working memory", words, rotated)?;
    reverse(canonical, rotated);
    Scores::fill(library, scores, |view, reversed| {
        let ours = if reversed { &*rotated } else { canonical };
        let mut drawn = std::vec![0; words];
        library.draw(view, &mut drawn);
        let pairs = ours.iter().zip(&drawn);
        pairs
            .map(|(ours, theirs)| (ours ^ theirs).count_ones())
            .sum()
    })
}

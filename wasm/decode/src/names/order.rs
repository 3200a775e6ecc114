//! The order of names of files: that of the frames.

use std::cmp::Ordering;
use std::iter::Peekable;
use std::str::Chars;

/// Signs and their order, as browsers have it (CLDR's root order); digits and letters come after them.
const SIGNS: &str = " _-,;:!?.'\"()[]{}@*/\\&#%`^+<=>|~$";

/// Which of two names comes first: a run of digits counts as its number, so that `f2` stands before `f10`, and large letters are as
/// small ones. Names that are alike so far are told apart by the first large letter, then by their characters. The page has the same order
/// (`web/src/exchange/name_order.ts`); names that a test holds against both are in `tests/corpus/name_order.txt`.
pub fn name_order(a: &str, b: &str) -> Ordering {
    let pieces = pieces(a).cmp(pieces(b));
    // Small letters come first.
    let large = |name: &str| -> Vec<bool> { name.chars().map(char::is_uppercase).collect() };
    pieces
        .then_with(|| large(without_zeros(a).as_str()).cmp(&large(without_zeros(b).as_str())))
        .then_with(|| a.cmp(b))
}

/// A part of a name, in the order of names.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Piece {
    /// A sign, by its place.
    Sign(usize),
    /// A number of any length: its number of digits, and these, without zeros before.
    Number(usize, String),
    Letter(char),
}

/// The parts of a name.
pub(super) fn pieces(name: &str) -> impl Iterator<Item = Piece> {
    let mut letters = name.chars().peekable();
    std::iter::from_fn(move || {
        let first = *letters.peek()?;
        if first.is_ascii_digit() {
            let digits = digits(&mut letters);
            return Some(Piece::Number(digits.len(), digits));
        }
        letters.next();
        let small = first.to_lowercase().next().unwrap_or(first);
        let sign = SIGNS.chars().position(|sign| sign == first);
        Some(sign.map_or(Piece::Letter(small), Piece::Sign))
    })
}

/// The digits that come next, without zeros before.
fn digits(letters: &mut Peekable<Chars<'_>>) -> String {
    let mut digits = String::new();
    while let Some(digit) = letters.next_if(char::is_ascii_digit) {
        if digit != '0' || !digits.is_empty() {
            digits.push(digit);
        }
    }
    digits
}

/// A name whose letters stand at the same places as in one that is alike: numbers without zeros before.
fn without_zeros(name: &str) -> String {
    let mut letters = name.chars().peekable();
    let mut out = String::new();
    while let Some(&first) = letters.peek() {
        if first.is_ascii_digit() {
            out.push_str(&digits(&mut letters));
        } else {
            out.extend(letters.next());
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: &str = include_str!("../../../../tests/corpus/name_order.txt");

    #[test]
    fn names_stand_as_in_the_page() {
        let known: Vec<&str> = NAMES.lines().collect();
        let mut sorted = known.clone();
        sorted.reverse();
        sorted.sort_by(|a, b| name_order(a, b));
        assert_eq!(sorted, known);
    }

    #[test]
    fn it_is_an_order() {
        let names: Vec<&str> = NAMES.lines().chain(["", "0", "f", "f000", "f0"]).collect();
        for a in &names {
            for b in &names {
                assert_eq!(name_order(a, b), name_order(b, a).reverse());
                assert_eq!(name_order(a, b).is_eq(), a == b, "{a} {b}");
                for c in names.iter().filter(|c| name_order(b, c).is_lt()) {
                    assert!(
                        name_order(a, b).is_ge() || name_order(a, c).is_lt(),
                        "{a} {b} {c}"
                    );
                }
            }
        }
    }
}

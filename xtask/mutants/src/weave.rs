//! A file's text with changes in it, each behind the question whether it counts.

use std::ops::Range;

use crate::change::{Change, Edit};

/// A text with changes in it.
pub(crate) struct Woven {
    pub(crate) text: String,
    /// Each change's number, and the bytes that came or stand between what came with it.
    pub(crate) places: Vec<(usize, Range<usize>)>,
}

/// A piece of text that comes to a place of a file.
struct Piece {
    at: usize,
    /// The change, and whether the piece stands at its beginning.
    of: (usize, bool),
    text: String,
}

/// Weaves changes, each with its number, into the text they were found in.
pub(crate) fn weave(text: &str, changes: &[(usize, &Change)]) -> Woven {
    let mut changes = changes.to_vec();
    // Outer ones first; of one and the same expression as they are given.
    changes.sort_by_key(|(_, change)| {
        let Range { start, end } = change.edit.range();
        (start, std::cmp::Reverse(end))
    });
    let mut pieces: Vec<Piece> = Vec::new();
    for (number, change) in changes {
        let on = format!("::fluoropose_switch::on({number})");
        let mut piece = |at, begins, text| {
            pieces.push(Piece {
                at,
                of: (number, begins),
                text,
            });
        };
        match &change.edit {
            Edit::Instead { of, other } => {
                piece(of.start, true, format!("(if {on} {{ {other} }} else {{ "));
                piece(of.end, false, " })".to_owned());
            }
            Edit::Return { at, value } => {
                piece(*at, true, format!(" if {on} {{ return {value}; }}"));
                piece(*at, false, String::new());
            }
            Edit::Never {
                at,
                guard_end: None,
            } => {
                piece(*at, true, format!(" if !{on}"));
                piece(*at, false, String::new());
            }
            Edit::Never {
                at,
                guard_end: Some(end),
            } => {
                piece(*at, true, format!("!{on} && ("));
                piece(*end, false, ")".to_owned());
            }
        }
    }
    // Stable: what begins at one place stands as it was found, outer first; what ends there the other way round.
    let ends = |piece: &Piece| !piece.of.1;
    let (mut closing, opening): (Vec<Piece>, Vec<Piece>) = pieces.into_iter().partition(ends);
    closing.reverse();
    let mut all: Vec<Piece> = closing.into_iter().chain(opening).collect();
    all.sort_by_key(|piece| piece.at);
    joined(text, &mut all)
}

fn joined(text: &str, pieces: &mut [Piece]) -> Woven {
    let mut woven = Woven {
        text: String::with_capacity(2 * text.len()),
        places: Vec::new(),
    };
    let mut done = 0;
    for piece in pieces {
        woven.text.push_str(&text[done..piece.at]);
        done = piece.at;
        let (number, begins) = piece.of;
        let from = woven.text.len();
        woven.text.push_str(&piece.text);
        let to = woven.text.len();
        match woven.places.iter_mut().find(|(own, _)| *own == number) {
            Some((_, place)) if begins => *place = from..to.max(place.end),
            Some((_, place)) => place.end = to,
            None => woven.places.push((number, from..to)),
        }
    }
    woven.text.push_str(&text[done..]);
    woven
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::places::of_file;

    const SOURCE: &str = "fn sum(a: f64, b: f64) -> f64 { a + -b }\n";

    /// A source with all its changes.
    fn woven(source: &str) -> (Vec<Change>, Woven) {
        let (changes, _) = of_file("a.rs", source).unwrap_or_default();
        let numbered: Vec<(usize, &Change)> = changes.iter().enumerate().collect();
        let woven = weave(source, &numbered);
        (changes, woven)
    }

    #[test]
    fn changes_of_one_expression_lie_in_each_other() {
        let (changes, woven) = woven(SOURCE);
        assert_eq!(changes.len(), 6);
        let parts = [
            "fn sum(a: f64, b: f64) -> f64 {",
            "if ::fluoropose_switch::on(0) { return 0.0; }",
            "if ::fluoropose_switch::on(1) { return 1.0; }",
            "if ::fluoropose_switch::on(2) { return -1.0; }",
            "(if ::fluoropose_switch::on(3) { (a) - (-b) } else {",
            "(if ::fluoropose_switch::on(4) { (a) * (-b) } else {",
            "a + (if ::fluoropose_switch::on(5) { (b) } else { -b }) }) }) }\n",
        ];
        assert_eq!(woven.text, parts.join(" "));
    }

    /// The product is found first, and lies in the quotient: the quotient's change takes the whole of it.
    #[test]
    fn an_expression_that_begins_another_lies_in_it_whatever_the_order() {
        let source = "fn part(a: f64, b: f64, c: f64) -> f64 { a * b / c }\n";
        let (changes, _) = of_file("a.rs", source).unwrap_or_default();
        let of = |what: &str| changes.iter().position(|one| one.what.starts_with(what));
        let (quotient, product) = (of("% for /").unwrap_or(9), of("+ for *").unwrap_or(9));
        for order in [[quotient, product], [product, quotient]] {
            let numbered = order.map(|number| (number, &changes[number]));
            let woven = weave(source, &numbered);
            let due = format!(
                "{{ (if ::fluoropose_switch::on({quotient}) {{ (a * b) % (c) }} else {{ (if ::fluoropose_switch::on({product}) {{ (a) + (b) }} else {{ a * b }}) / c }}) }}\n"
            );
            assert!(woven.text.ends_with(&due), "{}", woven.text);
        }
    }

    #[test]
    fn the_place_of_a_change_holds_all_that_came_with_it() {
        let (_, woven) = woven(SOURCE);
        for (number, place) in &woven.places {
            let text = &woven.text[place.clone()];
            assert!(text.contains(&format!("on({number})")), "{text}");
        }
        let inner = |number| {
            woven
                .places
                .iter()
                .find(|(own, _)| *own == number)
                .map(|(_, place)| place.clone())
        };
        let (outer, inner) = (inner(3).unwrap_or_default(), inner(5).unwrap_or_default());
        assert!(outer.start < inner.start && inner.end < outer.end);
    }

    #[test]
    fn what_is_woven_is_still_rust() {
        let source = "fn f(a: &[u8], b: bool) -> Result<bool, ()> {\n    let mut n = 0;\n    n += a.len() * 2 - 1;\n    \
                      match n {\n        0 if b && n > 1 => Ok(true),\n        3 => Ok(!b),\n        _ => Ok(b || n == 4),\n    }\n}\n";
        let (changes, woven) = woven(source);
        assert_eq!(changes.len(), 19);
        assert!(syn::parse_file(&woven.text).is_ok(), "{}", woven.text);
    }
}

//! What is missing among files that are numbered.

use super::order::{Piece, pieces};

/// Fewer files do not tell that one is missing among them.
const ENOUGH: usize = 4;
/// Missing files that are named.
const NAMED: usize = 3;

/// What files that are numbered evenly but for gaps lack, a sentence without its full stop: poses of neighbours are taken to be near each
/// other, and times to be even. `names` are in their order.
#[must_use]
pub fn gaps_among(names: &[String]) -> Option<String> {
    let numbers = running_numbers(names)?;
    let steps = numbers.windows(2).map(|pair| pair[1].checked_sub(pair[0]));
    let steps: Vec<u64> = steps.collect::<Option<_>>()?;
    let step = *steps.iter().min()?;
    let even = steps.iter().filter(|&&other| other == step).count();
    let gaps: Vec<usize> = (0..steps.len()).filter(|&at| steps[at] != step).collect();
    let is_even = names.len() >= ENOUGH && step > 0 && 2 * even > steps.len();
    if !is_even || gaps.is_empty() || !steps.iter().all(|other| other.is_multiple_of(step)) {
        return None;
    }
    let missing: u64 = gaps.iter().map(|&at| steps[at] / step - 1).sum();
    let between = |&at: &usize| format!("{} and {}", names[at], names[at + 1]);
    let named: Vec<String> = gaps.iter().take(NAMED).map(between).collect();
    let more = match gaps.len() - named.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    Some(format!(
        "{missing} of the numbered files {} missing, between {}{more}: the frames at hand are taken for neighbours at even times",
        if missing == 1 { "is" } else { "are" },
        named.join(", ")
    ))
}

/// The number that tells names apart, where that is all that does.
fn running_numbers(names: &[String]) -> Option<Vec<u64>> {
    let all: Vec<Vec<Piece>> = names.iter().map(|name| pieces(name).collect()).collect();
    let (first, others) = all.split_first()?;
    let differs = |at: usize| others.iter().any(|other| other.get(at) != first.get(at));
    let mut differing = (0..first.len()).filter(|&at| differs(at));
    let (Some(at), None) = (differing.next(), differing.next()) else {
        return None;
    };
    let number = |pieces: &Vec<Piece>| match pieces.get(at) {
        // No digits are 0.
        Some(Piece::Number(_, digits)) if digits.is_empty() => Some(0),
        Some(Piece::Number(_, digits)) => digits.parse().ok(),
        _ => None,
    };
    let numbers = all
        .iter()
        .map(|pieces| number(pieces).filter(|_| pieces.len() == first.len()));
    numbers.collect()
}

#[cfg(test)]
mod tests {
    use super::gaps_among;

    fn of(names: &[&str]) -> Option<String> {
        gaps_among(
            &names
                .iter()
                .map(|&name| name.to_owned())
                .collect::<Vec<_>>(),
        )
    }

    fn numbered(numbers: &[u32]) -> Option<String> {
        let name = |number: &u32| format!("k2_{number:03}.png");
        gaps_among(&numbers.iter().map(name).collect::<Vec<_>>())
    }

    #[test]
    fn what_is_missing_among_numbers_is_told() {
        for (numbers, told) in [
            (
                &[0, 1, 2, 3, 4, 6, 7][..],
                "1 of the numbered files is missing, between k2_004.png and k2_006.png:",
            ),
            (
                &[0, 4, 8, 20, 24, 28, 36],
                "3 of the numbered files are missing, between k2_008.png and k2_020.png, k2_028.png and k2_036.png:",
            ),
        ] {
            let found = numbered(numbers).unwrap();
            assert!(found.starts_with(told), "{found}");
        }
        let names = ["f0", "f1", "f2", "f4", "f5", "f6", "f7", "f9", "F10"];
        assert!(of(&names).unwrap().starts_with("2 of the numbered files"));
    }

    #[test]
    fn nothing_is_made_up() {
        // Even steps, no steps that anybody meant, too few, in no order.
        for numbers in [
            &[5, 6, 7, 8][..],
            &[0, 4, 8, 12],
            &[0, 3, 4, 9, 11],
            &[1, 2, 5],
            &[1, 2, 9, 3],
            &[],
        ] {
            assert_eq!(numbered(numbers), None, "{numbers:?}");
        }
        assert_eq!(of(&["a1.png", "b2.png", "c4.png", "d5.png"]), None);
        assert_eq!(of(&["s1_1", "s1_2", "s2_3", "s2_5", "s2_6"]), None);
    }
}

//! Numbers with one standard deviation, as people read them: by one rule in page, report and commands.

/// As many decimals as the deviation is worth: two of its digits, but not more than usual, unless even its first digit is smaller than that.
fn decimals_for(deviation: f64, usual: usize) -> usize {
    if deviation.is_nan() || deviation <= 0.0 {
        return usual;
    }
    let first = -deviation.log10().floor();
    let least = (usual as f64).max(first).min(usual as f64 + 1.0);
    (first + 1.0).min(least).max(0.0) as usize
}

/// A number and its deviation with the same decimals, `usual` ones where the deviation is worth as many. It is never shown as none. A unit
/// stands behind a space, a degree sign does not.
#[must_use]
pub fn plus_minus(value: f64, deviation: f64, usual: usize) -> String {
    let places = decimals_for(deviation, usual);
    let least = 0.1_f64.powi(i32::try_from(places).unwrap_or(i32::MAX));
    format!(
        "{} \u{b1} {:.places$}",
        number(value, places),
        deviation.max(least)
    )
}

/// With a true minus, and none before what is rounded to zero.
fn number(value: f64, places: usize) -> String {
    let text = format!("{value:.places$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.contains(|letter: char| matches!(letter, '1'..='9')) => {
            format!("\u{2212}{rest}")
        }
        Some(zero) => zero.to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::plus_minus;

    #[test]
    fn numbers_are_written_as_the_page_writes_them() {
        let known = include_str!("../../../tests/corpus/plus_minus.txt");
        let lines = known.lines().skip(1);
        let read = |line: &str| {
            let (numbers, written) = line.split_once(": ").unwrap();
            let numbers: Vec<f64> = numbers.split(' ').map(|one| one.parse().unwrap()).collect();
            let found = plus_minus(numbers[0], numbers[1], numbers[2] as usize);
            assert_eq!(found, written, "{line}");
        };
        assert!(lines.map(read).count() > 10);
    }
}

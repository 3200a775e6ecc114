//! A second reader of pose files, which shares nothing with the core's but how a single number is read.

/// A row: six numbers, or none for a frame without a pose.
pub(super) type Row = Option<[f64; 6]>;

/// All rows, or the line at fault, from 1; 0 for the first line that says what the file is.
pub(super) fn read(text: &str) -> Result<Vec<Row>, usize> {
    let text = text.trim_start_matches('\u{feff}');
    let mut rows = Vec::new();
    let mut place = Place::Heading;
    for (index, line) in text.split('\n').enumerate() {
        let words: Vec<&str> = line
            .trim()
            .split(|letter| ",; \t".contains(letter))
            .filter(|word| !word.is_empty())
            .collect();
        if line.trim().is_empty() {
            continue;
        }
        match place {
            Place::Heading => {
                let forms = ["JT_EULER_312", "JTA_EULER_KINEMATICS", "JTA_EULER_POSE"];
                let known = |form: &&str| line.trim().get(..form.len()) == Some(*form);
                if !forms.iter().any(known) {
                    return Err(0);
                }
                place = Place::Names;
                continue;
            }
            Place::Names => {
                place = Place::Rows;
                if words.first().is_some_and(|word| is_name(word)) {
                    continue;
                }
            }
            Place::Rows => {}
        }
        rows.push(row(line.trim(), &words).ok_or(index + 1)?);
    }
    match place {
        Place::Heading => Err(0),
        _ => Ok(rows),
    }
}

enum Place {
    Heading,
    Names,
    Rows,
}

fn is_name(word: &str) -> bool {
    let letter = word.as_bytes()[0].is_ascii_alphabetic();
    letter && number(word).is_none() && !word.starts_with("NOT_OPTIMIZED")
}

fn row(line: &str, words: &[&str]) -> Option<Row> {
    if line.starts_with("NOT_OPTIMIZED") {
        return Some(None);
    }
    let numbers: Vec<f64> = words
        .iter()
        .map(|word| number(word))
        .collect::<Option<_>>()?;
    let numbers: [f64; 6] = numbers.try_into().ok()?;
    let count = |is: fn(f64) -> bool| numbers.into_iter().filter(|&number| is(number)).count();
    match (
        count(f64::is_nan),
        count(|n| n == 0.0),
        count(f64::is_finite),
    ) {
        (6, ..) | (_, 6, _) => Some(None),
        (_, _, 6) => Some(Some(numbers)),
        _ => None,
    }
}

fn number(word: &str) -> Option<f64> {
    word.parse().ok()
}

//! Texts that tell of a camera. Whether they tell enough says who reads them.

/// Parts of names that a camera's numbers have, in small letters.
const NAMES: [&str; 8] = [
    "camera_matrix",
    "cameramatrix",
    "intrinsic",
    "opencv-matrix",
    "distortion_coefficients",
    "dist_coef",
    "distcoef",
    "principalpoint",
];

/// The first line that is no note.
pub(super) fn first_said(text: &str) -> &str {
    let lines = text.lines().map(str::trim);
    let is_note =
        |line: &str| line.is_empty() || ["#", "%", "//"].iter().any(|mark| line.starts_with(mark));
    lines
        .into_iter()
        .find(|line| !is_note(line))
        .unwrap_or_default()
}

/// Whether a line is the first heading of MayaCam 2.0.
pub(super) fn is_mayacam(first: &str) -> bool {
    first
        .trim_end_matches(':')
        .trim_end()
        .eq_ignore_ascii_case("image size")
}

/// Whether a text is a camera matrix of another form: numbers alone, as MayaCam 1.0 and saved arrays have them, or named ones.
pub(super) fn is_other(text: &str) -> bool {
    let lines = || text.lines().map(str::trim).filter(|line| !line.is_empty());
    if [3, 5].contains(&lines().count()) && lines().all(is_three_numbers) {
        return true;
    }
    // Programs and prose have such words too, but do not begin with a key.
    let first = first_said(text);
    let begins = first.starts_with(['{', '<'])
        || first.starts_with("---")
        || first.ends_with(':')
        || is_key(first);
    let small = text.to_ascii_lowercase();
    let is_named = NAMES.iter().any(|name| small.contains(name));
    begins && (is_named || has_lines(text, &["fc", "cc"]) || has_lines(text, &["K"]))
}

/// Whether it begins with one word and a colon or an equals sign.
fn is_key(line: &str) -> bool {
    let word = line.split([':', '=']).next().unwrap_or_default();
    word.len() < line.len() && word.split_whitespace().count() == 1
}

fn has_lines(text: &str, keys: &[&str]) -> bool {
    let is_there = |key: &&str| {
        text.lines().any(|line| {
            let rest = line.trim_start().strip_prefix(*key).map(str::trim_start);
            rest.is_some_and(|rest| rest.starts_with([':', '=']))
        })
    };
    keys.iter().all(is_there)
}

fn is_three_numbers(line: &str) -> bool {
    let fields = line
        .split([',', ';', ' ', '\t'])
        .filter(|field| !field.is_empty());
    let numbers = fields.map(|field| field.parse::<f64>().is_ok());
    numbers.fold((0, true), |(count, all), is| (count + 1, all && is)) == (3, true)
}

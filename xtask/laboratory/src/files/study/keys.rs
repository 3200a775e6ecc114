//! The keys of a study, what each must be, and what is said where it is not: with the line, what was expected and an example.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{Result, anyhow, bail};
use fluoropose::mesh::anatomy::AnatomicalAxes;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// What a key holds.
enum Kind {
    Text,
    Path,
    Number,
    Above0,
    Pair,
    /// Three axes of a model's file.
    Axes,
    OneOf(&'static [&'static str]),
    /// Paths by the name of their source.
    Paths,
    Table(&'static [Key]),
    Tables(&'static [Key]),
}

/// A key that is known.
struct Key {
    name: &'static str,
    kind: Kind,
    is_needed: bool,
    /// As a person would write it.
    example: &'static str,
}

const fn needed(name: &'static str, kind: Kind, example: &'static str) -> Key {
    Key {
        name,
        kind,
        is_needed: true,
        example,
    }
}

const fn optional(name: &'static str, kind: Kind, example: &'static str) -> Key {
    Key {
        name,
        kind,
        is_needed: false,
        example,
    }
}

const STUDY: &[Key] = &[
    needed("name", Kind::Text, r#"name = "my study""#),
    needed(
        "calibration",
        Kind::Path,
        r#"calibration = "calibration.txt""#,
    ),
    needed("component", Kind::Tables(COMPONENT), "[[component]]"),
    optional("side", Kind::OneOf(&["left", "right"]), r#"side = "left""#),
    optional(
        "frames",
        Kind::Path,
        r#"frames = "frames", the folder of the grey frames or a file that holds them all"#,
    ),
    optional("frames_per_s", Kind::Above0, "frames_per_s = 15.0"),
    optional("film", Kind::Table(FILM), "[film]"),
];

const FILM: &[Key] = &[
    optional("curvature", Kind::Number, "curvature = 0.025"),
    optional("blur_px", Kind::Number, "blur_px = 0.8"),
    optional(
        "display",
        Kind::OneOf(&["linear", "between", "logarithmic"]),
        r#"display = "logarithmic""#,
    ),
];

const COMPONENT: &[Key] = &[
    needed("name", Kind::Text, r#"name = "femur""#),
    needed("model", Kind::Path, r#"model = "femur.stl""#),
    optional(
        "unit",
        Kind::OneOf(&["mm", "cm", "m", "in"]),
        r#"unit = "m", where the model's file is not in mm"#,
    ),
    optional(
        "role",
        Kind::OneOf(&["femur", "tibia"]),
        r#"role = "femur""#,
    ),
    optional("reference", Kind::Path, r#"reference = "femur.jts""#),
    optional("axes", Kind::Axes, r#"axes = "x y z""#),
    optional("nominal", Kind::Pair, "nominal = [0.0, 0.0]"),
    optional("distance_mm", Kind::Above0, "distance_mm = 1080.0"),
    optional("attenuation", Kind::Above0, "attenuation = 0.7"),
    optional("masks", Kind::Paths, r#"masks.hand = "masks/femur""#),
    optional("unknown", Kind::Paths, r#"unknown.hand = "unknown/femur""#),
    optional("peer", Kind::Paths, r#"peer.other = "other.jts""#),
];

/// A missing key of the study, in words.
pub(super) fn missing(name: &str) -> String {
    let example = STUDY.iter().find(|key| key.name == name);
    let example = example.map_or("", |key| key.example);
    format!("the key {name} is missing, as in {example}")
}

/// The frames of a study of which nothing is wrong but that it has no calibration.
pub(super) fn frames_without_calibration(text: &str, error: &anyhow::Error) -> Option<PathBuf> {
    if error.to_string() != missing("calibration") {
        return None;
    }
    let table = DeTable::parse(text).ok()?;
    let frames = table.get_ref().get("frames")?.get_ref();
    frames.as_str().map(PathBuf::from)
}

/// What a study's text was checked for.
#[derive(Debug, Default)]
pub(super) struct Checked {
    /// What there is to say of it, a sentence each.
    pub(super) remarks: Vec<String>,
    /// The line of each key, from 1; those of components are `component.N.KEY`, N from 0.
    pub(super) lines: BTreeMap<String, usize>,
}

impl Checked {
    /// Checks the text of a study: its keys and what each holds.
    ///
    /// # Errors
    /// A sentence with the line, the key, what was expected and an example.
    pub(super) fn of(text: &str) -> Result<Self> {
        let table = DeTable::parse(text).or_else(|error| {
            let line = error.span().map_or(1, |span| line_of(text, span.start));
            let own = text.lines().nth(line - 1).unwrap_or_default().trim();
            // The second of them is a fault of the form already.
            if own.starts_with("[component]") {
                bail!("line {line}: {}", two_brackets("component"));
            }
            if own.contains(TYPOGRAPHIC) {
                bail!(
                    "line {line}: text stands between straight quotes, \", and not typographic ones"
                );
            }
            if let Some((key, text)) = without_quotes(own) {
                bail!("line {line}: {key}: text needs quotes, as in {key} = {text:?}");
            }
            bail!("line {line}: {}", error.message().replace('\n', ", "))
        })?;
        let mut checked = Self::default();
        let root = Place {
            text,
            path: String::new(),
            within: String::new(),
        };
        checked.table(&root, table.get_ref(), STUDY)?;
        Ok(checked)
    }

    fn table(&mut self, place: &Place<'_>, table: &DeTable<'_>, keys: &[Key]) -> Result<()> {
        for (name, value) in table {
            let line = line_of(place.text, name.span().start);
            match keys.iter().find(|key| key.name == *name.get_ref()) {
                Some(key) => self.value(place, line, key, value)?,
                None => self.unknown(place, line, name.get_ref(), table, keys)?,
            }
        }
        for key in keys.iter().filter(|key| key.is_needed) {
            if table.get(key.name).is_none() {
                let (within, Key { name, example, .. }) = (&place.within, key);
                bail!("{within}the key {name} is missing, as in {example}");
            }
        }
        Ok(())
    }

    /// A key that is not known: refused where it stands in place of one that is needed, else told.
    fn unknown(
        &mut self,
        place: &Place<'_>,
        line: usize,
        name: &str,
        table: &DeTable<'_>,
        keys: &[Key],
    ) -> Result<()> {
        let mut told = format!("line {line}: {}the key {name:?} is not known", place.within);
        let absent = keys.iter().filter(|key| table.get(key.name).is_none());
        let meant = absent.min_by_key(|key| distance(key.name, name));
        let meant = meant.filter(|key| distance(key.name, name) <= 2.max(key.name.len() / 3));
        let is_of_study = !place.path.is_empty() && STUDY.iter().any(|key| key.name == name);
        match meant {
            _ if is_of_study => {
                bail!(
                    "{told} there: it is the study's, and stands before the first [[component]] and [film]"
                )
            }
            Some(key) if key.is_needed => bail!("{told}: was {} meant?", key.name),
            Some(key) => write!(told, " and left out: was {} meant?", key.name)?,
            None => told.push_str(" and left out"),
        }
        self.remarks.push(told);
        Ok(())
    }

    fn value(
        &mut self,
        place: &Place<'_>,
        line: usize,
        key: &Key,
        value: &Spanned<DeValue<'_>>,
    ) -> Result<()> {
        let (path, value) = (format!("{}{}", place.path, key.name), value.get_ref());
        self.lines.insert(path.clone(), line);
        match (&key.kind, value) {
            (Kind::Table(keys), DeValue::Table(table)) => {
                let within = format!("[{}]: ", key.name);
                self.table(&place.inner(path, within), table, keys)
            }
            (Kind::Tables(_), DeValue::Array(all)) if all.is_empty() => {
                bail!(
                    "line {line}: {} holds none: it takes one, as in {}",
                    key.name,
                    key.example
                )
            }
            (Kind::Tables(keys), DeValue::Array(all)) => {
                let mut all = all.iter().enumerate();
                all.try_for_each(|(number, one)| {
                    self.one_of_several(place, format!("{path}.{number}"), one, keys)
                })
            }
            (Kind::Tables(_), DeValue::Table(_)) => {
                bail!("line {line}: {}", two_brackets(key.name))
            }
            (Kind::Axes, DeValue::String(words)) => {
                let axes = AnatomicalAxes::from_words(words);
                axes.map(|_| ()).map_err(|error| {
                    anyhow!(
                        "line {line}: {}axes: {error}; it is {words:?}",
                        place.within
                    )
                })
            }
            (kind, value) if kind.holds(value) => Ok(()),
            (kind, value) => bail!(
                "line {line}: {}{} must be {}, as in {}; it is {}",
                place.within,
                key.name,
                kind.words(),
                key.example,
                words_of(value)
            ),
        }
    }

    fn one_of_several(
        &mut self,
        place: &Place<'_>,
        path: String,
        one: &Spanned<DeValue<'_>>,
        keys: &[Key],
    ) -> Result<()> {
        let line = line_of(place.text, one.span().start);
        let DeValue::Table(table) = one.get_ref() else {
            bail!("line {line}: a component is a table that begins with [[component]]");
        };
        let name = table.get("name").and_then(|name| name.get_ref().as_str());
        let within = match name {
            Some(name) => format!("component {name}: "),
            None => format!("the [[component]] of line {line}: "),
        };
        self.lines.insert(path.clone(), line);
        self.table(&place.inner(path, within), table, keys)
    }
}

/// Where a table stands.
struct Place<'t> {
    text: &'t str,
    /// Of its keys in [`Checked::lines`].
    path: String,
    /// Of its keys in messages.
    within: String,
}

impl<'t> Place<'t> {
    fn inner(&self, path: String, within: String) -> Place<'t> {
        Place {
            text: self.text,
            path: path + ".",
            within,
        }
    }
}

impl Kind {
    fn holds(&self, value: &DeValue<'_>) -> bool {
        match self {
            Self::Text => value.is_str(),
            Self::Path => value.as_str().is_some_and(is_path),
            Self::Number => number(value).is_some(),
            Self::Above0 => number(value).is_some_and(|number| number > 0.0 && number.is_finite()),
            Self::Pair => value.as_array().is_some_and(|pair| {
                let is_number =
                    |one: &Spanned<DeValue<'_>>| number(one.get_ref()).is_some_and(f64::is_finite);
                pair.len() == 2 && pair.iter().all(is_number)
            }),
            Self::OneOf(words) => value.as_str().is_some_and(|word| words.contains(&word)),
            Self::Paths => value.as_table().is_some_and(|table| {
                table
                    .values()
                    .all(|one| one.get_ref().as_str().is_some_and(is_path))
            }),
            Self::Axes | Self::Table(_) | Self::Tables(_) => false,
        }
    }

    fn words(&self) -> String {
        match self {
            Self::Text | Self::Axes => "text in quotes".to_owned(),
            Self::Path => format!("a file or folder in quotes{ESCAPES}"),
            Self::Number => "a number".to_owned(),
            Self::Above0 => "a number above 0".to_owned(),
            Self::Pair => "two numbers".to_owned(),
            Self::OneOf(words) => {
                let quoted = words.iter().map(|word| format!("{word:?}"));
                quoted.collect::<Vec<_>>().join(" or ")
            }
            Self::Paths => {
                format!("files or folders in quotes{ESCAPES}, each with the name of its source")
            }
            Self::Table(_) | Self::Tables(_) => "a table".to_owned(),
        }
    }
}

/// What editors of letters make of quotes.
const TYPOGRAPHIC: [char; 6] = [
    '\u{201c}', '\u{201d}', '\u{201e}', '\u{2018}', '\u{2019}', '\u{ab}',
];

/// What becomes of a backslash, as those have it who copy a path.
const ESCAPES: &str = " (between \"\" a backslash begins another character: write / in its place)";

/// Whether text may be a path: not where a backslash made a character of it that stands in no file's name.
fn is_path(text: &str) -> bool {
    !text.is_empty() && !text.contains(char::is_control)
}

/// The key and the value of a line whose value is a word or path without quotes.
fn without_quotes(line: &str) -> Option<(&str, &str)> {
    let (key, value) = line.split_once('=')?;
    let value = value.split('#').next().unwrap_or(value).trim();
    let begins = value.starts_with(|first: char| first.is_alphabetic() || "/\\.~_".contains(first));
    let is_of_toml = ["true", "false", "inf", "nan"].contains(&value);
    let is_quoted = value.contains(['"', '\'', '[', '{']);
    (begins && !is_of_toml && !is_quoted).then_some((key.trim(), value))
}

fn two_brackets(key: &str) -> String {
    format!("[{key}] needs two brackets, [[{key}]]: a study may have several")
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    let text = match value {
        DeValue::Integer(number) if number.radix() == 10 => number.as_str(),
        DeValue::Float(number) => number.as_str(),
        _ => return None,
    };
    text.parse().ok()
}

fn words_of(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("{text:?}"),
        DeValue::Integer(number) => number.as_str().to_owned(),
        DeValue::Float(number) => number.as_str().to_owned(),
        DeValue::Boolean(whether) => whether.to_string(),
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Array(all) => format!("a list of {}", all.len()),
        DeValue::Table(_) => "a table".to_owned(),
    }
}

/// The line, from 1, of a byte of a text.
fn line_of(text: &str, byte: usize) -> usize {
    let before = text.get(..byte).unwrap_or(text);
    1 + before.matches('\n').count()
}

/// How many letters have to be put in, left out or changed to make one word of another (Levenshtein).
pub(super) fn distance(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (number, letter) in one.chars().enumerate() {
        let mut corner = std::mem::replace(&mut row[0], number + 1);
        for (place, theirs) in other.iter().enumerate() {
            let changed = corner + usize::from(letter != *theirs);
            corner = row[place + 1];
            row[place + 1] = changed.min(corner + 1).min(row[place] + 1);
        }
    }
    row[other.len()]
}

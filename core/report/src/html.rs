//! The report of one study: one HTML file that prints well and needs nothing else.

use std::fmt::Write as _;

use fluoropose::Side;
use fluoropose::joint::COLUMNS;
use fluoropose::joint::numbers::place;
use fluoropose::joint::shared::KnownTo;

use crate::facts::{CONVENTIONS, Facts, filter, times};
use crate::figure::figure;
use crate::film::{JointFilm, JointRow, ORIGINS};
use crate::plus_minus::plus_minus;
use crate::svg::escaped;

const STYLE: &str = "\
:root{color-scheme:light}body{font:10.5pt/1.45 Helvetica,Arial,'Liberation Sans',sans-serif;color:#111;background:#fff;max-width:190mm;margin:8mm auto;padding:0 4mm}\
h1{font-size:17pt;margin:0 0 1mm}h2{font-size:12.5pt;margin:7mm 0 2mm;break-after:avoid}p{margin:0 0 2mm;max-width:165mm}\
table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:8.5pt;width:100%}\
th,td{padding:.7mm 1.2mm;text-align:right;vertical-align:top}td{white-space:nowrap}td.word,td.frames{white-space:normal}th{border-bottom:.3mm solid #111;font-weight:600;vertical-align:bottom;white-space:nowrap}\
td{border-bottom:.1mm solid #ccc}th:first-child,td:first-child,td.word,th.word{text-align:left}td.digest{font-family:monospace;font-size:7pt;white-space:normal;overflow-wrap:anywhere;text-align:left}\
thead{display:table-header-group}tr{break-inside:avoid}table.short{break-inside:avoid}h2+p{break-after:avoid}h2.frames{break-before:page}figure{margin:0;break-inside:avoid}figure svg{width:100%;height:auto}\
figcaption{font-size:9pt;margin-top:1mm}.doubtful td{background:#f6efe2}\
@media print{body{margin:0;padding:0;max-width:none}@page{size:A4;margin:14mm 12mm}}";

/// The report as HTML.
#[must_use]
pub fn html(film: &JointFilm, facts: &Facts) -> String {
    let mut out = String::new();
    let name = escaped(&film.name);
    let _ = write!(
        out,
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <title>{name}: joint motion</title><style>{STYLE}</style></head>\n<body>\n<h1>{name}: joint motion</h1>\n<p>{}</p>\n",
        escaped(&summary(film))
    );
    for remark in &film.remarks {
        let _ = writeln!(out, "<p><strong>{}</strong></p>", escaped(remark));
    }
    let _ = write!(
        out,
        "<h2>Figure</h2>\n<figure>\n{}<figcaption>{}</figcaption></figure>\n",
        figure(film).svg(),
        escaped(&caption(film))
    );
    steps(&mut out, film);
    accuracy(&mut out, film);
    doubts(&mut out, film);
    limits(&mut out, film, facts);
    inputs(&mut out, facts);
    settings(&mut out, film, facts);
    frames(&mut out, film);
    out.push_str("</body></html>\n");
    out
}

fn summary(film: &JointFilm) -> String {
    let side = match film.side {
        Side::Left => "Left",
        Side::Right => "Right",
    };
    let doubtful = film.doubtful_told();
    format!(
        "{side} knee, {} frames: {} with a pose of both components, {doubtful}. Made by fluoropose {}. Not a medical device, and not for \
         decisions about patients.",
        film.rows.len(),
        film.posed(),
        env!("CARGO_PKG_VERSION")
    )
}

fn caption(film: &JointFilm) -> String {
    let bands = if film.has_deviations() {
        "Bands and bars: one standard deviation, from the uncertainty of both poses."
    } else {
        "Without standard deviations: the uncertainty of the poses is not known."
    };
    let not_drawn = match film.impossible() {
        0 => String::new(),
        some => format!("; {some} frames have numbers that no knee has, and are not drawn"),
    };
    format!(
        "Joint motion of one knee. Thin lines and small points: frames, unfiltered; hollow points: doubtful frames, left out of all that follows{not_drawn}; large marks: linear \
         interpolation at steps of 10\u{b0} of flexion within monotonic phases, mean over the phases that pass it. {bands} a, lowest points of \
         the medial and lateral condyle above the tray, from the middle of the tray. b, rotation of the tibia. c, the tray from above \
         with the line between the lowest points at each step (of each frame, where there is no step), light to dark with flexion, and the centre of rotation with one standard \
         deviation. d, abduction of the tibia, negative where it is adducted, and height of the lateral condyle above the medial one; dotted: 1 mm."
    )
}

/// Numbers of the tables, with their headings.
const SHOWN: [(usize, &str); 6] = [
    (place::ABDUCTION, "abduction, \u{b0}"),
    (place::ROTATION, "internal rotation, \u{b0}"),
    (place::MEDIAL_AP, "medial AP, mm"),
    (place::LATERAL_AP, "lateral AP, mm"),
    (place::MEDIAL_AP + 2, "medial AP, % of tray"),
    (place::LATERAL_AP + 2, "lateral AP, % of tray"),
];

/// Tables that stay on one page, and those that may not.
const SHORT: &str = "short";
const LONG: &str = "long";

/// The head of a table; what is not long stays on one page. A unit stands below its number's name.
fn heading(out: &mut String, length: &str, words: &[&str]) {
    let _ = write!(out, "<table class=\"{length}\"><thead><tr>");
    for word in words {
        let (name, unit) = word.rsplit_once(", ").unwrap_or((word, ""));
        let line = if unit.is_empty() { "" } else { ",<br>" };
        let _ = write!(out, "<th>{}{line}{}</th>", escaped(name), escaped(unit));
    }
    out.push_str("</tr></thead><tbody>\n");
}

/// A number with one standard deviation, where that is known.
fn with_deviation(value: f64, deviation: f64) -> String {
    match (value.is_finite(), deviation.is_finite()) {
        (false, _) => "\u{2013}".to_owned(),
        (true, false) => minus(&format!("{value:.1}")),
        (true, true) => plus_minus(value, deviation, 1),
    }
}

/// What is rounded to zero has no sign.
fn minus(number: &str) -> String {
    let rest = number.strip_prefix("-0.0");
    let rest = rest.filter(|rest| !rest.starts_with(|letter: char| letter.is_ascii_digit()));
    let number = rest.map_or_else(|| number.to_owned(), |rest| format!("0.0{rest}"));
    number.replace('-', "\u{2212}")
}

/// What the poses themselves say of the numbers.
fn accuracy(out: &mut String, film: &JointFilm) {
    out.push_str("<h2>Accuracy to expect</h2>\n");
    if !film.has_deviations() {
        out.push_str("<p>Not known: the poses come without covariances.</p>\n");
        return;
    }
    out.push_str("<p>As carried from the covariances of both poses, without doubtful frames; what they do not know of is among the limits.</p>\n");
    heading(
        out,
        SHORT,
        &[
            "one standard deviation",
            "half of the frames",
            "every frame",
        ],
    );
    let flexion = (place::FLEXION, "flexion, \u{b0}");
    let others = [
        (place::MEDIAL, "mediolateral translation, mm"),
        (place::LIFT_OFF, "lift-off, mm"),
    ];
    for (number, word) in [flexion].into_iter().chain(SHOWN).chain(others) {
        let mut known = film.trusted(film.deviations(number));
        known.retain(|deviation| deviation.is_finite());
        known.sort_by(f64::total_cmp);
        let (middle, last) = (known.get(known.len() / 2), known.last());
        let cell = |deviation: Option<&f64>| match deviation {
            Some(deviation) => format!("<td>at most {:.1}</td>", rounded_up(*deviation)),
            None => "<td>\u{2013}</td>".to_owned(),
        };
        let (word, middle, last) = (escaped(word), cell(middle), cell(last));
        let _ = writeln!(out, "<tr><td>{word}</td>{middle}{last}</tr>");
    }
    out.push_str("</tbody></table>\n");
}

/// To a tenth: a number that is well known is off by something, too.
fn rounded_up(deviation: f64) -> f64 {
    (10.0 * deviation).ceil() / 10.0
}

fn steps(out: &mut String, film: &JointFilm) {
    out.push_str("<h2>At steps of flexion</h2>\n");
    let levels = film.levels();
    if levels.is_empty() {
        out.push_str("<p>None: no run of frames without doubt, bending or stretching only, passes a multiple of 10\u{b0}. Nothing is extrapolated, nor drawn across doubtful frames.</p>\n");
        return;
    }
    out.push_str("<p>n: monotonic phases that pass this flexion, without doubtful frames. Nothing is extrapolated.</p>\n");
    let mut words = vec!["flexion, \u{b0}", "n"];
    words.extend(SHOWN.map(|(_, word)| word));
    words.push("lift-off, mm");
    heading(out, SHORT, &words);
    let phases = film.phases();
    for level in levels {
        let numbers = SHOWN
            .iter()
            .map(|(number, _)| *number)
            .chain([place::LIFT_OFF]);
        let n = film.at(place::FLEXION, &phases, level).n;
        let _ = write!(
            out,
            "<tr><td>{}</td><td>{n}</td>",
            minus(&format!("{level:.0}"))
        );
        for number in numbers {
            let step = film.at(number, &phases, level);
            let _ = write!(
                out,
                "<td>{}</td>",
                with_deviation(step.mean, step.deviation)
            );
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</tbody></table>\n");
}

fn doubts(out: &mut String, film: &JointFilm) {
    let missing = film.rows.iter().filter(|row| row.joint.is_none());
    let missing: Vec<usize> = missing.map(|row| row.number).collect();
    out.push_str("<h2>Doubtful and missing frames</h2>\n");
    let doubtful = reasons(film, |row| row.doubt.as_deref());
    if let Some(all) = all_doubtful(film) {
        let _ = writeln!(out, "<p><strong>{}</strong></p>", escaped(&all));
    }
    if doubtful.is_empty() {
        let none = match film.has_verdicts {
            true => "No frame is marked as doubtful.",
            false => "Which frames are doubtful is not known: the poses come without verdicts.",
        };
        let _ = writeln!(out, "<p>{none}</p>");
    } else {
        reasons_table(out, &doubtful);
    }
    let checked = reasons(film, |row| row.accepted.as_deref());
    if !checked.is_empty() {
        let _ = writeln!(
            out,
            "<p>Doubtful until a person checked them and found them right; they count:</p>"
        );
        reasons_table(out, &checked);
    }
    if !missing.is_empty() {
        let _ = writeln!(
            out,
            "<p>Frames without a pose of both components, empty everywhere: {}.</p>",
            in_runs(&missing)
        );
    }
}

fn reasons_table(out: &mut String, reasons: &[(&str, Vec<usize>)]) {
    out.push_str(
        "<table><thead><tr><th>frames</th><th class=\"word\">why</th></tr></thead><tbody>\n",
    );
    for (why, frames) in reasons {
        let _ = writeln!(
            out,
            "<tr><td class=\"frames\">{}</td><td class=\"word\">{}</td></tr>",
            in_runs(frames),
            escaped(why)
        );
    }
    out.push_str("</tbody></table>\n");
}

/// What is said once for a film of which nothing can be relied on.
fn all_doubtful(film: &JointFilm) -> Option<String> {
    let (posed, doubtful) = (film.posed(), film.doubtful());
    (posed > 0 && doubtful >= posed).then(|| {
        let impossible = match film.impossible() {
            0 => String::new(),
            some => format!(" In {some} of them a number is one that no knee has."),
        };
        format!("All {posed} frames are doubtful, so that there are no steps of flexion and no centre of rotation.{impossible}")
    })
}

/// Each reason once, with its frames, in the order in which they come up.
fn reasons(film: &JointFilm, of: impl Fn(&JointRow) -> Option<&str>) -> Vec<(&str, Vec<usize>)> {
    let mut all: Vec<(&str, Vec<usize>)> = Vec::new();
    for row in &film.rows {
        let Some(why) = of(row) else {
            continue;
        };
        match all.iter_mut().find(|(known, _)| *known == why) {
            Some((_, frames)) => frames.push(row.number),
            None => all.push((why, vec![row.number])),
        }
    }
    all
}

/// Rising numbers in words: runs with a dash.
fn in_runs(numbers: &[usize]) -> String {
    let runs = numbers.chunk_by(|a, b| a + 1 == *b);
    let words = runs.map(|run| match run {
        [one] => one.to_string(),
        [first, .., last] => format!("{first}\u{2013}{last}"),
        [] => String::new(),
    });
    words.collect::<Vec<_>>().join(", ")
}

fn limits(out: &mut String, film: &JointFilm, facts: &Facts) {
    out.push_str("<h2>Limits</h2>\n<ul>\n");
    let mut say = |text: &str| {
        let _ = writeln!(out, "<li>{}</li>", escaped(text));
    };
    say(
        "One plane: depth is the least certain, and with it mediolateral translation. Where both components err in depth alike, as a wrong principal distance makes them, the joint hardly changes.",
    );
    say(
        "Lowest points are not contact: the insert between the components is not seen. Lift-off is the difference of their heights above the tray, so it is that of an insert equally thick on both sides.",
    );
    if film.has_deviations() {
        let KnownTo { distance, size } = KnownTo::USUALLY;
        say(&format!(
            "Standard deviations hold what errs from frame to frame and what is wrong with the whole film alike: its display and blur as far as they are \
             not known, a principal distance known to {} % and models whose size is known to {} % (judgements: this film does not tell them). What the \
             film has alike in both components is taken so, and no mean over frames makes it less.",
            100.0 * distance,
            100.0 * size
        ));
        say(
            "They do not know of a wrong model, of a calibration that is wrong by more, or of a pose on the wrong side of a mirror.",
        );
    } else {
        say("These poses come without a covariance, so no number has a standard deviation here.");
    }
    say(
        "The centre of rotation takes what errs from frame to frame as independent, which neighbouring frames are not: its standard deviation is too small where many frames cover little motion.",
    );
    let verdicts = film.no_verdicts_told();
    // Those of the knee stand at the top.
    let others = facts.remarks.iter();
    let others = others.filter(|remark| !film.remarks.contains(remark));
    let remarks = verdicts.iter().copied().chain(others.map(String::as_str));
    let origins = film.origins_told();
    for remark in remarks.chain(origins.iter().map(String::as_str)) {
        say(remark);
    }
    out.push_str("</ul>\n");
}

fn inputs(out: &mut String, facts: &Facts) {
    out.push_str("<h2>Made from</h2>\n<table class=\"short\"><thead><tr><th>what</th><th class=\"word\">file</th><th class=\"word\">SHA-256</th></tr></thead><tbody>\n");
    for input in &facts.inputs {
        let _ = writeln!(
            out,
            "<tr><td>{}</td><td class=\"word\">{}</td><td class=\"digest\">{}</td></tr>",
            escaped(&input.what),
            escaped(&input.name),
            escaped(&input.sha256)
        );
    }
    out.push_str("</tbody></table>\n");
}

fn settings(out: &mut String, film: &JointFilm, facts: &Facts) {
    out.push_str("<h2>Settings and conventions</h2>\n<table class=\"short\"><tbody>\n");
    let (times, filter) = (times(film), filter(film));
    let always = [
        ("six numbers", CONVENTIONS),
        ("translations", ORIGINS),
        ("times", &times),
        ("filter", &filter),
    ];
    let own = facts.settings.iter();
    let own = own.map(|(name, value)| (name.as_str(), value.as_str()));
    for (name, value) in always.into_iter().chain(own) {
        let (name, value) = (escaped(name), escaped(value));
        let _ = writeln!(
            out,
            "<tr><td>{name}</td><td class=\"word\">{value}</td></tr>"
        );
    }
    out.push_str("</tbody></table>\n");
}

fn frames(out: &mut String, film: &JointFilm) {
    let _ = writeln!(
        out,
        "<h2 class=\"frames\">Frame by frame</h2>\n<p>All {} numbers, unrounded, are in joint.csv. ML: the femoral origin to medial of the tibial one, in tibial axes.</p>",
        COLUMNS.len()
    );
    let mut words = vec!["frame", "flexion, \u{b0}"];
    words.extend(SHOWN.iter().take(4).map(|(_, word)| *word));
    words.extend(["ML, mm", "lift-off, mm", "P(lift-off, > 1 mm)"]);
    heading(out, LONG, &words);
    for row in &film.rows {
        let class = if row.doubt.is_some() {
            " class=\"doubtful\""
        } else {
            ""
        };
        let _ = write!(out, "<tr{class}><td>{}</td>", row.number);
        let numbers = [place::FLEXION]
            .into_iter()
            .chain(SHOWN.iter().take(4).map(|(number, _)| *number))
            .chain([place::MEDIAL, place::LIFT_OFF]);
        for number in numbers {
            let value = row.joint.map_or(f64::NAN, |joint| joint.numbers[number]);
            let deviation = row.joint.and_then(|joint| Some(joint.deviations?[number]));
            let _ = write!(
                out,
                "<td>{}</td>",
                with_deviation(value, deviation.unwrap_or(f64::NAN))
            );
        }
        let probability = row.joint.and_then(|joint| joint.lift_off_probability(1.0));
        let text = probability.map_or("\u{2013}".to_owned(), |p| format!("{p:.2}"));
        let _ = writeln!(out, "<td>{text}</td></tr>");
    }
    out.push_str("</tbody></table>\n");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_is_no_less_than_what_it_bounds_and_never_nothing() {
        let rounded = [0.03, 0.1, 0.101, 1.0, 2.34].map(rounded_up);
        assert_eq!(rounded, [0.1, 0.1, 0.2, 1.0, 2.4]);
    }
}

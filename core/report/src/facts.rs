//! What a report says beside the numbers: where they come from, and by what settings.

use fluoropose::joint::flange::OtherSide;
use fluoropose::mesh::anatomy::AnatomicalAxes;

use crate::film::JointFilm;

/// A file that a report was made from.
#[derive(Clone, Debug)]
pub struct Input {
    /// What it is: `femoral model`, `calibration`.
    pub what: String,
    /// Its name.
    pub name: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

/// What a report says beside the numbers.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    /// The files.
    pub inputs: Vec<Input>,
    /// What was chosen beside what the numbers say themselves: a name and a value each.
    pub settings: Vec<(String, String)>,
    /// What a reader has to know of these data beyond what is always said.
    pub remarks: Vec<String>,
}

impl Facts {
    /// A setting more.
    pub fn set(&mut self, name: &str, value: impl Into<String>) {
        self.settings.push((name.to_owned(), value.into()));
    }

    /// What the femoral component says of the side that is stated, where that is the other one.
    #[must_use]
    pub fn side_remark(other: OtherSide) -> String {
        format!("Side: {other}.")
    }

    /// Which of a component's own axes is which; `what`: `femoral`, `tibial`.
    pub fn set_axes(&mut self, what: &str, axes: &AnatomicalAxes) {
        let words = format!("anterior, superior, right: {axes}");
        self.set(&format!("{what} axes"), words);
    }
}

pub(crate) const CONVENTIONS: &str = "field: femoral origin in tibial axes; rotations z, x, y, which is Grood and Suntay's sequence; their translations in joint.csv as gs_*";

pub(crate) fn times(film: &JointFilm) -> String {
    film.frames_per_s.map_or("not stated".to_owned(), |rate| {
        format!("{rate} frames a second")
    })
}

pub(crate) fn filter(film: &JointFilm) -> String {
    film.cutoff_hz.map_or("none".to_owned(), |cutoff| {
        format!("{cutoff} Hz, zero-lag Butterworth of fourth order, in joint.csv beside the others; the figure is unfiltered")
    })
}

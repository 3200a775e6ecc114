//! What came of a click or a box, and how sure it is.

use js_sys::Float64Array;
use wasm_bindgen::prelude::*;

use crate::found::Match;

/// Parts of the outline on edges from which an answer is good, and fair.
const GOOD: f64 = 0.85;
pub(super) const FAIR: f64 = 0.65;

/// What came of a click or a box: candidates, the chosen one first. Asked beyond `count`, the methods answer nothing.
#[wasm_bindgen]
pub struct OneClickAnswer {
    pub(super) outlines: Vec<Vec<f64>>,
    /// Of outlines from a model.
    pub(super) supports: Vec<f64>,
    /// Of poses that were given: which of them each of the first was.
    pub(super) places: Vec<Option<usize>>,
    /// Whether its poses are as the film puts the edges.
    pub(super) corrected: bool,
    pub(super) matched: Option<Match>,
    pub(super) sentence: String,
}

impl OneClickAnswer {
    /// Without candidates so far.
    pub(super) fn new(corrected: bool) -> Self {
        Self {
            outlines: Vec::new(),
            supports: Vec::new(),
            places: Vec::new(),
            corrected,
            matched: None,
            sentence: String::new(),
        }
    }
}

#[wasm_bindgen]
impl OneClickAnswer {
    /// Whether its poses are as the film puts the edges: what the film makes of the component was known.
    #[wasm_bindgen(getter)]
    pub fn corrected(&self) -> bool {
        self.corrected
    }

    /// How many candidates there are.
    #[wasm_bindgen(getter)]
    pub fn count(&self) -> usize {
        self.outlines.len()
    }

    /// Whether the outlines are the model's silhouettes, each with a pose; otherwise there is one, of a region.
    #[wasm_bindgen(getter, js_name = fromModel)]
    pub fn from_model(&self) -> bool {
        !self.supports.is_empty()
    }

    /// What was done and how sure it is.
    #[wasm_bindgen(getter)]
    pub fn sentence(&self) -> String {
        self.sentence.clone()
    }

    /// How sure the first candidate is: "good", "fair" or "poor".
    #[wasm_bindgen(getter)]
    pub fn confidence(&self) -> String {
        let word = match self.supports.first() {
            Some(&share) if share >= GOOD => "good",
            Some(&share) if share >= FAIR => "fair",
            _ => "poor",
        };
        word.to_owned()
    }

    /// Columns and rows by turns: a simple polygon.
    pub fn outline(&self, index: usize) -> Option<Float64Array> {
        let outline = self.outlines.get(index)?;
        Some(Float64Array::from(&outline[..]))
    }

    /// Part of the outline that lies on an edge of the right polarity, 0 to 1; nothing for a region.
    pub fn support(&self, index: usize) -> Option<f64> {
        self.supports.get(index).copied()
    }

    /// Which of the poses that were given it was; nothing where it is another one.
    pub fn from(&self, index: usize) -> Option<usize> {
        self.places.get(index).copied().flatten()
    }

    /// The candidates' poses, in the same order; once, and nothing for a region.
    #[wasm_bindgen(js_name = takeMatch)]
    pub fn take_match(&mut self) -> Option<Match> {
        self.matched.take()
    }
}

/// What was done and how sure it is: `share` of the outline's length lies on edges, and another pose may be `open`.
pub(super) fn told(share: f64, open: bool) -> String {
    let percent = (100.0 * share).round();
    let how = format!("The model's outline lies on edges along {percent} % of its length.");
    let doubt = match share {
        share if share >= GOOD => "",
        share if share >= FAIR => " Check it before you go on.",
        _ => {
            " That is little: something may hide it, or it is another part; correct it or click elsewhere."
        }
    };
    let rival = match open {
        true => " Another pose explains the frame nearly as well.",
        false => "",
    };
    format!("{how}{doubt}{rival}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_tells_how_sure_it_is_and_of_a_rival_that_is_open() {
        let good = "The model's outline lies on edges along 94 % of its length.";
        assert_eq!(told(0.936, false), good);
        let rival = " Another pose explains the frame nearly as well.";
        assert_eq!(told(0.936, true), format!("{good}{rival}"));
        assert!(told(0.7, false).ends_with(" Check it before you go on."));
        assert!(told(0.4, false).contains("correct it or click elsewhere"));
    }
}

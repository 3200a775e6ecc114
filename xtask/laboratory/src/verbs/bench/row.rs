//! One figure beside a peer's, and how it is taken.

use std::hint::black_box;
use std::time::Instant;

use serde::Serialize;

/// One piece of work, ours and a peer's.
#[derive(Debug, Serialize)]
pub(super) struct Row {
    pub(super) work: String,
    pub(super) ours_ms: f64,
    pub(super) peer: String,
    /// Nothing where the peer could not be run.
    pub(super) peer_ms: Option<f64>,
    /// The peer's time over ours.
    pub(super) ratio: Option<f64>,
    /// Whether both gave the same answer, every time.
    pub(super) same_answer: Option<bool>,
}

impl Row {
    pub(super) fn new(work: &str, ours_ms: f64, peer: &str, theirs: Option<(f64, bool)>) -> Self {
        Self {
            work: work.to_owned(),
            ours_ms,
            peer: peer.to_owned(),
            peer_ms: theirs.map(|(ms, _)| ms),
            ratio: theirs.map(|(ms, _)| ms / ours_ms),
            same_answer: theirs.map(|(_, same)| same),
        }
    }
}

/// The median; of none, not a number.
pub(super) fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Milliseconds that a piece of work takes, and what it gives.
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let value = black_box(work());
    (1000.0 * start.elapsed().as_secs_f64(), value)
}

//! What is wrong with an array.

use crate::error::Problem;

const FORMAT: &str = "NumPy";

pub(super) fn damaged(detail: &str) -> Problem {
    Problem::damaged(FORMAT, detail)
}

pub(super) fn not_read(detail: String) -> Problem {
    Problem::unsupported(
        FORMAT,
        detail,
        "Save frames as numbers of shape (rows, columns) or (frames, rows, columns); numpy.moveaxis(frames, -1, 0) puts the last axis first",
    )
}

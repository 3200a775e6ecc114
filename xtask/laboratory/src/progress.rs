//! How far a long piece of work is.

use indicatif::{ProgressBar, ProgressStyle};

/// A progress bar that counts `what`.
pub fn progress(length: usize, what: &str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {elapsed} (left {eta})")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length as u64)
        .with_style(style)
        .with_message(what.to_owned())
}

/// Says on standard error what is being done now.
pub fn announce(what: &str) {
    eprintln!("==> {what}");
}

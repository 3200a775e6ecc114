//! How far a long piece of work is, and the wish to end it.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::{Result, bail};
use indicatif::{ProgressBar, ProgressStyle};

/// Whether bars are drawn: they are a person's at a terminal, and no other program's that calls this one.
static BARS: AtomicBool = AtomicBool::new(true);

/// From now on no bars are drawn in this process.
pub fn without_bars() {
    BARS.store(false, Ordering::Relaxed);
}

/// A progress bar that counts `what`.
pub fn progress(length: usize, what: &str) -> ProgressBar {
    if !BARS.load(Ordering::Relaxed) {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {elapsed} (left {eta})")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length as u64)
        .with_style(style)
        .with_message(what.to_owned())
}

/// What was said once.
static SAID: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());

/// Says a sentence on standard error that holds for many things alike, as a camera's for every source of masks: the first time alone.
pub fn say_once(sentence: &str) {
    let mut said = SAID.lock().unwrap_or_else(PoisonError::into_inner);
    if said.insert(sentence.to_owned()) {
        eprintln!("{sentence}");
    }
}

/// Says on standard error what is being done now.
pub fn announce(what: &str) {
    eprintln!("==> {what}");
}

/// A wish to end some work, which the work looks at between its steps. Copies are of one wish.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Asks for the end.
    pub fn ask(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Goes on unless the end was asked for.
    ///
    /// # Errors
    /// Where it was.
    pub fn check(&self) -> Result<()> {
        if self.0.load(Ordering::Relaxed) {
            bail!("the work was called off");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_of_a_wish_is_the_same_wish() {
        let stop = Stop::default();
        let copy = stop.clone();
        assert!(copy.check().is_ok());
        stop.ask();
        assert!(copy.check().is_err());
        assert!(Stop::default().check().is_ok());
    }
}

//! What all steps of a run share: what is asked, the film, the journal, and how the progress is told.

use std::sync::Mutex;

use fluoropose::follow::Looked;

use super::journal::Journal;
use super::part::Part;
use super::request::Request;
use crate::files::Film;

/// What all parts of a run share.
pub(super) struct Run<'r> {
    pub(super) request: &'r Request,
    pub(super) film: &'r Film,
    pub(super) journal: Journal,
    pub(super) saying: Mutex<()>,
}

impl Run<'_> {
    /// Says something on standard error.
    pub(super) fn say(&self, text: &str) {
        if !self.request.quiet {
            let _one = self.saying.lock();
            eprintln!("{text}");
        }
    }

    pub(super) fn debug(&self, text: impl FnOnce() -> String) {
        if std::env::var_os("FLUOROPOSE_TRACK_DEBUG").is_some() {
            self.say(&text());
        }
    }

    /// Tells the progress by frame.
    pub(super) fn tell(&self, part: &Part<'_>, frame: usize, looked: &Looked) {
        if self.request.quiet {
            return;
        }
        let what = match &looked.found {
            Ok(found) => format!(
                "{:.2} px, edges {:.2}{}",
                found.misfit_px,
                found.contrast.strength,
                if looked.searched { ", searched" } else { "" }
            ),
            Err(why) => format!("{why:?}").to_lowercase(),
        };
        self.say(&format!("{} frame {}: {what}", part.name(), frame + 1));
    }
}

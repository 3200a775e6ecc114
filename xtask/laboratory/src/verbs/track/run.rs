//! What all steps of a run share: what is asked, the film, the journal, and how the progress is told.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use anyhow::Result;
use fluoropose::follow::Looked;

use super::journal::Journal;
use super::part::Part;
use super::record::Record;
use super::request::{Request, Told};
use crate::files::Film;

/// What all parts of a run share.
pub(super) struct Run<'r> {
    pub(super) request: &'r Request,
    pub(super) film: &'r Film,
    pub(super) journal: &'r Journal,
    /// Number of components.
    pub(super) parts: usize,
    /// Frames that were looked at, by the numbers of their components.
    pub(super) seen: Mutex<BTreeSet<(usize, usize)>>,
}

impl<'r> Run<'r> {
    /// The same on the same film in other squares.
    pub(super) fn on(&self, film: &'r Film) -> Self {
        let seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        Self {
            film,
            seen: Mutex::new(seen.clone()),
            ..*self
        }
    }
}

impl Run<'_> {
    /// Tells what was done or is begun.
    pub(super) fn say(&self, what: String) {
        let seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        (self.request.listener)(Told::Step {
            what,
            done: seen.len(),
            of: self.parts * self.film.count(),
        });
    }

    /// A step of the journal that takes a while, told when it is begun.
    ///
    /// # Errors
    /// As of [`Journal::step`].
    pub(super) fn step<R: Record>(
        &self,
        (part, frame): (&Part<'_>, usize),
        what: &str,
        key: &str,
        work: impl FnOnce() -> Result<R>,
    ) -> Result<R> {
        self.journal.step(key, || {
            self.say(format!("{} frame {}: {what}", part.name(), frame + 1));
            work()
        })
    }

    /// Tells that all is done: also what was never looked at, because nothing led to it.
    pub(super) fn say_done(&self) {
        let of = self.parts * self.film.count();
        let what = "done".to_owned();
        (self.request.listener)(Told::Step { what, done: of, of });
    }

    pub(super) fn debug(&self, text: impl FnOnce() -> String) {
        if std::env::var_os("FLUOROPOSE_TRACK_DEBUG").is_some() {
            eprintln!("{}", text());
        }
    }

    /// Counts a frame of a component as looked at.
    pub(super) fn count(&self, part: &Part<'_>, frame: usize) {
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        seen.insert((part.number, frame));
    }

    /// Tells what was seen in a frame.
    pub(super) fn tell(&self, part: &Part<'_>, frame: usize, looked: &Looked) {
        self.count(part, frame);
        let what = match &looked.found {
            Ok(found) => format!(
                "{:.2} px, edges {:.2}{}",
                found.misfit_px,
                found.contrast.strength,
                if looked.searched { ", searched" } else { "" }
            ),
            Err(why) => format!("{why:?}").to_lowercase(),
        };
        self.say(format!("{} frame {}: {what}", part.name(), frame + 1));
    }
}

//! What is said of the work, line by line; where several steps run side by side, each line says of which it is.

use std::cell::Cell;

thread_local! {
    /// The lane that this thread works in, where several work side by side.
    static LANE: Cell<Option<Lane>> = const { Cell::new(None) };
}

/// A row of steps that runs beside others.
#[derive(Clone, Copy)]
pub(crate) struct Lane {
    /// What stands before each of its lines.
    pub(crate) name: &'static str,
    /// How much its programs give way to those of other lanes, as the program `nice` counts: a compiler can wait, a browser's
    /// test has a clock.
    pub(crate) gives_way: u8,
}

impl Lane {
    /// Works in this lane.
    pub(crate) fn work<T>(self, work: impl FnOnce() -> T) -> T {
        LANE.set(Some(self));
        let done = work();
        LANE.set(None);
        done
    }
}

/// The lane that this thread works in.
pub(crate) fn lane() -> Option<Lane> {
    LANE.get()
}

/// Writes a line of output, with the lane that it comes from.
pub(crate) fn say(line: &str) {
    match LANE.get() {
        Some(lane) => println!("{:<8} | {line}", lane.name),
        None => println!("{line}"),
    }
}

/// Says what is being done now: every slow step has such a line.
pub(crate) fn announce(what: &str) {
    say(&format!("==> {what}"));
}

//! Work on many things, some of them beside each other.

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};
use std::thread;

use anyhow::Result;

use crate::output;

/// Does something with each thing, so many at a time, in the lane of this thread. Results come in no order.
///
/// # Errors
/// The first that `one` had, when all that had begun is done.
pub(super) fn each<T: Send, R: Send>(
    things: VecDeque<T>,
    at_once: usize,
    one: impl Fn(&T) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let lane = output::lane();
    let waiting = Mutex::new(things);
    let next = || {
        waiting
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .pop_front()
    };
    let work = || -> Result<Vec<R>> { std::iter::from_fn(next).map(|thing| one(&thing)).collect() };
    let in_lane = || lane.map_or_else(work, |lane| lane.work(work));
    let ended = thread::scope(|scope| {
        let workers: Vec<_> = (0..at_once).map(|_| scope.spawn(in_lane)).collect();
        workers
            .into_iter()
            .map(thread::ScopedJoinHandle::join)
            .collect::<Vec<_>>()
    });
    let mut all = Vec::new();
    for of_one in ended {
        match of_one {
            Ok(ended) => all.extend(ended?),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    }
    Ok(all)
}

/// Those that are named first, in that order, and then the others: what begins late and takes long is waited for alone.
pub(super) fn long_first<T>(
    mut things: Vec<T>,
    long: &[&str],
    name: impl Fn(&T) -> &str,
) -> VecDeque<T> {
    things.sort_by_key(|thing| {
        let place = long.iter().position(|long| *long == name(thing));
        place.unwrap_or(long.len())
    });
    things.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_begin_first() {
        let order = long_first(
            vec!["a", "long", "b", "longer"],
            &["longer", "long"],
            |name| name,
        );
        assert_eq!(order, ["longer", "long", "a", "b"]);
    }

    #[test]
    fn all_are_done_and_an_error_is_told() {
        let mut doubled = each((1..=20).collect(), 3, |number| Ok(2 * number)).unwrap();
        doubled.sort_unstable();
        assert!(doubled.into_iter().eq((1..=20).map(|number| 2 * number)));
        let refused = |number: &i32| {
            anyhow::ensure!(*number != 7, "seven");
            Ok(())
        };
        let error = each((1..=20).collect(), 3, refused).unwrap_err();
        assert_eq!(error.to_string(), "seven");
    }
}

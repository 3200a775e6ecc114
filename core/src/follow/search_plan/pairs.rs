//! Frames beside those in which other components are known, one after the other.

use super::sought::Sought;
use super::step::{Other, Search};

/// A place in the list of frames beside known ones of all other components.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pairs {
    pub(super) other: usize,
    from: usize,
    pub(super) place: usize,
}

impl Pairs {
    /// The next frame in which another component is known, those that `leads` names: its own frame first, then the ends of what is followed
    /// from there, which is asked for before.
    pub(super) fn next(
        &mut self,
        part: usize,
        parts: &[Sought],
        leads: impl Fn(&Sought) -> bool,
    ) -> Option<(usize, Search)> {
        loop {
            let other = parts.get(self.other)?;
            let from = other.known.get(self.from);
            let (Some(from), false, true) = (from, self.other == part, leads(other)) else {
                *self = Self {
                    other: self.other + 1,
                    ..Self::default()
                };
                continue;
            };
            let there = match (self.place, &from.ends) {
                (0, _) => Some((from.frame, from.pose)),
                (1 | 2, None) => {
                    return Some((from.frame, Search::Follow { from: self.from }));
                }
                (1 | 2, Some(ends)) => ends[self.place - 1].filter(|end| end.0 != from.frame),
                _ => {
                    (self.from, self.place) = (self.from + 1, 0);
                    continue;
                }
            };
            let Some((frame, pose)) = there else {
                self.place += 1;
                continue;
            };
            let (part, from) = (self.other, self.from);
            return Some((frame, Search::Joint(Other { part, from, pose })));
        }
    }
}

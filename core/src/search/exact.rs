//! Exact search of a library that reads little of it.
//!
//! The differences of two sketches (set pixels of blocks) are a lower bound on their silhouettes'
//! unmatched pixels. Bounds of all views are quick; only views whose bound does not exceed what has
//! been found already are compared in full. The answers are those of comparing every view, ties
//! included. In a plain library, which has no sketches, every view is compared.

use heapless::{Vec, VecView};

use crate::canonical::CanonicalSpec;
use crate::library::Library;
use crate::memory::first;
use crate::search::kernels::Kernels;
use crate::search::query::{Query, bound, longest_sketch};
use crate::search::scores::{MatchError, ViewMatch, neighbours, rows_around, scores_needed};
use crate::shortlist::keep;

/// Bounds below this bit; set where the number is no bound but exact.
const EXACT: u32 = 1 << 31;

/// See [`ViewSearch::rivals`]. A true pose is less than one step from the nearest view.
const RIVAL_STEPS: u32 = 4;

/// Minima of the bounds from which it is gone downhill; others are found by looking at all places.
const DESCENTS: usize = 32;

/// Directions of the principal axis that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Directions {
    /// The silhouette as it is.
    Straight,
    /// As it is and rotated by 180 degrees.
    Both,
}

/// Working memory of a [`ViewSearch`].
#[derive(Debug)]
pub struct ViewSearchMemory<'m> {
    /// [`crate::search::scores_needed`] numbers.
    pub bounds: &'m mut [u32],
    /// [`search_bytes_needed`] bytes.
    pub sketches: &'m mut [u8],
}

/// Bytes of [`ViewSearchMemory::sketches`].
#[must_use]
pub const fn search_bytes_needed(spec: &CanonicalSpec) -> usize {
    longest_sketch(spec)
}

/// The search for a silhouette in a library. For each view it holds the exact number of unmatched pixels where that has
/// been counted, and a lower bound elsewhere.
#[derive(Debug)]
pub struct ViewSearch<'s, 'm> {
    library: &'s Library<'s>,
    query: &'s Query<'s>,
    kernels: Kernels,
    /// Straight, then reversed.
    bounds: &'m mut [u32],
}

impl<'s, 'm> ViewSearch<'s, 'm> {
    /// Bounds the unmatched pixels of all views. `query` must have the library's own canonical frame.
    ///
    /// # Errors
    /// [`MatchError`] for memory of a wrong length or a query of another canonical frame.
    pub fn new(
        library: &'s Library<'s>,
        query: &'s Query<'s>,
        kernels: &Kernels,
        memory: ViewSearchMemory<'m>,
    ) -> Result<Self, MatchError> {
        let spec = library.info().canonical;
        if *query.spec() != spec {
            return Err(MatchError::Canonical);
        }
        let bounds = first("scores", scores_needed(library.views()), memory.bounds)?;
        let sketches = first(
            "bytes of sketches",
            search_bytes_needed(&spec),
            memory.sketches,
        )?;
        let mut search = Self {
            library,
            query,
            kernels: *kernels,
            bounds,
        };
        search.bound(sketches);
        Ok(search)
    }

    fn bound(&mut self, memory: &mut [u8]) {
        let Some(sketches) = self.library.sketches() else {
            self.score_all();
            return;
        };
        let stride = sketches.stride();
        let ours = memory.get_mut(..sketches.compared()).unwrap_or_default();
        let views = self.library.views().max(1);
        for (reversed, bounds) in [false, true].into_iter().zip(self.bounds.chunks_mut(views)) {
            let base = self
                .query
                .sketch_for(&sketches, reversed, &self.kernels, ours);
            bound(ours, sketches.all, stride, base, &self.kernels, bounds);
        }
    }

    /// Compares every view at once: a plain library has no sketches.
    fn score_all(&mut self) {
        self.bounds.fill(0);
        for reversed in [false, true] {
            for view in 0..self.library.views() {
                self.score(view, reversed);
            }
        }
    }

    /// The library.
    #[must_use]
    pub fn library(&self) -> &'s Library<'s> {
        self.library
    }

    /// The silhouette.
    #[must_use]
    pub fn query(&self) -> &'s Query<'s> {
        self.query
    }

    /// Unmatched pixels of a view, counted at most once.
    pub fn score(&mut self, view: usize, reversed: bool) -> u32 {
        let at = self.place(view, reversed);
        match self.bounds.get(at) {
            Some(known) if known & EXACT != 0 => known & !EXACT,
            _ => {
                let query = self.query;
                let exact = query.unmatched(self.library, view, reversed, &self.kernels);
                if let Some(bound) = self.bounds.get_mut(at) {
                    *bound = exact | EXACT;
                }
                exact
            }
        }
    }

    /// At most a view's unmatched pixels.
    fn at_least(&self, view: usize, reversed: bool) -> u32 {
        self.at_least_at(self.place(view, reversed))
    }

    /// The same of a place.
    fn at_least_at(&self, place: usize) -> u32 {
        let bound = self.bounds.get(place);
        bound.map_or(u32::MAX, |bound| bound & !EXACT)
    }

    fn place(&self, view: usize, reversed: bool) -> usize {
        let views = self.library.views();
        if view >= views {
            return usize::MAX;
        }
        view + if reversed { views } else { 0 }
    }

    fn candidate(&mut self, place: usize) -> ViewMatch {
        let (view, reversed) = self.apart(place);
        ViewMatch {
            view,
            reversed,
            unmatched: self.score(view, reversed),
        }
    }

    /// The `K` views with the fewest unmatched pixels, best first. Ties keep view order, the
    /// straight direction first.
    pub fn best<const K: usize>(&mut self, directions: Directions) -> Vec<ViewMatch, K> {
        let mut best = Vec::new();
        self.add_best(directions, &mut best);
        best
    }

    fn add_best(&mut self, directions: Directions, candidates: &mut VecView<ViewMatch>) {
        let places = match directions {
            Directions::Straight => self.library.views(),
            Directions::Both => scores_needed(self.library.views()),
        };
        let mut best = Shortlist::up_to(u32::MAX, candidates);
        // The least bound first: what it turns out to be rules most of the others out.
        let bounds = self.bounds.iter().take(places).enumerate();
        let least = bounds.min_by_key(|(_, bound)| **bound & !EXACT);
        let Some(first) = least.map(|(place, _)| place) else {
            return;
        };
        best.offer(self.candidate(first));
        for place in 0..places {
            if self.at_least_at(place) <= best.limit && place != first {
                let candidate = self.candidate(place);
                best.offer(candidate);
            }
        }
    }

    /// The best `K` local minima of the score surfaces, both directions: views that none of their
    /// eight neighbours beats. These are the rival poses; the views beside a minimum are not.
    pub fn minima<const K: usize>(&mut self) -> Vec<ViewMatch, K> {
        let mut minima = Vec::new();
        self.add_minima(u32::MAX, &mut minima);
        minima
    }

    /// The best `K` of these minima whose unmatched pixels exceed the best one's by no more than four steps of the grid
    /// there change: a view that differs more does not explain the silhouette.
    #[cfg_attr(target_os = "none", inline(never))]
    pub fn rivals<const K: usize>(&mut self) -> Vec<ViewMatch, K> {
        let best = self.best::<1>(Directions::Both);
        let Some(best) = best.first() else {
            return Vec::new();
        };
        let library = self.library;
        let own = library.pixels(best.view);
        let step = neighbours(&library.info().grid, best.view)
            .map(|near| own + library.pixels(near) - 2 * library.overlap(best.view, near))
            .max();
        let beyond = step.map_or(u32::MAX, |step| RIVAL_STEPS.saturating_mul(step));
        let mut rivals = Vec::new();
        self.add_minima(best.unmatched.saturating_add(beyond), &mut rivals);
        rivals
    }

    fn add_minima(&mut self, most: u32, candidates: &mut VecView<ViewMatch>) {
        let places = scores_needed(self.library.views());
        let mut minima = Shortlist::up_to(most, candidates);
        // Going downhill from the least of the bounds' own minima finds most of them: a limit for the rest.
        for (bound, place) in self.promising(most) {
            if bound <= minima.limit {
                let (view, reversed) = self.apart(place);
                let candidate = self.descend(view, reversed);
                minima.offer(candidate);
            }
        }
        for place in 0..places {
            if self.at_least_at(place) > minima.limit {
                continue;
            }
            let (view, reversed) = self.apart(place);
            if self.is_minimum(view, reversed) {
                let candidate = self.candidate(place);
                minima.offer(candidate);
            }
        }
    }

    /// The least minima of the bounds, up to a limit, with their places.
    fn promising(&self, most: u32) -> Vec<(u32, usize), DESCENTS> {
        let mut least: Vec<(u32, usize), DESCENTS> = Vec::new();
        let mut limit = most;
        for (place, bound) in self.bounds.iter().enumerate() {
            let bound = bound & !EXACT;
            if bound > limit || !self.is_minimum_of_bounds(place, bound) {
                continue;
            }
            keep(&mut least, (bound, place), |&(bound, _)| bound);
            if let (true, Some(&(last, _))) = (least.is_full(), least.last()) {
                limit = most.min(last);
            }
        }
        least
    }

    fn apart(&self, place: usize) -> (usize, bool) {
        match place.checked_sub(self.library.views()) {
            None => (place, false),
            Some(view) => (view, true),
        }
    }

    fn is_minimum_of_bounds(&self, place: usize, bound: u32) -> bool {
        let (view, reversed) = self.apart(place);
        let mut rows = self.around(view, reversed);
        rows.all(|(_, row)| row.iter().all(|other| bound <= other & !EXACT))
    }

    /// The rows of bounds of the views around one, itself among them, each with the number of its first view.
    fn around(&self, view: usize, reversed: bool) -> impl Iterator<Item = (usize, &[u32])> {
        let views = self.library.views();
        let surfaces = self.bounds.split_at_checked(views).unwrap_or_default();
        let surface = if reversed { surfaces.1 } else { surfaces.0 };
        let rows = rows_around(&self.library.info().grid, view);
        rows.filter_map(|row| Some((row.start, surface.get(row)?)))
    }

    /// Whether a neighbour is known to have fewer unmatched pixels.
    fn has_known_below(&self, pixels: u32, view: usize, reversed: bool) -> bool {
        // The number of such a one lies between its mark alone and this.
        let is_below = |known: &u32| (EXACT..EXACT | pixels).contains(known);
        let mut rows = self.around(view, reversed);
        rows.any(|(_, row)| row.iter().any(is_below))
    }

    /// The neighbour with the least bound, the first of equals, and that bound.
    fn likeliest_neighbour(&self, view: usize, reversed: bool) -> (u32, usize) {
        let mut least = (u32::MAX, view);
        for (first, row) in self.around(view, reversed) {
            for (neighbour, bound) in (first..).zip(row) {
                let bound = bound & !EXACT;
                if bound < least.0 && neighbour != view {
                    least = (bound, neighbour);
                }
            }
        }
        least
    }

    /// The local minimum that descent over neighbours leads to.
    fn descend(&mut self, view: usize, reversed: bool) -> ViewMatch {
        let mut view = view;
        while let Some(better) = self.better_neighbour(view, reversed) {
            view = better;
        }
        ViewMatch {
            view,
            reversed,
            unmatched: self.score(view, reversed),
        }
    }

    fn is_minimum(&mut self, view: usize, reversed: bool) -> bool {
        // Where a neighbour is known to beat even the bound, the view need not be compared.
        let bound = self.at_least(view, reversed);
        if self.has_known_below(bound, view, reversed) {
            return false;
        }
        // Otherwise the likeliest neighbour is compared first: it beats other views around it, too.
        let (least, neighbour) = self.likeliest_neighbour(view, reversed);
        let beaten = least < bound && self.score(neighbour, reversed) < bound;
        !beaten && self.better_neighbour(view, reversed).is_none()
    }

    /// A neighbour that beats a view, if one does: that with the least bound is compared first. Of equal neighbours
    /// the first beats.
    fn better_neighbour(&mut self, view: usize, reversed: bool) -> Option<usize> {
        let own = (self.score(view, reversed), view);
        loop {
            let (bound, neighbour) = self.likeliest_neighbour(view, reversed);
            if (bound, neighbour) > own {
                return None;
            }
            if (self.score(neighbour, reversed), neighbour) < own {
                return Some(neighbour);
            }
        }
    }
}

/// The best candidates so far, as many as there is room for, best first. One function for lists of all lengths, because a microcontroller would have it for
/// each.
struct Shortlist<'v> {
    candidates: &'v mut VecView<ViewMatch>,
    /// What has more unmatched pixels than this is none of the best.
    limit: u32,
}

impl<'v> Shortlist<'v> {
    fn up_to(most: u32, candidates: &'v mut VecView<ViewMatch>) -> Self {
        // A list without room has no best.
        let limit = if candidates.is_full() { 0 } else { most };
        Self { candidates, limit }
    }

    /// Takes a candidate in its place, once.
    fn offer(&mut self, candidate: ViewMatch) {
        let key = |one: &ViewMatch| (one.unmatched, one.reversed, one.view);
        if candidate.unmatched <= self.limit && !self.candidates.contains(&candidate) {
            keep(self.candidates, candidate, key);
        }
        if let (true, Some(last)) = (self.candidates.is_full(), self.candidates.last()) {
            self.limit = last.unmatched;
        }
    }
}

#[cfg(test)]
mod tests;

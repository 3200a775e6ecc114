//! Best-first search of a catalogue's tree.

use heapless::Vec;
use heapless::binary_heap::{BinaryHeap, Min};

use super::tree::{Catalogue, Node, PATCH};
use crate::canonical::CanonicalSpec;
use crate::library::Library;
use crate::memory::first;
use crate::search::kernels::Kernels;
use crate::search::query::{Query, bound, longest_sketch};
use crate::search::scores::{MatchError, ViewMatch};
use crate::shortlist::keep;

/// The best view of one library of a catalogue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identified {
    /// Number of the library.
    pub library: usize,
    /// Its best view.
    pub best: ViewMatch,
}

/// Bytes of working memory of [`Catalogue::identify`].
#[must_use]
pub const fn identify_bytes_needed(spec: &CanonicalSpec) -> usize {
    3 * longest_sketch(spec)
}

impl<'c> Catalogue<'c> {
    /// The libraries.
    #[must_use]
    pub fn libraries(&self) -> &'c [Library<'c>] {
        self.libraries
    }

    /// The canonical frame of all libraries.
    #[must_use]
    pub fn spec(&self) -> CanonicalSpec {
        let first = self.libraries.first();
        first.map_or_else(CanonicalSpec::default, |library| library.info().canonical)
    }

    /// The `K` implants whose best views have the fewest unmatched pixels, best first; of each
    /// implant its best view, both directions of the axis. The same as searching every library: ties
    /// keep the libraries' order, within one the straight direction first, then view order.
    /// `bytes` is working memory, [`identify_bytes_needed`] of it; some 10 KB of stack are used besides.
    ///
    /// # Errors
    /// [`MatchError`] for memory of a wrong length or a query of another canonical frame.
    pub fn identify<const K: usize>(
        &self,
        query: &Query<'_>,
        kernels: &Kernels,
        bytes: &mut [u8],
    ) -> Result<Vec<Identified, K>, MatchError> {
        let spec = self.spec();
        if *query.spec() != spec {
            return Err(MatchError::Canonical);
        }
        let bytes = first("bytes", identify_bytes_needed(&spec), bytes)?;
        Ok(self.best_first::<K, WAITING>(query, kernels, bytes))
    }

    pub(super) fn best_first<const K: usize, const ROOM: usize>(
        &self,
        query: &Query<'_>,
        kernels: &Kernels,
        bytes: &mut [u8],
    ) -> Vec<Identified, K> {
        let (ours, leaf) = bytes.split_at_mut(2 * longest_sketch(&self.spec()));
        let tree = &self.tree;
        let (straight, rotated) = ours.split_at_mut(ours.len() / 2);
        let sides = [(false, straight), (true, rotated)].map(|(reversed, bytes)| {
            let blocks = &mut bytes[..tree.stride()];
            let base = query.gather(tree.places(), tree.common, reversed, kernels, blocks);
            DirectionBlocks { base, blocks }
        });
        let mut best_first = BestFirst {
            catalogue: self,
            query,
            kernels,
            leaf,
            sides,
            found: BestOfLibraries::new(),
        };
        best_first.run::<ROOM>();
        best_first.found.list
    }
}

/// A node that may hold something better, and its bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct OpenNode {
    bound: u32,
    reversed: bool,
    node: Node,
}

/// The silhouette's blocks at the tree's places.
#[derive(Clone, Copy, Debug)]
struct DirectionBlocks<'h> {
    /// Difference of the common blocks.
    base: u32,
    /// Set pixels.
    blocks: &'h [u8],
}

/// Most nodes that wait for their turn; where there would be more, one is searched depth first at once.
const WAITING: usize = 256;

/// Levels of a tree at most: its leaves are counted in 32 bits.
const LEVELS: usize = 33;

/// One best-first search of the tree.
struct BestFirst<'h, const K: usize> {
    catalogue: &'h Catalogue<'h>,
    query: &'h Query<'h>,
    kernels: &'h Kernels,
    leaf: &'h mut [u8],
    /// Straight, and reversed.
    sides: [DirectionBlocks<'h>; 2],
    found: BestOfLibraries<K>,
}

impl<const K: usize> BestFirst<'_, K> {
    /// The nearest node first: none is opened whose bound exceeds the last answer.
    fn run<const ROOM: usize>(&mut self) {
        let mut waiting: BinaryHeap<OpenNode, Min, ROOM> = BinaryHeap::new();
        for reversed in [false, true] {
            let root = self.open(self.catalogue.tree.root(), reversed);
            if waiting.push(root).is_err() {
                self.look_through(root);
            }
        }
        while let Some(next) = waiting.pop() {
            if next.bound > self.found.limit() {
                return;
            }
            for child in self.children(next) {
                if child.bound <= self.found.limit() && waiting.push(child).is_err() {
                    self.look_through(child);
                }
            }
        }
    }

    /// Depth first, which needs two places a level.
    fn look_through(&mut self, open: OpenNode) {
        let mut waiting: Vec<OpenNode, { 2 * LEVELS }> = Vec::new();
        let _ = waiting.push(open);
        while let Some(next) = waiting.pop() {
            if next.bound <= self.found.limit() {
                let _ = waiting.extend_from_slice(&self.children(next));
            }
        }
    }

    fn open(&self, node: Node, reversed: bool) -> OpenNode {
        let side = &self.sides[usize::from(reversed)];
        OpenNode {
            bound: side.base
                + (self.kernels.gap)([side.blocks; 2], self.catalogue.tree.bounds(&node)),
            node,
            reversed,
        }
    }

    /// The children of a node, the nearer last; none of a leaf, whose views are compared instead.
    fn children(&mut self, open: OpenNode) -> Vec<OpenNode, 2> {
        let mut children = Vec::new();
        if open.node.is_leaf() {
            self.look_at(open.node.first, open.reversed);
            return children;
        }
        let both = open.node.children();
        let [a, b] = both.map(|child| self.open(child, open.reversed));
        let _ = children.extend_from_slice(&if a.bound < b.bound { [b, a] } else { [a, b] });
        children
    }

    /// Compares the views of a patch whose bounds allow it.
    fn look_at(&mut self, leaf: usize, reversed: bool) {
        let Some(&leaf) = self.catalogue.tree.leaves.get(leaf) else {
            return;
        };
        let number = leaf.library as usize;
        let Some(library) = self.catalogue.libraries.get(number) else {
            return;
        };
        let Some(sketches) = library.sketches() else {
            return;
        };
        let stride = sketches.stride();
        let ours = &mut self.leaf[..sketches.compared()];
        let base = self
            .query
            .sketch_for(&sketches, reversed, self.kernels, ours);
        for row in leaf.rows(&library.info().grid) {
            let mut bounds = [0; PATCH];
            let bounds = &mut bounds[..row.len()];
            let views = sketches.of_row(&row);
            bound(ours, views, stride, base, self.kernels, bounds);
            for (view, &bound) in row.zip(&*bounds) {
                if bound > self.found.limit() {
                    continue;
                }
                let unmatched = self.query.unmatched(library, view, reversed, self.kernels);
                self.found.offer(Identified {
                    library: number,
                    best: ViewMatch {
                        view,
                        reversed,
                        unmatched,
                    },
                });
            }
        }
    }
}

/// The best view of each of the `K` best libraries so far, best first.
struct BestOfLibraries<const K: usize> {
    list: Vec<Identified, K>,
}

impl<const K: usize> BestOfLibraries<K> {
    fn new() -> Self {
        Self { list: Vec::new() }
    }

    /// What has more unmatched pixels than this changes nothing.
    fn limit(&self) -> u32 {
        match self.list.last() {
            Some(last) if self.list.is_full() => last.best.unmatched,
            None if K == 0 => 0,
            _ => u32::MAX,
        }
    }

    fn offer(&mut self, new: Identified) {
        let key = |one: &Identified| {
            let best = &one.best;
            (best.unmatched, one.library, best.reversed, best.view)
        };
        let own = self.list.iter().position(|one| one.library == new.library);
        if let Some(own) = own {
            if key(&self.list[own]) <= key(&new) {
                return;
            }
            self.list.remove(own);
        }
        keep(&mut self.list, new, key);
    }
}

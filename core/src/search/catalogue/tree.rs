//! The tree of a catalogue: nodes of patches, with what bounds their scores.

use core::ops::Range;

use crate::library::sketch::STRIDE;
use crate::library::{Library, ViewGrid};

/// Views of a patch along each axis of the grid.
pub(super) const PATCH: usize = 3;

/// Libraries with a tree over them.
#[derive(Clone, Copy, Debug)]
pub struct Catalogue<'c> {
    pub(super) libraries: &'c [Library<'c>],
    pub(super) tree: Tree<'c>,
}

/// A balanced tree: node 0 has all leaves, the nearer child follows its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tree<'c> {
    pub(super) leaves: &'c [Leaf],
    /// Least, then most, of each node.
    pub(super) boxes: &'c [u8],
    /// Numbers of the blocks that differ within the catalogue.
    pub(super) places: &'c [u16],
    /// Of the others.
    pub(super) common: &'c [u8],
}

/// A node by its number and its leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Node {
    pub(super) number: usize,
    pub(super) first: usize,
    pub(super) end: usize,
}

impl Node {
    pub(super) fn is_leaf(&self) -> bool {
        self.end - self.first <= 1
    }

    pub(super) fn children(&self) -> [Self; 2] {
        let middle = self.first + (self.end - self.first) / 2;
        // A tree of n leaves has 2 n - 1 nodes.
        let second = self.number + 2 * (middle - self.first);
        [
            Self {
                number: self.number + 1,
                end: middle,
                ..*self
            },
            Self {
                number: second,
                first: middle,
                ..*self
            },
        ]
    }
}

impl<'c> Tree<'c> {
    pub(super) fn stride(&self) -> usize {
        self.places.len().next_multiple_of(STRIDE)
    }

    pub(super) fn places(&self) -> impl Iterator<Item = usize> + Clone + use<'c> {
        self.places.iter().map(|&place| usize::from(place))
    }

    pub(super) fn root(&self) -> Node {
        Node {
            number: 0,
            first: 0,
            end: self.leaves.len(),
        }
    }

    pub(super) fn bounds(&self, node: &Node) -> [&'c [u8]; 2] {
        let stride = self.stride();
        let start = 2 * stride * node.number;
        let both = self.boxes.get(start..start + 2 * stride);
        both.unwrap_or_default()
            .split_at_checked(stride)
            .map_or([&[], &[]], |(low, high)| [low, high])
    }
}

/// A patch of neighbouring views of one library.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Leaf {
    pub(super) library: u32,
    /// The view at the corner with the smallest rotations.
    pub(super) corner: u32,
    /// Where its middle view's blocks stand while the tree is built.
    pub(super) centre: u32,
}

impl Leaf {
    /// The views of the patch, row by row: at most [`PATCH`] that follow one another.
    pub(super) fn rows(&self, grid: &ViewGrid) -> impl Iterator<Item = Range<usize>> + use<> {
        let grid = *grid;
        let (x, y) = grid.place(self.corner as usize);
        let count = PATCH.min(grid.x.count - x);
        let rows = y..(y + PATCH).min(grid.y.count);
        rows.map(move |y| grid.view(x, y)..grid.view(x, y) + count)
    }

    pub(super) fn middle(&self, grid: &ViewGrid) -> usize {
        let (x, y) = grid.place(self.corner as usize);
        let within = |first: usize, count: usize| (first + PATCH / 2).min(count - 1);
        grid.view(within(x, grid.x.count), within(y, grid.y.count))
    }
}

/// The corners of a library's patches.
pub(super) fn corners(grid: &ViewGrid) -> impl Iterator<Item = usize> + use<> {
    let grid = *grid;
    let rows = (0..grid.y.count).step_by(PATCH);
    rows.flat_map(move |y| {
        (0..grid.x.count)
            .step_by(PATCH)
            .map(move |x| grid.view(x, y))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers nodes as they are come to, the nearer child and all of its own first.
    fn check(node: &Node, next: &mut usize, leaves: &mut usize) {
        assert_eq!(node.number, *next);
        *next += 1;
        if node.is_leaf() {
            assert_eq!((node.first, node.end), (*leaves, *leaves + 1));
            *leaves += 1;
            return;
        }
        let [a, b] = node.children();
        assert_eq!((a.first, a.end, b.end), (node.first, b.first, node.end));
        let [one, other] = [a, b].map(|child| child.end - child.first);
        assert!(one > 0 && other > 0 && one.abs_diff(other) <= 1);
        check(&a, next, leaves);
        check(&b, next, leaves);
    }

    #[test]
    fn nodes_are_numbered_in_the_order_in_which_they_are_come_to() {
        for count in 1..40 {
            let all = std::vec![Leaf::default(); count];
            let tree = Tree {
                leaves: &all,
                boxes: &[],
                places: &[],
                common: &[],
            };
            let (mut next, mut leaves) = (0, 0);
            check(&tree.root(), &mut next, &mut leaves);
            assert_eq!((next, leaves), (2 * count - 1, count));
        }
    }

    #[test]
    fn each_view_of_a_grid_lies_in_one_patch_about_its_middle() {
        let axis = |count| crate::library::ViewAxis {
            first: 0.0,
            step: 1.0,
            count,
        };
        for (columns, rows) in (1..8).flat_map(|columns| (1..8).map(move |rows| (columns, rows))) {
            let grid = ViewGrid {
                x: axis(columns),
                y: axis(rows),
            };
            let mut seen = std::vec![0; grid.views()];
            for corner in corners(&grid) {
                let leaf = Leaf {
                    corner: corner as u32,
                    ..Leaf::default()
                };
                let (x, y) = grid.place(leaf.middle(&grid));
                for view in leaf.rows(&grid).flatten() {
                    seen[view] += 1;
                    let (own_x, own_y) = grid.place(view);
                    assert!(own_x.abs_diff(x) <= 1 && own_y.abs_diff(y) <= 1);
                }
            }
            assert!(seen.into_iter().all(|times| times == 1));
        }
    }
}

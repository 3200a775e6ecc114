//! Building the tree over a catalogue's libraries.

use super::error::CatalogueError;
use super::tree::{Catalogue, Leaf, Node, Tree, corners};
use crate::canonical::CanonicalSpec;
use crate::library::Library;
use crate::library::sketch::{STRIDE, blocks};
use crate::memory::check_length;
use crate::search::kernels::gap;

/// Lengths of the memory of a [`Catalogue`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CatalogueNeeds {
    /// Of [`CatalogueMemory::leaves`].
    pub leaves: usize,
    /// Of [`CatalogueMemory::boxes`], bytes.
    pub boxes: usize,
    /// Of [`CatalogueMemory::places`].
    pub places: usize,
    /// Of [`CatalogueMemory::scratch`], bytes.
    pub scratch: usize,
}

/// Memory of a [`Catalogue`].
#[derive(Debug)]
pub struct CatalogueMemory<'c> {
    /// Patches.
    pub leaves: &'c mut [Leaf],
    /// What the tree's nodes have in common.
    pub boxes: &'c mut [u8],
    /// Numbers of blocks.
    pub places: &'c mut [u16],
    /// Used only while the tree is built.
    pub scratch: &'c mut [u8],
}

/// Lengths of the memory that a catalogue of these libraries borrows.
#[must_use]
pub fn catalogue_needed(libraries: &[Library<'_>]) -> CatalogueNeeds {
    let leaves = libraries
        .iter()
        .map(|library| corners(&library.info().grid).count())
        .sum();
    let first = libraries.first().map(|library| library.info().canonical);
    let blocks = first.map_or(0, |spec| blocks(&spec));
    let node = 2 * blocks.next_multiple_of(STRIDE);
    CatalogueNeeds {
        leaves,
        // The common blocks, and a box for each node.
        boxes: blocks + (2 * leaves).saturating_sub(1) * node,
        places: blocks,
        scratch: (leaves + 2) * blocks,
    }
}

impl<'c> Catalogue<'c> {
    /// Puts a tree over libraries of one canonical frame.
    ///
    /// # Errors
    /// [`CatalogueError`] for libraries that do not go together and for memory of a wrong length
    /// ([`catalogue_needed`]).
    pub fn new(
        libraries: &'c [Library<'c>],
        memory: CatalogueMemory<'c>,
    ) -> Result<Self, CatalogueError> {
        let spec = one_frame(libraries)?;
        let needs = catalogue_needed(libraries);
        let lengths = [
            ("leaves", needs.leaves, memory.leaves.len()),
            ("bytes of boxes", needs.boxes, memory.boxes.len()),
            ("places", needs.places, memory.places.len()),
            ("bytes of scratch", needs.scratch, memory.scratch.len()),
        ];
        for (what, needed, given) in lengths {
            check_length(what, needed, given)?;
        }
        let leaves = &mut memory.leaves[..needs.leaves];
        let scratch = &mut memory.scratch[..needs.scratch];
        let (extremes, centres) = scratch.split_at_mut(2 * blocks(&spec));
        let (common, boxes) = memory.boxes[..needs.boxes].split_at_mut(blocks(&spec));
        let varying = find_common(libraries, extremes, common, memory.places);
        let places = &memory.places[..varying];
        plant(libraries, leaves);
        let (view, _) = extremes.split_at_mut(blocks(&spec));
        let mut builder = Builder {
            libraries,
            places,
            boxes,
            centres,
            view,
        };
        builder.write_centres(leaves);
        let root = Node {
            number: 0,
            first: 0,
            end: leaves.len(),
        };
        builder.grow(&root, leaves);
        Ok(Self {
            libraries,
            tree: Tree {
                leaves,
                boxes: builder.boxes,
                places,
                common,
            },
        })
    }
}

/// The canonical frame of all of them.
fn one_frame(libraries: &[Library<'_>]) -> Result<CanonicalSpec, CatalogueError> {
    let first = libraries.first().ok_or(CatalogueError::Empty)?;
    let spec = first.info().canonical;
    for (number, library) in libraries.iter().enumerate() {
        if library.info().canonical != spec {
            return Err(CatalogueError::Canonical(number));
        }
        if library.sketches().is_none() {
            return Err(CatalogueError::Plain(number));
        }
    }
    Ok(spec)
}

/// Finds the blocks that are the same in all views of all libraries, writes their set pixels to `common` and the numbers of
/// the other blocks to `places`, and returns the number of the latter.
fn find_common(
    libraries: &[Library<'_>],
    extremes: &mut [u8],
    common: &mut [u8],
    places: &mut [u16],
) -> usize {
    let (low, high) = extremes.split_at_mut(common.len());
    low.fill(u8::MAX);
    high.fill(0);
    for sketches in libraries.iter().filter_map(|library| library.sketches()) {
        let mut own = sketches.places().enumerate().peekable();
        for (block, &alike) in sketches.common.iter().enumerate() {
            let column = own.next_if(|&(_, place)| place == block);
            let (least, most) = match column {
                Some((column, _)) => {
                    let views = sketches.all.chunks_exact(sketches.stride());
                    let counts = views.filter_map(|sketch| sketch.get(column));
                    counts.fold((u8::MAX, 0), |(least, most), &count| {
                        (least.min(count), most.max(count))
                    })
                }
                None => (alike, alike),
            };
            low[block] = low[block].min(least);
            high[block] = high[block].max(most);
        }
    }
    let mut varying = 0;
    for (block, common) in common.iter_mut().enumerate() {
        let same = low[block] == high[block];
        *common = if same { low[block] } else { 0 };
        if !same {
            places[varying] = block as u16;
            varying += 1;
        }
    }
    varying
}

fn plant(libraries: &[Library<'_>], leaves: &mut [Leaf]) {
    let all = libraries.iter().enumerate().flat_map(|(number, library)| {
        corners(&library.info().grid).map(move |corner| (number, corner))
    });
    for (centre, (leaf, (library, corner))) in leaves.iter_mut().zip(all).enumerate() {
        *leaf = Leaf {
            library: library as u32,
            corner: corner as u32,
            centre: centre as u32,
        };
    }
}

struct Builder<'b, 'c> {
    libraries: &'b [Library<'b>],
    places: &'b [u16],
    boxes: &'c mut [u8],
    /// Blocks of each patch's middle view, at the catalogue's places.
    centres: &'b mut [u8],
    /// Blocks of one view.
    view: &'b mut [u8],
}

impl Builder<'_, '_> {
    fn stride(&self) -> usize {
        self.places.len().next_multiple_of(STRIDE)
    }

    /// All blocks of a view of a library.
    fn read_view(&mut self, library: &Library<'_>, view: usize) {
        let Some(sketches) = library.sketches() else {
            return;
        };
        self.view.copy_from_slice(sketches.common);
        for (place, &count) in sketches.places().zip(sketches.of(view)) {
            self.view[place] = count;
        }
    }

    fn write_centres(&mut self, leaves: &[Leaf]) {
        let length = self.places.len();
        for (number, leaf) in leaves.iter().enumerate() {
            let library = self.libraries[leaf.library as usize];
            self.read_view(&library, leaf.middle(&library.info().grid));
            let centre = self.centres.get_mut(number * length..(number + 1) * length);
            for (to, &place) in centre.unwrap_or_default().iter_mut().zip(self.places) {
                *to = self.view[usize::from(place)];
            }
        }
    }

    fn centre(&self, leaf: &Leaf) -> &[u8] {
        let length = self.places.len();
        let start = leaf.centre as usize * length;
        self.centres.get(start..start + length).unwrap_or_default()
    }

    /// Parts the leaves of a node, and so on, and writes the boxes of all of them. They are parted halfway along the
    /// line between two that are far apart, so what is alike stays together in all its blocks; parted by the one
    /// block in which they spread most, nodes stayed wide in all others, and a search of 500 implants took ten times
    /// as long. The tree is balanced: it is as deep as the binary logarithm of its leaves.
    fn grow(&mut self, node: &Node, leaves: &mut [Leaf]) {
        if node.is_leaf() {
            if let Some(leaf) = leaves.get(node.first) {
                self.write_leaf(node, leaf);
            }
            return;
        }
        let children = node.children();
        let range = &mut leaves[node.first..node.end];
        let ends = self.far_apart(range).map(|leaf| self.centre(&leaf));
        let half = children[0].end - node.first;
        range
            .select_nth_unstable_by_key(half, |leaf| (along(ends, self.centre(leaf)), leaf.centre));
        for child in &children {
            self.grow(child, leaves);
        }
        self.unite(node, &children);
    }

    /// Two leaves far apart: the farthest from the first, and the farthest from that.
    fn far_apart(&self, leaves: &[Leaf]) -> [Leaf; 2] {
        let farthest = |from: &Leaf| {
            let from = self.centre(from);
            let distance = |leaf: &Leaf| gap([from; 2], [self.centre(leaf); 2]);
            let far = leaves.iter().copied().max_by_key(distance);
            far.unwrap_or_default()
        };
        let first = leaves.first().copied().unwrap_or_default();
        let one = farthest(&first);
        [one, farthest(&one)]
    }

    fn write_leaf(&mut self, node: &Node, leaf: &Leaf) {
        let stride = self.stride();
        let start = 2 * stride * node.number;
        self.boxes[start..start + 2 * stride].fill(0);
        self.boxes[start..start + self.places.len()].fill(u8::MAX);
        let library = self.libraries[leaf.library as usize];
        for view in leaf.rows(&library.info().grid).flatten() {
            self.read_view(&library, view);
            let (low, high) = self.boxes[start..start + 2 * stride].split_at_mut(stride);
            for ((low, high), &place) in low.iter_mut().zip(high).zip(self.places) {
                let count = self.view[usize::from(place)];
                (*low, *high) = ((*low).min(count), (*high).max(count));
            }
        }
    }

    fn unite(&mut self, node: &Node, children: &[Node; 2]) {
        let stride = self.stride();
        let [to, a, b] = [node.number, children[0].number, children[1].number];
        for column in 0..stride {
            let at = |number: usize, half: usize| (2 * number + half) * stride + column;
            self.boxes[at(to, 0)] = self.boxes[at(a, 0)].min(self.boxes[at(b, 0)]);
            self.boxes[at(to, 1)] = self.boxes[at(a, 1)].max(self.boxes[at(b, 1)]);
        }
    }
}

/// How far something is along the line from one end to the other, in no unit: 4096 blocks at most, each up to 255.
fn along([from, to]: [&[u8]; 2], what: &[u8]) -> i32 {
    let steps = from.iter().zip(to).zip(what);
    let steps =
        steps.map(|((&from, &to), &what)| i32::from(what) * (i32::from(to) - i32::from(from)));
    steps.sum()
}

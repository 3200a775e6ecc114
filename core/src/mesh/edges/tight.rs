//! Edges between two triangles as a stream of bytes, two thirds of what [`PackedEdge`]s and their boxes take: groups of
//! sixteen, which are read one after another.
//!
//! Edges of one group lie near each other, so they have few vertices, whose numbers lie near each other. A group, in this order:
//!
//! - its box: ten numbers of which each is the upper half of one of 32 bits (`boxes.rs`);
//! - the bytes of all that follows these two, and the number of its vertices (u8 each);
//! - its edges: from, to and the third vertices of the triangles that run it forth and back, each by its place in the list below, in
//!   as few bits as hold these places, four at least, from the lowest bit of a byte on: two edges are whole bytes, and where there is
//!   no second one zeros stand for it;
//! - its vertices, rising: by how much each is more than the one before it, the first more than -1: a byte, or a zero and then two.

use super::boxes::{Halves, IN_BOX};
use super::edge::PackedEdge;

/// Vertices of the edges in one box at most, and at least.
pub(super) const MOST_VERTICES: usize = 4 * IN_BOX;
const FEWEST_VERTICES: usize = 3;

/// Bits by which one of so many vertices is told: as many bytes take two edges.
pub(super) const fn bits_for(vertices: usize) -> usize {
    // Of more vertices than can be there are no more bits.
    let highest = vertices.saturating_sub(1) % MOST_VERTICES;
    (usize::BITS - (highest | 1 << 3).leading_zeros()) as usize
}

/// The bits of the first place of an edge.
const fn mask(bits: usize) -> u32 {
    (1 << bits) - 1
}

/// Whether none of four steps is written as a zero and two bytes (Warren, *Hacker's Delight*, 6-1).
#[inline(always)]
fn are_bytes(steps: &[u8; 4]) -> bool {
    let word = u32::from_le_bytes(*steps);
    word.wrapping_sub(0x0101_0101) & !word & 0x8080_8080 == 0
}

/// Reads vertices one by one from the steps between them; zeros follow the last. Gives the steps that are left, and the last vertex: what is
/// read and written behind references stands in memory.
fn read_each<'e>(mut rest: &'e [u8], mut before: u16, out: &mut [u16]) -> (&'e [u8], u16) {
    for vertex in out {
        let mut step = next_byte(&mut rest);
        if step == 0 {
            step = next_byte(&mut rest) | next_byte(&mut rest) << 8;
        }
        before = before.wrapping_add(step);
        *vertex = before;
    }
    (rest, before)
}

#[inline(always)]
fn next_byte(rest: &mut &[u8]) -> u16 {
    match rest.split_first() {
        Some((&first, behind)) => {
            *rest = behind;
            first.into()
        }
        None => 0,
    }
}

/// Groups of edges, which are found one after another.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TightGroups<'e> {
    bytes: &'e [u8],
    /// How many there are, and how many edges they have together.
    boxes: usize,
    edges: usize,
}

/// The edges in a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct TightGroup<'e> {
    /// Edges, then vertices.
    bytes: &'e [u8],
    vertices: usize,
    edges: usize,
}

/// Where a group's vertices and edges are written.
pub(super) struct GroupRoom {
    vertices: [u16; MOST_VERTICES],
    edges: [EdgePlaces; IN_BOX],
}

/// An edge as places of its vertices in a list: from, to, and the third ones of the triangles that run it forth and back, from the lowest
/// bit on.
pub(crate) type EdgePlaces = u32;

/// The edges in a box, by their own list of vertices.
pub(crate) struct Group<'r> {
    vertices: &'r [u16; MOST_VERTICES],
    edges: &'r [EdgePlaces],
    /// Of a place.
    bits: usize,
    mask: u32,
}

/// Bits of a place where there are as many vertices as can be; the first four places, and four more of each.
const MOST_BITS: usize = bits_for(MOST_VERTICES);
const FIRST_FOUR: EdgePlaces = 1 << MOST_BITS | 2 << (2 * MOST_BITS) | 3 << (3 * MOST_BITS);
const FOUR_ON: EdgePlaces = 4 * (1 | 1 << MOST_BITS | 1 << (2 * MOST_BITS) | 1 << (3 * MOST_BITS));

impl GroupRoom {
    pub(super) const EMPTY: Self = Self {
        vertices: [0; MOST_VERTICES],
        edges: [0; IN_BOX],
    };

    /// Edges that have no list of vertices: each has places of its own.
    pub(super) fn listed(&mut self, edges: &[PackedEdge]) -> Group<'_> {
        let places = self.vertices.as_chunks_mut().0.iter_mut().zip(edges);
        for (number, ((vertices, edge), places)) in (0..).zip(places.zip(&mut self.edges)) {
            *vertices = *edge;
            *places = FIRST_FOUR + number * FOUR_ON;
        }
        let count = edges.len().min(IN_BOX);
        Group {
            vertices: &self.vertices,
            edges: self.edges.get(..count).unwrap_or_default(),
            bits: MOST_BITS,
            mask: mask(MOST_BITS),
        }
    }
}

impl Group<'_> {
    pub(crate) fn edges(&self) -> &[EdgePlaces] {
        self.edges
    }

    /// An edge by its vertices.
    #[inline(always)]
    pub(crate) fn edge(&self, edge: EdgePlaces) -> PackedEdge {
        let bits = self.bits;
        let vertex = |places: u32| self.vertices[(places & self.mask) as usize % MOST_VERTICES];
        // One after the other: of an iterator some compilers leave a loop. By one bit number, not by its multiples.
        let second = edge >> bits;
        let third = second >> bits;
        [
            vertex(edge),
            vertex(second),
            vertex(third),
            vertex(third >> bits),
        ]
    }
}

impl<'e> TightGroups<'e> {
    pub(super) fn new(bytes: &'e [u8], boxes: usize, edges: usize) -> Self {
        Self {
            bytes,
            boxes,
            edges,
        }
    }

    /// How many edges are left.
    pub(super) fn edges(&self) -> usize {
        self.edges
    }

    /// Whether they are that, of a surface of so many vertices, and nothing is behind them.
    pub(super) fn fit(mut self, vertices: usize) -> bool {
        let mut groups = 0;
        let all_fit = self.all(|(_, group)| {
            groups += 1;
            group.fits(vertices)
        });
        all_fit && groups == self.boxes && self.edges == 0 && self.bytes.is_empty()
    }
}

impl<'e> Iterator for TightGroups<'e> {
    type Item = (&'e Halves, TightGroup<'e>);

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        let (halves, rest) = self.bytes.split_first_chunk::<{ size_of::<Halves>() }>()?;
        let (&[length, vertices], rest) = rest.split_first_chunk()?;
        let (bytes, rest) = rest.split_at_checked(length.into())?;
        let edges = self.edges.min(IN_BOX);
        self.edges -= edges;
        self.bytes = rest;
        let group = TightGroup {
            bytes,
            vertices: vertices.into(),
            edges,
        };
        Some((bytemuck::cast_ref(halves), group))
    }
}

impl TightGroup<'_> {
    /// Bits of a vertex's place, and the bytes of all edges.
    fn widths(&self) -> (usize, usize) {
        let bits = bits_for(self.vertices);
        (bits, self.edges.div_ceil(2) * bits)
    }

    /// Its vertices, rising; gives whether no bytes follow them.
    fn read_vertices(&self, out: &mut [u16; MOST_VERTICES]) -> bool {
        let mut rest = self.bytes.get(self.widths().1..).unwrap_or_default();
        let mut before = u16::MAX;
        let (fours, others) = out
            .get_mut(..self.vertices)
            .unwrap_or_default()
            .as_chunks_mut();
        for four in fours {
            match rest.split_first_chunk() {
                Some((steps, behind)) if are_bytes(steps) => {
                    let first = before.wrapping_add(steps[0].into());
                    let second = first.wrapping_add(steps[1].into());
                    let third = second.wrapping_add(steps[2].into());
                    before = third.wrapping_add(steps[3].into());
                    *four = [first, second, third, before];
                    rest = behind;
                }
                _ => (rest, before) = read_each(rest, before, four),
            }
        }
        (rest, _) = read_each(rest, before, others);
        rest.is_empty()
    }

    /// The edges, written into `room`.
    pub(super) fn unpacked<'r>(&self, room: &'r mut GroupRoom) -> Group<'r> {
        let GroupRoom { vertices, edges } = room;
        self.read_vertices(vertices);
        let (bits, _) = self.widths();
        let mut rest = self.bytes;
        for pair in edges.as_chunks_mut::<2>().0 {
            // The second edge ends where its bytes do.
            let last = rest.get(bits.saturating_sub(4)..).unwrap_or_default();
            let (Some(&first), Some(&last)) = (rest.first_chunk(), last.first_chunk()) else {
                break;
            };
            let second = u32::from_le_bytes(last) >> (32 - 4 * bits);
            *pair = [u32::from_le_bytes(first), second];
            rest = rest.get(bits..).unwrap_or_default();
        }
        Group {
            vertices,
            edges: edges.get(..self.edges).unwrap_or_default(),
            bits,
            mask: mask(bits),
        }
    }

    /// Whether it has no more bytes than it should, vertices of a surface of so many, and edges of these.
    fn fits(&self, of_surface: usize) -> bool {
        if !(FEWEST_VERTICES..=MOST_VERTICES).contains(&self.vertices) || self.edges == 0 {
            return false;
        }
        let mut vertices = [0; MOST_VERTICES];
        let is_whole = self.read_vertices(&mut vertices);
        let vertices = vertices.get(..self.vertices).unwrap_or_default();
        let rise = vertices.is_sorted_by(|a, b| a < b);
        let known = vertices
            .last()
            .is_some_and(|&last| usize::from(last) < of_surface);
        // A list that was cut ends in vertices that do not rise, or is whole with zeros behind it.
        is_whole && rise && known && self.places_fit()
    }

    /// Whether every edge is of vertices in the list.
    fn places_fit(&self) -> bool {
        let (bits, bytes) = self.widths();
        let (mut all, mut have) = (0u32, 0);
        let mut highest = 0;
        for &byte in self.bytes.get(..bytes).unwrap_or_default() {
            all |= u32::from(byte) << have;
            have += 8;
            while have >= bits {
                highest = highest.max(all & ((1 << bits) - 1));
                (all, have) = (all >> bits, have - bits);
            }
        }
        (highest as usize) < self.vertices
    }
}

#[cfg(test)]
mod tests {
    use super::super::tighten::tightened;
    use super::*;
    use proptest::prelude::*;
    use std::vec::Vec;

    properties! {
        #[test]
        fn four_steps_are_bytes_where_none_of_them_is_zero(
            steps in proptest::array::uniform4(prop_oneof![0..3u8, 126..130u8, 254..=255u8, any::<u8>()])
        ) {
            prop_assert_eq!(are_bytes(&steps), !steps.contains(&0));
        }
    }

    /// Whether bytes are so many edges of a surface, read as the description at the top says, bit by bit.
    fn read(
        mut bytes: &[u8],
        boxes: usize,
        mut edges: usize,
        of_surface: usize,
    ) -> Option<Vec<PackedEdge>> {
        let mut all = Vec::new();
        for _ in 0..boxes {
            let (head, rest) = bytes.split_at_checked(22)?;
            let (group, rest) = rest.split_at_checked(head[20].into())?;
            bytes = rest;
            let (count, here) = (usize::from(head[21]), edges.min(16));
            edges -= here;
            let bits = (4..7).find(|bits| 1 << bits >= count)?;
            let (places, steps) = group.split_at_checked(here.div_ceil(2) * bits)?;
            let mut steps = steps.iter().map(|&step| i32::from(step));
            let mut vertices = Vec::new();
            let mut before = -1;
            for _ in 0..count {
                // Of a list that was cut zeros are read.
                let mut next = || steps.next().unwrap_or(0);
                before += match next() {
                    0 => next() + 256 * next(),
                    step => step,
                };
                vertices.push(before);
            }
            let rise =
                vertices.windows(2).all(|two| two[0] < two[1]) && vertices.first() >= Some(&0);
            if here == 0
                || count < 3
                || !rise
                || before >= of_surface as i32
                || steps.next().is_some()
            {
                return None;
            }
            let bit = |at: usize| usize::from(places[at / 8] >> (at % 8) & 1);
            let place = |number: usize| {
                (0..bits)
                    .map(|k| bit(number * bits + k) << k)
                    .sum::<usize>()
            };
            let found: Option<Vec<u16>> = (0..8 * here.div_ceil(2))
                .map(|number| Some(*vertices.get(place(number))? as u16))
                .collect();
            all.extend(found?.as_chunks::<4>().0.iter().take(here));
        }
        (edges == 0 && bytes.is_empty()).then_some(all)
    }

    properties! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// Edges with a byte or two changed, of which some are edges still.
        #[test]
        fn what_fits_is_what_is_read_bit_by_bit(
            edges in proptest::collection::vec(proptest::array::uniform4(prop_oneof![0u16..20, 0u16..40, 0u16..700]), 1..36),
            changes in proptest::collection::vec((any::<proptest::sample::Index>(), prop_oneof![0u8..4, any::<u8>()]), 0..3),
            cut in prop_oneof![Just(0usize), 0..4usize],
            behind in prop_oneof![Just(0usize), 20..25usize],
        ) {
            let boxes = edges.len().div_ceil(IN_BOX);
            let mut bytes = tightened(&std::vec![[1.0; 10]; boxes], &edges);
            bytes.truncate(bytes.len() - cut);
            // As many zeros as the head of a group without edges, or about so.
            bytes.resize(bytes.len() + behind, 0);
            for (at, byte) in &changes {
                let at = at.index(bytes.len());
                bytes[at] = *byte;
            }
            for of_surface in [40, 600, 1 << 16] {
                let expected = read(&bytes, boxes, edges.len(), of_surface);
                let groups = TightGroups::new(&bytes, boxes, edges.len());
                prop_assert_eq!(groups.fit(of_surface), expected.is_some());
                if let Some(expected) = expected {
                    let mut room = GroupRoom::EMPTY;
                    let mut found = Vec::new();
                    for (_, group) in groups {
                        let group = group.unpacked(&mut room);
                        found.extend(group.edges().iter().map(|&edge| group.edge(edge)));
                    }
                    prop_assert_eq!(found, expected);
                }
            }
        }
    }

    #[test]
    fn so_many_vertices_take_no_more_bits_than_their_last_place() {
        for vertices in 1..=MOST_VERTICES {
            let bits = bits_for(vertices);
            let places = 1 << bits;
            assert!(places >= vertices && (bits == 4 || places / 2 < vertices));
            assert_eq!(mask(bits), places as u32 - 1);
        }
    }
}

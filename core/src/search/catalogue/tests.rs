//! The catalogue against searching every library.

use super::*;
use crate::canonical::CanonicalSpec;
use crate::canonical::reverse;
use crate::image::mask::Word;
use crate::library::Library;
use crate::library::fake::{compact_library, plain_library, spots};
use crate::search::exhaustive::score;
use crate::search::kernels::Kernels;
use crate::search::query::{Query, query_bytes_needed};
use crate::search::scores::scores_needed;
use proptest::prelude::*;

const SIZE: usize = 64;
type Bits = std::vec::Vec<Word>;

fn spec() -> CanonicalSpec {
    CanonicalSpec::new(SIZE, 900).expect("possible")
}

/// Libraries of different grids with views that are like one another, and a silhouette like them.
fn cases() -> impl Strategy<Value = (std::vec::Vec<std::vec::Vec<u8>>, Bits)> {
    let words = SIZE * SIZE / 32;
    let kinds = proptest::collection::vec(spots(SIZE), 5);
    let pick = (0..5usize, 0..words, prop_oneof![Just(0), any::<Word>()]);
    let grids = proptest::collection::vec((1..9usize, 1..9usize), 1..6);
    (kinds, grids, proptest::collection::vec(pick, 1..40)).prop_map(|(kinds, grids, picks)| {
        let mut picks = picks.into_iter().cycle();
        let mut view = || {
            let (kind, at, change) = picks.next().expect("endless");
            let mut view: Bits = kinds[kind].clone();
            view[at] ^= change;
            view
        };
        let libraries = grids.into_iter().map(|(columns, rows)| {
            let views: std::vec::Vec<Bits> = (0..columns * rows).map(|_| view()).collect();
            compact_library(&plain_library(&views, columns, spec()))
        });
        let libraries = libraries.collect();
        (libraries, view())
    })
}

fn best_of_each(libraries: &[Library<'_>], silhouette: &[Word]) -> std::vec::Vec<Identified> {
    let mut rotated = silhouette.to_vec();
    let mut all: std::vec::Vec<Identified> = libraries
        .iter()
        .enumerate()
        .map(|(number, library)| {
            let mut scores = std::vec![0; scores_needed(library.views())];
            let scores = score(library, silhouette, &mut rotated, &mut scores).expect("lengths");
            Identified {
                library: number,
                best: scores.best::<1>()[0],
            }
        })
        .collect();
    all.sort_by_key(|one| one.best.unmatched);
    all
}

struct Memory {
    leaves: std::vec::Vec<Leaf>,
    boxes: std::vec::Vec<u8>,
    places: std::vec::Vec<u16>,
    scratch: std::vec::Vec<u8>,
}

impl Memory {
    fn for_libraries(libraries: &[Library<'_>]) -> Self {
        let needs = catalogue_needed(libraries);
        Self {
            leaves: std::vec![Leaf::default(); needs.leaves],
            boxes: std::vec![0; needs.boxes],
            places: std::vec![0; needs.places],
            scratch: std::vec![0; needs.scratch],
        }
    }

    fn borrow(&mut self) -> CatalogueMemory<'_> {
        CatalogueMemory {
            leaves: &mut self.leaves,
            boxes: &mut self.boxes,
            places: &mut self.places,
            scratch: &mut self.scratch,
        }
    }
}

properties! {
    #[test]
    fn the_catalogue_finds_what_searching_every_library_finds((files, silhouette) in cases()) {
        let libraries: std::vec::Vec<_> =
            files.iter().map(|bytes| Library::open(bytes).expect("valid")).collect();
        let mut memory = Memory::for_libraries(&libraries);
        let catalogue = Catalogue::new(&libraries, memory.borrow()).expect("they go together");
        let mut rotated = silhouette.clone();
        reverse(&silhouette, &mut rotated);
        let mut prepared = std::vec![0; query_bytes_needed(&spec())];
        let query = Query::new(&spec(), &silhouette, &rotated, &mut prepared).expect("lengths");
        let mut bytes = std::vec![0; identify_bytes_needed(&spec())];
        let wanted = best_of_each(&libraries, &silhouette);
        let kernels = Kernels::PORTABLE;
        let one = catalogue.identify::<1>(&query, &kernels, &mut bytes).expect("lengths");
        prop_assert_eq!(&one[..], &wanted[..1]);
        let three = catalogue.identify::<3>(&query, &kernels, &mut bytes).expect("lengths");
        prop_assert_eq!(&three[..], &wanted[..wanted.len().min(3)]);
        let all = catalogue.identify::<16>(&query, &kernels, &mut bytes).expect("lengths");
        prop_assert_eq!(&all[..], &wanted[..]);
        // With hardly a place for nodes that wait, most are looked through depth first.
        for crowded in [
            catalogue.best_first::<3, 1>(&query, &kernels, &mut bytes),
            catalogue.best_first::<3, 3>(&query, &kernels, &mut bytes),
        ] {
            prop_assert_eq!(&crowded[..], &wanted[..wanted.len().min(3)]);
        }
    }
}

#[test]
fn libraries_that_do_not_go_together_are_refused() {
    let view = |size: usize| std::vec![std::vec![1; size * size / 32]];
    let plain = plain_library(&view(SIZE), 1, spec());
    let compact = compact_library(&plain);
    let other = compact_library(&plain_library(
        &view(96),
        1,
        CanonicalSpec::new(96, 900).expect("possible"),
    ));
    let open = |bytes| Library::open(bytes).expect("valid");
    let error = |libraries: &[Library<'_>]| {
        let mut memory = Memory::for_libraries(libraries);
        Catalogue::new(libraries, memory.borrow()).err()
    };
    assert_eq!(error(&[]), Some(CatalogueError::Empty));
    assert_eq!(
        error(&[open(&compact), open(&plain)]),
        Some(CatalogueError::Plain(1))
    );
    assert_eq!(
        error(&[open(&compact), open(&other)]),
        Some(CatalogueError::Canonical(1))
    );
    assert_eq!(error(&[open(&compact), open(&compact)]), None);
}

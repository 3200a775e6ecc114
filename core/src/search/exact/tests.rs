//! The search against comparing every view.

use super::*;
use crate::image::mask::Word;
use crate::library::fake::{compact_library, plain_library, spots};
use crate::memory::TooLittleMemory;
use crate::search::exhaustive::score;
use crate::search::query::query_bytes_needed;
use crate::search::scores::Scores;
use proptest::prelude::*;

const SIZE: usize = 64;
const COLUMNS: usize = 5;
const VIEWS: usize = 20;
type Bits = std::vec::Vec<Word>;

fn spec() -> CanonicalSpec {
    CanonicalSpec::new(SIZE, 900).expect("possible")
}

/// Views from a few silhouettes, so that many tie, with some pixels changed here and there, and a silhouette like them.
fn cases() -> impl Strategy<Value = (std::vec::Vec<Bits>, Bits)> {
    let words = SIZE * SIZE / 32;
    let kinds = proptest::collection::vec(spots(SIZE), 4);
    let picks = proptest::collection::vec(
        (0..4usize, 0..words, prop_oneof![Just(0), any::<Word>()]),
        VIEWS + 1,
    );
    (kinds, picks).prop_map(|(kinds, picks)| {
        let mut views: std::vec::Vec<Bits> = picks
            .into_iter()
            .map(|(kind, at, change)| {
                let mut view = kinds[kind].clone();
                view[at] ^= change;
                view
            })
            .collect();
        let silhouette = views.pop().expect("one more than views");
        (views, silhouette)
    })
}

/// What comparing every view finds.
struct Oracle {
    scores: std::vec::Vec<u32>,
}

impl Oracle {
    fn new(library: &Library<'_>, silhouette: &[Word]) -> (Self, Bits) {
        let mut scores = std::vec![0; scores_needed(library.views())];
        let mut rotated = silhouette.to_vec();
        score(library, silhouette, &mut rotated, &mut scores).expect("right lengths");
        (Self { scores }, rotated)
    }

    fn surfaces(&mut self, library: &Library<'_>) -> Scores<'_> {
        let known = self.scores.clone();
        Scores::fill(library, &mut self.scores, |view, reversed| {
            known[view + if reversed { VIEWS } else { 0 }]
        })
        .expect("right lengths")
    }
}

/// Unmatched pixels of the best view, and four times what its farthest neighbour differs by, pixel by pixel.
fn farthest_rival(library: &Library<'_>, best: &ViewMatch) -> u32 {
    let drawn = |view: usize| {
        let mut words = std::vec![0; spec().words_needed()];
        library.draw(view, &mut words);
        words
    };
    let own = drawn(best.view);
    let steps = neighbours(&library.info().grid, best.view).map(|near| {
        let pairs = drawn(near).into_iter().zip(&own);
        pairs.map(|(a, b)| (a ^ b).count_ones()).sum::<u32>()
    });
    best.unmatched + 4 * steps.max().expect("more than one view")
}

fn check_search(bytes: &[u8], silhouette: &[Word]) {
    let library = Library::open(bytes).expect("valid");
    let (mut oracle, rotated) = Oracle::new(&library, silhouette);
    let mut prepared = std::vec![0; query_bytes_needed(&spec())];
    let query = Query::new(&spec(), silhouette, &rotated, &mut prepared).expect("right lengths");
    let surfaces = oracle.surfaces(&library);
    let mut bounds = [0; scores_needed(VIEWS)];
    let mut sketches = std::vec![0; search_bytes_needed(&spec())];
    let mut fresh = |answer: &mut dyn FnMut(&mut ViewSearch<'_, '_>)| {
        let memory = ViewSearchMemory {
            bounds: &mut bounds,
            sketches: &mut sketches,
        };
        let kernels = Kernels::PORTABLE;
        answer(&mut ViewSearch::new(&library, &query, &kernels, memory).expect("right lengths"));
    };
    fresh(&mut |search| {
        for view in 0..VIEWS {
            for reversed in [false, true] {
                let exact = surfaces.surface(reversed)[view];
                assert!(search.at_least(view, reversed) <= exact);
                assert_eq!(search.score(view, reversed), exact);
            }
        }
    });
    fresh(&mut |search| assert_eq!(search.best::<1>(Directions::Both), surfaces.best::<1>()));
    fresh(&mut |search| assert_eq!(search.best::<7>(Directions::Both), surfaces.best::<7>()));
    fresh(&mut |search| assert_eq!(search.best::<64>(Directions::Both), surfaces.best::<64>()));
    fresh(&mut |search| {
        let straight: Vec<_, 64> = surfaces
            .best::<64>()
            .into_iter()
            .filter(|one| !one.reversed)
            .collect();
        assert_eq!(search.best::<3>(Directions::Straight)[..], straight[..3]);
    });
    fresh(&mut |search| assert_eq!(search.minima::<1>(), surfaces.minima::<1>()));
    fresh(&mut |search| assert_eq!(search.minima::<4>(), surfaces.minima::<4>()));
    fresh(&mut |search| assert_eq!(search.minima::<64>(), surfaces.minima::<64>()));
    let most = farthest_rival(&library, &surfaces.best::<1>()[0]);
    let near = surfaces.minima::<64>().into_iter();
    let near: Vec<_, 64> = near.filter(|one| one.unmatched <= most).collect();
    fresh(&mut |search| assert_eq!(search.rivals::<64>(), near));
    fresh(&mut |search| assert_eq!(search.rivals::<2>()[..], near[..near.len().min(2)]));
    // One answer does not spoil the next.
    fresh(&mut |search| {
        search.best::<2>(Directions::Straight);
        assert_eq!(search.minima::<4>(), surfaces.minima::<4>());
        assert_eq!(search.best::<7>(Directions::Both), surfaces.best::<7>());
    });
}

properties! {
    #[test]
    fn the_search_finds_what_comparing_every_view_finds((views, silhouette) in cases()) {
        let plain = plain_library(&views, COLUMNS, spec());
        check_search(&plain, &silhouette);
        check_search(&compact_library(&plain), &silhouette);
    }

    #[test]
    fn noise_is_found_too(
        views in proptest::collection::vec(proptest::collection::vec(any::<Word>(), SIZE * SIZE / 32), VIEWS)
    ) {
        let plain = plain_library(&views, COLUMNS, spec());
        check_search(&compact_library(&plain), &views[3]);
    }
}

#[test]
fn memory_of_a_wrong_length_is_refused() {
    let silhouette = std::vec![1; SIZE * SIZE / 32];
    let plain = plain_library(&std::vec![silhouette.clone(); VIEWS], COLUMNS, spec());
    let library = Library::open(&plain).expect("valid");
    let mut prepared = std::vec![0; query_bytes_needed(&spec())];
    let short = Query::new(&spec(), &silhouette, &silhouette, &mut prepared[1..]);
    assert!(matches!(short, Err(MatchError::Memory { .. })));
    let query =
        Query::new(&spec(), &silhouette, &silhouette, &mut prepared).expect("right lengths");
    let mut sketches = std::vec![0; search_bytes_needed(&spec())];
    let memory = ViewSearchMemory {
        bounds: &mut [0; VIEWS],
        sketches: &mut sketches,
    };
    let short = ViewSearch::new(&library, &query, &Kernels::PORTABLE, memory).err();
    assert!(matches!(
        short,
        Some(MatchError::Memory(TooLittleMemory { what: "scores", .. }))
    ));
}

properties! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// What has been counted is known exactly; what has not, by its sketch to lie above what most views are compared with.
    #[test]
    fn a_bound_is_the_score_itself_where_that_has_been_counted((views, silhouette) in cases()) {
        let bytes = compact_library(&plain_library(&views, COLUMNS, spec()));
        let library = Library::open(&bytes).expect("valid");
        let mut rotated = silhouette.clone();
        crate::canonical::reverse(&silhouette, &mut rotated);
        let mut prepared = std::vec![0; query_bytes_needed(&spec())];
        let query = Query::new(&spec(), &silhouette, &rotated, &mut prepared).expect("right lengths");
        let memory = ViewSearchMemory {
            bounds: &mut [0; scores_needed(VIEWS)],
            sketches: &mut std::vec![0; search_bytes_needed(&spec())],
        };
        let mut search = ViewSearch::new(&library, &query, &Kernels::PORTABLE, memory).expect("right lengths");
        for (view, bits) in views.iter().enumerate() {
            for (reversed, silhouette) in [(false, &silhouette), (true, &rotated)] {
                let naive: u32 = bits.iter().zip(silhouette).map(|(a, b)| (a ^ b).count_ones()).sum();
                // Set pixels of all of a view differ by no more than those of its blocks together.
                let [own, theirs] = [bits, silhouette].map(|bits| bits.iter().map(|word| word.count_ones()).sum::<u32>());
                let bound = search.at_least(view, reversed);
                // A full block counts as one with a pixel less.
                prop_assert!(bound + 64 >= own.abs_diff(theirs) && bound <= naive);
                prop_assert_eq!(search.score(view, reversed), naive);
                prop_assert_eq!(search.at_least(view, reversed), naive);
            }
        }
        // Beyond the last view there is none that could be better.
        prop_assert_eq!(search.at_least(VIEWS, false), u32::MAX);
        prop_assert_eq!(search.at_least(VIEWS, true), u32::MAX);
    }
}

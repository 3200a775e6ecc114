//! Every target of `cargo xtask fuzz` for a moment: what is kept of it, and a few changes of that.

use fluoropose_tests::fuzz::{Random, Seed, Target, changed};

/// So few that all of it takes a second.
fn changes(target: Target) -> usize {
    match target {
        Target::Outlines => 4,
        Target::Implants => 20,
        _ => 200,
    }
}

#[test]
fn what_is_kept_and_changes_of_it_end_no_program() {
    for target in Target::ALL {
        let corpus = target.corpus().expect("a folder");
        assert!(!corpus.is_empty(), "{target:?}");
        let mut random = Random::new(7);
        for seed in &corpus {
            target.run(seed);
        }
        for _ in 0..changes(target) {
            let Seed { name, bytes } = &corpus[random.below(corpus.len())];
            let bytes = changed(bytes, &corpus, &mut random);
            target.run(&Seed {
                name: name.clone(),
                bytes,
            });
        }
    }
}

use super::*;

/// The cycles of a crate `c` given by its files below `src`.
fn crate_of(files: &[(&str, &str)]) -> Graph {
    let sources = files
        .iter()
        .map(|(file, text)| (format!("c/src/{file}"), Source::parse(text).unwrap()));
    graph("my-c", "c", &sources.collect()).unwrap()
}

fn cycles(files: &[(&str, &str)]) -> Vec<String> {
    crate_of(files).cycles()
}

/// Every use as "user > used".
fn uses(files: &[(&str, &str)]) -> Vec<String> {
    let graph = crate_of(files);
    let name = |file: usize| graph.files[file].trim_end_matches(".rs");
    let mut told: Vec<String> = graph
        .uses
        .keys()
        .map(|(from, to)| format!("{} > {}", name(*from), name(*to)))
        .collect();
    told.sort();
    told
}

#[test]
fn two_files_that_import_each_other_are_a_cycle() {
    let two = cycles(&[
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "use crate::b::B;\npub struct A(B);"),
        (
            "b.rs",
            "\nuse super::a::{self, A as Other};\npub struct B(Option<&'static Other>);",
        ),
    ]);
    assert_eq!(
        two,
        ["cycle: c/src/a.rs:1 uses B -> c/src/b.rs:2 uses A -> c/src/a.rs"]
    );
}

#[test]
fn a_cycle_of_three_is_seen_through_re_exports() {
    let three = cycles(&[
        ("lib.rs", "pub mod room; mod other; pub use room::A;"),
        (
            "room/mod.rs",
            "mod a; mod b;\npub use a::A;\npub(crate) use self::b::*;",
        ),
        ("room/a.rs", "use super::B;\npub struct A(B);"),
        ("room/b.rs", "use crate::other::C;\npub struct B(C);"),
        ("other.rs", "use crate::A;\npub struct C(*const A);"),
    ]);
    assert_eq!(
        three,
        [
            "cycle, the shortest among 3 files: c/src/room/a.rs:1 uses B -> c/src/room/b.rs:1 uses C \
          -> c/src/other.rs:1 uses A -> c/src/room/a.rs"
        ]
    );
}

#[test]
fn a_cycle_is_seen_through_inline_paths() {
    let inline = cycles(&[
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "pub fn one() -> f32 {\n    crate::b::two()\n}"),
        (
            "b.rs",
            "use crate::a;\npub fn two() -> f32 {\n    assert!(1.0 > a::one());\n    0.0\n}",
        ),
    ]);
    assert_eq!(
        inline,
        ["cycle: c/src/a.rs:2 uses two -> c/src/b.rs:3 uses one -> c/src/a.rs"]
    );
}

#[test]
fn a_parent_that_uses_its_child_and_is_used_by_it_is_a_cycle() {
    let private = cycles(&[
        ("lib.rs", "mod room;"),
        (
            "room.rs",
            "mod a;\nuse a::help;\npub struct Shared;\nfn f() { help() }",
        ),
        (
            "room/a.rs",
            "use super::*;\npub fn help() {\n    let _ = Shared;\n}",
        ),
    ]);
    assert_eq!(
        private,
        ["cycle: c/src/room.rs:2 uses help -> c/src/room/a.rs:3 uses Shared -> c/src/room.rs"]
    );
    let exported = cycles(&[
        ("lib.rs", "mod room;"),
        ("room.rs", "mod a;\npub use a::help;\npub struct Shared;"),
        ("room/a.rs", "use super::Shared;\npub fn help(_: Shared) {}"),
    ]);
    assert!(exported.is_empty(), "{exported:?}");
}

#[test]
fn a_re_export_that_its_own_file_uses_is_a_use() {
    let own = uses(&[
        ("lib.rs", "mod room;"),
        ("room.rs", "mod a;\npub use a::A;\npub struct Pair(A, A);"),
        ("room/a.rs", "pub struct A;"),
    ]);
    assert_eq!(own, ["room > room/a"]);
}

#[test]
fn a_re_export_from_elsewhere_is_a_use() {
    let sideways = uses(&[
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "pub use crate::b::B;"),
        ("b.rs", "pub struct B;"),
    ]);
    assert_eq!(sideways, ["a > b"]);
}

#[test]
fn what_only_tests_have_does_not_count() {
    let tested = crate_of(&[
        ("lib.rs", "mod a; mod b;"),
        (
            "a.rs",
            "use crate::b::B;\npub struct A(B);\n#[cfg(test)]\nmod tests;\n#[cfg(test)]\nmod fake;",
        ),
        ("a/tests.rs", "use super::*;"),
        ("a/fake.rs", "use super::A;"),
        (
            "b.rs",
            "pub struct B;\n#[cfg(test)]\nuse crate::a::A;\n#[test]\nfn t() { crate::a::x(); }\n\
             impl B { #[cfg(test)]\n fn f(_: crate::a::A) {} }\n\
             #[cfg(all(test, unix))]\nmod tests { use crate::a::A; }",
        ),
    ]);
    assert_eq!(tested.files, ["lib.rs", "a.rs", "b.rs"]);
    assert_eq!(tested.uses.len(), 1);
}

#[test]
fn comments_strings_and_foreign_crates_do_not_count() {
    let quiet = uses(&[
        ("lib.rs", "mod a; mod b;"),
        (
            "a.rs",
            "//! [`crate::b::B`]\nuse std::b::B;\nuse ::b::C;\n/// See [crate::b::B].\n\
             pub fn f(x: &X) { println!(\"crate::b::B\", x.b::<u8>()); x.B; other::b::B::new(); }",
        ),
        ("b.rs", "pub struct B;\npub struct C;"),
    ]);
    assert!(quiet.is_empty(), "{quiet:?}");
}

#[test]
fn a_function_and_a_module_of_one_name_are_told_apart() {
    let both = uses(&[
        (
            "lib.rs",
            "mod estimate; mod user;\npub use estimate::estimate;",
        ),
        ("estimate.rs", "pub fn estimate() {}"),
        (
            "user.rs",
            "use crate::estimate;\nfn f() { estimate(); estimate::estimate(); }",
        ),
    ]);
    assert_eq!(both, ["user > estimate"]);
}

#[test]
fn paths_of_inline_modules_variants_and_stated_files_are_found() {
    let found = uses(&[
        (
            "lib.rs",
            "mod kind; mod outer { pub mod deep; }\n#[path = \"odd/place.rs\"]\nmod placed; mod user;",
        ),
        ("kind.rs", "pub enum Kind { One }"),
        (
            "outer/deep.rs",
            "use super::super::kind::Kind::{self, *};\nfn f() -> Kind { One }",
        ),
        ("odd/place.rs", "pub trait Told {}"),
        (
            "user.rs",
            "struct U; impl crate::placed::Told for U {}\nfn f() -> u8 { match x { crate::kind::Kind::One => 1 } }",
        ),
    ]);
    assert_eq!(
        found,
        ["outer/deep > kind", "user > kind", "user > odd/place"]
    );
}

#[test]
fn macros_are_found_where_they_are_named_or_in_scope() {
    let called = uses(&[
        (
            "lib.rs",
            "macro_rules! early { () => {} }\nmod a; mod b; mod made;",
        ),
        (
            "a.rs",
            "macro_rules! twice { ($x:ident) => { $crate::b::help($x) } }\npub(crate) use twice;",
        ),
        ("b.rs", "early!();\npub fn help() { crate::a::twice!(x); }"),
        (
            "made.rs",
            "self_cell!(pub struct Made { a: u8 });\nfn f() { crate::a::twice!(super::b::help()) }",
        ),
    ]);
    assert_eq!(
        called,
        ["a > b", "b > a", "b > lib", "made > a", "made > b"]
    );
}

#[test]
fn a_program_uses_the_files_of_its_own_library() {
    let program = uses(&[
        ("lib.rs", "pub mod a;"),
        ("a.rs", "pub fn run() {}"),
        ("main.rs", "fn main() { my_c::a::run() }"),
    ]);
    assert_eq!(program, ["main > a"]);
}

#[test]
fn re_exports_in_a_circle_end() {
    let circle = uses(&[
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "pub use crate::b::*;\npub use crate::b::Nothing;"),
        (
            "b.rs",
            "pub use crate::a::*;\npub use crate::a::Nothing;\nfn f(_: Missing) {}",
        ),
    ]);
    assert_eq!(circle, ["a > b", "b > a"]);
}

#[test]
fn a_module_without_a_file_is_an_error() {
    let sources = [(
        "c/src/lib.rs".to_string(),
        Source::parse("mod gone;").unwrap(),
    )]
    .into();
    let error = graph("c", "c", &sources).unwrap_err().to_string();
    assert_eq!(
        error,
        "no file for module `gone`; looked for c/src/gone.rs and c/src/gone/mod.rs"
    );
}

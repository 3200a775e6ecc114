//! Depth from grey frames has no bias: the built-in film, whose display is logarithmic and whose poses are known.
#![allow(clippy::unwrap_used, reason = "a refusal fails the test")]

use fluoropose_laboratory::finding::Method;
use fluoropose_laboratory::verbs::evaluate::{Request, evaluate};
use fluoropose_laboratory::verbs::synthetic::{FilmKind, FilmWay, Films, measure_films};
use fluoropose_phantom::implant::Side;
use fluoropose_phantom::sequence::{Options, write};

#[test]
fn poses_on_the_built_in_film_have_their_true_depth() {
    let name = format!("fluoropose-film-{}", std::process::id());
    let folder = std::env::temp_dir().join(name);
    let options = Options {
        frames: 4,
        seed: 2,
        side: Side::Left,
        ..Options::default()
    };
    write(&options, &folder).unwrap();
    let table = evaluate(&folder.join("study.toml"), &Request::of(Method::Image));
    std::fs::remove_dir_all(&folder).unwrap();
    let table = table.unwrap();
    // Without the film's constants they are 8 and 38 mm too far.
    for (row, [z_mm, rotation_deg]) in table.rows.iter().zip([[1.0, 0.15], [2.0, 0.4]]) {
        let name = &row.component;
        assert!(row.bias.z_mm.abs() < z_mm, "{name}: {:?}", row.bias);
        assert!(row.rms.geodesic_deg < rotation_deg, "{name}: {:?}", row.rms);
        let film = row.film.as_ref().unwrap();
        assert!(film.starts_with("logarithmic film"), "{film}");
    }
    assert_eq!(table.rows.len(), 2);
}

/// In the second of these films the click takes the tray's inner rim, 15 degrees and 33 mm off, where the right pose leaves a third
/// of what remains there.
#[test]
fn a_tray_on_its_inner_rim_is_told_by_its_film() {
    let mut kinds = FilmKind::all();
    kinds.retain(|kind| kind.name == "linear, sharp, much");
    let what = Films {
        kinds: &kinds,
        count: 2,
        seed: 1,
        ways: &[FilmWay::Click],
    };
    let rows = measure_films(&what, |_| ()).unwrap();
    assert_eq!(rows.len(), 2);
    for (row, z_mm) in rows.iter().zip([1.5, 3.0]) {
        let name = row.component;
        assert_eq!(
            [row.good, row.failures, row.far_but_good],
            [2, 0, 0],
            "{name}"
        );
        assert!(row.rms.z_mm < z_mm, "{name}: {:?}", row.rms);
    }
}

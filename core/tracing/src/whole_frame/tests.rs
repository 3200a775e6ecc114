//! In which frames is searched, and how near places and poses are to each other.

use super::*;
use crate::PlacesBuffers;
use crate::one_click::tests::{library, model, pose};
use fluoropose::finder::FinderBuffers;
use fluoropose::image::frame::Frame;
use fluoropose::image::mask::{Mask, MaskMut, words_needed};
use fluoropose::library::Library;
use fluoropose::mesh::Model;
use fluoropose::pose::EulerPose;
use fluoropose::refine::Polarity;
use fluoropose::render::{Projected, render};
use fluoropose::search::kernels::Kernels;

/// What comes of a search that is begun in a frame which is so many pixels wide.
fn begun<T>(
    side: usize,
    with: impl FnOnce(&ImageTarget<'_>, &Component<'_>, &Camera, &mut PlacesMemory<'_>) -> T,
) -> T {
    let (vertices, triangles) = model();
    let model = Model::from_triangles(&vertices, &triangles).expect("valid");
    let bytes = library(model, 1000.0);
    let library = Library::open(&bytes).expect("a library");
    let times = side as f64 / 384.0;
    let camera = Camera::new(side, side, [1800.0 * times; 2], [192.0 * times; 2]);
    let camera = camera.expect("valid");
    let mut words = std::vec![0; words_needed(side, side)];
    let mut mask = MaskMut::new(&mut words, side, side).expect("fits");
    let mut scratch = std::vec![Projected::default(); vertices.len()];
    render(&model, &camera, &pose(), &mut scratch, &mut mask).expect("in front");
    let mask = Mask::new(&words, side, side).expect("valid");
    let grey = |k: usize| match mask.get(k % side, k / side) {
        true => 9000,
        false => 20_000 + 4 * (k % side) as u16,
    };
    let pixels: std::vec::Vec<u16> = (0..side * side).map(grey).collect();
    let frame = Frame::new(&pixels, side, side, side).expect("fits");
    let image = ImageTarget {
        frame: &frame,
        unknown: None,
        polarity: Polarity::DarkImplant,
        film: None,
    };
    let component = Component {
        library: &library,
        model: &model,
        planes: &[],
    };
    let (mut buffers, mut finder) = (PlacesBuffers::default(), FinderBuffers::default());
    let mut memory = buffers.borrow(&camera, finder.workspace(&library, Kernels::PORTABLE));
    with(&image, &component, &camera, &mut memory)
}

/// Widths of the frames in which the first click searches, where there is any, of frames that are so many pixels wide.
fn searched(side: usize) -> [Option<usize>; 3] {
    begun(side, |image, component, camera, memory| {
        [Places::Shaped, Places::Dark, Places::All].map(|places| {
            let begun = WholeFrame::new(image, component, camera, (places, None), memory);
            let search = begun.expect("enough memory");
            search.needs().map(|_| search.reduction.camera().width())
        })
    })
}

/// The first place is where somebody clicked; the implant is 90 pixels large.
#[test]
fn near_a_click_are_itself_and_places_no_farther_off_than_the_component_is_large() {
    for (click, others) in [
        ([192.0, 192.0], true),
        ([230.0, 150.0], true),
        ([12.0, 370.0], false),
    ] {
        let click = Point::new(click[0], click[1]);
        let (places, size) = begun(384, |image, component, camera, memory| {
            let search = WholeFrame::near(image, component, camera, click, memory);
            let size = expected_size(component, camera);
            (search.expect("enough memory").places, size)
        });
        assert_eq!(places[0].0, click);
        assert_eq!(places.len() > 1, others, "{click:?}");
        for (place, _) in &places {
            let off = f64::hypot(place.column - click.column, place.row - click.row);
            assert!(off <= size, "{off} of {size}");
        }
    }
}

/// Of points that lie as far from the camera, in any direction from the middle.
#[test]
fn a_place_is_as_far_from_a_point_as_the_point_that_is_seen_there() {
    let camera = Camera::new(640, 480, [1500.0, 1700.0], [300.0, 250.0]).expect("valid");
    let middle = [12.0, -30.0, -800.0];
    for [x, y] in [[0.0, 0.0], [30.0, 0.0], [0.0, -40.0], [-21.0, 20.0]] {
        let place = camera.project(&[middle[0] + x, middle[1] + y, middle[2]]);
        let away = distance_mm(&place.expect("seen"), &middle, &camera);
        assert!((away - f64::hypot(x, y)).abs() < 1e-9, "{away}");
    }
    let behind = distance_mm(&Point::new(0.0, 0.0), &[0.0, 0.0, 800.0], &camera);
    assert_eq!(behind, f64::INFINITY);
}

#[test]
fn poses_are_near_each_other_by_their_turn_and_by_a_part_of_their_distance() {
    let pose = |y_rot_deg: f64, x_mm: f64| {
        let euler = EulerPose {
            y_rot_deg,
            x_mm,
            z_mm: -1000.0,
            ..EulerPose::default()
        };
        Pose::from(euler)
    };
    for (turn_deg, x_mm, near) in [
        (0.0, 0.0, true),
        (1.9, 19.9, true),
        (-1.9, -19.9, true),
        (2.1, 0.0, false),
        (0.0, 20.1, false),
    ] {
        assert_eq!(
            is_near(&pose(turn_deg, x_mm), &pose(0.0, 0.0), 2.0, 0.02),
            near
        );
    }
}

#[test]
fn large_things_are_looked_for_from_afar_and_small_ones_as_they_are() {
    let [shaped, dark, all] = searched(1536).map(Option::unwrap_or_default);
    assert!(0 < shaped && shaped < 1536 / 2, "{shaped}");
    assert_eq!([dark, all], [shaped; 2]);
    assert_eq!(searched(192), [Some(192); 3]);
}

/// Dark places by the number of those that are shaped: in passing first, where they are many, then those that are kept.
#[test]
fn what_is_done_of_a_search_never_becomes_less_and_ends_with_all_of_it() {
    let camera = Camera::new(64, 64, [300.0; 2], [32.0; 2]).expect("valid");
    for (shaped, dark) in [(0, 16), (4, 16), (2, 5), (0, 4), (3, 0), (4, 2)] {
        let place = (Point::new(30.0, 30.0), 0.5);
        let mut search = WholeFrame {
            beside: None,
            places: (0..shaped + dark).map(|_| place).collect(),
            shaped,
            in_passing: false,
            passed: 0,
            at: 0,
            click: None,
            found: None,
            agreed: false,
            reduction: Reduction::of(f64::NAN, &camera),
            surround: None,
        };
        let mut before = 0.0;
        let mut at_least = |search: &WholeFrame, part: f64| {
            let done = search.part_done(part);
            assert!(
                (before..=1.0 + 1e-12).contains(&done),
                "{shaped} {dark}: {done} after {before}"
            );
            before = done;
        };
        while search.at < search.places.len() {
            if search.at == shaped && search.places.len() > shaped + TRIED {
                search.in_passing = true;
                while search.at < search.places.len() {
                    at_least(&search, 0.3);
                    search.at += 1;
                }
                search.keep_the_likeliest();
            }
            for part in [0.0, 0.5, 1.0] {
                at_least(&search, part);
            }
            search.at += 1;
        }
        assert!((before - 1.0).abs() < 1e-12, "{shaped} {dark}: {before}");
    }
}

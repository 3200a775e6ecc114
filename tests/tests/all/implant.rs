//! An implant in one file: what is found with it in a part of the frame, and what becomes of damaged bytes.

use fluoropose::finder::choice::ChoiceContext;
use fluoropose::finder::{FinderBuffers, Found, Goal, find};
use fluoropose::image::crop::Crop;
use fluoropose::image::mask::{MaskMut, words_needed};
use fluoropose::image::runs::{PixelRun, RunBuilder};
use fluoropose::implant::{
    ArenaNeeds, HEADER_BYTES, ImplantCheck, ImplantError, ImplantFile, write_implant,
};
use fluoropose::mesh::symmetry::symmetry_planes;
use fluoropose::mesh::{Model, OwnedModel};
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::render::{Projected, render};
use fluoropose::search::kernels::Kernels;
use fluoropose::{Camera, Mask, RefineOptions, Silhouette};
use fluoropose_laboratory::finding::{ViewOptions, build_library};

use crate::made_implant::{
    DISTANCE, Words, camera, drawn, is_cut_off, made_femur, made_tibia, many_poses,
};

/// What is found of a silhouette in all of the frame, with a model that was linked here.
fn in_frame(file: &ImplantFile<'_>, own: &OwnedModel, mask: &Mask<'_>) -> Found {
    let (camera, model) = (camera(), own.as_model());
    let component = fluoropose::Component {
        model: &model,
        ..file.component()
    };
    let mut buffers = FinderBuffers::default();
    let mut memory = buffers.borrow(&component, &camera, Kernels::PORTABLE);
    let silhouette = Silhouette::from(mask);
    let options = RefineOptions::default();
    find(
        &component,
        &camera,
        &silhouette,
        Goal::Outline,
        options,
        &mut memory,
    )
    .expect("found")
}

/// The same from its rows, in the part of the frame that holds it, with the model of the file.
fn in_crop(file: &ImplantFile<'_>, mask: &Mask<'_>) -> Found {
    let mut memory = vec![PixelRun::EMPTY; 4096];
    let mut builder = RunBuilder::new(&mut memory, 512, 512).expect("a frame");
    for row in 0..512 {
        let pixels = (0..512).map(|column| mask.get(column, row));
        builder.add_row(row, pixels).expect("room");
    }
    let runs = builder.finish();
    assert_eq!(runs.moments(), mask.moments());
    let crop = runs.crop(Crop::MARGIN).expect("a silhouette");
    let mut words = vec![0; crop.words_needed()];
    let mask = runs.draw(&crop, &mut words).expect("fits");
    let silhouette = Silhouette::from(&mask).in_crop(&crop).expect("all of it");
    let (camera, component) = (camera().cropped(&crop).expect("a part"), file.component());
    let mut buffers = FinderBuffers::default();
    let mut memory = buffers.borrow(&component, &camera, Kernels::PORTABLE);
    // What static memory would have, and nothing for pieces of an outline.
    let needs = ArenaNeeds::of(file.bytes(), crop.width(), crop.height());
    let mut projected = vec![Projected::default(); needs.projected];
    memory.refine.projected = &mut projected;
    memory.partial = Default::default();
    let options = RefineOptions::default();
    find(
        &component,
        &camera,
        &silhouette,
        Goal::Outline,
        options,
        &mut memory,
    )
    .expect("found")
}

#[test]
fn a_part_of_the_frame_leads_to_the_pose_that_the_frame_leads_to() {
    let mut at_border = 0;
    for (own, words) in [made_femur(), made_tibia()] {
        let file = ImplantFile::open(words.bytes()).expect("whole");
        for euler in many_poses().take(48) {
            let frame = drawn(&own, euler);
            let mask = Mask::new(&frame, 512, 512).expect("valid");
            if is_cut_off(&mask) {
                // Cut off: pieces of its outline are looked for in the frame.
                continue;
            }
            let (columns, rows) = mask.bounds();
            let after = (512 - columns.end).min(512 - rows.end);
            let nearest = columns.start.min(rows.start).min(after);
            at_border += usize::from(nearest < Crop::MARGIN);
            let (there, here) = (in_frame(&file, &own, &mask), in_crop(&file, &mask));
            assert_eq!(there.candidates.len(), here.candidates.len(), "{euler:?}");
            for (there, here) in there.candidates.iter().zip(&here.candidates) {
                let turn = geodesic_deg(&there.pose.rotation, &here.pose.rotation);
                assert!(turn < 1e-6, "{turn} deg at {euler:?}");
                for (a, b) in there.pose.translation.iter().zip(&here.pose.translation) {
                    assert!((a - b).abs() < 1e-5, "{a}, {b} at {euler:?}");
                }
            }
            let context = ChoiceContext::default();
            let [there, here] = [there, here].map(|found| found.decide(&context).expect("some"));
            assert_eq!(there.choice.index, here.choice.index);
            assert_eq!(there.verdict.word(), here.verdict.word());
        }
    }
    assert!(at_border > 0, "none lay at the border");
}

/// Triangles, each from its lowest vertex on, in order.
fn triangles_of(model: &Model<'_>) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    model.for_each_triangle(|triangle| {
        let mut triangle = *triangle;
        let lowest = (0..3).min_by_key(|&corner| triangle[corner]);
        triangle.rotate_left(lowest.expect("three"));
        triangles.push(triangle);
    });
    triangles.sort_unstable();
    triangles
}

/// The pixels of a model that is drawn where there is no room for its silhouette edges: triangle by triangle.
fn drawn_by_triangles(model: &Model<'_>, camera: &Camera, euler: EulerPose) -> Vec<u32> {
    let mut words = vec![0; words_needed(camera.width(), camera.height())];
    let mut mask = MaskMut::new(&mut words, camera.width(), camera.height()).expect("fits");
    let mut scratch = vec![Projected::default(); 64];
    render(model, camera, &Pose::from(euler), &mut scratch, &mut mask).expect("in front");
    words
}

/// Files of the first layouts: with a list of triangles, and with edges as numbers.
#[test]
fn files_of_earlier_versions_are_read() {
    let kept = [0, 1].map(|version| {
        let path = format!("golden/version-{version}.implant");
        let path = fluoropose_tests::home().join(path);
        Words::of(&std::fs::read(path).expect("kept"))
    });
    let [first, second] = kept
        .each_ref()
        .map(|words| ImplantFile::open(words.bytes()).expect("whole"));
    let (model, library) = (first.model(), first.library());
    assert_eq!((model.triangles().len(), library.views()), (140, 9));
    assert_eq!((first.planes().len(), first.deviation_mm()), (3, 0.125));
    // Written again it has neither, and is the same implant.
    let vertices = model.vertices().as_flattened().to_vec();
    let triangles = model.triangles().as_flattened().to_vec();
    let own = OwnedModel::new(vertices, triangles).expect("valid");
    let bytes = first.bytes();
    let views = &bytes[bytes.len() - library_bytes(bytes)..];
    let again = write_implant(&own.as_model(), views, first.planes(), first.deviation_mm());
    let again = Words::of(&again.expect("written"));
    let third = ImplantFile::open(again.bytes()).expect("whole");
    assert_eq!(second.bytes().len() + 12 * 140, bytes.len());
    assert!(third.bytes().len() + 3 * 210 < second.bytes().len());
    let camera = library.info().camera;
    for other in [second, third] {
        assert_eq!(triangles_of(other.model()), triangles_of(model));
        assert_eq!(other.contour_needs(), first.contour_needs());
        for euler in many_poses().take(20) {
            let euler = EulerPose {
                x_mm: 0.0,
                y_mm: 0.0,
                ..euler
            };
            assert_eq!(
                drawn_by_triangles(other.model(), &camera, euler),
                drawn_by_triangles(model, &camera, euler)
            );
        }
    }
}

/// Bytes of the library at the end of an implant file.
fn library_bytes(file: &[u8]) -> usize {
    let four = file[32..36].try_into().expect("four");
    u32::from_le_bytes(four) as usize
}

#[test]
fn what_is_known_of_an_implant_is_read_back() {
    let (own, words) = made_femur();
    let (bytes, model) = (words.bytes(), own.as_model());
    let file = ImplantFile::open(bytes).expect("whole");
    let trusted = ImplantFile::trusted(bytes).expect("long enough");
    let intact = ImplantFile::intact(bytes).expect("whole");
    let mut check = ImplantCheck::new(bytes).expect("a header");
    while check.go_on(1000) {}
    for file in [file, trusted, intact, check.finish().expect("whole")] {
        assert_eq!(file.model().vertices(), model.vertices());
        assert_eq!(triangles_of(file.model()), triangles_of(&model));
        assert!(file.model().triangles().is_empty());
        assert_eq!(file.model().bounds(), model.bounds());
        assert_eq!(file.model().digest(), model.digest());
        assert_eq!(file.planes(), symmetry_planes(model.mesh()).as_slice());
        assert_eq!(file.library().views(), 7 * 9);
        assert_eq!(file.deviation_mm(), 0.25);
        let needs = ArenaNeeds::of(bytes, 200, 160);
        let vertices = model.vertices().len();
        assert_eq!(needs.projected, file.contour_needs().scratch(vertices, 160));
        assert_eq!(
            needs.canonical,
            file.library().info().canonical.words_needed()
        );
        assert_eq!(needs.words, words_needed(200, 160));
    }
}

/// With sums that are right: what was written wrongly, and not what was damaged.
#[test]
fn planes_and_deviations_that_cannot_be_are_refused() {
    let (own, words) = made_tibia();
    let crc = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
    let put = |at: usize, values: &[f64]| {
        let mut bytes = words.bytes().to_vec();
        for (place, value) in bytes[at..].as_chunks_mut().0.iter_mut().zip(values) {
            *place = value.to_le_bytes();
        }
        let sum = crc.checksum(&bytes[..HEADER_BYTES - 4]);
        bytes[HEADER_BYTES - 4..HEADER_BYTES].copy_from_slice(&sum.to_le_bytes());
        ImplantFile::open(Words::of(&bytes).bytes()).err()
    };
    let planes = Some(ImplantError::Value("planes of symmetry"));
    let (deviation, point, normal, off) = (52, 92, 116, 140);
    assert_eq!(put(deviation, &[0.5]), None);
    assert_eq!(put(normal, &[0.6, 0.0, 0.8]), None);
    for wrong in [[f64::NAN; 3], [0.0; 3], [0.0, 0.0, 3.0]] {
        assert_eq!(put(normal, &wrong), planes, "{wrong:?}");
    }
    assert_eq!(put(point, &[f64::INFINITY]), planes);
    for wrong in [f64::NAN, -1.0] {
        assert_eq!(put(off, &[wrong]), planes);
        assert_eq!(
            put(deviation, &[wrong]),
            Some(ImplantError::Value("deviation"))
        );
    }
    let mut planes = symmetry_planes(own.as_model().mesh());
    planes[0].normal = [0.0; 3];
    let library = &words.bytes()[words.length - library_bytes(words.bytes())..];
    let written = write_implant(&own.as_model(), library, &planes, 0.0);
    assert_eq!(
        written.err(),
        Some(ImplantError::Value("planes of symmetry"))
    );
}

#[test]
fn damaged_bytes_are_refused() {
    let (_, mut words) = made_femur();
    let bits = 8 * words.length;
    // All of the header, and then some of every part; a checksum tells any one bit.
    for bit in (0..8 * HEADER_BYTES).chain((8 * HEADER_BYTES..bits).step_by(3001)) {
        words.flip(bit);
        assert!(ImplantFile::open(words.bytes()).is_err(), "bit {bit}");
        // It does not panic.
        let _ = ImplantFile::trusted(words.bytes()).is_err();
        words.flip(bit);
    }
    let bytes = words.bytes();
    for length in [0, 7, 8, 11, HEADER_BYTES - 1, HEADER_BYTES, bytes.len() - 1] {
        assert!(ImplantFile::open(&bytes[..length]).is_err());
        assert!(ImplantFile::trusted(&bytes[..length]).is_err());
    }
    let mut odd = vec![0; 1];
    odd.extend(bytes);
    let odd = Words::of(&odd);
    assert_eq!(
        ImplantFile::open(&odd.bytes()[1..]).err(),
        Some(ImplantError::Place)
    );
    let (tray, _) = made_tibia();
    let library = build_library(
        tray.as_model(),
        camera(),
        &ViewOptions::window([0.0; 2]),
        DISTANCE,
    );
    let (own, _) = made_femur();
    assert_eq!(
        write_implant(&own.as_model(), &library.expect("built").bytes, &[], 0.0).err(),
        Some(ImplantError::OtherModel)
    );
}

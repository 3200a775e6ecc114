//! A short film followed from poses that a person fixed, stopped, and gone on with.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fluoropose::camera::Camera;
use fluoropose::follow::State;
use fluoropose::image::mask::{MaskMut, words_needed};
use fluoropose::pose::{EulerPose, Pose, geodesic_deg};
use fluoropose::render::{Projected, render, scratch_needed};
use fluoropose_laboratory::progress::Stop;
use fluoropose_laboratory::verbs::track::{Fixed, Request, Tracked, track};
use fluoropose_phantom::film::motion::{Position, deep_knee_bend};
use fluoropose_phantom::implant::{Side, Triangles};
use fluoropose_phantom::picture::write_grey;
use fluoropose_phantom::stl;
use fluoropose_tests::{coarse_parts, surface};

/// Where it does not matter how well a frame is resolved.
const SIDE: usize = 384;
/// Of a detector, mm.
const DETECTOR: f64 = 381.952;
const FRAMES: usize = 4;
const CALIBRATION: &str = "JT_INTCALIB\n1200\n0\n0\n0.994666666666667\n";
const STUDY: &str = "name = 'short'\ncalibration = 'calibration.txt'\nframes = 'frames'\n\
[[component]]\nname = 'femur'\nmodel = 'femur.stl'\n[[component]]\nname = 'tibia'\nmodel = 'tibia.stl'\n";

/// A film in a folder of its own, and its truth.
struct Short {
    folder: PathBuf,
    truth: [Vec<EulerPose>; 2],
}

impl Drop for Short {
    fn drop(&mut self) {
        // What cannot be removed stays in the folder of temporary files.
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Of frames of so many pixels to a side.
pub(crate) fn camera(side: usize) -> Camera {
    let pitch = DETECTOR / side as f64;
    Camera::from_principal_distance(side, side, 1200.0, pitch, [0.0, 0.0]).expect("valid")
}

/// Two components of different darkness, drawn four times as finely as they are seen, and a little noise.
pub(crate) fn frame(
    side: usize,
    parts: [(&Triangles, EulerPose, f64); 2],
    number: usize,
) -> Vec<u8> {
    const FINE: usize = 4;
    let fine = side * FINE;
    let mut grey = vec![200.0; side * side];
    for (part, pose, darker) in parts {
        let model = surface(part.clone());
        let mut words = vec![0; words_needed(fine, fine)];
        let mut mask = MaskMut::new(&mut words, fine, fine).expect("fits");
        let mut scratch = vec![Projected::default(); scratch_needed(&model.as_model())];
        render(
            &model.as_model(),
            &camera(fine),
            &pose.into(),
            &mut scratch,
            &mut mask,
        )
        .expect("in front");
        let mask = mask.into_mask();
        for (at, grey) in grey.iter_mut().enumerate() {
            let (column, row) = (at % side * FINE, at / side * FINE);
            let inside = (0..FINE * FINE)
                .filter(|k| mask.get(column + k % FINE, row + k / FINE))
                .count();
            *grey -= darker * inside as f64 / (FINE * FINE) as f64;
        }
    }
    let mut seed = number as u64 + 1;
    let mut noise = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 40) as f64 / f64::from(1u32 << 24) - 0.5
    };
    grey.iter()
        .map(|grey| (grey + 6.0 * noise()) as u8)
        .collect()
}

fn short(name: &str) -> Short {
    shown(name, |grey| grey)
}

/// The same film as `show` displays it.
fn shown(name: &str, show: fn(u8) -> u8) -> Short {
    let folder =
        std::env::temp_dir().join(format!("fluoropose-track-{name}-{}", std::process::id()));
    fs::create_dir_all(folder.join("frames")).expect("a folder");
    let [thigh, tray] = coarse_parts();
    let film = deep_knee_bend(80, Side::Left, &thigh, 70.0, 1);
    for (number, position) in film.iter().take(FRAMES).enumerate() {
        let parts = [
            (&thigh, position.femur, 120.0),
            (&tray, position.tibia, 70.0),
        ];
        let path = folder.join("frames").join(format!("{number:02}.png"));
        let grey: Vec<u8> = frame(SIDE, parts, number).into_iter().map(show).collect();
        write_grey(&path, (SIDE, SIDE), &grey).expect("a frame");
    }
    for (part, name) in [(&thigh, "femur.stl"), (&tray, "tibia.stl")] {
        stl::write_file(part, &folder.join(name)).expect("a model");
    }
    fs::write(folder.join("calibration.txt"), CALIBRATION).expect("a calibration");
    fs::write(folder.join("study.toml"), STUDY).expect("a study");
    let truth = |of: fn(usize, &[Position]) -> EulerPose| {
        (0..FRAMES).map(|number| of(number, &film)).collect()
    };
    Short {
        truth: [
            truth(|number, film| film[number].femur),
            truth(|number, film| film[number].tibia),
        ],
        folder,
    }
}

impl Short {
    /// Follows from the frames in which the poses are fixed.
    fn track(&self, out: &str, fixed: &[usize]) -> anyhow::Result<Vec<Tracked>> {
        let parts = ["femur", "tibia"].into_iter().zip(&self.truth);
        let given = parts.map(|(name, truth)| Fixed {
            component: name.to_owned(),
            poses: truth
                .iter()
                .enumerate()
                .map(|(frame, pose)| fixed.contains(&frame).then(|| Pose::from(*pose)))
                .collect(),
            called: name.to_owned(),
        });
        track(&Request {
            study: self.folder.join("study.toml"),
            out: self.folder.join(out),
            clicks: Vec::new(),
            fixed: given.collect(),
            polarity: None,
            interpolate: 0,
            anew: false,
            listener: Arc::new(|_| ()),
            stop: Stop::default(),
        })
    }

    /// All frames but the first, whose pose was fixed, are followed to within 2 degrees.
    fn assert_followed_from_the_first(&self, tracked: &[Tracked]) {
        self.assert_near(tracked);
        for row in tracked.iter().flat_map(|tracked| &tracked.rows) {
            let state = if row.frame == 1 {
                State::Fixed
            } else {
                State::Followed
            };
            assert_eq!(row.state, state, "{row:?}");
        }
    }

    /// All frames have a pose within 2 degrees.
    fn assert_near(&self, tracked: &[Tracked]) {
        for (tracked, truth) in tracked.iter().zip(&self.truth) {
            for (row, truth) in tracked.rows.iter().zip(truth) {
                let pose = Pose::from(row.pose.expect("every frame is visible"));
                let turn = geodesic_deg(&pose.rotation, &Pose::from(*truth).rotation);
                assert!(turn < 2.0, "{} {turn} {row:?}", tracked.component);
            }
        }
    }

    fn bytes(&self, out: &str) -> Vec<Vec<u8>> {
        let read = |name: &str| fs::read(self.folder.join(out).join(name)).expect("written");
        ["femur.jts", "tibia.jts", "track.csv"].map(read).to_vec()
    }

    fn journal(&self, out: &str) -> PathBuf {
        self.folder.join(out).join("journal.txt")
    }

    fn lines(&self, out: &str) -> usize {
        let text = fs::read_to_string(self.journal(out)).expect("written");
        text.lines().count()
    }
}

fn copy(from: &Path, to: &Path, bytes: usize) {
    let whole = fs::read(from).expect("written");
    fs::create_dir_all(to.parent().expect("a folder")).expect("a folder");
    fs::write(to, &whole[..bytes.min(whole.len())]).expect("a copy");
}

#[test]
fn a_short_film_is_followed_from_one_frame_and_the_same_where_it_was_stopped() {
    let film = short("resumed");
    let whole = film.track("whole", &[0]).expect("a film");
    film.assert_followed_from_the_first(&whole);
    // Stopped twice, once in the middle of a line.
    let length = fs::metadata(film.journal("whole")).expect("written").len() as usize;
    for (out, bytes) in [("early", length / 5), ("late", 4 * length / 5)] {
        copy(&film.journal("whole"), &film.journal(out), bytes);
        film.track(out, &[0]).expect("it goes on");
        assert!(film.bytes(out) == film.bytes("whole"), "stopped {out}");
    }
    let done = film.lines("whole");
    film.track("whole", &[0]).expect("nothing is left to do");
    assert_eq!(film.lines("whole"), done);
}

#[test]
fn a_negative_is_followed_and_nobody_says_that_it_is_one() {
    let film = shown("negative", |grey| 255 - grey);
    let tracked = film.track("whole", &[0]).expect("a film");
    film.assert_followed_from_the_first(&tracked);
}

/// A film twice as fine as [`short`], of a blur of some five of its pixels and more noise.
fn finer() -> Short {
    const FINE: usize = 2 * SIDE;
    let film = short("finer");
    let calibration = CALIBRATION.replace("0.994666666666667", "0.497333333333333");
    fs::write(film.folder.join("calibration.txt"), calibration).expect("a calibration");
    let mut seed = 1_u64;
    for number in 0..FRAMES {
        let path = film.folder.join(format!("frames/{number:02}.png"));
        let file = fs::read(&path).expect("a frame");
        let coarse = fluoropose_decode::decode_frames(&file, "frame.png").expect("a frame");
        let at = |k: usize| coarse[0].pixels.get(k / FINE / 2 * SIDE + k % FINE / 2);
        let mut grey: Vec<f64> = (0..FINE * FINE)
            .map(|k| f64::from(at(k).expect("a pixel")))
            .collect();
        for step in [1, FINE].repeat(3) {
            let mean = |k: usize| {
                let near = (0..5).map(|n| k as isize + (n - 2) * step as isize);
                let value = |at: isize| grey.get(at as usize).copied().unwrap_or(grey[k]);
                near.map(value).sum::<f64>() / 5.0
            };
            grey = (0..FINE * FINE).map(mean).collect();
        }
        let noisy = |grey: f64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (grey + 30.0 * ((seed >> 40) as f64 / f64::from(1u32 << 24) - 0.5)) as u8
        };
        let grey: Vec<u8> = grey.into_iter().map(noisy).collect();
        write_grey(&path, (FINE, FINE), &grey).expect("a frame");
    }
    film
}

#[test]
fn a_film_finer_than_its_blur_is_read_in_squares() {
    let film = finer();
    let tracked = film.track("whole", &[0]).expect("a film");
    let constants = fs::read_to_string(film.folder.join("whole/film.csv")).expect("written");
    for row in constants.lines().skip(1) {
        assert!(row.ends_with(",2"), "{constants}");
    }
    // Trays of so soft and noisy a film may be doubtful.
    film.assert_near(&tracked);
    let done = film.lines("whole");
    film.track("whole", &[0]).expect("nothing is left to do");
    assert_eq!(film.lines("whole"), done);
}

#[test]
fn fixed_poses_stay_and_other_inputs_are_not_mixed() {
    let film = short("fixed");
    let all = film.track("all", &[0, 1, 2, 3]).expect("a film");
    for (tracked, truth) in all.iter().zip(&film.truth) {
        for (row, truth) in tracked.rows.iter().zip(truth) {
            let given = Pose::from(*truth);
            let pose = Pose::from(row.pose.expect("fixed"));
            assert_eq!(row.state, State::Fixed);
            assert!(geodesic_deg(&pose.rotation, &given.rotation) < 1e-6);
            assert_eq!(pose.translation, given.translation);
        }
    }
    // Another frame of the same name.
    fs::copy(
        film.folder.join("frames/00.png"),
        film.folder.join("frames/03.png"),
    )
    .expect("a copy");
    let mixed = film.track("all", &[0]).err().expect("refused").to_string();
    assert!(mixed.contains("other frames"), "{mixed}");
}

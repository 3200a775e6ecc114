//! Profiles of a film around the frames in which a component's pose is known, for the film's constants.
//!
//! One frame tells little of a film: its metal lies where it lies, and its blur is that of one place. What lies beside it is near enough to
//! be reached without the constants.

use alloc::boxed::Box;
use alloc::collections::VecDeque;
use alloc::vec;
use alloc::vec::Vec;

use super::cell::Anchor;
use super::frame_pose::{From, refined_on_frame};
use super::look::look;
use super::subject::Subject;
use super::way::Way;
use crate::film::FilmProfile;
use crate::film::pool::profiles_of_each;
use crate::math::Vector3;
use crate::pose::Pose;
use crate::refine::{ImageTarget, RefineMemory, film_profiles};

/// Known poses of a component that are looked at, and frames to each side of them.
const POSES: usize = 3;
const BESIDE: usize = 6;

/// Reads profiles of a film at the first poses of a component that are known, and in the frames beside those as far as a way without the
/// film's constants leads. [`Self::wanted`] says which frame is to be looked at, [`Self::take`] looks at it.
///
/// What a person placed by hand may lie off by more than a film's blur: profiles are read where the frame itself puts the outline.
#[derive(Debug)]
pub struct FilmReading {
    middle: Vector3,
    frames: usize,
    /// The number that its profiles bear.
    component: u8,
    poses: usize,
    tasks: VecDeque<Task>,
}

#[derive(Debug)]
enum Task {
    At(usize, Pose),
    /// Read at this very pose.
    Just(usize, Pose),
    Beside(Box<Way>, usize),
}

impl FilmReading {
    /// Of a film of `frames`; `middle` is the middle of the model's box, `component` the number that profiles bear.
    #[must_use]
    pub fn new(middle: Vector3, frames: usize, component: u8) -> Self {
        Self {
            middle,
            frames,
            component,
            poses: 0,
            tasks: VecDeque::new(),
        }
    }

    /// Gives a pose that is known, before the first frame is asked for; in the order of frames. More than three are left out, as are
    /// frames outside of the film.
    pub fn give(&mut self, frame: usize, pose: Pose) {
        if frame < self.frames && self.poses < POSES {
            self.poses += 1;
            self.tasks.push_back(Task::At(frame, pose));
        }
    }

    /// Asks for the profiles at a pose that a frame has led to, as it is and without the frames beside it; such may be as many as are wanted.
    pub fn ask(&mut self, frame: usize, pose: Pose) {
        if frame < self.frames {
            self.tasks.push_back(Task::Just(frame, pose));
        }
    }

    /// Takes off what comes last of what is left, for another thread: nothing of it depends on the rest, and its frames come after those of
    /// the rest. `None` where it is one way or one pose.
    pub fn split(&mut self) -> Option<Self> {
        let tasks = self.tasks.split_off(self.tasks.len().div_ceil(2));
        (!tasks.is_empty()).then_some(Self {
            middle: self.middle,
            frames: self.frames,
            component: self.component,
            poses: self.poses,
            tasks,
        })
    }

    /// The frame that is to be looked at; `None` where all is read.
    pub fn wanted(&mut self) -> Option<usize> {
        loop {
            let next = match self.tasks.front()? {
                Task::At(frame, _) | Task::Just(frame, _) => Some(*frame),
                Task::Beside(way, to) => way.next(*to),
            };
            if next.is_some() {
                return next;
            }
            self.tasks.pop_front();
        }
    }

    /// Looks at the frame that [`Self::wanted`] asked for; gives its profiles, none where the component is not found there. What is
    /// known of the film is not used, so that the order of work does not matter.
    pub fn take(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        memory: &mut RefineMemory<'_>,
    ) -> Vec<FilmProfile> {
        let Some(frame) = self.wanted() else {
            return Vec::new();
        };
        let bare = ImageTarget {
            film: None,
            ..*image
        };
        match self.look(frame, subject, &bare, memory) {
            Some(pose) => profiles_at(subject, image, &pose, (self.component, frame), memory),
            None => Vec::new(),
        }
    }

    fn look(
        &mut self,
        frame: usize,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        memory: &mut RefineMemory<'_>,
    ) -> Option<Pose> {
        match self.tasks.front_mut()? {
            Task::Beside(way, _) => {
                let looked = look(subject, image, frame, way.trail(), memory);
                way.take(frame, &looked, &self.middle);
                looked.found.ok().map(|found| found.pose)
            }
            Task::Just(_, pose) => {
                let pose = *pose;
                self.tasks.pop_front();
                Some(pose)
            }
            Task::At(_, pose) => {
                let start = (&*pose, From::Near);
                let found = refined_on_frame(subject, image, start, memory);
                self.tasks.pop_front();
                let anchor = Anchor::found(frame, found.ok()?);
                let last = (frame + BESIDE).min(self.frames - 1);
                for to in [frame.saturating_sub(BESIDE), last] {
                    let way = Way::begin(&anchor, to >= frame);
                    self.tasks.push_front(Task::Beside(Box::new(way), to));
                }
                Some(anchor.found.pose)
            }
        }
    }
}

/// The profiles of a component (`names`: its number and that of the frame) at a pose that is known there; none where it cannot be drawn.
fn profiles_at(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    pose: &Pose,
    (component, frame): (u8, usize),
    memory: &mut RefineMemory<'_>,
) -> Vec<FilmProfile> {
    let bare = ImageTarget {
        film: None,
        ..*image
    };
    let names = (component, u16::try_from(frame).unwrap_or(u16::MAX));
    let mut read = vec![FilmProfile::default(); profiles_of_each(1)];
    let (model, camera) = (subject.model, subject.camera);
    let count = film_profiles(model, camera, pose, &bare, names, memory, &mut read);
    read.truncate(count.unwrap_or(0));
    read
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_split_off_comes_after_the_rest() {
        let mut reading = FilmReading::new([0.0; 3], 60, 0);
        assert!(reading.split().is_none());
        for frame in [7, 20, 50] {
            reading.give(frame, Pose::IDENTITY);
        }
        let mut last = reading.split().expect("three poses");
        let mut middle = reading.split().expect("two");
        let wanted = [&mut reading, &mut middle, &mut last].map(FilmReading::wanted);
        assert_eq!(wanted, [Some(7), Some(20), Some(50)]);
        assert!(last.split().is_none());
    }

    #[test]
    fn three_poses_are_read_with_what_lies_beside_them_and_all_that_are_asked_for_as_they_are() {
        let mut reading = FilmReading::new([0.0; 3], 60, 0);
        assert_eq!(reading.wanted(), None);
        for frame in [60, 7, 20, 99, 50, 55] {
            reading.give(frame, Pose::IDENTITY);
        }
        for frame in [3, 60, 59, 4, 5, 6] {
            reading.ask(frame, Pose::IDENTITY);
        }
        let tasks: Vec<(usize, bool)> = (reading.tasks.iter())
            .filter_map(|task| match task {
                Task::At(frame, _) => Some((*frame, true)),
                Task::Just(frame, _) => Some((*frame, false)),
                Task::Beside(..) => None,
            })
            .collect();
        let just = [3, 59, 4, 5, 6].map(|frame| (frame, false));
        let at = [7, 20, 50].map(|frame| (frame, true));
        assert_eq!(tasks, [&at[..], &just].concat());
        assert_eq!(reading.wanted(), Some(7));
    }

    /// A way is asked for as far as it leads, and then what comes next.
    #[test]
    fn what_lies_beside_a_pose_is_wanted_to_both_sides_before_the_next_one() {
        use crate::follow::fake::{looked, turned};
        let mut reading = FilmReading::new([0.0; 3], 60, 0);
        let anchor = Anchor::found(7, turned(0.0, 0.3));
        for to in [1, 13] {
            let way = Way::begin(&anchor, to >= 7);
            reading.tasks.push_back(Task::Beside(Box::new(way), to));
        }
        reading.ask(40, Pose::IDENTITY);
        let mut wanted = Vec::new();
        while let Some(frame) = reading.wanted() {
            wanted.push(frame);
            match reading.tasks.front_mut() {
                Some(Task::Beside(way, _)) => {
                    way.take(frame, &looked(Ok(turned(0.0, 0.3))), &[0.0; 3])
                }
                _ => drop(reading.tasks.pop_front()),
            }
        }
        assert_eq!(wanted, [6, 5, 4, 3, 2, 1, 8, 9, 10, 11, 12, 13, 40]);
    }
}

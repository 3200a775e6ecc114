//! Pieces of work that ask for frames.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;
use core::convert::Infallible;
use core::ops::Range;

use crate::follow::cell::{Anchor, Cell};
use crate::follow::crossing::Crossing;
use crate::follow::frame_pose::{FramePose, frame_pose_at};
use crate::follow::look::{Looked, look};
use crate::follow::meeting::{have_met, join_ways};
use crate::follow::second_look::SecondLook;
use crate::follow::settle::settled;
use crate::follow::settling::Settling;
use crate::follow::subject::Subject;
use crate::follow::way::Way;
use crate::math::Vector3;
use crate::pose::Pose;
use crate::refine::{ImageTarget, RefineError, RefineMemory};

/// A piece of work.
#[derive(Clone, Debug)]
pub(super) enum Task {
    /// A pose that the caller gave is looked at in its frame.
    Given {
        frame: usize,
        pose: Pose,
        fixed: bool,
    },
    Walk(Box<Walk>),
    Span(Box<Span>),
    /// In a run of frames the component is not: the caller looks for it in the whole of one of them, or where its joint leaves it beside the
    /// other one.
    Search {
        frame: usize,
        run: Range<usize>,
        beside: Option<Pose>,
    },
    /// A pose that the caller found there is looked at in its frame.
    Found {
        frame: usize,
        pose: Pose,
        run: Range<usize>,
    },
    /// A frame is seen from the other side of the mirror too.
    BothSides(usize),
    /// A frame is looked at from starts beside its pose.
    Elsewhere(usize),
    /// A jump is crossed.
    Crossing(Box<Crossing>),
    /// A frame that stands out is looked at once more.
    Again(Box<SecondLook>),
}

impl Task {
    /// The frame that is to be looked at; `None` where it is done.
    pub(super) fn wanted(&mut self) -> Option<usize> {
        match self {
            Self::Given { frame, .. }
            | Self::Search { frame, .. }
            | Self::Found { frame, .. }
            | Self::BothSides(frame)
            | Self::Elsewhere(frame) => Some(*frame),
            Self::Again(look) => Some(look.frame),
            Self::Walk(walk) => walk.way.next(walk.to),
            Self::Span(span) => span.wanted(),
            Self::Crossing(crossing) => crossing.next(),
        }
    }

    /// Looks at the next frame of a way; gives its pose, where one was found.
    pub(super) fn go_on(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        (middle, settling): (&Vector3, &mut Settling),
        memory: &mut RefineMemory<'_>,
    ) -> Option<FramePose> {
        let (way, which, frame) = self.next()?;
        let trail = way.trail();
        let mut see = || Ok::<_, Infallible>(look(subject, image, frame, trail, memory));
        let Ok(looked) = match self {
            Self::Crossing(_) => settling.over_jump((frame, trail), see),
            _ => see(),
        };
        match self {
            Self::Walk(walk) => walk.saw(frame, looked, middle),
            Self::Span(span) => span.saw(which, frame, looked, middle),
            Self::Crossing(crossing) => {
                crossing.saw(frame, looked, (middle, subject.planes));
            }
            _ => {}
        }
        looked.found.ok()
    }

    /// The way that goes on, which of both it is in a span, and its next frame.
    fn next(&self) -> Option<(&Way, usize, usize)> {
        match self {
            Self::Walk(walk) => Some((&walk.way, 0, walk.way.next(walk.to)?)),
            Self::Span(span) => {
                let (which, frame) = span.next()?;
                Some((&span.ways[which], which, frame))
            }
            Self::Crossing(crossing) => Some((crossing.way(), 0, crossing.next()?)),
            _ => None,
        }
    }

    /// Writes what came of it.
    pub(super) fn write(self, cells: &mut [Cell]) {
        match self {
            Self::Walk(walk) => {
                for (frame, looked) in walk.seen {
                    // A pose that a person gave, in the way of the other side.
                    if let Some(cell) = cells.get_mut(frame).filter(|cell| !cell.fixed) {
                        *cell = Cell::on_the_way(looked);
                    }
                }
            }
            Self::Span(span) => span.write(cells),
            Self::Crossing(crossing) => crossing.write(cells),
            _ => {}
        }
    }
}

/// A frame with a pose that was given, and that nobody fixed: it is brought to the best of those near it once the film is known.
///
/// # Errors
/// Where the model cannot be drawn there.
pub(super) fn given(
    subject: &Subject<'_>,
    image: &ImageTarget<'_>,
    (frame, pose): (usize, &Pose),
    memory: &mut RefineMemory<'_>,
) -> Result<Anchor, RefineError> {
    let found = frame_pose_at(subject, image, pose, memory)?;
    let found = match image.film {
        None => found,
        Some(_) => settled(subject, image, &found, memory),
    };
    Ok(Anchor::found(frame, found))
}

/// From an anchor to the end of the film, or of a run of frames.
#[derive(Clone, Debug)]
pub(super) struct Walk {
    way: Way,
    to: usize,
    seen: Vec<(usize, Looked)>,
}

impl Walk {
    pub(super) fn new(from: &Anchor, to: usize) -> Self {
        Self {
            way: Way::begin(from, to >= from.frame),
            to,
            seen: Vec::new(),
        }
    }

    fn saw(&mut self, frame: usize, looked: Looked, middle: &Vector3) {
        self.way.take(frame, &looked, middle);
        self.seen.push((frame, looked));
    }
}

/// The frames between two anchors: followed from both to the middle, and over all of them from both where they do not meet
/// there.
#[derive(Clone, Debug)]
pub(super) struct Span {
    /// The first frame between.
    first: usize,
    ways: [Way; 2],
    /// What both ways saw of each frame between.
    seen: Vec<[Option<Looked>; 2]>,
    /// Both go all the way.
    apart: bool,
}

impl Span {
    /// `None` where nothing lies between them.
    pub(super) fn between(a: &Anchor, b: &Anchor) -> Option<Self> {
        let count = b
            .frame
            .checked_sub(a.frame + 1)
            .filter(|&count| count > 0)?;
        Some(Self {
            first: a.frame + 1,
            ways: [Way::begin(a, true), Way::begin(b, false)],
            seen: vec![[None; 2]; count],
            apart: false,
        })
    }

    /// Where the ways meet.
    fn middle(&self) -> usize {
        (self.first - 1 + self.first + self.seen.len()) / 2
    }

    fn ends(&self) -> [usize; 2] {
        match self.apart {
            true => [self.first + self.seen.len() - 1, self.first],
            false => [self.middle(), self.middle().max(self.first)],
        }
    }

    /// The way that goes on, and its next frame.
    fn next(&self) -> Option<(usize, usize)> {
        let ends = self.ends();
        let next = |which: usize| Some((which, self.ways[which].next(ends[which])?));
        next(0).or_else(|| next(1))
    }

    fn wanted(&mut self) -> Option<usize> {
        if self.next().is_none() && !self.apart && !self.has_met() {
            self.apart = true;
        }
        self.next().map(|(_, frame)| frame)
    }

    fn has_met(&self) -> bool {
        let seen = self.ways[1]
            .at()
            .checked_sub(self.first)
            .and_then(|at| self.seen.get(at));
        match seen {
            Some([Some(one), Some(other)]) => have_met(one, other),
            _ => false,
        }
    }

    fn saw(&mut self, which: usize, frame: usize, looked: Looked, middle: &Vector3) {
        self.ways[which].take(frame, &looked, middle);
        let seen = frame
            .checked_sub(self.first)
            .and_then(|at| self.seen.get_mut(at));
        if let Some(seen) = seen {
            seen[which] = Some(looked);
        }
    }

    fn write(self, cells: &mut [Cell]) {
        let Some(cells) = cells.get_mut(self.first..self.first + self.seen.len()) else {
            return;
        };
        if self.apart {
            join_ways(&self.seen, cells);
            return;
        }
        for (cell, [one, other]) in cells.iter_mut().zip(self.seen) {
            // Where they met the way from the second end has the word.
            *cell = other.or(one).map_or(Cell::default(), Cell::on_the_way);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::follow::fake::{looked, turned};
    use crate::follow::look::Missing;

    const MIDDLE: Vector3 = [0.0; 3];

    /// Follows a span from frame 10 to one where each way sees the part turned by so many degrees; gives the order of frames, and the cells.
    fn followed(last: usize, degs: [f64; 2]) -> (Vec<(usize, usize)>, Vec<Cell>) {
        let ends = [
            Anchor::found(10, turned(degs[0], 0.3)),
            Anchor::found(last, turned(degs[1], 0.3)),
        ];
        let mut span = Span::between(&ends[0], &ends[1]).expect("frames between");
        let mut order = Vec::new();
        while let Some(frame) = span.wanted() {
            let (which, next) = span.next().expect("wanted");
            assert_eq!(next, frame);
            order.push((which, frame));
            span.saw(which, frame, looked(Ok(turned(degs[which], 0.3))), &MIDDLE);
        }
        let mut cells = vec![Cell::default(); last + 1];
        span.write(&mut cells);
        (order, cells)
    }

    fn turns(cells: &[Cell]) -> Vec<Option<f64>> {
        let rotations = cells
            .iter()
            .map(|cell| cell.found().map(|found| found.pose.rotation));
        let deg = |rotation| crate::pose::geodesic_deg(&rotation, &turned(0.0, 0.0).pose.rotation);
        rotations.map(|one| one.map(deg).map(libm::round)).collect()
    }

    #[test]
    fn two_ways_go_to_the_middle_where_they_meet_there() {
        let (order, cells) = followed(15, [5.0, 5.5]);
        assert_eq!(order, [(0, 11), (0, 12), (1, 14), (1, 13), (1, 12)]);
        assert!(turns(&cells)[..11].iter().all(Option::is_none) && cells[15].looked.is_none());
        // Where they met the second way has the word.
        let poses = [11, 12, 13, 14].map(|frame| cells[frame].found().expect("seen").pose);
        let [first, second] = [5.0, 5.5].map(|deg| turned(deg, 0.0).pose);
        assert_eq!(poses, [first, second, second, second]);
        assert_eq!(followed(12, [5.0, 5.0]).0, [(0, 11), (1, 11)]);
    }

    #[test]
    fn two_ways_that_do_not_meet_go_over_all_frames_and_each_tells_the_other() {
        let (order, cells) = followed(15, [5.0, 25.0]);
        assert_eq!(
            order,
            [
                (0, 11),
                (0, 12),
                (1, 14),
                (1, 13),
                (1, 12),
                (0, 13),
                (0, 14),
                (1, 11)
            ]
        );
        for (frame, cell) in cells.iter().enumerate() {
            assert_eq!(
                cell.other_way.is_some(),
                (11..15).contains(&frame),
                "{frame}"
            );
        }
        let [a, b] = [10, 11].map(|frame| Anchor::found(frame, turned(0.0, 0.3)));
        assert!(
            Span::between(&a, &b).is_none()
                && Span::between(&b, &a).is_none()
                && Span::between(&a, &a).is_none()
        );
    }

    #[test]
    fn a_walk_goes_to_its_end_or_gives_up_and_leaves_what_a_person_gave() {
        for (to, frames) in [(8, &[6, 7, 8][..]), (3, &[4, 3]), (5, &[])] {
            let mut walk = Walk::new(&Anchor::found(5, turned(0.0, 0.3)), to);
            let mut seen = Vec::new();
            while let Some(frame) = walk.way.next(walk.to) {
                walk.saw(frame, looked(Ok(turned(1.0, 0.3))), &MIDDLE);
                seen.push(frame);
            }
            assert_eq!(seen, frames);
            let mut cells = vec![Cell::default(); 8];
            cells[4].fixed = true;
            Task::Walk(Box::new(walk)).write(&mut cells);
            let written = (0..8).filter(|&frame| cells[frame].looked.is_some());
            assert!(written.eq((0..8).filter(|frame| frames.contains(frame) && *frame != 4)));
        }
        let mut lost = Walk::new(&Anchor::found(5, turned(0.0, 0.3)), 90);
        let mut count = 0;
        while let Some(frame) = lost.way.next(lost.to) {
            lost.saw(frame, looked(Err(Missing::Hidden)), &MIDDLE);
            count += 1;
        }
        assert_eq!(count, 12);
    }
}

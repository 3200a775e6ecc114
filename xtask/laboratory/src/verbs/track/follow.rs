//! A component followed from anchors, frames whose pose is known, over the frames between and beside them.

use anyhow::Result;
use fluoropose::follow::{FramePose, Looked, Trail, look};
use fluoropose::pose::{Pose, geodesic_deg};
use sha2::{Digest, Sha256};

use super::part::Part;
use super::record::Record;
use super::run::Run;

/// A trail ends after so many frames without a pose: whole frames are searched from there on.
const GIVE_UP: usize = 12;
/// Two ways have come to the same pose of a frame where they are nearer than this, degrees.
const SAME_DEG: f64 = 1.0;
/// The worse of two ways that differ is no rival where its score is below this part of the better one's.
const RIVAL: f64 = 0.8;
/// What a jump of a degree costs where one way is left for the other, in scores.
const JUMP: f64 = 0.05;

/// A frame whose pose is known before it is followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Anchor {
    pub(super) frame: usize,
    pub(super) found: FramePose,
    /// Whether a person gave it: it never changes.
    pub(super) fixed: bool,
}

impl Anchor {
    /// Tells it from all others: what follows from it is done again where it changes.
    pub(super) fn mark(&self) -> String {
        let mut hash = Sha256::new();
        for number in self.found.numbers() {
            hash.update(number.to_bits().to_le_bytes());
        }
        let digest: [u8; 32] = hash.finalize().into();
        let short: String = digest[..8]
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect();
        format!("{}-{short}", self.frame)
    }
}

/// What came of a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cell {
    /// None where it was never reached.
    pub(super) looked: Option<Looked>,
    pub(super) fixed: bool,
    /// What the way from the other end came to, where it differs.
    pub(super) other_way: Option<Pose>,
}

impl Cell {
    pub(super) fn found(&self) -> Option<&FramePose> {
        self.looked.as_ref()?.found.as_ref().ok()
    }

    fn of(anchor: &Anchor) -> Self {
        Self {
            looked: Some(Looked {
                found: Ok(anchor.found),
                ordinary: true,
                searched: false,
                known: anchor.found.fit.known,
            }),
            fixed: anchor.fixed,
            other_way: None,
        }
    }
}

/// Follows a component from its anchors, which are in the order of their frames, over the frames `range`.
pub(super) fn follow(
    run: &Run<'_>,
    part: &Part<'_>,
    anchors: &[Anchor],
    range: std::ops::Range<usize>,
    cells: &mut [Cell],
) -> Result<()> {
    for anchor in anchors {
        cells[anchor.frame] = Cell::of(anchor);
    }
    let (Some(first), Some(last)) = (anchors.first(), anchors.last()) else {
        return Ok(());
    };
    let ends = || {
        rayon::join(
            || way(run, part, first, range.start),
            || way(run, part, last, range.end - 1),
        )
    };
    let between = || -> Result<Vec<Vec<(usize, Cell)>>> {
        let pairs = anchors.windows(2);
        pairs
            .map(|pair| span(run, part, &pair[0], &pair[1]))
            .collect()
    };
    let ((before, after), between) = rayon::join(ends, between);
    let alone = [before?, after?].into_iter().flat_map(Walk::cells);
    for (frame, cell) in alone.chain(between?.into_iter().flatten()) {
        cells[frame] = cell;
    }
    Ok(())
}

/// A trail on its way from an anchor.
struct Walk<'w, 's> {
    run: &'w Run<'s>,
    part: &'w Part<'s>,
    mark: String,
    trail: Trail,
    /// The next frame, where there is one.
    at: usize,
    forward: bool,
    looked: Vec<(usize, Looked)>,
}

/// What lies at most `far` frames beside an anchor, the anchor included: in the order of frames.
pub(super) fn beside(
    run: &Run<'_>,
    part: &Part<'_>,
    anchor: &Anchor,
    far: usize,
) -> Result<Vec<(usize, Pose)>> {
    let last = (anchor.frame + far).min(run.film.count() - 1);
    let (before, after) = rayon::join(
        || way(run, part, anchor, anchor.frame.saturating_sub(far)),
        || way(run, part, anchor, last),
    );
    let mut found = vec![(anchor.frame, anchor.found.pose)];
    for (frame, looked) in before?.looked.into_iter().chain(after?.looked) {
        if let Ok(one) = looked.found {
            found.push((frame, one.pose));
        }
    }
    found.sort_by_key(|&(frame, _)| frame);
    Ok(found)
}

fn way<'w, 's>(
    run: &'w Run<'s>,
    part: &'w Part<'s>,
    from: &Anchor,
    to: usize,
) -> Result<Walk<'w, 's>> {
    let mut walk = Walk {
        run,
        part,
        mark: from.mark(),
        trail: Trail::begin(from.frame, &from.found),
        at: from.frame,
        forward: to >= from.frame,
        looked: Vec::new(),
    };
    walk.on(to)?;
    Ok(walk)
}

impl Walk<'_, '_> {
    /// Goes on up to a frame, unless the trail is given up.
    fn on(&mut self, to: usize) -> Result<()> {
        let middle = self.part.middle();
        while self.at != to && self.trail.missed() < GIVE_UP {
            self.at = match self.forward {
                true => self.at + 1,
                false => self.at - 1,
            };
            let (frame, trail) = (self.at, &self.trail);
            let arrow = if self.forward { "f" } else { "b" };
            let key = format!(
                "look/{}/{}/{}/{arrow}/{frame}",
                self.part.number,
                self.part.phase(),
                self.mark
            );
            let looked: Looked = self.run.journal.step(&key, || {
                self.part
                    .see(self.run.film, frame, |subject, image, memory| {
                        look(subject, image, frame, trail, memory)
                    })
            })?;
            self.trail
                .take(frame, looked.found.as_ref().ok(), looked.ordinary, &middle);
            self.run.tell(self.part, frame, &looked);
            self.looked.push((frame, looked));
        }
        Ok(())
    }

    fn cells(self) -> impl Iterator<Item = (usize, Cell)> {
        self.looked.into_iter().map(|(frame, looked)| {
            let cell = Cell {
                looked: Some(looked),
                ..Cell::default()
            };
            (frame, cell)
        })
    }

    fn last_found(&self) -> Option<(usize, FramePose)> {
        let &(frame, looked) = self.looked.last()?;
        Some((frame, looked.found.ok()?))
    }

    fn at(&self, frame: usize) -> Option<Looked> {
        let found = self.looked.iter().find(|(at, _)| *at == frame);
        found.map(|&(_, looked)| looked)
    }
}

/// The frames between two anchors: followed from both to the middle, and over all of them from both where they do not meet
/// there.
fn span(run: &Run<'_>, part: &Part<'_>, a: &Anchor, b: &Anchor) -> Result<Vec<(usize, Cell)>> {
    if b.frame - a.frame < 2 {
        return Ok(Vec::new());
    }
    let middle = (a.frame + b.frame) / 2;
    let (forward, backward) = rayon::join(
        || way(run, part, a, middle),
        || way(run, part, b, middle.max(a.frame + 1)),
    );
    let (mut forward, mut backward) = (forward?, backward?);
    if let (Some((at, one)), Some((_, other))) = (forward.last_found(), backward.last_found())
        && at == backward.at
        && geodesic_deg(&one.pose.rotation, &other.pose.rotation) < SAME_DEG
    {
        let half = forward.cells().filter(|&(frame, _)| frame != at);
        return Ok(half.chain(backward.cells()).collect());
    }
    let (one, other) = rayon::join(|| forward.on(b.frame - 1), || backward.on(a.frame + 1));
    one?;
    other?;
    let ways: Vec<[Option<Looked>; 2]> = (a.frame + 1..b.frame)
        .map(|frame| [forward.at(frame), backward.at(frame)])
        .collect();
    let cells = cut(&ways).into_iter().enumerate();
    Ok(cells.map(|(k, cell)| (a.frame + 1 + k, cell)).collect())
}

/// Takes the frames up to one from the first way and those behind it from the second, where that is best.
fn cut(ways: &[[Option<Looked>; 2]]) -> Vec<Cell> {
    let score = |k: usize, which: usize| {
        let looked = ways[k][which].as_ref();
        let found = looked.and_then(|looked| looked.found.as_ref().ok());
        found.map_or(0.0, FramePose::score)
    };
    let pose = |k: usize, which: usize| ways[k][which]?.found.ok().map(|found| found.pose);
    let jump = |at: usize| match (
        pose(at.saturating_sub(1), 0),
        pose(at.min(ways.len() - 1), 1),
    ) {
        (Some(one), Some(other)) => JUMP * geodesic_deg(&one.rotation, &other.rotation),
        _ => 0.0,
    };
    let worth = |at: usize| {
        let first: f64 = (0..at).map(|k| score(k, 0)).sum();
        let second: f64 = (at..ways.len()).map(|k| score(k, 1)).sum();
        first + second - jump(at)
    };
    let best = (0..=ways.len()).max_by(|&a, &b| worth(a).total_cmp(&worth(b)));
    let best = best.unwrap_or(0);
    let cell = |k: usize| {
        let which = usize::from(k >= best);
        let rival = score(k, 1 - which) >= RIVAL * score(k, which);
        let apart = |a: &Pose, b: &Pose| geodesic_deg(&a.rotation, &b.rotation) >= SAME_DEG;
        let other = pose(k, 1 - which).zip(pose(k, which));
        Cell {
            looked: ways[k][which].or(ways[k][1 - which]),
            fixed: false,
            other_way: other
                .filter(|(other, own)| rival && apart(other, own))
                .map(|pair| pair.0),
        }
    };
    (0..ways.len()).map(cell).collect()
}

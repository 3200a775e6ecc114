//! A component followed from anchors, frames whose pose is known, over the frames between and beside them.

use anyhow::Result;
use fluoropose::follow::{
    Anchor, Cell, Ends, FAR, FramePose, Looked, Way, have_met, join_ways, look,
};
use sha2::{Digest, Sha256};

use super::part::Part;
use super::record::Record;
use super::run::Run;

/// Tells an anchor from all others: what follows from it is done again where it changes.
pub(super) fn mark(anchor: &Anchor) -> String {
    let mut hash = Sha256::new();
    for number in anchor.found.numbers() {
        hash.update(number.to_bits().to_le_bytes());
    }
    let digest: [u8; 32] = hash.finalize().into();
    let short: String = digest[..8]
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    format!("{}-{short}", anchor.frame)
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
        cells[anchor.frame] = Cell::from(anchor);
        run.count(part, anchor.frame);
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
    way: Way,
    forward: bool,
    looked: Vec<(usize, Looked)>,
}

/// The first and the last of the frames near an anchor in which the component is followed from there.
pub(super) fn ends_beside(run: &Run<'_>, part: &Part<'_>, anchor: &Anchor) -> Result<Ends> {
    let last = (anchor.frame + FAR).min(run.film.count() - 1);
    let (before, after) = rayon::join(
        || way(run, part, anchor, anchor.frame.saturating_sub(FAR)),
        || way(run, part, anchor, last),
    );
    let end = |walk: Walk<'_, '_>| {
        let found = |(frame, looked): &(usize, Looked)| Some((*frame, looked.found.ok()?.pose));
        walk.looked.iter().rev().find_map(found)
    };
    Ok([end(before?), end(after?)])
}

/// What following from an anchor comes to in a frame; `None` where the component is lost on the way there.
pub(super) fn followed_to(
    run: &Run<'_>,
    part: &Part<'_>,
    from: &Anchor,
    frame: usize,
) -> Result<Option<FramePose>> {
    if frame == from.frame {
        return Ok(Some(from.found));
    }
    let walk = way(run, part, from, frame)?;
    Ok(walk.at(frame).and_then(|looked| looked.found.ok()))
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
        mark: mark(from),
        way: Way::begin(from, to >= from.frame),
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
        while let Some(frame) = self.way.next(to) {
            let trail = self.way.trail();
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
            self.way.take(frame, &looked, &middle);
            self.run.tell(self.part, frame, &looked);
            self.looked.push((frame, looked));
        }
        Ok(())
    }

    fn cells(self) -> impl Iterator<Item = (usize, Cell)> {
        let cell = |(frame, looked)| (frame, Cell::on_the_way(looked));
        self.looked.into_iter().map(cell)
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
    let last = backward.way.at();
    if let (Some(one), Some(other)) = (forward.at(last), backward.at(last))
        && have_met(&one, &other)
    {
        let half = forward.cells().filter(|&(frame, _)| frame != last);
        return Ok(half.chain(backward.cells()).collect());
    }
    let (one, other) = rayon::join(|| forward.on(b.frame - 1), || backward.on(a.frame + 1));
    one?;
    other?;
    let ways: Vec<[Option<Looked>; 2]> = (a.frame + 1..b.frame)
        .map(|frame| [forward.at(frame), backward.at(frame)])
        .collect();
    let mut cells = vec![Cell::default(); ways.len()];
    join_ways(&ways, &mut cells);
    Ok((a.frame + 1..).zip(cells).collect())
}

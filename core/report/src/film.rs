//! The numbers of a film, frame by frame.

use fluoropose::Side;
use fluoropose::joint::JointFrame;
use fluoropose::joint::beside::Beside;
use fluoropose::joint::course::{
    FLEXION_STEP_DEG, Phase, REVERSAL_DEG, at_flexion, cycle, levels, phases,
};
use fluoropose::joint::impossible::{Impossible, impossible, origins_apart};
use fluoropose::joint::numbers::{NUMBERS, place};
use fluoropose::joint::pivot::{CondyleLine, Pivot, pivot_of_film};

/// What is told of numbers that no knee has: each kind once, with the first frame of it and how many there are. `frames`: the number
/// of each, from 1, and its numbers in the order of [`COLUMNS`](fluoropose::joint::COLUMNS), NaN for what is not known.
#[must_use]
pub fn impossibilities(frames: impl Iterator<Item = (usize, [f64; NUMBERS])>) -> Vec<String> {
    let mut kinds: Vec<(Impossible, usize, usize)> = Vec::new();
    for (number, numbers) in frames {
        let Some(wrong) = impossible(&numbers) else {
            continue;
        };
        let kind = core::mem::discriminant::<Impossible>;
        match kinds
            .iter_mut()
            .find(|(known, ..)| kind(known) == kind(&wrong))
        {
            Some((.., count)) => *count += 1,
            None => kinds.push((wrong, number, 1)),
        }
    }
    let sentence = |(wrong, first, count): (Impossible, usize, usize)| match count {
        1 => format!("frame {first}: {wrong}"),
        _ => format!("frame {first} and {} more: {wrong}", count - 1),
    };
    kinds.into_iter().map(sentence).collect()
}

/// What is told of frames whose components lie beside each other as in no knee: the first of them and how many there are, a sentence.
#[must_use]
pub fn besides(mut frames: impl Iterator<Item = (usize, Beside)>) -> Option<String> {
    let (first, told) = frames.next()?;
    Some(match frames.count() {
        0 => format!("frame {first}: {told}"),
        more => format!("frame {first} and {more} more: {told}"),
    })
}

/// Whose origins translations are of, which no table of them is understood without.
pub const ORIGINS: &str = "origins are those of the models' files, wherever they lie: translations of knees whose files have other origins cannot be compared, \
rotations and lowest points can";

/// What is told of translations that no knee has because of the files' origins: the first frame of them and how many there are, a sentence.
/// `frames`: as of [`impossibilities`].
#[must_use]
pub fn origins_told(frames: impl Iterator<Item = (usize, [f64; NUMBERS])>) -> Option<String> {
    let possible = frames.filter(|(_, numbers)| impossible(numbers).is_none());
    let far = |(frame, numbers): (usize, _)| Some((frame, origins_apart(&numbers)?));
    let far: Vec<(usize, f64)> = possible.filter_map(far).collect();
    let &(first, mm) = far.first()?;
    let more = match far.len() - 1 {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    Some(format!(
        "frame {first}{more}: a translation is {mm:.0} mm, farther than components of a knee are apart: the origin of a model's file lies far off its component. Translations \
         (field_*, gs_*, anterior_posterior_mm and those beside it) are these origins'; rotations and lowest points are free of them"
    ))
}

/// What is said of poses that come without verdicts.
pub(crate) const NO_VERDICTS: &str = "Nothing says how far the poses are to be trusted, as the table of `track`, of the page or of `pose --report` does: a frame without a doubt need not be good.";

/// A frame of a film.
#[derive(Clone, Debug, Default)]
pub struct JointRow {
    /// Its number in the film it comes from, from 1.
    pub number: usize,
    /// Its numbers; `None` where a component has no pose.
    pub joint: Option<JointFrame>,
    /// The same numbers of the filtered poses, where a filter was asked for.
    pub filtered: Option<[f64; NUMBERS]>,
    /// Whether a person has checked both poses as they are.
    pub checked: bool,
    /// Why it is doubtful; `None` where it is not.
    pub doubt: Option<String>,
    /// Why poses of it were doubtful that a person has accepted, so that they count.
    pub accepted: Option<String>,
    /// How far its components lie beside each other, where that is as in no knee.
    pub beside: Option<Beside>,
}

/// A joint in all frames of a film.
#[derive(Clone, Debug)]
pub struct JointFilm {
    /// What the study is called.
    pub name: String,
    /// Which knee.
    pub side: Side,
    /// Anterior-posterior extent of the tray's plate, mm; 0 where there is no plate.
    pub plate_depth_mm: f64,
    /// Mediolateral extent, mm.
    pub plate_width_mm: f64,
    /// The plate's border as seen from above: anterior and medial place, mm.
    pub plate_outline: Vec<[f64; 2]>,
    /// Frames a second, where they are known.
    pub frames_per_s: Option<f64>,
    /// Cutoff of the filter, Hz, where one was asked for.
    pub cutoff_hz: Option<f64>,
    /// What a reader has to know of the knee, sentences: that it may be of the other side, that a shape does not tell its front. They stand
    /// in the heading of its table.
    pub remarks: Vec<String>,
    /// Whether the poses come with what says how far each is to be trusted. Without it nobody knows which are doubtful.
    pub has_verdicts: bool,
    /// Frame by frame.
    pub rows: Vec<JointRow>,
}

/// A number at one flexion.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Mean over the phases that pass it.
    pub mean: f64,
    /// One standard deviation as carried from the poses; NaN where it is not known.
    pub deviation: f64,
    /// Phases.
    pub n: usize,
}

impl JointRow {
    /// A frame with what is known of it. Numbers that no knee has make it doubtful, whatever its poses say of themselves.
    #[must_use]
    pub fn new(number: usize, joint: Option<JointFrame>, doubt: Option<String>) -> Self {
        let wrong = joint.and_then(|joint| impossible(&joint.numbers));
        let told = wrong.map(|wrong| wrong.to_string());
        let said: Vec<String> = told.into_iter().chain(doubt).collect();
        Self {
            number,
            joint,
            doubt: (!said.is_empty()).then(|| said.join("; ")),
            ..Self::default()
        }
    }

    /// The same with components that lie beside each other as in no knee, where that is so: it is doubtful then.
    #[must_use]
    pub fn lying(mut self, beside: Option<Beside>) -> Self {
        self.beside = beside;
        if let (Some(beside), None) = (beside, &self.doubt) {
            self.doubt = Some(beside.to_string());
        }
        self
    }

    /// Whether it has numbers that a knee can have.
    pub(crate) fn is_possible(&self) -> bool {
        self.joint
            .is_some_and(|joint| impossible(&joint.numbers).is_none())
    }
}

impl JointFilm {
    /// A number in each frame; NaN where there is none.
    #[must_use]
    pub fn values(&self, number: usize) -> Vec<f64> {
        let value = |row: &JointRow| row.joint.map_or(f64::NAN, |joint| joint.numbers[number]);
        self.rows.iter().map(value).collect()
    }

    /// Its standard deviation in each frame; NaN where that is not known.
    #[must_use]
    pub fn deviations(&self, number: usize) -> Vec<f64> {
        let of = |row: &JointRow| Some(row.joint?.deviations?[number]);
        self.rows
            .iter()
            .map(|row| of(row).unwrap_or(f64::NAN))
            .collect()
    }

    /// The same numbers without those of frames that no knee can have: what is drawn.
    pub(crate) fn possible(&self, mut numbers: Vec<f64>) -> Vec<f64> {
        for (number, row) in numbers.iter_mut().zip(&self.rows) {
            if !row.is_possible() {
                *number = f64::NAN;
            }
        }
        numbers
    }

    /// How many frames have numbers that no knee can have.
    pub(crate) fn impossible(&self) -> usize {
        self.rows
            .iter()
            .filter(|row| row.joint.is_some() && !row.is_possible())
            .count()
    }

    /// What is told of numbers that no knee has; see [`impossibilities`].
    #[must_use]
    pub fn impossibilities(&self) -> Vec<String> {
        let numbers = |row: &JointRow| Some((row.number, row.joint?.numbers));
        let mut told = impossibilities(self.rows.iter().filter_map(numbers));
        let beside = |row: &JointRow| Some((row.number, row.beside?));
        told.extend(besides(self.rows.iter().filter_map(beside)));
        told
    }

    /// What is told of translations that no knee has; see [`origins_told`].
    #[must_use]
    pub fn origins_told(&self) -> Option<String> {
        let numbers = |row: &JointRow| Some((row.number, row.joint?.numbers));
        origins_told(self.rows.iter().filter_map(numbers))
    }

    /// The frames with a joint that are doubtful, and why: one without has nothing to doubt, and its reason is why it has none.
    pub fn doubts(&self) -> impl Iterator<Item = (&JointRow, &str)> {
        let joints = self.rows.iter().filter(|row| row.joint.is_some());
        joints.filter_map(|row| Some((row, row.doubt.as_deref()?)))
    }

    /// How many those are.
    #[must_use]
    pub fn doubtful(&self) -> usize {
        self.doubts().count()
    }

    /// How many frames have a pose of both components.
    #[must_use]
    pub fn posed(&self) -> usize {
        self.rows.iter().filter(|row| row.joint.is_some()).count()
    }

    /// How many of those poses a person has accepted that were doubtful.
    #[must_use]
    pub fn accepted(&self) -> usize {
        let accepted = |row: &&JointRow| row.joint.is_some() && row.accepted.is_some();
        self.rows.iter().filter(accepted).count()
    }

    /// How many frames are doubtful, in words, after the number of those that have a joint.
    #[must_use]
    pub fn doubtful_told(&self) -> String {
        let doubtful = match (self.has_verdicts, self.doubtful()) {
            (true, doubtful) => format!("{doubtful} doubtful"),
            (false, 0) => "which of them are doubtful is not known".to_owned(),
            (false, doubtful) => {
                format!(
                    "{doubtful} doubtful by their numbers alone, and of no other pose is it known"
                )
            }
        };
        match self.accepted() {
            0 => doubtful,
            some => format!("{doubtful}, {some} more that were until a person checked them"),
        }
    }

    /// What a reader has to know of the film besides its numbers: translations that the origins of the files make, poses without verdicts or
    /// accepted ones, and [`Self::remarks`]. It stands in the heading of its table.
    #[must_use]
    pub fn told(&self) -> Vec<String> {
        let told = self.origins_told().into_iter().chain(self.verdicts_told());
        told.chain(self.remarks.iter().cloned()).collect()
    }

    /// That there are no verdicts on the poses, where that is so: a sentence.
    pub(crate) fn no_verdicts_told(&self) -> Option<&'static str> {
        (!self.has_verdicts).then_some(NO_VERDICTS)
    }

    /// What a reader has to know of the verdicts on the poses: that there are none, and which a person has checked that were doubtful. Sentences.
    #[must_use]
    pub fn verdicts_told(&self) -> Vec<String> {
        let mut told: Vec<String> = Vec::new();
        told.extend(self.no_verdicts_told().map(str::to_owned));
        let frames = self.rows.iter().filter_map(|row| {
            let accepted = row.accepted.as_deref()?;
            Some(format!("{} ({accepted})", row.number))
        });
        let frames: Vec<String> = frames.collect();
        if !frames.is_empty() {
            told.push(format!(
                "Frames with poses that were doubtful until a person checked them: {}.",
                frames.join(", ")
            ));
        }
        told
    }

    /// The same numbers without those of doubtful frames: what steps, phases and centre are made from.
    pub(crate) fn trusted(&self, mut numbers: Vec<f64>) -> Vec<f64> {
        for (number, row) in numbers.iter_mut().zip(&self.rows) {
            if row.doubt.is_some() {
                *number = f64::NAN;
            }
        }
        numbers
    }

    /// A number from its first to its last frame at 0 to 100 percent, 101 points, linear between frames; NaN beside missing ones.
    #[must_use]
    pub fn cycle(&self, number: usize) -> Vec<f64> {
        let places: Vec<f64> = self.rows.iter().map(|row| row.number as f64).collect();
        let values = self.values(number);
        let known = |index: &usize| values[*index].is_finite();
        let first = (0..values.len()).find(known).unwrap_or(0);
        let last = (0..values.len()).rev().find(known).unwrap_or(0);
        let end = |index: usize| places.get(index).copied().unwrap_or(f64::NAN);
        cycle(&places, &values, end(first), end(last)).to_vec()
    }

    /// Whether any frame has standard deviations.
    #[must_use]
    pub fn has_deviations(&self) -> bool {
        let known = |row: &JointRow| row.joint.is_some_and(|joint| joint.deviations.is_some());
        self.rows.iter().any(known)
    }

    /// Whether there is a tray's plate that lowest points lie above.
    #[must_use]
    pub fn has_plate(&self) -> bool {
        self.plate_depth_mm > 0.0 && self.plate_width_mm > 0.0
    }

    /// The monotonic phases of the activity, without doubtful frames.
    #[must_use]
    pub fn phases(&self) -> Vec<Phase> {
        let flexion = self.trusted(self.values(place::FLEXION));
        let mut room = vec![Phase::default(); flexion.len()];
        // There is room for as many as frames.
        phases(&flexion, REVERSAL_DEG, &mut room).map_or(Vec::new(), <[Phase]>::to_vec)
    }

    /// The flexions at which numbers are published: steps that a phase passes. A film that jumps over some has no rows for them.
    #[must_use]
    pub fn levels(&self) -> Vec<f64> {
        let phases = self.phases();
        let passed = |&level: &f64| self.at(place::FLEXION, &phases, level).n > 0;
        levels(&self.trusted(self.values(place::FLEXION)), FLEXION_STEP_DEG)
            .filter(passed)
            .collect()
    }

    /// A number at one flexion.
    #[must_use]
    pub fn at(&self, number: usize, phases: &[Phase], level_deg: f64) -> Step {
        let flexion = self.values(place::FLEXION);
        let bin = at_flexion(&flexion, &self.values(number), phases, level_deg);
        let carried = at_flexion(&flexion, &self.deviations(number), phases, level_deg);
        Step {
            mean: bin.mean,
            deviation: carried.mean,
            n: bin.n,
        }
    }

    /// The centre of rotation over all frames that are not doubtful.
    #[must_use]
    pub fn pivot(&self) -> Option<Pivot> {
        let trusted = self.rows.iter().filter(|row| row.doubt.is_none());
        let joints = trusted.filter_map(|row| row.joint);
        pivot_of_film(|error| {
            joints.clone().map(
                move |JointFrame {
                          mut numbers,
                          shared,
                          ..
                      }| {
                    if let Some(error) = error {
                        let moved = numbers.iter_mut().zip(shared[error]);
                        moved.for_each(|(number, by)| *number += by);
                    }
                    line(&numbers)
                },
            )
        })
    }
}

/// The condyle line of a frame's numbers.
pub(crate) fn line(numbers: &[f64; NUMBERS]) -> CondyleLine {
    CondyleLine {
        medial: [numbers[place::MEDIAL_AP], numbers[place::MEDIAL_ACROSS]],
        lateral: [numbers[place::LATERAL_AP], numbers[place::LATERAL_ACROSS]],
    }
}

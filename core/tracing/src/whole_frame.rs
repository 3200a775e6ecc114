//! A component looked for in a whole frame, where nobody points at it: clicks at the places that [`shapes`] gives, nearly all of which lead to
//! what is sought where it shows, and at those of [`seeds`], most of which lead nowhere and are soon given up.

use fluoropose::camera::Camera;
use fluoropose::finder::Component;
use fluoropose::follow::{FramePose, From, Places, Subject, refined_on_frame};
use fluoropose::image::contour::Point;
use fluoropose::image::mask::Word;
use fluoropose::image::shuttered::Shuttered;
use fluoropose::math::{Vector3, norm, sqrt, subtract};
use fluoropose::memory::TooLittleMemory;
use fluoropose::pose::{Pose, geodesic_deg};
use fluoropose::refine::{ImageTarget, RefineError, RefineMemory};
use heapless::Vec;

use crate::one_click::{
    Answer, Observation, OneClick, OneClickError, OneClickMemory, OneClickNeeds, Progress, Prompt,
};
use crate::reduced::{ReducedMemory, ReducedPixels, Reduction};
use crate::seeds::{SEEDS, expected_size, seeds};
use crate::shapes::{SHAPES, ShapeMemory, shapes};
use crate::surround::surround;

/// Most places that are tried.
const PLACES: usize = 1 + SHAPES + SEEDS;
/// Of places that are merely dark so many are tried, those whose regions look most like the component: where they lie all are looked at in
/// passing, which takes about such a part of what it takes to try one.
const TRIED: usize = 4;
const PASSING: f64 = 0.15;
/// Of the answers to a click so many are refined once more and compared.
const ANSWERS: usize = 4;
/// What is asked of a pose that nobody pointed at.
struct Demands {
    /// A place is left where its best answer has a smaller score than this before poses around it are tried.
    worth_much: f64,
    /// The least score of the pose ([`FramePose::score`]), and the least part of its outline that is met. An answer's own score
    /// is a part of the sharpest border near the place, which may be that of the field.
    score: f64,
    met: f64,
    /// What may remain between the outline and its edges, pixels.
    most_px: f64,
}

/// Where it may be anything, and where it lies beside the other component of its joint, which hides and outshines it.
const ALONE: Demands = Demands {
    worth_much: 0.45,
    score: 0.45,
    met: 0.9,
    most_px: 0.7,
};
const BESIDE: Demands = Demands {
    worth_much: 0.3,
    score: 0.38,
    met: 0.7,
    most_px: 1.5,
};
/// The middles of two components of a joint are at most so far apart, mm: across the view, and along it.
const ACROSS_MM: f64 = 90.0;
const ALONG_MM: f64 = 60.0;
/// So much of it is seen.
const LEAST_KNOWN: f64 = 0.7;
/// A place is left where its best answer has a smaller score than this before its surroundings are searched once more; how far
/// the work is then, and before poses around the best answer are tried.
const WORTH: f64 = 0.2;
const AGAIN: f64 = 0.575;
const AROUND: f64 = 0.655;
/// Better ones are not looked for beyond this score, nor where clicks at two places lead to one pose: so near to each other,
/// degrees, and parts of its distance.
const ENOUGH: f64 = 0.55;
const ONE_DEG: f64 = 1.0;
const ONE_PART: f64 = 0.01;
/// What a reduced frame leads to is not farther from what the frame itself makes of it.
const NEAR_DEG: f64 = 5.0;
const NEAR_PART: f64 = 0.05;

/// Where a component was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Discovery {
    /// A click there leads to it.
    pub place: Point,
    /// The pose, and what the frame says of it.
    pub pose: FramePose,
}

/// Working memory of [`WholeFrame::new`].
#[derive(Debug)]
pub struct PlacesMemory<'m> {
    /// [`crate::seeds::seeds_needed`] numbers.
    pub sums: &'m mut [f64],
    /// As [`crate::shapes::shapes_needed`] says.
    pub shapes: ShapeMemory<'m>,
    /// As [`crate::reduced::reduced_needed`] says; what is written into it each step reads.
    pub reduced: ReducedMemory<'m>,
    /// As many as [`fluoropose::image::mask::words_needed`] says for a mask of the frame's size; each step reads them too.
    pub surround: &'m mut [Word],
}

/// What [`WholeFrame::new`] wrote for its steps.
#[derive(Clone, Copy, Debug)]
pub struct Written<'m> {
    /// The frame, reduced.
    pub reduced: ReducedPixels<'m>,
    /// A mask of what is not of the picture, of the frame's size: only where a surround was found.
    pub surround: &'m [Word],
}

/// The search of a frame, in steps between which it can be called off.
#[derive(Debug)]
pub struct WholeFrame {
    /// Middle of the joint's other component, where that is known.
    beside: Option<Vector3>,
    /// Places, with the score of the best first pose of those that were looked at in passing.
    places: Vec<(Point, f64), PLACES>,
    /// So many of them were given by their shape, and come first.
    shaped: usize,
    /// Whether places are looked at in passing, to choose among them; and of how many that was done.
    in_passing: bool,
    passed: usize,
    /// Number of the place that is tried.
    at: usize,
    click: Option<OneClick>,
    found: Option<Discovery>,
    /// Whether clicks at two places led there.
    agreed: bool,
    /// By how much the frame is reduced where places are tried.
    reduction: Reduction,
    /// Whether it has a surround, and how many words its mask takes.
    surround: Option<usize>,
}

impl WholeFrame {
    /// Begins the search of a frame at some places; nothing is looked for where its pixels are unknown. Where the joint's other component is
    /// known, `beside` its middle (mm, in the camera's frame) less is asked of an answer, and only there.
    ///
    /// # Errors
    /// [`TooLittleMemory`] where there is less than [`PlacesMemory`] says.
    pub fn new(
        image: &ImageTarget<'_>,
        component: &Component<'_>,
        camera: &Camera,
        (places, beside): (Places, Option<Vector3>),
        memory: &mut PlacesMemory<'_>,
    ) -> Result<Self, TooLittleMemory> {
        let is_near = |place: &Point| {
            beside.is_none_or(|middle| distance_mm(place, &middle, camera) <= ACROSS_MM)
        };
        let at = (places, is_near, None);
        Self::at(image, component, camera, at, memory).map(|mut search| {
            search.beside = beside;
            search.begin(component);
            search
        })
    }

    /// Begins where somebody clicked and that led to nothing that convinces: there once more, for in a reduced frame other regions hold the
    /// place, and at places of the frame whose shape is the component's and that lie no farther off than it is large.
    ///
    /// # Errors
    /// As of [`Self::new`].
    pub fn near(
        image: &ImageTarget<'_>,
        component: &Component<'_>,
        camera: &Camera,
        click: Point,
        memory: &mut PlacesMemory<'_>,
    ) -> Result<Self, TooLittleMemory> {
        let size = expected_size(component, camera);
        let is_near = |place: &Point| {
            let off = [place.column - click.column, place.row - click.row];
            sqrt(off[0] * off[0] + off[1] * off[1]) <= size
        };
        let at = (Places::Shaped, is_near, Some(click));
        Self::at(image, component, camera, at, memory).map(|mut search| {
            search.begin(component);
            search
        })
    }

    /// Places of those that are kept, behind the `first` one; nothing has begun there yet.
    fn at(
        image: &ImageTarget<'_>,
        component: &Component<'_>,
        camera: &Camera,
        (places, is_kept, first): (Places, impl Fn(&Point) -> bool, Option<Point>),
        memory: &mut PlacesMemory<'_>,
    ) -> Result<Self, TooLittleMemory> {
        let size = expected_size(component, camera);
        // An implant in nothing but air may lie before what is taken for a surround: other places are looked for in the frame as it is.
        let surround = match places {
            Places::Shaped => surround(image, memory.surround)?,
            Places::Dark | Places::All => None,
        };
        let image = &ImageTarget {
            unknown: surround.as_ref().or(image.unknown),
            ..*image
        };
        let listed = |place: Point| (place, 0.0);
        let mut all: Vec<_, PLACES> = first.into_iter().map(listed).collect();
        if places != Places::Dark {
            let shaped = shapes(image, component, camera, size, &mut memory.shapes)?;
            all.extend(shaped.into_iter().filter(&is_kept).map(listed));
        }
        let shaped = all.len();
        if places != Places::Shaped {
            let dark = seeds(image, camera, size, memory.sums)?;
            all.extend(dark.into_iter().filter(&is_kept).map(listed));
        }
        let search = Self {
            beside: None,
            places: all,
            shaped,
            in_passing: false,
            passed: 0,
            at: 0,
            click: None,
            found: None,
            agreed: false,
            reduction: Reduction::of(size, camera),
            surround: surround.map(|mask| mask.words().len()),
        };
        if search.reduction.is_any() && !search.places.is_empty() {
            search.reduction.write(image, &mut memory.reduced)?;
        }
        Ok(search)
    }

    /// Lengths of the memory that the next [`Self::step`] borrows; `None` where nothing is left to do.
    #[must_use]
    pub fn needs(&self) -> Option<OneClickNeeds> {
        Some(self.click.as_ref()?.needs(self.reduction.camera()))
    }

    /// The part of the work that is done, 0 to 1.
    #[must_use]
    pub fn progress(&self) -> f64 {
        let of_click = match self.click.as_ref().map(OneClick::progress) {
            None => return 1.0,
            Some(Progress::Regions(part) | Progress::Poses(part)) => part,
            Some(Progress::Done) => 1.0,
        };
        self.part_done(of_click)
    }

    /// The same with such a part of the click in hand done: to look in passing is a part of the whole, and of what is looked at so few are tried.
    fn part_done(&self, of_click: f64) -> f64 {
        let dark = self.places.len() - self.shaped;
        let passing = PASSING * if dark > TRIED { dark } else { self.passed } as f64;
        let all = (self.shaped + dark.min(TRIED)) as f64 + passing;
        let done = match (self.in_passing, self.at < self.shaped) {
            (true, _) => self.shaped as f64 + PASSING * (self.at - self.shaped) as f64,
            (false, true) => self.at as f64 + of_click,
            (false, false) => self.at as f64 + of_click + passing,
        };
        done / all.max(1.0)
    }

    /// The best that was found so far, where it is good.
    #[must_use]
    pub fn found(&self) -> Option<&Discovery> {
        self.found.as_ref()
    }

    /// The next part of the work, with what [`Self::new`] wrote. Returns whether there is more to do.
    ///
    /// # Errors
    /// Where memory is too short.
    pub fn step(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
        written: Written<'_>,
    ) -> Result<bool, OneClickError> {
        let reduction = self.reduction;
        if let Some(words) = self.surround.filter(|_| !reduction.is_any()) {
            let behind = written.surround.get(..words).unwrap_or_default();
            let frame = Shuttered::new(image.frame, behind)?;
            let seen = ImageTarget {
                frame: &frame,
                ..*image
            };
            return self.try_place(subject, [image, &seen], component, memory);
        }
        if !reduction.is_any() {
            return self.try_place(subject, [image, image], component, memory);
        }
        // What is known of the film is in pixels, and a pixel that is unknown is none of the reduced frame.
        let reduced = reduction.frame(written.reduced)?;
        let seen = ImageTarget {
            frame: &reduced,
            unknown: None,
            film: None,
            ..*image
        };
        self.try_place(subject, [image, &seen], component, memory)
    }

    /// The next part of a click into a frame, as it is `seen`.
    fn try_place(
        &mut self,
        subject: &Subject<'_>,
        [image, seen]: [&ImageTarget<'_>; 2],
        component: &Component<'_>,
        memory: &mut OneClickMemory<'_>,
    ) -> Result<bool, OneClickError> {
        let Some(click) = &mut self.click else {
            return Ok(false);
        };
        let observation = Observation {
            frame: seen.frame,
            camera: self.reduction.camera(),
            polarity: seen.polarity,
            excluded: seen.unknown,
            beside: None,
            film: None,
        };
        let step = click.step(&observation, Some(component), memory);
        let has_more = matches!(step, Ok(true));
        if self.in_passing {
            let is_seen = !has_more || matches!(click.progress(), Progress::Poses(_));
            if !is_seen {
                return Ok(true);
            }
            let best = click.starts().first().map_or(0.0, |start| start.score);
            if let Some((_, score)) = self.places.get_mut(self.at) {
                *score = best;
            }
        } else if has_more && is_worth_it(click, self.beside, subject) {
            return Ok(true);
        } else if step.is_ok() {
            self.compare(subject, [image, seen], &mut memory.refine);
        }
        // A click may lead nowhere.
        if let Err(
            OneClickError::Memory(error) | OneClickError::Refine(RefineError::Memory(error)),
        ) = step
        {
            return Err(error.into());
        }
        self.at += 1;
        self.click = None;
        let is_enough = |found: &Discovery| found.pose.score() >= ENOUGH;
        if !self.agreed && !self.found.as_ref().is_some_and(is_enough) {
            self.begin(component);
        }
        Ok(self.click.is_some())
    }

    /// The click at the next place that has room for one.
    fn begin(&mut self, component: &Component<'_>) {
        loop {
            if self.at == self.shaped && self.places.len() > self.shaped + TRIED {
                self.in_passing = true;
            }
            if self.in_passing && self.at >= self.places.len() {
                self.keep_the_likeliest();
            }
            let Some(&(place, _)) = self.places.get(self.at) else {
                return;
            };
            let prompt = Prompt::Click(self.reduction.reduced(place));
            self.click = OneClick::new(prompt, self.reduction.camera(), Some(component)).ok();
            if self.click.is_some() {
                return;
            }
            self.at += 1;
        }
    }

    /// Leaves of the places that were looked at in passing those to be tried.
    fn keep_the_likeliest(&mut self) {
        let seen = self.places.get_mut(self.shaped..).unwrap_or_default();
        seen.sort_unstable_by(|one, other| other.1.total_cmp(&one.1));
        self.passed = seen.len();
        self.places.truncate(self.shaped + TRIED);
        (self.at, self.in_passing) = (self.shaped, false);
    }

    /// Takes the best of a click's answers, refined once more, where it is good and better than what there is.
    fn compare(
        &mut self,
        subject: &Subject<'_>,
        [image, seen]: [&ImageTarget<'_>; 2],
        memory: &mut RefineMemory<'_>,
    ) {
        let (answers, demands) = (self.click.as_ref(), demands(self.beside));
        let answers = answers.map_or(&[][..], OneClick::answers);
        let possible = |answer: &&Answer| is_beside(answer, self.beside, subject);
        let from_afar = Subject {
            camera: self.reduction.camera(),
            ..*subject
        };
        let mut best: Option<FramePose> = None;
        for answer in answers.iter().filter(possible).take(ANSWERS) {
            let start = (&answer.refined.pose, From::Far);
            let Ok(one) = refined_on_frame(&from_afar, seen, start, memory) else {
                continue;
            };
            if best.is_none_or(|best| one.score() > best.score()) {
                best = Some(one);
            }
        }
        let (Some(best), Some(place)) = (
            best.filter(|one| is_good(one, demands)),
            self.places.get(self.at).map(|&(place, _)| place),
        ) else {
            return;
        };
        // Where refinement ends depends a little on where it began: less so the second time, from the same answer by another click.
        let again = refined_on_frame(subject, image, (&best.pose, From::Far), memory).ok();
        let pose = match self.reduction.is_any() {
            false => again
                .filter(|again| is_good(again, demands))
                .unwrap_or(best),
            // What is good was asked of the reduced frame, for it is asked in pixels; the frame itself only makes it exact.
            true => {
                match again.filter(|again| is_near(&again.pose, &best.pose, NEAR_DEG, NEAR_PART)) {
                    Some(again) => again,
                    None => return,
                }
            }
        };
        self.agreed = self
            .found
            .is_some_and(|found| is_near(&found.pose.pose, &pose.pose, ONE_DEG, ONE_PART));
        let is_better = |found: &Discovery| pose.score() > found.pose.score();
        if self.found.as_ref().is_none_or(is_better) {
            self.found = Some(Discovery { place, pose });
        }
    }
}

fn is_near(one: &Pose, other: &Pose, degrees: f64, part: f64) -> bool {
    let off = norm(&subtract(&one.translation, &other.translation));
    geodesic_deg(&one.rotation, &other.rotation) <= degrees
        && off <= part * norm(&other.translation)
}

fn demands(beside: Option<Vector3>) -> &'static Demands {
    if beside.is_some() { &BESIDE } else { &ALONE }
}

/// Whether a click at a place that nobody chose is worth going on with: most lead nowhere.
fn is_worth_it(click: &OneClick, beside: Option<Vector3>, subject: &Subject<'_>) -> bool {
    let possible = |answer: &&Answer| is_beside(answer, beside, subject);
    let best = click.answers().iter().find(possible);
    let best = best.map_or(0.0, |best| best.score);
    match click.progress() {
        Progress::Poses(part) if part >= AROUND => best >= demands(beside).worth_much,
        Progress::Poses(part) if part >= AGAIN => best >= WORTH,
        _ => true,
    }
}

/// Whether an answer lies where the other component leaves it.
fn is_beside(answer: &Answer, beside: Option<Vector3>, subject: &Subject<'_>) -> bool {
    let Some(other) = beside else {
        return true;
    };
    let middle = answer
        .refined
        .pose
        .transform(&subject.model.bounds().centre);
    let [x, y, z] = core::array::from_fn(|axis| middle[axis] - other[axis]);
    x * x + y * y <= ACROSS_MM * ACROSS_MM && z.abs() <= ALONG_MM
}

/// How far a place is from a point of the camera's frame, at its distance, mm.
fn distance_mm(place: &Point, middle: &Vector3, camera: &Camera) -> f64 {
    let [fx, fy] = camera.focal();
    let Some(seen) = camera.project(middle) else {
        return f64::INFINITY;
    };
    let (x, y) = (
        (place.column - seen.column) / fx,
        (place.row - seen.row) / fy,
    );
    sqrt(x * x + y * y) * middle[2].abs()
}

fn is_good(found: &FramePose, demands: &Demands) -> bool {
    found.score() >= demands.score
        && found.fit.met >= demands.met
        && found.misfit_px <= demands.most_px
        && found.fit.known >= LEAST_KNOWN
}

#[cfg(all(test, feature = "alloc"))]
mod tests;

//! An implant that is looked for, frame after frame, in memory that was borrowed once.

use core::task::Poll;

use fluoropose::film::LineMemory;
use fluoropose::finder::choice::ChoiceContext;
use fluoropose::finder::{Decision, FindError, FrameSearch, Wanted};
use fluoropose::image::crop::Crop;
use fluoropose::image::mask::{MaskError, Word};
use fluoropose::image::runs::{PixelRun, RunBuilder};
use fluoropose::implant::{ArenaNeeds, ImplantFile};
use fluoropose::locate::partial::PartialMemory;
use fluoropose::refine::{BorderPixel, RefineError};
use fluoropose::render::Projected;
use fluoropose::search::kernels::Kernels;
use fluoropose::{
    Camera, FinderMemory, Found, Goal, Mask, Outline, Point, Pose, RefineMemory, RefineOptions,
    Silhouette, Workspace,
};

use crate::block::{Block, units_for};
use crate::failure::Failure;
use crate::layouts::{CandidateNumbers, FoundNumbers, Room};

/// An implant, a camera, and all that is worked in.
pub struct Session<'m> {
    implant: ImplantFile<'m>,
    camera: Camera,
    room: Room,
    memory: FinderMemory<'m>,
    words: &'m mut [Word],
    runs: RunBuilder<'m>,
    seen: Seen,
    search: &'m mut FrameSearch,
    /// Whether it was begun and has not ended.
    searches: bool,
    found: &'m mut Found,
    decision: Option<Decision>,
}

/// What is known of the frame.
#[derive(Clone, Copy)]
enum Seen {
    Nothing,
    /// Rows come.
    Rows,
    /// The silhouette in a part of it, whose pixels are in memory.
    Part(Crop),
}

/// How far a rotation that comes from C may be from one: numbers of single precision are.
const RIGID: f64 = 1e-5;

/// Crossings of all rows that memory is reckoned for: 32 bits hold what follows from them.
const CROSSINGS: usize = 1 << 26;

/// Units of memory that a session of an implant takes; `None` for a room that no frame has.
pub(crate) fn units_needed(implant: &ImplantFile<'_>, room: &Room) -> Option<usize> {
    let needs = needs(implant, room)?;
    let masks = units_for::<Word>(needs.words)?.checked_mul(2)?;
    let canonical = units_for::<Word>(needs.canonical)?.checked_mul(2)?;
    [
        masks,
        canonical,
        units_for::<u32>(needs.scores)?,
        units_for::<u8>(needs.bytes)?,
        units_for::<Projected>(needs.projected)?,
        units_for::<u16>(needs.places)?,
        units_for::<BorderPixel>(room.border as usize)?,
        units_for::<PixelRun>(room.runs as usize)?,
        units_for::<FrameSearch>(1)?,
        units_for::<Found>(1)?,
    ]
    .into_iter()
    .try_fold(0usize, usize::checked_add)
}

fn needs(implant: &ImplantFile<'_>, room: &Room) -> Option<ArenaNeeds> {
    let (columns, rows) = (room.columns as usize, room.rows as usize);
    Crop::whole(columns, rows).ok()?;
    let crossings = rows.checked_mul(implant.contour_needs().crossings_a_row)?;
    let needs = || ArenaNeeds::of(implant.bytes(), columns, rows);
    (crossings < CROSSINGS).then(needs)
}

impl<'m> Session<'m> {
    /// An implant that is looked for with the camera of its library, until another is set.
    ///
    /// # Errors
    /// [`Failure::Memory`] where `memory` is too short for `room`.
    pub(crate) fn new(
        implant: ImplantFile<'m>,
        room: &Room,
        mut block: Block<'m>,
    ) -> Result<Self, Failure> {
        let camera = implant.library().info().camera;
        let needs = needs(&implant, room).ok_or(Failure::Memory)?;
        let runs = block.take(room.runs as usize, PixelRun::EMPTY);
        let words = block.take(needs.words, 0);
        let memory = finder_memory(&mut block, &needs, room);
        // Both are long: where they stand they stay.
        let (search, found) = (block.put(FrameSearch::new), block.put(|| Found::NOTHING));
        Ok(Self {
            runs: RunBuilder::new(
                runs.ok_or(Failure::Memory)?,
                camera.width(),
                camera.height(),
            )?,
            words: words.ok_or(Failure::Memory)?,
            memory: memory.ok_or(Failure::Memory)?,
            implant,
            camera,
            room: *room,
            seen: Seen::Nothing,
            search: search.ok_or(Failure::Memory)?,
            searches: false,
            found: found.ok_or(Failure::Memory)?,
            decision: None,
        })
    }

    /// The camera that frames are looked at with.
    #[must_use]
    pub fn camera(&self) -> Camera {
        self.camera
    }

    /// Looks at frames of another camera from now on.
    pub fn set_camera(&mut self, camera: Camera) {
        self.camera = camera;
        self.forget();
    }

    fn forget(&mut self) {
        self.searches = false;
        self.seen = Seen::Nothing;
        self.decision = None;
    }

    /// Takes an outline of the next frame.
    ///
    /// # Errors
    /// [`Failure`] for points that are none, or more of the frame than there is memory for.
    pub fn outline(&mut self, points: &[Point]) -> Result<(), Failure> {
        self.forget();
        let frame = [self.camera.width(), self.camera.height()];
        let outline = Outline::new(points, frame[0], frame[1])?;
        let crop = Crop::around_outline(&outline, Crop::MARGIN, frame)?;
        fits(&crop, &self.room)?;
        let mask = crop.fill_outline(&outline, self.words)?;
        if mask.area() == 0 {
            return Err(MaskError::Empty.into());
        }
        self.seen = Seen::Part(crop);
        Ok(())
    }

    /// Rows of the next frame's silhouette come.
    ///
    /// # Errors
    /// None, of a camera that was set.
    pub fn begin_rows(&mut self) -> Result<(), Failure> {
        self.forget();
        self.runs
            .restart(self.camera.width(), self.camera.height())?;
        self.seen = Seen::Rows;
        Ok(())
    }

    /// Adds a row, a byte a pixel from the left: what is not 0 is the silhouette.
    ///
    /// # Errors
    /// [`Failure::Order`] before [`Self::begin_rows`]; [`Failure::Width`] and [`Failure::Rows`] for rows that are not as wide as the frame, do not
    /// rise, reach beyond it or have more runs than there is memory for: the silhouette is lost then.
    pub fn row(&mut self, row: usize, pixels: &[u8]) -> Result<(), Failure> {
        // A search is given up, as by all that is said of a frame.
        self.searches = false;
        if !matches!(self.seen, Seen::Rows) {
            return Err(Failure::Order);
        }
        let (width, wanted) = (pixels.len(), self.camera.width());
        let added = match width == wanted {
            true => {
                let inside = pixels.iter().map(|&pixel| pixel != 0);
                self.runs.add_row(row, inside).map_err(Failure::from)
            }
            false => Err(Failure::Width { width, wanted }),
        };
        if added.is_err() {
            self.forget();
        }
        added
    }

    /// The search for the silhouette that was taken begins at a pose that is known, which left `misfit_px` pixels on the frame before; see
    /// [`FrameSearch::restart_near`]. One that was begun is given up.
    ///
    /// # Errors
    /// [`Failure::Order`] before a silhouette; [`Failure::Near`] for what is no pose.
    pub fn near(&mut self, pose: &Pose, misfit_px: f64) -> Result<(), Failure> {
        (self.searches, self.decision) = (false, None);
        if let Seen::Nothing = self.seen {
            return Err(Failure::Order);
        }
        if !pose.is_rigid(RIGID) || misfit_px.is_nan() || misfit_px < 0.0 {
            return Err(Failure::Near);
        }
        self.search.restart_near(pose, misfit_px);
        self.searches = true;
        Ok(())
    }

    /// Finds the poses that explain the silhouette, chooses among them and judges the choice: so many slices of it, which begin
    /// the search where it was not begun.
    ///
    /// # Errors
    /// [`Failure`]; the search has ended then.
    pub fn go_on(&mut self, slices: u32) -> Poll<Result<(), Failure>> {
        if !self.searches {
            self.search.restart();
            (self.searches, self.decision) = (true, None);
        }
        let done = self.search_on(slices);
        self.searches = done.is_pending();
        done
    }

    fn search_on(&mut self, slices: u32) -> Poll<Result<(), Failure>> {
        let crop = self.part()?;
        let words = self.words.get(..crop.words_needed()).unwrap_or_default();
        let mask = Mask::new(words, crop.width(), crop.height())?;
        let silhouette = Silhouette::from(&mask).in_crop(&crop)?;
        let camera = self.camera.cropped(&crop)?;
        let component = self.implant.component();
        let (memory, found) = (&mut self.memory, &mut *self.found);
        let wanted = Wanted {
            component: &component,
            camera: &camera,
            silhouette: &silhouette,
            goal: Goal::Outline,
            options: RefineOptions::default(),
        };
        for _ in 0..slices {
            if let Poll::Ready(done) = self.search.go_on(&wanted, memory, found) {
                done.map_err(too_long)?;
                self.decision = found.decide(&ChoiceContext::default());
                return Poll::Ready(Ok(()));
            }
        }
        Poll::Pending
    }

    /// The part of the frame with the silhouette, whose pixels are in memory then.
    fn part(&mut self) -> Result<Crop, Failure> {
        let crop = match self.seen {
            Seen::Nothing => return Err(Failure::Order),
            Seen::Part(crop) => return Ok(crop),
            Seen::Rows => {
                let runs = self.runs.runs();
                let crop = runs.crop(Crop::MARGIN)?;
                fits(&crop, &self.room)?;
                runs.draw(&crop, self.words)?;
                crop
            }
        };
        self.seen = Seen::Part(crop);
        Ok(crop)
    }

    /// What was found, and the decision.
    ///
    /// # Errors
    /// [`Failure::Order`] where nothing was.
    pub fn decision(&self) -> Result<(FoundNumbers, &Decision), Failure> {
        match (&self.decision, self.seen) {
            (Some(decision), Seen::Part(crop)) => {
                let count = self.found.candidates.len();
                Ok((FoundNumbers::of(count, decision, &crop), decision))
            }
            _ => Err(Failure::Order),
        }
    }

    /// One of the poses that explain the silhouette, the best is number 0.
    ///
    /// # Errors
    /// [`Failure::Order`] where there are not so many.
    pub fn candidate(&self, number: usize) -> Result<CandidateNumbers, Failure> {
        self.decision()?;
        let candidate = self.found.candidates.get(number);
        candidate.map(CandidateNumbers::from).ok_or(Failure::Order)
    }
}

/// Whether there is room for a silhouette and what is around it: its words might do where it is narrow and high, and others would not.
fn fits(crop: &Crop, room: &Room) -> Result<(), Failure> {
    let sides = [
        ("columns", crop.width(), room.columns as usize),
        ("rows", crop.height(), room.rows as usize),
    ];
    match sides.into_iter().find(|(_, needed, given)| needed > given) {
        Some((what, needed, given)) => Err(Failure::Room {
            what,
            needed,
            given,
        }),
        None => Ok(()),
    }
}

/// Of the memory that a refinement works in nothing but that of outlines can be too short: the rest follows from columns and rows.
fn too_long(error: FindError) -> Failure {
    match error {
        FindError::Refine(RefineError::Memory(lack)) => Failure::Room {
            what: "pixels of border",
            needed: lack.needed,
            given: lack.given,
        },
        other => other.into(),
    }
}

fn finder_memory<'m>(
    block: &mut Block<'m>,
    needs: &ArenaNeeds,
    room: &Room,
) -> Option<FinderMemory<'m>> {
    Some(FinderMemory {
        workspace: Workspace {
            canonical: block.take(needs.canonical, 0)?,
            rotated: block.take(needs.canonical, 0)?,
            scores: block.take(needs.scores, 0)?,
            bytes: block.take(needs.bytes, 0)?,
            kernels: Kernels::PORTABLE,
        },
        partial: PartialMemory::default(),
        refine: RefineMemory {
            projected: block.take(needs.projected, Projected::ZERO)?,
            drawn: block.take(needs.words, 0)?,
            places: block.take(needs.places, 0)?,
            border: block.take(room.border as usize, BorderPixel::EMPTY)?,
            film: LineMemory::default(),
        },
    })
}

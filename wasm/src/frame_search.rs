//! A component looked for in frames where nobody points at it: in a whole frame, or where its joint leaves it beside the other one.

mod clicked;
mod other;
mod walk;

use fluoropose::camera::Camera;
use fluoropose::camera::calibration::Calibration;
use fluoropose::film::FilmModel;
use fluoropose::finder::{Component, FinderBuffers};
use fluoropose::follow::{FramePose, InJoint, JointSearch, Places, Subject};
use fluoropose::math::Vector3;
use fluoropose::mesh::OwnedModel;
use fluoropose::mesh::anatomy::KneeComponent;
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::pose::{EulerPose, Pose};
use fluoropose::refine::{ImageTarget, Polarity, RefineBuffers, RefineMemory, polarity_at};
use fluoropose::search::kernels::Kernels;
use fluoropose_tracing::PlacesBuffers;
use fluoropose_tracing::one_click::OneClickBuffers;
use fluoropose_tracing::whole_frame::{WholeFrame, Written};
use wasm_bindgen::prelude::*;

use self::other::{Beside, Other};
use self::walk::Walk;
use crate::film::film_model;
use crate::hidden::with_mask;
use crate::matcher::OpenLibrary;
use crate::shape::Shape;
use crate::squares::square_px;
use fluoropose_page::calibration::calibration_of;
use fluoropose_page::error::sentence;
use fluoropose_page::frame_image::FrameImage;
use fluoropose_page::pose_numbers::{from_numbers, to_numbers};

/// Looks for a component in one frame after the other, in steps between which a worker can be called off.
#[wasm_bindgen]
pub struct FrameSearch {
    /// At least one.
    libraries: Vec<OpenLibrary>,
    /// The number of the one that frames are compared with.
    library: usize,
    model: OwnedModel,
    planes: Vec<SymmetryPlane>,
    /// Of whole frames, and of those in the squares that the film is read in.
    whole: Camera,
    camera: Camera,
    calibration: Calibration,
    /// The frame that is searched, where those are not pixels.
    squares: Option<FrameImage>,
    polarity: Polarity,
    film: Option<FilmModel>,
    /// Which component it is and its axes, where its shape tells them.
    shape: Option<Shape>,
    /// The joint's other component, and where it is in the frame.
    other: Option<Other>,
    beside: Option<Beside>,
    places: Places,
    finder: FinderBuffers,
    own: OneClickBuffers,
    for_places: PlacesBuffers,
    refine: RefineBuffers,
    search: Option<Search>,
    walk: Option<Walk>,
}

/// What a frame is searched by.
enum Search {
    Whole(Box<WholeFrame>),
    Joint(Box<JointSearch>),
}

impl Search {
    /// The next part of it; gives whether there is more to do.
    ///
    /// # Errors
    /// A sentence about a frame of another size.
    fn go_on(
        &mut self,
        subject: &Subject<'_>,
        image: &ImageTarget<'_>,
        component: &Component<'_>,
        (finder, own, refine): (&mut FinderBuffers, &mut OneClickBuffers, &mut RefineBuffers),
        written: Written<'_>,
    ) -> Result<bool, JsError> {
        let (model, camera) = (subject.model, subject.camera);
        match self {
            Self::Joint(search) => {
                Ok(search.step(subject, image, &mut refine.borrow(model, camera)))
            }
            Self::Whole(search) => {
                let Some(needs) = search.needs() else {
                    return Ok(false);
                };
                let finder = finder.borrow(component, camera, Kernels::PORTABLE);
                let mut memory = own.borrow(&needs, finder.workspace, finder.refine);
                search
                    .step(subject, image, component, &mut memory, written)
                    .map_err(sentence)
            }
        }
    }
}

#[wasm_bindgen]
impl FrameSearch {
    /// With a library's bytes and the model that it was made from, for frames of the size that the calibration text is for.
    ///
    /// # Errors
    /// The core's sentences about library, model and calibration.
    #[wasm_bindgen(constructor)]
    pub fn new(
        library: Vec<u8>,
        vertices: Vec<f32>,
        triangles: Vec<u32>,
        calibration: &str,
        width: u32,
        height: u32,
    ) -> Result<FrameSearch, JsError> {
        let model = OwnedModel::new(vertices, triangles).map_err(sentence)?;
        let (calibration, camera) = calibration_of(calibration, width, height)?;
        Ok(Self {
            libraries: vec![OpenLibrary::of(library)?],
            library: 0,
            planes: symmetry_planes(model.as_model().mesh()).to_vec(),
            model,
            whole: camera,
            camera,
            calibration,
            squares: None,
            polarity: Polarity::DarkImplant,
            film: None,
            shape: None,
            other: None,
            beside: None,
            places: Places::All,
            finder: FinderBuffers::default(),
            own: OneClickBuffers::default(),
            for_places: PlacesBuffers::default(),
            refine: RefineBuffers::default(),
            search: None,
            walk: None,
        })
    }

    /// Takes another library of the model, as of another distance. They are numbered as they were given, the first one is 0.
    ///
    /// # Errors
    /// The core's sentence about the library.
    #[wasm_bindgen(js_name = addLibrary)]
    pub fn add_library(&mut self, library: Vec<u8>) -> Result<(), JsError> {
        self.libraries.push(OpenLibrary::of(library)?);
        Ok(())
    }

    /// Says which library frames are compared with from now on.
    ///
    /// # Errors
    /// A sentence where there are not so many.
    #[wasm_bindgen(js_name = useLibrary)]
    pub fn use_library(&mut self, number: usize) -> Result<(), JsError> {
        if number >= self.libraries.len() {
            return Err(JsError::new(&format!("There is no library {number}")));
        }
        self.library = number;
        Ok(())
    }

    /// Says whether metal is brighter than what surrounds it, from now on.
    #[wasm_bindgen(js_name = showBright)]
    pub fn show_bright(&mut self, bright: bool) {
        self.polarity = Polarity::of(bright);
    }

    /// Says which component it is, and its axes (nine numbers, as `axes_from` takes them), where its shape tells them, and whether they
    /// tell the front.
    ///
    /// # Errors
    /// A sentence where axes are no right-handed frame.
    #[wasm_bindgen(js_name = knowLimb)]
    pub fn know_limb(
        &mut self,
        femoral: bool,
        axes: &[f64],
        front_is_known: bool,
    ) -> Result<(), JsError> {
        let component = match femoral {
            true => KneeComponent::Femur,
            false => KneeComponent::Tibia,
        };
        self.shape = Some(Shape::of(component, axes, front_is_known)?);
        Ok(())
    }

    /// The same of the joint's other component, with its model; without axes it only hides what lies behind it.
    ///
    /// # Errors
    /// The core's sentence about the model, and that of `knowLimb`.
    #[wasm_bindgen(js_name = knowOther)]
    pub fn know_other(
        &mut self,
        vertices: Vec<f32>,
        triangles: Vec<u32>,
        axes: &[f64],
        front_is_known: bool,
    ) -> Result<(), JsError> {
        let own = self.shape.filter(|_| !axes.is_empty());
        let shape = own.map(|own| Shape::of(own.other_component(), axes, front_is_known));
        self.other = Some(Other::new(vertices, triangles, shape.transpose()?)?);
        Ok(())
    }

    /// What the film makes of the component, as `FilmFacts.model` gives it, or nothing of it.
    ///
    /// # Errors
    /// A sentence about the numbers.
    #[wasm_bindgen(js_name = knowFilm)]
    pub fn know_film(&mut self, film: &[f64]) -> Result<(), JsError> {
        self.film = film_model(film)?;
        self.camera = self.whole.reduced(self.side()).map_err(sentence)?;
        Ok(())
    }

    /// Says where the joint's other component is in the next frame (the six numbers of its pose), and whether its joint tells where this one
    /// is. Without numbers it is not known.
    ///
    /// # Errors
    /// A sentence about the numbers, or where nothing is known of the other one, and the core's about a pose that cannot be drawn.
    pub fn beside(&mut self, pose: &[f64], in_joint: bool) -> Result<(), JsError> {
        self.beside = None;
        if !pose.is_empty() {
            let pose = Pose::from(from_numbers(pose)?);
            let lack = || JsError::new("Nothing is known of the joint's other component");
            let other = self.other.as_mut().ok_or_else(lack)?;
            self.beside = Some(other.at(pose, in_joint, &self.camera)?);
        }
        Ok(())
    }

    /// Says where the next frame is searched as a whole: `shaped`, `dark` or `all`, as the core's `Places`.
    ///
    /// # Errors
    /// A sentence about another word.
    #[wasm_bindgen(js_name = lookAt)]
    pub fn look_at(&mut self, places: &str) -> Result<(), JsError> {
        self.places = match places {
            "shaped" => Places::Shaped,
            "dark" => Places::Dark,
            "all" => Places::All,
            other => return Err(JsError::new(&format!("No places are called {other}"))),
        };
        Ok(())
    }

    /// Whether metal is brighter than what surrounds it, by a frame in which the component's pose is known.
    ///
    /// # Errors
    /// A sentence about the numbers, and the core's about a pose that cannot be drawn.
    #[wasm_bindgen(js_name = isBright)]
    pub fn is_bright(&mut self, frame: &FrameImage, pose: &[f64]) -> Result<bool, JsError> {
        let pose = Pose::from(from_numbers(pose)?);
        let model = self.model.as_model();
        let mut memory = self.refine.borrow(&model, &self.whole);
        let told = frame.look(|frame| {
            polarity_at(&model, &self.whole, &pose, frame, &mut memory).map_err(sentence)
        })?;
        Ok(told == Polarity::BrightImplant)
    }

    /// The next part of the search of a frame, the same until it is done; `fresh` begins with it. Gives whether there is more to do.
    ///
    /// # Errors
    /// A sentence about a frame of another size.
    pub fn step(&mut self, frame: &FrameImage, fresh: bool) -> Result<bool, JsError> {
        if fresh {
            self.squares = self.in_squares(frame)?;
        }
        let frame = self.squares.as_ref().unwrap_or(frame);
        let model = self.model.as_model();
        let component = Component {
            library: self.libraries[self.library].borrow_dependent(),
            model: &model,
            planes: &self.planes,
        };
        let subject = Subject::new(&model, &self.planes, &self.camera);
        let (camera, polarity, kept) = (&self.camera, self.polarity, &mut self.search);
        let (finder, own, refine) = (&mut self.finder, &mut self.own, &mut self.refine);
        let (for_places, places) = (&mut self.for_places, self.places);
        let (other, beside) = (self.other.as_ref(), self.beside.as_ref());
        let limb = self.shape.map(|shape| shape.limb(*model.mesh()));
        let joint = beside.filter(|beside| beside.in_joint);
        let joint = joint.and_then(|beside| Some(InJoint::beside(&other?.limb()?, &beside.pose)));
        let mut look = |image: &ImageTarget<'_>| {
            if fresh || kept.is_none() {
                *kept = Some(match (&joint, &limb, beside) {
                    (Some(joint), Some(limb), _) => {
                        Search::Joint(Box::new(JointSearch::new(image, joint, limb)))
                    }
                    (_, _, Some(beside)) if beside.in_joint => return Ok(false),
                    _ => {
                        let middle: Option<Vector3> = beside.map(|beside| beside.middle);
                        let workspace = finder.workspace(component.library, Kernels::PORTABLE);
                        let mut memory = for_places.borrow(camera, workspace);
                        let at = (places, middle);
                        let begun = WholeFrame::new(image, &component, camera, at, &mut memory);
                        Search::Whole(Box::new(begun.map_err(sentence)?))
                    }
                });
            }
            kept.as_mut().map_or(Ok(false), |search| {
                let written = for_places.written();
                search.go_on(&subject, image, &component, (finder, own, refine), written)
            })
        };
        let hidden = beside.map(|beside| beside.hidden.as_slice());
        frame.look(|frame| {
            with_mask(hidden, camera, |unknown| {
                look(&ImageTarget {
                    frame,
                    unknown,
                    polarity,
                    film: self.film,
                })
            })
        })
    }

    /// The part of a frame's search that is done, 0 to 1.
    #[wasm_bindgen(getter)]
    pub fn progress(&self) -> f64 {
        match &self.search {
            None => 0.0,
            Some(Search::Whole(search)) => search.progress(),
            Some(Search::Joint(search)) => search.progress(),
        }
    }

    /// Column and row of a place in what was found.
    #[wasm_bindgen(getter)]
    pub fn place(&self) -> Option<Vec<f64>> {
        self.found()?;
        let place = match self.search.as_ref()? {
            Search::Whole(search) => search.found()?.place,
            Search::Joint(search) => {
                let middle = self.model.as_model().bounds().centre;
                self.camera
                    .project(&search.found()?.pose.transform(&middle))?
            }
        };
        let side = self.side() as f64;
        Some(vec![side * place.column, side * place.row])
    }

    /// Six numbers of the pose that was found.
    #[wasm_bindgen(getter)]
    pub fn pose(&self) -> Option<Vec<f64>> {
        Some(to_numbers(&EulerPose::from(self.found()?.pose)).to_vec())
    }

    /// By what poses that were found are compared, the greatest first.
    #[wasm_bindgen(getter)]
    pub fn score(&self) -> Option<f64> {
        Some(self.found()?.score())
    }

    /// Begins to follow the component from a frame in which its pose (six numbers) is known to some frames before and after it, in a film
    /// of `frames`.
    ///
    /// # Errors
    /// A sentence about the numbers.
    #[wasm_bindgen(js_name = beginWalk)]
    pub fn begin_walk(&mut self, frame: usize, pose: &[f64], frames: usize) -> Result<(), JsError> {
        self.walk = Some(Walk::new(frame, from_numbers(pose)?.into(), frames));
        Ok(())
    }

    /// The frame that is to be looked at next; nothing where all are.
    #[wasm_bindgen(js_name = walkWanted)]
    pub fn walk_wanted(&self) -> Option<usize> {
        self.walk.as_ref()?.wanted()
    }

    /// Looks at the frame that was asked for.
    ///
    /// # Errors
    /// The core's sentence about a pose that was given and cannot be drawn.
    #[wasm_bindgen(js_name = walkTake)]
    pub fn walk_take(&mut self, frame: &FrameImage) -> Result<(), JsError> {
        let Some(mut walk) = self.walk.take() else {
            return Ok(());
        };
        let taken = self.look(frame, |subject, image, memory| {
            walk.take(subject, image, memory).map_err(sentence)
        });
        self.walk = Some(walk);
        taken
    }

    /// The first and the last frame in which it was followed, each with the six numbers of its pose: seven numbers, not finite where there
    /// is none.
    #[wasm_bindgen(js_name = walkEnds)]
    pub fn walk_ends(&self) -> Vec<f64> {
        let ends = self.walk.as_ref().map_or([None, None], Walk::ends);
        let numbers = |end: Option<(usize, Pose)>| match end {
            None => vec![f64::NAN; 7],
            Some((frame, pose)) => {
                let numbers = to_numbers(&EulerPose::from(pose));
                [frame as f64].into_iter().chain(numbers).collect()
            }
        };
        ends.into_iter().flat_map(numbers).collect()
    }
}

impl FrameSearch {
    /// Looks at a frame in the squares that the film is read in.
    fn look<T>(
        &mut self,
        frame: &FrameImage,
        with: impl FnOnce(&Subject<'_>, &ImageTarget<'_>, &mut RefineMemory<'_>) -> Result<T, JsError>,
    ) -> Result<T, JsError> {
        let squares = self.in_squares(frame)?;
        let frame = squares.as_ref().unwrap_or(frame);
        let model = self.model.as_model();
        let subject = Subject::new(&model, &self.planes, &self.camera);
        let mut memory = self.refine.borrow(&model, &self.camera);
        let (polarity, film) = (self.polarity, self.film);
        frame.look(|frame| {
            let image = ImageTarget {
                frame,
                unknown: None,
                polarity,
                film,
            };
            with(&subject, &image, &mut memory)
        })
    }

    /// Side of the squares that the film is read in, pixels.
    fn side(&self) -> usize {
        square_px(self.film.as_ref())
    }

    /// A frame in those, where they are not pixels.
    fn in_squares(&self, frame: &FrameImage) -> Result<Option<FrameImage>, JsError> {
        let side = self.side();
        (side > 1).then(|| frame.reduced(side)).transpose()
    }

    fn found(&self) -> Option<&FramePose> {
        let found = match self.search.as_ref()? {
            Search::Whole(search) => search.found().map(|found| &found.pose),
            Search::Joint(search) => search.found(),
        };
        found.filter(|found| self.may_be_at(&found.pose))
    }

    /// Whether the component can be where a pose has it: before the detector, and not within the tube.
    fn may_be_at(&self, pose: &Pose) -> bool {
        let middle = self.model.as_model().bounds().centre;
        self.calibration.may_be_at(pose, &middle)
    }
}

//! A component that is followed, with what belongs to it and the memory to look at frames.

use std::sync::{Mutex, OnceLock, PoisonError, RwLock};

use anyhow::{Context, Result};
use fluoropose::Side;
use fluoropose::camera::Camera;
use fluoropose::camera::calibration::Calibration;
use fluoropose::film::FilmModel;
use fluoropose::follow::{Limb, Subject};
use fluoropose::image::mask::Mask;
use fluoropose::joint::flange::{OtherSide, side_by_flange};
use fluoropose::math::Vector3;
use fluoropose::mesh::anatomy::{KneeComponent, field_axes};
use fluoropose::mesh::symmetry::{SymmetryPlane, symmetry_planes};
use fluoropose::mesh::{Model, OwnedModel};
use fluoropose::pose::Pose;
use fluoropose::refine::{ImageTarget, Polarity, RefineBuffers, RefineMemory};
use rayon::prelude::*;

use super::request::{Listener, Told};
use crate::files::{Component, Film, MaskBuffer, Role, grey, other_shape};
use crate::finding::{Built, ViewOptions, axes_of, build_library, covered};
use crate::options::Pair;

/// A component that is followed.
pub(super) struct Part<'s> {
    /// Its number among those of the study.
    pub(super) number: usize,
    pub(super) component: &'s Component,
    model: &'s OwnedModel,
    mesh: Model<'s>,
    pub(super) planes: Vec<SymmetryPlane>,
    /// The rotation from the field's axes to the model's, where the shape tells it.
    pub(super) axes: Option<Pose>,
    /// What its joint tells by, where its shape tells which way it lies.
    pub(super) limb: Option<Limb<'s>>,
    /// Of the film in the squares that it is seen in.
    pub(super) camera: Camera,
    /// Their side, pixels of the files.
    square_px: usize,
    pub(super) polarity: Polarity,
    calibration: &'s Calibration,
    libraries: [OnceLock<Built>; 2],
    /// What the film makes of the component, and how often that was learnt.
    film: RwLock<(Option<FilmModel>, usize)>,
    buffers: Mutex<Vec<RefineBuffers>>,
}

/// Reads the models of components; what there is to say of them is handed on.
///
/// # Errors
/// Names the file.
pub(super) fn read_models(
    components: &[Component],
    listener: &Listener,
) -> Result<Vec<OwnedModel>> {
    let read = |one: &Component| one.read_model_and_remarks();
    let read: Vec<_> = components.par_iter().map(read).collect();
    let told = components.iter().zip(read).map(|(one, read)| {
        let (model, remarks) = read?;
        for remark in remarks {
            listener(Told::Remark(format!("{}: {remark}", one.name)));
        }
        Ok(model)
    });
    told.collect()
}

/// What the shape of a component tells: it takes as long as looking at some frames.
#[derive(Clone)]
pub(super) struct Shape<'s> {
    component: &'s Component,
    model: &'s OwnedModel,
    planes: Vec<SymmetryPlane>,
    axes: Option<Pose>,
    limb: Option<Limb<'s>>,
}

impl<'s> Shape<'s> {
    /// # Errors
    /// For axes that the study states wrongly.
    pub(super) fn of(component: &'s Component, model: &'s OwnedModel) -> Result<Self> {
        let mesh = model.as_model();
        let planes = symmetry_planes(mesh.mesh()).to_vec();
        let told = match component.role() {
            Some(role) => axes_of(&mesh, role, component.axes.as_deref())?,
            None => None,
        };
        let kind = component.role().map(Role::component);
        let unsigned = || field_axes(mesh.mesh(), &planes, kind?);
        let axes = told.map(|axes| axes.model_from_field).or_else(unsigned);
        let limb = kind.zip(told).map(|(component, axes)| Limb {
            mesh: *model.as_model().mesh(),
            component,
            axes,
        });
        Ok(Self {
            component,
            model,
            planes,
            axes,
            limb,
        })
    }

    /// What a femoral component says of the side that is stated.
    pub(super) fn other_side(&self, stated: Side) -> Option<OtherSide> {
        let limb = self.femoral()?;
        OtherSide::than(stated, &limb.mesh, &limb.axes)
    }

    /// The knee that a femoral component is made for, where its flange tells.
    pub(super) fn made_for(&self) -> Option<Side> {
        let limb = self.femoral()?;
        side_by_flange(&limb.mesh, &limb.axes)
    }

    fn femoral(&self) -> Option<Limb<'s>> {
        self.limb
            .filter(|limb| limb.component == KneeComponent::Femur)
    }
}

impl<'s> Part<'s> {
    pub(super) fn new(
        number: usize,
        shape: &Shape<'s>,
        calibration: &'s Calibration,
        (camera, square_px): (Camera, usize),
        polarity: Polarity,
    ) -> Self {
        let Shape {
            component,
            model,
            planes,
            axes,
            limb,
        } = shape.clone();
        Self {
            number,
            component,
            model,
            mesh: model.as_model(),
            planes,
            axes,
            limb,
            camera,
            square_px,
            polarity,
            calibration,
            libraries: Default::default(),
            film: RwLock::default(),
            buffers: Mutex::default(),
        }
    }

    pub(super) fn name(&self) -> &str {
        &self.component.name
    }

    pub(super) fn role(&self) -> Option<Role> {
        self.component.role()
    }

    /// The component that its model has the shape of, where that is the other one.
    pub(super) fn other_shape(&self) -> Option<KneeComponent> {
        other_shape(self.model, self.role()?)
    }

    /// What the film makes of the component, once that is known.
    pub(super) fn film(&self) -> Option<FilmModel> {
        self.known_film().0
    }

    fn known_film(&self) -> (Option<FilmModel>, usize) {
        *self.film.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// From now on edges are compared with those that the film makes of the component.
    pub(super) fn set_film(&self, film: FilmModel) {
        let mut known = self.film.write().unwrap_or_else(PoisonError::into_inner);
        *known = (Some(film), known.1 + 1);
    }

    /// Tells steps with the film's constants from those without, from those with others, and from those in other squares.
    pub(super) fn phase(&self) -> String {
        let phase = match (self.known_film().1, self.polarity) {
            (0, Polarity::DarkImplant) => "bare",
            (1, Polarity::DarkImplant) => "film",
            (_, Polarity::DarkImplant) => "film-again",
            (0, Polarity::BrightImplant) => "bright-bare",
            (1, Polarity::BrightImplant) => "bright-film",
            (_, Polarity::BrightImplant) => "bright-film-again",
        };
        match self.square_px {
            1 => phase.to_owned(),
            side => format!("{phase}-{side}"),
        }
    }

    /// Middle of the model's box.
    pub(super) fn middle(&self) -> Vector3 {
        self.mesh.bounds().centre
    }

    /// How far away the component is at a pose, mm.
    pub(super) fn depth_of(&self, pose: &Pose) -> f64 {
        -pose.transform(&self.middle())[2]
    }

    /// Whether the component can be where a pose has it: before the detector, and not within the tube.
    pub(super) fn may_be_at(&self, pose: &Pose) -> bool {
        self.calibration.may_be_at(pose, &self.middle())
    }

    pub(super) fn model(&self) -> Model<'s> {
        self.model.as_model()
    }

    /// Distances of libraries, mm, with their numbers: those that serve a part which is about so far away, mm, where that is known.
    pub(super) fn distances(&self, depth: Option<f64>) -> Vec<(usize, f64)> {
        let told = self.component.distance_mm;
        let wanted = self.calibration.search_distances(told, depth);
        let all = self.calibration.search_distances(told, None);
        let numbered = all.into_iter().enumerate();
        numbered.filter(|(_, one)| wanted.contains(one)).collect()
    }

    /// The library for one of the distances, of all views or of those that the study asks for; built when it is first wanted.
    pub(super) fn library(&self, number: usize, distance: f64) -> Result<&[u8]> {
        let library = self.libraries.get(number).context("two libraries")?;
        if library.get().is_none() {
            let views = ViewOptions {
                nominal: self.component.nominal.map(Pair),
                distance: self.component.distance_mm,
                ..ViewOptions::default()
            };
            let built = build_library(self.model(), self.camera, &views, distance)
                .with_context(|| self.component.words())?;
            // Whoever was first.
            let _ = library.set(built);
        }
        let built = library.get().context("it was built")?;
        Ok(&built.bytes)
    }

    /// The silhouette at a pose and what its edges reach beyond it.
    ///
    /// # Errors
    /// For a pose that cannot be drawn.
    pub(super) fn silhouette(&self, pose: &Pose) -> Result<MaskBuffer> {
        covered(&self.mesh, &self.camera, pose)
    }

    /// Calls `work` with a frame of the film, and with memory that is used again.
    ///
    /// # Errors
    /// For a frame that cannot be read, and those of `work`.
    pub(super) fn see<T>(
        &self,
        film: &Film,
        frame: usize,
        work: impl FnOnce(&Subject<'_>, &ImageTarget<'_>, &mut RefineMemory<'_>) -> T,
    ) -> Result<T> {
        self.see_beside(film, frame, None, work)
    }

    /// The same where some pixels are another component's.
    ///
    /// # Errors
    /// As of [`Self::see`].
    pub(super) fn see_beside<T>(
        &self,
        film: &Film,
        frame: usize,
        unknown: Option<&Mask<'_>>,
        work: impl FnOnce(&Subject<'_>, &ImageTarget<'_>, &mut RefineMemory<'_>) -> T,
    ) -> Result<T> {
        let decoded = film.frame(frame)?;
        let grey = grey(&decoded)?;
        let image = ImageTarget {
            frame: &*grey,
            unknown,
            polarity: self.polarity,
            film: self.film(),
        };
        let subject = Subject::new(&self.mesh, &self.planes, &self.camera);
        let mut buffers = self.take();
        let answer = work(
            &subject,
            &image,
            &mut buffers.borrow(&self.mesh, &self.camera),
        );
        self.locked().push(buffers);
        Ok(answer)
    }

    fn take(&self) -> RefineBuffers {
        self.locked().pop().unwrap_or_default()
    }

    fn locked(&self) -> std::sync::MutexGuard<'_, Vec<RefineBuffers>> {
        self.buffers.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

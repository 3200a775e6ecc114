//! A model drawn at known poses, as the method gets to see it.

use anyhow::Result;
use fluoropose::camera::Camera;
use fluoropose::mesh::Model;
use fluoropose::pose::Pose;
use fluoropose::render::{Projected, render, scratch_needed};
use rand::RngExt;

use super::disturb::{DisturbanceOptions, Disturbed};
use super::frame_cut::cut_off;
use super::level::Noise;
use crate::mask_buffer::MaskBuffer;

/// A model, a camera, and how what it sees is disturbed.
pub struct Scene<'m> {
    mesh: Model<'m>,
    camera: Camera,
    fine: Camera,
    factor: usize,
    options: DisturbanceOptions,
    scratch: Vec<Projected>,
    drawn: MaskBuffer,
}

/// Streams of the random numbers that choose how an outline is cut, apart from those that disturb it.
const CUTS: u64 = 1 << 63;

/// Streams of the random numbers that disturb what a second camera sees.
const SECOND: u64 = 1 << 62;

/// One of this many hidden outlines is cut off by the frame's border: as many as hide behind a
/// half plane, a disc or a band.
const KINDS: u32 = 4;

impl<'m> Scene<'m> {
    /// A scene with its working memory.
    ///
    /// # Errors
    /// For impossible options and frames.
    pub fn new(mesh: Model<'m>, camera: Camera, options: DisturbanceOptions) -> Result<Self> {
        options.check()?;
        let factor = options.fineness(camera.width(), camera.height());
        let fine = camera.supersampled(factor)?;
        Ok(Self {
            mesh,
            camera,
            fine,
            factor,
            options,
            scratch: vec![Projected::default(); scratch_needed(&mesh)],
            drawn: MaskBuffer::new(fine.width(), fine.height())?,
        })
    }

    /// The noise of the outlines.
    pub fn noise(&self) -> Noise {
        Noise::of(&self.options, self.factor)
    }

    /// Draws the model at a pose and disturbs the mask; `frame` numbers the random numbers.
    /// Returns the pose that was drawn: another where the frame's border is to cut the outline.
    ///
    /// # Errors
    /// Where the model cannot be drawn or its outline has too many corners.
    pub fn observe(&mut self, pose: &Pose, frame: u64) -> Result<(Pose, Disturbed)> {
        let (mut pose, mut options) = (*pose, self.options);
        if options.occlude > 0.0 {
            let mut random = options.random(CUTS | frame);
            if random.random_range(0..KINDS) == 0 {
                self.draw(&pose)?;
                let curves = options.curves(&self.drawn.mask(), self.factor)?;
                pose = cut_off(&pose, &curves, &self.camera, options.occlude, &mut random);
                options.occlude = 0.0;
            }
        }
        self.draw(&pose)?;
        let disturbed = options.disturb_drawn(&self.drawn.mask(), self.factor, frame)?;
        Ok((pose, disturbed))
    }

    /// What a second camera of the same kind, `placement` = `second_from_first`, sees of the model
    /// at a pose in the first camera's frame, disturbed on its own.
    ///
    /// # Errors
    /// Those of [`Self::observe`].
    pub fn observe_from(&mut self, placement: &Pose, pose: &Pose, frame: u64) -> Result<Disturbed> {
        self.draw(&placement.compose(pose))?;
        let mask = self.drawn.mask();
        self.options
            .disturb_drawn(&mask, self.factor, SECOND | frame)
    }

    fn draw(&mut self, pose: &Pose) -> Result<()> {
        let (mesh, fine, scratch) = (&self.mesh, &self.fine, &mut self.scratch);
        self.drawn
            .draw(|mask| render(mesh, fine, pose, scratch, mask))?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fluoropose::pose::EulerPose;
    use fluoropose_phantom::implant::{Parameters, femur};

    fn seen(options: DisturbanceOptions, check: impl Fn(&Camera, &Pose, &Pose, &Disturbed)) {
        let model = femur(&Parameters::default()).unwrap();
        let mesh = Model::from_triangles(&model.vertices, &model.triangles).unwrap();
        let camera = Camera::from_principal_distance(1024, 1024, 1198.0, 0.373, [0.0, 0.0]);
        let camera = camera.unwrap();
        let mut scene = Scene::new(mesh, camera, options).unwrap();
        for frame in 0..12 {
            let pose = Pose::from(EulerPose {
                x_mm: 5.0,
                y_mm: -9.0,
                z_mm: -1000.0,
                z_rot_deg: 30.0 * frame as f64,
                x_rot_deg: 6.0,
                y_rot_deg: -11.0,
            });
            let (drawn, disturbed) = scene.observe(&pose, frame).unwrap();
            check(&camera, &pose, &drawn, &disturbed);
        }
    }

    /// Length of the outline that lies inside the frame, borders of the frame left out.
    fn length_inside(mask: &MaskBuffer) -> f64 {
        let options = DisturbanceOptions::default();
        let curves = options.curves(&mask.mask(), 1).unwrap();
        let side = |value: f64, size: usize| (0.0..=size as f64).contains(&value);
        curves
            .iter()
            .flat_map(|curve| curve.points.iter().zip(curve.lengths()))
            .filter(|(p, _)| {
                side(p.column, mask.mask().width()) && side(p.row, mask.mask().height())
            })
            .map(|(_, length)| length)
            .sum()
    }

    #[test]
    fn without_a_disturbance_the_model_is_drawn_as_it_is() {
        let model = femur(&Parameters::default()).unwrap();
        seen(
            DisturbanceOptions::default(),
            |camera, pose, drawn, disturbed| {
                assert_eq!(pose, drawn);
                assert!(disturbed.unknown.is_none() && disturbed.hidden.is_none());
                let mesh = Model::from_triangles(&model.vertices, &model.triangles).unwrap();
                let mut plain = MaskBuffer::new(1024, 1024).unwrap();
                let mut scratch = vec![Projected::default(); scratch_needed(&mesh)];
                plain
                    .draw(|mask| render(&mesh, camera, pose, &mut scratch, mask))
                    .unwrap();
                assert_eq!(disturbed.mask.mask().unmatched(&plain.mask()), Some(0));
            },
        );
    }

    #[test]
    fn the_frame_cuts_off_the_part_that_was_asked_for() {
        let options = DisturbanceOptions {
            occlude: 0.25,
            ..DisturbanceOptions::default()
        };
        let cuts = std::cell::Cell::new(0);
        let model = femur(&Parameters::default()).unwrap();
        seen(options, |camera, pose, drawn, disturbed| {
            assert_eq!(pose == drawn, disturbed.hidden.is_some());
            if pose == drawn {
                return;
            }
            cuts.set(cuts.get() + 1);
            // The same rays in a frame that is large enough, by the same focal length.
            let whole = Camera::new(3072, 3072, camera.focal(), [1536.0, 1536.0]).unwrap();
            let mesh = Model::from_triangles(&model.vertices, &model.triangles).unwrap();
            let mut scratch = vec![Projected::default(); scratch_needed(&mesh)];
            let mut all = MaskBuffer::new(3072, 3072).unwrap();
            all.draw(|mask| render(&mesh, &whole, drawn, &mut scratch, mask))
                .unwrap();
            let part = length_inside(&disturbed.mask) / length_inside(&all);
            assert!((part - 0.75).abs() < 0.02, "{part}");
        });
        assert!(cuts.get() >= 1, "{}", cuts.get());
    }
}

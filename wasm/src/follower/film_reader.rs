//! What the constants of a film are estimated from, read around the frames in which a component's pose is known.

use fluoropose::film::FilmProfile;
use fluoropose::follow::FilmReading;
use fluoropose::pose::Pose;
use wasm_bindgen::prelude::*;

use super::seen::Seen;
use fluoropose_page::frame_image::FrameImage;
use fluoropose_page::pose_numbers::from_numbers;

/// Reads profiles of a film around known poses of a component; see the core's `FilmReading`.
#[wasm_bindgen]
pub struct FilmReader {
    reading: FilmReading,
    seen: Seen,
    given: Vec<(usize, Pose)>,
}

#[wasm_bindgen]
impl FilmReader {
    /// Of a film of `frames`, all of the size that the calibration text is for. `component` is 0 for a femur, 1 for a tibia; profiles are read in
    /// squares with sides of `side` pixels (1: as they are).
    ///
    /// # Errors
    /// The core's sentence about the model or the calibration.
    #[wasm_bindgen(constructor)]
    #[expect(
        clippy::too_many_arguments,
        reason = "they cross into JavaScript one by one"
    )]
    pub fn new(
        vertices: Vec<f32>,
        triangles: Vec<u32>,
        calibration: &str,
        width: u32,
        height: u32,
        frames: usize,
        component: u8,
        side: usize,
    ) -> Result<FilmReader, JsError> {
        let seen = Seen::new((vertices, triangles), calibration, (width, height), side)?;
        Ok(Self {
            reading: FilmReading::new(seen.middle(), frames, component),
            seen,
            given: Vec::new(),
        })
    }

    /// Gives a known pose (six numbers) of a frame, in the order of frames.
    ///
    /// # Errors
    /// A sentence where they are not six finite numbers.
    pub fn give(&mut self, frame: usize, pose: &[f64]) -> Result<(), JsError> {
        let pose = Pose::from(from_numbers(pose)?);
        self.reading.give(frame, pose);
        self.given.push((frame, pose));
        Ok(())
    }

    /// Asks for the profiles at a pose (six numbers) of a frame as it is.
    ///
    /// # Errors
    /// A sentence where they are not six finite numbers.
    pub fn ask(&mut self, frame: usize, pose: &[f64]) -> Result<(), JsError> {
        let pose = Pose::from(from_numbers(pose)?);
        self.reading.ask(frame, pose);
        self.given.push((frame, pose));
        Ok(())
    }

    /// The frame that is to be looked at next; nothing where all is read.
    pub fn wanted(&mut self) -> Option<usize> {
        self.reading.wanted()
    }

    /// Looks at the frame that was asked for; gives its profiles as numbers, none where the component was not found.
    ///
    /// # Errors
    /// The core's sentence about a pose that was given and cannot be drawn.
    pub fn take(&mut self, frame: &FrameImage) -> Result<Vec<f32>, JsError> {
        let reading = &mut self.reading;
        let wanted = reading.wanted();
        let given = self.given.iter().find(|(at, _)| Some(*at) == wanted);
        let given = given.map(|(_, pose)| pose);
        let read = self
            .seen
            .look(frame, (given, None), |subject, image, memory| {
                reading.take(subject, image, memory)
            })?;
        Ok(read.iter().flat_map(FilmProfile::numbers).collect())
    }
}

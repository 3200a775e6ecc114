//! Attenuation of skin, muscle and bone along a ray.

use super::anatomy as body;
use super::sagittal::Sagittal;
use super::texture::pattern;
use super::tube::soft_max;
use libm::{cos, sin};

/// Linear attenuation per mm at the beam's mean energy; bone counts what it adds to muscle.
const FAT: f64 = 0.0155;
const MUSCLE: f64 = 0.0195;
const SPONGY: f64 = 0.0105;
const CORTICAL: f64 = 0.036;

/// Where the patella sits at full extension, as an angle on the groove, and how far it glides for each radian of flexion.
const PATELLA_START: f64 = 0.08;
const PATELLA_GLIDE: f64 = 0.72;

/// A knee in one position.
pub(super) struct Knee {
    patella: f64,
    seed: u64,
}

impl Knee {
    /// The knee whose bones lie in these planes.
    pub(super) fn new(femur: &Sagittal, tibia: &Sagittal, seed: u64) -> Self {
        let flexion = tibia.flexion(femur).abs();
        Self {
            patella: PATELLA_START - PATELLA_GLIDE * flexion,
            seed,
        }
    }

    /// Attenuation along the ray that passes the femur's and the tibia's plane at these places.
    pub(super) fn attenuation(&self, at_femur: [f64; 2], at_tibia: [f64; 2]) -> f64 {
        let at_patella = self.on_patella(at_femur);
        self.soft(at_femur, at_tibia, at_patella) + self.bone(at_femur, at_tibia, at_patella)
    }

    fn soft(&self, at_femur: [f64; 2], at_tibia: [f64; 2], at_patella: [f64; 2]) -> f64 {
        let (thigh, shank) = (body::THIGH.chord(at_femur), body::SHANK.chord(at_tibia));
        let limbs = soft_max(thigh.whole, shank.whole, 14.0);
        let skin = soft_max(limbs, body::KNEECAP.chord(at_patella).whole, 22.0);
        if skin <= 0.0 {
            return 0.0;
        }
        let muscle = soft_max(thigh.whole - thigh.shell, shank.whole - shank.shell, 14.0);
        let strands = 1.0 + 0.035 * pattern([at_femur[0], at_femur[1] * 0.25], 14.0, self.seed);
        FAT * skin + (MUSCLE - FAT) * muscle * strands
    }

    fn bone(&self, at_femur: [f64; 2], at_tibia: [f64; 2], at_patella: [f64; 2]) -> f64 {
        [
            (&body::FEMUR, at_femur, 1.0),
            (&body::TIBIA, at_tibia, 1.0),
            (&body::FIBULA, at_tibia, 0.9),
            (&body::PATELLA, at_patella, 1.2),
        ]
        .into_iter()
        .map(|(tube, at, density)| {
            let chord = tube.chord(at);
            if chord.whole <= 0.0 {
                return 0.0;
            }
            let mottled =
                1.0 + 0.20 * pattern([at[0], at[1] * 0.6], 5.0, self.seed.wrapping_add(77));
            density * mottled * (SPONGY * (chord.whole - chord.shell) + CORTICAL * chord.shell)
        })
        .sum()
    }

    /// The patella's own coordinates of a place on the femur's plane.
    fn on_patella(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (s, c) = (sin(self.patella), cos(self.patella));
        let (dx, dy) = (x - body::GROOVE_CENTRE[0], y - body::GROOVE_CENTRE[1]);
        [
            dx * c + dy * s - body::GROOVE_RADIUS - body::PATELLA_HEIGHT,
            dy * c - dx * s,
        ]
    }
}

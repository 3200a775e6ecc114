//! The kinds of films that are measured.

use fluoropose_phantom::film::{
    Alloys, Blur, Display, Physics, Sampling, Scatter, Surroundings, Unsharp,
};

/// Blur of a sharp film and of a soft one, standard deviations in pixels.
const BLURS: [(&str, f64); 2] = [("sharp", 0.7), ("soft", 1.4)];
/// Little scatter, and much: its part of the primary beam, with half as much of glare.
const SCATTERS: [(&str, f64); 2] = [("little", 0.05), ("much", 0.4)];
/// How much a usual beam hardens.
const HARDENING: f64 = 0.2;
/// Edges enhanced as many fluoroscopes do.
const UNSHARP: Unsharp = Unsharp {
    amount: 0.8,
    sigma_px: 3.0,
};

/// A kind of films.
#[derive(Clone, Debug)]
pub struct FilmKind {
    /// Its display, blur, scatter and what else, in words.
    pub name: String,
    /// How it is made.
    pub physics: Physics,
}

impl FilmKind {
    /// Logarithmic and linear display, sharp and soft, with little scatter and much: eight kinds; then a linear display
    /// with an unsharp mask, a square-root one, and cement and screws beside the implants.
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for display in [Display::Logarithmic, Display::Linear] {
            for (blur, sigma) in BLURS {
                for (scatter, share) in SCATTERS {
                    all.push(Self {
                        name: format!("{display}, {blur}, {scatter}"),
                        physics: physics(display, sigma, share),
                    });
                }
            }
        }
        let linear = physics(Display::Linear, BLURS[0].1, SCATTERS[0].1);
        all.push(Self {
            name: "linear, sharp, little, unsharp mask".to_owned(),
            physics: Physics {
                unsharp: Some(UNSHARP),
                ..linear
            },
        });
        all.push(Self {
            name: "square-root, soft, little".to_owned(),
            physics: physics(Display::SquareRoot, BLURS[1].1, SCATTERS[0].1),
        });
        let disturbed = physics(Display::Linear, BLURS[1].1, SCATTERS[0].1);
        all.push(Self {
            name: "linear, soft, little, cement, screws".to_owned(),
            physics: Physics {
                surroundings: Surroundings {
                    cement: true,
                    screws: true,
                    ..Surroundings::default()
                },
                ..disturbed
            },
        });
        all
    }
}

fn physics(display: Display, sigma: f64, share: f64) -> Physics {
    Physics {
        display,
        alloys: Alloys {
            hardening: HARDENING,
            ..Alloys::default()
        },
        blur: Blur {
            focal_px: 0.0,
            detector_px: sigma,
        },
        scatter: Scatter {
            share,
            glare: share / 2.0,
            ..Scatter::default()
        },
        sampling: Sampling::EXACT,
        ..Physics::default()
    }
}

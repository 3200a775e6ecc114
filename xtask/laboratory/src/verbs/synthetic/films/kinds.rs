//! The kinds of films that are measured.

use fluoropose_phantom::film::{
    Alloys, Blur, Cement, Display, Exposure, Physics, Sampling, Scatter, Surroundings, Unsharp,
};

/// Blur of a sharp film and of a soft one, standard deviations in pixels.
const BLURS: [(&str, f64); 2] = [("sharp", 0.7), ("soft", 1.4)];
/// Little scatter, and much: its part of the primary beam, with half as much of glare.
const SCATTERS: [(&str, f64); 2] = [("little", 0.05), ("much", 0.4)];
const SHARP: f64 = BLURS[0].1;
const SOFT: f64 = BLURS[1].1;
/// How much a usual beam hardens.
const HARDENING: f64 = 0.2;
/// Edges enhanced in several ways, little and strongly, narrowly and widely, on films of this display and blur.
const ENHANCED: [(Display, f64, [f64; 2]); 8] = [
    (Display::Linear, SHARP, [0.8, 3.0]),
    (Display::Linear, SOFT, [1.5, 2.0]),
    (Display::Linear, SOFT, [0.5, 6.0]),
    (Display::SquareRoot, SHARP, [0.4, 1.5]),
    (Display::SquareRoot, SOFT, [1.0, 4.0]),
    (Display::Logarithmic, SHARP, [0.5, 2.0]),
    (Display::Logarithmic, SOFT, [1.2, 3.0]),
    (Display::Logarithmic, SOFT, [0.6, 8.0]),
];
/// Cement of several thicknesses (mm) and attenuations (per mm), on films of this display and blur.
const CEMENTED: [(Display, f64, [f64; 2]); 5] = [
    (Display::Linear, SHARP, [0.8, 0.035]),
    (Display::Linear, SOFT, [3.0, 0.02]),
    (Display::SquareRoot, SHARP, [1.8, 0.05]),
    (Display::Logarithmic, SHARP, [1.2, 0.035]),
    (Display::Logarithmic, SOFT, [3.5, 0.035]),
];

/// A kind of films.
#[derive(Clone, Debug)]
pub struct FilmKind {
    /// Its display, blur, scatter and what else, in words.
    pub name: String,
    /// How it is made.
    pub physics: Physics,
}

impl FilmKind {
    /// Logarithmic and linear display, sharp and soft, with little scatter and much: eight kinds; then a square-root display,
    /// and cement and screws beside the implants; then edges enhanced, cement, and few quanta, each on several displays.
    pub fn all() -> Vec<Self> {
        let mut all = Self::plain();
        all.push(Self {
            name: "square-root, soft, little".to_owned(),
            physics: physics(Display::SquareRoot, SOFT, SCATTERS[0].1),
        });
        all.push(Self {
            name: "linear, soft, cement, screws".to_owned(),
            physics: with_cement(Display::Linear, SOFT, Cement::default(), true),
        });
        all.extend(ENHANCED.map(|(display, blur, unsharp)| Self::enhanced(display, blur, unsharp)));
        all.extend(CEMENTED.map(|(display, blur, cement)| Self::cemented(display, blur, cement)));
        all.extend([Display::Linear, Display::Logarithmic].map(Self::of_few_quanta));
        all
    }

    fn plain() -> Vec<Self> {
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
        all
    }

    fn enhanced(display: Display, blur: f64, [amount, sigma_px]: [f64; 2]) -> Self {
        Self {
            name: format!("{display}, {}, unsharp {amount} {sigma_px}", word(blur)),
            physics: Physics {
                unsharp: Some(Unsharp { amount, sigma_px }),
                ..physics(display, blur, SCATTERS[0].1)
            },
        }
    }

    fn cemented(display: Display, blur: f64, [thickness_mm, density]: [f64; 2]) -> Self {
        let cement = Cement {
            thickness_mm,
            density,
        };
        let name = format!("{display}, {}, cement {thickness_mm} {density}", word(blur));
        Self {
            name,
            physics: with_cement(display, blur, cement, false),
        }
    }

    /// A film of another exposure and other metals: a quarter of the quanta, a thinner alloy of the femur, a denser tray.
    fn of_few_quanta(display: Display) -> Self {
        let few = physics(display, SHARP, SCATTERS[0].1);
        Self {
            name: format!("{display}, sharp, few quanta, alloys"),
            physics: Physics {
                exposure: Exposure(0.25),
                alloys: Alloys {
                    femur: 0.45,
                    tibia: 0.35,
                    ..few.alloys
                },
                ..few
            },
        }
    }
}

fn word(blur: f64) -> &'static str {
    BLURS[usize::from(blur == SOFT)].0
}

fn with_cement(display: Display, blur: f64, cement: Cement, screws: bool) -> Physics {
    Physics {
        surroundings: Surroundings {
            cement: Some(cement),
            screws,
            ..Surroundings::default()
        },
        ..physics(display, blur, SCATTERS[0].1)
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

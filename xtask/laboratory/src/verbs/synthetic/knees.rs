//! Films of which a seed draws everything: the design of the implants, the knee, what it does, and how it is filmed.

use std::fmt;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use fluoropose_phantom::film::activity::Activity;
use fluoropose_phantom::film::{
    Alloys, Cement, Display, Exposure, Field, Physics, Sampling, Unsharp,
};
use fluoropose_phantom::implant::Side;
use fluoropose_phantom::own_folder::check_source;
use fluoropose_phantom::sequence::{self, Options};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::implants::of_study;
use crate::files::write_json;
use crate::options::Seeds;
use crate::verbs::measured_film::{HEADING, Words, follow};

/// Options of which the seed is in place.
const DRAWN_BY_SEED: [&str; 18] = [
    "seed",
    "side",
    "shutter",
    "second_leg",
    "leaves_field",
    "stretch",
    "display",
    "blur",
    "scatter",
    "glare",
    "unsharp",
    "exposure",
    "opacity",
    "hardening",
    "cement",
    "screws",
    "ruler",
    "flat_panel",
];

/// Which films are drawn.
#[derive(clap::Args)]
pub(super) struct KneeArgs {
    /// With --implants: films of which the seeds from A to B draw all: knee, activity, design, physics
    #[arg(
        long,
        value_name = "A..B",
        group = "drawn",
        requires_all = ["implants", "out"],
        conflicts_with = "films",
        conflicts_with_all = DRAWN_BY_SEED,
        conflicts_with_all = super::OF_THE_PROTOCOL, conflicts_with_all = super::OF_THE_LIBRARY
    )]
    pub(super) knees: Option<Seeds>,
    /// With --knees: follow each film from nothing, and compare it with its truth
    #[arg(long, requires = "knees")]
    track: bool,
}

/// Draws the films into folders of `out`, and follows them where that is asked for.
///
/// # Errors
/// For files that cannot be read or written, and those of following.
pub(super) fn run(
    args: &KneeArgs,
    (implants, out): (&Path, &Path),
    frames: usize,
    json: Option<&Path>,
) -> Result<()> {
    ensure!(
        json.is_none() || args.track,
        "--json writes the rows of --track: ask for it too"
    );
    let mut rows = Vec::new();
    if args.track {
        println!("{HEADING}");
    }
    let films = args.knees.iter().flat_map(|seeds| seeds.folders(out));
    for (seed, folder) in films {
        check_source(implants, &folder)?;
        let knee = Knee::drawn(seed);
        knee.write(implants, frames, &folder)?;
        if !args.track {
            println!("{}: {knee}", folder.display());
            continue;
        }
        let measured = follow(&folder, Vec::new(), seed, &Words::Film(knee.to_string()));
        rows.extend(measured.with_context(|| folder.display().to_string())?);
        // Hours of work are kept where a later one ends it.
        write_json(json, &rows)?;
    }
    Ok(())
}

/// A film that a seed draws.
#[derive(Clone, Debug, PartialEq)]
struct Knee {
    seed: u64,
    side: Side,
    activity: Activity,
    /// Of the implants, along the anterior, superior and lateral axis.
    stretch: [f64; 3],
    physics: Physics,
    shutter: f64,
    second_leg: bool,
    leaves_field: bool,
}

impl Knee {
    fn drawn(seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let stretch = std::array::from_fn(|_| random.random_range(0.85..1.35));
        let side = [Side::Left, Side::Right][random.random_range(0..2)];
        let activity = Activity::ALL[random.random_range(0..Activity::ALL.len())];
        let physics = physics(&mut random);
        // Most fluoroscopes flash.
        let shutter = match random.random_bool(0.3) {
            true => random.random_range(0.05..0.6),
            false => 0.0,
        };
        Self {
            seed,
            side,
            activity,
            stretch,
            physics,
            shutter,
            second_leg: random.random_bool(0.3),
            leaves_field: random.random_bool(0.15),
        }
    }

    fn write(&self, implants: &Path, frames: usize, out: &Path) -> Result<()> {
        let options = Options {
            frames,
            seed: self.seed,
            side: self.side,
            activity: Some(self.activity),
            physics: self.physics,
            shutter: self.shutter,
            second_leg: self.second_leg,
            leaves_field: self.leaves_field,
            implants: Some(of_study(implants, self.side, self.stretch)?),
            ..Options::default()
        };
        sequence::write(&options, out)
    }
}

fn physics(random: &mut ChaCha8Rng) -> Physics {
    let mut physics = Physics {
        sampling: Sampling::EXACT,
        ..Physics::default()
    };
    let displays = [Display::Logarithmic, Display::Linear, Display::SquareRoot];
    physics.display = displays[random.random_range(0..displays.len())];
    physics.blur.detector_px = random.random_range(0.3..1.5);
    physics.scatter.share = random.random_range(0.0..0.2);
    physics.scatter.glare = random.random_range(0.0..0.1);
    // As many times more as less.
    physics.exposure = Exposure(random.random_range(-1.2..1.2f64).exp());
    physics.alloys = Alloys {
        femur: random.random_range(0.4..1.0),
        tibia: random.random_range(0.12..0.4),
        hardening: random.random_range(0.0..0.1),
    };
    physics.unsharp = random.random_bool(0.25).then(|| Unsharp {
        amount: random.random_range(0.2..0.8),
        sigma_px: random.random_range(1.0..3.0),
    });
    physics.surroundings.cement = random.random_bool(0.3).then(Cement::default);
    physics.surroundings.screws = random.random_bool(0.2);
    physics.surroundings.ruler = random.random_bool(0.3);
    physics.field = match random.random_bool(0.5) {
        true => Field::Flat,
        false => Field::Round,
    };
    physics
}

impl fmt::Display for Knee {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.stretch;
        let physics = &self.physics;
        write!(
            f,
            "{}, {} knee, stretched by {x:.2}, {y:.2}, {z:.2}, {}, blur {:.2} px, scatter {:.2}, glare {:.2}, exposure {:.2}, {:.2} and {:.2} a mm, hardening {:.2}",
            self.activity,
            self.side,
            physics.display,
            physics.blur.detector_px,
            physics.scatter.share,
            physics.scatter.glare,
            physics.exposure.0,
            physics.alloys.femur,
            physics.alloys.tibia,
            physics.alloys.hardening
        )?;
        if let Some(Unsharp { amount, sigma_px }) = physics.unsharp {
            write!(f, ", edges enhanced by {amount:.2} within {sigma_px:.1} px")?;
        }
        if self.shutter > 0.0 {
            write!(f, ", shutter {:.2}", self.shutter)?;
        }
        let surroundings = &physics.surroundings;
        let others = [
            (surroundings.cement.is_some(), "cement"),
            (surroundings.screws, "screws"),
            (surroundings.ruler, "ruler"),
            (physics.field == Field::Flat, "flat panel"),
            (self.second_leg, "second leg"),
            (self.leaves_field, "leaves the field"),
        ];
        let others = others.into_iter().filter(|(is_there, _)| *is_there);
        others
            .into_iter()
            .try_for_each(|(_, word)| write!(f, ", {word}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_seed_draws_is_not_stated_as_well() {
        #[derive(clap::Parser)]
        struct Verb {
            #[command(flatten)]
            args: crate::verbs::synthetic::Args,
        }
        let parsed = |more: &str| {
            let words = format!("synthetic --knees 1..2 --implants study.toml --out x {more}");
            <Verb as clap::Parser>::try_parse_from(words.split_whitespace()).map(|verb| verb.args)
        };
        assert!(parsed("--frames 12 --track").is_ok());
        for more in [
            "--seed 3",
            "--side right",
            "--activity gait",
            "--blur 1",
            "--cement",
            "--films",
            "--model a.stl",
            "--poses 3",
            "--method image",
            "--jitter 1",
            "--count 3",
        ] {
            assert!(parsed(more).is_err(), "{more}");
        }
        let alone = "synthetic --model a.stl --calibration b.txt --out x";
        assert!(<Verb as clap::Parser>::try_parse_from(alone.split_whitespace()).is_err());
    }

    #[test]
    fn a_seed_draws_the_same_again_and_each_another_film() {
        let mut words = std::collections::BTreeSet::new();
        for seed in 0..50 {
            assert_eq!(Knee::drawn(seed), Knee::drawn(seed));
            words.insert(Knee::drawn(seed).to_string());
        }
        assert_eq!(words.len(), 50);
        for word in [
            "second leg",
            "cement",
            "edges enhanced",
            "shutter",
            "right knee",
            "linear",
        ] {
            let with = words.iter().filter(|words| words.contains(word)).count();
            assert!((1..50).contains(&with), "{word}: {with}");
        }
    }
}

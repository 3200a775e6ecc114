//! Verb `synthetic`: the accuracy protocol of Walker et al. 1996 on random known poses.

mod activity;
mod anywhere;
mod films;
mod implants;
mod knees;
mod physics;
mod protocol;
mod random;
mod ranges;
mod refusal;
mod strangers;

use std::path::PathBuf;

use anyhow::{Context, Result};
use fluoropose::camera::Camera;
use fluoropose::mesh::Model;

use crate::files::{camera_for, check_outputs, read_calibration, read_model, write_json};
use crate::finding::{Method, ViewOptions};
use crate::noise::DisturbanceOptions;
use crate::options::{Pair, at_least_1};
use ranges::FAILURE_DEG;

pub use anywhere::{Anywhere, Places, measure_anywhere};
pub use films::{FilmKind, FilmRow, FilmWay, Films, JointBands, measure_films};
pub use protocol::{Accuracy, Protocol, StartOff, Variant, measure, measure_as};
pub use refusal::{Kind, Refusal, measure_refusal};

// What stands with --films, --activity, --any-view or --refusal alone requires the group of that option, of which it is the only one: of an option
// that is missing and in conflict with another one on the line the command line's parser says nothing.

/// Options of the protocol, which films have no use for.
const OF_THE_PROTOCOL: [&str; 7] = [
    "model",
    "calibration",
    "frame",
    "poses",
    "any_view",
    "refusal",
    "distance",
];
/// Others of it, which poses from anywhere have no use for either: all directions, one method, outlines of their own.
const OF_THE_LIBRARY: [&str; 13] = [
    "biplane",
    "start_off",
    "method",
    "nominal",
    "x",
    "y",
    "area",
    "size",
    "jitter",
    "correlation",
    "occlude",
    "unmarked",
    "noise_seed",
];

/// Options of `synthetic`.
#[derive(clap::Args)]
#[command(
    after_help = "Draws N random poses inside the library's range (x and y within 40 mm of the axis, z within 50 mm of the library's \
distance, z_rot any), renders each as a mask, finds it again and prints mean absolute errors. Poses wrong by more than 4 degrees are \
failures: they are counted and left out of the means, as in Walker et al. 1996.\n\n\
--jitter S draws the outline as a hand would: the model is drawn four times as finely, its outline followed, smoothed of pixel steps, \
moved along its normals by Gaussian noise of the standard deviation S and the correlation length --correlation, and filled again. \
--occlude F hides the part F of the outline's length: behind a half plane, a disc or a band (what is hidden is left out of the mask or \
traced as a part of it), or beyond the frame's border, to which the pose is then moved; the four are equally likely. The finder is told which \
pixels are hidden unless --unmarked is given.\n\n\
Below the errors stand what no unbiased estimator undercuts for this noise (the bound of Cramer and Rao) and what plain least squares \
reaches, root mean square over the same poses, and the errors divided by them. Without jitter the noise is rounding to pixels, \
1/12 square pixel for each pixel of outline.\n\n\
--films measures grey films of the built-in implants instead: display x blur x scatter, an unsharp mask, a square-root display; each component \
found from one click, and refined on the film from its true pose. --activity writes a film with its truth, as the folder of a study. --knees draws all of a film at random, by its seed: a design (a study's implants stretched by 0.85 to 1.35 along each \
axis), knee, activity, display, blur, scatter, exposure, metals, enhanced edges, shutter, and what else is in the beam; --track follows each from nothing and prints its rows, \
as `disguise --track` does.\n\n\
Examples:\n  cargo xtask synthetic --model femur.stl --calibration calibration.txt --poses 150 --seed 1\n  \
cargo xtask synthetic --films --count 25\n  \
cargo xtask synthetic --activity gait --frames 120 --display linear --second-leg --out gait\n  \
cargo xtask synthetic --knees 1..16 --implants study.toml --frames 12 --out knees --track --json rows.json"
)]
pub struct Args {
    /// The implant's model: STL (binary or ASCII), OBJ or PLY, in mm
    #[arg(long, required_unless_present_any = ["films", "activity", "knees"])]
    model: Option<PathBuf>,
    /// Calibration: JT_INTCALIB or a camera matrix (MayaCam 2.0, OpenCV, ROS, MATLAB)
    #[arg(long, required_unless_present_any = ["films", "activity", "knees"])]
    calibration: Option<PathBuf>,
    /// Width and height of the frames, pixels; 1024,1024 if not given, but a camera matrix has its own
    #[arg(long, value_name = "W,H")]
    frame: Option<Pair>,
    /// Number of poses
    #[arg(long, default_value_t = 150, value_parser = at_least_1)]
    poses: usize,
    /// Seed of the random poses
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How poses are found
    #[arg(long, value_parser = Method::of_masks(), default_value = Method::default().word())]
    method: Method,
    /// Start refinement from the pose drawn, turned by DEG about a random axis and moved by MM
    /// aside and MM along the view, instead of from the library: the basin of refinement
    #[arg(long, value_name = "DEG,MM,MM")]
    start_off: Option<StartOff>,
    /// A second camera sees the implant too, from this many degrees aside; method refined
    #[arg(long, value_name = "DEG")]
    biplane: Option<f64>,
    /// Poses of any rotation, found by a library of all directions, method refined: how often the part is found at its
    /// place in the camera's frame
    #[arg(long, group = "anywhere", conflicts_with = "refusal", conflicts_with_all = OF_THE_LIBRARY)]
    any_view: bool,
    /// With --any-view: the model's axes are turned at random too
    #[arg(long, requires = "anywhere")]
    any_axes: bool,
    /// What is called good, doubtful and no fit: outlines of the model by a hand, and outlines that are none of its views
    #[arg(long, group = "refused", conflicts_with_all = OF_THE_LIBRARY)]
    refusal: bool,
    /// With --refusal: a model whose outlines are not the model's, the other component's or another implant's
    #[arg(long, value_name = "FILE", requires = "refused")]
    other: Vec<PathBuf>,
    #[command(flatten)]
    films: films::FilmArgs,
    #[command(flatten)]
    activity: activity::ActivityArgs,
    #[command(flatten)]
    knees: knees::KneeArgs,
    #[command(flatten)]
    views: ViewOptions,
    #[command(flatten)]
    disturbance: DisturbanceOptions,
    /// Write the table as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Runs the verb.
///
/// # Errors
/// For files that cannot be read and views that cannot be rendered.
pub fn run(args: Args) -> Result<()> {
    let models = [&args.model, &args.calibration, &args.activity.implants];
    let models = models.map(Option::as_deref).into_iter();
    check_outputs(
        &[("--json", args.json.as_deref())],
        models.chain(args.other.iter().map(|path| Some(&**path))),
    )?;
    if args.films.films {
        return films::run(&args.films, args.seed, args.json.as_deref());
    }
    if args.activity.activity.is_some() {
        return activity::run(&args.activity, args.seed);
    }
    let places = args
        .activity
        .implants
        .as_ref()
        .zip(args.activity.out.as_ref());
    if let Some((implants, out)) = places.filter(|_| args.knees.knees.is_some()) {
        let frames = args.activity.frames;
        return knees::run(&args.knees, (implants, out), frames, args.json.as_deref());
    }
    let needed = |path: &Option<PathBuf>| path.clone().context("which model and calibration?");
    let model = read_model(&needed(&args.model)?)?;
    let calibration = read_calibration(&needed(&args.calibration)?)?;
    let camera = camera_for(&calibration, args.frame)?;
    let views = args.views.or_window();
    let distance = views.distance_for(&calibration);
    let mesh = model.as_model();
    if args.any_view {
        return run_anywhere(&args, &mesh, camera, distance);
    }
    if args.refusal {
        return run_refusal(&args, &mesh, camera, distance);
    }
    let protocol = Protocol {
        method: args.method,
        distance,
        poses: args.poses,
        seed: args.seed,
        disturbance: args.disturbance,
    };
    let variant = Variant {
        start_off: args.start_off,
        biplane: args.biplane,
    };
    let accuracy = measure_as(mesh, camera, &views, &protocol, variant)?;
    println!(
        "{} poses, seed {}, {} triangles, library of {} views at {distance} mm, method {}",
        args.poses,
        args.seed,
        model.as_model().triangles().len(),
        views.grid().views(),
        args.method.word(),
    );
    print(&accuracy);
    write_json(args.json.as_deref(), &accuracy)
}

fn run_anywhere(args: &Args, model: &Model<'_>, camera: Camera, distance: f64) -> Result<()> {
    let what = Anywhere {
        any_axes: args.any_axes,
        distance,
        poses: args.poses,
        seed: args.seed,
    };
    let places = measure_anywhere(model, camera, &what)?;
    println!(
        "{} poses: {} right, {} open with the right pose among the candidates ({:.1} % together), {} else doubted, {} wrong and called good",
        places.poses,
        places.right,
        places.among_candidates,
        100.0 * places.part(),
        places.doubted,
        places.wrong
    );
    write_json(args.json.as_deref(), &places)
}

fn run_refusal(args: &Args, model: &Model<'_>, camera: Camera, distance: f64) -> Result<()> {
    let others = args.other.iter().map(|path| read_model(path));
    let others = others.collect::<Result<Vec<_>>>()?;
    let what = Refusal {
        others: &others,
        distance,
        poses: args.poses,
        seed: args.seed,
    };
    let kinds = measure_refusal(model, camera, &what)?;
    refusal::print(&kinds);
    write_json(args.json.as_deref(), &kinds)
}

fn print(accuracy: &Accuracy) {
    println!("in-plane rotation      {:.3} deg", accuracy.in_plane_deg);
    println!(
        "out-of-plane rotation  {:.3} deg",
        accuracy.out_of_plane_deg
    );
    println!("in-plane translation   {:.3} mm", accuracy.in_plane_mm);
    println!("out-of-plane           {:.3} mm", accuracy.out_of_plane_mm);
    println!("failures (over {FAILURE_DEG} deg) {}", accuracy.failures);
    println!("on the wrong side      {}", accuracy.wrong_side);
    println!("within 1 deg           {}", accuracy.within_1_deg);
    if accuracy.not_found > 0 {
        println!("no pose found          {}", accuracy.not_found);
    }
    if accuracy.regions > 0 {
        println!(
            "in its 95 % region     {} of {} ({:.1} %)",
            accuracy.covered,
            accuracy.regions,
            100.0 * accuracy.covered as f64 / accuracy.regions as f64
        );
        let [narrow, wide] = accuracy.inside.words();
        println!("in their 68 %, by number: x, y, z, rot. z, x, y {narrow} %");
        println!("in their 95 %, by number: x, y, z, rot. z, x, y {wide} %");
    }
    accuracy.limits.print(&accuracy.rms, &accuracy.median);
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROTOCOL: &str = "--model a.stl --calibration b.txt";
    const AROUND: &str =
        "--model a.stl --calibration b.txt --any-view --any-axes --poses 20 --distance 900";
    const ACTIVITY: &str = "--activity gait --out x --frames 3 --side right --cement --second-leg";
    /// What is asked for, and options that go with it.
    const RIGHT: [(&str, &str); 6] = [
        (AROUND, ""),
        (ACTIVITY, ""),
        ("--films", "--count 3 --only cement --way click --seed 4"),
        (
            PROTOCOL,
            "--jitter 1 --correlation 5 --occlude 0.2 --unmarked",
        ),
        (PROTOCOL, "--refusal --other a.stl"),
        (PROTOCOL, "--method refined --x=-3:3:1"),
    ];
    /// The same, and options each of which it has no use for.
    const WRONG: [(&str, &str); 9] = [
        (
            PROTOCOL,
            "--count 3|--only cement|--way click|--any-axes|--other c.stl",
        ),
        (PROTOCOL, "--x=-3:3:1 --any-axes|--x=-3:3:1 --other c.stl"),
        (
            PROTOCOL,
            "--frames 3|--implants s|--stretch 1,1,1|--blur 1|--out x",
        ),
        (
            PROTOCOL,
            "--poses 0|--unmarked|--correlation 3|--method image",
        ),
        (AROUND, "--method image|--x=-3:3:1|--jitter 1|--refusal"),
        (ACTIVITY, "--model a.stl|--poses 3|--json a.json|--jitter 1"),
        (ACTIVITY, "--films|--any-view"),
        ("--films", "--model a.stl|--poses 3|--frames 3"),
        ("--films", "--display linear|--count 0"),
    ];

    #[test]
    fn what_would_be_left_out_is_refused() {
        #[derive(clap::Parser)]
        struct Verb {
            #[command(flatten)]
            args: Args,
        }
        let parsed = |what: &str, more: &str| {
            let words = ["synthetic", what, more];
            let words = words.iter().flat_map(|words| words.split_whitespace());
            <Verb as clap::Parser>::try_parse_from(words).map(|verb| verb.args)
        };
        for (what, more) in RIGHT {
            assert!(parsed(what, more).is_ok(), "{what} {more}");
        }
        for (what, all) in WRONG {
            for more in all.split('|') {
                assert!(parsed(what, more).is_err(), "{what} {more}");
            }
        }
    }
}

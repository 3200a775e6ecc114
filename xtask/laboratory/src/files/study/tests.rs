//! What studies say, and how they are refused.

use super::*;

mod stated;

fn read(text: &str) -> Result<Study> {
    let name = format!(
        "fluoropose-study-{}-{}.toml",
        std::process::id(),
        text.len()
    );
    let path = std::env::temp_dir().join(name);
    std::fs::write(&path, text).unwrap();
    let study = Study::read(&path);
    std::fs::remove_file(&path).unwrap();
    study
}

#[test]
fn unknown_pixels_belong_to_a_source_of_masks() {
    let component =
        "name = 'left'\ncalibration = 'c.txt'\n[[component]]\nname = 'femur'\nmodel = 'f.stl'\n";
    let study = read(&format!(
        "{component}masks.hand = 'm'\nunknown.hand = 'u'\n"
    ));
    let unknown = &study.unwrap().components[0].unknown["hand"];
    assert_eq!(unknown, &std::env::temp_dir().join("u"));
    let stray = read(&format!(
        "{component}masks.hand = 'm'\nunknown.foot = 'u'\n"
    ));
    let message = format!("{:#}", stray.unwrap_err());
    assert!(message.contains("unknown.foot"), "{message}");
}

#[test]
fn a_film_is_stated_in_whole_or_in_part() {
    let film = |keys: &str| {
        let study = read(&format!(
            "name = 'left'\ncalibration = 'c.txt'\n[film]\n{keys}\n[[component]]\nname = 'femur'\nmodel = 'f.stl'\n"
        ))?;
        Ok::<_, anyhow::Error>(study.film.expect("it is there"))
    };
    let whole = film("curvature = 0.025\nblur_px = 0.8").unwrap();
    let constants = whole.constants().expect("all of them");
    assert_eq!((constants.curvature, constants.blur_px), (0.025, 0.8));
    let part = film("display = 'logarithmic'").unwrap();
    assert_eq!(part.constants(), None);
    assert_eq!(part.given().display, Some(DisplayKind::Logarithmic));
    assert_eq!(film("blur_px = 1.3").unwrap().given().blur_px, Some(1.3));
    for wrong in [
        "curvature = 0.025",
        "curvature = 0.025\nblur_px = 0.8\ndisplay = 'linear'",
        "blur_px = 0.0",
        "curvature = -1.0\nblur_px = 0.8",
        "display = 'bent'",
        "blur_px = 500.0",
        "curvature = 1e9\nblur_px = 0.8",
        "colour = 1",
    ] {
        assert!(film(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn an_attenuation_goes_with_a_film_that_is_stated_and_the_other_way_round() {
    let whole = "[film]\ncurvature = 0.025\nblur_px = 0.8\n";
    let own = "attenuation = 0.7\n";
    let remarks = |film: &str, attenuation: &str| {
        let text = format!("{STUDY}{film}{FEMUR}{attenuation}");
        let (_, remarks) = Study::of(&text, Path::new("study.toml")).unwrap();
        remarks.join("; ")
    };
    assert_eq!(remarks("", "") + &remarks(whole, own), "");
    let without = remarks(whole, "");
    assert!(
        without.contains("line 6: component femur: states no attenuation"),
        "{without}"
    );
    for film in ["", "[film]\nblur_px = 0.8\n"] {
        assert!(remarks(film, own).contains("which is left out"));
    }
}

#[test]
fn names_that_lead_elsewhere_are_refused() {
    let head = "name = 'left'\ncalibration = 'c.txt'\n[[component]]\nmodel = 'f.stl'\n";
    for hostile in [
        "name = '../femur'",
        "name = '/tmp/femur'",
        "name = 'NUL'",
        "name = 'femur'\nmasks.'../m' = 'm'",
        "name = 'femur'\npeer.'a/b' = 'p.jts'",
    ] {
        let error = read(&format!("{head}{hostile}\n")).unwrap_err();
        assert!(
            format!("{error:#}").contains("is no name for a file"),
            "{error:#}"
        );
    }
}

#[test]
fn a_role_is_told_or_follows_from_the_name() {
    let study = read(
        "name = 'left'\ncalibration = 'c.txt'\n\
         [[component]]\nname = 'Femur'\nmodel = 'f.stl'\n\
         [[component]]\nname = 'tray'\nrole = 'tibia'\nmodel = 't.stl'\n\
         [[component]]\nname = 'patella'\nmodel = 'p.stl'\n",
    );
    let components = study.unwrap().components;
    let roles: Vec<Option<Role>> = components.iter().map(Component::role).collect();
    assert_eq!(roles, [Some(Role::Femur), Some(Role::Tibia), None]);
}

/// What is said of a study that is refused.
fn refused(text: &str) -> String {
    format!("{:#}", read(text).unwrap_err())
}

const STUDY: &str = "name = 'left'\ncalibration = 'c.txt'\n";
const FEMUR: &str = "[[component]]\nname = 'femur'\nmodel = 'f.stl'\n";

/// Studies that are refused, and words of why; `STUDY;` and `FEMUR;` stand for what most begin and end with.
const FAULTY: &[(&str, [&str; 2])] = &[
    (
        "STUDY;component = []\n",
        ["line 3: component holds none", "as in [[component]]"],
    ),
    (
        // A path as Windows writes it: a backslash and an f are a form feed.
        "STUDY;frames = \"x-rays\\frames\"\nFEMUR;",
        [
            "line 3: frames must be a file or folder",
            "write / in its place",
        ],
    ),
    (
        "STUDY;FEMUR;masks.hand = \"\\tmasks\"\n",
        [
            "line 6: component femur: masks must be",
            "write / in its place",
        ],
    ),
    (
        "STUDY;FEMUR;axes = 'x y'\n",
        [
            "line 6: component femur: axes: axes are three of",
            "it is \"x y\"",
        ],
    ),
    (
        "STUDY;FEMUR;axes = 'x y -z'\n",
        ["line 6: component femur: axes: ", "right-handed"],
    ),
    (
        "STUDY;FEMUR;nominal = [inf, 0.0]\n",
        [
            "line 6: component femur: nominal must be two numbers",
            "a list of 2",
        ],
    ),
    (
        "name = 'left'\ncalibraton = 'c.txt'\nFEMUR;",
        [
            "line 2: the key \"calibraton\" is not known",
            "was calibration meant?",
        ],
    ),
    (
        "name = 'left'\nFEMUR;",
        [
            "the key calibration is missing",
            "as in calibration = \"calibration.txt\"",
        ],
    ),
    (
        "STUDY;[component]\nname = 'femur'\nmodel = 'f.stl'\n",
        [
            "line 3: [component] needs two brackets, [[component]]",
            "several",
        ],
    ),
    (
        "STUDY;[component]\nname = 'femur'\n\n[component]\nname = 'tibia'\n",
        ["line 6: [component] needs two brackets", "[[component]]"],
    ),
    (
        "STUDY;[[components]]\nname = 'femur'\nmodel = 'f.stl'\n",
        [
            "line 3: the key \"components\" is not known",
            "was component meant?",
        ],
    ),
    ("STUDY;", ["the key component is missing", "[[component]]"]),
    (
        "STUDY;frames_per_s = '15'\nFEMUR;",
        [
            "line 3: frames_per_s must be a number above 0, as in frames_per_s = 15.0",
            "it is \"15\"",
        ],
    ),
    (
        "STUDY;side = 'Left'\nFEMUR;",
        [
            "line 3: side must be \"left\" or \"right\"",
            "it is \"Left\"",
        ],
    ),
    (
        "STUDY;FEMUR;distance_mm = 'far'\n",
        [
            "line 6: component femur: distance_mm must be a number above 0",
            "it is \"far\"",
        ],
    ),
    (
        "STUDY;FEMUR;attenuation = -1.08\n",
        [
            "line 6: component femur: attenuation must be a number above 0",
            "it is -1.08",
        ],
    ),
    (
        "STUDY;FEMUR;nominal = [0.0]\n",
        [
            "line 6: component femur: nominal must be two numbers",
            "a list of 1",
        ],
    ),
    (
        "STUDY;FEMUR;masks = 'masks'\n",
        [
            "line 6: component femur: masks must be files or folders",
            "masks.hand = \"masks/femur\"",
        ],
    ),
    (
        "STUDY;FEMUR;side = 'left'\n",
        [
            "line 6: component femur: the key \"side\" is not known there",
            "before the first [[component]]",
        ],
    ),
    (
        "STUDY;[[component]]\nname = 'femur'\nmdel = 'f.stl'\n",
        [
            "line 5: component femur: the key \"mdel\" is not known",
            "was model meant?",
        ],
    ),
    (
        "STUDY;[[component]]\nmodel = 'f.stl'\n",
        [
            "the [[component]] of line 3: the key name is missing",
            "name = \"femur\"",
        ],
    ),
    (
        "STUDY;FEMUR;[[component]]\nname = 'Femur'\nmodel = 'f.stl'\n",
        [
            "line 6: there is another component \"Femur\" (line 3: \"femur\")",
            "name of its own",
        ],
    ),
    (
        "STUDY;side = left\nFEMUR;",
        ["line 3: side: text needs quotes", "side = \"left\""],
    ),
    (
        "STUDY;[[component]]\nname = femur # the left one\nmodel = 'f.stl'\n",
        ["line 4: name: text needs quotes", "as in name = \"femur\""],
    ),
    (
        "STUDY;FEMUR;masks.hand = masks/femur\n",
        ["line 6: masks.hand: text needs quotes", "\"masks/femur\""],
    ),
    (
        "STUDY;frames = \u{201c}frames\u{201d}\nFEMUR;",
        ["line 3: text stands between straight quotes", "typographic"],
    ),
    ("STUDY;frames_per_s = 15,0\nFEMUR;", ["line 3: ", "newline"]),
];

#[test]
fn a_name_that_is_nearly_that_of_a_component_is_told() {
    let remarks = |name: &str| {
        let component = format!("[[component]]\nname = '{name}'\nmodel = 'f.stl'\n");
        let text = format!("{STUDY}{component}");
        Study::of(&text, Path::new("s.toml")).expect("a study").1
    };
    for (name, role) in [
        ("tibai", "tibia"),
        ("Femural", "femur"),
        ("tibial tray", "tibia"),
    ] {
        let told = remarks(name);
        let words = format!("if it is meant, state role = {role:?}");
        assert!(
            matches!(&told[..], [one] if one.starts_with("line 3: ") && one.ends_with(&words)),
            "{told:?}"
        );
    }
    assert!(remarks("patella").is_empty() && remarks("Femur").is_empty());
}

#[test]
fn faults_are_told_with_file_line_key_and_what_was_expected() {
    for (text, words) in FAULTY {
        let text = text.replace("STUDY;", STUDY).replace("FEMUR;", FEMUR);
        let said = refused(&text);
        assert!(
            said.starts_with("in ") && said.contains(".toml: "),
            "{said}"
        );
        for word in words {
            assert!(said.contains(word), "{said}");
        }
        assert!(!said.contains('\n'), "{said}");
    }
}

#[test]
fn what_is_not_known_is_told_and_left_out() {
    let text = format!("{STUDY}frame = 'f'\nlater = 1\n{FEMUR}");
    let (study, remarks) = Study::of(&text, Path::new("x/study.toml")).unwrap();
    assert_eq!(
        remarks,
        [
            "line 3: the key \"frame\" is not known and left out: was frames meant?",
            "line 4: the key \"later\" is not known and left out"
        ]
    );
    let lack = format!("{:#}", study.frames_folder().unwrap_err());
    assert!(
        lack.starts_with("in x/study.toml: the key frames is missing, as in frames = "),
        "{lack}"
    );
    let lack = format!("{:#}", study.known_side().unwrap_err());
    assert!(
        lack.contains("the key side is missing, as in side = \"left\""),
        "{lack}"
    );
}

#[test]
fn a_file_that_is_not_there_is_told_with_its_key() {
    // Names that nobody else has beside it.
    let own = |name: &str| format!("fluoropose-{}-{name}", std::process::id());
    let text = format!("{STUDY}{FEMUR}");
    let text = ["c.txt", "f.stl"]
        .iter()
        .fold(text, |text, name| text.replace(name, &own(name)));
    let study = read(&text).unwrap();
    let told = || format!("{:#}", study.check_files(None).unwrap_err());
    assert!(
        told().contains(".toml: line 2: calibration: there is no "),
        "{}",
        told()
    );
    std::fs::write(&study.calibration, "").unwrap();
    let told = told();
    std::fs::remove_file(&study.calibration).unwrap();
    assert!(
        told.contains(".toml: line 5: model: there is no "),
        "{told}"
    );
    assert!(told.ends_with("f.stl"), "{told}");
}

#[test]
fn what_may_be_meant_by_a_file_that_is_not_there_is_told() {
    let folder = std::env::temp_dir().join(format!("fluoropose-absent-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("Frames")).unwrap();
    // A letter and its mark, as systems write it that take names apart.
    std::fs::create_dir_all(folder.join("Ro\u{308}ntgen")).unwrap();
    std::fs::write(folder.join("f.STL"), "").unwrap();
    std::fs::write(folder.join("c.txt"), "").unwrap();
    let told = |frames: &str, model: &str| {
        let text = format!("{STUDY}frames = '{frames}'\n{FEMUR}").replace("f.stl", model);
        let study = Study::of(&text, &folder.join("s.toml")).unwrap().0;
        let frames = study.frames_folder().unwrap();
        format!("{:#}", study.check_files(Some(frames)).unwrap_err())
    };
    let cases = [
        told("Frames", "f.ply"),
        told("frames", "f.STL"),
        told("R\u{f6}ntgen", "f.STL"),
        told("x/frames", "f.STL"),
        told("Frames/*.png", "f.STL"),
        told("films", "f.STL"),
        told("C:\\films\\one", "f.STL"),
        told("~/films", "f.STL"),
    ];
    std::fs::remove_dir_all(&folder).unwrap();
    let ends = [
        ": was \"f.STL\" meant?",
        ": was \"Frames\" meant?",
        "that look alike; copy its name",
        "x is not there",
        ": patterns are not read, name the folder or one file",
        "films",
        "write it from the study's folder",
        "write it from the study's folder",
    ];
    for (told, end) in cases.iter().zip(ends) {
        assert!(told.ends_with(end), "{told}");
    }
}

/// The joint is of one femur and one tibia: of two nothing tells which.
#[test]
fn two_components_of_one_role_are_told() {
    let text =
        format!("{STUDY}{FEMUR}[[component]]\nname = 'old'\nrole = 'femur'\nmodel = 'f.stl'\n");
    let (_, remarks) = Study::of(&text, Path::new("s.toml")).unwrap();
    let [told] = remarks.try_into().unwrap();
    assert!(
        told.starts_with(
            "line 6: the component \"old\" is a second femur, beside \"femur\" (line 3)"
        ),
        "{told}"
    );
}

#[test]
fn frames_and_masks_of_several_sizes_are_refused() {
    use fluoropose_phantom::picture::write_grey;
    let folder = std::env::temp_dir().join(format!("fluoropose-sizes-{}", std::process::id()));
    for (name, side) in [("frames", 32), ("masks", 32), ("half", 16)] {
        std::fs::create_dir_all(folder.join(name)).unwrap();
        let picture = folder.join(name).join("1.png");
        write_grey(&picture, (side, side), &vec![0; side * side]).unwrap();
    }
    let check = |keys: &str| {
        let text = format!("{STUDY}frames = 'frames'\n{FEMUR}{keys}\n");
        Study::of(&text, &folder.join("study.toml"))
            .unwrap()
            .0
            .check_sizes()
    };
    let alike = check("masks.hand = 'masks'\nmasks.net = 'nowhere'");
    let halved = check("masks.hand = 'half'").unwrap_err().to_string();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(alike.is_ok());
    assert!(
        halved.contains("line 7: masks.hand has 16 x 16 pixels ("),
        "{halved}"
    );
    assert!(
        halved.contains("line 3: frames has 32 x 32 pixels ("),
        "{halved}"
    );
}

/// The page opens such studies, and so does the system that they come from.
#[test]
fn paths_with_backslashes_lead_where_those_with_slashes_do() {
    let folder = std::env::temp_dir().join(format!("fluoropose-back-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("x-rays/frames")).unwrap();
    let file = folder.join("study.toml");
    let text = format!("{STUDY}frames = 'x-rays\\frames'\n{FEMUR}");
    std::fs::write(&file, text).unwrap();
    let study = Study::read(&file).unwrap();
    assert!(study.frames_folder().unwrap().is_dir());
    std::fs::remove_dir_all(folder).unwrap();
}

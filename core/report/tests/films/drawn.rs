//! The figure and the report tell what a reader must know.

use fluoropose::joint::numbers::{NUMBERS, place};
use fluoropose_report::levels::by_flexion;
use fluoropose_report::{Facts, Input, JointFilm, JointRow, figure, html, read, write};

use crate::film;

#[test]
fn the_figure_has_four_panels_and_tells_its_centre() {
    let picture = figure(&film(12.0)).svg();
    for letter in ["a", "b", "c", "d"] {
        assert!(
            picture.contains(&format!("font-weight=\"bold\">{letter}</text>")),
            "{letter}"
        );
    }
    assert!(
        picture
            .contains("centre of rotation 4.0 \u{b1} 0.0 mm posterior, 12.0 \u{b1} 0.0 mm medial")
    );
    assert!(picture.contains("<title>Joint motion of a &amp; b</title>"));
    assert!(
        picture.contains("<title>frame 16: "),
        "points name their frames"
    );
    assert!(!picture.contains("NaN") && !picture.contains("inf"));
    // Levels at 0, 10, .. 50 degrees: a line on the tray for each but 10, whose frame is doubtful.
    assert_eq!(picture.matches("stroke-width=\"1.5\"").count(), 5);
    assert!(!picture.contains("each line is a frame"));
    let little = figure(&film(2.0)).svg();
    assert!(little.contains("the condyle lines turn by 2.0\u{b0} only"));
}

/// Every second frame is doubtful, so that nothing is passed: there are lines of frames, bars instead of bands, and words instead of a table.
#[test]
fn a_film_without_steps_shows_its_frames() {
    let mut gapped = film(12.0);
    for row in gapped.rows.iter_mut().step_by(2) {
        row.doubt = Some("a rim".to_owned());
    }
    let picture = figure(&gapped).svg();
    assert!(picture.contains("each line is a frame"));
    // 15 frames are left, of which one is doubtful by itself.
    let lines = picture.lines().filter(|line| {
        line.contains("<polyline") && line.contains("\"0.8\"") && !line.contains("#111111")
    });
    assert_eq!(lines.count(), 14);
    let report = html(&gapped, &Facts::default());
    assert!(report.contains("<p>None: no run of frames without doubt"));
    assert!(!report.contains("n: monotonic phases"));
}

/// Of a film in which most frames have no tray, those that have one are not called doubtful because of the others.
#[test]
fn frames_without_a_joint_count_as_missing_and_not_as_doubtful() {
    let mut sparse = film(12.0);
    for row in sparse.rows.iter_mut().filter(|row| row.number > 20) {
        row.joint = None;
        row.doubt = Some("tibia: there are no edges of it where it is expected".to_owned());
    }
    assert_eq!((sparse.posed(), sparse.doubtful()), (9, 1));
    let report = html(&sparse, &Facts::default());
    assert!(report.contains("30 frames: 9 with a pose of both components, 1 doubtful."));
    assert!(!report.contains("All 9 frames are doubtful"));
    assert!(
        report.contains("there are no edges of it"),
        "why they have none"
    );
}

/// A centre known to 200 mm: its bars end where the panel does.
#[test]
fn bars_of_the_centre_stay_in_their_panel() {
    let mut vague = film(12.0);
    for row in &mut vague.rows {
        for joint in row.joint.iter_mut() {
            joint.deviations = Some([0.5; NUMBERS]);
            joint.shared[0][place::MEDIAL_ACROSS] = 300.0;
            joint.shared[0][place::LATERAL_ACROSS] = 300.0;
        }
    }
    let picture = figure(&vague).svg();
    let bars: Vec<Vec<f64>> = picture
        .lines()
        .filter(|line| line.contains("<polyline") && line.contains("\"1.4\""))
        .filter_map(|line| line.split("points=\"").nth(1)?.split('"').next())
        .map(|points| points.split([' ', ',']).flat_map(str::parse).collect())
        .collect();
    assert_eq!(bars.len(), 2, "{picture}");
    // Where the tray is drawn, its words left out.
    for bar in &bars {
        let ends = bar.as_chunks::<2>().0;
        let is_inside =
            |&[x, y]: &[f64; 2]| (34.0..=354.0).contains(&x) && (360.0..=578.0).contains(&y);
        assert!(ends.len() == 2 && ends.iter().all(is_inside), "{bar:?}");
    }
    assert!(bars.iter().any(|bar| bar[0] == 34.0 && bar[2] == 354.0));
}

#[test]
fn doubtful_frames_are_shown_and_count_for_nothing() {
    let mut spoilt = film(12.0);
    let joint = spoilt.rows[5].joint.as_mut().unwrap();
    joint.numbers[place::LATERAL_AP] = 900.0;
    joint.numbers[place::FLEXION] = -17.0;
    let (clean, pivot) = (film(12.0).pivot().unwrap(), spoilt.pivot().unwrap());
    assert_eq!((clean.n, pivot), (28, clean));
    // At 10 degrees there is but a doubtful frame, and no row.
    assert_eq!(spoilt.levels(), [0.0, 20.0, 30.0, 40.0, 50.0]);
    let steps = by_flexion(&spoilt);
    assert!(steps.len() == 5 && steps.iter().all(|level| level.steps[place::FLEXION].n > 0));
    let at = |film: &JointFilm| film.at(place::LATERAL_AP, &film.phases(), 30.0).mean;
    assert_eq!(at(&spoilt), at(&film(12.0)));
    assert!(
        figure(&spoilt)
            .svg()
            .contains("<title>frame 16: 900.00</title>")
    );
}

/// A tibia on the wrong side of its mirror: told, left out, and not drawn.
#[test]
fn numbers_that_no_knee_has_are_told_and_not_drawn() {
    let mut spoilt = film(12.0);
    for k in [12, 13, 20] {
        let mut joint = spoilt.rows[k].joint.unwrap();
        joint.numbers[place::ROTATION] = 160.0;
        spoilt.rows[k] = JointRow::new(k + 11, Some(joint), None);
    }
    let why = "internal rotation would be 160\u{b0}, which no knee does";
    assert_eq!(spoilt.rows[13].doubt.as_ref().unwrap().find(why), Some(0));
    let [told] = &spoilt.impossibilities()[..] else {
        panic!("one kind")
    };
    assert!(
        told.starts_with("frame 23 and 2 more: ") && told.contains(why),
        "{told}"
    );
    let picture = figure(&spoilt).svg();
    assert!(!picture.contains(": 160.00") && picture.contains("not drawn, no knee does that: 3"));
    assert!(picture.contains("<title>frame 22: "));
    let page = html(&spoilt, &Facts::default());
    assert!(page.contains("23\u{2013}24, 31</td>") && page.contains(why) && page.contains("160.0"));
    assert!(!page.contains("All 29 frames"));
    assert!(write::table(&spoilt).contains(why));
    for row in &mut spoilt.rows {
        *row = JointRow::new(
            row.number,
            row.joint,
            Some("a tray on the wrong side".to_owned()),
        );
    }
    let page = html(&spoilt, &Facts::default());
    assert!(page.contains("All 29 frames are doubtful") && page.contains("In 3 of them"));
    assert!(page.contains("11\u{2013}22, 25\u{2013}30, 32\u{2013}40</td>"));
}

/// An angle that passes half a turn is no line across the figure.
#[test]
fn no_line_joins_angles_that_jump() {
    let lines = |jump: f64| {
        let mut film = film(12.0);
        for (k, row) in film.rows.iter_mut().enumerate() {
            if let Some(joint) = &mut row.joint {
                joint.numbers[place::ROTATION] += if k < 15 { -30.0 } else { jump - 30.0 };
            }
        }
        let picture = figure(&film).svg();
        let frames = picture.split("<g class=\"frames\">").nth(3).unwrap();
        frames
            .split("</g>")
            .next()
            .unwrap()
            .matches("<polyline")
            .count()
    };
    assert_eq!((lines(0.0), lines(40.0), lines(48.0)), (2, 2, 3));
}

#[test]
fn a_film_without_anything_is_drawn_empty() {
    let mut nothing = film(12.0);
    nothing.rows.iter_mut().for_each(|row| row.joint = None);
    let picture = figure(&nothing).svg();
    assert!(picture.contains("too few condyle lines") && !picture.contains("NaN"));
    (nothing.plate_depth_mm, nothing.plate_width_mm) = (0.0, 0.0);
    let picture = figure(&nothing).svg();
    assert!(picture.contains("lowest points are not known") && !picture.contains("NaN"));
    nothing.rows.clear();
    assert!(html(&nothing, &Facts::default()).contains("0 frames"));
}

#[test]
fn the_report_names_inputs_settings_doubts_and_limits() {
    let facts = Facts {
        inputs: vec![Input {
            what: "femoral model".to_owned(),
            name: "f.stl".to_owned(),
            sha256: "00ff".to_owned(),
        }],
        settings: vec![("poses".to_owned(), "of a <hand>".to_owned())],
        remarks: vec!["The front is <guessed>.".to_owned()],
    };
    let mut turning = film(12.0);
    if let Some(joint) = &mut turning.rows[0].joint {
        joint.numbers[place::LIFT_OFF] = -0.04;
        joint.numbers[place::ROTATION] = -0.06;
    }
    let page = html(&turning, &facts);
    assert!(!page.contains("\u{2212}0.0<") && page.contains("\u{2212}0.1<"));
    let unknown = html(&without_deviations(film(12.0)), &facts);
    assert!(unknown.contains("Not known: the poses come without covariances"));
    for words in [
        "a &amp; b: joint motion",
        "30 frames: 29 with a pose of both components, 1 doubtful",
        "00ff",
        "The front is &lt;guessed&gt;.",
        "of a &lt;hand&gt;",
        "15 frames a second",
        "\"rim&quot; &lt;inner&gt;".trim_start_matches('"'),
        "empty everywhere: 19",
        "Lowest points are not contact",
        "<tr><td>lift-off, mm</td><td>at most 0.5</td><td>at most 0.5</td></tr>",
        "<svg",
    ] {
        assert!(page.contains(words), "{words}");
    }
    assert!(
        !page.contains("http://")
            || page.matches("http://").count() == page.matches("http://www.w3.org").count()
    );
}

fn without_deviations(mut film: JointFilm) -> JointFilm {
    for joint in film.rows.iter_mut().filter_map(|row| row.joint.as_mut()) {
        joint.deviations = None;
    }
    film
}

#[test]
fn what_nobody_judged_is_not_said_to_be_good_and_what_a_person_accepted_is_told() {
    let told = |film: &JointFilm| {
        let page = html(film, &Facts::default());
        let table = write::table(film);
        let heading: Vec<&str> = table.lines().filter(|line| line.starts_with('#')).collect();
        (page, heading.join("\n"))
    };
    let (page, heading) = told(&film(0.0));
    assert!(page.contains("29 with a pose of both components, 1 doubtful. Made by"));
    assert!(!page.contains("Nothing says") && !heading.contains("until a person"));

    let mut unjudged = film(0.0);
    unjudged.has_verdicts = false;
    unjudged.rows.iter_mut().for_each(|row| row.doubt = None);
    let (page, heading) = told(&unjudged);
    assert!(page.contains(
        "29 with a pose of both components, which of them are doubtful is not known. Made"
    ));
    assert!(
        page.contains("Which frames are doubtful is not known")
            && !page.contains("No frame is marked")
    );
    for text in [&page, &heading] {
        assert!(
            text.contains("Nothing says how far the poses are to be trusted"),
            "{text}"
        );
    }

    let back = |film: &JointFilm| read::film(&write::table(film)).map(|film| film.has_verdicts);
    assert_eq!([back(&film(0.0)), back(&unjudged)], [Ok(true), Ok(false)]);

    let mut accepted = film(0.0);
    for row in &mut accepted.rows[3..5] {
        row.accepted = Some("tibia: ambiguous, perhaps".to_owned());
    }
    let (page, heading) = told(&accepted);
    assert!(page.contains("1 doubtful, 2 more that were until a person checked them"));
    accepted.remarks.push("Side: <left>?".to_owned());
    let facts = Facts {
        remarks: accepted.remarks.clone(),
        ..Facts::default()
    };
    // At the top, and not once more.
    let parts = html(&accepted, &facts);
    let parts: Vec<&str> = parts.split("Side: &lt;left&gt;?").collect();
    assert!(parts.len() == 2 && !parts[0].contains("<h2>"));
    let frames = "checked them: 14 (tibia: ambiguous, perhaps), 15 (tibia: ambiguous, perhaps).";
    assert!(heading.contains(frames), "{heading}");
    // A row for each reason with all its frames, and no sentence that is as long as the film.
    assert!(!page.contains(frames));
    let row =
        "<td class=\"frames\">14\u{2013}15</td><td class=\"word\">tibia: ambiguous, perhaps</td>";
    let (_, section) = page
        .split_once("Doubtful until a person checked them")
        .expect("its heading");
    assert!(section.contains(row), "{section}");
}

/// As it is without models: lift-off and lowest points are not known, nor how well.
#[test]
fn what_is_not_known_is_not_drawn() {
    let mut bare = film(12.0);
    for joint in bare.rows.iter_mut().filter_map(|row| row.joint.as_mut()) {
        let mut deviations = joint.deviations.unwrap_or([0.5; NUMBERS]);
        joint.numbers[place::MEDIAL_AP..].fill(f64::NAN);
        deviations[place::MEDIAL_AP..].fill(f64::NAN);
        joint.deviations = Some(deviations);
    }
    let picture = figure(&bare);
    assert!(!picture.svg().contains("NaN"));
    assert!(!String::from_utf8_lossy(&picture.pdf()).contains("NaN"));
}

#[test]
fn marks_of_an_axis_differ() {
    let mut narrow = film(12.0);
    for (k, row) in narrow.rows.iter_mut().enumerate() {
        if let Some(joint) = &mut row.joint {
            joint.numbers[place::ABDUCTION] = 0.3 + 0.002 * k as f64;
            joint.deviations = None;
        }
    }
    let picture = figure(&narrow).svg();
    let texts = picture
        .split("</text>")
        .filter_map(|text| text.rsplit_once('>'));
    let labels: Vec<&str> = texts
        .map(|(_, text)| text)
        .filter(|text| text.starts_with("0.3"))
        .collect();
    let mut distinct = labels.clone();
    distinct.dedup();
    assert!(labels.len() > 1 && distinct == labels, "{labels:?}");
}

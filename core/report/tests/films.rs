//! A made-up film as files, figure and report: what is written reads back, and what a reader must be told stands there.
#![allow(clippy::unwrap_used, reason = "a refusal fails the test")]

use fluoropose::Side;
use fluoropose::joint::numbers::{NUMBERS, place};
use fluoropose::joint::shared::ERRORS;
use fluoropose::joint::{COLUMNS, JointFrame};
use fluoropose::pose::{EulerPose, Pose, geodesic_deg, jts};
use fluoropose_report::levels::{FilmLevels, by_flexion};
use fluoropose_report::{
    Facts, Group, Input, JointFilm, JointRow, Knee, cohorts, figure, group_figure, html, read,
    write,
};

/// Bent from 0 to 58 degrees in 2-degree steps about a centre at (-4, 12); frame 8 has no pose, frame 5 is doubtful.
fn film(rotation_deg: f64) -> JointFilm {
    let row = |k: usize| {
        let turn = (rotation_deg * (k as f64 / 29.0 - 0.5)).to_radians();
        let mut numbers = [0.0; NUMBERS];
        for (number, value) in numbers.iter_mut().enumerate() {
            *value = number as f64 + 0.1 * (k as f64).sin();
        }
        numbers[place::FLEXION] = 2.0 * k as f64;
        numbers[place::ROTATION] = turn.to_degrees();
        for (ap, across, at) in [
            (place::MEDIAL_AP, place::MEDIAL_ACROSS, 24.0),
            (place::LATERAL_AP, place::LATERAL_ACROSS, -24.0),
        ] {
            numbers[ap] = -4.0 + (at - 12.0) * turn.sin();
            numbers[across] = 12.0 + (at - 12.0) * turn.cos();
        }
        let deviations = (!k.is_multiple_of(3)).then_some([0.5; NUMBERS]);
        JointRow {
            number: k + 11,
            joint: (k != 8).then_some(JointFrame {
                numbers,
                deviations,
                shared: [[0.0; NUMBERS]; ERRORS],
            }),
            filtered: None,
            checked: k == 2,
            doubt: (k == 5).then(|| "tibia doubtful: \"rim\" <inner>, or not".to_owned()),
        }
    };
    JointFilm {
        name: "a & b".to_owned(),
        side: Side::Left,
        plate_depth_mm: 48.0,
        plate_width_mm: 74.0,
        plate_outline: vec![[24.0, 37.0], [24.0, -37.0], [-24.0, -37.0], [-24.0, 37.0]],
        frames_per_s: Some(15.0),
        cutoff_hz: None,
        rows: (0..30).map(row).collect(),
    }
}

#[test]
fn the_table_reads_back_to_the_last_bit() {
    let film = film(12.0);
    let table = read::table(&write::table(&film)).unwrap();
    assert_eq!(table.rows.len(), 30);
    assert_eq!(table.column("frame").unwrap()[0], 11.0);
    for (number, column) in COLUMNS.iter().enumerate() {
        let found = table.column(column.name).unwrap();
        let wanted = film.values(number);
        assert!(
            found
                .iter()
                .zip(&wanted)
                .all(|(a, b)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()))
        );
        let sd = table.column(&format!("sd_{}", column.name)).unwrap();
        assert_eq!((sd[1], sd[3].is_nan()), (0.5, true));
    }
    assert_eq!(table.column("checked").unwrap()[1..4], [0.0, 1.0, 0.0]);
    let text = write::table(&film);
    for word in [
        "version 1",
        "filter: none",
        "Grood and Suntay",
        "units: mm",
        "\"\"rim\"\"",
    ] {
        assert!(text.contains(word), "{word}");
    }
    assert!(film.values(3)[8].is_nan());
}

#[test]
fn a_table_reads_back_as_a_film() {
    let film = film(12.0);
    let read = read::film(&write::table(&film)).unwrap();
    assert_eq!((read.name.as_str(), read.side), ("a & b", Side::Left));
    assert_eq!((read.plate_depth_mm, read.plate_width_mm), (48.0, 74.0));
    assert_eq!(read.rows.len(), film.rows.len());
    for (read, row) in read.rows.iter().zip(&film.rows) {
        assert_eq!((read.number, read.checked), (row.number, row.checked));
        assert_eq!((&read.doubt, read.joint), (&row.doubt, row.joint));
    }
    assert!(read::film("frame,x,doubt\n1,2,\"\"\n").is_err());
}

/// Two knees, the first with two films: each knee counts once, and steps that one knee alone reaches have one.
#[test]
fn a_group_is_the_mean_of_its_knees() {
    let raised = |by: f64, frames: usize| {
        let mut film = film(12.0);
        film.rows.truncate(frames);
        for joint in film.rows.iter_mut().filter_map(|row| row.joint.as_mut()) {
            joint.numbers[place::ROTATION] = by;
        }
        FilmLevels::of(&film)
    };
    let knee = |name: &str, films| Knee {
        name: name.to_owned(),
        films,
    };
    let group = Group::new(
        "two <knees>".to_owned(),
        vec![
            knee("p1", vec![raised(2.0, 30), raised(4.0, 30)]),
            knee("p2", vec![raised(9.0, 22)]),
        ],
    );
    // At 10 degrees there is but a doubtful frame.
    assert_eq!(group.levels(), [0.0, 20.0, 30.0, 40.0, 50.0]);
    let at = |level| group.at(place::ROTATION, level);
    assert_eq!((at(30.0).mean, at(30.0).n), (6.0, 2));
    assert!((at(30.0).deviation - 18f64.sqrt()).abs() < 1e-12);
    assert_eq!(
        (at(50.0).mean, at(50.0).n, at(50.0).deviation.is_nan()),
        (3.0, 1, true)
    );
    let text = write::group_table(&group);
    assert!(
        text.contains("# knee p1: a & b, a & b\n")
            && text.lines().last().unwrap().starts_with("50,1,")
            && text.contains(",50,NaN,")
    );
    let picture = group_figure(&group).svg();
    assert!(picture.contains("2 knees, 3 films") && picture.contains("two &lt;knees&gt;"));
    assert!(!picture.contains("NaN") && !picture.contains("inf"));
    // Beside another group: a row for each step of each knee, then of the group.
    let rows = cohorts::table(std::slice::from_ref(&group));
    let row = |begin: &str| rows.lines().find(|line| line.starts_with(begin));
    assert_eq!(rows.lines().count(), 1 + 5 + 4 + 5);
    let rotation = |begin: &str| -> Vec<&str> {
        let fields = row(begin).unwrap().split(',');
        fields.skip(3 + 3 * place::ROTATION).take(3).collect()
    };
    assert_eq!(rotation("\"two <knees>\",\"p1\",30,")[0], "3");
    assert_eq!(rotation("\"two <knees>\",\"p2\",30,"), ["9", "NaN", "1"]);
    assert_eq!(
        rotation("\"two <knees>\",\"mean of the group\",50,"),
        ["3", "NaN", "1"]
    );
    let drawn = cohorts::figure(&[group.clone(), group]).svg();
    assert!(drawn.contains("(n = 2)") && !drawn.contains("NaN"));
    let nothing = group_figure(&Group::new(String::new(), Vec::new())).svg();
    assert!(nothing.contains("0 knees") && !nothing.contains("NaN"));
}

#[test]
fn opensim_files_have_times_and_refuse_without() {
    let mut film = film(12.0);
    let text = write::mot(&film).unwrap();
    let table = read::mot(&text).unwrap();
    assert_eq!(table.names[0], "time");
    assert_eq!(table.column("time").unwrap()[3], (14.0 - 1.0) / 15.0);
    assert_eq!(table.column("flexion_deg").unwrap()[20], 40.0);
    assert!(text.contains(&format!(
        "nRows=30\nnColumns={}\ninDegrees=yes",
        NUMBERS + 1
    )));
    film.frames_per_s = None;
    assert!(write::mot(&film).is_err());
    assert!(read::mot("time\t1").is_err());
}

#[test]
fn a_matrix_has_101_points_a_film() {
    let film = film(12.0);
    let text = write::matrix(&[&film, &film], place::FLEXION);
    let rows: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(rows.len(), 2);
    let points: Vec<f64> = rows[0].split(',').map(|x| x.parse().unwrap()).collect();
    assert_eq!(points.len(), 101);
    assert!((points[100] - 58.0).abs() < 1e-9 && (points[50] - 29.0).abs() < 1e-9);
    // Frame 8 of 29 steps is missing: what lies within one step of it.
    let missing = points.iter().filter(|point| point.is_nan()).count();
    assert_eq!(missing, (25..=31).count());
}

fn poses() -> Vec<Option<Pose>> {
    (0..6)
        .map(|k| {
            let t = f64::from(k);
            let pose = EulerPose {
                x_mm: t,
                y_mm: -3.5,
                z_mm: -900.0 - t,
                z_rot_deg: 20.0 * t,
                x_rot_deg: -4.0,
                y_rot_deg: 7.0,
            };
            (k != 2).then(|| Pose::from(pose))
        })
        .collect()
}

fn alike(a: &[Option<Pose>], b: &[Option<Pose>]) {
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        match (a, b) {
            (Some(a), Some(b)) => {
                assert!(geodesic_deg(&a.rotation, &b.rotation) < 1e-6);
                assert!((a.translation[2] - b.translation[2]).abs() < 1e-9);
            }
            (a, b) => assert!(a.is_none() && b.is_none()),
        }
    }
}

#[test]
fn poses_read_back_with_their_gaps() {
    let poses = poses();
    let read_jts = |text: &str| -> Vec<Option<Pose>> {
        let rows = jts::read(text).unwrap();
        rows.map(|row| row.unwrap().map(Pose::from)).collect()
    };
    alike(&read_jts(&write::jtak(&poses)), &poses);
    alike(&read_jts(&write::jtap(&poses[0].unwrap())), &poses[..1]);
    let text = write::tra(&[&poses, &poses[..5]]);
    let bodies = read::tra(&text).unwrap();
    alike(&bodies[0], &poses);
    alike(&bodies[1][..5], &poses[..5]);
    assert!(bodies[1][5].is_none());
    // By columns, with tabs.
    let pose = poses[1].unwrap();
    let by_columns: Vec<String> = (0..16)
        .map(|k| match (k / 4, k % 4) {
            (3, 3) => 1.0,
            (_, 3) => 0.0,
            (3, row) => pose.translation[row],
            (column, row) => pose.rotation[row][column],
        })
        .map(|number: f64| number.to_string())
        .collect();
    alike(&read::tra(&by_columns.join("\t")).unwrap()[0], &poses[1..2]);
}

#[test]
fn faulty_files_are_refused_by_line() {
    let text = write::tra(&[&poses()]);
    assert_eq!(read::tra("1,2,3,4,5,6"), Err(read::ReadError::Bodies(6)));
    let torn = text.replacen(",0,0,0,1\n", ",0,0,1,1\n", 1);
    assert_eq!(read::tra(&torn), Err(read::ReadError::Matrix(1)));
    let short = format!("{text}1,2\n");
    assert!(read::tra(&short).is_err());
    let words = read::table("# x\nframe,a,doubt\n1,2,\"\"\n2,x,\"\"\n");
    assert_eq!(
        words,
        Err(read::ReadError::Row {
            line: 4,
            expected: 2
        })
    );
}

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

/// What a spreadsheet that takes commas, semicolons or tabs for separators would calculate: cells that begin with a sign and are no number.
fn formulas(table: &str) -> Vec<&str> {
    let cells = table.lines().flat_map(|line| line.split([',', ';', '\t']));
    // One quote is the cell's; a second would be its text's.
    let texts = cells.map(|cell| {
        let cell = cell.trim();
        cell.strip_prefix('"').unwrap_or(cell).trim_start()
    });
    texts
        .filter(|text| text.starts_with(['=', '+', '-', '@']) && text.parse::<f64>().is_err())
        .collect()
}

#[test]
fn hostile_names_are_no_formulas_and_leave_the_numbers_alone() {
    let names = [
        "=HYPERLINK(\"x\")",
        "a,=1",
        "b;@2",
        "c\t+3",
        "d\n-4,\"=5\"",
        "\"=6\"",
    ];
    for hostile in names {
        let (plain, mut film) = (film(12.0), film(12.0));
        film.name = hostile.to_owned();
        film.rows[5].doubt = Some(hostile.split([',', ';']).collect());
        let group = Group::new(
            hostile.to_owned(),
            vec![Knee {
                name: hostile.to_owned(),
                films: vec![FilmLevels::of(&film), FilmLevels::of(&film)],
            }],
        );
        for table in [
            write::table(&film),
            write::matrix(&[&film], 0),
            write::group_table(&group),
        ] {
            assert_eq!(formulas(&table), Vec::<&str>::new(), "{hostile:?}");
        }
        let cohorts = cohorts::table(std::slice::from_ref(&group));
        let first = cohorts.lines().nth(1).unwrap();
        assert!(
            !first.starts_with("\"=") && !first.starts_with("\"@"),
            "{first}"
        );
        let numbers = |film| read::table(&write::table(film)).unwrap().rows;
        assert_eq!(
            format!("{:?}", numbers(&film)),
            format!("{:?}", numbers(&plain))
        );
    }
}

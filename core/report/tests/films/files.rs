//! What is written reads back, and names of others calculate nothing.

use fluoropose::Side;
use fluoropose::joint::COLUMNS;
use fluoropose::joint::numbers::{NUMBERS, place};
use fluoropose::pose::{EulerPose, Pose, geodesic_deg, jts};
use fluoropose_report::levels::FilmLevels;
use fluoropose_report::{Group, Knee, cohorts, group_figure, read, write};

use crate::film;

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
fn what_a_reader_has_to_know_of_the_knee_stands_above_its_table() {
    let mut film = film(0.0);
    film.remarks = vec!["Side: it is made for a left knee.".to_owned()];
    let text = write::table(&film);
    assert!(
        text.contains("\n# Side: it is made for a left knee.\n"),
        "{text}"
    );
    let back = read::film(&text).unwrap();
    assert_eq!(
        back.rows.len(),
        film.rows.len(),
        "the heading is none of its rows"
    );
    assert_eq!(back.remarks, film.remarks);
    // Once, however often it is read and written.
    let again = write::table(&back);
    assert_eq!(again.matches("\n# Side: it is made").count(), 1, "{again}");
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

#[test]
fn a_study_may_have_any_name() {
    let mut named = film(12.0);
    named.side = Side::Right;
    named.name = "P07; knee: left; lunge".to_owned();
    let again = read::film(&write::table(&named)).unwrap();
    assert_eq!((again.name, again.side), (named.name, Side::Right));
}

#[test]
fn motion_files_say_which_rows_are_doubtful_and_nothing_of_columns_that_they_do_not_have() {
    let mut doubted = film(12.0);
    doubted.frames_per_s = Some(15.0);
    doubted.rows[2].doubt = Some("a rim".to_owned());
    let file = write::mot(&doubted).unwrap();
    assert!(
        file.contains("# doubtful: time 0.8, frame 13: a rim"),
        "{file}"
    );
    assert!(!file.contains("checked") && !file.contains("filter"));
}

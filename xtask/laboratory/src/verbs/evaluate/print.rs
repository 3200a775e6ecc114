//! The table for a person.

use super::inside::Inside;
use super::table::{Row, Table, Verdicts};
use crate::choice::report::Numbers;
use crate::measure::accuracy::Errors;
use crate::measure::bound::{Comparison, Limit};

/// Width of the columns before the numbers.
const LEFT: usize = 39;

pub(super) fn print(table: &Table) {
    println!(
        "{}: error against the reference, RMS over all frames with a pose (median absolute below)",
        table.study
    );
    println!(
        "{:<10} {:<12} {:<8} {:>6} {:>7} {:>7} {:>7} {:>8} {:>8} {:>8} {:>9} {:>6}",
        "component",
        "source",
        "method",
        "frames",
        "x mm",
        "y mm",
        "z mm",
        "z_rot",
        "x_rot",
        "y_rot",
        "geodesic",
        "wrong"
    );
    for row in &table.rows {
        print_row(row);
    }
}

fn print_row(row: &Row) {
    println!(
        "{:<10} {:<12} {:<8} {:>6} {} {:>6}",
        row.component,
        row.source,
        row.method,
        row.frames,
        numbers(&row.rms),
        row.wrong_side
    );
    println!("{:LEFT$} {}", "", numbers(&row.median));
    println!("{:>LEFT$} {}", "bias", numbers(&row.bias));
    if let Some(Inside { whole, scatter }) = &row.inside {
        let lines = [("", whole), (" about the bias", scatter)];
        for (of, [one, two]) in lines {
            println!("{:>LEFT$} {}", format!("within 1 SD{of}, %"), percents(one));
            println!("{:>LEFT$} {}", format!("within 2 SD{of}, %"), percents(two));
        }
    }
    if row.not_found > 0 {
        let (missing, frames) = (row.not_found, row.frames);
        println!(
            "{:LEFT$} {missing} of {frames} frames have no pose: the errors are those of the others",
            ""
        );
    }
    if row.no_reference > 0 {
        let (missing, frames) = (row.no_reference, row.frames);
        println!(
            "{:LEFT$} {missing} of {frames} frames have no reference pose",
            ""
        );
    }
    if let Some(limits) = &row.limits {
        print_limits(limits);
    }
    print_decisions(row);
    if let Some(film) = &row.film {
        println!("{:>LEFT$} {film}", "film");
    }
    if let Some(start) = &row.from_reference {
        let frames = format!("from the reference's start, {} frames", start.frames);
        println!("{frames:>LEFT$} {}", numbers(&start.rms));
        println!("{:>LEFT$} {}", "largest", numbers(&start.largest));
    }
}

fn print_decisions(row: &Row) {
    if let Some(verdicts) = &row.verdicts {
        let Verdicts {
            good,
            doubtful,
            none,
        } = verdicts;
        println!(
            "{:>LEFT$} good {good}, doubtful {doubtful}, none {none}",
            "verdict"
        );
    }
    if let Some(reasons) = &row.reasons {
        let known = row.femur.as_ref().map_or(String::new(), |source| {
            format!(" (with the femoral poses of {source} known)")
        });
        println!("{:>LEFT$} {reasons}{known}", "chosen by");
    }
}

fn numbers(e: &Errors) -> String {
    format!(
        "{:7.3} {:7.3} {:7.2} {:8.3} {:8.3} {:8.3} {:9.3}",
        e.x_mm, e.y_mm, e.z_mm, e.z_rot_deg, e.x_rot_deg, e.y_rot_deg, e.geodesic_deg
    )
}

fn percents(inside: &Numbers) -> String {
    let [x, y, z, z_rot, x_rot, y_rot] = inside.all().map(|part| 100.0 * part);
    format!("{x:7.0} {y:7.0} {z:7.0} {z_rot:8.0} {x_rot:8.0} {y_rot:8.0}")
}

/// Limits and ratios in the columns of the table.
fn print_limits(limits: &Comparison) {
    let line = |name: &str, l: &Limit| {
        println!(
            "{name:>LEFT$} {:7.3} {:7.3} {:7.2} {:26} {:9.3}",
            l.x_mm, l.y_mm, l.z_mm, "", l.geodesic_deg
        );
    };
    line("bound", &limits.bound);
    line("RMS / bound", &limits.ratio_to_bound);
    if limits.noise.jitter_px > 0.0 {
        line("plain least squares", &limits.least_squares);
        line("RMS / that", &limits.ratio_to_least_squares);
    }
}

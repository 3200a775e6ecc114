use super::*;
use std::vec;
use std::vec::Vec;

/// Pin-cushion and a twist, as an image intensifier has them: the place in the frame of an ideal place, px.
pub(crate) fn distorted([column, row]: [f64; 2], strength: f64) -> [f64; 2] {
    let [x, y] = [(column - 505.0) / 512.0, (row - 520.0) / 512.0];
    let square = x * x + y * y;
    let grow = 1.0 + strength * square;
    let twist = 0.4 * strength * square;
    [
        505.0 + 512.0 * (grow * x - twist * y),
        520.0 + 512.0 * (grow * y + twist * x),
    ]
}

/// An ideal lattice of 40 px rotated by 0.1 radians, distorted, with the numbers of its beads.
pub(crate) fn plate(strength: f64) -> Vec<([i32; 2], [f64; 2])> {
    let (sine, cosine) = f64::sin_cos(0.1);
    let mut out = Vec::new();
    for j in -11..=11 {
        for i in -11..=11 {
            let (x, y) = (40.0 * f64::from(i), 40.0 * f64::from(j));
            let ideal = [512.0 + cosine * x - sine * y, 512.0 + sine * x + cosine * y];
            let at = distorted(ideal, strength);
            if at.iter().all(|v| (20.0..1004.0).contains(v)) {
                out.push(([i, j], at));
            }
        }
    }
    out
}

fn beads(all: &[([i32; 2], [f64; 2])]) -> Vec<Bead> {
    all.iter()
        .map(|&(_, at)| Bead {
            at,
            ..Bead::default()
        })
        .collect()
}

/// All numbered beads have the right number, up to one shift; returns how many they are.
fn right_numbers(found: &[Bead], truth: &[([i32; 2], [f64; 2])]) -> usize {
    let pairs: Vec<_> = found
        .iter()
        .zip(truth)
        .filter_map(|(bead, (number, _))| Some((bead.index?, *number)))
        .collect();
    let (a, b) = pairs[0];
    for (got, number) in &pairs {
        assert_eq!(
            [got[0] - a[0], got[1] - a[1]],
            [number[0] - b[0], number[1] - b[1]]
        );
    }
    pairs.len()
}

#[test]
fn a_distorted_lattice_is_numbered_completely() {
    for strength in [0.0, 0.06, 0.12] {
        let truth = plate(strength);
        let mut found = beads(&truth);
        let mut queue = vec![0; found.len()];
        let step = number(&mut found, &mut queue).expect("a lattice");
        assert!((38.0..50.0).contains(&step), "{step}");
        assert_eq!(
            right_numbers(&found, &truth),
            truth.len(),
            "strength {strength}"
        );
    }
}

#[test]
fn missing_beads_and_false_marks_do_no_harm() {
    let all = plate(0.08);
    // A fifth is missing, and two whole columns: an island is left behind them.
    let truth: Vec<_> = all
        .iter()
        .copied()
        .enumerate()
        .filter(|(k, ([i, _], _))| (k * 7919) % 5 != 0 && ![5, 6].contains(i))
        .map(|(_, bead)| bead)
        .collect();
    let mut found = beads(&truth);
    // Marks half way between beads, and on top of each other.
    for k in 0..40 {
        let at = all[(k * 37) % all.len()].1;
        found.push(Bead {
            at: [at[0] + 19.0, at[1] + 17.0],
            ..Bead::default()
        });
    }
    let mut queue = vec![0; found.len()];
    number(&mut found, &mut queue).expect("a lattice");
    assert_eq!(right_numbers(&found, &truth), truth.len());
    assert!(found[truth.len()..].iter().all(|mark| mark.index.is_none()));
}

#[test]
fn no_lattice_is_said() {
    let mut queue = vec![0; 400];
    assert!(matches!(
        number(&mut [], &mut queue),
        Err(DistortionError::FewBeads { .. })
    ));
    let mut seed = 3u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(seed >> 8) / f64::from(1 << 24) * 1000.0
    };
    let mut scattered: Vec<Bead> = (0..150)
        .map(|_| Bead {
            at: [random(), random()],
            ..Bead::default()
        })
        .collect();
    assert!(matches!(
        number(&mut scattered, &mut queue),
        Err(DistortionError::FewBeads { .. })
    ));
    let mut one_spot = vec![Bead::default(); 50];
    assert!(number(&mut one_spot, &mut queue).is_err());
    let mut short = beads(&plate(0.0));
    assert!(matches!(
        number(&mut short, &mut queue[..3]),
        Err(DistortionError::Memory(_))
    ));
}

use super::*;
use crate::synthetic::SyntheticFrame;
use std::vec::Vec;

/// The edges of a drawn frame, computed in slices of `rows` rows.
pub(crate) fn edges_of(drawn: &SyntheticFrame, inside: Inside, rows: usize) -> Vec<Edge> {
    let pixels = drawn.eight_bit();
    let frame = Frame::new(&pixels, drawn.width, drawn.height, drawn.width).expect("fits");
    let (mut fine, mut edges) = (
        std::vec![0; pixels.len()],
        std::vec![Edge::default(); pixels.len()],
    );
    let (mut coarse, mut magnitude) = (fine.clone(), fine.clone());
    let mut memory = CostMemory {
        fine: &mut fine,
        coarse: &mut coarse,
        magnitude: &mut magnitude,
        edges: &mut edges,
    };
    let mut builder = CostBuilder::new(drawn.width, drawn.height, inside);
    while !builder.step(&frame, &mut memory, rows).expect("fits") {}
    edges
}

#[test]
fn slices_change_nothing() {
    let mut drawn = SyntheticFrame::new(50, 40, 180.0);
    drawn.disc([24.0, 20.0], 11.0, 60.0);
    drawn.add_noise(5.0, 4);
    let at_once = edges_of(&drawn, Inside::Dark, 1000);
    assert_eq!(edges_of(&drawn, Inside::Dark, 7), at_once);
}

#[test]
fn an_edge_is_strongest_in_its_middle_and_points_outwards() {
    let mut drawn = SyntheticFrame::new(100, 100, 200.0);
    drawn.disc([50.0, 50.0], 25.0, 60.0);
    drawn.add_noise(5.0, 1);
    let edges = edges_of(&drawn, Inside::Dark, 64);
    let costs = Costs::new(&edges, 100, 100).expect("fits");
    let mut off = 0.0f64;
    for k in 0..64 {
        let turn = core::f64::consts::TAU * f64::from(k) / 64.0;
        let (sin, cos) = turn.sin_cos();
        // Across the edge the strongest pixel is the one that it passes through, or the next.
        let at = |r: f64| costs.at((50.0 + r * cos) as usize, (50.0 + r * sin) as usize);
        let radii = (0..=80).map(|step| 15.0 + 0.25 * f64::from(step));
        let strongest = radii.max_by_key(|&r| at(r).strength).expect("some");
        assert!((strongest - 25.0).abs() < 1.6, "{strongest}");
        let (edge, ground) = (at(strongest).strength, at(12.0).strength);
        assert!(
            edge > 110 && 3 * u16::from(ground) < u16::from(edge),
            "{edge} {ground}"
        );
        let rotated = f64::from(at(strongest).outwards) / 256.0 - turn / core::f64::consts::TAU;
        off = off.max((rotated + 0.5).rem_euclid(1.0) - 0.5);
    }
    assert!(off < 0.04, "{off}");
    // A bright implant has its outside where it gets darker.
    let bright = edges_of(&drawn, Inside::Bright, 64);
    for (a, b) in edges.iter().zip(&bright) {
        assert_eq!(
            (a.strength, a.outwards.wrapping_add(128)),
            (b.strength, b.outwards)
        );
    }
}

#[test]
fn noise_alone_makes_no_strong_edges() {
    let mut drawn = SyntheticFrame::new(120, 90, 150.0);
    drawn.add_noise(12.0, 3);
    let edges = edges_of(&drawn, Inside::Dark, 64);
    let strong = edges.iter().filter(|edge| edge.strength > 128).count();
    assert!(strong * 50 < edges.len(), "{strong}");
}

#[test]
fn another_frame_and_short_memory_are_refused() {
    let frame = Frame::new(&[0u8; 30], 6, 5, 6).expect("fits");
    let (mut a, mut b, mut c) = ([0; 30], [0; 30], [0; 30]);
    let mut edges = [Edge::default(); 29];
    let mut memory = CostMemory {
        fine: &mut a,
        coarse: &mut b,
        magnitude: &mut c,
        edges: &mut edges,
    };
    let other = CostBuilder::new(5, 6, Inside::Dark).step(&frame, &mut memory, 1);
    assert_eq!(other, Err(TracingError::OtherFrame));
    let short = CostBuilder::new(6, 5, Inside::Dark).step(&frame, &mut memory, 1);
    assert!(matches!(
        short,
        Err(TracingError::Memory(TooLittleMemory { what: "edges", .. }))
    ));
    assert_eq!(
        Costs::new(&edges, 5, 5).expect("fits").at(5, 0),
        Edge::default()
    );
}

//! Outlines as a person makes them with the tracing tools: the region around a click, and a live-wire between points.

use anyhow::{Context, Result};
use fluoropose::image::border::follow_border;
use fluoropose::image::contour::{Contour, Outline, Point};
use fluoropose::image::frame::Frame;
use fluoropose::image::mask::Mask;
use fluoropose_tracing::costs::{CostBuilder, CostMemory, Costs, Edge};
use fluoropose_tracing::follow::{Cursor, Follower};
use fluoropose_tracing::smoothed::Smoothed;
use fluoropose_tracing::snap::{Snap, snapped};
use fluoropose_tracing::threshold::{
    Threshold, ThresholdMemory, region_at, suggested_level, threshold_needed,
};
use fluoropose_tracing::wire::{Node, Waiting, Wire, WireMemory};
use fluoropose_tracing::{Hand, Inside, List, Vertex};

use crate::files::MaskBuffer;

/// Bridges as the page cuts them, and how far its outlines are simplified, pixels.
const BRIDGE: usize = 2;
const TOLERANCE: f64 = 0.25;
/// Length of outline between two points of a live-wire, pixels; edges attract the cursor within this radius, and a path is brought
/// onto edges so near, as the page does.
const APART: usize = 90;
const RADIUS: f64 = 8.0;
const REACH: f64 = 2.0;
const PATH_TOLERANCE: f64 = 0.5;
/// Corners that a silhouette's border may have.
const CORNERS: usize = 16_384;

/// The region around a click, at the level that the tool suggests; `None` where there is none.
///
/// # Errors
/// Those of [`region_at`].
pub fn threshold_outline(frame: &Frame<'_, u8>, click: Point) -> Result<Option<MaskBuffer>> {
    let (width, height) = (frame.width(), frame.height());
    let mut cells = vec![0; width * height];
    let smoothed = Smoothed::new(frame, &mut cells)?;
    let Some(level) = suggested_level(&smoothed, click, Inside::Dark) else {
        return Ok(None);
    };
    let threshold = Threshold {
        inside: Inside::Dark,
        level,
        bridge: BRIDGE,
        tolerance: TOLERANCE,
    };
    let (words, points) = threshold_needed(width, height);
    let memory = ThresholdMemory {
        words: &mut vec![0; words],
        line: &mut vec![Vertex::default(); points],
        marks: &mut vec![false; points],
    };
    let mut places = vec![Vertex::default(); points];
    let mut out = List::new(&mut places);
    let region = region_at(&smoothed, click, &threshold, memory, &mut out)?;
    region
        .map(|_| filled(out.as_slice(), width, height))
        .transpose()
}

/// A live-wire around a component whose true silhouette this is, between points that a person would set.
///
/// # Errors
/// Those of the tools.
pub fn wire_outline(frame: &Frame<'_, u8>, silhouette: &Mask<'_>) -> Result<MaskBuffer> {
    let (width, height) = (frame.width(), frame.height());
    let edges = edges_of(frame)?;
    let costs = Costs::new(&edges, width, height)?;
    let mut border = Box::<Contour<CORNERS>>::default();
    follow_border(silhouette, border.as_mut())?;
    let near = |at: Point| {
        let cursor = Cursor { at, radius: RADIUS };
        Follower::default().attracted(&costs, &cursor)
    };
    let seeds: Vec<Point> = border.iter().step_by(APART).map(|p| near(*p)).collect();
    let mut nodes = vec![Node::default(); width * height];
    let mut waiting = vec![Waiting::default(); width * height];
    let mut outline = Vec::new();
    for (number, &from) in seeds.iter().enumerate() {
        let to = seeds[(number + 1) % seeds.len()];
        let mut memory = WireMemory {
            nodes: &mut nodes,
            waiting: &mut waiting,
        };
        let mut wire = Wire::start(&costs, from, Hand::Either, &mut memory)?;
        let mut places = vec![0; 16 * (width + height)];
        let mut path = List::new(&mut places);
        let cursor = Cursor {
            at: to,
            radius: 0.0,
        };
        let work = (cursor, usize::MAX);
        Follower::default().follow(&mut wire, &costs, &mut memory, work, &mut path)?;
        let middles: Vec<Point> = path.as_slice().iter().map(|&p| wire.centre(p)).collect();
        if middles.len() >= 2 {
            outline.extend(onto_edges(frame, &middles)?);
        }
    }
    filled(&outline, width, height)
}

fn edges_of(frame: &Frame<'_, u8>) -> Result<Vec<Edge>> {
    let (width, height) = (frame.width(), frame.height());
    let count = width * height;
    let mut edges = vec![Edge::default(); count];
    let mut memory = CostMemory {
        fine: &mut vec![0; count],
        coarse: &mut vec![0; count],
        magnitude: &mut vec![0; count],
        edges: &mut edges,
    };
    let mut builder = CostBuilder::new(width, height, Inside::Dark);
    while !builder.step(frame, &mut memory, height)? {}
    Ok(edges)
}

/// A path brought onto the edges that it follows, without its last point: the next path begins there.
fn onto_edges(frame: &Frame<'_, u8>, path: &[Point]) -> Result<Vec<Vertex>> {
    let settings = Snap {
        closed: false,
        hand: Hand::Either,
        inside: Inside::Dark,
        reach: REACH,
        tolerance: PATH_TOLERANCE,
    };
    let (mut points, _) = snapped(frame, path, &settings)?;
    points.pop();
    Ok(points)
}

fn filled(outline: &[Vertex], width: usize, height: usize) -> Result<MaskBuffer> {
    let points: Vec<Point> = outline.iter().map(|vertex| vertex.at).collect();
    let outline = Outline::new(&points, width, height).context("an outline encloses something")?;
    let mut buffer = MaskBuffer::new(width, height)?;
    buffer.draw(|mask| mask.fill_outline(&outline));
    Ok(buffer)
}

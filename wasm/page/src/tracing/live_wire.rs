//! The live-wire on a film.

use fluoropose::image::contour::Point;
use fluoropose::image::frame::Frame;
use fluoropose_tracing::cooling::Cooling as CoreCooling;
use fluoropose_tracing::costs::{CostBuilder, CostMemory, Costs, Edge};
use fluoropose_tracing::follow::{Cursor, Follower, common_length};
use fluoropose_tracing::wire::{Node, Waiting, Wire, WireMemory, hand_of};
use fluoropose_tracing::{List, TracingError};
use wasm_bindgen::prelude::*;

use super::{hand_of_side, inside_of, points_of};
use crate::error::sentence;
use crate::frame_image::{FrameImage, Pixels};

/// Paths along the edges of one film.
#[wasm_bindgen]
pub struct LiveWire {
    width: usize,
    height: usize,
    builder: CostBuilder,
    /// Nothing once the edges are worked out.
    preparing: Option<Preparing>,
    edges: Vec<Edge>,
    nodes: Vec<Node>,
    waiting: Vec<Waiting>,
    wire: Option<Wire>,
    follower: Follower,
    /// The cursor's radius when it was followed last.
    radius: f64,
    path: Vec<u32>,
    common: usize,
}

/// What is needed until the edges are worked out.
struct Preparing {
    film: FrameImage,
    fine: Vec<u16>,
    coarse: Vec<u16>,
    magnitude: Vec<u16>,
}

#[wasm_bindgen]
impl LiveWire {
    /// Takes a film on which the implant is dark or else bright, and memory: some 22 bytes a pixel, of which the page uses
    /// a part, and 6 more until all is prepared.
    #[wasm_bindgen(constructor)]
    #[must_use]
    pub fn new(film: &FrameImage, dark_inside: bool) -> Self {
        let (width, height) = film.size();
        let count = width * height;
        Self {
            width,
            height,
            builder: CostBuilder::new(width, height, inside_of(dark_inside)),
            preparing: Some(Preparing {
                film: film.shared(),
                fine: vec![0; count],
                coarse: vec![0; count],
                magnitude: vec![0; count],
            }),
            edges: vec![Edge::default(); count],
            nodes: vec![Node::default(); count],
            waiting: vec![Waiting::default(); count],
            wire: None,
            follower: Follower::default(),
            radius: 0.0,
            path: Vec::new(),
            common: 0,
        }
    }

    /// Works out the film's edges for `rows` more rows, of four times as many as it has, and tells whether all is done.
    ///
    /// # Errors
    /// The core's sentence about the film.
    pub fn prepare(&mut self, rows: u32) -> Result<bool, JsError> {
        let Some(preparing) = &mut self.preparing else {
            return Ok(true);
        };
        let mut memory = CostMemory {
            fine: &mut preparing.fine,
            coarse: &mut preparing.coarse,
            magnitude: &mut preparing.magnitude,
            edges: &mut self.edges,
        };
        let (width, height, rows) = (self.width, self.height, rows as usize);
        let done = match preparing.film.pixels() {
            Pixels::Eight(pixels) => {
                let frame = Frame::new(pixels, width, height, width).map_err(sentence)?;
                self.builder.step(&frame, &mut memory, rows)
            }
            Pixels::Sixteen(pixels) => {
                let frame = Frame::new(pixels, width, height, width).map_err(sentence)?;
                self.builder.step(&frame, &mut memory, rows)
            }
        };
        if done.map_err(sentence)? {
            self.preparing = None;
        }
        Ok(self.preparing.is_none())
    }

    /// Column and row of the middle of the strongest pixel of an edge within a radius, or the point itself where there is
    /// none.
    ///
    /// # Errors
    /// The core's sentence.
    #[wasm_bindgen(js_name = snapPoint)]
    pub fn snap_point(&self, column: f64, row: f64, radius: f64) -> Result<Vec<f64>, JsError> {
        let at = Point::new(column, row);
        let costs = Costs::new(&self.edges, self.width, self.height).map_err(sentence)?;
        let found = Follower::default().attracted(&costs, &Cursor { at, radius });
        Ok(vec![found.column, found.row])
    }

    /// Begins paths at a point, with the implant on their right hand (`side` 1), their left (-1) or either (0).
    ///
    /// # Errors
    /// A sentence where the film's edges are not worked out yet.
    pub fn seed(&mut self, column: f64, row: f64, side: i32) -> Result<(), JsError> {
        if self.preparing.is_some() {
            return Err(sentence(TracingError::NotPrepared));
        }
        let costs = Costs::new(&self.edges, self.width, self.height).map_err(sentence)?;
        let mut memory = WireMemory {
            nodes: &mut self.nodes,
            waiting: &mut self.waiting,
        };
        let seed = Point::new(column, row);
        let wire = Wire::start(&costs, seed, hand_of_side(side), &mut memory);
        self.wire = Some(wire.map_err(sentence)?);
        self.follower.release();
        self.path.clear();
        self.common = 0;
        Ok(())
    }

    /// Reaches up to so many more pixels, the cheapest first, and tells whether the whole frame is reached.
    ///
    /// # Errors
    /// The core's sentence.
    pub fn expand(&mut self, pixels: u32) -> Result<bool, JsError> {
        self.expand_to(None, pixels)
    }

    /// Reaches up to so many more pixels, but stops once the edge near a point is reached, and tells whether it is.
    ///
    /// # Errors
    /// The core's sentence.
    pub fn reach(&mut self, column: f64, row: f64, pixels: u32) -> Result<bool, JsError> {
        let at = Point::new(column, row);
        let radius = self.radius;
        let costs = Costs::new(&self.edges, self.width, self.height).map_err(sentence)?;
        let target = self.follower.attracted(&costs, &Cursor { at, radius });
        self.expand_to(Some(target), pixels)
    }

    /// Whether the cheapest path to a point is known.
    #[wasm_bindgen(js_name = isReached)]
    #[must_use]
    pub fn is_reached(&self, column: f64, row: f64) -> bool {
        let at = Point::new(column, row);
        let wire = self.wire.as_ref();
        wire.is_some_and(|wire| wire.is_reached(&self.nodes, at))
    }

    /// The path from the seed to the edge within a radius of a point, as columns and rows by turns: middles of pixels. It
    /// holds to what it followed before; at radius 0 it ends under the point and holds to nothing. Where the edge is not
    /// reached yet up to `pixels` more are (all by default); no points where that is not enough.
    ///
    /// # Errors
    /// The core's sentence.
    pub fn follow(
        &mut self,
        column: f64,
        row: f64,
        radius: f64,
        pixels: Option<u32>,
    ) -> Result<Vec<f64>, JsError> {
        let Some(wire) = &mut self.wire else {
            return Ok(Vec::new());
        };
        self.radius = radius;
        let costs = Costs::new(&self.edges, self.width, self.height).map_err(sentence)?;
        let mut memory = WireMemory {
            nodes: &mut self.nodes,
            waiting: &mut self.waiting,
        };
        let at = Point::new(column, row);
        let budget = pixels.map_or(usize::MAX, |pixels| pixels as usize);
        // A path passes no pixel twice, and few of them.
        let mut places = vec![0; (16 * (self.width + self.height)).min(2 * self.edges.len())];
        let mut path = List::new(&mut places);
        let work = (Cursor { at, radius }, budget);
        let followed = self
            .follower
            .follow(wire, &costs, &mut memory, work, &mut path);
        followed.map_err(sentence)?;
        if path.is_empty() {
            return Ok(Vec::new());
        }
        self.common = common_length(&self.path, path.as_slice());
        self.path = path.as_slice().to_vec();
        let middles = self.path.iter().map(|&pixel| wire.centre(pixel));
        Ok(middles.flat_map(|p| [p.column, p.row]).collect())
    }

    /// How many points of the last path are those of the one before it, from the seed on.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn common(&self) -> u32 {
        self.common as u32
    }

    /// On which hand of a line the implant is: from -1, left, to 1, right; 0 where there is no edge.
    ///
    /// # Errors
    /// The core's sentence.
    #[wasm_bindgen(js_name = darkSide)]
    pub fn dark_side(&self, path: &[f64]) -> Result<f64, JsError> {
        let costs = Costs::new(&self.edges, self.width, self.height).map_err(sentence)?;
        Ok(hand_of(&costs, &points_of(path)))
    }
}

impl LiveWire {
    fn expand_to(&mut self, target: Option<Point>, pixels: u32) -> Result<bool, JsError> {
        let Some(wire) = &mut self.wire else {
            return Ok(target.is_none());
        };
        let costs = Costs::new(&self.edges, self.width, self.height).map_err(sentence)?;
        let mut memory = WireMemory {
            nodes: &mut self.nodes,
            waiting: &mut self.waiting,
        };
        let done = wire.expand(&costs, &mut memory, pixels as usize, target);
        done.map_err(sentence)
    }
}

/// Watches which part of the paths from one seed has stayed the same for long.
#[wasm_bindgen]
pub struct Cooling(CoreCooling);

#[wasm_bindgen]
impl Cooling {
    /// Points may be fixed once they have been the same for about so many milliseconds.
    #[wasm_bindgen(constructor)]
    #[must_use]
    pub fn new(milliseconds: f64) -> Self {
        Self(CoreCooling::new(milliseconds))
    }

    /// Forgets everything: for a new seed.
    pub fn restart(&mut self) {
        self.0.restart();
    }

    /// Takes notice of a path of `length` points of which `common` are those of the one before it, at a time in
    /// milliseconds. Gives how many points, from the seed on, may be fixed.
    pub fn observe(&mut self, now: f64, common: u32, length: u32) -> u32 {
        self.0.observe(now, common as usize, length as usize) as u32
    }
}

//! The way from one mesh of a shape to another mesh of it, in small parts: nothing on the page ever jumps.

use crate::model::Model;
use crate::shape::{CurveShape, SurfaceShape};
use ductile_mesh::SurfaceTree;
use ductile_spec::{CurveId, SurfaceId};
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Steps of a slide: an eighth of a second at sixty frames a second.
const PARTS: u32 = 8;

/// Shapes on the way to others of the same document.
#[derive(Clone, Debug)]
pub(crate) struct Slide {
    pub(super) curves: BTreeMap<CurveId, Way<CurveShape>>,
    pub(super) surfaces: BTreeMap<SurfaceId, Way<SurfaceShape>>,
    part: u32,
}

/// A shape to arrive at, and where its vertices or samples begin.
#[derive(Clone, Debug)]
pub(super) struct Way<T> {
    pub(super) from: Vec<DVec3>,
    pub(super) to: Arc<T>,
}

impl Slide {
    /// From the shapes of one model to those of another of the same document. The new vertices begin at the nearest places
    /// of the shapes shown; those of controls are there already.
    pub(crate) fn new(shown: &Model, hidden: &Model) -> Self {
        let mut curves = BTreeMap::new();
        for (id, to) in &hidden.curves {
            let from = shown.curves.get(id).map_or_else(|| to.nodes.clone(), |shown| curve_starts(shown, to));
            curves.insert(*id, Way { from, to: Arc::clone(to) });
        }
        let mut surfaces = BTreeMap::new();
        for (id, to) in &hidden.surfaces {
            let mut from = to.positions.clone();
            if let Some(shown) = shown.surfaces.get(id) {
                surface_starts(shown, to, &mut from);
            }
            for embedded in &to.embeddings {
                let starts = curves.get(&embedded.curve).map_or(&[][..], |way| &way.from);
                embedded.vertices.iter().zip(starts).for_each(|(v, at)| from[v.index()] = *at);
            }
            to.pins.iter().for_each(|pin| from[pin.vertex.index()] = to.positions[pin.vertex.index()]);
            surfaces.insert(*id, Way { from, to: Arc::clone(to) });
        }
        Self { curves, surfaces, part: 0 }
    }

    /// Goes on by a part; returns whether that was the last.
    pub(crate) fn advance(&mut self) -> bool {
        self.part += 1;
        self.part >= PARTS
    }

    /// Puts the shapes where they are now.
    pub(crate) fn show(&self, model: &mut Model) {
        let t = f64::from(self.part) / f64::from(PARTS);
        // Begins and ends gently.
        let t = t * t * (3.0 - 2.0 * t);
        let between =
            |from: &[DVec3], to: &[DVec3]| from.iter().zip(to).map(|(a, b)| a.lerp(*b, t)).collect();
        for (id, way) in &self.curves {
            let nodes = between(&way.from, &way.to.nodes);
            model.curves.insert(*id, Arc::new(CurveShape { nodes, ..(*way.to).clone() }));
        }
        for (id, way) in &self.surfaces {
            let positions = between(&way.from, &way.to.positions);
            model.surfaces.insert(*id, Arc::new(SurfaceShape { positions, ..(*way.to).clone() }));
        }
    }

    /// Puts them where they were to arrive.
    pub(crate) fn end(&self, model: &mut Model) {
        model.curves.extend(self.curves.iter().map(|(id, way)| (*id, Arc::clone(&way.to))));
        model.surfaces.extend(self.surfaces.iter().map(|(id, way)| (*id, Arc::clone(&way.to))));
    }
}

/// The places of the curve shown that are nearest to the new samples.
fn curve_starts(shown: &CurveShape, to: &CurveShape) -> Vec<DVec3> {
    let start = |at: &DVec3| shown.nearest(*at).map_or(*at, |(edge, t)| shown.place(edge, t));
    let mut starts: Vec<DVec3> = to.nodes.iter().map(start).collect();
    to.controls.iter().for_each(|(sample, _)| starts[*sample as usize] = to.nodes[*sample as usize]);
    starts
}

/// The places of the surface shown that are nearest to the new vertices.
fn surface_starts(shown: &SurfaceShape, to: &SurfaceShape, starts: &mut [DVec3]) {
    let tree = SurfaceTree::new(&shown.mesh, &shown.positions);
    for v in to.mesh.vertices() {
        if let Some((_, at)) = tree.nearest(&shown.mesh, to.positions[v.index()]) {
            starts[v.index()] = at;
        }
    }
}

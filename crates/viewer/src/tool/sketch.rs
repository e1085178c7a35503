//! A curve sketched on a surface in one stroke: the path of the pointer becomes corners at equal distances on the picture,
//! few enough that each can be moved by hand afterwards.

use super::{Act, Aim, Surroundings, ToolKind, Toolbox};
use crate::Hit;
use glam::{Vec2, Vec3};

/// A new place of the path is noted after so many CSS pixels.
const STEP: f32 = 5.0;
/// A shorter stroke is a click of an unsteady hand.
const SHORTEST: f32 = 24.0;
/// Pixels between two corners, and most corners of a stroke.
const SPACING: f32 = 70.0;
const MOST: u8 = 24;
/// So near to its beginning a stroke that has gone far away closes.
const CLOSES: f32 = 18.0;

/// The path of the pointer so far: places on the surface, and where they are in the picture.
#[derive(Clone, Debug, Default)]
pub struct Stroke {
    pixels: Vec<Vec2>,
    hits: Vec<Hit>,
}

impl Stroke {
    /// Whether a cursor is far enough from the last place to be a new one.
    #[must_use]
    pub fn wants(&self, pixel: Vec2) -> bool {
        self.pixels.last().is_none_or(|last| last.distance(pixel) >= STEP)
    }

    /// Notes a place. Beside the surface there is none, and the path goes straight on from the last one.
    pub fn add(&mut self, pixel: Vec2, hit: Option<Hit>) {
        if let Some(hit) = hit {
            self.pixels.push(pixel);
            self.hits.push(hit);
        }
    }

    /// The path, to be shown.
    pub fn places(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.hits.iter().map(Hit::at)
    }

    /// How long it is on the picture after each of its places.
    fn lengths(&self) -> Vec<f32> {
        let mut sum = 0.0;
        let steps = self.pixels.iter().zip(self.pixels.iter().skip(1)).map(|(a, b)| a.distance(*b));
        std::iter::once(0.0)
            .chain(steps)
            .map(|step| {
                sum += step;
                sum
            })
            .collect()
    }

    /// Its corners, and whether it closes; a single one if it is no more than a click.
    fn corners(&self) -> (Vec<Hit>, bool) {
        let lengths = self.lengths();
        let (Some(first), Some(last), Some(length)) =
            (self.pixels.first(), self.pixels.last(), lengths.last())
        else {
            return (Vec::new(), false);
        };
        if *length < SHORTEST {
            return (self.hits[..1].to_vec(), false);
        }
        let closes = first.distance(*last) < CLOSES && *length > 6.0 * CLOSES;
        let pieces = (length / SPACING).round().clamp(if closes { 4.0 } else { 1.0 }, f32::from(MOST));
        let count = (1..=MOST).take_while(|n| f32::from(*n) <= pieces).count();
        let corner = |i: usize| {
            let wanted = length * i as f32 / pieces;
            let after = lengths.partition_point(|so_far| *so_far < wanted - 1e-3);
            self.hits[after.min(self.hits.len() - 1)]
        };
        // A closed one does not repeat its first.
        let corners = (0..if closes { count } else { count + 1 }).map(corner);
        (corners.collect(), closes)
    }
}

impl Toolbox {
    /// Whether a drag from here draws.
    #[must_use]
    pub fn sketches(&self) -> bool {
        self.kind == ToolKind::Draw
    }

    /// Takes a stroke: a curve of its own if nothing was begun before, else further corners of what was.
    pub fn sketched(&mut self, stroke: &Stroke, around: Surroundings<'_>) -> Vec<Act> {
        let is_first = self.corners.is_empty();
        let (corners, closes) = stroke.corners();
        let is_click = corners.len() == 1;
        for hit in &corners {
            let surface = match hit {
                Hit::Surface { id, .. } => Some(*id),
                _ => self.canvas(),
            };
            let refused = self.place_corner(Aim { hit: Some(hit), surface, ..Aim::default() }, around);
            if !refused.is_empty() {
                if is_first {
                    self.corners.clear();
                }
                return refused;
            }
        }
        if is_first && !is_click && !corners.is_empty() { self.end_path(closes, around) } else { Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::{Document, Edit, Structure, SurfaceId};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A stroke through pixels, each at its own place of a surface.
    fn stroke(surface: u32, pixels: impl Iterator<Item = Vec2>) -> Stroke {
        let mut stroke = Stroke::default();
        for pixel in pixels {
            if stroke.wants(pixel) {
                let at = pixel.extend(0.0);
                let hit = Hit::Surface { id: SurfaceId(surface), at, normal: Vec3::Z, triangle: 0 };
                stroke.add(pixel, Some(hit));
            }
        }
        stroke
    }

    fn sketch(tools: &mut Toolbox, stroke: &Stroke) -> Vec<Act> {
        let (structure, document) = (Structure::default(), Document::default());
        let around = Surroundings {
            structure: &structure,
            document: &document,
            forward: Vec3::NEG_Z,
            radius: 1.0,
            size: 1.0,
        };
        tools.sketched(stroke, around)
    }

    fn drawing() -> Toolbox {
        let mut tools = Toolbox::default();
        tools.choose(ToolKind::Draw);
        tools
    }

    fn circle(steps: u8) -> impl Iterator<Item = Vec2> {
        (0..steps).map(move |i| {
            let (s, c) = (std::f32::consts::TAU * f32::from(i) / f32::from(steps)).sin_cos();
            Vec2::new(100.0 * c, 100.0 * s)
        })
    }

    #[test]
    fn a_stroke_that_comes_back_is_a_closed_curve() {
        let acts = sketch(&mut drawing(), &stroke(1, circle(100)));
        let [Act::Edit(Edit::SLoop { surface, along, closed: true })] = &acts[..] else { panic!("{acts:?}") };
        // The circle is 628 pixels long.
        assert_eq!((*surface, along.len()), (SurfaceId(1), 9));
        assert!(along.iter().all(|at| (at.length() - 100.0).abs() < 0.1));
        let next = along.iter().cycle().skip(1);
        assert!(along.iter().zip(next).all(|(a, b)| (55.0..80.0).contains(&a.distance(*b))), "{along:?}");
    }

    #[test]
    fn a_stroke_that_does_not_is_an_open_one_from_end_to_end() {
        let line = (0_u8..=100).map(|i| Vec2::X * (2.0 * f32::from(i)));
        let acts = sketch(&mut drawing(), &stroke(1, line));
        let [Act::Edit(Edit::SLoop { along, closed: false, .. })] = &acts[..] else { panic!("{acts:?}") };
        assert_eq!(along.len(), 4);
        assert!(along[0].x == 0.0 && along[3].x > 190.0);
    }

    #[test]
    fn a_tremble_is_a_click_and_another_surface_is_refused() {
        let mut tools = drawing();
        assert!(sketch(&mut tools, &stroke(1, circle(100).take(3))).is_empty());
        assert_eq!(tools.corners().len(), 1);
        let more = stroke(1, (0_u8..60).map(|i| Vec2::new(0.0, 3.0 * f32::from(i))));
        assert!(sketch(&mut tools, &more).is_empty(), "a curve under way goes on");
        assert!(tools.corners().len() > 2);
        assert!(matches!(sketch(&mut tools, &stroke(2, circle(100)))[..], [Act::Say(_)]));
        assert!(sketch(&mut drawing(), &Stroke::default()).is_empty());
    }
}

//! What lies under the pointer, from the viewer's own copy of the frame: no question to the worker.
//!
//! Points come before curves and curves before surfaces, because they are harder to hit; but not through a
//! surface: what is clearly hidden is left to the surface that hides it. Surfaces are met by a flat loop over
//! their triangles (Möller and Trumbore 1997), which at 20,000 triangles costs a few tenths of a millisecond
//! and, unlike a tree, nothing when a new frame comes.

use crate::camera::{Camera, Ray};
use crate::scene::{Ball, Scene, triples};
use ductile_spec::{CurveId, PointId, SurfaceId};
use glam::{Vec2, Vec3};

/// How far behind a surface something still counts as lying on it, in CSS pixels: curves and points stand
/// out of the surface by about their own width.
const ON_SURFACE_PIXELS: f32 = 6.0;
/// How many of the nearest candidates are tested for being hidden; a heap of more cannot be told apart.
const CANDIDATES: usize = 8;

/// What lies under the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hit {
    /// A control point.
    Point {
        /// Which.
        id: PointId,
        /// Where it is.
        at: Vec3,
    },
    /// A control curve.
    Curve {
        /// Which.
        id: CurveId,
        /// Its place nearest to the pointer.
        at: Vec3,
    },
    /// A surface.
    Surface {
        /// Which.
        id: SurfaceId,
        /// The place under the pointer.
        at: Vec3,
        /// The unit normal there, toward the eye.
        normal: Vec3,
        /// Which triangle of the frame.
        triangle: u32,
    },
    /// An edge of a cage.
    Edge {
        /// The surface over the cage.
        surface: SurfaceId,
        /// Its ends.
        ends: [PointId; 2],
        /// Its place nearest to the pointer.
        at: Vec3,
    },
    /// A face of a cage.
    Face {
        /// The surface over the cage.
        surface: SurfaceId,
        /// Which face, in the order of the document.
        face: u32,
        /// The place of the surface over it under the pointer.
        at: Vec3,
        /// The unit normal of the face, outward.
        normal: Vec3,
    },
}

impl Hit {
    /// Where it is.
    #[must_use]
    pub fn at(&self) -> Vec3 {
        match *self {
            Self::Point { at, .. }
            | Self::Curve { at, .. }
            | Self::Surface { at, .. }
            | Self::Edge { at, .. }
            | Self::Face { at, .. } => at,
        }
    }
}

/// What kinds of things a tool wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// Control points.
    pub points: bool,
    /// Control curves.
    pub curves: bool,
    /// Surfaces. They hide what is behind them even if they are not wanted.
    pub surfaces: bool,
    /// Points and curves that a surface hides, too, where none is in sight.
    pub hidden: bool,
    /// A point that is passed over: the one in the hand, when it looks for another to snap to.
    pub except: Option<PointId>,
}

impl Wanted {
    /// Everything that is in sight.
    pub const ALL: Self = Self { points: true, curves: true, surfaces: true, hidden: false, except: None };
}

/// What lies under the pointer, the cursor in CSS pixels. Points and curves are reached from a distance.
#[must_use]
pub fn pick(scene: &Scene, camera: &Camera, cursor: Vec2, reach_px: f32) -> Option<Hit> {
    pick_among(scene, camera, cursor, reach_px, Wanted::ALL)
}

/// As [`pick`], among some kinds of things.
#[must_use]
pub fn pick_among(
    scene: &Scene,
    camera: &Camera,
    cursor: Vec2,
    reach_px: f32,
    wanted: Wanted,
) -> Option<Hit> {
    if !scene.has_frame() {
        return None;
    }
    let aim = Aim { scene, camera, cursor, reach_px };
    let mark = |hidden| {
        let point = if wanted.points { aim.point(wanted.except, hidden) } else { None };
        point.or_else(|| if wanted.curves { aim.curve(hidden) } else { None })
    };
    mark(false)
        .or_else(|| if wanted.hidden { mark(true) } else { None })
        .or_else(|| if wanted.surfaces { aim.surface() } else { None })
}

/// A polyline that can be pointed at.
pub(crate) struct Line {
    pub(crate) places: Vec<Vec3>,
    pub(crate) closed: bool,
}

/// The polyline under the pointer, by its number, and its place nearest to the pointer.
pub(crate) fn pick_line(
    scene: &Scene,
    camera: &Camera,
    cursor: Vec2,
    reach_px: f32,
    lines: impl Iterator<Item = Line>,
) -> Option<(usize, Vec3)> {
    let aim = Aim { scene, camera, cursor, reach_px };
    let candidates = lines.enumerate().filter_map(|(number, line)| {
        let Near { distance_px, depth, at } = aim.nearest_on(line.places.into_iter(), line.closed)?;
        Some(Candidate { distance_px, depth, at, what: number })
    });
    aim.taken(candidates.collect(), false).map(|found| (found.what, found.at))
}

/// Something within reach.
#[derive(Clone, Copy)]
struct Candidate<T> {
    distance_px: f32,
    depth: f32,
    at: Vec3,
    what: T,
}

/// A place of a polyline within reach.
struct Near {
    distance_px: f32,
    depth: f32,
    at: Vec3,
}

/// A pointer over a scene.
struct Aim<'a> {
    scene: &'a Scene,
    camera: &'a Camera,
    cursor: Vec2,
    reach_px: f32,
}

impl Aim<'_> {
    fn point(&self, except: Option<PointId>, hidden: bool) -> Option<Hit> {
        let points = self.scene.points().filter(|(entry, _)| Some(entry.id) != except);
        let candidates = points.filter_map(|(entry, at)| {
            let distance_px = self.camera.project(at)?.distance(self.cursor);
            let depth = self.camera.depth(at);
            (distance_px <= self.reach_px).then_some(Candidate { distance_px, depth, at, what: entry.id })
        });
        let found = self.taken(candidates.collect(), hidden);
        found.map(|found| Hit::Point { id: found.what, at: found.at })
    }

    fn curve(&self, hidden: bool) -> Option<Hit> {
        let candidates = self.scene.structure.curves.iter().filter_map(|span| {
            let samples = triples(self.scene.span_samples(span));
            let Near { distance_px, depth, at } = self.nearest_on(samples, span.closed)?;
            Some(Candidate { distance_px, depth, at, what: span.id })
        });
        let found = self.taken(candidates.collect(), hidden);
        found.map(|found| Hit::Curve { id: found.what, at: found.at })
    }

    /// The place of a polyline nearest to the pointer, if within reach.
    fn nearest_on(&self, places: impl Iterator<Item = Vec3> + Clone, closed: bool) -> Option<Near> {
        let last = places.clone().last()?;
        let closing = if closed { Some(last) } else { None };
        let mut best: Option<Near> = None;
        let mut before: Option<(Vec3, Option<Vec2>)> = closing.map(|at| (at, self.camera.project(at)));
        for at in places {
            let pixel = self.camera.project(at);
            if let (Some((from, Some(from_px))), Some(to_px)) = (before, pixel) {
                let (distance_px, part) = distance_to_segment(self.cursor, from_px, to_px);
                if distance_px <= self.reach_px && best.as_ref().is_none_or(|b| distance_px < b.distance_px) {
                    let place = from.lerp(at, self.part_in_space(from, at, part));
                    best = Some(Near { distance_px, depth: self.camera.depth(place), at: place });
                }
            }
            before = Some((at, pixel));
        }
        best
    }

    /// How far along a segment in space a part of its picture is.
    fn part_in_space(&self, from: Vec3, to: Vec3, part: f32) -> f32 {
        if self.camera.is_orthographic() {
            return part;
        }
        let (a, b) = (self.camera.depth(from), self.camera.depth(to));
        part * a / (part * a + (1.0 - part) * b)
    }

    /// The nearest candidate that no surface hides; of those on one pixel, the front one. If all are hidden, the nearest, where
    /// that will do.
    fn taken<T: Copy>(&self, mut candidates: Vec<Candidate<T>>, hidden: bool) -> Option<Candidate<T>> {
        candidates.sort_by(|a, b| {
            let pixels = a.distance_px.round().total_cmp(&b.distance_px.round());
            pixels.then(a.depth.total_cmp(&b.depth))
        });
        let visible = candidates.iter().take(CANDIDATES).find(|c| !self.is_hidden(c.at));
        visible.or_else(|| candidates.first().filter(|_| hidden)).copied()
    }

    /// Whether a surface lies clearly before a place.
    fn is_hidden(&self, at: Vec3) -> bool {
        let Some(pixel) = self.camera.project(at) else { return true };
        let ray = self.camera.ray(pixel);
        let reach = ray.direction.dot(at - ray.origin) - ON_SURFACE_PIXELS * self.camera.unit_per_pixel(at);
        self.scene.surfaces().any(|(_, triangles, ball)| {
            ball.is_met(&ray)
                && triangles.chunks_exact(3).any(|t| {
                    let [a, b, c] = corners(self.scene, t);
                    meets(&ray, a, b, c).is_some_and(|m| m.distance < reach)
                })
        })
    }

    fn surface(&self) -> Option<Hit> {
        let ray = self.camera.ray(self.cursor);
        let mut best: Option<(Meeting, SurfaceId, usize)> = None;
        for (span, triangles, _) in self.scene.surfaces().filter(|(.., ball)| ball.is_met(&ray)) {
            for (number, t) in triangles.chunks_exact(3).enumerate() {
                let [a, b, c] = corners(self.scene, t);
                let Some(meeting) = meets(&ray, a, b, c) else { continue };
                if best.as_ref().is_none_or(|(b, ..)| meeting.distance < b.distance) {
                    best = Some((meeting, span.id, span.first_index as usize / 3 + number));
                }
            }
        }
        let (meeting, id, triangle) = best?;
        let normal = self.normal(triangle, meeting.weights, ray.direction);
        Some(Hit::Surface {
            id,
            at: ray.at(meeting.distance),
            normal,
            triangle: u32::try_from(triangle).ok()?,
        })
    }

    /// The smooth normal in a triangle, toward the eye. The normals of its corners may point to different
    /// sides where the surface has one side only; each is turned to the side of the triangle first.
    fn normal(&self, triangle: usize, weights: Vec3, direction: Vec3) -> Vec3 {
        let t = &self.scene.indices[3 * triangle..3 * triangle + 3];
        let [a, b, c] = corners(self.scene, t);
        let flat = (b - a).cross(c - a);
        let flat = if flat.dot(direction) > 0.0 { -flat } else { flat };
        let turned = |corner: u32| {
            let normal = self.scene.vertex_normal(corner);
            if normal.dot(flat) < 0.0 { -normal } else { normal }
        };
        let smooth = turned(t[0]) * weights.x + turned(t[1]) * weights.y + turned(t[2]) * weights.z;
        smooth.try_normalize().or_else(|| flat.try_normalize()).unwrap_or(-direction)
    }
}

fn corners(scene: &Scene, t: &[u32]) -> [Vec3; 3] {
    [scene.vertex(t[0]), scene.vertex(t[1]), scene.vertex(t[2])]
}

impl Ball {
    /// Whether a half-line comes near enough.
    fn is_met(self, ray: &Ray) -> bool {
        let to = self.centre - ray.origin;
        let along = ray.direction.dot(to).max(0.0);
        // A little larger than measured, for rounding.
        (to - ray.direction * along).length() <= self.radius * 1.001
    }
}

/// Where a half-line meets a triangle.
struct Meeting {
    distance: f32,
    /// Weights of the corners.
    weights: Vec3,
}

/// Meets a triangle from either side; `None` behind the start.
fn meets(ray: &Ray, a: Vec3, b: Vec3, c: Vec3) -> Option<Meeting> {
    // Neighbours may both claim their common edge, so that no ray slips through.
    const EDGE: f32 = -1e-5;
    let (ab, ac) = (b - a, c - a);
    let p = ray.direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let inverse = 1.0 / determinant;
    let offset = ray.origin - a;
    let v = offset.dot(p) * inverse;
    if !(EDGE..=1.0 - EDGE).contains(&v) {
        return None;
    }
    let q = offset.cross(ab);
    let w = ray.direction.dot(q) * inverse;
    if w < EDGE || v + w > 1.0 - EDGE {
        return None;
    }
    let distance = ac.dot(q) * inverse;
    (distance > 0.0).then(|| Meeting { distance, weights: Vec3::new(1.0 - v - w, v, w) })
}

/// Distance of a place from a segment, and how far along its nearest place is.
fn distance_to_segment(at: Vec2, from: Vec2, to: Vec2) -> (f32, f32) {
    let along = to - from;
    let square = along.length_squared();
    let part = if square > 0.0 { ((at - from).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (at.distance(from + along * part), part)
}

#[cfg(test)]
mod tests;

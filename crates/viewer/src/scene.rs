//! The viewer's own copy of the newest frame: what picking reads, and what the graphics device is filled
//! from anew after it was lost.
//!
//! A frame comes from another thread and is checked before it is believed: counts against the structure,
//! indices against the vertices, numbers against NaN. A frame that fails leaves the scene as it was.

use crate::pick::Hit;
use ductile_spec::{
    CurveId, CurveSpan, FrameHeader, PointEntry, PointId, RegionEntry, Structure, SurfaceId, SurfaceSpan,
    VERTEX_FLOATS,
};
use glam::Vec3;

/// The newest frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// What the numbers belong to.
    pub structure: Structure,
    /// Corners of the triangles, three each, counted from the first vertex of the frame.
    pub indices: Vec<u32>,
    /// The numbers: vertices, curve samples, points, nets (see `ductile_spec::frame`). Empty until the first
    /// frame of a structure has come.
    pub floats: Vec<f32>,
    /// The small part of the frame.
    pub header: FrameHeader,
    /// A ball around each surface, in the order of the structure.
    balls: Vec<Ball>,
    /// A ball around everything.
    bounds: Option<Ball>,
}

/// A ball around a part of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Ball {
    pub(crate) centre: Vec3,
    pub(crate) radius: f32,
}

/// Why a structure or a frame was not taken. The scene is as it was; asking the worker to `Describe` the
/// model anew is the cure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SceneError {
    /// The spans of surfaces, curves or nets do not follow one another without gaps, or a net has an edge outside.
    #[error("the spans of the structure have gaps or overlap")]
    BrokenSpans,
    /// The number of indices is not what the structure says, or not a multiple of three.
    #[error("{found} triangle indices came, {expected} were announced")]
    IndexCount {
        /// As announced.
        expected: usize,
        /// As received.
        found: usize,
    },
    /// A triangle names a vertex outside its surface.
    #[error("triangle {triangle} names a vertex that its surface does not have")]
    IndexRange {
        /// Which triangle of the frame.
        triangle: usize,
    },
    /// The frame belongs to another structure.
    #[error("the frame has topology {found}, the scene has {expected}")]
    Version {
        /// Version of the structure.
        expected: u32,
        /// Version of the frame.
        found: u32,
    },
    /// The number of floats is not what the structure says.
    #[error("{found} numbers came, {expected} were announced")]
    FloatCount {
        /// As announced.
        expected: usize,
        /// As received.
        found: usize,
    },
    /// A number is NaN or infinite.
    #[error("number {at} of the frame is not finite")]
    NotFinite {
        /// Which number.
        at: usize,
    },
}

impl Scene {
    /// Takes a new structure with its triangles; the numbers are missing until [`Self::set_frame`].
    ///
    /// # Errors
    ///
    /// If spans and counts contradict one another.
    pub fn set_structure(&mut self, structure: Structure, indices: Vec<u32>) -> Result<(), SceneError> {
        check_spans(&structure)?;
        let expected = structure.index_count();
        if indices.len() != expected || !expected.is_multiple_of(3) {
            return Err(SceneError::IndexCount { expected, found: indices.len() });
        }
        for surface in &structure.surfaces {
            check_triangles(surface, &indices)?;
        }
        self.structure = structure;
        self.indices = indices;
        self.floats.clear();
        self.balls.clear();
        self.bounds = None;
        Ok(())
    }

    /// Takes the numbers of a frame of the present structure.
    ///
    /// # Errors
    ///
    /// If the frame belongs to another structure, has another length or a number that is not finite.
    pub fn set_frame(&mut self, header: FrameHeader, floats: &[f32]) -> Result<(), SceneError> {
        let expected = self.structure.version;
        if header.topology_version != expected {
            return Err(SceneError::Version { expected, found: header.topology_version });
        }
        let expected = self.structure.float_count();
        if floats.len() != expected {
            return Err(SceneError::FloatCount { expected, found: floats.len() });
        }
        if let Some(at) = floats.iter().position(|x| !x.is_finite()) {
            return Err(SceneError::NotFinite { at });
        }
        self.floats.clear();
        self.floats.extend_from_slice(floats);
        self.header = header;
        self.measure();
        Ok(())
    }

    /// Whether the numbers of the present structure have come.
    #[must_use]
    pub fn has_frame(&self) -> bool {
        self.floats.len() == self.structure.float_count()
    }

    /// Centre and radius of a ball around everything; `None` while there is nothing.
    #[must_use]
    pub fn bounds(&self) -> Option<(Vec3, f32)> {
        self.bounds.map(|ball| (ball.centre, ball.radius))
    }

    /// Where a control point is.
    #[must_use]
    pub fn point(&self, id: PointId) -> Option<Vec3> {
        self.points().find(|(entry, _)| entry.id == id).map(|(_, at)| at)
    }

    /// The control points with their places, in order; none before the first frame.
    pub fn points(&self) -> impl Iterator<Item = (&PointEntry, Vec3)> + '_ {
        let places = self.part(self.structure.points_at(), self.structure.nets_at());
        self.structure.points.iter().zip(triples(places))
    }

    /// The span of a curve.
    #[must_use]
    pub fn curve(&self, id: CurveId) -> Option<&CurveSpan> {
        self.structure.curves.iter().find(|curve| curve.id == id)
    }

    /// The samples of a curve, in order; empty if it is unknown.
    pub fn samples(&self, id: CurveId) -> impl ExactSizeIterator<Item = Vec3> + Clone + '_ {
        let span = self.curve(id);
        triples(span.map_or(&[], |span| self.span_samples(span)))
    }

    /// The samples of a curve by its span.
    pub(crate) fn span_samples(&self, span: &CurveSpan) -> &[f32] {
        let first = self.structure.samples_at() + 3 * span.first as usize;
        self.part(first, first + 3 * span.count as usize)
    }

    /// The place of a vertex of the net of a surface, counted from its first.
    #[must_use]
    pub fn net_vertex(&self, surface: SurfaceId, vertex: u32) -> Option<Vec3> {
        let net = self.structure.nets.iter().find(|net| net.surface == surface)?;
        let at = self.structure.nets_at() + 3 * (net.first as usize + vertex as usize);
        (vertex < net.count && self.has_frame()).then(|| vector(&self.floats, at))
    }

    /// The place of a vertex.
    pub(crate) fn vertex(&self, index: u32) -> Vec3 {
        vector(&self.floats, index as usize * VERTEX_FLOATS)
    }

    /// The unit normal of a vertex.
    pub(crate) fn vertex_normal(&self, index: u32) -> Vec3 {
        vector(&self.floats, index as usize * VERTEX_FLOATS + 3)
    }

    /// The region of a surface nearest to a place, by the middle of its triangles; none if the surface is in one piece.
    #[must_use]
    pub fn region_at(&self, surface: SurfaceId, at: Vec3) -> Option<RegionEntry> {
        let (span, triangles, _) = self.surfaces().find(|(span, ..)| span.id == surface)?;
        let first = span.first_index as usize / 3;
        let middle = |t: &[u32]| t.iter().map(|v| self.vertex(*v)).sum::<Vec3>() / 3.0;
        let distances = triangles.chunks_exact(3).map(|t| middle(t).distance_squared(at));
        let (nearest, _) = distances.enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b))?;
        let region = self.structure.region_of_triangle.get(first + nearest)?;
        self.structure.regions.get(usize::from(*region)).copied().filter(|entry| entry.surface == surface)
    }

    /// The place of a surface nearest to a given one, by the middle of its triangles, as if it had been pointed at.
    #[must_use]
    pub fn hit_near(&self, surface: SurfaceId, place: Vec3) -> Option<Hit> {
        let (span, triangles, _) = self.surfaces().find(|(span, ..)| span.id == surface)?;
        let middle = |t: &[u32]| t.iter().map(|v| self.vertex(*v)).sum::<Vec3>() / 3.0;
        let middles = triangles.chunks_exact(3).map(middle).zip(span.first_index / 3..);
        let distance = |(at, _): &(Vec3, u32)| at.distance_squared(place);
        let (at, triangle) = middles.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let normal = self.vertex_normal(self.indices[3 * triangle as usize]);
        Some(Hit::Surface { id: surface, at, normal, triangle })
    }

    /// The surface that has the vertex nearest to a place.
    #[must_use]
    pub fn surface_near(&self, place: Vec3) -> Option<SurfaceId> {
        let nearest = |span: &SurfaceSpan| {
            let own = span.first_vertex..span.first_vertex + span.vertex_count;
            own.map(|v| self.vertex(v).distance_squared(place)).fold(f32::INFINITY, f32::min)
        };
        let found =
            self.structure.surfaces.iter().filter(|_| self.has_frame()).map(|span| (nearest(span), span.id));
        found.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, id)| id)
    }

    /// The region to which a triangle of the frame belongs; none if its surface is in one piece.
    #[must_use]
    pub fn region_of(&self, triangle: u32) -> Option<u16> {
        let region = self.structure.region_of_triangle.get(triangle as usize).copied();
        region.filter(|region| usize::from(*region) < self.structure.regions.len())
    }

    /// Centre and radius of a ball around a surface.
    #[must_use]
    pub fn ball_of(&self, surface: SurfaceId) -> Option<(Vec3, f32)> {
        let (.., ball) = self.surfaces().find(|(span, ..)| span.id == surface)?;
        Some((ball.centre, ball.radius))
    }

    /// The triangles of a surface with a ball around them; none before the first frame.
    pub(crate) fn surfaces(&self) -> impl Iterator<Item = (&SurfaceSpan, &[u32], Ball)> + '_ {
        self.structure.surfaces.iter().zip(&self.balls).map(|(span, ball)| {
            let first = span.first_index as usize;
            (span, &self.indices[first..first + span.index_count as usize], *ball)
        })
    }

    /// A part of the numbers, as far as it is there.
    fn part(&self, from: usize, to: usize) -> &[f32] {
        self.floats.get(from..to.min(self.floats.len())).unwrap_or_default()
    }

    /// Measures the balls.
    fn measure(&mut self) {
        let vertices = |span: &SurfaceSpan| {
            let first = span.first_vertex as usize * VERTEX_FLOATS;
            let last = first + span.vertex_count as usize * VERTEX_FLOATS;
            self.floats[first..last].chunks_exact(VERTEX_FLOATS).map(|v| Vec3::new(v[0], v[1], v[2]))
        };
        let balls = self.structure.surfaces.iter().map(|s| Ball::around(vertices(s)).unwrap_or_default());
        self.balls.clear();
        self.balls.extend(balls);
        let all = self.structure.surfaces.iter().flat_map(vertices);
        // Control nets may reach far beyond what they control, and are no part of the shape.
        let marks = self.part(self.structure.samples_at(), self.structure.nets_at());
        self.bounds = Ball::around(all.chain(triples(marks)));
    }
}

impl Ball {
    /// The smallest ball around some places with its centre in the middle of their box.
    fn around(places: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        let mut low = Vec3::INFINITY;
        let mut high = Vec3::NEG_INFINITY;
        for at in places.clone() {
            low = low.min(at);
            high = high.max(at);
        }
        // Halved before the sum, so that the largest coordinates do not overflow.
        let centre = low * 0.5 + high * 0.5;
        let radius = places.map(|at| at.distance(centre)).fold(0.0, f32::max);
        (low.x <= high.x).then_some(Self { centre, radius })
    }
}

/// Three floats at a time.
pub(crate) fn triples(floats: &[f32]) -> impl ExactSizeIterator<Item = Vec3> + Clone + '_ {
    floats.chunks_exact(3).map(|v| Vec3::new(v[0], v[1], v[2]))
}

fn vector(floats: &[f32], at: usize) -> Vec3 {
    Vec3::new(floats[at], floats[at + 1], floats[at + 2])
}

/// Spans must follow one another without gaps, from zero.
fn check_spans(structure: &Structure) -> Result<(), SceneError> {
    let mut vertex = 0_u32;
    let mut index = 0_u32;
    for surface in &structure.surfaces {
        if surface.first_vertex != vertex
            || surface.first_index != index
            || !surface.index_count.is_multiple_of(3)
        {
            return Err(SceneError::BrokenSpans);
        }
        vertex = vertex.checked_add(surface.vertex_count).ok_or(SceneError::BrokenSpans)?;
        index = index.checked_add(surface.index_count).ok_or(SceneError::BrokenSpans)?;
    }
    let mut sample = 0_u32;
    for curve in &structure.curves {
        if curve.first != sample {
            return Err(SceneError::BrokenSpans);
        }
        sample = sample.checked_add(curve.count).ok_or(SceneError::BrokenSpans)?;
    }
    let mut vertex = 0_u32;
    for net in &structure.nets {
        if net.first != vertex || net.edges.iter().flatten().any(|end| *end >= net.count) {
            return Err(SceneError::BrokenSpans);
        }
        vertex = vertex.checked_add(net.count).ok_or(SceneError::BrokenSpans)?;
    }
    Ok(())
}

/// The triangles of a surface name only its own vertices.
fn check_triangles(surface: &SurfaceSpan, indices: &[u32]) -> Result<(), SceneError> {
    let first = surface.first_index as usize;
    let own = &indices[first..first + surface.index_count as usize];
    let vertices = surface.first_vertex..surface.first_vertex + surface.vertex_count;
    match own.iter().position(|corner| !vertices.contains(corner)) {
        Some(at) => Err(SceneError::IndexRange { triangle: (first + at) / 3 }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::{self, frame_of};
    use ductile_spec::{CurveRole, SurfaceId};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn empty_scene_copes() {
        let mut scene = Scene::default();
        assert!(scene.set_frame(FrameHeader::default(), &[]).is_ok());
        assert_eq!(scene.bounds(), None);
        assert_eq!(scene.point(PointId(1)), None);
        assert_eq!(scene.samples(CurveId(1)).len(), 0);
    }

    #[test]
    fn places_are_found() {
        let scene = sample::bumpy_disc(12);
        let (centre, radius) = scene.bounds().unwrap();
        assert!(centre.length() < 0.5 && (0.99..1.2).contains(&radius), "{centre} {radius}");
        assert_eq!(scene.points().count(), scene.structure.points.len());
        let id = scene.structure.points[1].id;
        assert_eq!(scene.point(id), scene.points().nth(1).map(|(_, at)| at));
        let curve = scene.structure.curves[0];
        assert_eq!(scene.samples(curve.id).len(), curve.count as usize);
        assert!((scene.samples(curve.id).next().unwrap().length() - 1.0).abs() < 0.2);
    }

    #[test]
    fn what_lies_nearest_is_found() {
        let plate = |z: f32| move |u: f32, v: f32| Vec3::new(u, v, z);
        let sketch = sample::Sketch::default().grid(10, plate(0.0), true).grid(10, plate(1.0), true);
        let mut scene = sketch.finish();
        assert_eq!(scene.surface_near(Vec3::new(0.5, 0.5, 0.7)), Some(SurfaceId(2)));
        let Some(Hit::Surface { at, triangle, .. }) = scene.hit_near(SurfaceId(2), Vec3::splat(0.52)) else {
            panic!("there is a place");
        };
        assert!(at.z == 1.0 && at.truncate().distance(glam::Vec2::splat(0.52)) < 0.06 && triangle >= 200);
        assert_eq!(scene.region_of(triangle), None);
        let region = RegionEntry { surface: SurfaceId(2), objective: None, spacing: None, shadow: None };
        scene.structure.regions = vec![region; 2];
        scene.structure.region_of_triangle = [vec![ductile_spec::NO_REGION; 200], vec![1; 200]].concat();
        assert_eq!((scene.region_of(0), scene.region_of(triangle)), (None, Some(1)));
    }

    #[test]
    fn wrong_frames_are_refused_and_change_nothing() {
        let mut scene = sample::bumpy_disc(6);
        let before = scene.clone();
        let (header, mut floats) = frame_of(&scene);
        let stale = FrameHeader { topology_version: 99, ..header.clone() };
        assert!(matches!(scene.set_frame(stale, &floats), Err(SceneError::Version { found: 99, .. })));
        let short = &floats[..floats.len() - 1];
        assert!(matches!(scene.set_frame(header.clone(), short), Err(SceneError::FloatCount { .. })));
        for bad in [f32::NAN, f32::INFINITY] {
            floats[7] = bad;
            assert_eq!(scene.set_frame(header.clone(), &floats), Err(SceneError::NotFinite { at: 7 }));
        }
        assert_eq!(scene, before);
    }

    #[test]
    fn wrong_structures_are_refused_and_change_nothing() {
        let mut scene = sample::bumpy_disc(6);
        let before = scene.clone();
        let structure = scene.structure.clone();
        let mut indices = scene.indices.clone();
        indices.pop();
        assert!(matches!(
            scene.set_structure(structure.clone(), indices),
            Err(SceneError::IndexCount { .. })
        ));
        let mut indices = scene.indices.clone();
        indices[4] = 1_000_000;
        assert_eq!(
            scene.set_structure(structure.clone(), indices.clone()),
            Err(SceneError::IndexRange { triangle: 1 })
        );
        let mut gap = structure.clone();
        gap.surfaces[0].first_vertex = 1;
        assert_eq!(scene.set_structure(gap, before.indices.clone()), Err(SceneError::BrokenSpans));
        let mut gap = structure;
        gap.curves[0].first = 2;
        assert_eq!(scene.set_structure(gap, before.indices.clone()), Err(SceneError::BrokenSpans));
        assert_eq!(scene, before);
    }

    #[test]
    fn counts_that_overflow_are_refused() {
        let surface = SurfaceSpan {
            id: SurfaceId(1),
            first_vertex: 0,
            vertex_count: u32::MAX,
            first_index: 0,
            index_count: 0,
            kind: ductile_spec::SurfaceKind::Fair,
            summary: ductile_spec::SurfaceSummary::default(),
        };
        let second = SurfaceSpan { first_vertex: u32::MAX, ..surface };
        let structure = Structure { surfaces: vec![surface, second], ..Structure::default() };
        assert_eq!(Scene::default().set_structure(structure, vec![]), Err(SceneError::BrokenSpans));
        let curve =
            CurveSpan { id: CurveId(1), first: 0, count: u32::MAX, closed: false, role: CurveRole::Free };
        let curves = vec![curve, CurveSpan { first: u32::MAX, ..curve }];
        let structure = Structure { curves, ..Structure::default() };
        assert_eq!(Scene::default().set_structure(structure, vec![]), Err(SceneError::BrokenSpans));
    }
}

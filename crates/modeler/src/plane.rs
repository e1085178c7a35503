//! The tangent planes that a document prescribes, at the vertices that follow its controls: normals at points, and ribbons
//! along curves (thesis sections 2.5.3 and 5.5).
//!
//! A ribbon has directions at some control points. Between them they are carried along the samples without turning about the
//! curve, from both ends, by double reflection (Wang et al., *Computation of rotation minimizing frames*, 2008), and blended
//! by angle. So a single direction does for a whole rim: along a plane one its angle to the plane stays what it is.
//!
//! A ribbon can also go on from an exact surface that ends at the curve: its directions are those that lead away from that
//! one within its tangent planes, as they are now.
//!
//! What cannot be is not asked for: of a normal at a point of a curve only what is across the curve counts, and where two
//! curves cross, their tangents are the plane already.

use crate::bank;
use crate::error::ModelError;
use crate::model::Model;
use crate::patch::{Led, PatchRim};
use crate::shape::{CurveShape, EmbeddedCurve, SurfaceShape};
use ductile_mesh::VertexId;
use ductile_solver::Rings;
use ductile_spec::{CurveId, Document, PointId, Ribbon, SurfaceId};
use glam::DVec3;
use std::collections::BTreeMap;

/// Sine of the angle to the curve below which a direction says nothing about what is across it.
const ACROSS: f64 = 0.02;

/// What is prescribed of a surface, found again on its mesh.
#[derive(Debug)]
pub(crate) struct Planes<'a> {
    pub(crate) model: &'a Model,
    pub(crate) shape: &'a SurfaceShape,
    pub(crate) rings: &'a Rings,
    /// The node of every vertex.
    pub(crate) compact: &'a [u32],
    /// The unit normals that the surface has now, per node.
    pub(crate) normals: &'a [DVec3],
}

impl Planes<'_> {
    /// Node and unit normal of every plane, in the senses of the rings.
    pub(crate) fn of(&self, id: SurfaceId) -> Vec<(u32, DVec3)> {
        let Some(surface) = self.model.document.surfaces.get(&id) else { return Vec::new() };
        let mut planes: BTreeMap<u32, DVec3> = BTreeMap::new();
        let crossings = self.crossings();
        for (curve, ribbon) in &surface.ribbons {
            let embedded = self.shape.embeddings.iter().find(|embedded| embedded.curve == *curve);
            let (Some(embedded), Some(shape)) = (embedded, self.model.curves.get(curve)) else { continue };
            let crosses = match ribbon.onto.and_then(|other| self.model.patches.get(&other)) {
                Some(patch) => {
                    match Led::of(self.model, *curve).filter(|led| ribbon.onto == Some(led.surface)) {
                        Some(led) => {
                            let away = |sample| Some(led.on_sampling(shape, sample, 0.0)?.away);
                            (0..shape.nodes.len()).map(away).collect()
                        }
                        None => {
                            let rim = PatchRim::new(patch);
                            shape.nodes.iter().map(|at| rim.away(*at)).collect()
                        }
                    }
                }
                None => crosses(&self.model.document, *curve, shape, ribbon),
            };
            for ((v, normal), cross) in embedded.vertices.iter().zip(self.along(embedded, shape)).zip(crosses)
            {
                let (Some(across), Some(cross)) = (normal, cross) else { continue };
                planes.entry(self.node(*v)).or_insert_with(|| across.cross(cross));
            }
        }
        for (point, normal) in &surface.normals {
            if let Some((node, normal)) = self.at_point(*point, *normal) {
                planes.insert(node, normal);
            }
        }
        planes.retain(|node, _| !crossings.contains(node));
        // What a fill takes planes from is smooth at its corners only in the plane of both curves.
        for (v, normal) in bank::corners(self.model, id, self.shape) {
            let node = self.node(v);
            let now = self.normals.get(node as usize).copied().unwrap_or_default();
            planes.insert(node, if normal.dot(now) < 0.0 { -normal } else { normal });
        }
        planes.into_iter().collect()
    }

    fn node(&self, v: VertexId) -> u32 {
        self.compact[v.index()]
    }

    /// Nodes on more than one curve.
    fn crossings(&self) -> Vec<u32> {
        let on_curves = self.shape.embeddings.iter().flat_map(|embedded| &embedded.vertices);
        let mut nodes: Vec<u32> = on_curves.map(|v| self.node(*v)).collect();
        nodes.sort_unstable();
        let mut twice: Vec<u32> =
            nodes.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
        twice.dedup();
        twice
    }

    /// The normal at a control point, less what runs along its curve, in the sense that the surface has now.
    fn at_point(&self, point: PointId, normal: DVec3) -> Option<(u32, DVec3)> {
        let pin = self.shape.pins.iter().find(|pin| pin.point == point).map(|pin| pin.vertex);
        let on_curve = self.shape.embeddings.iter().find_map(|embedded| {
            let shape = self.model.curves.get(&embedded.curve)?;
            let sample = shape.sample_of(point)?;
            Some((*embedded.vertices.get(sample)?, embedded.curve, shape, sample))
        });
        let (vertex, across) = match (on_curve, pin) {
            (Some((vertex, curve, shape, sample)), _) => {
                let tangents = tangents(&self.model.document, curve, shape);
                (vertex, across(normal, tangents[sample])?)
            }
            (None, Some(vertex)) => (vertex, unit(normal)?),
            (None, None) => return None,
        };
        let node = self.node(vertex);
        let now = self.normals.get(node as usize)?;
        Some((node, if across.dot(*now) < 0.0 { -across } else { across }))
    }

    /// The tangent at every sample of a curve in the surface, turned so that its vector product with a direction away from the
    /// curve into the surface (inside: to the left) is a normal in the sense of the ring.
    fn along(&self, embedded: &EmbeddedCurve, shape: &CurveShape) -> Vec<Option<DVec3>> {
        let tangents = tangents(&self.model.document, embedded.curve, shape);
        let count = embedded.vertices.len().min(tangents.len());
        let nodes: Vec<u32> = embedded.vertices[..count].iter().map(|v| self.node(*v)).collect();
        // Rings may turn either way, if the surface has one side: the curve's left stays where it was.
        let mut sense = 1.0;
        let mut result = Vec::with_capacity(count);
        for k in 0..count {
            let next = if k + 1 < count || shape.closed { Some(nodes[(k + 1) % count]) } else { None };
            let ring = self.rings.ring(nodes[k] as usize);
            let turn = if self.rings.is_boundary(nodes[k] as usize) {
                // The surface is to the left of the way to the first of the ring.
                let before = if k > 0 || shape.closed { Some(nodes[(k + count - 1) % count]) } else { None };
                match (ring.first().copied(), ring.last().copied()) {
                    (Some(first), _) if Some(first) == next => Some(1.0),
                    (_, Some(last)) if Some(last) == next => Some(-1.0),
                    (Some(first), _) if Some(first) == before => Some(-1.0),
                    (_, Some(last)) if Some(last) == before => Some(1.0),
                    _ => None,
                }
            } else {
                Some(sense)
            };
            result.push(turn.map(|turn| tangents[k] * turn));
            if let Some(next) = next {
                sense *= self.agreement(nodes[k], next);
            }
        }
        result
    }

    /// +1 where the rings of two neighbours turn the same way, -1 where they do not.
    fn agreement(&self, a: u32, b: u32) -> f64 {
        let (at_a, at_b) = (self.rings.ring(a as usize), self.rings.ring(b as usize));
        let after = |ring: &[u32], node: u32| {
            let place = ring.iter().position(|other| *other == node)?;
            ring.get(place + 1).or_else(|| ring.first()).copied()
        };
        // The corner after b around a lies before a around b, if both turn the same way.
        let Some(corner) = after(at_a, b) else { return 1.0 };
        if after(at_b, corner) == Some(a) || after(at_b, a) != Some(corner) { 1.0 } else { -1.0 }
    }

    /// A curve and how the surface follows it.
    fn followed(&self, id: SurfaceId, curve: CurveId) -> Result<(&EmbeddedCurve, &CurveShape), ModelError> {
        let embedded = self.shape.embeddings.iter().find(|embedded| embedded.curve == curve);
        embedded
            .zip(self.model.curves.get(&curve).map(|shape| &**shape))
            .ok_or(ModelError::NotInSurface { surface: id, curve })
    }

    /// The directions in which the surface leaves a curve now, by control point; none where curves cross, since their tangents
    /// are the plane there.
    pub(crate) fn left_now(
        &self,
        id: SurfaceId,
        curve: CurveId,
    ) -> Result<BTreeMap<PointId, DVec3>, ModelError> {
        let (embedded, shape) = self.followed(id, curve)?;
        let (turned, crossings) = (self.along(embedded, shape), self.crossings());
        let mut cross = BTreeMap::new();
        for (sample, point) in &shape.controls {
            let place = *sample as usize;
            let (Some(v), Some(Some(along))) = (embedded.vertices.get(place), turned.get(place)) else {
                continue;
            };
            let node = self.node(*v);
            let normal = self.normals.get(node as usize).filter(|_| !crossings.contains(&node));
            if let Some(direction) = normal.and_then(|normal| unit(normal.cross(*along))) {
                cross.insert(*point, direction);
            }
        }
        Ok(cross)
    }

    /// The directions of a ribbon that leaves a curve at an angle from the curve's plane, by control point.
    pub(crate) fn leaving(
        &self,
        id: SurfaceId,
        curve: CurveId,
        angle: f64,
    ) -> Result<BTreeMap<PointId, DVec3>, ModelError> {
        let (embedded, shape) = self.followed(id, curve)?;
        let plane = unit(area(&shape.nodes)).ok_or(ModelError::NoPlane(curve))?;
        let tangents = tangents(&self.model.document, curve, shape);
        let turned = self.along(embedded, shape);
        let (sin, cos) = libm::sincos(angle);
        let mut cross = BTreeMap::new();
        for (sample, point) in &shape.controls {
            let sample = *sample as usize;
            let (Some(v), Some(Some(along))) = (embedded.vertices.get(sample), turned.get(sample)) else {
                continue;
            };
            let (node, tangent) = (self.node(*v) as usize, tangents[sample]);
            // Inside the curve, across it; on the boundary the surface's own sense says which side of the plane is up.
            let Some(inwards) = unit(plane.cross(tangent)) else { continue };
            let direction = if self.rings.is_boundary(node) {
                inwards * cos + along.cross(inwards) * sin
            } else {
                let up = tangent.cross(inwards);
                let side = if self.normals[node].dot(up) < 0.0 { -1.0 } else { 1.0 };
                (inwards * cos + up * sin) * side
            };
            cross.insert(*point, direction);
        }
        Ok(cross)
    }
}

/// What of a direction is across a curve at one of its control points, as a unit vector; none if it runs along the curve.
pub(crate) fn across_at(model: &Model, curve: CurveId, point: PointId, direction: DVec3) -> Option<DVec3> {
    let shape = model.curves.get(&curve)?;
    let sample = shape.sample_of(point)?;
    across(direction, tangents(&model.document, curve, shape)[sample])
}

/// Refuses a normal that says nothing, because the curves through its point leave it no choice.
pub(crate) fn check_normal(
    model: &Model,
    id: SurfaceId,
    point: PointId,
    normal: DVec3,
) -> Result<(), ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let curves = shape.embeddings.iter().filter_map(|embedded| {
        let curve = model.curves.get(&embedded.curve)?;
        Some((embedded.curve, curve, curve.sample_of(point)?))
    });
    for (place, (id_of_curve, curve, sample)) in curves.enumerate() {
        if place > 0 {
            return Err(ModelError::PlaneGiven { surface: id, point });
        }
        let tangent = tangents(&model.document, id_of_curve, curve)[sample];
        if across(normal, tangent).is_none() {
            return Err(ModelError::NormalAlongCurve { surface: id, curve: id_of_curve, point });
        }
    }
    Ok(())
}

/// Refuses a ribbon's direction that runs along its curve.
pub(crate) fn check_cross(
    model: &Model,
    id: SurfaceId,
    curve: CurveId,
    ribbon: &Ribbon,
) -> Result<(), ModelError> {
    let shape = model.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?;
    let tangents = tangents(&model.document, curve, shape);
    for (point, cross) in &ribbon.cross {
        let tangent = shape.sample_of(*point).map(|sample| tangents[sample]);
        if tangent.is_some_and(|tangent| across(*cross, tangent).is_none()) {
            return Err(ModelError::CrossAlongCurve { surface: id, curve, point: *point });
        }
    }
    Ok(())
}

/// Whatever its length.
fn unit(vector: DVec3) -> Option<DVec3> {
    let size = vector.abs().max_element();
    (vector / size).try_normalize()
}

/// What of a direction is across a unit tangent, as a unit vector; none if it runs along it.
fn across(direction: DVec3, tangent: DVec3) -> Option<DVec3> {
    let direction = unit(direction)?;
    let across = direction - tangent * tangent.dot(direction);
    if across.length() < ACROSS { None } else { across.try_normalize() }
}

/// Twice the vector area of a closed polygon.
fn area(nodes: &[DVec3]) -> DVec3 {
    let centre = nodes.iter().sum::<DVec3>() / nodes.len().max(1) as f64;
    let next = nodes.iter().cycle().skip(1);
    let sum: DVec3 = nodes.iter().zip(next).map(|(a, b)| (*a - centre).cross(*b - centre)).sum();
    let extent = nodes.iter().map(|at| at.distance_squared(centre)).fold(0.0, f64::max);
    // A straight line lies in many planes.
    if sum.length() > 1e-6 * extent { sum } else { DVec3::ZERO }
}

/// Unit tangents at the samples: of the parabola through each and its neighbours, or what the document prescribes.
pub(crate) fn tangents(document: &Document, id: CurveId, shape: &CurveShape) -> Vec<DVec3> {
    let (nodes, count) = (&shape.nodes, shape.nodes.len());
    let chord = |k: usize| unit(nodes[(k + 1) % count] - nodes[k % count]).unwrap_or(DVec3::ZERO);
    let length = |k: usize| nodes[(k + 1) % count].distance(nodes[k % count]);
    let inner = |k: usize| {
        let before = (k + count - 1) % count;
        unit(chord(k) * length(before) + chord(before) * length(k)).unwrap_or_else(|| chord(k))
    };
    let mut tangents: Vec<DVec3> = (0..count)
        .map(|k| match (shape.closed, k) {
            (true, _) => inner(k),
            (false, 0) if count > 2 => mirrored(inner(1), chord(0)),
            (false, 0) => chord(0),
            (false, k) if k + 1 == count && count > 2 => mirrored(inner(k - 1), chord(k - 1)),
            (false, k) if k + 1 == count => chord(k.saturating_sub(1)),
            (false, k) => inner(k),
        })
        .collect();
    if let Some(curve) = document.curves.get(&id) {
        for (sample, point) in &shape.controls {
            if let Some(given) = curve.tangents.get(point).and_then(|given| unit(*given)) {
                tangents[*sample as usize] = given;
            }
        }
    }
    tangents
}

/// The tangent at the other end of a chord, as on a circle.
fn mirrored(tangent: DVec3, chord: DVec3) -> DVec3 {
    unit(chord * (2.0 * chord.dot(tangent)) - tangent).unwrap_or(chord)
}

/// The unit direction of a ribbon at every sample, across the curve; none where it has none.
fn crosses(document: &Document, id: CurveId, shape: &CurveShape, ribbon: &Ribbon) -> Vec<Option<DVec3>> {
    let count = shape.nodes.len();
    let tangents = tangents(document, id, shape);
    let given: Vec<(usize, DVec3)> = shape
        .controls
        .iter()
        .filter_map(|(sample, point)| {
            let sample = *sample as usize;
            Some((sample, across(*ribbon.cross.get(point)?, tangents[sample])?))
        })
        .collect();
    let mut crosses = vec![None; count];
    let (Some(first), Some(last)) = (given.first(), given.last()) else { return crosses };
    let carry = |from: usize, to: usize, cross: DVec3| {
        carried([shape.nodes[from], shape.nodes[to]], [tangents[from], tangents[to]], cross)
    };
    for (place, &(start, cross)) in given.iter().enumerate() {
        let (end, target, steps) = match given.get(place + 1) {
            Some(&(end, target)) => (end, target, end - start),
            None if shape.closed => (first.0, first.1, first.0 + count - start),
            None => continue,
        };
        // From the start onwards, and from the end back.
        let mut forth = vec![cross];
        for step in 0..steps {
            forth.push(carry((start + step) % count, (start + step + 1) % count, forth[step]));
        }
        let mut back = target;
        let total: f64 = (0..steps).map(|step| length(shape, start + step)).sum();
        let mut left = 0.0;
        for step in (0..steps).rev() {
            let (here, after) = ((start + step) % count, (start + step + 1) % count);
            back = carry(after, here, back);
            left += length(shape, start + step);
            let way = if total > 0.0 { 1.0 - left / total } else { 0.0 };
            crosses[here] = Some(blended(forth[step], back, tangents[here], way));
        }
        crosses[end] = Some(target);
    }
    if !shape.closed {
        (crosses[first.0], crosses[last.0]) = (Some(first.1), Some(last.1));
        let mut cross = first.1;
        for k in (0..first.0).rev() {
            cross = carry(k + 1, k, cross);
            crosses[k] = Some(cross);
        }
        cross = last.1;
        for (k, place) in crosses.iter_mut().enumerate().skip(last.0 + 1) {
            cross = carry(k - 1, k, cross);
            *place = Some(cross);
        }
    }
    crosses
}

fn length(shape: &CurveShape, edge: usize) -> f64 {
    let count = shape.nodes.len();
    shape.nodes[edge % count].distance(shape.nodes[(edge + 1) % count])
}

/// A direction across a curve, carried from one sample to the next without turning about it: reflected in the plane midway, then
/// so that the tangents agree.
fn carried(places: [DVec3; 2], tangents: [DVec3; 2], cross: DVec3) -> DVec3 {
    let reflect = |vector: DVec3, across: DVec3| {
        let squared = across.length_squared();
        if squared > 0.0 { vector - across * (2.0 * across.dot(vector) / squared) } else { vector }
    };
    let chord = places[1] - places[0];
    let (cross, tangent) = (reflect(cross, chord), reflect(tangents[0], chord));
    let cross = reflect(cross, tangents[1] - tangent);
    across(cross, tangents[1]).unwrap_or(cross)
}

/// Between two directions across a tangent, `way` in [0, 1] of the way, without haste at the ends.
fn blended(from: DVec3, to: DVec3, tangent: DVec3, way: f64) -> DVec3 {
    let angle = libm::atan2(tangent.dot(from.cross(to)), from.dot(to));
    let (sin, cos) = libm::sincos(angle * way * way * (3.0 - 2.0 * way));
    from * cos + tangent.cross(from) * sin
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A circle of radius 2 with so many samples, with controls at some of them, and a ribbon with one direction for each control.
    fn circle(samples: u32, controls: &[u32], cross: &[DVec3]) -> Vec<Option<DVec3>> {
        let turn = core::f64::consts::TAU / f64::from(samples);
        let place =
            |k: u32| 2.0 * DVec3::new(libm::cos(f64::from(k) * turn), libm::sin(f64::from(k) * turn), 0.0);
        let controls: Vec<_> = controls.iter().map(|k| (*k, PointId(*k))).collect();
        let ribbon =
            Ribbon::directed(controls.iter().map(|(_, id)| *id).zip(cross.iter().copied()).collect());
        let nodes = (0..samples).map(place).collect();
        let shape = CurveShape { nodes, closed: true, controls, revision: 0 };
        crosses(&Document::default(), CurveId(1), &shape, &ribbon)
    }

    /// Height over the plane of the circle, as an angle.
    fn rise(cross: &Option<DVec3>) -> f64 {
        libm::asin(cross.unwrap().z)
    }

    #[test]
    fn one_direction_keeps_its_angle_to_the_plane_of_the_curve_all_round() {
        let given = DVec3::new(-3.0, 0.0, 3.0);
        for (k, cross) in circle(37, &[0], &[given]).iter().enumerate() {
            assert!(
                (rise(cross) - core::f64::consts::FRAC_PI_4).abs() < 1e-12,
                "sample {k}: {}",
                rise(cross)
            );
        }
    }

    #[test]
    fn two_directions_blend_without_haste_and_are_met() {
        let crosses = circle(40, &[0, 20], &[DVec3::NEG_X, DVec3::new(1.0, 0.0, 1.0)]);
        let rises: Vec<f64> = crosses.iter().map(rise).collect();
        assert!(rises[0].abs() < 1e-12 && (rises[20] - core::f64::consts::FRAC_PI_4).abs() < 1e-12);
        assert!((rises[10] - 0.5 * rises[20]).abs() < 1e-12, "half way is half of it");
        for k in 0..20 {
            assert!(rises[k] < rises[k + 1] && (rises[k] - rises[(40 - k) % 40]).abs() < 1e-12);
        }
        assert!(rises[1] < 0.01 * rises[20], "it starts slowly");
    }

    #[test]
    fn a_direction_along_the_curve_says_nothing() {
        assert_eq!(circle(12, &[0], &[DVec3::Y]), vec![None; 12]);
        assert!(across(DVec3::new(0.01, 1.0, 0.0), DVec3::Y).is_none());
        assert_eq!(across(DVec3::new(5e-300, 1e-300, 0.0), DVec3::Y), Some(DVec3::X));
    }

    #[test]
    fn an_open_curve_carries_its_directions_on_to_its_ends() {
        let nodes = (0..9).map(|k| DVec3::X * f64::from(k)).collect();
        let controls = vec![(0, PointId(0)), (4, PointId(4)), (8, PointId(8))];
        let shape = CurveShape { nodes, closed: false, controls, revision: 0 };
        let ribbon = Ribbon::directed([(PointId(4), DVec3::new(1.0, 2.0, 0.0))].into());
        assert_eq!(crosses(&Document::default(), CurveId(1), &shape, &ribbon), vec![Some(DVec3::Y); 9]);
    }
}

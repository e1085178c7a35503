//! Connected parts of a surface, and how firmly its constraints hold each of them.
//!
//! Source: recipe section 4. A part with fewer than four non-coplanar constraint points has a family of minimisers
//! (three pins on a closed surface leave a Möbius family); undamped steps drift along it without bound.

use glam::DVec3;

use crate::rings::Rings;

/// Which part every node belongs to, numbered by first node.
#[derive(Clone, Debug)]
pub(crate) struct Components {
    of: Vec<u32>,
    count: usize,
}

/// How one part is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Part {
    /// Half the diagonal of its box.
    pub(crate) radius: f64,
    /// Whether any node is fixed.
    pub(crate) has_fixed: bool,
    /// Whether its fixed nodes are fewer than four or lie in one plane.
    pub(crate) is_loose: bool,
}

/// How every part is held, at some positions.
#[derive(Clone, Debug)]
pub(crate) struct Looseness(Vec<Part>);

impl Looseness {
    pub(crate) fn of(&self, components: &Components, node: usize) -> Part {
        self.0[components.of[node] as usize]
    }
}

impl Components {
    pub(crate) fn new(rings: &Rings) -> Self {
        let mut of = vec![u32::MAX; rings.len()];
        let mut count = 0;
        let mut stack = Vec::new();
        for first in 0..rings.len() {
            if of[first] != u32::MAX {
                continue;
            }
            of[first] = count;
            stack.push(first);
            while let Some(node) = stack.pop() {
                for &far in rings.ring(node) {
                    if of[far as usize] == u32::MAX {
                        of[far as usize] = count;
                        stack.push(far as usize);
                    }
                }
            }
            count += 1;
        }
        Self { of, count: count as usize }
    }

    pub(crate) fn looseness(&self, positions: &[DVec3], fixed: &[bool]) -> Looseness {
        let mut low = vec![DVec3::INFINITY; self.count];
        let mut high = vec![DVec3::NEG_INFINITY; self.count];
        let mut spans = vec![Span::default(); self.count];
        for (&part, &position) in self.of.iter().zip(positions) {
            low[part as usize] = low[part as usize].min(position);
            high[part as usize] = high[part as usize].max(position);
        }
        let radius: Vec<f64> =
            low.iter().zip(&high).map(|(&low, &high)| 0.5 * (high - low).length()).collect();
        for ((&part, &position), _) in self.of.iter().zip(positions).zip(fixed).filter(|(_, fixed)| **fixed) {
            spans[part as usize].add(position, radius[part as usize]);
        }
        let parts = spans.iter().zip(radius);
        Looseness(
            parts
                .map(|(span, radius)| Part {
                    radius,
                    has_fixed: span.origin.is_some(),
                    is_loose: span.normal.is_none() || !span.is_solid,
                })
                .collect(),
        )
    }
}

/// The affine span of some points, grown one by one; thinner than 1e-3 of the part counts as flat.
#[derive(Clone, Copy, Debug, Default)]
struct Span {
    origin: Option<DVec3>,
    along: Option<DVec3>,
    normal: Option<DVec3>,
    is_solid: bool,
}

impl Span {
    fn add(&mut self, point: DVec3, radius: f64) {
        let thin = 1e-3 * radius;
        let Some(origin) = self.origin else {
            self.origin = Some(point);
            return;
        };
        let offset = point - origin;
        match (self.along, self.normal) {
            (None, _) if offset.length() > thin => self.along = offset.try_normalize(),
            (Some(along), None) if along.cross(offset).length() > thin => {
                self.normal = along.cross(offset).try_normalize();
            }
            (Some(_), Some(normal)) if normal.dot(offset).abs() > thin => self.is_solid = true,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workload;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn flat_and_few_constraints_are_loose() {
        let mut shape = workload::sphere(2);
        let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).unwrap();
        let components = Components::new(&rings);
        let free = components.looseness(&shape.positions, &shape.fixed).of(&components, 0);
        assert!(!free.has_fixed && free.is_loose);
        workload::pin_axes(&mut shape);
        let pinned = components.looseness(&shape.positions, &shape.fixed).of(&components, 0);
        assert!(pinned.has_fixed && !pinned.is_loose);
        let disc = workload::disc(3);
        let rings = Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap();
        let components = Components::new(&rings);
        assert!(components.looseness(&disc.positions, &disc.fixed).of(&components, 0).is_loose);
    }
}

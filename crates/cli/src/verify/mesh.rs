//! The mesh of a reference file: nodes, triangles, and what can be counted or summed over them.

use super::reader::{Fields, Flaw, recorded};
use super::report::{Report, Tolerance};
use ductile_solver::{Rings, Settings, SurfaceSolver};
use glam::DVec3;

/// A mesh whose rings are known to be discs and half-discs.
#[derive(Debug)]
pub(crate) struct Mesh {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) rings: Rings,
}

impl Mesh {
    /// The fields `vertices` and `triangles`.
    pub(crate) fn read(fields: &Fields<'_>) -> Result<Self, Flaw> {
        let vertices = fields.need("vertices")?;
        let positions: Vec<DVec3> =
            vertices.list()?.map(|vertex| vertex.vector()).collect::<Result<_, _>>()?;
        let item = fields.need("triangles")?;
        let mut triangles = Vec::new();
        for triangle in item.list()? {
            let corners = triangle.list()?;
            if corners.len() != 3 {
                return Err(triangle.flaw(format!("a triangle has 3 corners, not {}", corners.len())));
            }
            let mut nodes = [0_u32; 3];
            for (node, corner) in nodes.iter_mut().zip(corners) {
                let index = corner.index(positions.len(), "node")?;
                *node = u32::try_from(index).map_err(|_| corner.flaw("there are too many nodes"))?;
            }
            triangles.push(nodes);
        }
        if triangles.is_empty() {
            return Err(item.flaw("there are no triangles"));
        }
        let rings = Rings::from_triangles(positions.len(), &triangles)
            .map_err(|reason| item.flaw(reason.to_string()))?;
        Ok(Self { positions, triangles, rings })
    }

    /// A solver, fitted to the mesh as it stands.
    pub(crate) fn solver(&self, fixed: Vec<bool>, settings: Settings) -> Result<SurfaceSolver, String> {
        let solver = SurfaceSolver::new(self.rings.clone(), fixed, settings);
        let mut solver = solver.map_err(|reason| reason.to_string())?;
        solver.fit_all(&self.positions);
        Ok(solver)
    }

    /// Compares `nodes`, `triangle_count`, `degree_min` and `degree_max` where they are given.
    pub(crate) fn check_counts(&self, fields: &Fields<'_>, report: &mut Report) {
        let degrees = || (0..self.rings.len()).map(|node| self.rings.ring(node).len());
        let counts = [
            ("nodes", self.positions.len()),
            ("triangle_count", self.triangles.len()),
            ("degree_min", degrees().min().unwrap_or(0)),
            ("degree_max", degrees().max().unwrap_or(0)),
        ];
        for (name, found) in counts {
            let Some(item) = fields.get(name) else { continue };
            if let Some(count) = recorded(item.count(), report) {
                #[expect(clippy::cast_precision_loss, reason = "counts of a mesh in memory")]
                let [count, found] = [count, found].map(|count| count as f64);
                report.compare(name, &item.place, count, found, Tolerance::EXACT);
            }
        }
    }

    /// One third of the triangles at every node.
    pub(crate) fn areas(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.positions.len()];
        for &triangle in &self.triangles {
            let [a, b, c] = triangle.map(|node| self.positions[node as usize]);
            let third = (b - a).cross(c - a).length() / 6.0;
            triangle.iter().for_each(|&node| areas[node as usize] += third);
        }
        areas
    }

    /// Whether there is no boundary.
    pub(crate) fn is_closed(&self) -> bool {
        (0..self.rings.len()).all(|node| !self.rings.is_boundary(node))
    }

    /// Nodes minus edges plus triangles.
    pub(crate) fn euler_characteristic(&self) -> i64 {
        let spokes: usize = (0..self.rings.len()).map(|node| self.rings.ring(node).len()).sum();
        let count = |n: usize| i64::try_from(n).unwrap_or(i64::MAX);
        count(self.positions.len()) - count(spokes / 2) + count(self.triangles.len())
    }
}

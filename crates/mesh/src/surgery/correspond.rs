//! Correspondence: two rims that are to be glued are brought to the same number of vertices between source nodes that belong
//! together.
//!
//! Source: Welch 1995, §4.2.2: given a one to one correspondence of the source nodes of two boundary curves, each of the
//! stretches between them is brought into node to node correspondence by splitting edges.

use crate::{GlueError, Mesh, Seam, VertexId};

/// A new vertex, the ends of the edge it lies on, and its place between them, in [0, 1].
pub type OnEdge = (VertexId, [VertexId; 2], f64);

impl Seam {
    /// Parts both rims, which may have different numbers of vertices, at nodes that belong together: nodes `k` of both lists.
    /// Gives the stretches from each node to the next, both nodes included.
    ///
    /// The nodes stand in the order of their rims. Loops are parted from the first node on, or from their first vertices
    /// where no node is named; the ends of open rims belong together without being named.
    ///
    /// # Errors
    /// [`GlueError::UnlikeNodes`], [`GlueError::NotOnRim`], [`GlueError::Repeated`], [`GlueError::OutOfOrder`],
    /// [`GlueError::TooShort`].
    pub fn stretches(&self, nodes: [&[VertexId]; 2]) -> Result<Vec<[Vec<VertexId>; 2]>, GlueError> {
        let [kept, gone] = nodes;
        if kept.len() != gone.len() {
            return Err(GlueError::UnlikeNodes(kept.len(), gone.len()));
        }
        let (kept, gone) = (self.part(&self.kept, kept)?, self.part(&self.gone, gone)?);
        let both = kept.into_iter().zip(gone).map(|(kept, gone)| [kept, gone]);
        // Where ends of open rims are named as well, nothing lies between.
        let stretches: Vec<_> = both.filter(|both| both.iter().any(|stretch| stretch.len() > 1)).collect();
        match stretches.iter().flatten().find(|stretch| stretch.len() < 2) {
            Some(stretch) => Err(GlueError::TooShort(stretch.len())),
            None => Ok(stretches),
        }
    }

    /// One rim, parted at its nodes.
    fn part(&self, rim: &[VertexId], nodes: &[VertexId]) -> Result<Vec<Vec<VertexId>>, GlueError> {
        let (Some(first), Some(last)) = (rim.first(), rim.last()) else { return Err(GlueError::TooShort(0)) };
        let mut seen = nodes.to_vec();
        seen.sort_unstable();
        if let Some(twice) = seen.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(GlueError::Repeated(twice[0]));
        }
        let mut nodes = nodes.to_vec();
        if nodes.is_empty() || !self.is_closed {
            nodes.insert(0, *first);
        }
        if !self.is_closed {
            nodes.push(*last);
        }
        let place = |node: &VertexId| rim.iter().position(|v| v == node).ok_or(GlueError::NotOnRim(*node));
        let places = nodes.iter().map(place).collect::<Result<Vec<_>, _>>()?;
        let count = rim.len();
        let mut stretches = Vec::with_capacity(nodes.len());
        let mut passed = 0;
        for k in 0..if self.is_closed { nodes.len() } else { nodes.len() - 1 } {
            let next = (k + 1) % nodes.len();
            let steps = match (self.is_closed, nodes.len()) {
                (true, 1) => count,
                (true, _) => (places[next] + count - places[k]) % count,
                (false, _) => {
                    places[next].checked_sub(places[k]).ok_or(GlueError::OutOfOrder(nodes[next]))?
                }
            };
            passed += steps;
            if passed > count {
                return Err(GlueError::OutOfOrder(nodes[next]));
            }
            stretches.push((0..=steps).map(|step| rim[(places[k] + step) % count]).collect());
        }
        Ok(stretches)
    }
}

impl Mesh {
    /// Splits edges of two rims until the stretches between nodes that belong together have as many vertices on both; gives
    /// the new vertices. The seam holds them afterwards, vertex for vertex, and begins at the first nodes.
    ///
    /// ```
    /// use ductile_mesh::{Seam, boundary_loops, primitive, summary};
    /// let rim = |n: i32| (0..n).map(|i| glam::DVec3::new(f64::from(i), f64::from(i * i), 0.0)).collect::<Vec<_>>();
    /// let (mut mesh, _) = primitive::cylinder(&rim(5), &rim(8), 2)?;
    /// let [kept, mut gone] = boundary_loops(&mesh).try_into().expect("two ends");
    /// gone.reverse();
    /// // The second of the one belongs to the first of the other, and so on.
    /// let nodes = [vec![kept[1], kept[3], kept[4]], vec![gone[0], gone[1], gone[4]]];
    /// let mut seam = Seam { kept, gone, is_closed: true };
    /// mesh.correspond(&mut seam, [&nodes[0], &nodes[1]])?;
    /// mesh.make_room(&seam)?;
    /// mesh.glue(&seam);
    /// assert_eq!((summary(&mesh).euler, summary(&mesh).boundaries), (0, 0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// See [`Seam::stretches`] and [`Mesh::can_glue`]; mesh and seam are then untouched.
    pub fn correspond(&mut self, seam: &mut Seam, nodes: [&[VertexId]; 2]) -> Result<Vec<OnEdge>, GlueError> {
        let stretches = seam.stretches(nodes)?;
        for ends in stretches.iter().flatten().flat_map(|stretch| stretch.windows(2)) {
            self.rim_edge(ends[0], ends[1])?;
        }
        let mut trial = self.clone();
        let mut even = Seam { kept: Vec::new(), gone: Vec::new(), is_closed: seam.is_closed };
        let mut made = Vec::new();
        for [mut kept, mut gone] in stretches {
            let count = kept.len().max(gone.len());
            for (rim, stretch) in [(&mut even.kept, &mut kept), (&mut even.gone, &mut gone)] {
                made.extend(trial.even_out(stretch, count));
                // Its last node is the first of the next.
                rim.extend(stretch.iter().take(count - 1));
            }
        }
        if !seam.is_closed {
            even.kept.extend(seam.kept.last());
            even.gone.extend(seam.gone.last());
        }
        trial.check_rims(&even)?;
        (*self, *seam) = (trial, even);
        Ok(made)
    }
}

#[cfg(test)]
mod tests;

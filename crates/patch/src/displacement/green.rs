//! Harmonic functions of a surface: one factorisation, and for each foot one back-substitution.
//!
//! Source: the recipe, sections 4 and 6. With `A` the Laplacian of the free vertices, the discrete Green's function of a
//! foot `j` solves `A g = e_j`; it is 0 where vertices are held and in other parts. The paper's harmonic function is
//! `h = g / g(j)`, and `exp(-2 π g)` is the modulus of the conformal map to the disc that takes the foot to the centre.
//! All of these are dimensionless.

use super::domain::{Domain, NONE};
use super::error::DisplacementError;
use super::item::Item;
use super::laplacian::Stiffness;
use ductile_solver::SymmetricFactor;

/// Numbers for some of the vertices, in order.
#[derive(Clone, Debug)]
pub(super) struct Numbering {
    /// Per vertex its number, or `NONE`.
    pub(super) of: Vec<u32>,
    pub(super) count: usize,
}

impl Numbering {
    pub(super) fn new(counts: impl Iterator<Item = bool>) -> Self {
        let mut next = 0;
        let number = |is_counted: bool| {
            if !is_counted {
                return NONE;
            }
            next += 1;
            next - 1
        };
        let of = counts.map(number).collect();
        Self { of, count: next as usize }
    }

    pub(super) fn get(&self, vertex: usize) -> Option<usize> {
        (self.of[vertex] != NONE).then_some(self.of[vertex] as usize)
    }

    /// Numbers of the counted vertices carried to all, with this at the others.
    pub(super) fn spread(&self, values: &[f64], elsewhere: f64) -> Vec<f64> {
        (0..self.of.len()).map(|vertex| self.get(vertex).map_or(elsewhere, |n| values[n])).collect()
    }
}

/// The factorised Laplacian of the free vertices.
#[derive(Clone, Debug)]
pub(super) struct Green {
    pub(super) stiffness: Stiffness,
    numbering: Numbering,
    /// Per free vertex the least vertex of its part; free vertices are in one part when free edges join them.
    part: Vec<u32>,
    factor: SymmetricFactor,
}

impl Green {
    pub(super) fn new(domain: &Domain, stiffness: Stiffness) -> Result<Self, DisplacementError> {
        let (part, is_grounded) = parts(domain, &stiffness);
        let counts = (0..domain.len()).map(|v| part[v] != NONE && is_grounded[part[v] as usize]);
        let numbering = Numbering::new(counts);
        let factor = factorise(&stiffness, &numbering)?;
        Ok(Self { stiffness, numbering, part, factor })
    }

    /// The part of a vertex in which something can move, by its least vertex.
    pub(super) fn part(&self, vertex: usize) -> Result<u32, DisplacementError> {
        let count = self.part.len();
        match self.part.get(vertex) {
            None => Err(DisplacementError::NoVertex { vertex, count }),
            Some(&NONE) => Err(DisplacementError::Held(vertex)),
            Some(&part) if self.numbering.get(vertex).is_none() => {
                Err(DisplacementError::NoBoundary(part as usize))
            }
            Some(&part) => Ok(part),
        }
    }

    /// The part in which a foot can move, and which vertex of it can.
    pub(super) fn part_of(&self, item: &Item) -> Result<(u32, usize), DisplacementError> {
        let parts =
            item.load().filter(|(_, share)| *share > 0.0).map(|(v, _)| self.part(v).map(|part| (part, v)));
        let mut refusal = Err(DisplacementError::Held(item.vertices[0]));
        for part in parts {
            if part.is_ok() {
                return part;
            }
            refusal = part;
        }
        refusal
    }

    /// The discrete Green's function of a foot, at all vertices. What rests on held vertices is gone.
    pub(super) fn function(&mut self, item: &Item) -> Result<Vec<f64>, DisplacementError> {
        let (_, vertex) = self.part_of(item)?;
        let mut values = vec![0.0; self.numbering.count];
        for (vertex, share) in item.load() {
            if let Some(number) = self.numbering.get(vertex) {
                values[number] += share;
            }
        }
        self.factor.solve(&mut values);
        let green = self.numbering.spread(&values, 0.0);
        if green[vertex] > 0.0 && green.iter().all(|g| g.is_finite()) {
            Ok(green)
        } else {
            Err(DisplacementError::Unsolvable(vertex))
        }
    }

    /// The harmonic function that is 1 at these vertices, 0 where vertices are held and in other parts. It has its own
    /// factorisation: a curve is many vertices.
    pub(super) fn capacity(&self, vertices: &[usize]) -> Result<Vec<f64>, DisplacementError> {
        let mut is_one = vec![false; self.part.len()];
        for &vertex in vertices {
            self.part(vertex)?;
            is_one[vertex] = true;
        }
        let counts = (0..self.part.len()).map(|v| self.numbering.get(v).is_some() && !is_one[v]);
        let numbering = Numbering::new(counts);
        let mut values = vec![0.0; numbering.count];
        for &(a, b, weight) in &self.stiffness.weights {
            for [here, there] in [[a, b], [b, a]] {
                if let Some(number) = numbering.get(here as usize).filter(|_| is_one[there as usize]) {
                    values[number] += weight;
                }
            }
        }
        factorise(&self.stiffness, &numbering)?.solve(&mut values);
        let mut harmonic = numbering.spread(&values, 0.0);
        vertices.iter().for_each(|&vertex| harmonic[vertex] = 1.0);
        match harmonic.iter().position(|h| !h.is_finite()) {
            Some(vertex) => Err(DisplacementError::Unsolvable(vertex)),
            None => Ok(harmonic),
        }
    }
}

/// The parts of the free vertices, and for each its least vertex whether it touches a held one.
fn parts(domain: &Domain, stiffness: &Stiffness) -> (Vec<u32>, Vec<bool>) {
    let count = domain.len();
    let mut up: Vec<u32> = (0_u32..).take(count).collect();
    let mut is_used = vec![false; count];
    let root = |up: &mut [u32], mut v: u32| {
        while up[v as usize] != v {
            up[v as usize] = up[up[v as usize] as usize];
            v = up[v as usize];
        }
        v
    };
    for &(a, b, _) in &stiffness.weights {
        is_used[a as usize] = true;
        is_used[b as usize] = true;
        if !domain.held[a as usize] && !domain.held[b as usize] {
            let (a, b) = (root(&mut up, a), root(&mut up, b));
            up[a.max(b) as usize] = a.min(b);
        }
    }
    let is_free = |v: u32| is_used[v as usize] && !domain.held[v as usize];
    let part: Vec<u32> =
        (0_u32..).take(count).map(|v| if is_free(v) { root(&mut up, v) } else { NONE }).collect();
    let mut is_grounded = vec![false; count];
    for &(a, b, _) in &stiffness.weights {
        for [here, there] in [[a, b], [b, a]] {
            if part[here as usize] != NONE && domain.held[there as usize] {
                is_grounded[part[here as usize] as usize] = true;
            }
        }
    }
    (part, is_grounded)
}

/// The factor of the Laplacian's rows and columns of the numbered vertices.
fn factorise(stiffness: &Stiffness, numbering: &Numbering) -> Result<SymmetricFactor, DisplacementError> {
    let mut entries = Vec::with_capacity(2 * stiffness.weights.len());
    for &(a, b, weight) in &stiffness.weights {
        let (a, b) = (numbering.get(a as usize), numbering.get(b as usize));
        entries.extend([a, b].into_iter().flatten().map(|n| (n, n, weight)));
        if let (Some(a), Some(b)) = (a, b) {
            entries.push((a, b, -weight));
        }
    }
    let first = numbering.of.iter().position(|&number| number != NONE).unwrap_or(0);
    SymmetricFactor::new(numbering.count, &entries).map_err(|_| DisplacementError::Unsolvable(first))
}

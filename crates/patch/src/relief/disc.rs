//! Some triangles of a mesh that form a disc: vertices of their own, one winding, one rim.

use super::error::ReliefError;

/// No vertex.
const NONE: u32 = u32::MAX;

/// A disc of triangles.
#[derive(Clone, Debug)]
pub struct Disc {
    /// Of each vertex its number in the mesh, ascending.
    vertices: Vec<u32>,
    /// Corners by own numbers, all wound like the first.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The vertices of the rim by own numbers; the disc lies to its left.
    pub(super) rim: Vec<u32>,
}

/// A side of a triangle.
#[derive(Clone, Copy, Debug)]
struct Side {
    low: u32,
    high: u32,
    triangle: usize,
    /// Whether the triangle runs from the lower to the higher vertex.
    rises: bool,
}

impl Disc {
    /// Takes triangles of a mesh with `count` vertices. Windings may disagree; that of the first counts.
    ///
    /// # Errors
    /// [`ReliefError`] if they are no disc.
    pub fn new(count: usize, triangles: &[[u32; 3]]) -> Result<Self, ReliefError> {
        let mut own = vec![NONE; count];
        for &corner in triangles.as_flattened() {
            *own.get_mut(corner as usize).ok_or(ReliefError::Empty)? = 0;
        }
        let mut vertices = Vec::new();
        for (vertex, own) in (0..).zip(&mut own).filter(|(_, own)| **own != NONE) {
            *own = number(vertices.len());
            vertices.push(vertex);
        }
        let mut triangles: Vec<[u32; 3]> =
            triangles.iter().map(|corners| corners.map(|v| own[v as usize])).collect();
        let sides = sides(&triangles)?;
        wind(&mut triangles, &sides)?;
        let rims = rims(&triangles, &sides, vertices.len())?;
        let edges = sides.len() - sides.windows(2).filter(|pair| is_same(&pair[0], &pair[1])).count();
        let euler = signed(vertices.len()) - signed(edges) + signed(triangles.len());
        match <[Vec<u32>; 1]>::try_from(rims) {
            Ok([rim]) if euler == 1 => Ok(Self { vertices, triangles, rim }),
            Ok(_) => Err(ReliefError::NoDisc { rims: 1, handles: handles(1, euler) }),
            Err(rims) if rims.is_empty() => Err(ReliefError::Closed),
            Err(rims) => Err(ReliefError::NoDisc { rims: rims.len(), handles: handles(rims.len(), euler) }),
        }
    }

    /// Numbers of its vertices in the mesh, ascending.
    #[must_use]
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// The vertices of its rim in the mesh, in order; the disc lies to their left.
    pub fn rim(&self) -> impl Iterator<Item = u32> + '_ {
        self.rim.iter().map(|&own| self.vertices[own as usize])
    }

    /// Those of some values of the mesh that belong to its vertices.
    pub(super) fn own<T: Copy>(&self, all: &[T]) -> Vec<T> {
        self.vertices.iter().map(|&v| all[v as usize]).collect()
    }
}

/// All sides, those of an edge beside one another.
fn sides(triangles: &[[u32; 3]]) -> Result<Vec<Side>, ReliefError> {
    let mut sides = Vec::with_capacity(3 * triangles.len());
    for (triangle, &[a, b, c]) in triangles.iter().enumerate() {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            sides.push(Side { low: from.min(to), high: from.max(to), triangle, rises: from < to });
        }
    }
    sides.sort_by_key(|side| (side.low, side.high, side.triangle));
    let is_crowded = sides.windows(3).any(|three| is_same(&three[0], &three[2]));
    if is_crowded || sides.iter().any(|side| side.low == side.high) {
        return Err(ReliefError::Pinched);
    }
    if sides.is_empty() { Err(ReliefError::Empty) } else { Ok(sides) }
}

fn is_same(a: &Side, b: &Side) -> bool {
    (a.low, a.high) == (b.low, b.high)
}

/// Winds all triangles like the first.
fn wind(triangles: &mut [[u32; 3]], sides: &[Side]) -> Result<(), ReliefError> {
    let mut beside: Vec<Vec<(usize, bool)>> = vec![Vec::new(); triangles.len()];
    for pair in sides.windows(2).filter(|pair| is_same(&pair[0], &pair[1])) {
        let agree = pair[0].rises != pair[1].rises;
        beside[pair[0].triangle].push((pair[1].triangle, agree));
        beside[pair[1].triangle].push((pair[0].triangle, agree));
    }
    let mut kept: Vec<Option<bool>> = vec![None; triangles.len()];
    let mut pieces = 0;
    let mut open = Vec::new();
    for first in 0..triangles.len() {
        if kept[first].is_some() {
            continue;
        }
        pieces += 1;
        kept[first] = Some(true);
        open.push((first, true));
        while let Some((triangle, own)) = open.pop() {
            for &(other, agree) in &beside[triangle] {
                let wanted = own == agree;
                match kept[other] {
                    None => {
                        kept[other] = Some(wanted);
                        open.push((other, wanted));
                    }
                    Some(is) if is != wanted => return Err(ReliefError::OneSided),
                    Some(_) => {}
                }
            }
        }
    }
    if pieces != 1 {
        return Err(ReliefError::Pieces(pieces));
    }
    for (triangle, _) in triangles.iter_mut().zip(kept).filter(|(_, kept)| *kept == Some(false)) {
        triangle.swap(1, 2);
    }
    Ok(())
}

/// The closed lines of edges with one triangle, each along its triangles.
fn rims(triangles: &[[u32; 3]], sides: &[Side], count: usize) -> Result<Vec<Vec<u32>>, ReliefError> {
    let mut next = vec![NONE; count];
    for (k, side) in sides.iter().enumerate() {
        let before = k.checked_sub(1).is_some_and(|k| is_same(&sides[k], side));
        if before || sides.get(k + 1).is_some_and(|other| is_same(other, side)) {
            continue;
        }
        let [a, b, c] = triangles[side.triangle];
        let ends = [[a, b], [b, c], [c, a]];
        let Some([from, to]) =
            ends.into_iter().find(|[x, y]| (*x.min(y), *x.max(y)) == (side.low, side.high))
        else {
            continue;
        };
        if next[from as usize] != NONE {
            return Err(ReliefError::Pinched);
        }
        next[from as usize] = to;
    }
    let mut rims = Vec::new();
    for start in 0..count {
        let mut rim = Vec::new();
        let mut at = number(start);
        while next[at as usize] != NONE {
            rim.push(at);
            at = std::mem::replace(&mut next[at as usize], NONE);
        }
        if !rim.is_empty() {
            rims.push(rim);
        }
    }
    Ok(rims)
}

/// How many handles make an Euler characteristic, with so many rims.
fn handles(rims: usize, euler: isize) -> usize {
    usize::try_from((2 - signed(rims) - euler) / 2).unwrap_or(0)
}

fn signed(count: usize) -> isize {
    isize::try_from(count).unwrap_or(isize::MAX)
}

fn number(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(NONE)
}

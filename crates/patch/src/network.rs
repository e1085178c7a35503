//! Networks of curves that meet at nodes: which loops bound the faces of the surface that they suggest.
//!
//! A network in space has no faces of its own. They come from an order of the edges around each node (a rotation system; J. Gross,
//! T. Tucker, *Topological Graph Theory*, 1987, chapter 3): the directions in which the edges leave a node nearly lie on a plane, or on a cone
//! as at the corner of a box, and around its axis they have an order. Axes of neighbours are given the same sense by carrying
//! one along the edge between them. A loop that always turns as far to the left as possible is then a face, unless it runs
//! round the outside of an open network: that one turns the other way about its axes.

use glam::{DMat3, DVec3};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// A curve between two nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct NetworkEdge {
    /// The nodes where it begins and ends, from 0; they may be one.
    pub ends: [usize; 2],
    /// Places along it, from the one end to the other: at least two.
    pub along: Vec<DVec3>,
}

/// An edge of a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Directed {
    /// Which edge, from 0.
    pub edge: usize,
    /// Whether the loop runs from its end to its beginning.
    pub back: bool,
}

/// The least share of its area that a face turns to the side of its axes. The rim of a dome sees no side, and may stay open.
const LEAST_LEAN: f64 = 0.15;
/// Rounds of inverse iteration for the axis of a node.
const ROUNDS: usize = 24;

impl NetworkEdge {
    fn length(&self) -> f64 {
        self.along.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    }

    /// Its places in the direction of a loop.
    fn places(&self, back: bool) -> Box<dyn Iterator<Item = DVec3> + '_> {
        if back { Box::new(self.along.iter().rev().copied()) } else { Box::new(self.along.iter().copied()) }
    }

    /// The direction in which it leaves one of its ends.
    fn leaves(&self, end: usize) -> DVec3 {
        let mut places = self.places(end == 1);
        let first = places.next().unwrap_or_default();
        places.map(|place| place - first).find_map(DVec3::try_normalize).unwrap_or_default()
    }
}

/// The edges at each node, as (edge, end), without those that lead to a dead end.
fn spokes(edges: &[NetworkEdge]) -> BTreeMap<usize, Vec<(usize, usize)>> {
    let mut spokes: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
    for (at, edge) in edges.iter().enumerate() {
        for (end, node) in edge.ends.iter().enumerate() {
            spokes.entry(*node).or_default().push((at, end));
        }
    }
    while let Some((&node, &(dead, _))) =
        spokes.iter().find_map(|(node, around)| (around.len() == 1).then(|| (node, &around[0])))
    {
        spokes.remove(&node);
        spokes.values_mut().for_each(|around| around.retain(|(edge, _)| *edge != dead));
        spokes.retain(|_, around| !around.is_empty());
    }
    spokes
}

/// The loops that bound the faces of a network, each with its face on the left as seen from one side of the network. Edges that
/// lead nowhere, loops that run along an edge twice, and the outside of an open network bound none.
#[must_use]
pub fn network_faces(edges: &[NetworkEdge]) -> Vec<Vec<Directed>> {
    let spokes = spokes(edges);
    let axes = axes(edges, &spokes);
    let around: BTreeMap<usize, Vec<(usize, usize)>> = spokes
        .iter()
        .map(|(node, spokes)| (*node, ordered(edges, spokes, axes.get(node).copied().unwrap_or_default())))
        .collect();
    let mut done: BTreeSet<Directed> = BTreeSet::new();
    let mut faces = Vec::new();
    for &(edge, end) in spokes.values().flatten() {
        let first = Directed { edge, back: end == 1 };
        if done.contains(&first) {
            continue;
        }
        let mut face = Vec::new();
        let mut now = first;
        while done.insert(now) {
            face.push(now);
            let arrived = usize::from(!now.back);
            let node = edges[now.edge].ends[arrived];
            let Some(around) = around.get(&node) else { break };
            let Some(place) = around.iter().position(|spoke| *spoke == (now.edge, arrived)) else { break };
            // As far to the left as possible is the next one clockwise from where it came.
            let (edge, end) = around[(place + around.len() - 1) % around.len()];
            now = Directed { edge, back: end == 1 };
        }
        if is_face(edges, &spokes, &axes, &face) {
            faces.push(face);
        }
    }
    faces.sort();
    faces
}

fn is_face(
    edges: &[NetworkEdge],
    spokes: &BTreeMap<usize, Vec<(usize, usize)>>,
    axes: &BTreeMap<usize, DVec3>,
    face: &[Directed],
) -> bool {
    if face.iter().map(|step| step.edge).collect::<BTreeSet<_>>().len() < face.len() {
        return false;
    }
    let nodes = face.iter().map(|step| edges[step.edge].ends[usize::from(step.back)]);
    let nodes: Vec<usize> = nodes.collect();
    if nodes.iter().all(|node| spokes.get(node).is_some_and(|around| around.len() == 2)) {
        // A ring by itself is met from both sides, and is one face.
        return face.iter().min().is_some_and(|step| !step.back);
    }
    let area = area(edges, face);
    let lean: DVec3 = nodes.iter().filter_map(|node| axes.get(node)).sum::<DVec3>() / nodes.len() as f64;
    area.dot(lean) > LEAST_LEAN * area.length()
}

/// Twice the vector area inside a loop.
fn area(edges: &[NetworkEdge], face: &[Directed]) -> DVec3 {
    let places: Vec<DVec3> = face.iter().flat_map(|step| edges[step.edge].places(step.back)).collect();
    let origin = places.first().copied().unwrap_or_default();
    places.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin)).sum()
}

/// The edges at a node, counter-clockwise about its axis.
fn ordered(edges: &[NetworkEdge], spokes: &[(usize, usize)], axis: DVec3) -> Vec<(usize, usize)> {
    let Some(axis) = axis.try_normalize() else { return spokes.to_vec() };
    let (x, y) = axis.any_orthonormal_pair();
    let mut by_angle: Vec<(f64, (usize, usize))> = spokes
        .iter()
        .map(|&(edge, end)| {
            let leaves = edges[edge].leaves(end);
            (libm::atan2(leaves.dot(y), leaves.dot(x)), (edge, end))
        })
        .collect();
    by_angle.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    by_angle.into_iter().map(|(_, spoke)| spoke).collect()
}

/// The axis of every node, neighbours in the same sense as far as that can be.
fn axes(edges: &[NetworkEdge], spokes: &BTreeMap<usize, Vec<(usize, usize)>>) -> BTreeMap<usize, DVec3> {
    let mut axes: BTreeMap<usize, DVec3> = BTreeMap::new();
    let mut starts: Vec<usize> = spokes.keys().copied().collect();
    starts.sort_by_key(|node| (core::cmp::Reverse(spokes[node].len()), *node));
    for start in starts {
        if axes.contains_key(&start) {
            continue;
        }
        axes.insert(start, own_axis(edges, &spokes[&start]).unwrap_or(DVec3::ZERO));
        let mut queue = VecDeque::from([start]);
        while let Some(node) = queue.pop_front() {
            for &(edge, end) in &spokes[&node] {
                let there = edges[edge].ends[1 - end];
                if axes.contains_key(&there) {
                    continue;
                }
                let carried = carried(&edges[edge], end == 1, axes[&node]);
                let own = own_axis(edges, &spokes[&there]);
                axes.insert(
                    there,
                    own.map_or(carried, |own| if own.dot(carried) < 0.0 { -own } else { own }),
                );
                queue.push_back(there);
            }
        }
    }
    axes
}

/// The normal of the plane nearest to the tips of the unit vectors in which edges leave a node; none for less than three.
fn own_axis(edges: &[NetworkEdge], spokes: &[(usize, usize)]) -> Option<DVec3> {
    if spokes.len() < 3 {
        return None;
    }
    let leaves = spokes.iter().map(|&(edge, end)| edges[edge].leaves(end));
    plane_normal(&leaves.collect::<Vec<_>>())
}

/// The unit normal of the plane nearest to places, in the sense of least squares; none if there is no place.
fn plane_normal(places: &[DVec3]) -> Option<DVec3> {
    let mean = places.iter().sum::<DVec3>() / places.len().max(1) as f64;
    let mut moments = DMat3::ZERO;
    for place in places {
        let off = *place - mean;
        moments += DMat3::from_cols(off * off.x, off * off.y, off * off.z);
    }
    // Shifted, so that an exact plane has an inverse, too.
    let trace = moments.x_axis.x + moments.y_axis.y + moments.z_axis.z;
    let inverse = (moments + DMat3::from_diagonal(DVec3::splat(1e-9 * trace))).inverse();
    let columns = [inverse.x_axis, inverse.y_axis, inverse.z_axis];
    let longest = columns.into_iter().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?;
    let mut normal = longest.try_normalize()?;
    for _ in 0..ROUNDS {
        normal = (inverse * normal).try_normalize()?;
    }
    Some(normal)
}

/// An axis carried along an edge without turning about it.
fn carried(edge: &NetworkEdge, back: bool, axis: DVec3) -> DVec3 {
    let places: Vec<DVec3> = edge.places(back).collect();
    let mut axis = axis;
    for pair in places.windows(2) {
        if let Some(along) = (pair[1] - pair[0]).try_normalize() {
            axis = (axis - along * along.dot(axis)).try_normalize().unwrap_or(axis);
        }
    }
    axis
}

/// The unit normal of the plane that directions at a node lie in, as nearly as they do, and the sine of the largest angle of one
/// to it; none if there is no such plane.
#[must_use]
pub fn plane_of_directions(directions: &[DVec3]) -> Option<(DVec3, f64)> {
    let units: Vec<DVec3> = directions.iter().filter_map(|v| v.try_normalize()).collect();
    // With the opposite of each the plane passes through the origin.
    let both: Vec<DVec3> = units.iter().flat_map(|v| [*v, -*v]).collect();
    let normal = plane_normal(&both)?;
    let off = units.iter().map(|v| v.dot(normal).abs()).fold(0.0, f64::max);
    Some((normal, off))
}

/// For each way to go on from the end of an edge the shortest loop back to its beginning, the shortest of all first. A loop passes
/// no node twice, and begins with that edge in its own direction.
#[must_use]
pub fn loops_through(edges: &[NetworkEdge], edge: usize) -> Vec<Vec<Directed>> {
    let Some(own) = edges.get(edge) else { return Vec::new() };
    let (from, to) = (own.ends[0], own.ends[1]);
    let first = Directed { edge, back: false };
    if from == to {
        return vec![vec![first]];
    }
    let spokes = spokes(edges);
    let lengths: Vec<f64> = edges.iter().map(NetworkEdge::length).collect();
    let mut found: Vec<(f64, Vec<Directed>)> = Vec::new();
    for &(next, end) in spokes.get(&to).into_iter().flatten().filter(|(next, _)| *next != edge) {
        let step = Directed { edge: next, back: end == 1 };
        let there = edges[next].ends[1 - end];
        if there == to {
            continue;
        }
        let Some((length, way)) = shortest(edges, &spokes, &lengths, there, from, to) else { continue };
        let whole: Vec<Directed> = [first, step].into_iter().chain(way).collect();
        found.push((lengths[edge] + lengths[next] + length, whole));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1)));
    found.into_iter().map(|(_, way)| way).collect()
}

/// The shortest way between two nodes that keeps off a third (E. Dijkstra, 1959), and its length.
fn shortest(
    edges: &[NetworkEdge],
    spokes: &BTreeMap<usize, Vec<(usize, usize)>>,
    lengths: &[f64],
    from: usize,
    to: usize,
    shunned: usize,
) -> Option<(f64, Vec<Directed>)> {
    let mut reached: BTreeMap<usize, (f64, Option<(usize, Directed)>)> = [(from, (0.0, None))].into();
    let mut done: BTreeSet<usize> = [shunned].into();
    loop {
        let open = reached.iter().filter(|(node, _)| !done.contains(node));
        let (&node, &(length, _)) = open.min_by(|a, b| a.1.0.total_cmp(&b.1.0).then(a.0.cmp(b.0)))?;
        if node == to {
            let (mut way, mut at) = (Vec::new(), node);
            while let Some((_, Some((before, step)))) = reached.get(&at) {
                way.push(*step);
                at = *before;
            }
            way.reverse();
            return Some((length, way));
        }
        done.insert(node);
        for &(edge, end) in spokes.get(&node).into_iter().flatten() {
            let there = edges[edge].ends[1 - end];
            let longer = length + lengths[edge];
            if !done.contains(&there) && reached.get(&there).is_none_or(|(known, _)| longer < *known) {
                let step = Directed { edge, back: end == 1 };
                reached.insert(there, (longer, Some((node, step))));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn straight(places: &[DVec3], pairs: &[[usize; 2]]) -> Vec<NetworkEdge> {
        let edge = |ends: &[usize; 2]| NetworkEdge {
            ends: *ends,
            along: (0..=8).map(|k| places[ends[0]].lerp(places[ends[1]], f64::from(k) / 8.0)).collect(),
        };
        pairs.iter().map(edge).collect()
    }

    fn cube() -> Vec<NetworkEdge> {
        let places: Vec<DVec3> = (0..8_u8)
            .map(|k| [1, 2, 4].map(|bit| f64::from(u8::from(k & bit != 0))))
            .map(DVec3::from)
            .collect();
        let pairs: Vec<[usize; 2]> = (0..8)
            .flat_map(|k: usize| [1, 2, 4].map(move |bit| [k, k | bit]))
            .filter(|[a, b]| a != b)
            .collect();
        straight(&places, &pairs)
    }

    /// A net of 2 x 2 squares on a saddle, with a spike that leads nowhere.
    fn net() -> Vec<NetworkEdge> {
        let place = |k: usize| {
            let (x, y) = ((k % 3) as f64, (k / 3) as f64);
            DVec3::new(x, y, 0.2 * (x - 1.0) * (y - 1.0))
        };
        let mut places: Vec<DVec3> = (0..9).map(place).collect();
        places.push(DVec3::new(3.0, 3.0, 0.0));
        let across = (0..9).filter(|k| k % 3 < 2).map(|k| [k, k + 1]);
        let up = (0..6).map(|k| [k, k + 3]);
        straight(&places, &across.chain(up).chain([[8, 9]]).collect::<Vec<_>>())
    }

    #[test]
    fn a_cube_has_six_faces_that_wind_alike() {
        let edges = cube();
        let faces = network_faces(&edges);
        assert_eq!(faces.iter().map(Vec::len).collect::<Vec<_>>(), [4; 6]);
        // Every edge is run through once in each direction.
        let steps: BTreeSet<Directed> = faces.iter().flatten().copied().collect();
        assert_eq!(steps.len(), 24);
    }

    #[test]
    fn an_open_net_has_no_face_outside_and_a_spike_bounds_nothing() {
        let faces = network_faces(&net());
        assert_eq!(faces.iter().map(Vec::len).collect::<Vec<_>>(), [4; 4]);
        assert!(faces.iter().flatten().all(|step| step.edge != 12));
        let areas: Vec<f64> = faces.iter().map(|face| area(&net(), face).z).collect();
        assert!(areas.iter().all(|a| a.signum() == areas[0].signum()), "{areas:?}");
    }

    #[test]
    fn a_dome_keeps_its_rim_open() {
        // Four meridians of a hemisphere down to its equator, in four parts.
        let at = |turn: usize, up: f64| {
            let (sin, cos) = libm::sincos(turn as f64 * core::f64::consts::FRAC_PI_2);
            DVec3::new(cos * (1.0 - up * up).sqrt(), sin * (1.0 - up * up).sqrt(), up)
        };
        let meridian = |turn: usize| NetworkEdge {
            ends: [turn, 4],
            along: (0..=16)
                .map(|k| f64::from(k) / 16.0 * core::f64::consts::FRAC_PI_2)
                .map(|a| at(turn, libm::sin(a)))
                .collect(),
        };
        let equator = |turn: usize| NetworkEdge {
            ends: [turn, (turn + 1) % 4],
            along: (0..=16)
                .map(|k| (turn as f64 + f64::from(k) / 16.0) * core::f64::consts::FRAC_PI_2)
                .map(|a| DVec3::new(libm::cos(a), libm::sin(a), 0.0))
                .collect(),
        };
        let edges: Vec<NetworkEdge> = (0..4).map(meridian).chain((0..4).map(equator)).collect();
        assert_eq!(network_faces(&edges).iter().map(Vec::len).collect::<Vec<_>>(), [3; 4]);
    }

    #[test]
    fn a_ring_by_itself_is_one_face() {
        let places: Vec<DVec3> =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.2], [1.0, 1.0, 0.0], [0.0, 1.0, 0.3]].map(DVec3::from).to_vec();
        let faces = network_faces(&straight(&places, &[[0, 1], [1, 2], [2, 3], [3, 0]]));
        assert_eq!(faces.len(), 1);
        assert_eq!(faces[0].len(), 4);
    }

    #[test]
    fn loops_through_an_edge_begin_with_the_shortest() {
        let edges = cube();
        let loops = loops_through(&edges, 0);
        assert_eq!(loops.iter().map(Vec::len).collect::<Vec<_>>(), [4, 4]);
        for found in &loops {
            assert_eq!(found[0], Directed { edge: 0, back: false });
            for (k, step) in found.iter().enumerate() {
                let next = found[(k + 1) % found.len()];
                let end = edges[step.edge].ends[usize::from(!step.back)];
                assert_eq!(end, edges[next.edge].ends[usize::from(next.back)]);
            }
        }
        assert!(loops_through(&net(), 12).is_empty(), "a spike lies on no loop");
        assert!(loops_through(&edges, 99).is_empty());
    }

    #[test]
    fn directions_that_nearly_lie_in_a_plane_have_one() {
        let (normal, off) =
            plane_of_directions(&[DVec3::X * 3.0, DVec3::new(1.0, 1.0, 0.1), -DVec3::Y]).unwrap();
        assert!(normal.z.abs() > 0.99 && off > 0.01 && off < 0.1, "{normal} {off}");
        let (normal, off) = plane_of_directions(&[DVec3::X, DVec3::Y]).unwrap();
        assert!((normal.z.abs() - 1.0).abs() < 1e-9 && off < 1e-9);
        assert!(plane_of_directions(&[]).is_none());
    }
}

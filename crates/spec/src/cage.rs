//! A cage surface: an exact surface through the vertices of a polygon mesh, its *cage* (P. Salvi, *Polyhedral design with
//! blended n-sided interpolants*). The vertices of the cage are control points of the document.

use crate::id::PointId;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Most steps along an edge of a quad that a document may ask for.
pub const MAX_CAGE_RESOLUTION: u32 = 64;
/// Largest order of a Hermite blend.
pub const MAX_HERMITE: u32 = 24;
/// Largest exponent of a bump.
pub const MAX_BUMP: u32 = 8;

/// Steps along an edge of a quad where a cage does not say: as many as give about [`WANTED_SAMPLES`], within these.
const STEPS: std::ops::RangeInclusive<u32> = 2..=16;
/// Vertices of a tessellation that suit a picture.
const WANTED_SAMPLES: usize = 20_000;

/// A surface over a cage.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cage {
    /// The corners of its faces, at least three each, counter-clockwise seen from outside.
    pub faces: Vec<Vec<PointId>>,
    /// How the surface is made.
    #[serde(default, skip_serializing_if = "CageSettings::is_default")]
    pub settings: CageSettings,
}

/// How a surface over a cage is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CageSettings {
    /// How faces become quads; left open: not at all where all are quads, else by `offset`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub split: Option<CageSplit>,
    /// From the square to the local surfaces of vertices that have not four faces.
    #[serde(default, skip_serializing_if = "is_default")]
    pub map: CageMap,
    /// How the weight of a vertex fades.
    #[serde(default, skip_serializing_if = "is_default")]
    pub blend: CageBlend,
    /// What completes the rings of vertices at a boundary.
    #[serde(default, skip_serializing_if = "is_default")]
    pub boundary: CageBoundary,
    /// Steps along every edge of a quad, 1 to 64; left open: what suits the number of faces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resolution: Option<u32>,
}

/// An edge of the rim of a cage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RimEdge {
    /// The vertex where it ends.
    pub to: PointId,
    /// The only face that has it, from 0.
    pub face: usize,
    /// The corner of that face where it begins, from 0.
    pub corner: usize,
    /// Whether the rim of the surface turns where it begins: a single face meets there.
    pub turns: bool,
}

/// How the faces of a cage become quads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CageSplit {
    /// They are quads.
    None,
    /// At their middles: the surface stays near the polyhedron.
    Linear,
    /// Rounder, and through the vertices all the same.
    Offset,
    /// The roundest, but the surface misses the vertices of the cage.
    CatmullClark,
}

/// From the square to the local surface of an irregular vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CageMap {
    /// A closed form: curvature is continuous.
    #[default]
    Smooth,
    /// The paper's: tangent planes are continuous.
    Rational,
}

/// How the weight of a vertex fades along the edges of its quads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CageBlend {
    /// A polynomial whose derivatives up to this order, 1 to 24, vanish at both ends.
    Hermite(u32),
    /// Infinitely flat at both ends, with this exponent, 1 to 8.
    Bump(u32),
    /// The expo-rational blend, infinitely flat at both ends.
    Erbs,
}

impl Default for CageBlend {
    fn default() -> Self {
        Self::Hermite(2)
    }
}

/// What completes the ring of a vertex at a boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CageBoundary {
    /// The ring is mirrored at the boundary.
    #[default]
    Linear,
    /// The surface of the neighbour inside is continued, where it has four faces.
    Borrow,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl CageSettings {
    fn is_default(&self) -> bool {
        is_default(self)
    }
}

impl Cage {
    /// A cage with these faces, made as usual.
    #[must_use]
    pub fn new(faces: Vec<Vec<PointId>>) -> Self {
        Self { faces, settings: CageSettings::default() }
    }

    /// Its vertices, each once, in order of identity.
    #[must_use]
    pub fn points(&self) -> BTreeSet<PointId> {
        self.faces.iter().flatten().copied().collect()
    }

    /// Its edges, each once, by their ends in ascending order.
    #[must_use]
    pub fn edges(&self) -> BTreeSet<[PointId; 2]> {
        let of_face = |face: &Vec<PointId>| {
            let next = face.iter().cycle().skip(1);
            face.iter().zip(next).map(|(a, b)| [*a.min(b), *a.max(b)]).collect::<Vec<_>>()
        };
        self.faces.iter().flat_map(of_face).collect()
    }

    /// The edges at which it ends, by the vertex where each begins, with the cage on their left.
    #[must_use]
    pub fn rim(&self) -> BTreeMap<PointId, RimEdge> {
        let mut faces: BTreeMap<[PointId; 2], usize> = BTreeMap::new();
        let corners =
            |face: &Vec<PointId>| (0..face.len()).map(|k| [face[k], face[(k + 1) % face.len()]]).collect();
        let sides: Vec<Vec<[PointId; 2]>> = self.faces.iter().map(corners).collect();
        for [a, b] in sides.iter().flatten() {
            *faces.entry([*a.min(b), *a.max(b)]).or_default() += 1;
        }
        let mut at: BTreeMap<PointId, usize> = BTreeMap::new();
        self.faces.iter().flatten().for_each(|point| *at.entry(*point).or_default() += 1);
        let mut rim = BTreeMap::new();
        for (face, sides) in sides.iter().enumerate() {
            for (corner, [from, to]) in sides.iter().enumerate() {
                if faces.get(&[*from.min(to), *from.max(to)]) == Some(&1) {
                    let turns = at.get(from) == Some(&1);
                    rim.insert(*from, RimEdge { to: *to, face, corner, turns });
                }
            }
        }
        rim
    }

    /// An edge at which it ends, by its ends in either order: in the sense in which it has the cage on its left.
    #[must_use]
    pub fn rim_edge(&self, [a, b]: [PointId; 2]) -> Option<[PointId; 2]> {
        let rim = self.rim();
        let is_edge = |[from, to]: &[PointId; 2]| rim.get(from).is_some_and(|edge| edge.to == *to);
        [[a, b], [b, a]].into_iter().find(is_edge)
    }

    /// The vertices along the stretch of its rim that has the edge which begins at one, and whether it closes: all round, or from
    /// where the rim turns to where it turns next.
    #[must_use]
    pub fn rim_stretch(&self, from: PointId) -> (Vec<PointId>, bool) {
        let rim = self.rim();
        let before: BTreeMap<PointId, PointId> = rim.iter().map(|(from, edge)| (edge.to, *from)).collect();
        let turns = |point: PointId| rim.get(&point).is_none_or(|edge| edge.turns);
        let mut first = from;
        for _ in 0..rim.len() {
            match before.get(&first) {
                Some(point) if *point != from && !turns(first) => first = *point,
                _ => break,
            }
        }
        let closes = !turns(first);
        if closes {
            first = from;
        }
        let (mut through, mut at) = (vec![first], first);
        while let Some(edge) = rim.get(&at) {
            at = edge.to;
            if closes && at == first {
                break;
            }
            through.push(at);
            if turns(at) || through.len() > rim.len() {
                break;
            }
        }
        (through, closes)
    }

    /// What of the stretch of its rim with an edge, as [`Self::rim_edge`] gives it, lies between two vertices and has that edge.
    #[must_use]
    pub fn rim_between(&self, edge: [PointId; 2], between: [PointId; 2]) -> Option<Vec<PointId>> {
        let (all, closed) = self.rim_stretch(edge[0]);
        let count = all.len();
        let place = |point: PointId| all.iter().position(|other| *other == point);
        let [a, b] = [place(between[0])?, place(between[1])?];
        let run = |first: usize, last: usize| -> Option<Vec<PointId>> {
            let steps = if last > first {
                last - first
            } else if closed && first != last {
                last + count - first
            } else {
                return None;
            };
            let run: Vec<PointId> = (0..=steps).map(|step| all[(first + step) % count]).collect();
            run.windows(2).any(|pair| pair == edge).then_some(run)
        };
        run(a, b).or_else(|| run(b, a))
    }

    /// How its faces become quads.
    #[must_use]
    pub fn split(&self) -> CageSplit {
        let has_quads_only = self.faces.iter().all(|face| face.len() == 4);
        // Of those that keep the vertices the rounder one: an icosahedron's radius varies by 1.7 % instead of 6.5 %.
        let suited = if has_quads_only { CageSplit::None } else { CageSplit::Offset };
        self.settings.split.unwrap_or(suited)
    }

    /// The face of which each quad is a part: the face itself, or one quad for each corner of it.
    pub fn face_of_quads(&self) -> impl Iterator<Item = usize> + '_ {
        let is_whole = self.split() == CageSplit::None;
        let parts = move |face: &Vec<PointId>| if is_whole { 1 } else { face.len() };
        self.faces.iter().enumerate().flat_map(move |(number, face)| std::iter::repeat_n(number, parts(face)))
    }

    /// Steps along every edge of a quad.
    #[must_use]
    pub fn resolution(&self) -> u32 {
        let quads = self.face_of_quads().count();
        let suits = |steps: &u32| quads.saturating_mul((*steps as usize).pow(2)) <= WANTED_SAMPLES;
        self.settings.resolution.unwrap_or_else(|| STEPS.rev().find(suits).unwrap_or(*STEPS.start()))
    }

    /// About how many vertices its tessellation has.
    pub(crate) fn samples(&self) -> usize {
        self.face_of_quads().count().saturating_mul((self.resolution() as usize).saturating_pow(2))
    }
}

//! Acts of surgery by chance, aimed at what is there: sensible ones, doubtful ones, and now and then some that cannot be done.

use ductile_mesh::measure::face_normal;
use ductile_modeler::{Model, SurfaceShape};
use ductile_spec::{
    Blending, Border, Combination, CurveId, Displacement, Edit, Extent, Hold, JoinRibbon, Leave, Objective,
    ObjectiveOf, On, PointId, Request, SpacingOf, Step, SurfaceId, Through,
};
use glam::DVec3;

/// Numbers to choose by: from a fixed stream, or as somebody's bytes have them.
#[derive(Clone, Debug)]
pub struct Dice(Source);

#[derive(Clone, Debug)]
enum Source {
    /// splitmix64.
    Stream(u64),
    /// As few bytes as a number needs, so that a changed byte changes one choice; zeros after the last.
    Bytes { bytes: Vec<u8>, at: usize },
}

impl Dice {
    /// The stream of a seed.
    #[must_use]
    pub fn seeded(seed: u64) -> Self {
        Self(Source::Stream(seed))
    }

    /// What bytes say.
    #[must_use]
    pub fn told(bytes: &[u8]) -> Self {
        Self(Source::Bytes { bytes: bytes.to_vec(), at: 0 })
    }

    /// Whether there are no bytes left. A stream has no end.
    #[must_use]
    pub fn is_spent(&self) -> bool {
        matches!(&self.0, Source::Bytes { bytes, at } if *at >= bytes.len())
    }

    /// The next number of so many bits, at most 53; of the stream its highest ones.
    fn bits(&mut self, bits: u32) -> u64 {
        match &mut self.0 {
            Source::Stream(state) => {
                *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
                let mut x = *state;
                x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
                x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
                (x ^ (x >> 31)) >> (64 - bits)
            }
            Source::Bytes { bytes, at } => {
                let count = bits.div_ceil(8) as usize;
                let number = (0..count)
                    .fold(0, |sum, k| (sum << 8) | u64::from(bytes.get(*at + k).copied().unwrap_or(0)));
                *at += count;
                number
            }
        }
    }

    /// A number below another one, which is not 0.
    ///
    /// # Panics
    /// When it is 0.
    pub fn below(&mut self, count: usize) -> usize {
        let bits = match self.0 {
            Source::Stream(_) => 31,
            Source::Bytes { .. } if count <= 1 << 8 => 8,
            Source::Bytes { .. } => 16,
        };
        usize::try_from(self.bits(bits)).expect("31 bits fit") % count
    }

    /// A number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        let bits = if matches!(self.0, Source::Stream(_)) { 53 } else { 16 };
        self.bits(bits) as f64 / (1_u64 << bits) as f64
    }

    /// One or the other.
    pub fn coin(&mut self) -> bool {
        self.below(2) == 0
    }

    /// A vector in the cube from -1 to 1.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.unit() - 0.5, self.unit() - 0.5, self.unit() - 0.5) * 2.0
    }

    /// One of several, if there is any.
    pub fn pick<T: Copy>(&mut self, among: &[T]) -> Option<T> {
        if among.is_empty() { None } else { Some(among[self.below(among.len())]) }
    }
}

/// The next request of a sequence.
pub fn propose(dice: &mut Dice, model: &Model) -> Request {
    match dice.below(20) {
        0 | 1 => Request::Step(Step { drag: None, iterations: 20 }),
        2 => [Request::Undo, Request::Undo, Request::Redo][dice.below(3)].clone(),
        3 if dice.below(3) == 0 => Request::OpenText { text: ductile_spec::to_compact_text(&model.document) },
        _ => Request::Edit(edit(dice, model)),
    }
}

#[expect(clippy::too_many_lines, reason = "one row for each act")]
fn edit(dice: &mut Dice, model: &Model) -> Edit {
    let curves: Vec<CurveId> = model.curves.keys().copied().collect();
    let points: Vec<PointId> = model.document.points.keys().copied().collect();
    let surfaces: Vec<SurfaceId> = model.surfaces.keys().copied().collect();
    // What is not there is asked for now and then.
    let is_wild = dice.below(60) == 0;
    let curve = dice.pick(&curves).filter(|_| !is_wild).unwrap_or(CurveId(99));
    let point = dice.pick(&points).filter(|_| !is_wild).unwrap_or(PointId(99));
    let surface = dice.pick(&surfaces).filter(|_| !is_wild).unwrap_or(SurfaceId(99));
    let shape = model.surfaces.get(&surface).map(|shape| &**shape);
    let at = place(dice, model, shape);
    match dice.below(49) {
        0..=8 => Edit::SLoop { surface, along: Vec::new(), closed: false }.drawn(dice, model, shape),
        9..=11 => Edit::Burnout { region: On { surface, at } },
        12..=14 => Edit::Split { border: border(dice, model, curve, On { surface, at }) },
        15..=18 => Edit::Crease { border: border(dice, model, curve, On { surface, at }) },
        19..=21 => Edit::Smooth { curve: crease(model).filter(|_| !is_wild).unwrap_or(curve) },
        22..=24 => {
            let (from, to) = (rim_place(dice, model, 0), rim_place(dice, model, 1));
            let (skirt, reversed) = (dice.coin(), dice.coin());
            Edit::Glue { from, to, skirt, reversed }
        }
        25..=26 => {
            let other = dice.pick(&surfaces).unwrap_or(surface);
            let there = place(dice, model, model.surfaces.get(&other).map(|shape| &**shape));
            if other != surface && dice.below(4) == 0 {
                let (radius, keep) = (model.spacing() * (0.7 + dice.unit()), dice.coin());
                return Edit::MergeClosest { first: surface, second: other, radius, keep };
            }
            let (from, to) = (On { surface, at }, On { surface: other, at: there });
            Edit::Merge { from, to, radius: model.spacing() * (0.7 + dice.unit()), keep: dice.coin() }
        }
        27 => Edit::Sweep {
            from: curve,
            to: dice.pick(&curves).unwrap_or(curve),
            stretches: [None; 2],
            reversed: dice.coin(),
        },
        28 => Edit::Sheet { boundary: curve },
        29 => {
            let radius = 0.2 + 1.5 * dice.unit();
            let other = dice.pick(&curves).unwrap_or(curve);
            let to = if dice.coin() { Extent::Radius(radius) } else { Extent::Like(other) };
            Edit::Expand { curve, to }
        }
        30 if dice.coin() => Edit::Propagate { surface },
        30 => Edit::Reverse { surface },
        31 => Edit::Release { point },
        32 => match dice.below(4) {
            0 => Edit::DeletePoint { point },
            1 => Edit::DeleteSurface { surface },
            _ => Edit::DeleteCurve { curve },
        },
        33 | 34 => {
            let at = model.document.points.get(&point).copied().unwrap_or(DVec3::ZERO);
            Edit::Move { point, to: at + 0.3 * dice.vector() }
        }
        35 => Edit::Pin { surface, at },
        36 => Edit::Insert { curve, at },
        37 => {
            let all = [Objective::ThinPlate, Objective::Fair, Objective::Neutral, Objective::Membrane];
            let of =
                if dice.coin() { ObjectiveOf::Region { surface, at } } else { ObjectiveOf::Surface(surface) };
            Edit::Objective { of, objective: dice.pick(&all).filter(|_| dice.below(4) > 0) }
        }
        38 => {
            let of =
                if dice.coin() { SpacingOf::Region { surface, at } } else { SpacingOf::Surface(surface) };
            Edit::Spacing { of, spacing: Some(0.25 + 0.3 * dice.unit()).filter(|_| dice.below(4) > 0) }
        }
        39 => Edit::Normal { surface, point, normal: Some(dice.vector()) },
        40 | 41 => Edit::Ribbon { surface, curve, leave: Some(Leave::Angle(1.2 * (dice.unit() - 0.5))) },
        42 => {
            let count = 2 + dice.below(3);
            let closed = dice.coin();
            let mut through: Vec<Through> =
                (0..count + usize::from(closed)).map(|_| Through::Place(1.5 * dice.vector())).collect();
            if dice.coin() {
                through[0] = Through::Point(point);
            }
            Edit::Curve { through, closed }
        }
        43 => {
            let of = dice.pick(&surfaces).filter(|of| *of != surface || is_wild);
            let turn = Some(3.0 * dice.unit()).filter(|_| dice.coin());
            Edit::Shadow { region: On { surface, at }, of, strength: 2.0 * dice.unit() - 0.5, turn }
        }
        44 => Edit::Embed { curve, surface },
        45 => {
            let other = dice.pick(&surfaces).unwrap_or(surface);
            let there = place(dice, model, model.surfaces.get(&other).map(|shape| &**shape));
            let ribbon = [None, Some(JoinRibbon::AsMet), Some(JoinRibbon::Angle(3.0 * dice.unit()))];
            let (first, second) = (On { surface, at }, On { surface: other, at: there });
            Edit::Trim { first, second, smooth: dice.coin(), ribbon: ribbon[dice.below(3)] }
        }
        46 => {
            let to = dice.pick(&curves).unwrap_or(curve);
            let stretches = [curve, to].map(|curve| stretch(dice, model, curve));
            Edit::Sweep { from: curve, to, stretches, reversed: dice.coin() }
        }
        47 if dice.below(3) == 0 => Edit::Bake { surface },
        47 | 48 => displacing(dice, surface, at),
        _ => Edit::Tangent { curve, point, direction: Some(dice.vector()) },
    }
}

/// Two control points of a curve, or all of it.
fn stretch(dice: &mut Dice, model: &Model, curve: CurveId) -> Option<[PointId; 2]> {
    let through = &model.document.curves.get(&curve)?.through;
    let ends = [dice.pick(through)?, dice.pick(through)?];
    Some(ends).filter(|_| dice.below(4) > 0)
}

/// An act on displacements.
fn displacing(dice: &mut Dice, surface: SurfaceId, at: DVec3) -> Edit {
    let range = 0.9 - 2.0 * dice.unit();
    let displacement = Displacement { range, ..Displacement::new(at, 0.3 * dice.vector()) };
    let number = 1 + dice.below(3);
    match dice.below(9) {
        8 => Edit::AddFoot { surface, number, at },
        0 => Edit::ChangeDisplacement { surface, number, to: displacement },
        1 => Edit::EraseDisplacement { surface, number },
        2 => Edit::DropDisplacements { surface },
        3 => {
            let pins = vec![Hold::Around { at, radius: 0.2 * dice.unit() }];
            let combination = if dice.coin() { Combination::Plain } else { Combination::Pairwise };
            Edit::Blending { surface, blending: Blending { pins, combination, ..Blending::default() } }
        }
        _ => Edit::Displace { surface, displacement },
    }
}

fn border(dice: &mut Dice, model: &Model, curve: CurveId, on: On) -> Border {
    if dice.coin() { Border::Curve(inner(dice, model).unwrap_or(curve)) } else { Border::Region(on) }
}

/// A curve that runs inside a surface, mostly.
fn inner(dice: &mut Dice, model: &Model) -> Option<CurveId> {
    let shapes = model.surfaces.values();
    let inside = shapes.flat_map(|shape| {
        let edges = shape.mesh.edges().filter(|e| !shape.mesh.is_boundary_edge(*e));
        edges.filter_map(|e| shape.mesh.edge_source(e)).map(|tag| CurveId(tag.0))
    });
    let inside: std::collections::BTreeSet<CurveId> = inside.collect();
    let inside: Vec<CurveId> = inside.into_iter().collect();
    dice.pick(&inside).filter(|_| dice.below(8) > 0)
}

/// A curve at which two rims meet, if there is one.
fn crease(model: &Model) -> Option<CurveId> {
    let rims = |curve: &CurveId| {
        let lines = model.surfaces.values().flat_map(|shape| &shape.embeddings);
        lines.filter(|e| e.curve == *curve).count()
    };
    model.curves.keys().copied().find(|curve| rims(curve) == 2)
}

/// A place on a surface or beside it.
pub(crate) fn place(dice: &mut Dice, model: &Model, shape: Option<&SurfaceShape>) -> DVec3 {
    let Some(shape) = shape else { return dice.vector() };
    let vertices: Vec<_> = shape.mesh.vertices().collect();
    let at = |v: ductile_mesh::VertexId| shape.positions[v.index()];
    let some = vertices[dice.below(vertices.len())];
    match dice.below(8) {
        0 => {
            let tagged: Vec<_> = vertices.into_iter().filter(|v| shape.mesh.is_source_vertex(*v)).collect();
            dice.pick(&tagged).map_or(at(some), at)
        }
        1 => {
            let rim: Vec<_> = vertices.into_iter().filter(|v| shape.mesh.is_boundary_vertex(*v)).collect();
            dice.pick(&rim).map_or(at(some), at)
        }
        2 => dice
            .pick(&shape.embeddings.iter().flat_map(|e| e.vertices.clone()).collect::<Vec<_>>())
            .map_or(at(some), at),
        3 => at(some) + 0.3 * model.spacing() * dice.vector(),
        4 => at(some),
        _ => {
            let faces: Vec<_> = shape.mesh.faces().collect();
            let corners = shape.mesh.face_vertices(faces[dice.below(faces.len())]);
            corners.map(at).iter().sum::<DVec3>() / 3.0
        }
    }
}

/// A place on a rim of some surface that has one: the first half of the rims or the second, mostly.
fn rim_place(dice: &mut Dice, model: &Model, half: usize) -> On {
    let mut rims = Vec::new();
    for (id, shape) in &model.surfaces {
        for rim in ductile_mesh::boundary_loops(&shape.mesh) {
            rims.push((*id, shape.positions[rim[dice.below(rim.len())].index()]));
        }
    }
    if rims.len() > 1 && dice.below(5) > 0 {
        let middle = 1 + dice.below(rims.len() - 1);
        let other = rims.split_off(middle);
        // The halves are drawn anew each time: now and then both places are on one rim all the same.
        rims = if half == 0 { rims } else { other };
    }
    let (surface, at) = dice.pick(&rims).unwrap_or((SurfaceId(1), DVec3::ZERO));
    On { surface, at }
}

/// Fills in where a curve is drawn.
trait Drawn {
    fn drawn(self, dice: &mut Dice, model: &Model, shape: Option<&SurfaceShape>) -> Self;
}

impl Drawn for Edit {
    fn drawn(self, dice: &mut Dice, model: &Model, shape: Option<&SurfaceShape>) -> Self {
        let Self::SLoop { surface, .. } = self else { return self };
        let (along, closed) = match dice.below(6) {
            0..=2 => (ring(dice, model, shape), true),
            3 => ((0..3 + dice.below(2)).map(|_| place(dice, model, shape)).collect(), true),
            4 => ((0..2 + dice.below(3)).map(|_| place(dice, model, shape)).collect(), false),
            _ => {
                let rim: Vec<DVec3> = shape.map_or_else(Vec::new, |shape| {
                    let rim = shape.mesh.vertices().filter(|v| shape.mesh.is_boundary_vertex(*v));
                    rim.map(|v| shape.positions[v.index()]).collect()
                });
                let mut along = vec![place(dice, model, shape)];
                along.insert(0, dice.pick(&rim).unwrap_or(DVec3::X));
                along.push(dice.pick(&rim).unwrap_or(DVec3::Y));
                (along, false)
            }
        };
        Self::SLoop { surface, along, closed }
    }
}

/// Places round one on a surface.
fn ring(dice: &mut Dice, model: &Model, shape: Option<&SurfaceShape>) -> Vec<DVec3> {
    let normal = shape.and_then(|shape| {
        let faces: Vec<_> = shape.mesh.faces().collect();
        let f = faces[dice.below(faces.len())];
        let middle =
            shape.mesh.face_vertices(f).map(|v| shape.positions[v.index()]).iter().sum::<DVec3>() / 3.0;
        Some((middle, face_normal(&shape.mesh, &shape.positions, f).try_normalize()?))
    });
    let (centre, normal) = normal.unwrap_or((DVec3::ZERO, DVec3::Z));
    let (u, v) = normal.any_orthonormal_pair();
    let count = 3 + dice.below(5);
    let radius = model.spacing() * (0.5 + 3.0 * dice.unit());
    let corner = |k: usize| {
        let (sin, cos) = libm::sincos(k as f64 * core::f64::consts::TAU / count as f64);
        centre + (u * cos + v * sin) * radius
    };
    (0..count).map(corner).collect()
}

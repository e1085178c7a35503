//! A patch that fills a loop of curves: an S-patch between ribbons (P. Salvi, *G1 hole filling with S-patches made easy*, 2020).
//!
//! The sides become Bézier curves, least squares with the corners met; the ribbons lie in the tangent planes that the document
//! names as well as they can, and are fair where it names none. It takes as few sums as a frame can bear, so a fill follows its
//! curves and its neighbours in every frame. Fills whose planes come from others are done after those.

mod corners;
mod degree;
mod error;
mod net;
mod planes;
mod precedence;
mod side;
#[cfg(test)]
mod tests;
mod twist;

pub(crate) use corners::{corners, held, joined};
pub use error::FillError;
pub(crate) use side::{Drawn, Side, places, tangents};

use self::planes::{Given, side_on};
use self::precedence::Precedence;
use super::{NetLines, PatchShape};
use crate::model::Model;
use crate::relax::Relaxer;
use crate::shape::edit;
use ductile_patch::s_patch::{Fill as Rule, Join, PatchKind, SPatch, Tessellated};
use ductile_patch::{PlaneSample, Ribbon, RibbonLoop, curve_point, elevated, ribbons_along, ribbons_raised};
use ductile_spec::{
    CurveId, FILL_RESOLUTION, Fill, FillFigures, FillInterior, FillJoin, FillNet, FillSide, FillStyle,
    SurfaceId,
};
use glam::DVec3;
use std::collections::BTreeSet;
use std::sync::Arc;

/// More control points than this do not follow a hand.
const MOST_POINTS: usize = 13_000;
/// Sine of the least angle by which a loop turns at a corner, and of which it stays away from turning back: 5°.
const FLAT: f64 = 0.087;

/// A plane at a corner that a surface gives, and the curves that have to leave in it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lead {
    /// Whose plane it is.
    pub(crate) surface: SurfaceId,
    /// Its unit normal.
    pub(crate) normal: DVec3,
    pub(crate) curves: BTreeSet<CurveId>,
}

/// A fill, as its curves were when it last could follow them.
#[derive(Clone, Debug)]
pub struct FillShape {
    /// What it was last made from, or should have been.
    drawn: Vec<Drawn>,
    style: FillStyle,
    /// The least degree of its ribbons.
    degree: usize,
    planes: Vec<Given>,
    /// Its sides, and its ribbons as they would be without planes.
    pub(crate) sides: Vec<Side>,
    base: Option<RibbonLoop>,
    pub(crate) built: Option<Built>,
    /// Its curves have no fit: what it has is of others.
    is_behind: bool,
    /// Why it does not follow.
    pub(crate) failure: Option<FillError>,
    /// Names this connectivity.
    pub(crate) revision: u64,
}

/// A patch and its mesh.
#[derive(Clone, Debug)]
pub(crate) struct Built {
    kind: Arc<PatchKind>,
    pub(crate) ribbons: RibbonLoop,
    pub(crate) patch: SPatch,
    mesh: Tessellated,
    net: net::Lines,
    /// The largest angle to a plane that was asked for, in radians.
    angle: f64,
}

impl FillShape {
    /// One that has followed nothing yet.
    pub(super) fn new(style: FillStyle, revision: u64) -> Self {
        Self {
            drawn: Vec::new(),
            style,
            degree: 0,
            planes: Vec::new(),
            sides: Vec::new(),
            base: None,
            built: None,
            is_behind: false,
            failure: None,
            revision,
        }
    }

    pub(super) fn positions(&self) -> &[DVec3] {
        self.built.as_ref().map_or(&[], |built| &built.mesh.positions)
    }

    pub(super) fn normals(&self) -> &[DVec3] {
        self.built.as_ref().map_or(&[], |built| &built.mesh.normals)
    }

    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        self.built.as_ref().map_or(&[], |built| built.kind.triangles())
    }

    /// What it shows of its control points.
    pub(super) fn net(&self) -> NetLines<'_> {
        self.built.as_ref().map_or((&[], &[]), |built| (&built.net.0, &built.net.1))
    }

    /// How well it follows its curves and planes.
    pub(crate) fn figures(&self, surface: SurfaceId) -> FillFigures {
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let built = self.built.as_ref();
        FillFigures {
            surface,
            sides: count(built.map_or(self.drawn.len(), |built| built.ribbons.sides())),
            degree: count(built.map_or(0, |built| built.ribbons.degree())),
            control_points: count(built.map_or(0, |built| built.patch.points().len())),
            curve_deviation: self.sides.iter().map(|side| side.fit.deviation).fold(0.0, f64::max),
            plane_deviation: built.map_or(0.0, |built| built.angle.to_degrees()),
            turned_out: built
                .and_then(|built| turned_out(built.ribbons.ribbons()))
                .map(|side| count(side + 1)),
            stuck: self.failure.map(|failure| failure.to_string()),
        }
    }

    /// New curves: their fits, and the ribbons that they have by themselves.
    fn redraw(&mut self, fill: &Fill, (own, degree): (usize, usize), drawn: Vec<Drawn>) {
        self.drawn = drawn;
        (self.style, self.degree) = (fill.style, degree);
        let fitted = fitted(fill, own, &self.drawn);
        self.is_behind = fitted.is_err();
        self.failure = fitted.as_ref().err().copied();
        if let Ok((sides, base)) = fitted {
            (self.sides, self.base) = (sides, Some(base));
        }
    }

    /// New planes, or new curves: the patch.
    fn rebuild(&mut self, planes: Vec<Given>, known: impl Fn(&Wanted) -> Option<Arc<PatchKind>>) {
        self.planes = planes;
        let Some(base) = &self.base else { return };
        let built = built(base, &self.sides, (self.style, self.degree), &self.planes, known);
        self.failure = built.as_ref().err().copied();
        if let Ok(built) = built {
            self.built = Some(built);
        }
    }
}

/// Which kind of patch is wanted: sides, degree, join, rule, resolution.
type Wanted = (usize, usize, Join, Rule, usize);

fn join(style: FillStyle) -> Join {
    match style.join {
        FillJoin::Tangent => Join::Tangent,
        FillJoin::Position => Join::Position,
    }
}

/// Sides with their Bézier curves, and ribbons along them without regard to planes.
fn fitted(fill: &Fill, own: usize, drawn: &[Drawn]) -> Result<(Vec<Side>, RibbonLoop), FillError> {
    if !fill.ribbons.is_empty() {
        let ribbons = fill.ribbons.iter().map(|r| Ribbon { row0: r.row0.clone(), row1: r.row1.clone() });
        let ribbons: Vec<Ribbon> = ribbons.collect();
        let ring = match fill.style.join {
            FillJoin::Tangent => RibbonLoop::new(&ribbons)?,
            FillJoin::Position => {
                RibbonLoop::of_curves(&ribbons.into_iter().map(|ribbon| ribbon.row0).collect::<Vec<_>>())?
            }
        };
        return Ok((Vec::new(), ring));
    }
    let sides = drawn.iter().cloned().map(Side::new).collect::<Result<Vec<_>, _>>()?;
    let rows: Vec<Vec<DVec3>> = sides
        .iter()
        .map(|side| (side.fit.points.len() - 1..own).fold(side.row(), |row, _| elevated(&row)))
        .collect();
    let ring = match fill.style.join {
        FillJoin::Tangent => {
            check_corners(fill, &rows)?;
            ribbons_along(&rows, &[])?.ribbons
        }
        FillJoin::Position => RibbonLoop::of_curves(&rows)?,
    };
    Ok((sides, ring))
}

/// Refuses corners at which a patch would have no tangent plane.
fn check_corners(fill: &Fill, rows: &[Vec<DVec3>]) -> Result<(), FillError> {
    for (at, (side, row)) in fill.sides.iter().zip(rows).enumerate() {
        let before = &rows[(at + rows.len() - 1) % rows.len()];
        let [.., from, to] = before[..] else { continue };
        let (arrives, leaves) = ((to - from).normalize_or_zero(), (row[1] - row[0]).normalize_or_zero());
        let sine = arrives.cross(leaves).length();
        if sine.is_nan() || sine < FLAT {
            let degrees = libm::atan2(sine, arrives.dot(leaves)).to_degrees();
            return Err(FillError::FlatCorner { point: side.from, degrees });
        }
    }
    Ok(())
}

/// Cosine of the angle between the plane at a corner and that of the whole loop from which on the corner turns outwards: 120°. Loops
/// that are far from flat have corners that lean.
const TURNED_OUT: f64 = -0.5;

/// The first side at whose beginning the loop turns the other way than as a whole.
fn turned_out(ribbons: &[Ribbon]) -> Option<usize> {
    let places: Vec<DVec3> = ribbons.iter().flat_map(|ribbon| &ribbon.row0[1..]).copied().collect();
    let next = places.iter().cycle().skip(1);
    let area = places.iter().zip(next).map(|(a, b)| (*a - places[0]).cross(*b - places[0])).sum::<DVec3>();
    let up = area.normalize_or_zero();
    (0..ribbons.len()).find(|&side| {
        let before = &ribbons[(side + ribbons.len() - 1) % ribbons.len()].row0;
        let (own, [.., from, to]) = (&ribbons[side].row0, &before[..]) else { return false };
        (*to - *from).cross(own[1] - own[0]).normalize_or_zero().dot(up) < TURNED_OUT
    })
}

fn built(
    base: &RibbonLoop,
    sides: &[Side],
    (style, degree): (FillStyle, usize),
    planes: &[Given],
    known: impl Fn(&Wanted) -> Option<Arc<PatchKind>>,
) -> Result<Built, FillError> {
    let (mut ribbons, mut angle) = (base.clone(), 0.0);
    if style.join == FillJoin::Tangent && !planes.is_empty() {
        let rows: Vec<Vec<DVec3>> = base.ribbons().iter().map(|ribbon| ribbon.row0.clone()).collect();
        let samples: Vec<PlaneSample> = planes.iter().map(|given| given.sample).collect();
        ribbons = ribbons_raised(&rows, &samples, degree)?.ribbons;
        angle = planes.iter().map(|given| given.angle(&ribbons)).fold(0.0, f64::max);
    }
    let rule = match style.interior {
        FillInterior::Biharmonic => Rule::Biharmonic,
        FillInterior::Harmonic => Rule::Harmonic,
    };
    let resolution = usize::from(style.resolution.unwrap_or(FILL_RESOLUTION));
    let wanted = (ribbons.sides(), ribbons.degree(), join(style), rule, resolution);
    if PatchKind::control_points(wanted.0, wanted.1, wanted.2) > MOST_POINTS as f64 {
        return Err(FillError::TooLarge { sides: wanted.0, degree: wanted.1, limit: MOST_POINTS });
    }
    let kind = match known(&wanted) {
        Some(kind) => kind,
        None => Arc::new(PatchKind::new(wanted.0, wanted.1, wanted.2, wanted.3, wanted.4)?),
    };
    let lost = FillError::Kind(ductile_patch::s_patch::TessellationError::Resolution(resolution).into());
    let patch = kind.filling(&ribbons)?.ok_or(lost)?;
    let mut mesh = kind.evaluate(&patch).ok_or(lost)?;
    // Evaluated on the control curve's own Bézier curve, so that patches with a side in common have its points in common.
    for (at, side) in sides.iter().enumerate() {
        for step in 0..=resolution {
            let along = if side.drawn.back { resolution - step } else { step };
            let vertex = kind.grid().on_side(at, step);
            mesh.positions[vertex] = curve_point(&side.fit.points, along as f64 / resolution as f64);
        }
    }
    let net = match style.net {
        FillNet::Ribbons => net::of_ribbons(&ribbons, style.join),
        FillNet::Whole => net::whole(&kind, &patch),
    };
    Ok(Built { kind, ribbons, patch, mesh, net, angle })
}

/// The shape of a fill.
pub(crate) fn shape(model: &Model, id: SurfaceId) -> Option<&FillShape> {
    match model.patches.get(&id).map(|shape| &**shape) {
        Some(PatchShape::Fill(shape)) => Some(shape),
        _ => None,
    }
}

/// Changes the shape of a fill; it is copied if somebody else holds it.
fn change(model: &mut Model, id: SurfaceId, how: impl FnOnce(&mut FillShape)) {
    if let Some(PatchShape::Fill(shape)) = model.patches.get_mut(&id).map(edit) {
        how(shape);
    }
}

/// Brings all fills up to date with their curves and with what lies beside them. One that cannot follow stays as it was, and says
/// why. Without a relaxer nothing is known of the planes of fair surfaces.
pub(crate) fn follow(model: &mut Model, relaxer: Option<&Relaxer>) {
    if model.document.fills.is_empty() {
        return;
    }
    let document = Arc::clone(&model.document);
    let precedence = Precedence::new(&document);
    let (degrees, corner_planes) = (degree::of_stretches(&document), side::planes(model, relaxer));
    let mut is_new: BTreeSet<SurfaceId> = BTreeSet::new();
    for (id, fill) in &document.fills {
        let Some(shape) = shape(model, *id) else { continue };
        let (own, of_ribbons) = (degree::of(&document, fill), precedence.degree(*id));
        let drawn = side::all_drawn(model, &corner_planes, fill, |stretch| {
            degrees.get(stretch).copied().unwrap_or(own)
        });
        match drawn {
            Ok(drawn) => {
                let is_first = shape.base.is_none() && shape.failure.is_none();
                let is_same = fill.style == shape.style && of_ribbons == shape.degree;
                if is_first || drawn != shape.drawn || !is_same {
                    change(model, *id, |shape| shape.redraw(fill, (own, of_ribbons), drawn));
                    is_new.insert(*id);
                }
            }
            Err(failure) if shape.failure != Some(failure) => {
                change(model, *id, |shape| {
                    shape.drawn.clear();
                    (shape.is_behind, shape.failure) = (true, Some(failure));
                });
            }
            Err(_) => {}
        }
    }
    let twists = twist::Twists::new(model, relaxer, &precedence);
    let mut done: BTreeSet<SurfaceId> = BTreeSet::new();
    let waits = |id: SurfaceId, fill: &Fill, done: &BTreeSet<SurfaceId>| {
        let on = |(at, side): (usize, &FillSide)| side.planes.or_else(|| precedence.first(id, at));
        let mut on = fill.sides.iter().enumerate().filter_map(on);
        on.any(|on| on != id && document.fills.contains_key(&on) && !done.contains(&on))
    };
    // The document is valid, so there is always one that waits for none; that this ends does not hang on it.
    for _ in 0..document.fills.len() {
        let ready: Vec<SurfaceId> = document
            .fills
            .iter()
            .filter(|(id, fill)| !done.contains(id) && !waits(**id, fill, &done))
            .map(|(id, _)| *id)
            .collect();
        for id in ready {
            done.insert(id);
            put_in_planes(model, relaxer, (&precedence, &twists), (id, is_new.contains(&id)));
        }
        if done.len() == document.fills.len() {
            break;
        }
    }
}

/// Gives a fill the planes that there are for it now, and builds it if they or its curves are new.
fn put_in_planes(
    model: &mut Model,
    relaxer: Option<&Relaxer>,
    joins: (&Precedence, &twist::Twists),
    (id, is_new): (SurfaceId, bool),
) {
    let planes = planes::of(model, relaxer, joins, id);
    let Some(shape) = shape(model, id) else { return };
    if shape.is_behind || shape.base.is_none() || !is_new && planes == shape.planes {
        return;
    }
    let kinds: Vec<Arc<PatchKind>> = model
        .document
        .fills
        .keys()
        .filter_map(|other| Some(Arc::clone(&self::shape(model, *other)?.built.as_ref()?.kind)))
        .collect();
    let known = |&(sides, degree, join, rule, resolution): &Wanted| {
        kinds.iter().find(|kind| kind.is_for(sides, degree, join, rule, resolution)).map(Arc::clone)
    };
    let connectivity =
        |shape: &FillShape| shape.built.as_ref().map(|built| (Arc::clone(&built.kind), built.net.1.len()));
    let before = connectivity(shape);
    change(model, id, |shape| shape.rebuild(planes, known));
    let after = self::shape(model, id).and_then(connectivity);
    let is_alike = match (&before, &after) {
        (Some((kind, edges)), Some((other, others))) => Arc::ptr_eq(kind, other) && edges == others,
        (before, after) => before.is_none() && after.is_none(),
    };
    if !is_alike {
        let revision = model.next_revision();
        change(model, id, |shape| shape.revision = revision);
    }
}

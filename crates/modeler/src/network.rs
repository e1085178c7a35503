//! Which curves are solved together: those that meet, three or more at a time, at a control point of one surface, or at a corner of
//! fills that join smoothly there.
//!
//! A surface can be smooth where its curves cross only if their tangents lie in a plane there (thesis section 8.3, recipe
//! section 10); two always do. A point where curves of different surfaces meet is a corner, and asks nothing. Where a surface
//! beside a fill gives the plane of a corner, it is held, and a single curve has to lie in it. Curves that a film or a neutral
//! curve's lack of energy leaves out (see `ductile_solver::Network`) stay alone, and so do those that a rim leads.

use crate::bound::{BoundCurve, Motion};
use crate::model::Model;
use crate::patch::fill::{self, Lead};
use crate::shape::{CurveShape, edit};
use ductile_solver::{Network, SolverError, Spoke, Strand};
use ductile_spec::{CurveId, Document, Objective, PointId};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// An angle by which a plane that is held may turn without waking its curves, in radians.
const SAME: f64 = 1e-9;

/// Curves that hang together by their hubs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Group {
    /// In order of identity.
    curves: Vec<CurveId>,
    hubs: Vec<Vec<Spoke>>,
    /// For each hub its point, if the plane there is held.
    held: Vec<Option<PointId>>,
}

/// A point where curves have to agree, with those curves, and whether in a plane that is given.
type Hub = (PointId, Vec<CurveId>, bool);

/// A group with its solver; none where the group is too large for one.
#[derive(Clone, Debug)]
struct BoundNetwork {
    group: Group,
    network: Option<Network>,
    /// Whether a plane that is held has turned since the last step.
    has_turned: bool,
}

/// The networks of a model.
#[derive(Clone, Debug, Default)]
pub(crate) struct Networks {
    bound: Vec<BoundNetwork>,
}

/// How the curves of a network stand after a step.
pub(crate) struct Outcome {
    pub(crate) curves: Vec<CurveId>,
    pub(crate) at_rest: bool,
    /// Something was refused or shortened.
    pub(crate) is_rescued: bool,
}

impl Networks {
    /// Brings the networks up to the model, with the planes that surfaces give. Returns how many are too large to be solved together.
    pub(crate) fn bind(&mut self, model: &Model, leads: &BTreeMap<PointId, Lead>) -> u32 {
        let mut before = std::mem::take(&mut self.bound);
        let mut refused = 0;
        for group in groups(model, leads) {
            let normal =
                |point: &Option<PointId>| point.and_then(|point| leads.get(&point)).map(|lead| lead.normal);
            let planes: Vec<Option<DVec3>> = group.held.iter().map(normal).collect();
            let known = before.iter().position(|bound| bound.group == group);
            self.bound.push(known.map_or_else(
                || {
                    let hubs: Vec<_> = group.hubs.iter().cloned().zip(planes.iter().copied()).collect();
                    let network = Network::with_planes(&hubs).ok();
                    refused += u32::from(network.is_none());
                    BoundNetwork { group, network, has_turned: false }
                },
                |known| {
                    let mut known = before.swap_remove(known);
                    let turned = known.network.as_mut().map_or(0.0, |network| network.set_planes(&planes));
                    known.has_turned |= turned > SAME;
                    known
                },
            ));
        }
        refused
    }

    /// Carries the controls of every network that does not rest, and steps it once.
    pub(crate) fn step(
        &mut self,
        model: &mut Model,
        solvers: &mut BTreeMap<CurveId, BoundCurve>,
        rests: impl Fn(CurveId) -> bool,
    ) -> Vec<Outcome> {
        let mut outcomes = Vec::new();
        for BoundNetwork { group, network, has_turned } in &mut self.bound {
            let Some(network) = network else { continue };
            if !group.curves.iter().all(|id| solvers.contains_key(id) && model.curves.contains_key(id)) {
                continue;
            }
            let motions: Vec<Motion> =
                group.curves.iter().map(|id| BoundCurve::motion(model, &model.curves[id])).collect();
            let is_met = motions.iter().all(Motion::is_empty);
            let mut outcome = Outcome { curves: group.curves.clone(), at_rest: true, is_rescued: false };
            if std::mem::take(has_turned) || !(is_met && group.curves.iter().all(|id| rests(*id))) {
                match step(network, group, model, solvers, &motions) {
                    Ok((at_rest, damped)) => {
                        (outcome.at_rest, outcome.is_rescued) = (at_rest && is_met, damped);
                    }
                    Err(_) => (outcome.at_rest, outcome.is_rescued) = (false, true),
                }
            }
            outcomes.push(outcome);
        }
        outcomes
    }
}

/// One step of a network; the shapes change only if it is done.
fn step(
    network: &mut Network,
    group: &Group,
    model: &mut Model,
    solvers: &mut BTreeMap<CurveId, BoundCurve>,
    motions: &[Motion],
) -> Result<(bool, bool), SolverError> {
    let mut nodes: Vec<_> = group.curves.iter().map(|id| model.curves[id].nodes.clone()).collect();
    // Both in order of identity.
    let bound = solvers.iter_mut().filter(|(id, _)| group.curves.contains(id)).map(|(_, bound)| bound);
    let mut strands = Vec::with_capacity(nodes.len());
    for ((bound, nodes), motion) in bound.zip(&mut nodes).zip(motions) {
        bound.carry(nodes, motion)?;
        strands.push(Strand { solver: &mut bound.solver, positions: nodes });
    }
    let report = network.step(&mut strands)?;
    for (id, nodes) in group.curves.iter().zip(nodes) {
        if let Some(shape) = model.curves.get_mut(id).map(edit::<CurveShape>) {
            shape.nodes = nodes;
        }
    }
    Ok((report.at_rest, report.damped))
}

/// The points of a document where curves have to agree, each with those curves.
fn hubs(document: &Document, leads: &BTreeMap<PointId, Lead>) -> Vec<Hub> {
    let has_part = |id: &CurveId| {
        matches!(document.objective_of_curve(*id), Objective::ThinPlate | Objective::Fair)
            && document.curves.get(id).is_some_and(|curve| curve.rim.is_none())
    };
    let mut hubs = Vec::new();
    let mut taken: BTreeSet<(PointId, CurveId)> = BTreeSet::new();
    for surface in document.surfaces.values() {
        let curves: BTreeSet<CurveId> =
            surface.skeleton.curves.iter().map(|embedding| embedding.curve).filter(has_part).collect();
        let mut through: BTreeMap<PointId, Vec<CurveId>> = BTreeMap::new();
        for (id, curve) in curves.iter().filter_map(|id| Some((*id, document.curves.get(id)?))) {
            for point in curve.through.iter().filter(|point| !taken.contains(&(**point, id))) {
                through.entry(*point).or_default().push(id);
            }
        }
        for (point, curves) in through.into_iter().filter(|(_, curves)| curves.len() > 2) {
            taken.extend(curves.iter().map(|id| (point, *id)));
            hubs.push((point, curves, false));
        }
    }
    let free = |point: PointId, curves: BTreeSet<CurveId>| -> Vec<CurveId> {
        curves.into_iter().filter(|id| has_part(id) && !taken.contains(&(point, *id))).collect()
    };
    for (point, lead) in leads {
        let curves = free(*point, lead.curves.clone());
        if !curves.is_empty() {
            hubs.push((*point, curves, true));
        }
    }
    for (point, curves) in fill::corners(document).into_iter().filter(|(point, _)| !leads.contains_key(point))
    {
        let curves = free(point, curves);
        if curves.len() > 2 {
            hubs.push((point, curves, false));
        }
    }
    hubs
}

/// The curves that hang together, directly or by others.
fn groups(model: &Model, leads: &BTreeMap<PointId, Lead>) -> Vec<Group> {
    let hubs = hubs(&model.document, leads);
    let mut groups: Vec<(BTreeSet<CurveId>, Vec<&Hub>)> = Vec::new();
    for hub in &hubs {
        let mut joined = (hub.1.iter().copied().collect::<BTreeSet<_>>(), vec![hub]);
        let (touched, rest): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|(curves, _)| !curves.is_disjoint(&joined.0));
        for (curves, hubs) in touched {
            joined.0.extend(curves);
            joined.1.extend(hubs);
        }
        groups = rest;
        groups.push(joined);
    }
    let spoke = |curves: &BTreeSet<CurveId>, id: CurveId, point: PointId| {
        let node = model.curves.get(&id)?.sample_of(point)?;
        let curve = curves.iter().position(|other| *other == id)?;
        Some(Spoke { curve, node: u32::try_from(node).ok()? })
    };
    let build = |(curves, mut hubs): (BTreeSet<CurveId>, Vec<&Hub>)| {
        hubs.sort();
        let spokes =
            |(point, ids, _): &Hub| ids.iter().filter_map(|id| spoke(&curves, *id, *point)).collect();
        let held = hubs.iter().map(|(point, _, is_held)| is_held.then_some(*point)).collect();
        let hubs = hubs.into_iter().map(spokes).collect();
        Group { hubs, held, curves: curves.iter().copied().collect() }
    };
    groups.into_iter().map(build).collect()
}

#[cfg(test)]
mod tests;

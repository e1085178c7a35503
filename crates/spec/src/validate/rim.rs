//! What a curve must satisfy that is the rim of a surface over a cage.

use super::Defect;
use crate::cage::{Cage, CageSplit, RimEdge};
use crate::document::{Curve, Document};
use crate::id::{CurveId, PointId};
use std::collections::BTreeMap;

impl Document {
    /// Why a curve is not the rim that it is said to be; nothing for other curves.
    #[must_use]
    pub fn rim_defect(&self, id: CurveId) -> Option<Defect> {
        let curve = self.curves.get(&id)?;
        let surface = curve.rim?;
        let why = match self.cages.get(&surface) {
            None => Some("it is no surface over a cage"),
            Some(cage) => why_not(cage, curve),
        };
        why.map(|why| Defect::Rim { curve: id, surface, why })
    }

    /// Curves that are rims follow edges at which a cage ends, and nothing else is said of them.
    pub(super) fn validate_rims(&self) -> Result<(), Defect> {
        self.curves.keys().find_map(|id| self.rim_defect(*id)).map_or(Ok(()), Err)
    }
}

fn why_not(cage: &Cage, curve: &Curve) -> Option<&'static str> {
    if cage.split() == CageSplit::CatmullClark {
        return Some("that surface misses the vertices of its cage");
    }
    if curve.objective.is_some() || !curve.tangents.is_empty() {
        return Some("a rim has no objective and no tangents of its own");
    }
    let rim = cage.rim();
    let count = curve.through.len();
    let edges = if curve.closed { count } else { count - 1 };
    let at = |k: usize| curve.through[k % count];
    let runs = |forth: bool| {
        let ends = |k: usize| if forth { (at(k), at(k + 1)) } else { (at(k + 1), at(k)) };
        (0..edges).all(|k| rim.get(&ends(k).0).is_some_and(|edge| edge.to == ends(k).1))
    };
    if !runs(true) && !runs(false) {
        return Some("its points do not follow one another along edges at which the cage ends");
    }
    let inner = if curve.closed { 0..count } else { 1..count - 1 };
    inner.into_iter().any(|k| turns(&rim, at(k))).then_some("the rim turns at one of its points")
}

fn turns(rim: &BTreeMap<PointId, RimEdge>, point: PointId) -> bool {
    rim.get(&point).is_some_and(|edge| edge.turns)
}

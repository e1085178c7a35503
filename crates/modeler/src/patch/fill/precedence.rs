//! Which of two fills that agree along a side goes first: what a ribbon of a low degree cannot follow, one of a high degree can.
//!
//! A ribbon of degree `d` along a curve of degree `c` lies in the planes of another one, `W`, where its cross derivative is `a W + b T`
//! with `T` the derivative of the curve. For the corners and twist points to be what its other sides ask for, `a` is linear and
//! `b` cubic: it can if `d` is at least `c + 2` and more than the degree of `W`. Then the lower ribbon is fair, with the planes that the
//! corners ask for at its ends, and the other one follows it exactly.

use super::{degree, planes};
use ductile_spec::{Document, FillJoin, FillSide, SurfaceId};
use std::collections::{BTreeMap, BTreeSet};

/// By how much the degree of a ribbon has to exceed that of its curve to follow polynomial planes.
pub(super) const FREE: usize = 2;
/// Curves of this degree at the most have ribbons that come near polynomial planes at any rate.
const CARRIED: usize = 4;

/// A side of a fill, by its number.
type At = (SurfaceId, usize);

/// The degrees of the ribbons of all fills, and which go first. It hangs on the document alone.
#[derive(Clone, Debug, Default)]
pub(super) struct Precedence {
    degrees: BTreeMap<SurfaceId, usize>,
    first: BTreeMap<At, SurfaceId>,
    leaning: BTreeSet<SurfaceId>,
}

impl Precedence {
    pub(super) fn new(document: &Document) -> Self {
        let mut pairs: BTreeMap<At, SurfaceId> = BTreeMap::new();
        for (id, fill) in document.fills.iter().filter(|(_, fill)| fill.style.join == FillJoin::Tangent) {
            for (at, side) in fill.sides.iter().enumerate().filter(|(_, side)| side.planes.is_none()) {
                pairs.extend(document.partner(*id, side).map(|(other, ..)| ((*id, at), other)));
            }
        }
        let leaning: BTreeSet<SurfaceId> = document
            .fills
            .iter()
            .filter(|(id, fill)| planes::leans(document, **id, fill))
            .map(|(id, _)| *id)
            .collect();
        let of_curves: BTreeMap<SurfaceId, usize> =
            document.fills.iter().map(|(id, fill)| (*id, degree::of(document, fill))).collect();
        let pairs = Pairs { document, pairs, leaning, of_curves };
        let by_curves = pairs.first(&pairs.of_curves);
        let degree = |(id, fill): (&SurfaceId, &ductile_spec::Fill)| {
            let is_bound = |(at, side): (usize, &FillSide)| {
                let at = (*id, at);
                side.planes.is_some() || pairs.pairs.contains_key(&at) && by_curves.get(&at) != Some(id)
            };
            let is_bound =
                fill.style.join == FillJoin::Tangent && fill.sides.iter().enumerate().any(is_bound);
            (*id, degree::of_ribbons(document, fill, pairs.leaning.contains(id), is_bound))
        };
        let degrees = document.fills.iter().map(degree).collect();
        Self { first: pairs.first(&degrees), degrees, leaning: pairs.leaning }
    }

    /// The degree of the ribbons of a fill.
    pub(super) fn degree(&self, id: SurfaceId) -> usize {
        self.degrees.get(&id).copied().unwrap_or_default()
    }

    /// Whether two fills can both follow polynomial planes along a curve of a degree. What leans has the planes that it had without.
    pub(super) fn carries(&self, [one, other]: [SurfaceId; 2], of_curve: usize) -> bool {
        let least = self.degree(one).min(self.degree(other));
        let leans = self.leaning.contains(&one) || self.leaning.contains(&other);
        of_curve <= CARRIED || !leans && of_curve + FREE <= least
    }

    /// The fill that goes first along a side on which two agree; none where they meet half way.
    pub(super) fn first(&self, id: SurfaceId, at: usize) -> Option<SurfaceId> {
        self.first.get(&(id, at)).copied()
    }
}

/// The sides along which fills agree.
struct Pairs<'a> {
    document: &'a Document,
    /// With the other one.
    pairs: BTreeMap<At, SurfaceId>,
    leaning: BTreeSet<SurfaceId>,
    of_curves: BTreeMap<SurfaceId, usize>,
}

impl Pairs<'_> {
    /// Which goes first, with ribbons of these degrees.
    fn first(&self, degrees: &BTreeMap<SurfaceId, usize>) -> BTreeMap<At, SurfaceId> {
        let first = |(at, other): (&At, &SurfaceId)| {
            let [own, there] = [at.0, *other].map(|id| degrees.get(&id).copied().unwrap_or_default());
            let (first, [low, high]) =
                if own < there { (at.0, [own, there]) } else { (*other, [there, own]) };
            let of_curve = [at.0, *other].iter().filter_map(|id| self.of_curves.get(id)).min()?;
            // One that waits for another fill does not go first: so none waits, round about, for itself.
            let waits =
                |side: &FillSide| side.planes.is_some_and(|beside| self.document.fills.contains_key(&beside));
            let is_free = !self.leaning.contains(&at.0) && !self.leaning.contains(other);
            let can = is_free && low < high && high >= of_curve + FREE;
            (can && !self.document.fills.get(&first)?.sides.iter().any(waits)).then_some((*at, first))
        };
        self.pairs.iter().filter_map(first).collect()
    }
}

//! What is shown over one surface: its triangles, cut at the feet, with the offsets added.

use super::base::Base;
use super::footing::{Cut, Spot};
use super::normal;
use super::request::{items_of, settings};
use ductile_patch::{DisplacementError, Displacements, Domain, Range};
use ductile_spec::{Displaced, Displacement, Hold};
use glam::DVec3;

/// Part of a surface's radius by which it may have moved before blends are reckoned from its new shape: a document keeps
/// places no better.
const DRIFT: f64 = 1e-6;

/// A displaced surface.
#[derive(Clone, Debug)]
pub(crate) struct Overlay {
    /// Names what is shown, for frames.
    pub(crate) revision: u64,
    asked: Displaced,
    /// The connectivity of the base for which it was made, and the shape from which the blends were reckoned.
    source: u64,
    reckoned_on: Vec<DVec3>,
    solver: Displacements,
    /// Where the places of feet and pins are on the base, in order.
    anchors: Vec<Spot>,
    /// What stands behind each item of the solver.
    feet: Vec<Standing>,
    failures: Vec<(usize, DisplacementError)>,
    cut: Cut,
    offsets: Vec<DVec3>,
    /// The base, with a vertex at each foot, and what is shown of it.
    below: Vec<DVec3>,
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
}

/// An item of the solver.
#[derive(Clone, Copy, Debug)]
struct Standing {
    /// Index of its displacement.
    index: usize,
    /// Where it stands; a curve stands at vertices.
    spot: Option<Spot>,
    /// The vertex of the base at which it stands, if it does: of a curve the first.
    vertex: u32,
}

impl Overlay {
    /// Displaces a base; feet and pins stand at `places` if they are not where the document has them. A displacement that
    /// cannot be met is left out and told in [`Self::failures`].
    pub(super) fn new(
        asked: &Displaced,
        base: &Base<'_>,
        places: Option<&[DVec3]>,
        revision: u64,
    ) -> Result<Self, DisplacementError> {
        let documented: Vec<DVec3> = asked.clone().places_mut().map(|at| *at).collect();
        let stand = |at: &DVec3| Spot::nearest(base.positions, base.triangles, *at);
        let anchors: Option<Vec<Spot>> = places.unwrap_or(&documented).iter().map(stand).collect();
        let anchors = anchors.ok_or(DisplacementError::BadPosition(0))?;
        let feet = asked.items.iter().map(|item| item.foot.places().len()).sum();
        let domain = Domain::new(base.positions, base.triangles)?;
        let domain = domain.with_pins(&pinned(asked, base, anchors.get(feet..).unwrap_or_default()))?;
        let mut new = Self {
            revision,
            asked: asked.clone(),
            source: base.revision,
            reckoned_on: base.positions.to_vec(),
            solver: Displacements::new(domain, settings(&asked.blending))?,
            anchors,
            feet: Vec::new(),
            failures: Vec::new(),
            cut: Cut::default(),
            offsets: Vec::new(),
            below: Vec::new(),
            positions: Vec::new(),
            normals: Vec::new(),
        };
        let mut first = 0;
        for (index, item) in asked.items.iter().enumerate() {
            let count = item.foot.places().len();
            let spots = new.anchors[first..first + count].to_vec();
            if let Err(reason) = new.add(index, item, &spots, base) {
                new.failures.push((index, reason));
            }
            first += count;
        }
        new.cut(base);
        new.sum(base)?;
        Ok(new)
    }

    /// Adds all feet of a displacement, or none.
    fn add(
        &mut self,
        index: usize,
        item: &Displacement,
        spots: &[Spot],
        base: &Base<'_>,
    ) -> Result<(), DisplacementError> {
        let before = self.feet.len();
        for (spot, item) in items_of(item, spots, base)? {
            let first = spot.map_or(item.vertices()[0], |spot| spot.nearest_corner());
            if let Err(reason) = self.solver.add(item) {
                while self.feet.len() > before {
                    self.feet.pop();
                    self.solver.remove(self.feet.len())?;
                }
                return Err(reason);
            }
            self.feet.push(Standing { index, spot, vertex: u32::try_from(first).unwrap_or(0) });
        }
        Ok(())
    }

    fn cut(&mut self, base: &Base<'_>) {
        let spots: Vec<Option<Spot>> = self.feet.iter().map(|foot| foot.spot).collect();
        self.cut = Cut::new(base, &spots);
    }

    /// Reckons the offsets, and shows them.
    fn sum(&mut self, base: &Base<'_>) -> Result<(), DisplacementError> {
        self.offsets = self.solver.offsets()?;
        self.show(base);
        Ok(())
    }

    /// Adds the offsets to the base as it is now.
    pub(super) fn show(&mut self, base: &Base<'_>) {
        let mut offsets = self.offsets.clone();
        let mut normals = base.normals.to_vec();
        self.below.clear();
        self.below.extend_from_slice(base.positions);
        for made in &self.cut.made {
            self.below.push(made.of(base.positions));
            normals.push(made.of(base.normals).normalize_or_zero());
            offsets.push(made.of(&self.offsets));
        }
        for (item, (foot, &vertex)) in self.feet.iter().zip(&self.cut.at).enumerate() {
            if let (Some(spot), Ok(offset)) = (foot.spot, self.solver.foot_offset(item, &self.offsets)) {
                self.below[vertex as usize] = spot.of(base.positions);
                offsets[vertex as usize] = offset;
            }
        }
        self.normals = normal::turned(&self.below, &normals, &offsets, &self.cut.triangles);
        self.positions = self.below.iter().zip(&offsets).map(|(at, offset)| *at + *offset).collect();
    }

    /// Whether it was made for the connectivity that a base has.
    pub(super) fn is_on(&self, base: &Base<'_>) -> bool {
        self.source == base.revision
    }

    /// Whether its blends are those of another shape, or feet stand elsewhere than the document has them.
    pub(super) fn is_outdated(&self, asked: &Displaced, base: &Base<'_>) -> bool {
        let least = DRIFT * base.radius();
        let is_far = |a: DVec3, b: DVec3| a.distance_squared(b) > least * least;
        let mut pairs = self.reckoned_on.iter().zip(base.positions);
        if pairs.any(|(before, now)| is_far(*before, *now)) {
            return true;
        }
        let places: Vec<DVec3> = asked.clone().places_mut().map(|at| *at).collect();
        // Another number of them is not outdated but changed.
        places.len() == self.anchors.len()
            && self.anchors.iter().zip(places).any(|(anchor, at)| {
                let now = Spot::nearest(base.positions, base.triangles, at);
                now.is_some_and(|now| is_far(now.of(base.positions), anchor.of(base.positions)))
            })
    }

    /// Brings it up to what is asked and to the base, where it is, without reckoning the surface anew. Returns whether that
    /// could be done.
    pub(super) fn adjust(
        &mut self,
        asked: &Displaced,
        base: &Base<'_>,
        revision: &mut impl FnMut() -> u64,
    ) -> bool {
        if *asked == self.asked {
            if self.below.get(..base.positions.len()) != Some(base.positions) {
                self.show(base);
            }
            return true;
        }
        let count = self.feet.len();
        let is_done = self.failures.is_empty() && self.change(asked, base).is_some();
        if !is_done {
            return false;
        }
        self.asked = asked.clone();
        if self.feet.len() != count {
            self.cut(base);
            self.revision = revision();
        }
        self.sum(base).is_ok()
    }

    /// Changes ranges and displacements, appends one item or takes one away. Nothing if it is something else.
    fn change(&mut self, asked: &Displaced, base: &Base<'_>) -> Option<()> {
        if asked.blending.pins != self.asked.blending.pins {
            return None;
        }
        if asked.blending != self.asked.blending {
            self.solver.set_settings(settings(&asked.blending)).ok()?;
        }
        let (before, now) = (self.asked.items.clone(), &asked.items);
        if now.len() + 1 == before.len() {
            let gone = before.iter().zip(now).take_while(|(a, b)| a == b).count();
            return (before[gone + 1..] == now[gone..]).then(|| self.erase(gone)).flatten();
        }
        if now.len() < before.len() || now.len() > before.len() + 1 {
            return None;
        }
        for (index, (before, now)) in before.iter().zip(now).enumerate().filter(|(_, (a, b))| a != b) {
            if (&before.foot, before.direction) != (&now.foot, now.direction) {
                return None;
            }
            let range = Range::new(now.range).ok()?;
            for item in (0..self.feet.len()).filter(|&item| self.feet[item].index == index) {
                if before.range != now.range {
                    self.solver.set_range(item, range).ok()?;
                }
                self.solver.set_displacement(item, &[now.by]).ok()?;
            }
        }
        let Some(new) = now.get(before.len()) else { return Some(()) };
        let stand = |at: &DVec3| Spot::nearest(base.positions, base.triangles, *at);
        let spots: Vec<Spot> = new.foot.places().iter().map(stand).collect::<Option<_>>()?;
        self.add(before.len(), new, &spots, base).ok()?;
        let feet: usize = before.iter().map(|item| item.foot.places().len()).sum();
        self.anchors.splice(feet..feet, spots);
        Some(())
    }

    fn erase(&mut self, gone: usize) -> Option<()> {
        let first = self.feet.iter().position(|foot| foot.index == gone)?;
        while self.feet.get(first).is_some_and(|foot| foot.index == gone) {
            self.solver.remove(first).ok()?;
            self.feet.remove(first);
        }
        self.feet[first..].iter_mut().for_each(|foot| foot.index -= 1);
        let places =
            |items: &[Displacement]| items.iter().map(|item| item.foot.places().len()).sum::<usize>();
        let before = places(&self.asked.items[..gone]);
        self.anchors.drain(before..before + self.asked.items[gone].foot.places().len());
        Some(())
    }

    /// Where the places of feet and pins are now, if they are the places that are asked for.
    pub(super) fn carried(&self, asked: &Displaced) -> Option<Vec<DVec3>> {
        let places = |displaced: &Displaced| displaced.clone().places_mut().map(|at| *at).collect::<Vec<_>>();
        (places(asked) == places(&self.asked)).then(|| self.footprints())
    }

    /// Where the places of feet and pins are on the base, as it was shown last.
    pub(super) fn footprints(&self) -> Vec<DVec3> {
        self.footprints_on(&self.below)
    }

    /// The same on other positions of the base.
    pub(super) fn footprints_on(&self, positions: &[DVec3]) -> Vec<DVec3> {
        self.anchors.iter().map(|spot| spot.of(positions)).collect()
    }

    /// Whether what is asked for differs in places only.
    pub(super) fn is_alike(&self, asked: &Displaced) -> bool {
        let (mut own, mut other) = (self.asked.clone(), asked.clone());
        own.places_mut().zip(other.places_mut()).for_each(|(own, other)| *own = *other);
        own == *asked
    }

    /// The document has other places for what stands here: the act that moved the base carried them along.
    pub(super) fn adopt(&mut self, asked: &Displaced) {
        self.asked.clone_from(asked);
    }

    /// The blend that an item would have.
    pub(super) fn trial(&mut self, item: ductile_patch::Item) -> Result<Vec<f64>, DisplacementError> {
        self.solver.trial(item)
    }

    /// The displacements that cannot be met, by index, and why.
    pub(super) fn failures(&self) -> &[(usize, DisplacementError)] {
        &self.failures
    }

    /// The place of the base under a place of what is shown.
    pub(super) fn on_base(&self, at: DVec3) -> DVec3 {
        let spot = Spot::nearest(&self.positions, &self.cut.triangles, at);
        spot.map_or(at, |spot| at - (spot.of(&self.positions) - spot.of(&self.below)))
    }

    /// Where the first foot of a displacement stands on the base, and by how much the others move it there.
    pub(crate) fn foot(&self, index: usize) -> Option<(DVec3, DVec3)> {
        let item = self.feet.iter().position(|foot| foot.index == index)?;
        let vertex = self.vertex(item);
        let by = self.asked.items.get(index)?.by;
        let (below, shown) = (self.below[vertex], self.positions[vertex]);
        Some((below, shown - below - by))
    }

    /// The feet that are shown: index of the displacement and vertex; of a curve all its vertices, in order.
    pub(crate) fn feet(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.feet.iter().zip(self.solver.items()).enumerate().flat_map(|(item, (foot, solved))| {
            let at = self.vertex(item);
            let place = foot.spot.map(|_| at);
            let course = solved.vertices().iter().copied().filter(move |_| place.is_none());
            place.into_iter().chain(course).map(|vertex| (foot.index, vertex))
        })
    }

    fn vertex(&self, item: usize) -> usize {
        let foot = &self.feet[item];
        if foot.spot.is_some() { self.cut.at[item] as usize } else { foot.vertex as usize }
    }

    /// Where the vertices are.
    pub(crate) fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Unit normals at the vertices.
    pub(crate) fn normals(&self) -> &[DVec3] {
        &self.normals
    }

    /// Corners of the triangles.
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        &self.cut.triangles
    }

    /// How many triangles the base has.
    pub(crate) fn base_triangles(&self) -> usize {
        self.cut.base_triangles()
    }

    /// Of each triangle the one of the base in which it lies.
    pub(crate) fn parents(&self) -> &[u32] {
        &self.cut.parents
    }
}

/// The vertices that stay: around the places of pins and along curves.
pub(super) fn pinned(asked: &Displaced, base: &Base<'_>, anchors: &[Spot]) -> Vec<usize> {
    let mut held = Vec::new();
    let mut anchors = anchors.iter();
    for pin in &asked.blending.pins {
        match pin {
            Hold::Around { radius, .. } => {
                let Some(spot) = anchors.next() else { continue };
                let at = spot.of(base.positions);
                held.push(spot.nearest_corner());
                held.extend((0..base.positions.len()).filter(|&v| base.positions[v].distance(at) <= *radius));
            }
            Hold::Curve(curve) => {
                held.extend(base.along(*curve).map(|(vertices, _)| vertices).unwrap_or_default())
            }
        }
    }
    held
}

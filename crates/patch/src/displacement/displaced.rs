//! Displacements of a surface, kept with what was expensive about them: dragging one, or its range, costs the blend
//! alone; another foot costs one back-substitution.
//!
//! Source: P. Salvi, *Editing the interior of arbitrary surfaces using C∞ displacement blends*, eq. (1) and (11):
//! vertices move by `Σ d_j B_j` with `B = f ∘ R ∘ H`. All of `H` is kept as `ln ρ`, `ρ = 1 - H`: then `R` is one exponential.

use super::blend::{Blend, BlendFunction, Range};
use super::combine::{self, Combination, MOST_ITEMS, Pairwise, Seen};
use super::domain::Domain;
use super::error::DisplacementError;
use super::green::Green;
use super::item::{self, Item};
use super::laplacian::{Direction, Laplacian, Stiffness};
use super::reach::{Profile, Reach};
use glam::DVec3;
use std::collections::BTreeMap;

/// What all displacements of a surface have in common.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// On which triangles.
    pub laplacian: Laplacian,
    /// From Green's function to `H`. Curves are the same under both.
    pub profile: Profile,
    /// How several are met.
    pub combination: Combination,
    /// The step `f`.
    pub blend: Blend,
}

/// What became of an item.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ItemReport {
    /// By how much its vertex moved, or the first one of a curve.
    pub offset: DVec3,
    /// The least and the largest value of its blend at vertices that are not held.
    pub least: f64,
    /// See `least`.
    pub largest: f64,
    /// The largest value of its blend at vertices beside held ones.
    pub beside_held: f64,
}

impl ItemReport {
    /// Above this beside the boundary the mesh does not resolve the band in which the blend vanishes: derivatives across
    /// the boundary will show it. Use a smaller range or a finer mesh.
    pub const SENSIBLE_BESIDE_HELD: f64 = 1e-3;

    /// Whether the blend is larger beside the boundary than is sensible.
    #[must_use]
    pub fn is_cut_off(&self) -> bool {
        self.beside_held > Self::SENSIBLE_BESIDE_HELD
    }
}

/// A surface with its displacements.
#[derive(Clone, Debug)]
pub struct Displacements {
    domain: Domain,
    settings: Settings,
    function: BlendFunction,
    operators: Vec<(Option<Direction>, Green)>,
    reaches: Vec<Reach>,
    /// What the items owe to one another under `pairwise`; nothing under the others.
    pairwise: Pairwise,
    /// The inverse for `gram`, until a range changes.
    gram: Option<Vec<Vec<f64>>>,
}

impl Displacements {
    /// A surface without displacements.
    ///
    /// # Errors
    /// A parameter of the blend, triangles without area, or triangles too bad to be solved on.
    pub fn new(domain: Domain, settings: Settings) -> Result<Self, DisplacementError> {
        let function = BlendFunction::new(settings.blend)?;
        let mut new = Self {
            domain,
            settings,
            function,
            operators: Vec::new(),
            reaches: Vec::new(),
            pairwise: Pairwise::default(),
            gram: None,
        };
        new.operator(None)?;
        Ok(new)
    }

    /// Adds an item and gives its index. A failure leaves everything as it was.
    ///
    /// # Errors
    /// What [`DisplacementError`] says of feet, curves and combinations.
    pub fn add(&mut self, item: Item) -> Result<usize, DisplacementError> {
        if self.reaches.len() >= MOST_ITEMS {
            return Err(DisplacementError::TooMany(MOST_ITEMS));
        }
        let index = self.reaches.len();
        let reach = self.reach(item, index)?;
        self.reaches.push(reach);
        let outcome = self.combine(true);
        if outcome.is_err() {
            self.reaches.pop();
        }
        outcome.map(|()| index)
    }

    /// The blend that an item would have by itself, which is not added.
    ///
    /// # Errors
    /// As [`Self::add`].
    pub fn trial(&mut self, item: Item) -> Result<Vec<f64>, DisplacementError> {
        let index = self.reaches.len();
        self.reach(item, index).map(|reach| reach.blend)
    }

    /// Takes an item away; those after it move up.
    ///
    /// # Errors
    /// [`DisplacementError::NoItem`].
    pub fn remove(&mut self, index: usize) -> Result<(), DisplacementError> {
        self.get(index)?;
        let reach = self.reaches.remove(index);
        let outcome = self.combine(false);
        if outcome.is_err() {
            self.reaches.insert(index, reach);
        }
        outcome
    }

    /// Puts another item in the place of one.
    ///
    /// # Errors
    /// As [`Self::add`].
    pub fn set(&mut self, index: usize, item: Item) -> Result<(), DisplacementError> {
        self.get(index)?;
        let reach = self.reach(item, index)?;
        let before = core::mem::replace(&mut self.reaches[index], reach);
        let outcome = self.combine(false);
        if outcome.is_err() {
            self.reaches[index] = before;
        }
        outcome
    }

    /// Changes what an item has in common with the others, without a solve unless the Laplacian changes.
    ///
    /// # Errors
    /// As [`Self::new`] and [`Self::add`].
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), DisplacementError> {
        let mut new = if settings.laplacian == self.settings.laplacian {
            let function = BlendFunction::new(settings.blend)?;
            Self { settings, function, ..self.clone() }
        } else {
            let mut new = Self::new(self.domain.clone(), settings)?;
            for (index, reach) in self.reaches.iter().enumerate() {
                let reach = new.reach(reach.item.clone(), index)?;
                new.reaches.push(reach);
            }
            new
        };
        for reach in &mut new.reaches {
            reach.profile(settings.profile);
            reach.refresh_blend(&new.function);
        }
        new.combine(false)?;
        *self = new;
        Ok(())
    }

    /// Drags an item: one displacement, or one per vertex of a curve. No solve but, where a curve's displacements vary, two
    /// triangular ones per coordinate.
    ///
    /// # Errors
    /// [`DisplacementError::NoItem`], [`DisplacementError::Length`], [`DisplacementError::BadDisplacement`].
    pub fn set_displacement(
        &mut self,
        index: usize,
        displacements: &[DVec3],
    ) -> Result<(), DisplacementError> {
        let vertices = self.get(index)?.item.room();
        item::check_displacements(displacements, vertices)?;
        item::check_finite(index, displacements)?;
        let stiffness = &self.operators[self.reaches[index].operator].1.stiffness;
        let reach = &mut self.reaches[index];
        let before = core::mem::replace(&mut reach.item.displacements, displacements.to_vec());
        let outcome = reach.refresh_field(stiffness);
        if outcome.is_err() {
            reach.item.displacements = before;
        }
        outcome
    }

    /// Changes the range of an item: its blend is evaluated anew, nothing else.
    ///
    /// # Errors
    /// [`DisplacementError::NoItem`].
    pub fn set_range(&mut self, index: usize, range: Range) -> Result<(), DisplacementError> {
        self.get(index)?;
        self.gram = None;
        let reach = &mut self.reaches[index];
        reach.item.range = range;
        reach.refresh_blend(&self.function);
        self.refresh_shares(|other| other == index);
        Ok(())
    }

    /// By how much every vertex moves, in units of the surface: exactly 0 where vertices are held.
    ///
    /// # Errors
    /// [`DisplacementError::IllConditioned`], under `gram` only.
    pub fn offsets(&mut self) -> Result<Vec<DVec3>, DisplacementError> {
        let asked = self.amounts()?;
        let mut offsets = vec![DVec3::ZERO; self.domain.len()];
        for (reach, amount) in self.reaches.iter().zip(asked) {
            match &reach.field {
                None => {
                    offsets
                        .iter_mut()
                        .zip(&reach.share)
                        .for_each(|(offset, &share)| *offset += amount * share);
                }
                Some(field) => {
                    let varying = reach.share.iter().zip(field);
                    offsets.iter_mut().zip(varying).for_each(|(offset, (&share, &d))| *offset += d * share);
                }
            }
        }
        Ok(offsets)
    }

    /// What became of every item, given the offsets.
    #[must_use]
    pub fn reports(&self, offsets: &[DVec3]) -> Vec<ItemReport> {
        let beside = self.domain.beside_held();
        let held = self.domain.held();
        let report = |reach: &Reach| {
            let free = || reach.blend.iter().zip(held).filter(|(_, held)| !**held).map(|(blend, _)| *blend);
            let near = reach.blend.iter().zip(&beside).filter(|(_, near)| **near).map(|(blend, _)| *blend);
            ItemReport {
                offset: self.offset_at_foot(reach, offsets),
                least: free().fold(1.0, f64::min),
                largest: free().fold(0.0, f64::max),
                beside_held: near.fold(0.0, f64::max),
            }
        };
        self.reaches.iter().map(report).collect()
    }

    /// By how much the foot of an item moves, or the first vertex of a curve, given the offsets of the vertices.
    ///
    /// # Errors
    /// [`DisplacementError::NoItem`].
    pub fn foot_offset(&self, index: usize, offsets: &[DVec3]) -> Result<DVec3, DisplacementError> {
        self.get(index).map(|reach| self.offset_at_foot(reach, offsets))
    }

    fn offset_at_foot(&self, reach: &Reach, offsets: &[DVec3]) -> DVec3 {
        match reach.item.met().first() {
            Some(&vertex) => offsets[vertex],
            None if self.settings.combination == Combination::Plain => {
                let others = self.reaches.iter().filter(|other| !core::ptr::eq(*other, reach));
                let drags = others.map(|other| {
                    // A field that varies is smooth: linear will do.
                    let d = match &other.field {
                        None => other.item.displacements[0],
                        Some(field) => reach.item.load().map(|(v, share)| field[v] * share).sum(),
                    };
                    d * other.blend_at(&reach.item, &self.function)
                });
                reach.item.displacements[0] + drags.sum::<DVec3>()
            }
            None => reach.item.displacements[0],
        }
    }

    /// The items.
    pub fn items(&self) -> impl ExactSizeIterator<Item = &Item> {
        self.reaches.iter().map(|reach| &reach.item)
    }

    /// The surface.
    #[must_use]
    pub fn domain(&self) -> &Domain {
        &self.domain
    }

    /// The blend `B` of an item at every vertex, in [0, 1].
    ///
    /// # Errors
    /// [`DisplacementError::NoItem`].
    pub fn blend(&self, index: usize) -> Result<&[f64], DisplacementError> {
        Ok(&self.get(index)?.blend)
    }

    /// `ln ρ` of an item at every vertex: 0 at the border, minus infinity at the foot. To evaluate between vertices,
    /// interpolate `ρ` linearly and blend after that.
    ///
    /// # Errors
    /// [`DisplacementError::NoItem`].
    pub fn logarithm(&self, index: usize) -> Result<&[f64], DisplacementError> {
        Ok(&self.get(index)?.logarithm)
    }

    /// Green's function of a foot, or the harmonic function of a curve, at every vertex, as it was solved.
    ///
    /// # Errors
    /// [`DisplacementError::NoItem`].
    pub fn solution(&self, index: usize) -> Result<&[f64], DisplacementError> {
        Ok(&self.get(index)?.harmonic)
    }

    fn get(&self, index: usize) -> Result<&Reach, DisplacementError> {
        self.reaches.get(index).ok_or(DisplacementError::NoItem(index))
    }

    /// The factorised operator for a direction, made when it is first asked for.
    fn operator(&mut self, direction: Option<Direction>) -> Result<usize, DisplacementError> {
        if let Some(known) = self.operators.iter().position(|(other, _)| *other == direction) {
            return Ok(known);
        }
        let stiffness = Stiffness::new(&self.domain, self.settings.laplacian, direction)?;
        self.operators.push((direction, Green::new(&self.domain, stiffness)?));
        Ok(self.operators.len() - 1)
    }

    fn reach(&mut self, item: Item, index: usize) -> Result<Reach, DisplacementError> {
        item.check(index, &self.domain)?;
        let operator = self.operator(item.direction)?;
        let green = &mut self.operators[operator].1;
        let (part, _) = green.part_of(&item)?;
        let harmonic =
            if item.is_curve() { green.capacity(&item.vertices)? } else { green.function(&item)? };
        let mut reach = Reach::new(item, operator, part, harmonic);
        reach.profile(self.settings.profile);
        reach.refresh_blend(&self.function);
        reach.refresh_field(&self.operators[operator].1.stiffness)?;
        Ok(reach)
    }

    /// Gives the items what they owe to one another; what is known of the first ones may still hold. Refuses before it changes
    /// anything.
    fn combine(&mut self, is_known: bool) -> Result<(), DisplacementError> {
        self.check_apart()?;
        if !is_known {
            self.pairwise = Pairwise::default();
        }
        let reaches = &mut self.reaches;
        if self.settings.combination == Combination::Cardinal {
            let feet: Vec<usize> = reaches.iter().map(|reach| reach.item.vertices[0]).collect();
            let greens: Vec<&[f64]> = reaches.iter().map(|reach| reach.harmonic.as_slice()).collect();
            let functions = combine::cardinal(&greens, &feet)?;
            for (reach, function) in reaches.iter_mut().zip(functions) {
                reach.logarithm = function.iter().map(|h| libm::log1p(-h)).collect();
                reach.refresh_blend(&self.function);
            }
        }
        if self.settings.combination == Combination::Pairwise {
            let items: Vec<Seen<'_>> = reaches.iter().map(Reach::seen).collect();
            for count in self.pairwise.len()..items.len() {
                self.pairwise.append(&items[..=count], &self.function);
            }
        }
        self.refresh_shares(|_| true);
        self.gram = None;
        Ok(())
    }

    /// Makes the shares of some items from their blends and the weights of the combination.
    fn refresh_shares(&mut self, wanted: impl Fn(usize) -> bool) {
        let parts: Vec<u32> = self.reaches.iter().map(|reach| reach.part).collect();
        let mut sums: BTreeMap<u32, Vec<f64>> = BTreeMap::new();
        for (index, reach) in self.reaches.iter_mut().enumerate().filter(|(index, _)| wanted(*index)) {
            let Some(products) = self.pairwise.of(index) else {
                reach.share.clone_from(&reach.blend);
                continue;
            };
            let sum = sums.entry(reach.part).or_insert_with(|| self.pairwise.sum(&parts, reach.part));
            let weights = products.iter().zip(sum).map(|(product, sum)| product / *sum);
            reach.share = reach.blend.iter().zip(weights).map(|(blend, weight)| blend * weight).collect();
        }
    }

    /// Whether these items can be combined as the settings ask.
    fn check_apart(&self) -> Result<(), DisplacementError> {
        let (combination, reaches) = (self.settings.combination, &self.reaches);
        if combination == Combination::Plain {
            return Ok(());
        }
        let mut owner = vec![None; self.domain.len()];
        for (index, reach) in reaches.iter().enumerate() {
            if combination != Combination::Pairwise && reach.item.is_curve() {
                return Err(DisplacementError::CurveNotCombined(index));
            }
            if combination != Combination::Pairwise && reach.item.shares.is_some() {
                return Err(DisplacementError::SpotNotCombined(index));
            }
            let is_same = |other: &Reach| {
                let item = &other.item;
                item.shares.is_some()
                    && (&item.vertices, item.shares) == (&reach.item.vertices, reach.item.shares)
            };
            if let Some(other) = reaches[..index].iter().position(is_same) {
                return Err(DisplacementError::Touching(other, index, reach.item.vertices[0]));
            }
            if combination == Combination::Cardinal && reach.operator != reaches[0].operator {
                return Err(DisplacementError::MixedDirections(index));
            }
            for &vertex in reach.item.met() {
                if let Some(other) = owner[vertex].replace(index) {
                    return Err(DisplacementError::Touching(other, index, vertex));
                }
            }
        }
        Ok(())
    }

    /// What each item is multiplied with: its displacement, or what `gram` makes of all of them.
    fn amounts(&mut self) -> Result<Vec<DVec3>, DisplacementError> {
        let asked: Vec<DVec3> = self.reaches.iter().map(|reach| reach.item.displacements[0]).collect();
        if self.settings.combination != Combination::Gram {
            return Ok(asked);
        }
        let inverse = match self.gram.take() {
            Some(inverse) => inverse,
            None => {
                let blends: Vec<&[f64]> = self.reaches.iter().map(|reach| reach.blend.as_slice()).collect();
                let feet: Vec<usize> = self.reaches.iter().map(|reach| reach.item.vertices[0]).collect();
                combine::gram(&blends, &feet)?
            }
        };
        let row = |row: &Vec<f64>| row.iter().zip(&asked).map(|(&x, &d)| d * x).sum();
        let amounts = inverse.iter().map(row).collect();
        self.gram = Some(inverse);
        Ok(amounts)
    }
}

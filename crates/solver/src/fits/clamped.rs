//! The part of a sweep for nodes whose tangent plane is prescribed: one by one, after a plain fit with care, which says
//! how large the neighbourhood is, whether it is folded, and where it would have the plane.

use super::{Fits, Sweep, Wanted, scatter};
use crate::barrier;
use crate::batch::Batch;
use crate::clamp::{self, Clamp};
use crate::energy::thin_plate::{self, Demand};
use crate::fit::CarefulFit;
use crate::lanes::Vector;
use crate::objective::Goals;
use crate::rings::Rings;

/// Whether a node of a batch has a prescribed plane.
pub(super) fn has_plane(goals: &Goals, batch: &Batch) -> bool {
    batch.nodes.iter().any(|&node| goals.plane(node as usize).is_some())
}

impl Fits {
    /// One node whose tangent plane is prescribed; its ring is loaded and fitted. The barrier stays that of the plain fit.
    pub(super) fn fit_clamped(
        &mut self,
        rings: &Rings,
        batch: &Batch,
        lane: usize,
        careful: &CarefulFit,
        place: usize,
        sweep: &mut Sweep<'_>,
    ) {
        let Some(plane) = sweep.goals.planes.as_ref().map(|planes| planes.list()[place]) else { return };
        let (index, ring) = (batch.nodes[lane], &sweep.single);
        let (node, normal) = (index as usize, plane.normal());
        let clamp = Clamp::new(ring, &careful.fit, normal);
        let price = sweep.goals.price(node);
        let fold = barrier::value(careful.fit.jacobian);
        (self.nodes[node].normal, self.nodes[node].l) = (normal, clamp.l());
        self.energies[node] = clamp.value(price.rows(), price.rows()) + fold;
        self.keep(rings, node, 0, ring, true);
        self.clamps[place] = clamp;
        if sweep.wanted < Wanted::Rows {
            return;
        }
        let rows = &mut self.rows[batch.rows()];
        clamp.write_rows(|j, c, value| rows[j][c][lane] = value);
        if sweep.wanted < Wanted::Gradient {
            return;
        }
        let demand = clamp::Demand {
            plate: price.plate,
            tilt: price.plate,
            variation: price.variation * self.variation.as_ref().map_or(0.0, |variation| variation.scale),
            bending: self.bending::<f64>([index; 2]).unwrap_or_default(),
        };
        let turning = self.turning::<f64>(rings, [index; 2]);
        sweep.single_back.run_clamped(ring, careful, &clamp, normal, &demand, turning.as_ref());
        let mut hand_on = |chords: &[Vector<f64>]| {
            scatter(&mut self.gradient, rings.ring(node), index, chords.iter().map(|bar| bar.lane(0)));
        };
        hand_on(&sweep.single_back.chords);
        let slope = barrier::slope(careful.fit.jacobian);
        if slope != 0.0 && careful.is_fitted() {
            let zero = Demand { weight: 0.0, bending: [0.0; 3], slope };
            let adjoint = thin_plate::adjoint(&careful.fit, ring.h, &zero);
            sweep.single_back.run_carefully(ring, careful, &adjoint, None);
            hand_on(&sweep.single_back.chords);
        }
    }
}

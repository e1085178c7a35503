//! Control curves through the one door: what they minimise.

use acceptance::Bench;
use ductile_spec::{CurveId, Edit, Example, Objective, ObjectiveOf, Request};
use glam::DVec3;

const CURVE: CurveId = CurveId(1);

/// The samples of the first curve.
fn nodes(bench: &Bench) -> Vec<DVec3> {
    bench.modeler.model().curves[&CURVE].nodes.clone()
}

/// The largest distance of samples from a circle of radius 1 in the plane.
fn off_circle(bench: &Bench) -> f64 {
    nodes(bench).iter().map(|p| (p.truncate().length() - 1.0).abs().max(p.z.abs())).fold(0.0, f64::max)
}

#[test]
fn an_objective_makes_the_same_curve_by_an_act_as_from_a_file() {
    // Four points of a circle: what they hold is known for every objective.
    for (objective, low, high) in [
        (Objective::ThinPlate, 9.0e-3, 1.05e-2),
        (Objective::Fair, 0.0, 1e-4),
        (Objective::Neutral, 0.0, 5e-4),
        (Objective::Membrane, 0.28, 0.30),
    ] {
        let mut bench = Bench::with(Example::Disc);
        bench.rest(300);
        bench.edit(Edit::Objective { of: ObjectiveOf::Curve(CURVE), objective: Some(objective) });
        bench.rest(300);
        let off = off_circle(&bench);
        assert!((low..=high).contains(&off), "{objective:?}: {off}");
        let mut opened = Bench::new();
        opened.accept(Request::OpenText { text: bench.document.clone() });
        opened.rest(300);
        let again = off_circle(&opened);
        assert!((low..=high).contains(&again), "{objective:?}, opened: {again}");
        bench.accept(Request::Undo);
        bench.rest(300);
        assert!((9.0e-3..=1.05e-2).contains(&off_circle(&bench)), "{objective:?}, undone");
    }
}

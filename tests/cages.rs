//! Cages under any acts, in any order: each is done or refused whole, what is done can be opened again, taken back and done
//! again to the letter, and the surface runs through every vertex of its cage.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::dice::Dice;
use acceptance::round::Round;
use ductile_modeler::Model;
use ductile_spec::{
    CageBlend, CageForm, CageMap, CageSettings, CageSource, CageSplit, Edit, GrabTarget, PointId, Request,
    Step, SurfaceId,
};
use glam::DVec3;

/// A request about cages; now and then about one that is not there.
fn request(dice: &mut Dice, model: &Model) -> Request {
    let cages: Vec<SurfaceId> = model.document.cages.keys().copied().collect();
    let surface = dice.pick(&cages).filter(|_| dice.below(20) > 0).unwrap_or(SurfaceId(99));
    let points: Vec<PointId> = model.document.points.keys().copied().collect();
    let mut corner = || dice.pick(&points).unwrap_or(PointId(99));
    let (one, other) = (corner(), corner());
    let faces = model.document.cages.get(&surface).map_or(&[][..], |cage| &cage.faces);
    let face = dice.below(faces.len() + 1);
    let corners = faces.get(face).map_or(&[][..], |face| face);
    let [first, second] =
        if corners.is_empty() { [one, other] } else { [0; 2].map(|_| corners[dice.below(corners.len())]) };
    let (ends, face) = ([first, second], u32::try_from(face).unwrap());
    match dice.below(27) {
        0 => {
            let form = CageForm::ALL[dice.below(CageForm::ALL.len())];
            let from = CageSource::BuiltIn { form, centre: dice.vector(), size: 0.2 + dice.unit() };
            Request::Edit(Edit::Cage { from })
        }
        1..=4 => Request::Edit(Edit::Extrude { surface, face, distance: 0.6 * dice.unit() - 0.2 }),
        5..=6 => Request::Edit(Edit::DeleteFace { surface, face }),
        7..=9 => Request::Edit(Edit::SplitEdge { surface, ends, at: dice.unit() }),
        10..=11 => Request::Edit(Edit::SplitFace { surface, face, between: Some(ends) }),
        12 => Request::Edit(Edit::SplitFace { surface, face, between: None }),
        13 => {
            let split = [None, Some(CageSplit::None), Some(CageSplit::Linear), Some(CageSplit::CatmullClark)];
            let blend = [CageBlend::Erbs, CageBlend::Bump(1), CageBlend::Hermite(1)][dice.below(3)];
            let map = if dice.coin() { CageMap::Smooth } else { CageMap::Rational };
            let resolution = Some(u32::try_from(1 + dice.below(3)).unwrap());
            let split = split[dice.below(4)];
            let settings = CageSettings { split, blend, map, resolution, ..CageSettings::default() };
            Request::Edit(Edit::CageSettings { surface, settings })
        }
        14 => Request::Edit(Edit::Shift { points: vec![one, other], by: 0.2 * dice.vector() }),
        15 => Request::Edit(Edit::Move { point: one, to: dice.vector() }),
        16 => Request::Grab(GrabTarget::Face { surface, face, at: dice.vector() }),
        17 => Request::Grab(GrabTarget::Edge { surface, ends, at: dice.vector() }),
        18..=19 => Request::Step(Step { drag: Some(dice.vector()), iterations: 5 }),
        20..=21 => Request::Drop,
        24 => Request::Edit(Edit::Rim { surface, ends, between: None }),
        25..=26 => {
            // An edge at which the cage ends, if there is one.
            let rim = model.document.cages.get(&surface).map(|cage| cage.rim()).unwrap_or_default();
            let edges: Vec<[PointId; 2]> = rim.iter().map(|(from, edge)| [*from, edge.to]).collect();
            let edge = dice.pick(&edges).unwrap_or(ends);
            let between = dice.coin().then(|| [dice.pick(&edges).map_or(one, |edge| edge[0]), edge[1]]);
            Request::Edit(Edit::Rim { surface, ends: edge, between })
        }
        22 if dice.coin() => Request::Redo,
        22 => Request::Undo,
        _ if dice.below(8) == 0 => Request::Edit(Edit::DeleteSurface { surface }),
        _ => Request::Edit(Edit::DeletePoint { point: one }),
    }
}

/// The largest distance of a vertex of a cage from its surface.
fn farthest(model: &Model, surface: SurfaceId) -> f64 {
    let positions = model.patches[&surface].positions();
    let missed = |point: PointId| {
        let at = model.document.points[&point];
        positions.iter().map(|vertex| vertex.distance(at)).fold(f64::INFINITY, f64::min)
    };
    model.document.cages[&surface].points().into_iter().map(missed).fold(0.0, f64::max)
}

#[test]
fn any_acts_leave_cages_with_surfaces_through_their_vertices() {
    let (mut done, mut refused) = (0, 0);
    for seed in 0..40 {
        let mut dice = Dice::seeded(seed);
        let mut round = Round::new(r#"{"ductile":1,"points":{}}"#);
        let form = CageForm::ALL[dice.below(CageForm::ALL.len())];
        let from = CageSource::BuiltIn { form, centre: DVec3::ZERO, size: 1.0 };
        assert_eq!(round.ask(&Request::Edit(Edit::Cage { from })), None);
        for _ in 0..30 {
            let request = request(&mut dice, round.bench.modeler.model());
            match round.ask(&request) {
                None => done += 1,
                Some(_) => refused += 1,
            }
            let model = round.bench.modeler.model();
            assert!(round.bench.modeler.floats().iter().all(|x| x.is_finite()), "{request:?}");
            assert!(model.document.cages.keys().eq(model.patches.keys()), "{request:?}");
            for (id, cage) in &model.document.cages {
                if cage.split() != CageSplit::CatmullClark {
                    let missed = farthest(model, *id);
                    assert!(missed < 1e-12, "{request:?}: {id} misses a vertex by {missed:e}");
                }
            }
        }
        round.opens();
    }
    assert!(done > 500 && refused > 100, "{done} done, {refused} refused");
}

use glam::DVec3;

use super::*;
use crate::CurveSettings;
use crate::workload::Stream;
use proptest::prelude::*;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const TAU: f64 = std::f64::consts::TAU;

fn unit(vector: DVec3) -> DVec3 {
    vector.try_normalize().unwrap()
}

/// Curves with their positions.
struct Web {
    curves: Vec<(CurveSolver, Vec<DVec3>)>,
    network: Network,
}

impl Web {
    fn new(curves: Vec<(CurveSolver, Vec<DVec3>)>, hubs: &[Vec<(usize, u32)>]) -> Self {
        let spokes =
            |hub: &Vec<(usize, u32)>| hub.iter().map(|&(curve, node)| Spoke { curve, node }).collect();
        let hubs: Vec<Vec<Spoke>> = hubs.iter().map(spokes).collect();
        Self { curves, network: Network::new(&hubs).unwrap() }
    }

    fn step(&mut self) -> StepReport {
        let strands = self.curves.iter_mut().map(|(solver, positions)| Strand { solver, positions });
        self.network.step(&mut strands.collect::<Vec<_>>()).unwrap()
    }

    /// Steps until it rests; returns how many it took.
    fn relax(&mut self, limit: usize) -> usize {
        self.steps(limit).unwrap_or_else(|| panic!("not at rest after {limit} steps: {:?}", self.step()))
    }

    fn steps(&mut self, limit: usize) -> Option<usize> {
        let mut last = f64::INFINITY;
        for step in 1..=limit {
            let report = self.step();
            assert!(report.energy <= report.energy_before, "{report:?}");
            assert!(report.energy_before <= last * (1.0 + 1e-12), "{last} {report:?}");
            assert!(self.curves.iter().flat_map(|c| &c.1).all(|p| p.is_finite()));
            last = report.energy;
            if report.at_rest {
                return Some(step);
            }
        }
        None
    }

    /// Every curve by itself.
    fn settle_alone(&mut self) {
        for (solver, positions) in &mut self.curves {
            let mut last = StepReport::default();
            let rests = (0..200).any(|_| {
                last = solver.step(positions).unwrap();
                last.at_rest
            });
            assert!(rests, "{last:?}");
        }
    }

    fn energy(&self) -> f64 {
        self.curves.iter().map(|(solver, _)| solver.energy()).sum()
    }

    /// The tangent of a curve at a node and how far it points out of the plane of the other two.
    fn out_of_plane(&self, hub: [(usize, usize); 3]) -> f64 {
        let [a, b, c] = hub.map(|(curve, node)| self.curves[curve].0.tangents()[node]);
        a.dot(unit(b.cross(c))).abs()
    }
}

/// A meridian through both poles and two points of the equator, fixed there.
fn meridian(count: usize, longitude: f64, settings: CurveSettings) -> (CurveSolver, Vec<DVec3>) {
    let (y, x) = libm::sincos(longitude);
    let at = |i: usize| {
        let (height, out) =
            (libm::cos(TAU * i as f64 / count as f64), libm::sin(TAU * i as f64 / count as f64));
        DVec3::new(x * out, y * out, height)
    };
    let fixed = (0..count).map(|i| i % (count / 4) == 0).collect();
    (CurveSolver::new(count, true, fixed, settings).unwrap(), (0..count).map(at).collect())
}

/// An arch over the origin, which is fixed; its feet are at a distance of 1 and as deep as told.
fn arch(count: usize, longitude: f64, feet: [f64; 2], settings: CurveSettings) -> (CurveSolver, Vec<DVec3>) {
    let (y, x) = libm::sincos(longitude);
    let at = |i: usize| {
        let t = 2.0 * i as f64 / (count - 1) as f64 - 1.0;
        DVec3::new(x * t, y * t, t.abs() * if t < 0.0 { feet[0] } else { feet[1] })
    };
    let fixed = (0..count).map(|i| i % ((count - 1) / 2) == 0).collect();
    (CurveSolver::new(count, false, fixed, settings).unwrap(), (0..count).map(at).collect())
}

fn fair() -> CurveSettings {
    CurveSettings { objective: Objective::Fair, ..CurveSettings::default() }
}

/// Three arches that want to leave the hub steeply, each in another plane.
fn tripod(count: usize, settings: CurveSettings) -> Web {
    let feet = [[-0.6, 0.6], [0.2, 0.3], [0.5, -0.4]];
    let longitudes = [0.0, 1.0, 2.2];
    let arches = longitudes.into_iter().zip(feet).map(|(l, feet)| arch(count, l, feet, settings));
    let middle = u32::try_from(count / 2).unwrap();
    Web::new(arches.collect(), &[(0..3).map(|curve| (curve, middle)).collect()])
}

#[test]
fn meridians_of_a_sphere_agree_at_the_poles_and_stay_what_they_are_alone() {
    for settings in [CurveSettings::default(), fair()] {
        let count = 64;
        let meridians = || [0.0, 1.0, 2.0].map(|longitude| meridian(count, longitude, settings)).to_vec();
        let mut alone = Web::new(meridians(), &[]);
        alone.settle_alone();
        let poles = [0, 32].map(|node| (0..3).map(|curve| (curve, node)).collect());
        let mut together = Web::new(meridians(), &poles);
        let steps = together.relax(30);
        assert!(steps <= 8, "{steps}");
        // A clamp with a free tangent is a hinge, but for the turn within one edge: third order in the spacing.
        let energy = together.energy() / alone.energy() - 1.0;
        let apart = together.curves.iter().zip(&alone.curves).flat_map(|(a, b)| a.1.iter().zip(&b.1));
        let apart = apart.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(energy.abs() < 3e-5 && apart < 3e-5, "{energy} {apart}");
        assert!(together.network.normals().iter().all(|normal| normal.z.abs() > 1.0 - 1e-9));
    }
}

#[test]
fn tangents_that_do_not_agree_come_to_lie_in_one_plane() {
    for settings in [CurveSettings::default(), fair()] {
        for count in [41, 81] {
            let middle = count / 2;
            let hub = [0, 1, 2].map(|curve| (curve, middle));
            let mut web = tripod(count, settings);
            web.settle_alone();
            let before = (web.out_of_plane(hub), web.energy());
            let steps = web.relax(60);
            let after = (web.out_of_plane(hub), web.energy());
            assert!(before.0 > 0.1 && after.0 < 1e-12, "{before:?} {after:?}");
            assert!(after.1 > before.1 && steps <= 8, "{steps}");
            // The samples show it too, to the order of their spacing.
            let leave = |curve: usize| {
                let at = &web.curves[curve].1;
                unit(at[middle + 1] - at[middle - 1])
            };
            let seen = leave(0).dot(unit(leave(1).cross(leave(2)))).abs();
            assert!(seen < 0.5 / count as f64, "{seen}");
        }
    }
}

#[test]
fn two_curves_always_agree_and_make_no_hub() {
    let plate = CurveSettings::default();
    let pair = || vec![arch(41, 0.0, [-0.6, 0.6], plate), arch(41, 1.3, [0.2, 0.7], plate)];
    let mut web = Web::new(pair(), &[vec![(0, 20), (1, 20)]]);
    assert!(web.network.normals().is_empty());
    web.relax(40);
    let mut alone = Web::new(pair(), &[]);
    alone.settle_alone();
    for (curve, (_, positions)) in alone.curves.iter().enumerate() {
        let here = &web.curves[curve].1;
        let apart = here.iter().zip(positions).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        // The common node is a node of both; each is what it is alone, up to where it is called at rest.
        assert!(here[20] == DVec3::ZERO && apart < 1e-4, "{apart}");
    }
    // Whatever two tangents and two normal curvatures there are, one plane and one quadratic form have them.
    let [one, other] = [0, 1].map(|curve| &web.curves[curve].0);
    let (t1, t2) = (one.tangents()[20], other.tangents()[20]);
    let normal = unit(t1.cross(t2));
    assert!(normal.dot(t1).abs() < 1e-15 && normal.dot(t2).abs() < 1e-15);
    let kappa = [one, other].map(|curve| curve.curvatures()[20].dot(normal));
    // L = k1 u uᵀ + k2 v vᵀ with the dual basis u, v of the tangents.
    let across = t1.dot(t2);
    let dual = |a: DVec3, b: DVec3| (a - b * across) / (1.0 - across * across);
    let squared = |x: f64| x * x;
    let form = |t: DVec3| kappa[0] * squared(dual(t1, t2).dot(t)) + kappa[1] * squared(dual(t2, t1).dot(t));
    assert!((form(t1) - kappa[0]).abs() < 1e-12 && (form(t2) - kappa[1]).abs() < 1e-12);
}

/// What is left of a line at rest is rounding, of which no search can make less.
#[test]
fn a_straight_line_rests() {
    let (mut solver, mut positions) = arch(41, 0.3, [-0.6, 0.6], CurveSettings::default());
    assert!((0..10).any(|_| solver.step(&mut positions).unwrap().at_rest));
    assert_eq!(solver.damping, 1.0);
}

#[test]
fn a_prescribed_tangent_holds_the_plane_and_two_decide_it() {
    let count = 41;
    for given in 1..=2_usize {
        let mut web = tripod(count, CurveSettings::default());
        let wanted = [unit(DVec3::new(1.0, 0.0, 0.5)), unit(DVec3::new(0.5, 0.8, -0.3))];
        for curve in 0..given {
            web.curves[curve].0.set_tangents(&[(20, wanted[curve])]).unwrap();
        }
        web.relax(60);
        assert!(web.out_of_plane([(0, 20), (1, 20), (2, 20)]) < 1e-12);
        for curve in 0..given {
            assert!(web.curves[curve].0.tangents()[20].distance(wanted[curve]) < 1e-15);
        }
    }
}

#[test]
fn a_prescribed_plane_holds_any_number_of_curves_and_may_turn() {
    for settings in [CurveSettings::default(), fair()] {
        for count in 1..=3 {
            let mut web = tripod(41, settings);
            web.curves.truncate(count);
            web.settle_alone();
            let spokes: Vec<Spoke> = (0..count).map(|curve| Spoke { curve, node: 20 }).collect();
            let wanted = DVec3::new(0.3, -0.2, 2.0);
            web.network = Network::with_planes(&[(Vec::new(), None), (spokes, Some(wanted))]).unwrap();
            web.relax(60);
            let off = |web: &Web, normal: DVec3| {
                let tangents = web.curves.iter().map(|(solver, _)| solver.tangents()[20]);
                tangents.map(|tangent| tangent.dot(unit(normal)).abs()).fold(0.0, f64::max)
            };
            assert!(off(&web, wanted) < 1e-12, "{}", off(&web, wanted));
            let other = DVec3::new(-0.3, 0.4, 1.0);
            let turned = web.network.set_planes(&[Some(DVec3::X), Some(other)]);
            assert!((turned - unit(wanted).angle_between(unit(other))).abs() < 1e-12, "{turned}");
            assert!(web.network.set_planes(&[None, Some(-other)]) < 1e-12, "either sense is the same plane");
            web.relax(60);
            assert!(off(&web, other) < 1e-12, "{}", off(&web, other));
        }
    }
}

/// The derivative along a direction, hubs and all, against central differences.
#[test]
fn slope_of_a_direction_is_that_of_the_energy() {
    for settings in
        [CurveSettings::default(), fair(), CurveSettings { slack: 0.5, ..CurveSettings::default() }]
    {
        let mut web = tripod(21, settings);
        web.step();
        let mut stream = Stream::new(5);
        for (solver, positions) in &mut web.curves {
            for (position, _) in positions.iter_mut().zip(&solver.fixed).filter(|(_, fixed)| !**fixed) {
                *position += stream.vector() * 0.01;
            }
        }
        let network = &web.network;
        let mut strands: Vec<Strand<'_>> =
            web.curves.iter_mut().map(|(solver, positions)| Strand { solver, positions }).collect();
        measure(&network.hubs, &mut strands);
        let direction = network.direction(&mut strands, None).unwrap();
        let mut energy = |scale: f64| {
            let hub = network.hubs[0].turned(direction.tilts[0], &direction.turns[0], scale);
            let starts: Vec<Vec<DVec3>> = strands.iter().map(|strand| strand.positions.to_vec()).collect();
            for (strand, moves) in strands.iter_mut().zip(&direction.moves) {
                strand.positions.iter_mut().zip(moves).for_each(|(p, m)| *p += *m * scale);
            }
            let energy = measure(&[hub], &mut strands);
            for (strand, start) in strands.iter_mut().zip(starts) {
                strand.positions.copy_from_slice(&start);
            }
            energy
        };
        let step = 1e-6;
        let difference = (energy(step) - energy(-step)) / (2.0 * step);
        let exact = direction.slope;
        assert!(exact < 0.0 && (difference / exact - 1.0).abs() < 1e-6, "{difference} {exact}");
        // The turns stay in the plane as it tilts.
        for (rib, turn) in network.hubs[0].ribs.iter().zip(&direction.turns[0]) {
            let out = turn.dot(network.hubs[0].normal) + rib.tangent.dot(direction.tilts[0]);
            assert!(out.abs() < 1e-9 * (1.0 + turn.length()), "{out}");
        }
    }
}

#[test]
fn what_is_no_network_is_refused_with_its_offender() {
    let mut web = tripod(21, CurveSettings::default());
    let mut refused = |hub: Vec<Spoke>| {
        let mut network = Network::new(&[hub]).unwrap();
        let strands = web.curves.iter_mut().map(|(solver, positions)| Strand { solver, positions });
        network.step(&mut strands.collect::<Vec<_>>()).unwrap_err()
    };
    let spokes = |nodes: [u32; 3]| (0..3).zip(nodes).map(|(curve, node)| Spoke { curve, node }).collect();
    assert_eq!(refused(spokes([10, 10, 77])), SolverError::UnknownNode(77));
    assert_eq!(refused(spokes([10, 3, 10])), SolverError::NotFixed(3));
    assert_eq!(
        refused((3..6).map(|curve| Spoke { curve, node: 10 }).collect()),
        SolverError::UnknownNode(10)
    );
    let crowd: Vec<Spoke> = (0..300).map(|curve| Spoke { curve, node: 0 }).collect();
    assert_eq!(Network::new(&[crowd]).unwrap_err(), SolverError::TooManySpokes(300));
    let taut = CurveSettings { objective: Objective::Membrane, ..CurveSettings::default() };
    let mut web = tripod(21, taut);
    let strands = web.curves.iter_mut().map(|(solver, positions)| Strand { solver, positions });
    let error = web.network.step(&mut strands.collect::<Vec<_>>()).unwrap_err();
    assert_eq!(error, SolverError::NoPartInNetwork(0));
}

fn cases() -> ProptestConfig {
    ProptestConfig {
        cases: if cfg!(target_arch = "wasm32") { 6 } else { 48 },
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(cases())]
    #[test]
    fn random_networks_come_to_rest_and_never_cost_more(
        seed in 0_u64..1_000_000,
        curves in 3_usize..6,
        is_closed: bool,
        is_fair: bool,
    ) {
        let mut stream = Stream::new(seed);
        let settings = if is_fair { fair() } else { CurveSettings::default() };
        let count = 24;
        let ends = [stream.vector(), stream.vector()];
        let hubs = [0, 12].map(|node| (0..curves).map(|curve| (curve, node)).collect());
        let one = |stream: &mut Stream| {
            let corners = [ends[0], stream.vector(), ends[1], stream.vector()];
            let at = |i: usize| corners[i / 6].lerp(corners[(i / 6 + 1) % 4], (i % 6) as f64 / 6.0);
            let last = if is_closed { count } else { 19 };
            let fixed = (0..last).map(|i| i % 6 == 0).collect();
            let positions: Vec<DVec3> = (0..last).map(at).collect();
            (CurveSolver::new(last, is_closed, fixed, settings).unwrap(), positions)
        };
        let mut web = Web::new((0..curves).map(|_| one(&mut stream)).collect(), &hubs);
        let again = || {
            let mut stream = Stream::new(seed);
            let _ = [stream.vector(), stream.vector()];
            Web::new((0..curves).map(|_| one(&mut stream)).collect(), &hubs)
        };
        let mut twin = again();
        // The third-order system takes its time on polygons as wild as these, alone as well.
        let steps = web.steps(if is_fair { 60 } else { 400 });
        prop_assert!(is_fair || steps.is_some());
        prop_assert_eq!(twin.steps(if is_fair { 60 } else { 400 }), steps);
        for (a, b) in web.curves.iter().zip(&twin.curves) {
            prop_assert_eq!(&a.1, &b.1);
        }
        for hub in &web.network.hubs {
            for rib in &hub.ribs {
                prop_assert!(web.curves[rib.curve].0.tangents()[rib.node].dot(hub.normal).abs() < 1e-12);
            }
        }
    }
}

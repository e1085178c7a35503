//! Bands between any two boundaries: the right number of triangles, and the surface becomes what it should.

use proptest::prelude::*;

use super::*;
use crate::property_test::cases;
use crate::{boundary_loops, primitive, summary, validate};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn ring(n: u32, radius: f64, height: f64, turn: f64) -> Vec<DVec3> {
    (0..n)
        .map(|k| {
            let t = core::f64::consts::TAU * f64::from(k) / f64::from(n) + turn;
            DVec3::new(radius * libm::cos(t), radius * libm::sin(t), height)
        })
        .collect()
}

/// Two discs, one above the other, as one mesh.
fn two_discs(n: u32, m: u32, turn: f64) -> (Mesh, Vec<DVec3>) {
    let (mut mesh, mut positions) = primitive::sheet(&ring(n, 1.0, 0.0, 0.0), 1).unwrap();
    let (other, above) = primitive::sheet(&ring(m, 1.0, 1.0, turn), 1).unwrap();
    mesh.append(&other);
    positions.extend(above);
    (mesh, positions)
}

fn loops(mesh: &Mesh) -> [Vec<VertexId>; 2] {
    boundary_loops(mesh).try_into().unwrap()
}

proptest! {
    #![proptest_config(cases(192, 48))]

    #[test]
    fn two_discs_become_a_sphere(
        (n, m) in (3_u32..20, 3_u32..20),
        turn in -3.0..3.0,
        (backward, sense) in (any::<bool>(), 0_usize..4),
        is_placed in any::<bool>(),
    ) {
        let (mut mesh, positions) = two_discs(n, m, turn);
        let positions = if is_placed { positions } else { Vec::new() };
        let [one, mut other] = loops(&mesh);
        if backward {
            other.reverse();
        }
        let sense = [Sense::Oriented, Sense::Reversed, Sense::AsGiven, Sense::Shortest][sense];
        let bridge = Bridge { one: one.clone(), other: other.clone(), nodes: Default::default(), is_closed: true, sense };
        prop_assert_eq!(mesh.can_bridge(&bridge, &positions), Ok(()));
        let before = mesh.face_count();
        let bridged = mesh.bridge(&bridge, &positions).unwrap();
        prop_assert_eq!(validate(&mesh), Ok(()));
        prop_assert_eq!(summary(&mesh).kind(), (2, 0, 1, true));
        prop_assert_eq!(mesh.face_count(), before + (n + m) as usize);
        prop_assert_eq!((bridged.faces.len(), bridged.rungs.len()), ((n + m) as usize, (n + m) as usize));
        let alike = |e: &EdgeId| mesh.is_wound_alike(*e);
        prop_assert!(bridged.rungs.iter().all(alike), "a band is wound one way");
        for (boundary, is_alike) in [(&one, true), (&other, sense == Sense::Oriented)] {
            for k in 0..boundary.len() {
                let e = mesh.edge_between(boundary[k], boundary[(k + 1) % boundary.len()]).unwrap();
                prop_assert!(!mesh.is_boundary_edge(e));
                prop_assert!(!is_alike || mesh.is_wound_alike(e));
            }
        }
        for (rung, face) in bridged.rungs.iter().zip(&bridged.faces) {
            let [a, b] = mesh.edge_vertices(*rung);
            prop_assert!(one.contains(&a) != one.contains(&b));
            prop_assert!(mesh.face_edges(*face).contains(rung));
        }
    }

    #[test]
    fn two_strips_become_one(
        (n, m) in (1_usize..9, 1_usize..9),
        (from, to) in (0_usize..8, 0_usize..8),
        is_turned in any::<bool>(),
    ) {
        let (mut mesh, mut positions) = primitive::plane(n, 2, 1.0);
        let (other, above) = primitive::plane(m, 2, 1.0);
        let added = mesh.append(&other);
        positions.extend(above.iter().map(|p| *p + DVec3::new(0.3, 5.0, 0.0)));
        let one: Vec<_> = (0..=n).map(|i| VertexId::from_index(3 * i + 2)).collect();
        let mut other: Vec<_> = (0..=m).map(|i| added.vertices[3 * i].unwrap()).collect();
        if is_turned {
            other.reverse();
        }
        // A stretch of the side, or all of it.
        let cut = |side: &[VertexId], k: usize| side[k.min(side.len() - 2)..].to_vec();
        let bridge = Bridge { one: cut(&one, from), other: cut(&other, to), nodes: Default::default(), is_closed: false, sense: Sense::Oriented };
        let bridged = mesh.bridge(&bridge, &positions).unwrap();
        prop_assert_eq!((validate(&mesh), summary(&mesh).kind()), (Ok(()), (1, 1, 1, true)));
        prop_assert_eq!(bridged.faces.len(), bridge.one.len() + bridge.other.len() - 2);
        prop_assert_eq!(bridged.rungs.len(), bridged.faces.len() + 1);
        let ends = [bridged.rungs[0], bridged.rungs[bridged.rungs.len() - 1]];
        prop_assert!(ends.iter().all(|&e| mesh.is_boundary_edge(e)));
        prop_assert!(mesh.edges().all(|e| mesh.is_wound_alike(e)));
    }
}

/// A sphere with two holes.
fn holed() -> (Mesh, Vec<DVec3>) {
    let (mut mesh, positions) = primitive::icosphere(2);
    let doomed: Vec<bool> = mesh
        .faces()
        .map(|f| mesh.face_vertices(f).iter().all(|v| positions[v.index()].z.abs() > 0.7))
        .collect();
    mesh.remove_faces(|f| doomed[f.index()]);
    (mesh, positions)
}

#[test]
fn a_bridge_from_a_piece_to_itself_is_a_handle_or_two_crosscaps() {
    for (sense, is_orientable) in [(Sense::Oriented, true), (Sense::Reversed, false)] {
        let (mut mesh, positions) = holed();
        let [one, other] = loops(&mesh);
        mesh.bridge(&Bridge { one, other, nodes: Default::default(), is_closed: true, sense }, &positions)
            .unwrap();
        assert_eq!((validate(&mesh), summary(&mesh).kind()), (Ok(()), (0, 0, 1, is_orientable)));
    }
}

#[test]
fn the_band_lies_straight_wherever_the_loops_begin() {
    for shift in 0..12 {
        let (mut mesh, positions) = two_discs(12, 12, 0.05);
        let [one, mut other] = loops(&mesh);
        other.rotate_left(shift);
        let bridged = mesh
            .bridge(
                &Bridge { one, other, nodes: Default::default(), is_closed: true, sense: Sense::Shortest },
                &positions,
            )
            .unwrap();
        let longest = bridged
            .rungs
            .iter()
            .map(|&e| {
                let [a, b] = mesh.edge_vertices(e).map(|v| positions[v.index()]);
                a.distance(b)
            })
            .fold(0.0, f64::max);
        // A rung straight up measures 1.001, a diagonal between neighbours at most 1.18.
        assert!(longest < 1.2, "{longest} at {shift}");
    }
}

#[test]
fn an_edge_in_the_way_is_named_and_split() {
    // A cylinder one square high joins its own boundaries already: six of the nine possible rungs are taken.
    let positions = [ring(3, 1.0, 0.0, 0.0), ring(3, 1.0, 1.0, 0.0)].concat();
    let squares = |k: u32| [[k, (k + 1) % 3, k + 3], [(k + 1) % 3, (k + 1) % 3 + 3, k + 3]];
    let mut mesh = Mesh::from_triangles(6, &[squares(0), squares(1), squares(2)].concat()).unwrap();
    let [one, other] = loops(&mesh);
    let bridge = Bridge { one, other, nodes: Default::default(), is_closed: true, sense: Sense::Oriented };
    let old = mesh.to_triangles();
    let Err(BridgeError::SecondEdge(e)) = mesh.can_bridge(&bridge, &positions) else { panic!("no room") };
    let [a, b] = mesh.edge_vertices(e);
    assert!(bridge.one.contains(&a) != bridge.one.contains(&b));
    assert_eq!(mesh.bridge(&bridge, &positions), Err(BridgeError::SecondEdge(e)));
    assert_eq!(mesh.to_triangles(), old);
    let made = mesh.make_room_to_bridge(&bridge, &positions).unwrap();
    assert!((1..=6).contains(&made.len()));
    mesh.bridge(&bridge, &positions).unwrap();
    assert_eq!((validate(&mesh), summary(&mesh).kind()), (Ok(()), (0, 0, 1, true)));
}

#[test]
fn nonsense_is_refused() {
    let (mut mesh, positions) = two_discs(5, 6, 0.0);
    let [one, other] = loops(&mesh);
    let mut refusal = |one: &[VertexId], other: &[VertexId], is_closed: bool| {
        let bridge = Bridge {
            one: one.to_vec(),
            other: other.to_vec(),
            nodes: Default::default(),
            is_closed,
            sense: Sense::Oriented,
        };
        let old = mesh.to_triangles();
        let error = mesh.bridge(&bridge, &positions).unwrap_err();
        assert_eq!(mesh.to_triangles(), old);
        error
    };
    assert_eq!(refusal(&one, &one, true), BridgeError::Repeated(one[0]));
    assert_eq!(refusal(&one[..2], &other, true), BridgeError::TooShort(2));
    assert_eq!(refusal(&one, &[], true), BridgeError::TooShort(0));
    assert_eq!(refusal(&one[..4], &other, true), BridgeError::NotOnBoundary(one[3], one[0]));
    assert_eq!(refusal(&one, &other[..1], false), BridgeError::TooShort(1));
    let nobody = VertexId(999);
    assert_eq!(refusal(&[nobody, one[0]], &other, false), BridgeError::NotOnBoundary(nobody, nobody));
}

#[test]
fn nodes_that_belong_together_are_joined_by_rungs() {
    // Ends of a cylinder, the nodes of which stand unevenly.
    let ring = |n: usize, z: f64| -> Vec<DVec3> {
        let turn = |k: usize| core::f64::consts::TAU * k as f64 / n as f64;
        (0..n).map(|k| DVec3::new(libm::cos(turn(k)), libm::sin(turn(k)), z)).collect()
    };
    for sense in [Sense::AsGiven, Sense::Shortest] {
        let (low, high) = (ring(12, 0.0), ring(17, 1.0));
        let mut mesh = primitive::sheet(&low, 1).unwrap().0;
        let slots = mesh.vertex_slots();
        let one = (0..12).map(VertexId::from_index).collect::<Vec<_>>();
        let added = mesh.append(&primitive::sheet(&high, 1).unwrap().0);
        let other: Vec<_> = (0..17).map(|k| added.vertices[k].unwrap()).collect();
        let mut positions = vec![DVec3::ZERO; mesh.vertex_slots()];
        positions[..12].copy_from_slice(&low);
        positions[slots..slots + 17].copy_from_slice(&high);
        let nodes = [vec![one[1], one[5], one[10]], vec![other[16], other[3], other[11]]];
        let bridge = Bridge { one, other, nodes: nodes.clone(), is_closed: true, sense };
        let plain = Bridge { nodes: Default::default(), ..bridge.clone() };
        let rungs = |bridge: &Bridge| {
            let mut mesh = mesh.clone();
            let made = mesh.bridge(bridge, &positions).unwrap();
            assert_eq!(validate(&mesh), Ok(()));
            made.rungs.iter().map(|e| mesh.edge_vertices(*e)).collect::<Vec<_>>()
        };
        // At 30°, 150°, 300° and at 339°, 64°, 233°: those meet which are nearest in order.
        let pairs = [
            (nodes[0][0], other_at(&bridge, 3)),
            (nodes[0][1], other_at(&bridge, 11)),
            (nodes[0][2], other_at(&bridge, 16)),
        ];
        let joins = |rungs: &[[VertexId; 2]], pair: (VertexId, VertexId)| {
            rungs.iter().any(|ends| *ends == [pair.0, pair.1] || *ends == [pair.1, pair.0])
        };
        let (met, free) = (rungs(&bridge), rungs(&plain));
        assert_eq!(met.len(), free.len());
        assert!(pairs.iter().all(|pair| joins(&met, *pair)), "{met:?}");
        assert!(!pairs.iter().all(|pair| joins(&free, *pair)), "it would not be by itself");
    }
}

fn other_at(bridge: &Bridge, k: usize) -> VertexId {
    bridge.other[k]
}

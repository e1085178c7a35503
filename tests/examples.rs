//! The constructions of the thesis among the examples: each is built by the script of acts in `scripts/`, in the words of the
//! page, and what the script gives is what the menu opens, to the letter. `BLESS=1` writes the documents anew.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::Bench;
use ductile_mesh::{Mesh, quality, summary};
use ductile_spec::{Edit, Example, Foot, Request, SurfaceId, to_fragment, to_text};
use glam::DVec3;
use serde_json::Value;

/// What an example is known by.
struct Known {
    example: Example,
    euler: i64,
    boundaries: usize,
    is_orientable: bool,
    /// What is minimised, at rest: ∫ κ₁² + κ₂² of all but the bored ball, which is `fair`.
    energy: f64,
    /// Sharpest angle of a triangle at rest, in degrees, is above this.
    angle: f64,
}

const fn known(example: Example, kind: (i64, usize, bool), energy: f64, angle: f64) -> Known {
    let (euler, boundaries, is_orientable) = kind;
    Known { example, euler, boundaries, is_orientable, energy, angle }
}

const KNOWN: [Known; Example::BUILT.len()] = [
    known(Example::Torus, (0, 0, true), 87.135, 26.5),
    known(Example::PartyHat, (-2, 4, true), 72.019, 30.0),
    known(Example::CappedCylinder, (2, 0, true), 25.058, 30.0),
    known(Example::GluedCylinders, (0, 2, true), 24.816, 30.0),
    known(Example::Handle, (-2, 0, true), 190.136, 25.0),
    known(Example::KleinMug, (0, 0, false), 145.280, 25.0),
    known(Example::ThreeHandles, (-4, 0, true), 212.795, 24.5),
    known(Example::MoebiusStrip, (0, 1, false), 4.386, 30.0),
    known(Example::Spout, (1, 1, true), 48.122, 27.0),
    known(Example::BoredBall, (0, 0, true), 1046.301, 27.0),
];

/// By how much of its energy the surface that a script leaves may differ from what its document opens to: the meshes are
/// others. The most is 0.69 %, for the surface with three handles.
const LIVE: f64 = 0.008;

fn path(folder: &str, example: Example, ending: &str) -> String {
    format!("{}/{folder}/{}.{ending}", env!("CARGO_MANIFEST_DIR"), example.word())
}

/// Does the acts of an example's script, from nothing.
fn run(example: Example) -> Bench {
    let text = std::fs::read_to_string(path("scripts", example, "json")).unwrap();
    let acts: Vec<Value> = serde_json::from_str(&text).unwrap();
    let mut bench = Bench::new();
    for (act, number) in acts.into_iter().zip(1..) {
        if act == "rest" {
            // The bored ball rests folded after 600 steps, and makes way for what its document opens to.
            bench.rest(1200);
            continue;
        }
        let edit: Edit = serde_json::from_value(act).unwrap_or_else(|e| panic!("{example:?} {number}: {e}"));
        let refused = bench.send(Request::Edit(edit)).refused;
        assert_eq!(refused, None, "{example:?}: act {number}");
    }
    bench
}

#[test]
fn every_built_example_is_what_its_script_gives() {
    let mut strays = Vec::new();
    for example in Example::BUILT.into_iter().chain(Example::PATCHES) {
        let mut bench = run(example);
        let made = bench.document();
        if let Some(known) = KNOWN.iter().find(|known| known.example == example) {
            let live = bench.accept(Request::Describe).frame.figures.energy;
            let off = live / known.energy - 1.0;
            println!("{example:?}: energy {live:.4} on the script's own mesh, {:+.3} %", 100.0 * off);
            strays.extend((off.abs() >= LIVE).then_some(example));
        }
        let text = to_text(&made);
        let link = to_fragment(&made).len();
        println!("{example:?}: a link of {link} characters");
        assert!(link < 1500, "{example:?} makes a link of {link} characters");
        let file = path("../crates/modeler/src/example", example, "ductile.json");
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(&file, &text).unwrap();
        }
        assert_eq!(std::fs::read_to_string(&file).unwrap(), text, "{example:?}");
    }
    assert_eq!(strays, []);
}

#[test]
fn every_built_example_is_the_kind_of_surface_that_it_is_called() {
    for known in KNOWN {
        let bench = Bench::with(known.example);
        let surfaces = &bench.modeler.model().surfaces;
        assert_eq!(surfaces.len(), 1, "{:?}", known.example);
        let shape = surfaces.values().next().unwrap();
        let found = summary(&shape.mesh);
        assert_eq!(found.components, 1, "{:?}", known.example);
        assert_eq!(
            (found.euler, found.boundaries, found.is_orientable),
            (known.euler, known.boundaries, known.is_orientable),
            "{:?}",
            known.example
        );
        if found.boundaries == 0 && found.is_orientable {
            let corners =
                shape.mesh.faces().map(|f| shape.mesh.face_vertices(f).map(|v| shape.positions[v.index()]));
            let volume: f64 = corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
            assert!(volume > 0.0, "{:?} shows its inside", known.example);
        }
    }
}

#[test]
fn every_built_example_comes_to_rest_at_its_energy() {
    let mut misses = Vec::new();
    for known in KNOWN {
        let mut bench = Bench::with(known.example);
        let mut steps = 0;
        let energy = loop {
            steps += 1;
            let reply = bench.step(None);
            if reply.frame.settled {
                break reply.frame.figures.energy;
            }
            assert!(steps < 600, "{:?} is not at rest after {steps} steps", known.example);
        };
        let shape = bench.modeler.model().surfaces.values().next().unwrap().clone();
        let least = quality(&shape.mesh, &shape.positions).least_angle.to_degrees();
        println!(
            "{:?}: energy {energy:.4}, {steps} steps, {} vertices, least angle {least:.1}",
            known.example,
            shape.mesh.vertex_count()
        );
        if (energy / known.energy - 1.0).abs() >= 1e-3 || least <= known.angle {
            misses.push(known.example);
        }
    }
    assert!(misses.is_empty(), "another energy or a sharper angle: {misses:?}");
}

/// The exact surfaces of an example at rest, by number.
fn exact(example: Example) -> (Bench, Vec<SurfaceId>) {
    let mut bench = Bench::with(example);
    bench.rest(600);
    let model = bench.modeler.model();
    assert!(model.surfaces.is_empty(), "{example:?}");
    let surfaces = model.patches.keys().copied().collect();
    (bench, surfaces)
}

#[test]
fn patches_of_the_examples_meet_smoothly_and_follow_their_curves() {
    for (example, patches, seams) in [(Example::SixSided, 1, 0), (Example::ConnectedPatches, 6, 10)] {
        let (mut bench, surfaces) = exact(example);
        assert_eq!(surfaces.len(), patches, "{example:?}");
        let found = bench.accept(Request::Seams).seams.unwrap();
        assert_eq!(found.seams.len(), seams, "{example:?}");
        for seam in &found.seams {
            println!("{example:?}: gap {:e}, {}°", seam.gap, seam.angle);
            assert!(seam.gap < 1e-12 && seam.angle < 0.05, "{example:?}: {seam:?}");
        }
        for fill in &found.fills {
            println!("{example:?}: {fill:?}");
            assert!(fill.stuck.is_none() && fill.curve_deviation < 2e-3, "{example:?}: {fill:?}");
        }
        for id in surfaces {
            let shape = &bench.modeler.model().patches[&id];
            let mesh = Mesh::from_triangles(shape.positions().len(), shape.triangles()).unwrap();
            let found = summary(&mesh);
            assert_eq!((found.euler, found.boundaries), (1, 1), "{example:?}");
        }
    }
}

/// What is nearest to a foot goes along with it, nothing goes farther, and rims stay.
#[test]
fn displaced_examples_stand_at_the_ends_of_their_displacements() {
    for (example, feet, euler) in [(Example::SixSided, 1, 1), (Example::LobedRing, 6, 0)] {
        let (mut bench, surfaces) = exact(example);
        let displaced = bench.document().displacements[&surfaces[0]].clone();
        assert_eq!(displaced.items.len(), feet, "{example:?}");
        let plain = bench.modeler.model().patches[&surfaces[0]].positions().to_vec();
        bench.edit(Edit::Bake { surface: surfaces[0] });
        let baked = bench.document().meshes[&surfaces[0]].clone();
        // A foot that is no vertex becomes one, after the others.
        let (shown, count) = (&baked.vertices, plain.len());
        let mesh = Mesh::from_triangles(shown.len(), &baked.triangles).unwrap();
        assert_eq!(summary(&mesh).euler, euler, "{example:?}");
        assert!((count..=count + feet).contains(&shown.len()), "{example:?}: {} and {count}", shown.len());
        let moved: Vec<DVec3> = shown.iter().zip(&plain).map(|(shown, plain)| *shown - *plain).collect();
        for item in &displaced.items {
            let Foot::At(at) = item.foot else { panic!("{example:?}: {item:?}") };
            let near =
                (0..plain.len()).min_by(|a, b| plain[*a].distance(at).total_cmp(&plain[*b].distance(at)));
            let off = moved[near.unwrap()].distance(item.by) / item.by.length();
            println!("{example:?}: {off:e} of the displacement is missing at the vertex beside the foot");
            assert!(off < 0.02, "{example:?}: {off}");
        }
        let most = displaced.items.iter().map(|item| item.by.length()).fold(0.0, f64::max);
        assert!(moved.iter().all(|by| by.length() < most + 1e-5), "{example:?}");
        let rim = mesh.vertices().filter(|v| mesh.is_boundary_vertex(*v));
        assert!(rim.map(|v| moved[v.index()].length()).all(|by| by < 1e-5), "{example:?}");
    }
}

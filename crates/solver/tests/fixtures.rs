//! The recipe's recorded values: energies, gradients and the raised disc.

#![allow(clippy::unwrap_used, reason = "a failing test or bench should stop where it fails")]

use ductile_solver::{Curvature, Rings, Settings, SurfaceSolver, workload};
use glam::DVec3;
use serde::Deserialize;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

macro_rules! fixture {
    ($name:literal) => {
        serde_json::from_str(include_str!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../tests/fixtures/",
            $name,
            ".json"
        )))
        .unwrap()
    };
}

#[derive(Deserialize)]
struct EnergyFile {
    meshes: Vec<EnergyMesh>,
}

#[derive(Deserialize)]
struct EnergyMesh {
    name: String,
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    energy: f64,
    node_checks: Vec<NodeCheck>,
}

#[derive(Deserialize)]
struct NodeCheck {
    node: usize,
    mean_curvature_abs: f64,
    gauss_curvature: f64,
    normal_up_to_sign: [f64; 3],
}

fn solver(
    vertices: &[[f64; 3]],
    triangles: &[[u32; 3]],
    fixed: Vec<bool>,
    settings: Settings,
) -> (SurfaceSolver, Vec<DVec3>) {
    let rings = Rings::from_triangles(vertices.len(), triangles).unwrap();
    let positions = vertices.iter().map(|&vertex| DVec3::from(vertex)).collect();
    (SurfaceSolver::new(rings, fixed, settings).unwrap(), positions)
}

#[test]
fn sphere_and_torus_energies() {
    let files: [EnergyFile; 2] = [fixture!("sphere-energy"), fixture!("torus-energy")];
    for mesh in files.iter().flat_map(|file| &file.meshes) {
        let fixed = vec![false; mesh.vertices.len()];
        let (mut solver, positions) = solver(&mesh.vertices, &mesh.triangles, fixed, Settings::default());
        solver.fit_all(&positions);
        let relative = (solver.energy() / mesh.energy - 1.0).abs();
        assert!(relative < 1e-8, "{}: {} for {}", mesh.name, solver.energy(), mesh.energy);
        let curvatures: Vec<Curvature> = solver.curvatures().collect();
        for check in &mesh.node_checks {
            let curvature = curvatures[check.node];
            assert!((curvature.mean.abs() - check.mean_curvature_abs).abs() < 1e-7);
            assert!((curvature.gauss - check.gauss_curvature).abs() < 1e-7);
            let aligned = solver.normals()[check.node].dot(DVec3::from(check.normal_up_to_sign)).abs();
            assert!((aligned - 1.0).abs() < 1e-7);
        }
    }
}

#[derive(Deserialize)]
struct GradientFile {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    energy: f64,
    gradient: Vec<GradientNode>,
}

#[derive(Deserialize)]
#[expect(non_snake_case, reason = "names of the fixture")]
struct GradientNode {
    node: usize,
    dE_dp: [f64; 3],
    dE_dn: f64,
}

#[test]
fn exact_gradient_and_its_identities() {
    let file: GradientFile = fixture!("variational-gradient");
    let (mut solver, positions) =
        solver(&file.vertices, &file.triangles, vec![false; file.vertices.len()], Settings::default());
    solver.fit_all(&positions);
    assert!((solver.energy() / file.energy - 1.0).abs() < 1e-8);
    let gradient = solver.gradient().to_vec();
    for node in &file.gradient {
        let found = gradient[node.node];
        assert!(found.distance(DVec3::from(node.dE_dp)) < 1e-5, "node {}: {found}", node.node);
        assert!((found.dot(solver.normals()[node.node]) - node.dE_dn).abs() < 1e-5);
    }
    let size = gradient.iter().map(|g| g.length()).sum::<f64>();
    let force: DVec3 = gradient.iter().copied().sum();
    let torque: DVec3 = positions.iter().zip(&gradient).map(|(p, g)| p.cross(*g)).sum();
    let growth: f64 = positions.iter().zip(&gradient).map(|(p, g)| p.dot(*g)).sum();
    assert!(force.length() < 1e-12 * size && torque.length() < 1e-12 * size && growth.abs() < 1e-12 * size);
}

#[derive(Deserialize)]
struct DiscFile {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    heights_at_radii: Vec<f64>,
    cases: Vec<DiscCase>,
}

#[derive(Deserialize)]
struct DiscCase {
    raise: f64,
    scheme: String,
    energy: f64,
    heights: Vec<f64>,
    node_positions: std::collections::BTreeMap<String, [f64; 3]>,
}

#[test]
fn raised_disc() {
    let file: DiscFile = fixture!("disc-raise");
    let fixed: Vec<bool> = file
        .vertices
        .iter()
        .enumerate()
        .map(|(node, v)| node == 0 || (v[0] * v[0] + v[1] * v[1] - 1.0).abs() < 1e-6)
        .collect();
    assert_eq!(file.cases.len(), 9);
    for case in file.cases.iter().filter(|case| case.scheme.starts_with("exact-gradient")) {
        // The fixture's predictor took the whole jump at once, by a direct solve.
        let mut settings = Settings::default();
        settings.strain_limit = f64::INFINITY;
        settings.predictor_tolerance = 1e-10;
        settings.predictor_iterations = 200;
        let (mut solver, mut positions) = solver(&file.vertices, &file.triangles, fixed.clone(), settings);
        let predicted = solver.predict(&mut positions, &[(0, DVec3::Z * case.raise)]).unwrap();
        assert_eq!(predicted.fraction, 1.0);
        let reports = workload::relax(&mut solver, &mut positions, 40).unwrap();
        assert!(reports.len() <= 8, "{} steps", reports.len());
        assert!(reports.last().unwrap().at_rest);
        let relative = solver.energy() / case.energy - 1.0;
        let steps = reports.len();
        assert!(relative.abs() < 1e-4, "raise {}: energy off by {relative} after {steps} steps", case.raise);
        for (node, expected) in &case.node_positions {
            let found = positions[node.parse::<usize>().unwrap()];
            assert!(found.distance(DVec3::from(*expected)) < 0.01 * case.raise, "node {node}: {found}");
        }
        for (&radius, &expected) in file.heights_at_radii.iter().zip(&case.heights) {
            let found = mean_height(&positions, &file.triangles, radius);
            assert!((found - expected).abs() < 0.01 * case.raise, "{found} for {expected} at {radius}");
        }
    }
}

/// Mean height of the polyhedral surface over 24 directions.
fn mean_height(positions: &[DVec3], triangles: &[[u32; 3]], radius: f64) -> f64 {
    let height = |x: f64, y: f64| {
        triangles.iter().find_map(|triangle| {
            let [a, b, c] = triangle.map(|node| positions[node as usize]);
            let area = (b - a).truncate().perp_dot((c - a).truncate());
            let point = glam::DVec2::new(x, y);
            let wb = (point - a.truncate()).perp_dot((c - a).truncate()) / area;
            let wc = (b - a).truncate().perp_dot(point - a.truncate()) / area;
            let inside = wb >= -1e-9 && wc >= -1e-9 && wb + wc <= 1.0 + 1e-9;
            inside.then_some(a.z + wb * (b.z - a.z) + wc * (c.z - a.z))
        })
    };
    let directions = (0..24).map(|k| libm::sincos(std::f64::consts::TAU * f64::from(k) / 24.0));
    directions.map(|(sin, cos)| height(radius * cos, radius * sin).unwrap()).sum::<f64>() / 24.0
}

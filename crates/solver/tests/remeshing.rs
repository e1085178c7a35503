//! Goal g after goal e: the triangles of an anisotropic torus that was made even.

#[path = "../benches/goals/torus.rs"]
mod torus;

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

#[test]
fn an_anisotropic_torus_is_made_even() {
    let (mut mesh, mut positions) = torus::torus();
    torus::remesh(&mut mesh, &mut positions);
    let count = mesh.vertex_count();
    assert!((9_000..11_000).contains(&count), "{count} vertices");
    let triangles = torus::Triangles::of(&mesh, &positions);
    assert!(triangles.least > 30.0 && triangles.percentile >= 42.0, "{triangles}");
    assert!(triangles.regular >= 0.97, "{triangles}");
    // Still the torus: radii 2 and 1.
    let off = |v: ductile_mesh::VertexId| {
        let p = positions[v.index()];
        ((p.x.hypot(p.y) - 2.0).hypot(p.z) - 1.0).abs()
    };
    let worst = mesh.vertices().map(off).fold(0.0, f64::max);
    assert!(worst < 2e-3, "{worst}");
}

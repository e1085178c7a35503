//! What a filled hole costs: the masks of a kind of patch (once), a build with the masks at hand (every drag of a ribbon),
//! the basis of a tessellation (once), and its vertices. `cargo bench -p ductile-patch --bench s_patch`.

#[cfg(not(target_arch = "wasm32"))]
mod native {
    use criterion::{BatchSize, Criterion};
    use ductile_patch::s_patch::{Domain, Fill, Join, MaskCache, PatchKind, SPatch, Tessellation};
    use ductile_patch::{Ribbon, RibbonLoop, made_compatible};
    use glam::DVec3;

    /// Ribbons over a regular polygon, bent so that nothing is flat.
    fn ribbons(n: usize, d: usize) -> RibbonLoop {
        let corners = Domain::new(n);
        let at = |side: usize, u: f64, inward: f64| {
            let p = corners.on_side(side, u) * (1.0 - inward);
            DVec3::new(p.x, p.y, 0.3 * p.x * p.x - 0.2 * p.x * p.y + 0.1 * p.y)
        };
        let row = |side, inward| (0..=d).map(|j| at(side, j as f64 / d as f64, inward)).collect();
        let ribbons: Vec<Ribbon> =
            (0..n).map(|side| Ribbon { row0: row(side, 0.0), row1: row(side, 0.8 / d as f64) }).collect();
        made_compatible(&ribbons)
            .unwrap_or_else(|error| unreachable!("they meet at their corners: {error}"))
            .ribbons
    }

    fn filled(ring: &RibbonLoop, cache: &mut MaskCache) -> SPatch {
        let patch = SPatch::filling(ring, Join::Tangent, Fill::Biharmonic, cache);
        patch.unwrap_or_else(|error| unreachable!("a patch of ordinary size: {error}"))
    }

    pub(super) fn main() {
        let mut criterion = Criterion::default().sample_size(10).configure_from_args();
        for (name, n, d) in [
            ("5-sided quintic", 5, 5),
            ("5-sided septic", 5, 7),
            ("4-sided of degree 10", 4, 10),
            ("8-sided cubic", 8, 3),
            ("8-sided quartic", 8, 4),
        ] {
            let ring = ribbons(n, d);
            let mut cache = MaskCache::new();
            let patch = filled(&ring, &mut cache);
            let domain = Domain::new(n);
            let grid = || {
                Tessellation::new(n, d + 3, 16).unwrap_or_else(|error| unreachable!("small enough: {error}"))
            };
            let own = grid();
            let mut group = criterion.benchmark_group(name);
            group.bench_function("first build", |bench| {
                bench.iter_batched(
                    MaskCache::new,
                    |mut cache| filled(&ring, &mut cache),
                    BatchSize::LargeInput,
                );
            });
            group.bench_function("build again", |bench| bench.iter(|| filled(&ring, &mut cache)));
            group.bench_function("basis, resolution 16", |bench| bench.iter(grid));
            group.bench_function("vertices and normals, resolution 16", |bench| {
                bench.iter(|| own.evaluate(&patch))
            });
            let place = domain.on_side(1, 0.3) * 0.6;
            group.bench_function("one point with second derivatives", |bench| {
                bench.iter(|| patch.at(&domain, place))
            });
            group.finish();
        }
        dragged(&mut criterion);
        criterion.final_summary();
    }

    /// A whole frame of a patch that is dragged, and what is made before the first.
    fn dragged(criterion: &mut Criterion) {
        for (name, n, d) in [
            ("5-sided septic", 5, 7),
            ("5-sided, leaning", 5, 11),
            ("8-sided cubic", 8, 3),
            ("8-sided quintic", 8, 5),
        ] {
            let ring = ribbons(n, d);
            let kind = || {
                let kind = PatchKind::new(n, d, Join::Tangent, Fill::Biharmonic, 16);
                kind.unwrap_or_else(|error| unreachable!("a patch of ordinary size: {error}"))
            };
            let own = kind();
            let fill = || own.filling(&ring).ok().flatten();
            let mut group = criterion.benchmark_group(format!("{name}, dragged"));
            group.bench_function("kind, once", |bench| bench.iter(kind));
            group.bench_function("control points", |bench| bench.iter(fill));
            group.bench_function("control points and mesh", |bench| {
                bench.iter(|| fill().and_then(|patch| own.evaluate(&patch)))
            });
            group.finish();
        }
    }
}

fn main() {
    #[cfg(not(target_arch = "wasm32"))]
    native::main();
}

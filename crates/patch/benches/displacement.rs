//! Displacement blends on 10,000 and 100,000 vertices: what setting up costs, another foot, and a drag of one or of its
//! range. `cargo bench -p ductile-patch --bench displacement`.

#[cfg(not(target_arch = "wasm32"))]
mod native {
    use criterion::{BatchSize, Criterion};
    use ductile_patch::{Displacements, Domain, Item, Range, Settings};
    use ductile_solver::workload;
    use glam::DVec3;
    use std::hint::black_box;

    /// Rings of a disc with about 10,000 and 100,000 vertices.
    const RINGS: [(&str, usize); 2] = [("10k", 57), ("100k", 182)];

    fn benches(c: &mut Criterion) {
        for (name, rings) in RINGS {
            bench(c, name, rings);
        }
    }

    fn bench(c: &mut Criterion, name: &str, rings: usize) {
        let disc = workload::disc(rings);
        let mut group = c.benchmark_group(format!("displacement/{name}"));
        group.sample_size(10);
        let domain = || Domain::new(&disc.positions, &disc.triangles);
        let Ok(Ok(empty)) = domain().map(|domain| Displacements::new(domain, Settings::default())) else {
            return;
        };
        group.bench_function("set-up", |b| {
            b.iter(|| domain().map(|domain| Displacements::new(domain, Settings::default()).is_ok()));
        });
        let foot =
            |turn: usize| Item::foot(1 + 3 * (rings / 2) * (rings / 2 - 1) + turn * rings / 2, DVec3::Z);
        let first = || {
            let mut surface = empty.clone();
            surface.add(foot(0)).is_ok().then_some(surface)
        };
        group.bench_function("first foot", |b| {
            b.iter_batched(|| empty.clone(), |mut surface| surface.add(foot(0)), BatchSize::LargeInput);
        });
        group.bench_function("second foot, pairwise", |b| {
            b.iter_batched(first, |surface| surface.map(|mut s| s.add(foot(2))), BatchSize::LargeInput);
        });
        let Some(mut surface) = first() else { return };
        if surface.add(foot(2)).is_err() {
            return;
        }
        let mut height = 0.0;
        group.bench_function("drag one of two", |b| {
            b.iter(|| {
                height += 1e-3;
                let moved = surface.set_displacement(0, &[DVec3::Z * height]);
                (moved.is_ok(), black_box(surface.offsets()).is_ok())
            });
        });
        let mut share = 0.0;
        group.bench_function("drag the range of one of two", |b| {
            b.iter(|| {
                share = if share > 0.7 { 0.1 } else { share + 0.01 };
                let moved = Range::new(share).is_ok_and(|range| surface.set_range(0, range).is_ok());
                (moved, black_box(surface.offsets()).is_ok())
            });
        });
        group.finish();
    }

    pub(super) fn main() {
        let mut criterion = Criterion::default().configure_from_args();
        benches(&mut criterion);
        criterion.final_summary();
    }
}

fn main() {
    #[cfg(not(target_arch = "wasm32"))]
    native::main();
}

//! Cage surfaces: making the tables, evaluating everything, and evaluating what one moved vertex touches. Throughput is in
//! evaluated vertices (position and normal), so criterion prints them per second.

#[cfg(not(target_arch = "wasm32"))]
mod native {
    use criterion::{Criterion, Throughput};
    use ductile_patch::cage::{Cage, CageSurface, Settings, Split, Tessellation, primitive};
    use std::hint::black_box;

    fn benches(c: &mut Criterion) {
        let cages = [
            ("torus-64x32", primitive::torus(3.0, 1.0, 64, 32), Split::None),
            ("icosahedron-split", primitive::icosahedron(1.0), Split::Offset),
            ("trebol", primitive::trebol(2.0), Split::None),
        ];
        for (name, cage, split) in cages {
            let Ok(cage) = cage else { continue };
            bench(c, name, &cage, split);
        }
    }

    fn bench(c: &mut Criterion, name: &str, cage: &Cage, split: Split) {
        let settings = Settings { split, ..Settings::default() };
        let Ok(mut surface) = CageSurface::new(cage, settings) else { return };
        let resolution = 8;
        let Ok(mut tessellation) = Tessellation::new(&surface, resolution) else { return };
        let mut group = c.benchmark_group(format!("cage/{name}"));
        let all = tessellation.positions().len() as u64;
        group.throughput(Throughput::Elements(all));
        group.bench_function("tables and first evaluation", |b| {
            b.iter(|| black_box(Tessellation::new(&surface, resolution)));
        });
        group.bench_function("evaluate all", |b| {
            b.iter(|| tessellation.evaluate(black_box(surface.positions())))
        });
        let mut positions = cage.positions().to_vec();
        let mut drag = |surface: &mut CageSurface, by: f64| {
            positions[0].z += by;
            surface.move_to(&positions).unwrap_or_default()
        };
        let moved = drag(&mut surface, 0.01);
        group.throughput(Throughput::Elements(tessellation.update(surface.positions(), &moved) as u64));
        let mut by = 0.01;
        group.bench_function("one dragged vertex", |b| {
            b.iter(|| {
                by = -by;
                let moved = drag(&mut surface, by);
                tessellation.update(surface.positions(), &moved)
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

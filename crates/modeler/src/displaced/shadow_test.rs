//! Regions that shadow other surfaces, through the one door.

use crate::modeler::Modeler;
use ductile_spec::{
    CageForm, CageSource, CurveId, Displacement, Document, Edit, Example, ExportFormat, GrabTarget, On,
    Reply, Request, Shadow, Step, Structure, SurfaceId, VERTEX_FLOATS, from_text, to_text,
};
use glam::DVec3;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const ONE: SurfaceId = SurfaceId(1);
const TWO: SurfaceId = SurfaceId(2);
/// Edge length of the meshes. The highest vertex is not nearer to the summit than such an edge.
const EDGE: f64 = 0.1;

/// A modeler, with the structure that its frames have.
struct Bench {
    modeler: Modeler,
    structure: Structure,
    settled: bool,
}

impl Bench {
    fn new() -> Self {
        Self { modeler: Modeler::new(), structure: Structure::default(), settled: false }
    }

    fn ask(&mut self, request: Request) -> Reply {
        let reply = self.modeler.handle(request);
        self.settled = reply.frame.settled;
        if let Some(structure) = &reply.structure {
            self.structure = structure.clone();
        }
        assert_eq!(self.modeler.floats().len(), self.structure.float_count());
        reply
    }

    fn accept(&mut self, request: Request) -> Reply {
        let reply = self.ask(request);
        assert_eq!(reply.refused, None);
        reply
    }

    fn edit(&mut self, edit: Edit) {
        self.accept(Request::Edit(edit));
    }

    fn refuse(&mut self, edit: Edit) -> String {
        let before = self.spec().clone();
        let reply = self.ask(Request::Edit(edit));
        assert_eq!(*self.spec(), before);
        reply.refused.unwrap().reason
    }

    fn rest(&mut self) {
        for _ in 0..900 {
            if self.settled {
                return;
            }
            self.accept(Request::Step(Step { drag: None, iterations: 20 }));
        }
        panic!("no rest");
    }

    fn spec(&self) -> &Document {
        &self.modeler.model().document
    }

    /// A round disc, its rim through `corners` points.
    fn disc(&mut self, centre: DVec3, radius: f64, corners: usize) {
        let angle = |k: usize| core::f64::consts::TAU * k as f64 / corners as f64;
        let at = |k| centre + DVec3::new(libm::cos(angle(k)), libm::sin(angle(k)), 0.0) * radius;
        let through = (0..corners).map(|k| ductile_spec::Through::Place(at(k))).collect();
        let boundary = self.spec().next_curve();
        self.edit(Edit::Curve { through, closed: true });
        self.edit(Edit::Sheet { boundary });
    }

    /// A flat disc of radius 1 (surface 1) and a stamp of radius 0.5 beside it (surface 2), raised to 0.3 off its middle.
    fn stamped() -> Self {
        let mut bench = Self::new();
        bench.edit(Edit::Spacing { of: ductile_spec::SpacingOf::Document, spacing: Some(EDGE) });
        bench.disc(DVec3::ZERO, 1.0, 6);
        bench.disc(DVec3::X * 3.0, 0.5, 6);
        bench.rest();
        bench.edit(Edit::Displace {
            surface: TWO,
            displacement: Displacement::new(DVec3::new(3.1, 0.0, 0.0), DVec3::Z * 0.3),
        });
        bench.rest();
        bench
    }

    fn shown(&self, id: SurfaceId) -> Vec<DVec3> {
        let span = self.structure.surfaces.iter().find(|span| span.id == id).unwrap();
        let place = |v: u32| {
            let at = v as usize * VERTEX_FLOATS;
            DVec3::from_array([0, 1, 2].map(|k| f64::from(self.modeler.floats()[at + k])))
        };
        (span.first_vertex..span.first_vertex + span.vertex_count).map(place).collect()
    }

    fn triangles(&self, id: SurfaceId) -> Vec<[u32; 3]> {
        let span = self.structure.surfaces.iter().find(|span| span.id == id).unwrap();
        let own = &self.modeler.indices()[span.first_index as usize..][..span.index_count as usize];
        own.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|v| v - span.first_vertex)).collect()
    }

    fn highest(&self, id: SurfaceId) -> DVec3 {
        self.shown(id).into_iter().max_by(|a, b| a.z.total_cmp(&b.z)).unwrap()
    }

    fn shadow(&self) -> Shadow {
        self.spec().surfaces[&ONE].regions[0].shadow.unwrap()
    }
}

fn on_one(at: DVec3) -> On {
    On { surface: ONE, at }
}

fn shadow(of: SurfaceId) -> Edit {
    Edit::Shadow { region: on_one(DVec3::ZERO), of: Some(of), strength: 1.0, turn: None }
}

#[test]
fn a_flat_disc_takes_on_the_very_shape_of_a_stamp() {
    let mut bench = Bench::stamped();
    bench.edit(shadow(TWO));
    bench.rest();
    // As it stands in space: both discs have their anchors toward +x. Their rims are sampled each in its own way.
    assert!(bench.shadow().turn.abs() < 1e-3, "{:?}", bench.shadow());
    let (stamp, triangles) = (bench.shown(TWO), bench.triangles(TWO));
    let mut most = 0.0_f64;
    for at in bench.shown(ONE) {
        let place = DVec3::X * 3.0 + at * 0.5;
        let (corners, shares) = ductile_patch::nearest_spot(&stamp, &triangles, place).unwrap();
        let on: DVec3 = corners.iter().zip(shares).map(|(&v, share)| stamp[v as usize] * share).sum();
        most = most.max(on.distance(place));
    }
    // Curves are fair, not round, and meshes are meshes.
    assert!(most < 0.01, "off the stamp by {most}");
    assert!((bench.highest(ONE).z - 0.6).abs() < 0.02, "{}", bench.highest(ONE));
    assert!((bench.highest(ONE).x - 0.2).abs() < EDGE, "{}", bench.highest(ONE));
    // The surface below knows nothing of it, and the rim stays.
    let shape = &bench.modeler.model().surfaces[&ONE];
    assert!(shape.mesh.vertices().all(|v| shape.positions[v.index()].z.abs() < 1e-6));
    let exported = bench.accept(Request::Export(ExportFormat::Obj)).exported.unwrap().text;
    assert!(exported.lines().filter(|line| line.starts_with("v ")).any(|line| line.contains(" 0.5")));
}

#[test]
fn strength_and_turn_are_what_they_say_and_a_region_can_be_set_free() {
    let mut bench = Bench::stamped();
    let (plain, document) = (bench.shown(ONE), to_text(bench.spec()));
    bench.edit(shadow(TWO));
    bench.rest();
    let first = to_text(bench.spec());
    let turn = Some(core::f64::consts::FRAC_PI_2);
    bench.edit(Edit::Shadow { region: on_one(DVec3::ZERO), of: Some(TWO), strength: -0.5, turn });
    bench.rest();
    let lowest = bench.shown(ONE).into_iter().min_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
    assert!((lowest.z + 0.3).abs() < 0.02 && (lowest.y - 0.2).abs() < EDGE, "{lowest}");
    assert_eq!(bench.spec().surfaces[&ONE].regions.len(), 1, "a region shadows once");
    let second = to_text(bench.spec());
    bench.edit(Edit::Shadow { region: on_one(DVec3::ZERO), of: None, strength: 1.0, turn: None });
    assert_eq!(to_text(bench.spec()), document);
    assert!(bench.shown(ONE).iter().all(|at| at.z.abs() < 1e-6) && plain.len() > 100);
    for text in [&second, &first, &document] {
        bench.accept(Request::Undo);
        assert_eq!(to_text(bench.spec()), *text);
    }
    for text in [&first, &second, &document] {
        bench.accept(Request::Redo);
        assert_eq!(to_text(bench.spec()), *text);
    }
}

#[test]
fn the_relief_follows_stamp_and_surface_in_the_middle_of_drags() {
    let mut bench = Bench::stamped();
    bench.edit(shadow(TWO));
    bench.rest();
    bench.accept(Request::Grab(GrabTarget::Foot { surface: TWO, number: 1 }));
    bench.accept(Request::Step(Step { drag: Some(DVec3::new(3.1, 0.0, 0.5)), iterations: 20 }));
    assert!((bench.highest(ONE).z - 1.0).abs() < 0.04, "{}", bench.highest(ONE));
    bench.accept(Request::Drop);
    bench.rest();
    assert!((bench.highest(ONE).z - 1.0).abs() < 0.04, "{}", bench.highest(ONE));
    // The whole rim is lifted: the relief is lifted with it.
    let points: Vec<_> = bench.spec().curves[&CurveId(1)].through.clone();
    let summit = bench.highest(ONE);
    bench.edit(Edit::Shift { points, by: DVec3::new(0.0, 0.5, 1.0) });
    bench.rest();
    let moved = bench.highest(ONE) - summit;
    assert!(moved.distance(DVec3::new(0.0, 0.5, 1.0)) < EDGE, "{moved}");
    // Opened again it is the same.
    let (text, before) = (to_text(bench.spec()), bench.highest(ONE));
    let mut other = Bench::new();
    other.accept(Request::OpenText { text: text.clone() });
    other.rest();
    assert_eq!(to_text(&from_text(&text).unwrap()), text);
    assert!(other.highest(ONE).distance(before) < EDGE, "{} {before}", other.highest(ONE));
    // A place of what is shown is a place of the surface below.
    let summit = other.highest(ONE);
    other.edit(Edit::Pin { surface: ONE, at: summit });
    let pin = *other.spec().points.values().next_back().unwrap();
    assert!((pin.z - 1.0).abs() < 0.01 && (pin.truncate() - summit.truncate()).length() < 0.1, "{pin}");
}

#[test]
fn the_region_is_meshed_as_finely_as_the_stamp() {
    let mut bench = Bench::stamped();
    let coarse = bench.shown(ONE).len();
    bench.edit(Edit::Spacing { of: ductile_spec::SpacingOf::Surface(TWO), spacing: Some(0.03) });
    bench.rest();
    bench.edit(shadow(TWO));
    bench.rest();
    let fine = bench.shown(ONE).len();
    // Edges of 0.06 on a disc of radius 1, like 0.03 on one of 0.5.
    assert!(fine > 3 * coarse / 2 && fine.abs_diff(bench.shown(TWO).len()) < fine / 3, "{coarse} {fine}");
}

#[test]
fn a_cage_can_be_a_stamp_and_a_stamp_can_be_stamped() {
    let mut bench = Bench::new();
    bench.disc(DVec3::ZERO, 1.0, 6);
    let from = CageSource::BuiltIn { form: CageForm::Grid, centre: DVec3::X * 3.0, size: 1.0 };
    bench.edit(Edit::Cage { from });
    bench.disc(DVec3::Y * 3.0, 1.0, 5);
    bench.rest();
    bench.edit(shadow(TWO));
    bench.rest();
    bench.edit(Edit::Displace {
        surface: TWO,
        displacement: Displacement::new(DVec3::new(3.0, 0.0, 0.0), DVec3::Z * 0.3),
    });
    bench.rest();
    let once = bench.highest(ONE);
    assert!(once.z > 0.15, "{once}");
    let three = On { surface: SurfaceId(3), at: DVec3::Y * 3.0 };
    bench.edit(Edit::Shadow { region: three, of: Some(ONE), strength: 1.0, turn: None });
    bench.rest();
    assert!((bench.highest(SurfaceId(3)).z - once.z).abs() < 0.03, "{}", bench.highest(SurfaceId(3)));
    let why = bench.refuse(shadow(SurfaceId(3)));
    assert!(why.contains("one of the two must lead"), "{why}");
    // Without its stamp a region is as it was.
    bench.edit(Edit::DeleteSurface { surface: TWO });
    assert!(bench.spec().surfaces[&ONE].regions.is_empty());
    bench.rest();
    assert!(bench.highest(ONE).z.abs() < 1e-6 && bench.highest(SurfaceId(3)).z.abs() < 1e-6);
}

#[test]
fn what_cannot_shadow_or_be_shadowed_is_refused_by_name() {
    let mut bench = Bench::stamped();
    bench.edit(Edit::Cage {
        from: CageSource::BuiltIn { form: CageForm::Cube, centre: DVec3::Y * 3.0, size: 0.5 },
    });
    let cube = SurfaceId(3);
    for (edit, words) in [
        (shadow(ONE), "cannot shadow itself"),
        (shadow(SurfaceId(9)), "surface 9 does not exist"),
        (shadow(cube), "the stamp does not suit, it is closed"),
        (
            Edit::Shadow { region: on_one(DVec3::ZERO), of: None, strength: 1.0, turn: None },
            "shadows nothing",
        ),
        (
            Edit::Shadow { region: on_one(DVec3::NAN), of: Some(TWO), strength: 1.0, turn: None },
            "a position must consist",
        ),
        (
            Edit::Shadow {
                region: On { surface: cube, at: DVec3::ZERO },
                of: Some(TWO),
                strength: 1.0,
                turn: None,
            },
            "works on fair surfaces only",
        ),
        (
            Edit::Shadow { region: on_one(DVec3::ZERO), of: Some(TWO), strength: f64::NAN, turn: None },
            "its strength must be",
        ),
        (
            Edit::Shadow { region: on_one(DVec3::ZERO), of: Some(TWO), strength: 1.0, turn: Some(7.0) },
            "its turn must be",
        ),
    ] {
        let why = bench.refuse(edit);
        assert!(why.contains(words), "{why}");
    }
}

/// Places round one of the plane.
fn round(centre: DVec3, radius: f64) -> Vec<DVec3> {
    [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y].map(|way| centre + way * radius).to_vec()
}

#[test]
fn a_region_or_a_stamp_with_a_hole_shows_no_shadow_and_says_why() {
    let mut bench = Bench::stamped();
    // A curve inside makes a disc of the middle and a ring of the rest.
    bench.edit(Edit::SLoop { surface: ONE, along: round(DVec3::ZERO, 0.4), closed: true });
    bench.rest();
    let ring = Edit::Shadow { region: on_one(DVec3::X * 0.7), of: Some(TWO), strength: 1.0, turn: None };
    let why = bench.refuse(ring);
    assert!(why.contains("the region does not suit, it has 2 rims"), "{why}");
    bench.edit(shadow(TWO));
    bench.rest();
    assert!((bench.highest(ONE).z - 0.24).abs() < 0.02, "{}", bench.highest(ONE));
    assert!(bench.structure.regions.iter().any(|entry| entry.shadow == Some(bench.shadow())));
    // A hole in the stamp leaves the region as it is, until there is a disc again.
    bench.edit(Edit::SLoop { surface: TWO, along: round(DVec3::X * 3.0, 0.16), closed: true });
    bench.edit(Edit::Burnout { region: On { surface: TWO, at: DVec3::X * 3.0 } });
    bench.rest();
    assert!(bench.highest(ONE).z.abs() < 1e-3, "{}", bench.highest(ONE));
    // And the frame says why.
    let [failed] = &bench.structure.failed_shadows[..] else {
        panic!("{:?}", bench.structure.failed_shadows)
    };
    assert_eq!((failed.surface, failed.shadow), (ONE, bench.shadow()));
    assert!(failed.why.contains("the stamp does not suit, it has 2 rims"), "{}", failed.why);
    bench.accept(Request::Undo);
    bench.rest();
    assert!((bench.highest(ONE).z - 0.24).abs() < 0.02, "{}", bench.highest(ONE));
    assert_eq!(bench.structure.failed_shadows, []);
}

#[test]
fn an_example_without_borders_has_no_region_to_name() {
    let mut bench = Bench::new();
    bench.accept(Request::OpenExample(Example::Ball));
    bench.rest();
    bench.disc(DVec3::X * 3.0, 0.5, 6);
    let why = bench.refuse(shadow(TWO));
    assert!(why.contains("no control curve bounds"), "{why}");
}

//! Fixed meshes in a model: given, imported, turned, displaced and baked.

use super::*;
use crate::modeler::Modeler;
use crate::patch::PatchRim;
use ductile_spec::{
    CageForm, CageSource, CurveId, Displacement, Document, Edit, FillStyle, Hole, ImportAs, ImportFormat,
    Leave, MOST_MESH_VERTICES, MeshSource, Reply, Request, Step, SurfaceKind, Through,
};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const ONE: SurfaceId = SurfaceId(1);

fn ask(modeler: &mut Modeler, request: Request) -> Reply {
    let reply = modeler.handle(request);
    assert_eq!(reply.refused, None);
    reply
}

fn edit(modeler: &mut Modeler, edit: Edit) -> Reply {
    ask(modeler, Request::Edit(edit))
}

fn rest(modeler: &mut Modeler) {
    for _ in 0..2000 {
        if ask(modeler, Request::Step(Step { drag: None, iterations: 50 })).frame.settled {
            return;
        }
    }
    panic!("no rest");
}

fn refusal(modeler: &mut Modeler, edit: Edit) -> String {
    let before = modeler.model().document.clone();
    let reason = modeler.handle(Request::Edit(edit)).refused.unwrap().reason;
    assert_eq!(modeler.model().document, before);
    reason
}

fn given(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Edit {
    Edit::Mesh { from: MeshSource::Given(FixedMesh { vertices, triangles }) }
}

fn with(edit: Edit) -> Modeler {
    let mut modeler = Modeler::new();
    self::edit(&mut modeler, edit);
    modeler
}

fn shape(modeler: &Modeler) -> (&[DVec3], &[DVec3], &[[u32; 3]]) {
    let shape = &modeler.model().patches[&ONE];
    (shape.positions(), shape.normals(), shape.triangles())
}

/// A band of `n` times `m` quads, each of two triangles, whose vertices are at places of `u` in `[0, 1)` around and `v` in `[0, 1]`
/// across; turned over where it closes, it has one side.
fn band(n: u32, m: u32, is_turned: bool, at: impl Fn(f64, f64) -> DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let part = |k: u32, of: u32| f64::from(k) / f64::from(of);
    let places = (0..n).flat_map(|i| (0..=m).map(move |j| (i, j)));
    let vertices = places.map(|(i, j)| at(part(i, n), part(j, m))).collect();
    let name = |i: u32, j: u32| match (i == n, is_turned) {
        (false, _) => i * (m + 1) + j,
        (true, false) => j,
        (true, true) => m - j,
    };
    let quads = (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
    let halves = quads.flat_map(|(i, j)| {
        let [a, b, c, d] = [name(i, j), name(i + 1, j), name(i + 1, j + 1), name(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    (vertices, halves.collect())
}

fn tube() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    band(32, 20, false, |u, v| {
        let (sin, cos) = libm::sincos(u * core::f64::consts::TAU);
        DVec3::new(cos, sin, 4.0 * v - 2.0)
    })
}

#[test]
fn a_given_mesh_is_shown_with_fitted_normals_turned_and_deleted() {
    let (mut vertices, triangles) = tube();
    // One that no triangle has.
    vertices.push(DVec3::splat(9.0));
    let mut modeler = with(given(vertices, triangles));
    let reply = ask(&mut modeler, Request::Describe);
    let structure = reply.structure.unwrap();
    let [span] = structure.surfaces[..] else { panic!("one surface") };
    assert_eq!((span.kind, span.summary.euler, span.summary.boundaries), (SurfaceKind::Mesh, 0, 2));
    assert_eq!((span.vertex_count, span.index_count), (32 * 21, 3 * 32 * 40));
    assert!(reply.frame.settled && modeler.floats().len() == structure.float_count());
    assert!((modeler.model().document.extent().1 - libm::sqrt(6.0)).abs() < 1e-12);
    let (positions, normals, _) = shape(&modeler);
    for (at, normal) in positions.iter().zip(normals) {
        let outward = DVec3::new(at.x, at.y, 0.0);
        let is_at_rim = at.z.abs() > 1.9;
        assert!(normal.dot(outward) > if is_at_rim { 1.0 - 2e-4 } else { 1.0 - 1e-6 }, "{at}: {normal}");
    }
    let before = normals.to_vec();
    edit(&mut modeler, Edit::Reverse { surface: ONE });
    assert!(shape(&modeler).1.iter().zip(&before).all(|(now, before)| now.distance(-*before) < 1e-9));
    ask(&mut modeler, Request::Undo);
    assert_eq!(shape(&modeler).1, before);
    let text = ductile_spec::to_text(&modeler.model().document);
    let mut again = Modeler::new();
    ask(&mut again, Request::OpenText { text });
    assert_eq!(shape(&again), shape(&modeler));
    let reason = refusal(&mut modeler, Edit::Pin { surface: ONE, at: DVec3::X });
    assert!(reason.contains("is a fixed mesh") && reason.contains("fair surfaces only"), "{reason}");
    let face = Edit::DeleteFace { surface: ONE, face: 0 };
    assert!(refusal(&mut modeler, face).contains("is a fixed mesh"));
    edit(&mut modeler, Edit::DeleteSurface { surface: ONE });
    assert_eq!(*modeler.model().document, Document::default());
}

#[test]
fn windings_may_disagree_one_side_is_enough_and_any_valence_has_a_normal() {
    // Every other triangle is wound the wrong way.
    let (vertices, mut triangles) = tube();
    triangles.iter_mut().skip(1).step_by(2).for_each(|corners| corners.swap(0, 1));
    let modeler = with(given(vertices, triangles));
    assert!(shape(&modeler).0.iter().zip(shape(&modeler).1).all(|(at, n)| n.x * at.x + n.y * at.y > 0.9));

    let (vertices, triangles) = band(40, 4, true, |u, v| {
        let (turn, s) = (u * core::f64::consts::TAU, v - 0.5);
        let (sin, cos) = libm::sincos(turn);
        let (up, out) = libm::sincos(0.5 * turn);
        DVec3::new(cos * (1.0 + s * out), sin * (1.0 + s * out), s * up)
    });
    let mut modeler = with(given(vertices, triangles));
    let span = ask(&mut modeler, Request::Describe).structure.unwrap().surfaces[0];
    assert!(!span.summary.orientable && span.summary.boundaries == 1);
    assert!(shape(&modeler).1.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-9));

    // A flat fan of more triangles than a fit can have neighbours.
    let rim = (0..40_u32).map(|k| {
        let (sin, cos) = libm::sincos(f64::from(k) * core::f64::consts::TAU / 40.0);
        DVec3::new(cos, sin, 0.0)
    });
    let vertices = core::iter::once(DVec3::ZERO).chain(rim).collect();
    let fan = (0..40).map(|k| [0, k + 1, (k + 1) % 40 + 1]).collect();
    let modeler = with(given(vertices, fan));
    assert!(shape(&modeler).1.iter().all(|normal| normal.distance(DVec3::Z) < 1e-12));
}

#[test]
fn what_is_no_surface_is_refused_by_name() {
    let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
    let says =
        |triangles: &[[u32; 3]]| refusal(&mut Modeler::new(), given(corners.clone(), triangles.to_vec()));
    assert!(says(&[]).contains("surface 1 has no triangles"));
    assert!(says(&[[0, 1, 9]]).contains("does not exist"));
    assert!(says(&[[0, 1, 1]]).contains("corner 1 or another one is repeated"));
    assert!(says(&[[0, 1, 2], [0, 1, 3], [0, 1, 4]]).contains("more than two faces"));
    assert!(says(&[[0, 1, 2], [2, 0, 1]]).contains("same corners"));
    assert!(says(&[[0, 1, 2], [0, 3, 4]]).contains("more than one fan"));
    let far = given(vec![DVec3::ZERO, DVec3::X, DVec3::splat(2e6)], vec![[0, 1, 2]]);
    assert!(refusal(&mut Modeler::new(), far).contains("surface 1, vertex 2"));
    let nan = given(vec![DVec3::ZERO, DVec3::X, DVec3::NAN], vec![[0, 1, 2]]);
    assert!(refusal(&mut Modeler::new(), nan).contains("surface 1, vertex 2"));
    let (vertices, triangles) = band(1500, 20, false, |u, v| DVec3::new(u, v, 0.0));
    assert!(vertices.len() > MOST_MESH_VERTICES);
    assert!(refusal(&mut Modeler::new(), given(vertices, triangles)).contains("too many vertices of meshes"));
    // Triangles without area are a surface all the same, one without a tangent plane.
    let modeler = with(given(vec![DVec3::ONE; 3], vec![[0, 1, 2]]));
    assert_eq!(shape(&modeler).1, [DVec3::ZERO; 3]);
}

/// The file of a mesh.
fn obj((vertices, triangles): &(Vec<DVec3>, Vec<[u32; 3]>)) -> Vec<u8> {
    let v = |at: &DVec3| format!("v {} {} {}\n", at.x, at.y, at.z);
    let f = |t: &[u32; 3]| format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    let lines = vertices.iter().map(v).chain(triangles.iter().map(f));
    lines.collect::<String>().into_bytes()
}

#[test]
fn many_triangles_of_a_file_are_a_mesh_and_few_a_cage_unless_it_is_said() {
    let kinds = [
        (obj(&tube()), None, SurfaceKind::Mesh),
        (obj(&tube()), Some(ImportAs::Cage), SurfaceKind::Cage),
        (b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n".to_vec(), None, SurfaceKind::Cage),
        (
            b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n".to_vec(),
            Some(ImportAs::Mesh),
            SurfaceKind::Mesh,
        ),
    ];
    for (bytes, into, kind) in kinds {
        let mut modeler = Modeler::new();
        let done = ask(&mut modeler, Request::Import { format: ImportFormat::Obj, bytes, into });
        assert_eq!(done.committed.unwrap().act, "Import");
        assert_eq!(modeler.model().document.kind_of(ONE), Some(kind));
    }
    let mut modeler = Modeler::new();
    let format = ImportFormat::Obj;
    ask(&mut modeler, Request::Import { format, bytes: obj(&tube()), into: None });
    // Seven digits from the radius on are kept.
    let worst = shape(&modeler).0.iter().zip(&tube().0).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!((1e-9..1e-6).contains(&worst), "{worst:e}");
}

fn displaced(surface: SurfaceId, at: DVec3, by: DVec3) -> Edit {
    Edit::Displace { surface, displacement: Displacement::new(at, by) }
}

/// What is shown of the only surface, as it is exported.
fn exported(modeler: &mut Modeler) -> String {
    let export = Request::Export(ductile_spec::ExportFormat::Obj);
    ask(modeler, export).exported.unwrap().text
}

/// The positions of an exported file.
fn positions(text: &str) -> Vec<DVec3> {
    let lines = text.lines().filter_map(|line| line.strip_prefix("v "));
    let number = |word: &str| word.parse::<f64>().unwrap();
    let place = |line: &str| line.split_whitespace().map(number).collect::<Vec<_>>();
    lines.map(|line| DVec3::from_slice(&place(line))).collect()
}

/// Bakes the surface; the picture stays, the displacements go, and undo brings all back.
fn bakes(modeler: &mut Modeler) {
    let before = modeler.model().document.clone();
    let seen = positions(&exported(modeler));
    edit(modeler, Edit::Bake { surface: ONE });
    let now = positions(&exported(modeler));
    let radius = before.extent().1;
    assert_eq!(seen.len(), now.len());
    let worst = seen.iter().zip(&now).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(worst < 2e-6 * radius, "{worst:e}");
    assert_eq!(modeler.model().document.kind_of(ONE), Some(SurfaceKind::Mesh));
    assert!(modeler.model().document.displacements.is_empty());
    let baked = modeler.model().document.clone();
    assert!(refusal(modeler, Edit::Bake { surface: ONE }).contains("a fixed mesh already"));
    ask(modeler, Request::Undo);
    assert_eq!(modeler.model().document, before);
    ask(modeler, Request::Redo);
    assert_eq!(modeler.model().document, baked);
    // It is a surface like any other: it is displaced once more, and baked once more.
    let at = shape(modeler).0.iter().copied().max_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
    let is_closed = shape(modeler).1.len() > 2 && modeler.model().patches[&ONE].summary().boundaries == 0;
    if !is_closed {
        edit(modeler, displaced(ONE, at, DVec3::X * 0.01 * radius));
        edit(modeler, Edit::Bake { surface: ONE });
    }
}

#[test]
fn displaced_surfaces_of_all_kinds_are_baked_as_they_are_shown() {
    // A mesh.
    let (vertices, triangles) = tube();
    let mut modeler = with(given(vertices, triangles));
    let reason = refusal(&mut modeler, Edit::Bake { surface: SurfaceId(7) });
    assert!(reason.contains("surface 7 does not exist"), "{reason}");
    edit(&mut modeler, displaced(ONE, DVec3::new(1.0, 0.05, 0.1), DVec3::X * 0.5));
    edit(&mut modeler, Edit::Bake { surface: ONE });
    assert!(shape(&modeler).0.iter().any(|at| at.x > 1.49 && at.x < 1.51));
    // A cage: its control points go.
    let from = CageSource::BuiltIn { form: CageForm::Disc, centre: DVec3::ZERO, size: 1.0 };
    let mut modeler = with(Edit::Cage { from });
    edit(&mut modeler, displaced(ONE, DVec3::ZERO, DVec3::Z * 0.3));
    bakes(&mut modeler);
    assert!(modeler.model().document.points.is_empty());
    // A fair surface: its curve stays, and the points of the curve.
    let mut modeler = Modeler::new();
    ask(&mut modeler, Request::OpenExample(ductile_spec::Example::RaisedDisc));
    rest(&mut modeler);
    edit(&mut modeler, displaced(ONE, DVec3::new(0.0, 0.0, 0.3), DVec3::Z * 0.3));
    bakes(&mut modeler);
    assert_eq!((modeler.model().document.curves.len(), modeler.model().document.points.len()), (1, 4));
    rest(&mut modeler);
}

/// Four curves around a square, a sheet is not needed for a fill: the fill is surface 1.
fn filled() -> Modeler {
    let mut modeler = Modeler::new();
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.2 * x * y);
    let corners = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)];
    for at in corners {
        edit(&mut modeler, Edit::Point { at });
    }
    for k in 0..4_u32 {
        let through = [k, (k + 1) % 4].map(|k| Through::Point(ductile_spec::PointId(k + 1))).to_vec();
        edit(&mut modeler, Edit::Curve { through, closed: false });
    }
    let hole = Hole::Near { curve: CurveId(1), at: None };
    edit(&mut modeler, Edit::Fill { hole, style: FillStyle::default() });
    rest(&mut modeler);
    modeler
}

#[test]
fn what_took_its_planes_from_a_surface_takes_them_from_the_baked_one() {
    let mut modeler = filled();
    // A fill beside it, on the side of the first curve, that takes the planes of the first.
    for at in [DVec3::new(1.2, 2.5, 0.6), DVec3::new(-1.2, 2.5, -0.6)] {
        edit(&mut modeler, Edit::Point { at });
    }
    for [a, b] in [[1, 5], [5, 6], [6, 2]] {
        let through = [a, b].map(|k| Through::Point(ductile_spec::PointId(k))).to_vec();
        edit(&mut modeler, Edit::Curve { through, closed: false });
    }
    let hole = Hole::Near { curve: CurveId(6), at: None };
    edit(&mut modeler, Edit::Fill { hole, style: FillStyle::default() });
    rest(&mut modeler);
    let takes = |modeler: &Modeler| {
        modeler.model().document.fills[&SurfaceId(2)].sides.iter().any(|side| side.planes == Some(ONE))
    };
    assert!(takes(&modeler));
    let kink = |modeler: &Modeler| -> f64 {
        let [one, two] = [1, 2].map(|id| PatchRim::new(&modeler.model().patches[&SurfaceId(id)]));
        let nodes = modeler.model().curves[&CurveId(1)].nodes.iter();
        let cosines = nodes.filter_map(|at| Some(one.normal(*at)?.dot(two.normal(*at)?).abs()));
        libm::acos(cosines.fold(1.0, f64::min)).to_degrees()
    };
    assert!(kink(&modeler) < 1.0, "{}", kink(&modeler));
    let follower = |modeler: &Modeler| modeler.model().patches[&SurfaceId(2)].positions().to_vec();
    let exact = modeler.model().patches[&ONE].clone();
    let before = follower(&modeler);
    edit(&mut modeler, Edit::Bake { surface: ONE });
    assert!(takes(&modeler), "the curve runs along the rim of the mesh");
    rest(&mut modeler);
    let moved = before.iter().zip(&follower(&modeler)).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    // Against the surface as it was before it became triangles.
    let off = {
        let [one, two] = [&exact, &modeler.model().patches[&SurfaceId(2)]].map(|patch| PatchRim::new(patch));
        let nodes = modeler.model().curves[&CurveId(1)].nodes.iter();
        let cosines = nodes.filter_map(|at| Some(one.normal(*at)?.dot(two.normal(*at)?).abs()));
        libm::acos(cosines.fold(1.0, f64::min)).to_degrees()
    };
    // 0.03 and 0.54° with the one-sided fits of the solver.
    println!("a follower of a baked surface moves by {moved}, and is {off} degrees off what was baked");
    assert!(moved < 0.012 && off < 0.1, "{moved} {off}");
    println!("kink at a baked surface: {} degrees", kink(&modeler));
    assert!(kink(&modeler) < 0.1, "{}", kink(&modeler));
    // When the curve leaves the rim, there are no planes any more.
    let point = ductile_spec::PointId(1);
    edit(&mut modeler, Edit::Move { point, to: DVec3::new(1.5, 1.5, 0.9) });
    assert!(!takes(&modeler));
}

#[test]
fn a_fair_surface_goes_on_from_a_baked_cage_as_it_did_from_the_cage() {
    // A sheet beside a disc over a cage, along its rim.
    let from = CageSource::BuiltIn { form: CageForm::Disc, centre: DVec3::ZERO, size: 1.0 };
    let mut modeler = with(Edit::Cage { from });
    let rim: Vec<DVec3> = {
        let patch = &modeler.model().patches[&ONE];
        let edges = rim::edges(patch.triangles());
        let mut at: Vec<DVec3> = edges.iter().map(|edge| patch.positions()[edge[0] as usize]).collect();
        at.sort_by(|a, b| libm::atan2(a.y, a.x).total_cmp(&libm::atan2(b.y, b.x)));
        at.into_iter().step_by(4).collect()
    };
    let through = rim.iter().map(|at| Through::Place(*at)).collect();
    edit(&mut modeler, Edit::Curve { through, closed: true });
    let out = rim.iter().step_by(2).map(|at| Through::Place(*at * 1.8 + DVec3::Z)).collect();
    edit(&mut modeler, Edit::Curve { through: out, closed: true });
    edit(
        &mut modeler,
        Edit::Sweep { from: CurveId(1), to: CurveId(2), stretches: [None; 2], reversed: false },
    );
    rest(&mut modeler);
    let (surface, curve) = (SurfaceId(2), CurveId(1));
    edit(&mut modeler, Edit::Ribbon { surface, curve, leave: Some(Leave::Onto(ONE)) });
    rest(&mut modeler);
    let energy = |modeler: &Modeler| modeler.relaxer().energy();
    let before = energy(&modeler);
    edit(&mut modeler, Edit::Bake { surface: ONE });
    rest(&mut modeler);
    let ribbon = &modeler.model().document.surfaces[&surface].ribbons[&curve];
    assert_eq!(ribbon.onto, Some(ONE));
    assert!((energy(&modeler) / before - 1.0).abs() < 0.02, "{} {before}", energy(&modeler));
    edit(&mut modeler, Edit::DeleteSurface { surface: ONE });
    assert!(modeler.model().document.surfaces[&surface].ribbons.is_empty());
}

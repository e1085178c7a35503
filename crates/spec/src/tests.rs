//! Round trips are exact; damage of any kind is refused with its place; nothing panics.

use crate::*;
use glam::{DVec3, dvec3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn sample() -> Document {
    let mut document = Document {
        name: "A “name”\n".into(),
        spacing: Some(0.1),
        objective: Objective::Neutral,
        ..Document::default()
    };
    for (id, at) in [(1, dvec3(0.1 + 0.2, -1e-7, 1.0 / 3.0)), (2, DVec3::X), (3, DVec3::Y), (7, DVec3::Z)] {
        document.points.insert(PointId(id), at);
    }
    let through = vec![PointId(1), PointId(2), PointId(3)];
    document.curves.insert(
        CurveId(4),
        Curve {
            objective: Some(Objective::Fair),
            tangents: [(PointId(2), dvec3(0.0, -0.5, 1.0 / 3.0))].into(),
            ..Curve::new(through, true)
        },
    );
    let vertices = [1, 2, 3, 7].map(|id| SkeletonVertex::Control(PointId(id))).into_iter();
    let skeleton = Skeleton {
        vertices: vertices.chain([SkeletonVertex::Free(dvec3(0.5, 0.25, 2.0))]).collect(),
        triangles: vec![[0, 1, 3], [1, 2, 3], [2, 0, 4], [0, 3, 4], [3, 2, 4]],
        curves: vec![Embedding { curve: CurveId(4), along: vec![0, 1, 2] }],
    };
    let ribbon = Ribbon::directed([(PointId(3), dvec3(0.1, 0.0, -2.5))].into());
    document.surfaces.insert(
        SurfaceId(2),
        Surface {
            spacing: Some(0.05),
            normals: [(PointId(7), dvec3(0.0, 1.0 / 7.0, 1.0))].into(),
            ribbons: [(CurveId(4), ribbon)].into(),
            ..Surface::new(skeleton)
        },
    );
    document
}

#[test]
fn a_document_survives_text_and_link_to_the_bit() {
    let document = sample();
    document.validate().unwrap();
    for text in [to_text(&document), to_compact_text(&document)] {
        let back = from_text(&text).unwrap();
        assert_eq!(back, document);
        assert_eq!(back.points[&PointId(1)].x.to_bits(), (0.1_f64 + 0.2).to_bits());
    }
    let fragment = to_fragment(&document);
    assert_eq!(from_fragment(&fragment).unwrap(), document);
    assert_eq!(from_fragment(&format!("https://example.org/ductile/?x=1#{fragment}")).unwrap(), document);
}

#[test]
fn readable_text_has_a_line_for_each_thing() {
    let text = to_text(&sample());
    assert!(text.contains("\n    \"2\": [1.0,0.0,0.0]"), "{text}");
    assert!(text.starts_with("{\n  \"ductile\": 1,\n"), "{text}");
}

#[test]
fn newer_documents_and_links_are_named_as_such() {
    let newer = r#"{"ductile": 2, "points": {}, "voxels": []}"#;
    assert_eq!(from_text(newer), Err(TextError::Newer { found: 2 }));
    assert_eq!(from_fragment("#d2=AAAA"), Err(LinkError::Newer("d2".into())));
    assert_eq!(from_fragment("https://example.org/"), Err(LinkError::Missing));
}

#[test]
fn bad_text_is_refused_with_its_place() {
    let refuse = |text: &str| from_text(text).unwrap_err().to_string();
    assert!(refuse("").contains("line 1"), "{}", refuse(""));
    assert!(refuse("{\n\"ductile\": 1,\n\"points\": {\"1\": [0,0]}}").contains("line 3"));
    assert!(refuse(r#"{"ductile":1,"points":{},"extra":0}"#).contains("unknown field `extra`"));
    assert!(
        refuse(r#"{"ductile":1,"points":{"1":[0,0,0],"1":[1,1,1]}}"#).contains("point 1 is defined twice")
    );
    assert!(refuse(r#"{"ductile":1,"points":{"1":[0,0,2e6]}}"#).contains("point 1"));
    assert!(refuse(r#"{"ductile":1,"points":{"1":[0,0,1e999]}}"#).contains("line 1"));
    assert!(refuse(r#"{"ductile":1,"points":{},"spacing":0}"#).contains("spacing is 0"));
    assert!(refuse(&"[".repeat(100_000)).contains("line 1"));
    assert!(matches!(from_text(&" ".repeat(MAX_TEXT_BYTES + 1)), Err(TextError::TooLong(_))));
}

#[test]
fn every_broken_reference_is_named() {
    let broken = |change: &dyn Fn(&mut Document)| {
        let mut document = sample();
        change(&mut document);
        from_text(&to_text(&document)).unwrap_err().to_string()
    };
    let surface = |d: &mut Document| d.surfaces.get_mut(&SurfaceId(2)).unwrap().skeleton.clone();
    let with = |d: &mut Document, s: Skeleton| d.surfaces.get_mut(&SurfaceId(2)).unwrap().skeleton = s;
    let edit = |f: fn(&mut Skeleton)| {
        broken(&move |d| {
            let mut s = surface(d);
            f(&mut s);
            with(d, s);
        })
    };
    assert!(
        broken(&|d| assert!(d.points.remove(&PointId(3)).is_some()))
            .contains("point 3, which does not exist")
    );
    assert!(broken(&|d| drop(d.curves.remove(&CurveId(4)))).contains("curve 4 does not exist"));
    assert!(edit(|s| s.triangles[0][0] = 9).contains("corner 9 does not exist"));
    assert!(edit(|s| s.triangles[0][0] = s.triangles[0][1]).contains("repeated"));
    assert!(edit(|s| s.triangles.clear()).contains("no triangles"));
    assert!(edit(|s| s.vertices[3] = s.vertices[0]).contains("already another vertex"));
    // Only on another rim may a curve and its points occur again.
    assert!(edit(|s| s.vertices[1] = s.vertices[0]).contains("own order"));
    assert!(edit(|s| s.curves[0].along = vec![0, 2, 1]).contains("own order"));
    assert!(edit(|s| s.curves[0].along = vec![0, 1]).contains("own order"));
    assert!(edit(|s| s.curves[0].along = vec![0, 1, 77]).contains("vertex 77"));
    assert!(edit(|s| s.triangles.retain(|t| *t != [0, 1, 3])).contains("no edge from vertex 0 to vertex 1"));
    assert!(broken(&|d| d.curves.get_mut(&CurveId(4)).unwrap().through.truncate(2)).contains("at least 3"));
}

#[test]
fn a_link_bomb_is_refused_before_it_unpacks() {
    use base64::Engine as _;
    let bomb = miniz_oxide::deflate::compress_to_vec_zlib(&vec![b' '; 64 << 20], 6);
    let link = format!("d1={}", base64::engine::general_purpose::URL_SAFE_NO_PAD.encode(bomb));
    assert!(matches!(from_fragment(&link), Err(LinkError::Damaged(_))), "{:?}", from_fragment(&link).err());
    assert!(matches!(from_fragment(&"x".repeat(MAX_LINK_BYTES + 1)), Err(LinkError::TooLong(_))));
}

/// In the browser there are fewer random cases, the same ones in every run, and no file in which to keep a failure.
fn cases() -> ProptestConfig {
    if cfg!(target_arch = "wasm32") {
        let rng_seed = RngSeed::Fixed(1995);
        ProptestConfig { cases: 64, rng_seed, failure_persistence: None, ..ProptestConfig::default() }
    } else {
        ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn a_cut_or_changed_link_is_refused_or_still_a_document(at in 0_usize..1000, with in 0_u8..128) {
        let whole = to_fragment(&sample());
        let cut = &whole[..at.min(whole.len() - 1)];
        prop_assert!(from_fragment(cut).is_err(), "a link cut at {at} was accepted");
        let mut bytes = whole.clone().into_bytes();
        let place = at % bytes.len();
        bytes[place] = with;
        if let Ok(document) = from_fragment(&String::from_utf8_lossy(&bytes)) {
            document.validate().unwrap();
        }
    }

    #[test]
    fn any_coordinates_round_trip(x in -1e6..1e6_f64, y in -1.0..1.0_f64, z in prop::num::f64::NORMAL) {
        let z = if z.abs() <= MAX_COORDINATE { z } else { 0.5 };
        let mut document = sample();
        document.points.insert(PointId(1), dvec3(x, y, z));
        let back = from_fragment(&to_fragment(&document)).unwrap();
        let [a, b] = [&document, &back].map(|d| d.points[&PointId(1)].to_array().map(f64::to_bits));
        prop_assert_eq!(a, b);
    }

    #[test]
    fn any_text_is_refused_or_a_valid_document(text in ".{0,200}") {
        if let Ok(document) = from_text(&text) {
            document.validate().unwrap();
        }
    }
}

#[test]
fn tangents_must_be_directions_at_points_of_their_curve() {
    let mut document = sample();
    let mut with = |point: u32, direction: DVec3| {
        let curve = document.curves.get_mut(&CurveId(4)).unwrap();
        curve.tangents = [(PointId(point), direction)].into();
        document.validate()
    };
    assert_eq!(with(2, dvec3(0.0, 1e6, -3.0)), Ok(()));
    let bad = [DVec3::ZERO, DVec3::NAN, DVec3::X * f64::INFINITY, DVec3::Y * 1.1e6, DVec3::Z * 1e-10];
    for (point, direction) in [(7, DVec3::X), (99, DVec3::X)].into_iter().chain(bad.map(|d| (2, d))) {
        let refused = with(point, direction);
        assert!(
            matches!(refused, Err(Defect::Tangent { point: PointId(p), .. }) if p == point),
            "{refused:?}"
        );
    }
}

#[test]
fn a_tangent_given_twice_is_refused() {
    let text = to_compact_text(&sample());
    let twice = text.replacen("\"tangents\":{\"2\":", "\"tangents\":{\"2\":[1,0,0],\"2\":", 1);
    assert_ne!(twice, text, "{text}");
    assert!(from_text(&twice).unwrap_err().to_string().contains("twice"));
}

#[test]
fn normals_and_ribbons_must_be_directions_where_the_surface_has_controls() {
    let refused = |change: &dyn Fn(&mut Surface)| {
        let mut document = sample();
        change(document.surfaces.get_mut(&SurfaceId(2)).unwrap());
        document.validate().unwrap_err()
    };
    let bad = [DVec3::ZERO, DVec3::X * 1e-12, DVec3::X * f64::NAN, DVec3::Z * f64::INFINITY, DVec3::Y * 2e6];
    for direction in bad {
        let normal = refused(&|surface| surface.normals = [(PointId(7), direction)].into());
        assert!(matches!(normal, Defect::Normal { point: PointId(7), .. }), "{normal}");
        let cross = refused(&|surface| {
            drop(surface.ribbons.insert(CurveId(4), Ribbon::directed([(PointId(1), direction)].into())));
        });
        assert!(matches!(cross, Defect::Cross { point: PointId(1), .. }), "{cross}");
    }
    let nowhere = refused(&|surface| surface.normals = [(PointId(9), DVec3::X)].into());
    assert!(matches!(nowhere, Defect::Normal { point: PointId(9), .. }), "{nowhere}");
    let beside = refused(&|surface| {
        drop(surface.ribbons.insert(CurveId(4), Ribbon::directed([(PointId(7), DVec3::X)].into())));
    });
    assert!(matches!(beside, Defect::Cross { point: PointId(7), .. }), "{beside}");
    for ribbons in
        [(CurveId(4), Ribbon::default()), (CurveId(5), Ribbon::directed([(PointId(1), DVec3::X)].into()))]
    {
        let curve = ribbons.0;
        let refused = refused(&|surface| surface.ribbons = [ribbons.clone()].into());
        assert!(matches!(refused, Defect::Ribbon { curve: c, .. } if c == curve), "{refused}");
    }
}

#[test]
fn of_two_surfaces_at_a_curve_only_one_can_lead() {
    let curve = CurveId(4);
    let mut document = sample();
    let through = document.curves[&curve].through.clone();
    let side = |k: usize| FillSide::new(curve, through[k % through.len()], through[(k + 1) % through.len()]);
    let fill = Fill { sides: (0..through.len()).map(side).collect(), ..Fill::default() };
    document.fills.insert(SurfaceId(9), fill);
    let onto = |onto| Ribbon { onto: Some(onto), ..Ribbon::default() };
    let surface = document.surfaces.get_mut(&SurfaceId(2)).unwrap();
    surface.ribbons = [(curve, onto(SurfaceId(9)))].into();
    assert_eq!(document.validate(), Ok(()));
    document.fills.get_mut(&SurfaceId(9)).unwrap().sides[1].planes = Some(SurfaceId(2));
    assert!(matches!(document.validate(), Err(Defect::Ribbon { .. })), "{:?}", document.validate());
    // Nor can a fair surface go on from a fair one, from nothing, or from directions and a surface at once.
    document.fills.get_mut(&SurfaceId(9)).unwrap().sides[1].planes = None;
    let both = Ribbon { cross: [(through[0], DVec3::Z)].into(), ..onto(SurfaceId(9)) };
    for ribbon in [onto(SurfaceId(2)), onto(SurfaceId(77)), both] {
        document.surfaces.get_mut(&SurfaceId(2)).unwrap().ribbons = [(curve, ribbon)].into();
        assert!(matches!(document.validate(), Err(Defect::Ribbon { .. })), "{:?}", document.validate());
    }
}

#[test]
fn a_normal_or_ribbon_given_twice_is_refused() {
    let text = to_compact_text(&sample());
    for (once, twice) in [
        ("\"normals\":{", "\"normals\":{\"7\":[1,0,0],"),
        ("\"cross\":{", "\"cross\":{\"3\":[1,0,0],"),
        ("\"ribbons\":{", "\"ribbons\":{\"4\":{\"cross\":{\"1\":[1,0,0]}},"),
    ] {
        let twice = text.replacen(once, twice, 1);
        assert_ne!(twice, text);
        assert!(from_text(&twice).unwrap_err().to_string().contains("defined twice"));
    }
}

#[test]
fn displacements_are_written_without_what_is_usual_and_come_round() {
    let mut document = sample();
    let plain = to_compact_text(&document);
    let mut displaced = Displaced::default();
    displaced.items.push(Displacement::new(DVec3::X, DVec3::Z));
    document.displacements.insert(SurfaceId(2), displaced);
    let text = to_compact_text(&document);
    let added = r#","displacements":{"2":{"items":[{"foot":{"at":[1.0,0.0,0.0]},"by":[0.0,0.0,1.0]}]}}"#;
    assert_eq!(text, format!("{}{added}}}", plain.strip_suffix('}').unwrap()));
    let displaced = document.displacements.get_mut(&SurfaceId(2)).unwrap();
    displaced.items.push(Displacement {
        foot: Foot::All(vec![DVec3::Y, DVec3::Z]),
        by: DVec3::X,
        range: -0.5,
        direction: Some(Stretch { along: DVec3::Y, times: 3.0 }),
    });
    displaced.items.push(Displacement { foot: Foot::Along(CurveId(4)), ..displaced.items[0].clone() });
    displaced.blending = Blending {
        profile: Profile::Harmonic,
        combination: Combination::Plain,
        blend: Blend::Bump(2.0),
        pins: vec![Hold::Around { at: DVec3::ONE, radius: 0.25 }, Hold::Curve(CurveId(4))],
    };
    assert_eq!(from_text(&to_text(&document)), Ok(document.clone()));
    assert!(to_compact_text(&document).contains(r#""foot":{"along":4}"#));
}

#[test]
fn displacements_that_cannot_be_are_refused_with_their_number() {
    let with = |change: &dyn Fn(&mut Displaced)| {
        let mut document = sample();
        let mut displaced = Displaced::default();
        displaced.items.push(Displacement::new(DVec3::X, DVec3::Z));
        change(&mut displaced);
        document.displacements.insert(SurfaceId(2), displaced);
        document.validate()
    };
    assert_eq!(with(&|_| {}), Ok(()));
    let item =
        |change: &dyn Fn(&mut Displacement)| with(&|displaced| change(&mut displaced.items[0])).unwrap_err();
    for range in [f64::NAN, 1.0, f64::INFINITY, -21.0] {
        let refused = item(&|item| item.range = range);
        assert!(matches!(refused, Defect::Displacement { number: 1, .. }), "{refused}");
    }
    for (along, times) in [(DVec3::ZERO, 2.0), (DVec3::X, 0.0), (DVec3::X, f64::NAN), (DVec3::X, 65.0)] {
        let refused = item(&|item| item.direction = Some(Stretch { along, times }));
        assert!(matches!(refused, Defect::Displacement { number: 1, .. }), "{refused}");
    }
    assert!(matches!(item(&|item| item.foot = Foot::All(Vec::new())), Defect::Displacement { .. }));
    assert!(matches!(item(&|item| item.by.x = 2e6), Defect::Coordinate { .. }));
    assert!(matches!(item(&|item| item.foot = Foot::At(DVec3::NAN)), Defect::Coordinate { .. }));
    let curve = CurveId(5);
    let refused = item(&|item| item.foot = Foot::Along(curve));
    assert_eq!(refused, Defect::DisplacedCurve { surface: SurfaceId(2), curve });
    for blend in [Blend::Bump(0.0), Blend::Bump(101.0), Blend::Eta(0.5), Blend::Eta(f64::NAN)] {
        let refused = with(&|displaced| displaced.blending.blend = blend).unwrap_err();
        assert!(matches!(refused, Defect::Blending { .. }), "{refused}");
    }
    let radius = with(&|displaced| {
        displaced.blending.pins.push(Hold::Around { at: DVec3::X, radius: -1.0 });
    });
    assert!(matches!(radius, Err(Defect::Blending { .. })));
    let many = with(&|displaced| displaced.items[0].foot = Foot::All(vec![DVec3::X; MOST_FEET + 1]));
    assert!(matches!(many, Err(Defect::TooMany { limit: MOST_FEET, .. })));
    let mut document = sample();
    document.displacements.insert(SurfaceId(9), Displaced::default());
    assert_eq!(document.validate(), Err(Defect::NothingToDisplace(SurfaceId(9))));
}

/// A tetrahedron as a cage on the points of the sample.
fn caged() -> Document {
    let mut document = sample();
    let faces = [[1, 3, 2], [1, 2, 7], [2, 3, 7], [3, 1, 7]].map(|face| face.map(PointId).to_vec());
    document.cages.insert(SurfaceId(5), Cage::new(faces.to_vec()));
    document
}

#[test]
fn what_is_usual_of_a_cage_is_not_written_and_the_rest_comes_back() {
    let mut document = caged();
    document.validate().unwrap();
    assert!(!to_compact_text(&sample()).contains("cages"));
    assert!(!to_compact_text(&document).contains("settings"));
    let settings = CageSettings {
        split: Some(CageSplit::CatmullClark),
        map: CageMap::Rational,
        blend: CageBlend::Bump(3),
        boundary: CageBoundary::Borrow,
        resolution: Some(7),
    };
    document.cages.get_mut(&SurfaceId(5)).unwrap().settings = settings;
    let text = to_compact_text(&document);
    let words = r#""settings":{"split":"catmull-clark","map":"rational","blend":{"bump":3},"boundary":"borrow","resolution":7}"#;
    assert!(text.contains(words), "{text}");
    assert_eq!(from_text(&text).unwrap(), document);
    assert_eq!(
        (document.next_surface(), document.kind_of(SurfaceId(5))),
        (SurfaceId(6), Some(SurfaceKind::Cage))
    );
}

#[test]
fn cages_that_make_no_sense_are_named() {
    let broken = |change: &dyn Fn(&mut Cage)| {
        let mut document = caged();
        change(document.cages.get_mut(&SurfaceId(5)).unwrap());
        from_text(&to_text(&document)).unwrap_err().to_string()
    };
    assert!(
        broken(&|cage| cage.faces[1][0] = PointId(9)).contains("surface 5, face 1: point 9 does not exist")
    );
    assert!(broken(&|cage| cage.faces[1][0] = PointId(7)).contains("face 1: point 7 is a corner twice"));
    assert!(broken(&|cage| cage.faces[2].truncate(2)).contains("face 2 has 2 corners"));
    assert!(broken(&|cage| cage.faces.clear()).contains("surface 5 has no triangles"));
    assert!(broken(&|cage| cage.settings.blend = CageBlend::Hermite(25)).contains("Hermite blend: 25"));
    assert!(broken(&|cage| cage.settings.resolution = Some(0)).contains("resolution: 0"));
    let mut document = caged();
    document.cages.insert(SurfaceId(2), document.cages[&SurfaceId(5)].clone());
    assert_eq!(document.validate(), Err(Defect::TwoKinds(SurfaceId(2))));
    // A hundred of them at the finest are more than a picture needs.
    let mut document = caged();
    let mut cage = document.cages[&SurfaceId(5)].clone();
    cage.settings.resolution = Some(MAX_CAGE_RESOLUTION);
    document.cages.extend((10..110).map(|id| (SurfaceId(id), cage.clone())));
    assert!(matches!(document.validate(), Err(Defect::TooMany { what, .. }) if what.contains("cages")));
}

#[test]
fn a_file_travels_as_bytes() {
    let request =
        Request::Import { format: ImportFormat::Ply, bytes: vec![0, 127, 255], into: Some(ImportAs::Mesh) };
    let text = serde_json::to_string(&request).unwrap();
    assert_eq!(serde_json::from_str::<Request>(&text).unwrap(), request);
    let formats = ["a.b.PLY", "cage.obj", "ply", "x.stl"].map(ImportFormat::of_name);
    assert_eq!(formats, [Some(ImportFormat::Ply), Some(ImportFormat::Obj), None, None]);
}

#[test]
fn a_new_identity_is_free_even_if_the_last_one_is_taken() {
    let mut document = Document::default();
    assert_eq!((document.next_point(), document.next_surface()), (PointId(1), SurfaceId(1)));
    document.points.extend([1, 2, u32::MAX].map(|id| (PointId(id), DVec3::ZERO)));
    assert_eq!(document.next_point(), PointId(3));
    document.points.remove(&PointId(u32::MAX));
    document.points.remove(&PointId(1));
    assert_eq!(document.next_point(), PointId(3));
}

/// A document with a mesh of two triangles.
fn meshed() -> Document {
    let mut document = sample();
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y];
    document.meshes.insert(SurfaceId(5), FixedMesh { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]] });
    document
}

#[test]
fn a_fixed_mesh_is_written_and_comes_back() {
    let mut document = meshed();
    document.validate().unwrap();
    assert!(!to_compact_text(&sample()).contains("meshes"));
    let text = to_compact_text(&document);
    let words = r#""meshes":{"5":{"vertices":[[0.0,0.0,0.0],[1.0,0.0,0.0],[1.0,1.0,1.0],[0.0,1.0,0.0]],"triangles":[[0,1,2],[0,2,3]]}}"#;
    assert!(text.contains(words), "{text}");
    assert_eq!(from_text(&text).unwrap(), document);
    assert_eq!(from_text(&to_text(&document)).unwrap(), document);
    assert_eq!(
        (document.next_surface(), document.kind_of(SurfaceId(5))),
        (SurfaceId(6), Some(SurfaceKind::Mesh))
    );
    let mesh = document.meshes.get_mut(&SurfaceId(5)).unwrap();
    mesh.vertices.insert(1, DVec3::splat(1e5));
    mesh.triangles = vec![[0, 2, 3], [0, 3, 4]];
    assert_eq!(mesh.without_unused(), meshed().meshes[&SurfaceId(5)]);
    let reach = document.extent().1;
    assert!(reach > 5e4, "what it has counts: {reach}");
}

#[test]
fn meshes_that_make_no_sense_are_named() {
    let broken = |change: &dyn Fn(&mut FixedMesh)| {
        let mut document = meshed();
        change(document.meshes.get_mut(&SurfaceId(5)).unwrap());
        document.validate().unwrap_err().to_string()
    };
    assert!(broken(&|mesh| mesh.triangles.clear()).contains("surface 5 has no triangles"));
    assert!(
        broken(&|mesh| mesh.triangles[1][2] = 4).contains("surface 5, triangle 1: corner 4 does not exist")
    );
    assert!(broken(&|mesh| mesh.triangles[1] = [3, 2, 2]).contains("triangle 1: corner 2 or another one"));
    assert!(broken(&|mesh| mesh.vertices.push(DVec3::ONE)).contains("surface 5: no triangle has vertex 4"));
    assert!(
        broken(&|mesh| mesh.vertices[2].y = f64::NAN).contains("surface 5, vertex 2: a coordinate is NaN")
    );
    assert!(
        broken(&|mesh| mesh.vertices[0].z = 2e6).contains("surface 5, vertex 0: a coordinate is 2000000")
    );
    let mut document = meshed();
    document.meshes.insert(SurfaceId(2), document.meshes[&SurfaceId(5)].clone());
    assert_eq!(document.validate(), Err(Defect::TwoKinds(SurfaceId(2))));
    for (vertices, triangles) in [(MOST_MESH_VERTICES + 1, 1), (3, MOST_MESH_TRIANGLES + 1)] {
        let mut document = meshed();
        let mesh = FixedMesh { vertices: vec![DVec3::ONE; vertices], triangles: vec![[0, 1, 2]; triangles] };
        document.meshes.insert(SurfaceId(6), mesh);
        let refused = document.validate().unwrap_err();
        assert!(matches!(refused, Defect::TooMany { what, .. } if what.contains("of meshes")), "{refused}");
    }
}

#[test]
fn the_largest_mesh_with_all_digits_is_a_file_that_can_be_read() {
    // A closed surface has twice as many triangles as vertices. Sixteen digits and a sign are the most that baked coordinates never
    // have and given ones may.
    let mut document = Document::default();
    let vertex = DVec3::new(-123_456.789_012_345_67, -0.123_456_789_012_345_67, -98_765.432_109_876_54);
    let last = u32::try_from(MOST_MESH_VERTICES).unwrap() - 1;
    let triangles = (0..MOST_MESH_TRIANGLES).map(|k| match u32::try_from(k).unwrap() {
        k if k < last - 1 => [k, k + 1, k + 2],
        _ => [last - 2, last - 1, last],
    });
    let mesh = FixedMesh { vertices: vec![vertex; MOST_MESH_VERTICES], triangles: triangles.collect() };
    document.meshes.insert(SurfaceId(1), mesh);
    let text = to_text(&document);
    println!("the largest mesh: {} bytes", text.len());
    assert_eq!(from_text(&text), Ok(document));
}

#[test]
fn a_script_may_leave_out_what_is_fair() {
    let read = |text: &str| serde_json::from_str::<Edit>(text);
    let lean = |turn, strength| Edit::Lean { surface: SurfaceId(1), side: 3, turn, strength };
    for (rest, wanted) in [
        ("", lean(0.0, 1.0)),
        (r#", "turn": 0.5"#, lean(0.5, 1.0)),
        (r#", "turn": -0.5, "strength": 2"#, lean(-0.5, 2.0)),
    ] {
        let text = format!(r#"{{"lean": {{"surface": 1, "side": 3{rest}}}}}"#);
        assert_eq!(read(&text).unwrap(), wanted);
    }
    assert!(read(r#"{"lean": {"surface": 1, "side": 3, "tilt": 0.5}}"#).is_err());
}

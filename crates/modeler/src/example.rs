//! The examples: small documents, each of which would fit in a message. Plain ones are written down here. The thesis's
//! constructions are what scripts of acts give: their documents are kept as text, and `tests/examples.rs` makes them again.

use crate::model::Model;
use crate::operation::cage::cage;
use ductile_spec::{
    CageForm, CageSource, Curve, CurveId, Document, Embedding, Example, PointId, Skeleton, SkeletonVertex,
    Surface, SurfaceId, from_text,
};
use glam::{DVec3, dvec3};

/// The document of an example.
#[must_use]
pub fn example(example: Example) -> Document {
    let mut document = match example {
        Example::Disc => disc(),
        Example::RaisedDisc => raised_disc(),
        Example::Saddle => saddle(),
        Example::Cylinder => cylinder(),
        Example::Ball => ball(),
        Example::Torus => built(include_str!("example/torus.ductile.json")),
        Example::PartyHat => built(include_str!("example/party-hat.ductile.json")),
        Example::CappedCylinder => built(include_str!("example/capped-cylinder.ductile.json")),
        Example::GluedCylinders => built(include_str!("example/glued-cylinders.ductile.json")),
        Example::Handle => built(include_str!("example/handle.ductile.json")),
        Example::KleinMug => built(include_str!("example/klein-mug.ductile.json")),
        Example::ThreeHandles => built(include_str!("example/three-handles.ductile.json")),
        Example::MoebiusStrip => built(include_str!("example/moebius-strip.ductile.json")),
        Example::Spout => built(include_str!("example/spout.ductile.json")),
        Example::BoredBall => built(include_str!("example/bored-ball.ductile.json")),
        Example::TorusCage => caged(CageForm::Torus),
        Example::Trebol => caged(CageForm::Trebol),
        Example::Icosahedron => caged(CageForm::Icosahedron),
        Example::SixSided => built(include_str!("example/six-sided.ductile.json")),
        Example::ConnectedPatches => built(include_str!("example/connected-patches.ductile.json")),
        Example::LobedRing => built(include_str!("example/lobed-ring.ductile.json")),
    };
    example.title().clone_into(&mut document.name);
    document
}

/// What a script gave.
fn built(text: &str) -> Document {
    from_text(text).expect("the texts are part of the program, and a test reads each of them")
}

/// What the act of that name lays into an empty document.
fn caged(form: CageForm) -> Document {
    let mut model = Model::default();
    let from = CageSource::BuiltIn { form, centre: DVec3::ZERO, size: 1.0 };
    cage(&mut model, &from).expect("a cage of size 1 fits any document, and a test makes each of them");
    Document::clone(&model.document)
}

/// Four points on the unit circle, on the diagonals; 0.7071 keeps the link short.
#[expect(clippy::approx_constant, reason = "four digits keep the link short")]
const DIAGONAL: f64 = 0.7071;

fn disc() -> Document {
    let mut document = Document { spacing: Some(0.08), ..Document::default() };
    let boundary = ring(&mut document, 0.0);
    let vertices = boundary.iter().map(|id| SkeletonVertex::Control(*id)).collect();
    add_surface(&mut document, vertices, vec![[0, 1, 2], [0, 2, 3]], &[(1, vec![0, 1, 2, 3])]);
    document
}

fn raised_disc() -> Document {
    let mut document = Document { spacing: Some(0.08), ..Document::default() };
    let boundary = ring(&mut document, 0.0);
    let raised = [dvec3(0.0, 0.45, 0.5), dvec3(-0.39, -0.22, 0.35), dvec3(0.39, -0.22, 0.35)];
    let raised = raised.map(|at| add_point(&mut document, at));
    let vertices = boundary.iter().chain(&raised).map(|id| SkeletonVertex::Control(*id)).collect();
    // The ring between the boundary 0 1 2 3 and the raised triangle 4 5 6, then that triangle.
    let triangles =
        vec![[0, 1, 4], [1, 5, 4], [1, 2, 5], [2, 6, 5], [2, 3, 6], [3, 0, 6], [0, 4, 6], [4, 5, 6]];
    add_surface(&mut document, vertices, triangles, &[(1, vec![0, 1, 2, 3])]);
    document
}

fn saddle() -> Document {
    let mut document = Document { spacing: Some(0.08), ..Document::default() };
    let at = [dvec3(1.0, 0.0, 0.4), dvec3(0.0, 1.0, -0.4), dvec3(-1.0, 0.0, 0.4), dvec3(0.0, -1.0, -0.4)];
    let boundary = at.map(|at| add_point(&mut document, at));
    add_curve(&mut document, &boundary);
    let vertices = boundary.iter().map(|id| SkeletonVertex::Control(*id)).collect();
    add_surface(&mut document, vertices, vec![[0, 1, 2], [0, 2, 3]], &[(1, vec![0, 1, 2, 3])]);
    document
}

fn cylinder() -> Document {
    let mut document = Document { spacing: Some(0.11), ..Document::default() };
    let low = ring(&mut document, -0.7);
    let high = ring(&mut document, 0.7);
    let vertices = low.iter().chain(&high).map(|id| SkeletonVertex::Control(*id)).collect();
    let triangles =
        vec![[0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]];
    add_surface(&mut document, vertices, triangles, &[(1, vec![0, 1, 2, 3]), (2, vec![4, 5, 6, 7])]);
    document
}

fn ball() -> Document {
    let mut document = Document { spacing: Some(0.12), ..Document::default() };
    let at = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let vertices = at.map(|at| SkeletonVertex::Control(add_point(&mut document, at))).to_vec();
    let triangles =
        vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];
    add_surface(&mut document, vertices, triangles, &[]);
    document
}

fn add_point(document: &mut Document, at: DVec3) -> PointId {
    let id = document.next_point();
    document.points.insert(id, at);
    id
}

fn add_curve(document: &mut Document, through: &[PointId]) -> CurveId {
    let id = document.next_curve();
    document.curves.insert(id, Curve::new(through.to_vec(), true));
    id
}

fn ring(document: &mut Document, z: f64) -> [PointId; 4] {
    let at = [(DIAGONAL, DIAGONAL), (-DIAGONAL, DIAGONAL), (-DIAGONAL, -DIAGONAL), (DIAGONAL, -DIAGONAL)];
    let points = at.map(|(x, y)| add_point(document, dvec3(x, y, z)));
    add_curve(document, &points);
    points
}

fn add_surface(
    document: &mut Document,
    vertices: Vec<SkeletonVertex>,
    triangles: Vec<[u32; 3]>,
    curves: &[(u32, Vec<u32>)],
) {
    let curves =
        curves.iter().map(|(id, along)| Embedding { curve: CurveId(*id), along: along.clone() }).collect();
    let skeleton = Skeleton { vertices, triangles, curves };
    document.surfaces.insert(SurfaceId(1), Surface::new(skeleton));
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn every_example_is_valid_and_fits_in_a_short_link() {
        for kind in Example::all() {
            let document = example(kind);
            document.validate().unwrap();
            let link = ductile_spec::to_fragment(&document);
            let most = if Example::PLAIN.contains(&kind) { 700 } else { 1500 };
            assert!(link.len() < most, "{kind:?}: {} characters", link.len());
        }
    }
}

//! Making the windings of neighbouring faces agree, where the surface has two sides.

use crate::{FaceId, Mesh};

/// For every face slot, whether it must be reversed so that all agree with the lowest face of their
/// piece; and whether that succeeds everywhere.
fn turns(mesh: &Mesh) -> (Vec<bool>, bool) {
    let mut turn = vec![false; mesh.face_slots()];
    let mut seen = vec![false; mesh.face_slots()];
    let mut is_orientable = true;
    let mut stack = Vec::new();
    for seed in mesh.faces() {
        if seen[seed.index()] {
            continue;
        }
        seen[seed.index()] = true;
        stack.push(seed);
        while let Some(f) = stack.pop() {
            for h in f.halfedges() {
                let Some(t) = mesh.twin(h) else { continue };
                let g = t.face();
                let needed = turn[f.index()] ^ (mesh.origin(h) == mesh.origin(t));
                if !seen[g.index()] {
                    seen[g.index()] = true;
                    turn[g.index()] = needed;
                    stack.push(g);
                } else if turn[g.index()] != needed {
                    is_orientable = false;
                }
            }
        }
    }
    (turn, is_orientable)
}

/// Whether the surface has two sides, so that all its faces can be wound alike.
#[must_use]
pub fn is_orientable(mesh: &Mesh) -> bool {
    turns(mesh).1
}

/// Reverses faces so that neighbours agree, each piece following its lowest face, and returns whether they
/// all do. On a one-sided piece they agree save along some seam.
pub fn propagate_orientation(mesh: &mut Mesh) -> bool {
    let (turn, is_orientable) = turns(mesh);
    for (f, _) in turn.iter().enumerate().filter(|(_, turn)| **turn) {
        reverse_face(mesh, FaceId::from_index(f));
    }
    is_orientable
}

/// Turns every face around, and with them the sense of every ring.
pub fn reverse(mesh: &mut Mesh) {
    let faces: Vec<_> = mesh.faces().collect();
    for f in faces {
        reverse_face(mesh, f);
    }
}

/// Turns one face around: corners `(a, b, c)` become `(b, a, c)`. Side 0 keeps its number, sides 1 and 2
/// change places.
pub fn reverse_face(mesh: &mut Mesh, f: FaceId) {
    let [a, b, c] = mesh.face_vertices(f);
    let anchored = [a, b, c].map(|v| mesh.anchor(v));
    let [ab, bc, ca] = f.halfedges().map(|h| mesh.outside(h));
    mesh.place(f, [b, a, c], [ab, ca, bc]);
    // `place` has anchored the corners here; those anchored elsewhere stay there.
    for (v, h) in [a, b, c].into_iter().zip(anchored) {
        if h.face() != f {
            mesh.anchor[v.index()] = h.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{primitive, validate};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn one_sided_surfaces_are_known() {
        assert!(is_orientable(&primitive::plane(3, 2, 1.0).0));
        assert!(is_orientable(&primitive::torus(5, 4, 2.0, 1.0).0));
        assert!(!is_orientable(&primitive::moebius(6, 2, 2.0, 1.0).0));
        assert!(!is_orientable(&primitive::klein_bottle(6, 6, 2.0, 1.0).0));
    }

    #[test]
    fn disorder_is_put_right() {
        let (tidy, _) = primitive::icosphere(1);
        let mut mesh = tidy.clone();
        for f in tidy.faces().filter(|f| f.index() % 3 == 1) {
            reverse_face(&mut mesh, f);
            assert_eq!(validate(&mesh), Ok(()));
        }
        assert!(!mesh.edges().all(|e| mesh.is_wound_alike(e)));
        assert!(propagate_orientation(&mut mesh));
        assert_eq!(validate(&mesh), Ok(()));
        assert!(mesh.edges().all(|e| mesh.is_wound_alike(e) && mesh.do_rings_agree(e)));
        let same_sense = |f: FaceId| {
            let ([a, b, c], tidy) = (mesh.face_vertices(f), tidy.face_vertices(f));
            [[a, b, c], [b, c, a], [c, a, b]].contains(&tidy)
        };
        assert!(mesh.faces().all(same_sense), "the lowest face leads, and it was not touched");
    }

    #[test]
    fn a_one_sided_surface_keeps_a_seam() {
        let (mut mesh, _) = primitive::moebius(6, 2, 2.0, 1.0);
        assert!(!propagate_orientation(&mut mesh));
        assert_eq!(validate(&mesh), Ok(()));
        assert!(mesh.edges().any(|e| !mesh.is_wound_alike(e)));
    }

    #[test]
    fn reversing_turns_the_rings() {
        let (mut mesh, _) = primitive::octahedron();
        let (mut before, mut after) = (Vec::new(), Vec::new());
        let v = crate::VertexId::from_index(0);
        mesh.ring(v, &mut before);
        reverse(&mut mesh);
        assert_eq!(validate(&mesh), Ok(()));
        mesh.ring(v, &mut after);
        after.reverse();
        let shift = after.iter().position(|w| *w == before[0]).unwrap();
        after.rotate_left(shift);
        assert_eq!(after, before);
    }
}

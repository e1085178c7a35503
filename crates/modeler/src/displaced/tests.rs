//! Displaced surfaces through the one door.

use crate::modeler::Modeler;
use ductile_spec::{
    Blending, Cage, Combination, Curve, Displaced, Displacement, Displacing, Document, Edit, Example,
    ExportFormat, Foot, GrabTarget, Hold, PointId, Reply, Request, Skeleton, SkeletonVertex, Step, Stretch,
    Structure, Surface, SurfaceId, VERTEX_FLOATS, from_text, to_text,
};
use glam::DVec3;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const ONE: SurfaceId = SurfaceId(1);

/// A modeler, with the structure that its frames have.
struct Bench {
    modeler: Modeler,
    structure: Structure,
    settled: bool,
}

impl Bench {
    fn open(request: Request) -> Self {
        let mut bench = Self { modeler: Modeler::new(), structure: Structure::default(), settled: false };
        bench.accept(request);
        bench.rest();
        bench
    }

    fn disc() -> Self {
        Self::open(Request::OpenExample(Example::Disc))
    }

    fn document(document: &Document) -> Self {
        Self::open(Request::OpenText { text: to_text(document) })
    }

    fn ask(&mut self, request: Request) -> Reply {
        let reply = self.modeler.handle(request);
        self.settled = reply.frame.settled;
        if let Some(structure) = &reply.structure {
            self.structure = structure.clone();
        }
        assert_eq!(self.modeler.floats().len(), self.structure.float_count());
        assert_eq!(self.modeler.indices().len(), self.structure.index_count());
        reply
    }

    fn accept(&mut self, request: Request) -> Reply {
        let reply = self.ask(request);
        assert_eq!(reply.refused, None);
        reply
    }

    fn refuse(&mut self, edit: Edit) -> String {
        let before = self.spec().clone();
        let reply = self.ask(Request::Edit(edit));
        assert_eq!(*self.spec(), before);
        reply.refused.unwrap().reason
    }

    fn edit(&mut self, edit: Edit) {
        self.accept(Request::Edit(edit));
    }

    fn step(&mut self, drag: Option<DVec3>) {
        self.accept(Request::Step(Step { drag, iterations: 20 }));
    }

    fn rest(&mut self) {
        for _ in 0..700 {
            if self.settled {
                return;
            }
            self.step(None);
        }
        panic!("no rest");
    }

    fn spec(&self) -> &Document {
        &self.modeler.model().document
    }

    fn displaced(&self) -> &Displaced {
        &self.spec().displacements[&ONE]
    }

    fn shown(&self, vertex: u32) -> DVec3 {
        let at = vertex as usize * VERTEX_FLOATS;
        DVec3::from_array([0, 1, 2].map(|k| f64::from(self.modeler.floats()[at + k])))
    }

    fn normal(&self, vertex: u32) -> DVec3 {
        let at = vertex as usize * VERTEX_FLOATS + 3;
        DVec3::from_array([0, 1, 2].map(|k| f64::from(self.modeler.floats()[at + k])))
    }

    fn all(&self) -> Vec<DVec3> {
        (0..self.structure.surfaces[0].vertex_count).map(|v| self.shown(v)).collect()
    }

    /// The largest distance of some places from the triangles that are shown.
    fn farthest(&self, places: &[DVec3]) -> f64 {
        let (all, indices) = (self.all(), self.modeler.indices());
        let triangles: Vec<[u32; 3]> = indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
        let distance = |at: &DVec3| {
            let (corners, shares) = ductile_patch::nearest_spot(&all, &triangles, *at).unwrap();
            let place: DVec3 = corners.iter().zip(shares).map(|(&v, share)| all[v as usize] * share).sum();
            place.distance(*at)
        };
        places.iter().map(distance).fold(0.0, f64::max)
    }

    fn foot(&self, number: u32) -> DVec3 {
        let foot = self.structure.feet.iter().find(|foot| foot.number == number).unwrap();
        self.shown(foot.vertex)
    }

    /// The place of the surface below at a foot.
    fn below(&self, number: u32) -> DVec3 {
        self.foot(number) - self.displaced().items[number as usize - 1].by
    }
}

fn displace(at: DVec3, by: DVec3) -> Edit {
    Edit::Displace { surface: ONE, displacement: Displacement::new(at, by) }
}

fn displacing(at: DVec3, range: f64) -> Displacing {
    Displacing { surface: ONE, at, along: None, range, direction: None }
}

/// The distance of a place from the nearest of some.
fn distance(places: &[DVec3], at: DVec3) -> f64 {
    places.iter().map(|place| place.distance(at)).fold(f64::INFINITY, f64::min)
}

/// A disc that a drag has not raised yet.
fn places_inside(bench: &Bench) -> [DVec3; 2] {
    let all = bench.all();
    let centre = all.iter().sum::<DVec3>() / all.len() as f64;
    let near = |at: DVec3| *all.iter().min_by(|a, b| a.distance(at).total_cmp(&b.distance(at))).unwrap();
    [near(centre + DVec3::X * 0.3), near(centre - DVec3::X * 0.3)]
}

#[test]
fn a_foot_moves_by_exactly_what_is_asked_and_the_boundary_stays() {
    let mut bench = Bench::disc();
    let (plain, count) = (bench.all(), bench.structure.surfaces[0].vertex_count);
    let [one, other] = places_inside(&bench);
    let between = one + DVec3::new(0.011, 0.017, 0.0);
    bench.edit(displace(between, DVec3::new(0.0, 0.05, 0.4)));
    bench.edit(displace(other, DVec3::Z * -0.2));
    bench.rest();
    assert_eq!(bench.structure.feet.len(), 2);
    // Feet between vertices get vertices of their own; the frame has room for them.
    assert!(bench.structure.surfaces[0].vertex_count > count);
    for (number, at) in [(1, between), (2, other)] {
        let below = bench.below(number);
        assert!(below.distance(at) < 0.02, "{below} for {at}");
        assert!(distance(&plain, below) < 0.08);
    }
    let moved = bench.all().into_iter().zip(&plain).map(|(now, before)| now.distance(*before));
    let moved: Vec<f64> = moved.collect();
    assert!(moved.iter().filter(|by| **by > 1e-3).count() > 100, "a neighbourhood moves");
    let shape = &bench.modeler.model().surfaces[&ONE];
    let still = shape.mesh.vertices().zip(&moved).filter(|(v, _)| shape.mesh.is_boundary_vertex(*v));
    let still: Vec<f64> = still.map(|(_, by)| *by).collect();
    assert!(still.len() > 20 && still.iter().all(|by| *by < 1e-6), "{still:?}");
    // The surface below knows nothing of it.
    let below = shape.mesh.vertices().map(|v| shape.positions[v.index()]).zip(&plain);
    let far = below.map(|(now, before)| now.distance(*before)).fold(0.0, f64::max);
    assert!(far < 1e-4, "{far}");
}

#[test]
fn normals_are_those_of_the_displaced_surface() {
    let mut bench = Bench::disc();
    let [one, _] = places_inside(&bench);
    bench.edit(displace(one, DVec3::Z * 0.3));
    bench.rest();
    // Against what the triangles around each vertex say, which is coarser.
    let mut sums = vec![DVec3::ZERO; bench.all().len()];
    for corners in bench.modeler.indices().chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|k| bench.shown(corners[k]));
        corners.iter().for_each(|&v| sums[v as usize] += (b - a).cross(c - a));
    }
    let turn =
        |(v, sum): (usize, &DVec3)| sum.normalize_or_zero().dot(bench.normal(u32::try_from(v).unwrap()));
    let cosines: Vec<f64> = sums.iter().enumerate().map(turn).collect();
    let mean = cosines.iter().sum::<f64>() / cosines.len() as f64;
    assert!(mean > 0.998, "{mean}");
    assert!(cosines.iter().all(|cos| *cos > 0.9), "{:?}", cosines.iter().copied().fold(1.0, f64::min));
}

#[test]
fn undo_erase_and_drop_give_the_same_documents_and_pictures() {
    let mut bench = Bench::disc();
    let (plain, document) = (bench.all(), bench.spec().clone());
    let [one, other] = places_inside(&bench);
    bench.edit(displace(one, DVec3::Z * 0.3));
    bench.rest();
    let (first, with_one) = (bench.all(), bench.spec().clone());
    bench.edit(displace(other, DVec3::X * 0.1));
    bench.edit(Edit::EraseDisplacement { surface: ONE, number: 1 });
    assert_eq!(bench.displaced().items.len(), 1);
    bench.accept(Request::Undo);
    bench.accept(Request::Undo);
    bench.rest();
    assert_eq!(*bench.spec(), with_one);
    let far = bench.all().into_iter().zip(&first).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(far < 1e-5, "{far}");
    bench.edit(Edit::DropDisplacements { surface: ONE });
    assert_eq!(*bench.spec(), document);
    bench.rest();
    assert!(bench.all().into_iter().zip(&plain).all(|(a, b)| a.distance(b.to_owned()) < 1e-5));
    assert!(bench.structure.feet.is_empty());
    assert!(bench.refuse(Edit::DropDisplacements { surface: ONE }).contains("no displacements"));
    let erase = Edit::EraseDisplacement { surface: ONE, number: 1 };
    assert!(bench.refuse(erase).contains("no displacement 1"));
}

#[test]
fn a_drag_takes_the_foot_to_the_hand_as_one_act() {
    let mut bench = Bench::disc();
    let document = bench.spec().clone();
    let [at, _] = places_inside(&bench);
    let target = GrabTarget::Displace(displacing(at, -0.5));
    let pulled = bench.accept(Request::Grab(target)).pulled.unwrap();
    assert_eq!((pulled.surface, pulled.number), (ONE, 1));
    assert!(pulled.at.distance(at) < 0.01);
    for step in 1..=8 {
        let hand = pulled.at + DVec3::new(0.01, 0.0, 0.05) * f64::from(step);
        bench.step(Some(hand));
        assert!(bench.foot(1).distance(hand) < 1e-5, "{} and {hand}", bench.foot(1));
    }
    let reply = bench.accept(Request::Drop);
    assert_eq!(reply.committed.unwrap().act, "Displace");
    assert_eq!(bench.displaced().items[0].range, -0.5);
    bench.rest();
    let end = bench.foot(1);
    assert!(end.distance(pulled.at + DVec3::new(0.08, 0.0, 0.4)) < 1e-4);
    // The foot can be taken again; given up, everything is as it was.
    bench.accept(Request::Grab(GrabTarget::Foot { surface: ONE, number: 1 }));
    bench.step(Some(end + DVec3::X * 0.1));
    let with = bench.displaced().items[0].by;
    bench.accept(Request::Cancel);
    assert!(bench.displaced().items[0].by != with);
    bench.accept(Request::Undo);
    assert_eq!(*bench.spec(), document);
    bench.accept(Request::Grab(target));
    assert_eq!(bench.accept(Request::Drop).committed, None);
    assert_eq!(*bench.spec(), document, "a drag that did not move is no act");
}

#[test]
fn a_control_below_is_dragged_and_the_foot_goes_along() {
    let mut bench = Bench::disc();
    let [at, _] = places_inside(&bench);
    bench.edit(displace(at, DVec3::Z * 0.3));
    bench.rest();
    let point = *bench.spec().points.keys().next().unwrap();
    let from = bench.spec().points[&point];
    bench.accept(Request::Grab(GrabTarget::Point(point)));
    let mut before = bench.foot(1);
    for step in 1..=20 {
        bench.step(Some(from + DVec3::Z * 0.02 * f64::from(step)));
        let now = bench.foot(1);
        assert!(now.distance(before) < 0.1, "no leap: {before} to {now}");
        before = now;
    }
    bench.accept(Request::Drop);
    let dropped = bench.all();
    let foot = bench.foot(1);
    // The document's place went along with the surface.
    let documented = bench.displaced().items[0].foot.places()[0];
    assert!(documented.distance(bench.below(1)) < 1e-4 && documented.distance(at) > 1e-4);
    bench.rest();
    assert!(bench.foot(1).distance(foot) < 0.03, "{} to {foot}", bench.foot(1));
    // What is left is the way that the surface below still went.
    let far = bench.farthest(&dropped);
    assert!(far < 0.02, "{far}");
}

#[test]
fn a_document_that_is_opened_again_shows_the_same() {
    let mut bench = Bench::disc();
    let [one, other] = places_inside(&bench);
    bench.edit(displace(one + DVec3::new(0.013, 0.0, 0.0), DVec3::Z * 0.3));
    bench.edit(displace(other, DVec3::new(0.1, 0.0, -0.2)));
    let point = *bench.spec().points.keys().next().unwrap();
    let to = bench.spec().points[&point] + DVec3::Z * 0.2;
    bench.edit(Edit::Move { point, to });
    bench.rest();
    let again = Bench::document(&from_text(&to_text(bench.spec())).unwrap());
    assert_eq!(again.spec(), bench.spec());
    // Another mesh of the same surface, a hundredth of its radius apart at most.
    for number in [1, 2] {
        let [a, b] = [&bench, &again].map(|bench| bench.foot(number));
        assert!(a.distance(b) < 0.01, "{a} and {b}");
    }
    let far = again.farthest(&bench.all()).max(bench.farthest(&again.all()));
    assert!(far < 0.01, "{far}");
}

#[test]
fn places_that_are_pointed_at_lie_on_what_is_shown() {
    let mut bench = Bench::disc();
    let [at, _] = places_inside(&bench);
    bench.edit(displace(at, DVec3::Z * 0.5));
    bench.rest();
    let (shown, below) = (bench.foot(1), bench.below(1));
    bench.edit(Edit::Pin { surface: ONE, at: shown });
    let pinned = *bench.spec().points.values().next_back().unwrap();
    assert!(pinned.distance(below) < 0.02, "{pinned} under {shown}");
    bench.accept(Request::Undo);
    // Drags as well.
    let grabbed = bench.accept(Request::Grab(GrabTarget::Surface { surface: ONE, at: shown })).grabbed;
    assert!(grabbed.unwrap().at.distance(below) < 0.02);
    bench.accept(Request::Cancel);
    let text = bench.accept(Request::Export(ExportFormat::Obj)).exported.unwrap().text;
    let most = text
        .lines()
        .filter(|line| line.starts_with("v "))
        .filter_map(|line| line.split(' ').nth(3)?.parse::<f64>().ok());
    assert!(most.fold(0.0, f64::max) > shown.z - 1e-6, "what is exported is what is shown");
}

#[test]
fn a_sum_drags_other_feet_along_and_pairs_do_not() {
    let mut bench = Bench::disc();
    let [one, other] = places_inside(&bench);
    bench.edit(displace(one, DVec3::Z * 0.2));
    bench.edit(displace(other, DVec3::Z * 0.2));
    bench.rest();
    let exact = bench.foot(1);
    let blending = Blending { combination: Combination::Plain, ..Blending::default() };
    bench.edit(Edit::Blending { surface: ONE, blending });
    bench.rest();
    assert!(bench.foot(1).z > exact.z + 1e-3, "{} and {exact}", bench.foot(1));
    // A foot that is pulled ends where the hand is all the same.
    let pulled = bench.accept(Request::Grab(GrabTarget::Foot { surface: ONE, number: 1 })).pulled.unwrap();
    let hand = pulled.at + DVec3::Z * 0.1;
    bench.step(Some(hand));
    assert!(bench.foot(1).distance(hand) < 1e-5);
    bench.accept(Request::Drop);
}

/// A tetrahedron of a skeleton: a closed surface through four points, nearly a ball.
fn closed() -> Document {
    let mut document = Document::default();
    let places =
        [DVec3::ONE, DVec3::new(1.0, -1.0, -1.0), DVec3::new(-1.0, 1.0, -1.0), DVec3::new(-1.0, -1.0, 1.0)];
    for (k, at) in (1..).zip(places) {
        document.points.insert(PointId(k), at);
    }
    let vertices = (1..=4).map(|k| SkeletonVertex::Control(PointId(k))).collect();
    let triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    document.surfaces.insert(ONE, Surface::new(Skeleton { vertices, triangles, curves: Vec::new() }));
    document
}

#[test]
fn a_closed_surface_needs_a_pin_and_stays_there() {
    let mut bench = Bench::document(&closed());
    let all = bench.all();
    let top = *all.iter().max_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
    let bottom = *all.iter().min_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
    assert!(bench.refuse(displace(top, DVec3::Z)).contains("closed"));
    let grab = bench.ask(Request::Grab(GrabTarget::Displace(displacing(top, 0.0))));
    let reason = grab.refused.unwrap().reason;
    assert!(reason.contains("closed") && reason.contains("Shift-click"), "{reason}");
    let pins = vec![Hold::Around { at: bottom, radius: 0.5 }];
    bench.edit(Edit::Blending { surface: ONE, blending: Blending { pins, ..Blending::default() } });
    bench.edit(displace(top, DVec3::Z * 0.5));
    bench.rest();
    assert!(bench.foot(1).distance(top + DVec3::Z * 0.5) < 0.05);
    let held = all.iter().zip(bench.all()).filter(|(before, _)| before.distance(bottom) < 0.4);
    assert!(held.clone().count() > 5);
    held.for_each(|(before, now)| assert!(before.distance(now) < 1e-5));
    assert!(bench.refuse(displace(bottom, DVec3::Z)).contains("pin"));
}

#[test]
fn a_surface_over_a_cage_is_displaced_and_follows_its_points() {
    let mut document = Document::default();
    for k in 0..8_u32 {
        let side = |bit: u32| if k & bit == 0 { -1.0 } else { 1.0 };
        document.points.insert(PointId(k + 1), DVec3::new(side(1), side(2), side(4)));
    }
    // A box without its lid.
    let faces = [[1, 3, 4, 2], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]];
    document.cages.insert(ONE, Cage::new(faces.map(|face| face.map(PointId).to_vec()).to_vec()));
    let mut bench = Bench::document(&document);
    let plain = bench.all();
    let at = *plain.iter().min_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
    bench.edit(displace(at, DVec3::Z * -0.5));
    assert!(bench.foot(1).distance(at - DVec3::Z * 0.5) < 1e-5);
    for (point, by) in (1..=8).map(|k| (PointId(k), DVec3::X * 0.5)) {
        let to = bench.spec().points[&point] + by;
        bench.edit(Edit::Move { point, to });
    }
    let moved = at + DVec3::X * 0.5;
    assert!(bench.displaced().items[0].foot.places()[0].distance(moved) < 1e-4);
    assert!(bench.foot(1).distance(moved - DVec3::Z * 0.5) < 1e-3);
    // In the middle of a drag too.
    let from = bench.spec().points[&PointId(1)];
    bench.accept(Request::Grab(GrabTarget::Point(PointId(1))));
    let before = bench.foot(1);
    bench.step(Some(from - DVec3::Z * 0.5));
    assert!(bench.foot(1).distance(before) > 1e-4);
    bench.accept(Request::Drop);
    bench.edit(Edit::DeleteSurface { surface: ONE });
    assert!(bench.spec().displacements.is_empty());
}

#[test]
fn a_place_that_is_added_moves_with_the_foot() {
    let mut bench = Bench::disc();
    let [one, other] = places_inside(&bench);
    let by = DVec3::new(0.05, 0.0, 0.2);
    bench.edit(displace(one, by));
    let shown = bench.all();
    let nearer = |a: &&DVec3, b: &&DVec3| a.distance(other).total_cmp(&b.distance(other));
    let at = *shown.iter().min_by(nearer).unwrap();
    bench.edit(Edit::AddFoot { surface: ONE, number: 1, at });
    let Foot::All(places) = bench.displaced().items[0].foot.clone() else { panic!("several places") };
    assert_eq!(places.len(), 2);
    for place in places {
        assert!(place.z.abs() < 1e-6, "it lies on the disc below: {place}");
        assert!(distance(&bench.all(), place + by) < 1e-5, "and moves by what is asked: {place}");
    }
    assert!(bench.refuse(Edit::AddFoot { surface: ONE, number: 2, at }).contains("no displacement 2"));
}

#[test]
fn a_curve_inside_is_a_foot_that_cannot_be_deleted() {
    let mut bench = Bench::disc();
    let [one, other] = places_inside(&bench);
    bench.edit(Edit::SLoop { surface: ONE, along: vec![one, other], closed: false });
    bench.rest();
    let curve = *bench.spec().curves.keys().next_back().unwrap();
    let displacement =
        Displacement { foot: Foot::Along(curve), ..Displacement::new(DVec3::ZERO, DVec3::Z * 0.3) };
    bench.edit(Edit::Displace { surface: ONE, displacement });
    bench.rest();
    let nodes = bench.modeler.model().curves[&curve].nodes.clone();
    let all = bench.all();
    for node in nodes {
        assert!(distance(&all, node + DVec3::Z * 0.3) < 1e-5);
    }
    assert!(bench.refuse(Edit::DeleteCurve { curve }).contains("hang"));
    let rim = *bench.spec().curves.keys().next().unwrap();
    let displacement = Displacement { foot: Foot::Along(rim), ..Displacement::new(DVec3::ZERO, DVec3::Z) };
    assert!(bench.refuse(Edit::Displace { surface: ONE, displacement }).contains("boundary"));
    let _: &Curve = &bench.spec().curves[&rim];
}

#[test]
fn a_drag_takes_a_whole_curve_along_as_one_act() {
    let mut bench = Bench::disc();
    let [one, other] = places_inside(&bench);
    bench.edit(Edit::SLoop { surface: ONE, along: vec![one, other], closed: false });
    bench.rest();
    let (document, plain) = (bench.spec().clone(), bench.all());
    let curve = *document.curves.keys().next_back().unwrap();
    let nodes = bench.modeler.model().curves[&curve].nodes.clone();
    let hand = nodes[nodes.len() / 3];
    let begun = Displacing { along: Some(curve), ..displacing(hand, 0.2) };
    let reach = bench.accept(Request::Reach(begun)).reach.unwrap();
    let mean =
        |places: &mut dyn Iterator<Item = DVec3>| places.fold(0.0, |far, at| far + distance(&nodes, at));
    let count = reach.segments.len() as f64;
    let influence = |at: &DVec3| {
        let nearest = |a: &usize, b: &usize| plain[*a].distance(*at).total_cmp(&plain[*b].distance(*at));
        reach.influence[(0..plain.len()).min_by(nearest).unwrap()]
    };
    assert_eq!(reach.influence.len(), plain.len(), "each vertex has its own");
    assert!(nodes.iter().all(|node| influence(node) > 250), "the curve goes along as a whole");
    let far = |at: &DVec3| distance(&nodes, *at) > 0.05 && (30..225).contains(&influence(at));
    assert!(plain.iter().any(far), "between them it fades");
    assert_eq!(*reach.influence.iter().min().unwrap(), 0, "the rim stays");
    assert!(mean(&mut reach.segments.iter().map(|ends| ends[0])) / count > 0.05, "it runs around the curve");
    let target = GrabTarget::Displace(begun);
    let pulled = bench.accept(Request::Grab(target)).pulled.unwrap();
    let by = DVec3::new(0.02, 0.0, 0.3);
    bench.step(Some(pulled.at + 0.5 * by));
    bench.step(Some(pulled.at + by));
    let feet = bench.structure.feet.clone();
    assert_eq!(feet.len(), nodes.len(), "each of its vertices has an entry");
    for (foot, node) in feet.iter().zip(&nodes) {
        assert!(bench.shown(foot.vertex).distance(*node + by) < 1e-5, "in order, and by the drag");
    }
    assert_eq!(bench.accept(Request::Drop).committed.unwrap().act, "Displace");
    assert_eq!(bench.displaced().items[0].foot, Foot::Along(curve));
    bench.rest();
    // It can be taken again; a drag that is given up leaves nothing.
    let again = bench.accept(Request::Grab(GrabTarget::Foot { surface: ONE, number: 1 })).pulled.unwrap();
    assert!(again.at.distance(pulled.at + by) < 1e-5);
    bench.step(Some(again.at + DVec3::Y));
    bench.accept(Request::Cancel);
    bench.accept(Request::Undo);
    assert_eq!(*bench.spec(), document);
    bench.rest();
    assert!(bench.all().iter().zip(&plain).all(|(a, b)| a.distance(*b) < 1e-5));
    // A rim cannot move, and a curve that is a foot already cannot be another one.
    let rim = *document.curves.keys().next().unwrap();
    let grab = GrabTarget::Displace(Displacing { along: Some(rim), ..begun });
    assert!(bench.ask(Request::Grab(grab)).refused.unwrap().reason.contains("boundary"));
    assert_eq!(*bench.spec(), document);
}

#[test]
fn a_stretched_reach_is_as_many_times_longer_than_wide() {
    let mut bench = Bench::disc();
    let all = bench.all();
    let at = all.iter().sum::<DVec3>() / all.len() as f64;
    let extent = |bench: &mut Bench, direction| {
        let trial = Displacing { direction, ..displacing(at, -2.0) };
        let segments = bench.accept(Request::Reach(trial)).reach.unwrap().segments;
        let far = |axis: usize| {
            segments.iter().flatten().map(|end| (end[axis] - at[axis]).abs()).fold(0.0, f64::max)
        };
        [far(0), far(1)]
    };
    let [x, y] = extent(&mut bench, None);
    assert!((x / y - 1.0).abs() < 0.1, "{x} {y}");
    for (along, times) in [(DVec3::X, 3.0), (DVec3::Y * 7.0, 1.0 / 3.0)] {
        let [x, y] = extent(&mut bench, Some(Stretch { along, times }));
        assert!((x / y / 3.0 - 1.0).abs() < 0.2, "{x} {y}");
    }
}

#[test]
fn what_is_burnt_out_takes_its_displacement_with_it_and_the_rest_keeps_its_own() {
    let mut bench = Bench::disc();
    let [one, other] = places_inside(&bench);
    bench.edit(displace(one, DVec3::Z * 0.1));
    bench.edit(displace(other, DVec3::Z * 0.1));
    bench.rest();
    let around = |k: u32| {
        let (sin, cos) = libm::sincos(f64::from(k) * core::f64::consts::FRAC_PI_2);
        one + DVec3::new(cos, sin, 0.0) * 0.15
    };
    bench.edit(Edit::SLoop { surface: ONE, along: (0..4).map(around).collect(), closed: true });
    bench.rest();
    assert_eq!(bench.displaced().items.len(), 2);
    let region = ductile_spec::On { surface: ONE, at: bench.foot(1) };
    bench.edit(Edit::Burnout { region });
    let items = &bench.displaced().items;
    assert_eq!(items.len(), 1, "{items:?}");
    assert!(items[0].foot.places()[0].distance(other) < 0.05);
    bench.rest();
    assert!(bench.foot(1).is_finite());
}

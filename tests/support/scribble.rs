//! Bytes as a sequence of requests: what a fuzzer writes. Each byte or two is a choice, so that a changed byte changes one thing;
//! every sequence of bytes means something, and nothing is too wild to be asked.

use crate::dice::{Dice, place, propose};
use crate::round::Round;
use crate::shapes;
use ductile_modeler::Model;
use ductile_spec::{
    CurveId, Displacement, Displacing, Edit, ExportFormat, Extent, GrabTarget, Handle, ObjectiveOf, On,
    PointId, Request, Resume, SpacingOf, Step, Stretch, SurfaceId, Through, to_compact_text, to_fragment,
};
use glam::DVec3;

/// Requests that one sequence may make.
const MOST: usize = 40;
/// A model with more nodes than this takes too long to be worth more.
const ENOUGH: usize = 4000;
/// Numbers that are at an edge of something.
const WILD: [f64; 14] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    -0.0,
    -1.0,
    1e-300,
    f64::MIN_POSITIVE,
    1e-9,
    1e5,
    1e6,
    1.000_001e6,
    1e300,
    f64::MAX,
];

/// Does what the bytes say on a document that the first of them chooses, and checks every promise. Gives the requests.
///
/// # Panics
/// When a promise is broken: that is a fault of the modeler.
pub fn run(bytes: &[u8]) -> Vec<Request> {
    let mut asked = Vec::new();
    run_told(bytes, |request| asked.push(request.clone()));
    asked
}

/// The same; each request is shown before it is made, so that it is known which one failed.
///
/// # Panics
/// When a promise is broken.
pub fn run_told(bytes: &[u8], mut tell: impl FnMut(&Request)) {
    let mut dice = Dice::told(bytes);
    let documents = shapes::for_surgery();
    let document = &documents[dice.below(documents.len())];
    let mut round = Round::new(&to_compact_text(document));
    for _ in 0..MOST {
        if dice.is_spent() || round.bench.modeler.model().node_count() > ENOUGH {
            break;
        }
        let request = request(&mut dice, round.bench.modeler.model());
        tell(&request);
        round.ask(&request);
    }
    round.opens();
}

fn request(dice: &mut Dice, model: &Model) -> Request {
    let surfaces: Vec<SurfaceId> = model.surfaces.keys().copied().collect();
    let surface = dice.pick(&surfaces).unwrap_or(SurfaceId(99));
    match dice.below(32) {
        0..=1 => Request::Grab(target(dice, model, surface)),
        2..=4 => {
            let drag = Some(if dice.below(8) == 0 { wild(dice) } else { 1.5 * dice.vector() });
            Request::Step(Step { drag, iterations: 20 })
        }
        5 => Request::Step(Step { drag: None, iterations: [0, 1, 3, u32::MAX][dice.below(4)] }),
        6..=7 => Request::Drop,
        8 => Request::Cancel,
        9 if dice.coin() => {
            let shape = model.surfaces.get(&surface).map(|shape| &**shape);
            let range = if dice.coin() { number(dice) } else { dice.unit() };
            Request::Reach(displacing(model, surface, place(dice, model, shape), range))
        }
        9 => Request::Meet { first: surface, second: dice.pick(&surfaces).unwrap_or(SurfaceId(99)) },
        10 => Request::Export(ExportFormat::Obj),
        11 => Request::Describe,
        12 => Request::Resume(Resume::default()),
        13 => Request::OpenLink { link: scrawled(dice, &to_fragment(&model.document)) },
        14 => Request::OpenText { text: scrawled(dice, &to_compact_text(&model.document)) },
        15..=16 => Request::Edit(wild_edit(dice, model, surface)),
        17 if dice.below(8) == 0 => Request::New,
        _ => propose(dice, model),
    }
}

/// What would be displaced from a place: on one side of the model a curve, here and there in a direction.
fn displacing(model: &Model, surface: SurfaceId, at: DVec3, range: f64) -> Displacing {
    let curves = model.document.surfaces.get(&surface).into_iter().flat_map(|s| &s.skeleton.curves);
    let along = curves.map(|embedded| embedded.curve).next_back().filter(|_| at.x > 0.0);
    let direction = (at.y > 0.0).then_some(Stretch { along: at, times: 2.0 + at.z });
    Displacing { surface, at, along, range, direction }
}

fn target(dice: &mut Dice, model: &Model, surface: SurfaceId) -> GrabTarget {
    let points: Vec<PointId> = model.document.points.keys().copied().collect();
    let curves: Vec<CurveId> = model.curves.keys().copied().collect();
    let point = dice.pick(&points).unwrap_or(PointId(99));
    let curve = dice.pick(&curves).unwrap_or(CurveId(99));
    let at = place(dice, model, model.surfaces.get(&surface).map(|shape| &**shape));
    match dice.below(6) {
        0..=1 => GrabTarget::Point(point),
        2 => GrabTarget::Curve { curve, at },
        3..=4 => GrabTarget::Surface { surface, at },
        _ if dice.coin() => GrabTarget::Displace(displacing(model, surface, at, 0.9 - 2.0 * dice.unit())),
        _ if dice.coin() => GrabTarget::Foot { surface, number: dice.below(3) },
        _ => GrabTarget::Handle(Handle::Tangent { curve, point }),
    }
}

fn number(dice: &mut Dice) -> f64 {
    WILD[dice.below(WILD.len())]
}

/// A vector with a number in it that is at an edge of something.
fn wild(dice: &mut Dice) -> DVec3 {
    let mut vector = dice.vector();
    vector[dice.below(3)] = number(dice);
    vector
}

/// An act with such a number.
fn wild_edit(dice: &mut Dice, model: &Model, surface: SurfaceId) -> Edit {
    let points: Vec<PointId> = model.document.points.keys().copied().collect();
    let curves: Vec<CurveId> = model.curves.keys().copied().collect();
    let point = dice.pick(&points).unwrap_or(PointId(99));
    let curve = dice.pick(&curves).unwrap_or(CurveId(99));
    let shape = model.surfaces.get(&surface).map(|shape| &**shape);
    let (at, wild) = (place(dice, model, shape), wild(dice));
    let on = On { surface, at };
    match dice.below(15) {
        0 => Edit::Point { at: wild },
        1 => Edit::Move { point, to: wild },
        2 => Edit::Curve { through: [wild, at, -at].map(Through::Place).to_vec(), closed: dice.coin() },
        3 => Edit::SLoop { surface, along: vec![at, wild, -at, at], closed: dice.coin() },
        4 => Edit::Burnout { region: On { surface, at: wild } },
        5 => Edit::Glue { from: on, to: On { surface, at: wild }, skirt: dice.coin(), reversed: dice.coin() },
        6 => {
            let to = On { surface, at: if dice.coin() { -at } else { wild } };
            Edit::Merge { from: on, to, radius: number(dice), keep: dice.coin() }
        }
        7 => {
            let second = On { surface: SurfaceId(2), at: wild };
            Edit::Trim {
                first: on,
                second,
                smooth: dice.coin(),
                ribbon: dice.coin().then_some(ductile_spec::JoinRibbon::AsMet),
            }
        }
        8 => Edit::Expand { curve, to: Extent::Radius(number(dice)) },
        9 => Edit::Pin { surface, at: wild },
        10 => Edit::Insert { curve, at: wild },
        11 => {
            let of = match dice.below(3) {
                0 => SpacingOf::Document,
                1 => SpacingOf::Surface(surface),
                _ => SpacingOf::Region { surface, at: wild },
            };
            Edit::Spacing { of, spacing: Some(number(dice)) }
        }
        12 => Edit::Tangent { curve, point, direction: Some(wild) },
        13 if dice.coin() => Edit::Displace {
            surface,
            displacement: Displacement { range: number(dice), ..Displacement::new(at, wild) },
        },
        13 => Edit::Normal { surface, point, normal: Some(wild) },
        _ if dice.coin() => {
            let second = SurfaceId(if dice.coin() { 2 } else { 1 });
            Edit::MergeClosest { first: surface, second, radius: number(dice), keep: dice.coin() }
        }
        _ => Edit::Objective { of: ObjectiveOf::Region { surface, at: wild }, objective: None },
    }
}

/// A text, now and then with a character changed, doubled or gone, or cut off.
fn scrawled(dice: &mut Dice, text: &str) -> String {
    let mut letters: Vec<char> = text.chars().collect();
    for _ in 0..dice.below(4) {
        let at = dice.below(letters.len().max(1));
        let Some(letter) = letters.get(at).copied() else { continue };
        match dice.below(4) {
            0 => letters[at] = char::from(b' ' + u8::try_from(dice.below(95)).unwrap_or(0)),
            1 => letters.insert(at, letter),
            2 => drop(letters.remove(at)),
            _ => letters.truncate(at),
        }
    }
    letters.into_iter().collect()
}

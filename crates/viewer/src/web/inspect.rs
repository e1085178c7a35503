//! What the page tells of itself, for those who embed or test it.

use super::dom::{self, put};
use super::page::{Page, act, look};
use crate::tool::Selection;
use ductile_spec::TRAP;
use glam::Vec3;
use js_sys::{Array, JSON, Object};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};

/// The state of the page as JSON; empty while there is none.
#[wasm_bindgen]
#[must_use]
pub fn inspect() -> String {
    let state = look(|page| JSON::stringify(&page.described()).ok()).flatten();
    state.and_then(|text| text.as_string()).unwrap_or_default()
}

/// Brings trouble about: `lose-device`, `kill-worker`, `hang-worker`, `trap-worker` (a panic inside of it).
#[wasm_bindgen]
pub fn provoke(what: &str) {
    let what = what.to_owned();
    act(move |page| match what.as_str() {
        "lose-device" => page.stage.lose(),
        "kill-worker" => page.worker_died("it was killed"),
        "hang-worker" => page.port.silence(),
        "trap-worker" => drop(page.port.send_raw(&JsValue::from_str(TRAP))),
        _ => page.notices.refusal(&format!("“{what}” cannot be provoked.")),
    });
}

/// Makes both reachable as `window.wasmBindings`.
pub(crate) fn expose() {
    let bindings = Object::new();
    put(&bindings, "inspect", Closure::<dyn Fn() -> String>::new(inspect).into_js_value());
    put(&bindings, "provoke", Closure::<dyn Fn(String)>::new(|what: String| provoke(&what)).into_js_value());
    put(dom::window().unchecked_ref::<Object>(), "wasmBindings", bindings);
}

impl Page {
    fn described(&self) -> JsValue {
        let out = Object::new();
        put(&out, "tool", self.tools.kind().word());
        put(&out, "corners", number(self.tools.corners().len()));
        put(&out, "underWay", self.tools.is_under_way());
        put(&out, "settled", self.schedule.is_at_rest() && self.scene.header.settled);
        put(&out, "held", self.scene.header.held.map_or(JsValue::NULL, |id| id.0.into()));
        put(&out, "figures", plain(&self.scene.header.figures));
        put(&out, "surfaces", plain(&self.scene.structure.surfaces));
        put(&out, "balls", self.described_balls());
        put(&out, "curves", self.described_curves());
        put(&out, "points", self.described_points());
        let arms = self.arms().into_iter().map(|arm| self.on_screen(arm.end));
        put(&out, "handles", arms.collect::<Array>());
        put(&out, "feet", self.described_feet());
        put(&out, "camera", self.described_camera());
        put(&out, "selection", self.described_selection());
        put(&out, "hover", self.described_hover());
        put(
            &out,
            "netEdges",
            self.scene.structure.nets.iter().map(|net| number(net.edges.len())).sum::<f64>(),
        );
        put(&out, "marked", self.described_marks());
        let committed = self.committed.as_ref();
        put(&out, "act", optional(committed.map(|c| c.act.as_str())));
        put(&out, "document", optional(committed.map(|c| c.document.as_str())));
        put(&out, "name", optional(committed.map(|c| c.name.as_str())));
        put(&out, "undo", optional(committed.and_then(|c| c.undo.as_deref())));
        put(&out, "redo", optional(committed.and_then(|c| c.redo.as_deref())));
        put(&out, "openings", self.openings);
        put(&out, "banners", self.notices.texts().map(JsValue::from_str).collect::<Array>());
        put(&out, "toast", optional(self.notices.toast_said().as_deref()));
        put(&out, "shading", self.settings.look.shading.word());
        put(&out, "gpu", self.stage.device.word());
        put(&out, "losses", self.stage.losses);
        put(&out, "pictures", self.stage.pictures);
        put(&out, "worker", if self.port.is_ready() { "ready" } else { "starting" });
        put(&out, "restarts", self.restart_count);
        put(&out, "stored", !self.journal.is_refused);
        out.into()
    }

    fn described_feet(&self) -> Array {
        let feet = self.all_feet().into_iter().map(|foot| {
            let out = Object::new();
            put(&out, "surface", foot.surface.0);
            put(&out, "number", number(foot.number));
            put(&out, "places", number(foot.course.len()));
            put(&out, "at", triple(foot.at));
            put(&out, "screen", self.on_screen(foot.at));
            JsValue::from(out)
        });
        feet.collect()
    }

    fn described_points(&self) -> Array {
        let points = self.scene.points().map(|(entry, at)| {
            let out = Object::new();
            put(&out, "id", entry.id.0);
            put(&out, "role", plain(&entry.role));
            put(&out, "at", triple(at));
            put(&out, "screen", self.on_screen(at));
            JsValue::from(out)
        });
        points.collect()
    }

    fn described_curves(&self) -> Array {
        let curves = self.scene.structure.curves.iter().map(|span| {
            let out = Object::new();
            put(&out, "id", span.id.0);
            put(&out, "closed", span.closed);
            put(&out, "role", plain(&span.role));
            put(&out, "samples", span.count);
            let places = || self.scene.samples(span.id).step_by(8);
            put(&out, "at", places().map(triple).collect::<Array>());
            put(&out, "screen", places().map(|at| self.on_screen(at)).collect::<Array>());
            JsValue::from(out)
        });
        curves.collect()
    }

    /// A ball around each surface, as it is drawn.
    fn described_balls(&self) -> Array {
        let spans = self.scene.structure.surfaces.iter();
        let balls = spans.filter_map(|span| Some((span.id, self.scene.ball_of(span.id)?)));
        let described = balls.map(|(id, (centre, radius))| {
            let out = Object::new();
            put(&out, "id", id.0);
            put(&out, "centre", triple(centre));
            put(&out, "radius", radius);
            JsValue::from(out)
        });
        described.collect()
    }

    fn described_camera(&self) -> Object {
        let out = Object::new();
        let pose = self.camera.pose();
        put(&out, "eye", triple(self.camera.eye()));
        put(&out, "target", triple(pose.centre));
        put(&out, "distance", pose.distance);
        put(&out, "right", triple(self.camera.right()));
        put(&out, "up", triple(self.camera.up()));
        put(&out, "forward", triple(self.camera.forward()));
        put(&out, "middle", self.on_screen(pose.centre));
        put(&out, "orthographic", self.camera.is_orthographic());
        put(&out, "flying", self.camera.is_flying());
        out
    }

    fn described_selection(&self) -> JsValue {
        named(self.selection)
    }

    fn described_hover(&self) -> JsValue {
        named(Selection::of(self.hand.hover.as_ref()))
    }

    /// What the tool in hand marks in the picture: how many parts are tinted, how many rims and lines are drawn, how many points
    /// are chosen.
    fn described_marks(&self) -> Object {
        let marks = self.highlight();
        let out = Object::new();
        put(&out, "tinted", number(marks.tinted.len()));
        put(&out, "skins", number(marks.skins.len()));
        put(&out, "edges", number(marks.edges.len()));
        put(&out, "soft", number(marks.edges.iter().filter(|edge| edge.is_soft).count()));
        put(&out, "rims", number(marks.rims.len()));
        put(&out, "lines", number(marks.sketch.len()));
        put(&out, "strips", number(marks.strips.len()));
        put(&out, "parts", number(marks.parts.len()));
        put(&out, "points", number(marks.selected.len()));
        let followed = |of: &[u8]| of.iter().filter(|follows| **follows > 0).count();
        put(&out, "influence", number(marks.influence.map_or(0, |(_, of)| followed(&of))));
        out
    }

    /// Where a place is in the window, in CSS pixels.
    fn on_screen(&self, at: Vec3) -> JsValue {
        match self.camera.project(at) {
            Some(place) => Array::of(&[JsValue::from(place.x), JsValue::from(place.y)]).into(),
            None => JsValue::NULL,
        }
    }
}

/// A thing by its name, `null` for nothing.
fn named(thing: Selection) -> JsValue {
    match thing {
        Selection::None => JsValue::NULL,
        Selection::Point(id) => id.to_string().into(),
        Selection::Curve(id) => id.to_string().into(),
        Selection::Surface(id) => id.to_string().into(),
        Selection::Edge { surface, ends: [a, b] } => format!("edge {}-{} of {surface}", a.0, b.0).into(),
        Selection::Face { surface, face } => format!("face {face} of {surface}").into(),
    }
}

fn triple(at: Vec3) -> Array {
    Array::of(&[JsValue::from(at.x), JsValue::from(at.y), JsValue::from(at.z)])
}

fn number(count: usize) -> f64 {
    super::files::as_float(count)
}

fn optional(text: Option<&str>) -> JsValue {
    text.map_or(JsValue::NULL, JsValue::from_str)
}

fn plain<T: serde::Serialize + ?Sized>(value: &T) -> JsValue {
    serde_wasm_bindgen::to_value(value).unwrap_or(JsValue::NULL)
}

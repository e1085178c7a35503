//! What floats at the edges: the scene list, the properties, the status line.

use super::dom;
use super::page::Page;
use crate::tool::{Selection, ToolKind, entry, span};
use ductile_spec::{CurveRole, PointRole, SurfaceId, SurfaceKind, SurfaceSummary};
use wasm_bindgen::JsCast;
use web_sys::{Element, HtmlElement};

/// The elements of the panel and what they show.
#[derive(Debug)]
pub(crate) struct Panel {
    is_stale: bool,
    figures_are_stale: bool,
    /// What the scene list shows: it is made anew only if this changes.
    listed: Option<(u32, Selection)>,
    pub(crate) welcome_is_over: bool,
    /// The field whose text was refused, and what was selected then.
    pub(crate) refused: Option<(&'static str, Selection)>,
    is_bare: bool,
    side: HtmlElement,
    welcome: HtmlElement,
}

impl Panel {
    pub(crate) fn new() -> Self {
        let side = dom::element("side");
        let closed = dom::media("(max-width: 640px)");
        dom::class(&side, "closed", closed);
        dom::attribute(&dom::element("scene-button"), "aria-expanded", if closed { "false" } else { "true" });
        Self {
            is_stale: true,
            figures_are_stale: true,
            listed: None,
            welcome_is_over: false,
            refused: None,
            is_bare: false,
            side,
            welcome: dom::element("welcome"),
        }
    }

    /// Hides everything but the model, or shows it again.
    pub(crate) fn toggle_bare(&mut self) {
        self.is_bare = !self.is_bare;
        if let Some(body) = dom::document().body() {
            dom::class(&body, "bare", self.is_bare);
        }
    }

    /// Opens or closes scene and properties.
    pub(crate) fn toggle_side(&mut self) {
        let closed = !self.side.class_list().contains("closed");
        dom::class(&self.side, "closed", closed);
        dom::attribute(&dom::element("scene-button"), "aria-expanded", if closed { "false" } else { "true" });
    }
}

impl Page {
    /// The page shows the newest state at the next display tick.
    pub(crate) fn refresh(&mut self) {
        self.panel.is_stale = true;
        self.panel.figures_are_stale = true;
        self.redraw();
    }

    /// As [`Self::refresh`], for the status line and numbers only.
    pub(crate) fn refresh_figures(&mut self) {
        self.panel.figures_are_stale = true;
        self.redraw();
    }

    /// Shows what has changed since the last tick.
    pub(crate) fn update_panel(&mut self) {
        self.show_cursor();
        if std::mem::take(&mut self.panel.figures_are_stale) {
            self.show_figures();
            self.show_fields();
        }
        if std::mem::take(&mut self.panel.is_stale) {
            self.show_hint();
            self.show_history();
            self.show_scene();
            self.show_properties();
            let first_time = self.openings == 1 && self.document.surfaces.len() == 1;
            let welcome = first_time && !self.panel.welcome_is_over && self.scene.has_frame();
            dom::show(&self.panel.welcome, welcome);
        }
    }

    fn show_cursor(&self) {
        let canvas = dom::element("view");
        let held = self.hand.drag.is_some();
        let shapes = self.tools.holds();
        let is_over = self.hand.hover.is_some() || self.hand.hover_arm.is_some();
        dom::class(&canvas, "held", held);
        dom::class(&canvas, "over", shapes && !held && is_over);
        dom::class(&canvas, "place", !shapes);
    }

    fn show_figures(&self) {
        let figures = &self.scene.header.figures;
        let rests = self.schedule.is_at_rest();
        dom::text(&dom::element("figure-topology"), &self.topology_text());
        dom::text(&dom::element("figure-nodes"), &format!("{} nodes", figures.nodes));
        dom::text(&dom::element("figure-energy"), &format!("energy {:.4}", whole_zero(figures.energy)));
        // Most shapes never need any.
        let rescues = dom::element("figure-rescues");
        dom::show(&rescues, figures.rescues > 0);
        let plural = if figures.rescues == 1 { "" } else { "s" };
        dom::text(&rescues, &format!("{} rescue{plural}", figures.rescues));
        dom::class(&dom::element("state-dot"), "rest", rests);
        let state = if self.port.is_stopped() {
            "stopped"
        } else if !self.port.is_ready() {
            "starting"
        } else if rests {
            "at rest"
        } else {
            "relaxing"
        };
        dom::text(&dom::element("state-text"), state);
        let time = figures.step_milliseconds;
        let text = if time > 0.0 && !rests { format!("{time:.1} ms") } else { String::new() };
        dom::text(&dom::element("figure-time"), &text);
    }

    fn show_hint(&self) {
        let hint = match &self.hand.drag {
            None if self.has_chosen_foot() => "Ctrl-click: one more place goes along. Shift-click: a pin.",
            None => match self.why_no_tube() {
                Some(why) => why,
                None => &self.why_no_loop().unwrap_or_else(|| self.tools.hint().to_owned()),
            },
            Some(drag) if drag.lock().is_some() => "Along the axis. The same key frees it, Esc: all back.",
            Some(_) => "Shift: normal · X, Y, Z: axis · Ctrl: grid · Esc: all back",
        };
        self.notices.hint(hint);
        for kind in ToolKind::ALL {
            let in_hand =
                if self.tools.kind() == ToolKind::Divide { ToolKind::Cage } else { self.tools.kind() };
            let chosen = kind == in_hand;
            let button = dom::element(&format!("tool-{}", kind.word()));
            dom::attribute(&button, "aria-pressed", if chosen { "true" } else { "false" });
        }
        self.show_options();
    }

    fn show_history(&self) {
        let committed = self.committed.as_ref();
        for (verb, word, label) in [
            ("Undo", "undo", committed.and_then(|c| c.undo.as_deref())),
            ("Redo", "redo", committed.and_then(|c| c.redo.as_deref())),
        ] {
            let name = label.map_or_else(|| verb.to_owned(), |label| format!("{verb} {label}"));
            for id in [word.to_owned(), format!("menu-{word}")] {
                let button = dom::element(&id);
                if label.is_some() {
                    let _ = button.remove_attribute("disabled");
                } else {
                    dom::attribute(&button, "disabled", "");
                }
                dom::attribute(&button, "aria-label", &name);
            }
        }
        dom::show(&dom::element("unsaved"), self.journal.is_refused);
        let name = committed.map_or("", |committed| committed.name.as_str());
        let title = if name.is_empty() { "Ductile".to_owned() } else { format!("{name} · Ductile") };
        if dom::document().title() != title {
            dom::document().set_title(&title);
        }
        self.fill_field(&dom::element_as("name"), false);
    }

    fn show_scene(&mut self) {
        let shown = (self.scene.structure.version, self.selection);
        if self.panel.listed == Some(shown) {
            return;
        }
        self.panel.listed = Some(shown);
        let list = dom::element("scene-list");
        let focused = dom::document().active_element().and_then(|e| e.get_attribute("data-subject"));
        dom::clear(&list);
        let structure = &self.scene.structure;
        for surface in &structure.surfaces {
            let selected = self.selection == Selection::Surface(surface.id);
            let note = match surface.kind {
                SurfaceKind::Fair => "",
                SurfaceKind::Cage => "over a cage",
                SurfaceKind::Fill => "fill",
                SurfaceKind::Mesh => "mesh",
            };
            list_entry(&list, "surface", surface.id.0, note, selected);
        }
        for curve in &structure.curves {
            let note = if curve.closed { "closed" } else { "open" };
            list_entry(&list, "curve", curve.id.0, note, self.selection == Selection::Curve(curve.id));
        }
        for point in &structure.points {
            let note = match point.role {
                PointRole::Free => "free",
                PointRole::Curve => "on a curve",
                PointRole::Surface => "on a surface",
            };
            list_entry(&list, "point", point.id.0, note, self.selection == Selection::Point(point.id));
        }
        let is_empty =
            structure.points.is_empty() && structure.curves.is_empty() && structure.surfaces.is_empty();
        dom::show(&dom::element("scene-empty"), is_empty && self.committed.is_some());
        if let Some(subject) = focused {
            let entry = list.query_selector(&format!("[data-subject=\"{subject}\"]")).ok().flatten();
            if let Some(entry) = entry.and_then(|entry| entry.dyn_into::<HtmlElement>().ok()) {
                let _ = entry.focus();
            }
        }
    }

    fn show_properties(&mut self) {
        if let Some((id, selection)) = self.panel.refused
            && selection != self.selection
        {
            self.show_field_error(id, None);
        }
        let structure = &self.scene.structure;
        let title = match self.selection {
            Selection::None => "Document".to_owned(),
            Selection::Point(id) => format!("Point {}", id.0),
            Selection::Curve(id) => format!("Curve {}", id.0),
            Selection::Surface(id) => format!("Surface {}", id.0),
            Selection::Edge { surface, .. } => format!("Edge of the cage of surface {}", surface.0),
            Selection::Face { surface, face } => format!("Face {face} of the cage of surface {}", surface.0),
        };
        dom::text(&dom::element("properties-title"), &title);
        dom::show(&dom::element("point-properties"), matches!(self.selection, Selection::Point(_)));
        let role = match self.selection {
            Selection::Point(id) => entry(structure, id).map(|entry| entry.role),
            _ => None,
        };
        let hangs = role.is_some_and(|role| role != PointRole::Free);
        let turns = match self.selection {
            Selection::Surface(id)
                if self.fair_surface().is_some() || self.document.meshes.contains_key(&id) =>
            {
                self.summary_shown().is_some_and(|summary| summary.orientable)
            }
            _ => false,
        };
        dom::show(&dom::element("reverse"), turns);
        let is_fair = self.fair_surface().is_some();
        dom::show(&dom::element("propagate"), turns && is_fair && structure.surfaces.len() > 1);
        let is_of_cage = match self.selection {
            Selection::Point(id) => self.document.cages_on(id).next().is_some(),
            Selection::Edge { .. } | Selection::Face { .. } => true,
            _ => false,
        };
        dom::show(&dom::element("divide"), is_of_cage);
        dom::show(&dom::element("release"), hangs && !is_of_cage);
        dom::show(&dom::element("delete"), self.selection != Selection::None && !hangs && !is_of_cage);
        self.show_tangent();
        self.show_normal();
        self.show_ribbon();
        self.show_extent();
        self.show_cage();
        let facts = dom::element("facts");
        dom::clear(&facts);
        for (name, value) in self.facts(role) {
            dom::append(&facts, [&dom::create_with("dt", "", name), &dom::create_with("dd", "", &value)]);
        }
        self.show_fields();
        self.show_objectives();
        self.show_shadow();
        self.show_density();
        self.show_displacements();
        self.show_fill();
        self.show_seams();
    }

    fn facts(&self, role: Option<PointRole>) -> Vec<(&'static str, String)> {
        let structure = &self.scene.structure;
        match self.selection {
            Selection::Point(_) => {
                let role = match role {
                    Some(PointRole::Curve) => "control of a curve",
                    Some(PointRole::Surface) => "control of a surface",
                    Some(PointRole::Free) | None => "free",
                };
                vec![("Role", role.to_owned())]
            }
            Selection::Curve(id) => {
                let Some(span) = span(structure, id) else { return Vec::new() };
                let curve = self.document.curves.get(&id);
                let role = match (span.role, curve.and_then(|curve| curve.rim)) {
                    (_, Some(surface)) => format!("rim of surface {}", surface.0),
                    (CurveRole::Free, None) => "free".to_owned(),
                    (CurveRole::Boundary, None) => "boundary of a surface".to_owned(),
                    (CurveRole::Inner, None) => "inside a surface".to_owned(),
                };
                let through = curve.map_or(0, |curve| curve.through.len());
                let course = if span.closed { "closed" } else { "open" };
                vec![("Role", role), ("Course", course.to_owned()), ("Points", through.to_string())]
            }
            Selection::Edge { .. } | Selection::Face { .. } => Vec::new(),
            Selection::Surface(_) | Selection::None => self.summary_shown().map(topology).unwrap_or_default(),
        }
    }

    /// The selected surface, if it is a fair one: exact ones have no mesh of their own and minimise nothing.
    pub(crate) fn fair_surface(&self) -> Option<SurfaceId> {
        let Selection::Surface(id) = self.selection else { return None };
        Some(id).filter(|id| !self.document.kind_of(*id).is_some_and(|kind| kind != SurfaceKind::Fair))
    }

    /// The topology that is shown: of the selected surface, or of the only one.
    fn summary_shown(&self) -> Option<&SurfaceSummary> {
        let surfaces = &self.scene.structure.surfaces;
        match (self.selection, surfaces.as_slice()) {
            (
                Selection::Surface(id)
                | Selection::Edge { surface: id, .. }
                | Selection::Face { surface: id, .. },
                _,
            ) => surfaces.iter().find(|surface| surface.id == id),
            (_, [only]) => Some(only),
            _ => None,
        }
        .map(|surface| &surface.summary)
    }

    /// The same in one line.
    fn topology_text(&self) -> String {
        let Some(summary) = self.summary_shown() else { return String::new() };
        let kind = if summary.orientable { "genus" } else { "crosscaps" };
        let boundaries = match summary.boundaries {
            0 => "closed".to_owned(),
            1 => "1 boundary".to_owned(),
            n => format!("{n} boundaries"),
        };
        let sides = if summary.orientable { "orientable" } else { "one-sided" };
        let euler = summary.euler.to_string().replace('-', "\u{2212}");
        format!("χ {euler} · {kind} {} · {boundaries} · {sides}", summary.genus)
    }
}

fn list_entry(list: &Element, kind: &str, number: u32, note: &str, selected: bool) {
    let subject = format!("{kind} {number}");
    let mut name = subject.clone();
    name[..1].make_ascii_uppercase();
    let button = dom::command_button("", "", "select");
    dom::attribute(&button, "data-subject", &subject);
    dom::attribute(&button, "aria-pressed", if selected { "true" } else { "false" });
    let label = dom::create_with("span", "", &name);
    let note = dom::create_with("span", "note", note);
    dom::append(&button, [&dom::icon(&format!("i-{kind}")), &label, &note]);
    let item = dom::create("li");
    dom::append(&item, [&button]);
    dom::append(list, [&item]);
}

/// What is shown as zero has no sign.
fn whole_zero(value: f64) -> f64 {
    if value.abs() < 5e-5 { 0.0 } else { value }
}

fn topology(summary: &SurfaceSummary) -> Vec<(&'static str, String)> {
    let mut facts = vec![
        ("Euler characteristic", summary.euler.to_string()),
        (if summary.orientable { "Genus" } else { "Crosscaps" }, summary.genus.to_string()),
        ("Boundaries", summary.boundaries.to_string()),
        ("Orientable", if summary.orientable { "yes" } else { "no" }.to_owned()),
    ];
    if summary.components > 1 {
        facts.push(("Pieces", summary.components.to_string()));
    }
    facts
}

//! The report on seams in the panel: how well surfaces of all kinds meet along the curves that they share.

use super::dom;
use super::fill::few;
use super::page::{Page, act};
use crate::Highlight;
use crate::tool::Selection;
use ductile_spec::{CurveStretch, SeamFigures, SurfaceId};
use glam::Vec3;
use wasm_bindgen::JsCast;
use web_sys::{Element, Event};

/// The report in index.html, and its list.
const REPORT: &str = "seams";
const LIST: &str = "seam-list";
/// More seams than this are not listed one by one.
const MOST_LISTED: usize = 100;

/// Listens to what is opened and pointed at.
pub(crate) fn listen() {
    dom::listen(&dom::element(REPORT), "toggle", |_: Event| act(|page| page.refresh()));
    for event in ["pointerover", "focusin"] {
        dom::listen(&dom::element(LIST), event, |event: Event| {
            let target = event.target().and_then(|target| target.dyn_into::<Element>().ok());
            let row = target.and_then(|target| target.closest("[data-seam]").ok().flatten());
            let seam = row.and_then(|row| row.get_attribute("data-seam")?.parse().ok());
            act(move |page| page.point_at_seam(seam));
        });
    }
    for event in ["pointerleave", "focusout"] {
        dom::listen(&dom::element(LIST), event, |_: Event| act(|page| page.point_at_seam(None)));
    }
}

impl Page {
    fn point_at_seam(&mut self, seam: Option<usize>) {
        if self.seam_over != seam {
            self.seam_over = seam;
            self.redraw();
        }
    }

    fn report_is_open(&self) -> bool {
        dom::element(REPORT).has_attribute("open")
    }

    /// Asks for the report if somebody looks at it.
    pub(crate) fn ask_seams(&mut self) {
        let looks = self.shows_fill() || self.report_is_open() && self.scene.structure.surfaces.len() > 1;
        let rests = self.scene.header.settled && self.hand.drag.is_none();
        if looks && let Some(question) = self.reporting.want(rests) {
            self.schedule.push(question);
        }
    }

    /// The surface of which the report tells, or all.
    fn reported(&self) -> Option<SurfaceId> {
        match self.selection {
            Selection::Surface(id)
            | Selection::Face { surface: id, .. }
            | Selection::Edge { surface: id, .. } => Some(id),
            _ => None,
        }
    }

    /// Shows the report: on the seams of the selected surface, or on all.
    pub(crate) fn show_seams(&mut self) {
        dom::show(&dom::element(REPORT), self.scene.structure.surfaces.len() > 1);
        self.ask_seams();
        if !self.report_is_open() {
            return;
        }
        let only = self.reported();
        let list = dom::element(LIST);
        let said = dom::element("seam-summary");
        let Some(report) = self.reporting.report() else {
            dom::text(&said, "Figures come when the shapes are at rest.");
            self.seams_shown.clear();
            return;
        };
        // Made anew only for another report, so that pointer and focus stay where they are.
        let shown = format!("{only:?} {:?}", report.seams);
        if self.seams_shown == shown {
            return;
        }
        dom::clear(&list);
        let is_meant = |seam: &SeamFigures| only.is_none_or(|id| seam.surfaces.contains(&id));
        let seams: Vec<_> = report.seams.iter().enumerate().filter(|(_, seam)| is_meant(seam)).collect();
        for (at, seam) in seams.iter().take(MOST_LISTED) {
            dom::append(&list, [&row(*at, seam)]);
        }
        let count = seams.len();
        let whose = only.map_or_else(String::new, |id| format!(" of surface {}", id.0));
        let text = match count {
            0 => format!("No seams{whose}: no two surfaces share a curve."),
            1 => format!("One seam{whose}."),
            _ if count > MOST_LISTED => format!("{count} seams{whose}, the first {MOST_LISTED} of them:"),
            _ => format!("{count} seams{whose}."),
        };
        dom::text(&said, &text);
        self.seams_shown = shown;
    }

    /// The seam of the report that is pointed at.
    pub(crate) fn mark_seam(&self, mark: &mut Highlight) {
        let seam = self.seam_over.and_then(|at| self.reporting.report()?.seams.get(at));
        let line = seam.and_then(|seam| self.stretch_line(&seam.stretch));
        mark.sketch.extend(line.filter(|line| line.len() > 1));
    }

    /// The samples of a curve along a stretch of it.
    pub(crate) fn stretch_line(&self, stretch: &CurveStretch) -> Option<Vec<Vec3>> {
        let span = self.scene.curve(stretch.curve)?;
        let samples: Vec<Vec3> = self.scene.samples(span.id).collect();
        let nearest = |id| {
            let at = self.scene.point(id)?;
            let distance = |k: &usize| samples[*k].distance_squared(at);
            (0..samples.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        let (from, to) = (nearest(stretch.from)?, nearest(stretch.to)?);
        let count = samples.len();
        let steps = if to > from {
            to - from
        } else if span.closed {
            to + count - from
        } else {
            0
        };
        Some((0..=steps).map(|k| samples[(from + k) % count]).collect())
    }
}

fn row(at: usize, seam: &SeamFigures) -> Element {
    let [one, other] = seam.surfaces.map(|id| id.0);
    let (curve, from, to) = (seam.stretch.curve.0, seam.stretch.from.0, seam.stretch.to.0);
    let stretch = if from == to { String::new() } else { format!(", points {from} to {to}") };
    let button = dom::command_button("", "", "select");
    dom::attribute(&button, "data-subject", &format!("curve {curve}"));
    dom::attribute(&button, "data-seam", &at.to_string());
    let name = format!("Surfaces {one} and {other} · curve {curve}{stretch}");
    let mut figures =
        format!("gap {} · {}° · curvature {}", few(seam.gap), few(seam.angle), few(seam.curvature_jump));
    if seam.without_normal > 0 {
        figures.push_str(&format!(" · {} of {} without a normal", seam.without_normal, seam.places));
    }
    dom::append(
        &button,
        [&dom::create_with("span", "", &name), &dom::create_with("span", "figures-note", &figures)],
    );
    let item = dom::create("li");
    dom::append(&item, [&button]);
    item.into()
}

//! How a surface leaves the chosen curve: one angle, in degrees, from the plane in which the curve lies.
//!
//! The document keeps directions at the curve's points. Where they have one angle in common the field shows it; where not, it
//! says so. Where a curve lies in several surfaces the field belongs to the first.

use super::dom;
use super::page::{Page, act};
use crate::number;
use crate::tool::{Arm, Selection, ToolKind, surface_of};
use crate::{Highlight, Hit, Strip, StripCourse};
use ductile_spec::{CurveId, Document, Edit, Leave, PointId, Request, SurfaceId};
use glam::{DVec2, DVec3, Vec3};
use web_sys::{Event, HtmlInputElement, HtmlSelectElement};

/// The field.
pub(crate) const FIELD: &str = "ribbon-angle";
/// The select of the surface that is gone on from.
const ONTO: &str = "ribbon-onto";

/// Width of a tangent strip: the handles end at its outer edge.
const STRIP: f32 = Arm::LENGTH;

/// Degrees by which the angles at the points may differ and still be shown as one.
const ALIKE: f64 = 0.05;

/// Listens to the select.
pub(crate) fn listen() {
    let select: HtmlSelectElement = dom::element_as(ONTO);
    let own = select.clone();
    dom::listen(&select, "change", move |_: Event| {
        let other = own.value().parse().ok().map(SurfaceId);
        act(move |page| page.choose_onto(other));
    });
}

impl Page {
    /// The chosen curve and the surface that the field is about.
    fn ribbon_subject(&self) -> Option<(SurfaceId, CurveId)> {
        let Selection::Curve(curve) = self.selection else { return None };
        surface_of(&self.document, curve, self.meant).map(|surface| (surface, curve))
    }

    /// What the field shows.
    pub(crate) fn ribbon_text(&self) -> String {
        self.ribbon_angle().map(|angle| number::show((angle * 10.0).round() / 10.0)).unwrap_or_default()
    }

    /// Shows the field where the curve lies in a surface, and the way back where there is a ribbon.
    pub(crate) fn show_ribbon(&self) {
        let subject = self.ribbon_subject();
        dom::show(&dom::element("ribbon-properties"), subject.is_some());
        let has_ribbon = subject.is_some_and(|subject| self.ribbon(subject).is_some());
        dom::show(&dom::element("free-ribbon"), has_ribbon);
        let field: HtmlInputElement = dom::element_as(FIELD);
        let onto = subject.and_then(|subject| self.ribbon(subject)).and_then(|ribbon| ribbon.onto);
        field.set_placeholder(match (has_ribbon, onto) {
            (_, Some(_)) => "as that surface",
            (true, None) => "various",
            (false, None) => "free",
        });
        self.show_onto(onto);
    }

    /// Lists the exact surfaces that the surface could go on from.
    fn show_onto(&self, chosen: Option<SurfaceId>) {
        let Document { fills, cages, meshes, .. } = &self.document;
        let all: Vec<SurfaceId> = fills.keys().chain(cages.keys()).chain(meshes.keys()).copied().collect();
        dom::show(&dom::element("ribbon-onto-row"), !all.is_empty());
        let select: HtmlSelectElement = dom::element_as(ONTO);
        let names: String = all.iter().map(|id| format!("{} ", id.0)).collect();
        if select.get_attribute("data-names").as_deref() != Some(&names) {
            dom::attribute(&select, "data-names", &names);
            dom::clear(&select);
            for (value, name) in [(String::new(), "none".to_owned())]
                .into_iter()
                .chain(all.iter().map(|id| (id.0.to_string(), format!("Surface {}", id.0))))
            {
                let option = dom::create_with("option", "", &name);
                dom::attribute(&option, "value", &value);
                dom::append(&select, [&option]);
            }
        }
        let value = chosen.map(|id| id.0.to_string()).unwrap_or_default();
        if select.value() != value {
            select.set_value(&value);
        }
    }

    /// Lets the surface go on smoothly from an exact one at the chosen curve, or no longer.
    fn choose_onto(&mut self, other: Option<SurfaceId>) {
        let Some((surface, curve)) = self.ribbon_subject() else { return };
        let leave = other.map(Leave::Onto);
        self.request(Request::Edit(Edit::Ribbon { surface, curve, leave }));
    }

    /// Takes what was typed; says what is wrong with it.
    pub(crate) fn typed_ribbon(&mut self, text: &str) -> Option<String> {
        let (surface, curve) = self.ribbon_subject()?;
        if text.trim().is_empty() {
            // A ribbon of various angles shows nothing either: leaving the field does not free it.
            if self.ribbon_angle().is_some() {
                self.free_ribbon();
            }
            return None;
        }
        match number::parse(text.trim().trim_end_matches('°')) {
            Ok(angle) if number::show(angle) == self.ribbon_text() => None,
            Ok(angle) if angle.abs() > 180.0 => {
                Some("An angle lies between -180 and 180 degrees.".to_owned())
            }
            Ok(angle) => {
                let leave = Some(Leave::Angle(angle.to_radians()));
                self.request(Request::Edit(Edit::Ribbon { surface, curve, leave }));
                None
            }
            Err(error) => Some(error.to_string()),
        }
    }

    /// Shows the way back beside the hint, where the tool has told a surface something.
    pub(crate) fn show_ribbon_option(&self) -> bool {
        let is_told = self.ribbon_subject().is_some_and(|subject| self.ribbon(subject).is_some());
        let shows = self.tools.kind() == ToolKind::Ribbon && (is_told || self.has_normal());
        dom::show(&dom::element("option-free"), shows);
        shows
    }

    /// Sets free what the tool has told a surface.
    pub(crate) fn free_told(&mut self) {
        match self.selection {
            Selection::Point(_) => self.free_normal(),
            _ => self.free_ribbon(),
        }
    }

    /// Sets the surface free along the curve.
    pub(crate) fn free_ribbon(&mut self) {
        if let Some((surface, curve)) = self.ribbon_subject() {
            self.request(Request::Edit(Edit::Ribbon { surface, curve, leave: None }));
        }
    }

    fn ribbon(&self, (surface, curve): (SurfaceId, CurveId)) -> Option<&ductile_spec::Ribbon> {
        self.document.surfaces.get(&surface)?.ribbons.get(&curve)
    }

    /// The surfaces and curves along which tangent strips are shown, and whether only because the tool points there.
    fn stripped(&self) -> Vec<(SurfaceId, CurveId, bool)> {
        if !self.tools.turns() || !self.settings.look.skeleton {
            return Vec::new();
        }
        let mut all = Vec::new();
        if let Selection::Curve(curve) = self.selection {
            let has_ribbon = |surface: &SurfaceId| self.ribbon((*surface, curve)).is_some();
            all.extend(self.document.surfaces_on(curve).filter(has_ribbon).map(|id| (id, curve, false)));
        }
        if let (ToolKind::Ribbon, Some(hit @ Hit::Curve { id, .. })) = (self.tools.kind(), &self.hand.hover) {
            let meant = self.hand.cursor.and_then(|at| self.surface_at(at, Some(hit)));
            let surface = surface_of(&self.document, *id, meant);
            all.extend(surface.map(|surface| (surface, *id, true)).filter(|(surface, curve, _)| {
                !all.iter().any(|(on, along, _)| (on, along) == (surface, curve))
            }));
        }
        all
    }

    /// Finds anew where the strips run that are shown, if the mesh is another.
    pub(crate) fn find_strips(&mut self) {
        let wanted = self.stripped();
        let mut courses = std::mem::take(&mut self.strips);
        for (surface, curve, _) in wanted {
            let known = courses.iter().position(|own| own.is_of(&self.scene, surface, curve));
            let known = known.map(|at| courses.swap_remove(at));
            self.strips.extend(known.or_else(|| StripCourse::find(&self.scene, surface, curve)));
        }
    }

    /// The tangent strips of the selected curve, and of the one that the tool points at.
    pub(crate) fn mark_strips(&self, mark: &mut Highlight) {
        for (surface, curve, is_ghost) in self.stripped() {
            let course = self.strips.iter().find(|own| own.is_of(&self.scene, surface, curve));
            let given = self.ribbon((surface, curve)).and_then(|ribbon| ribbon.cross.first_key_value());
            let side = given.and_then(|(point, cross)| Some((self.scene.point(*point)?, cross.as_vec3())));
            mark.strips.extend(
                course
                    .filter(|_| self.scene.has_frame())
                    .map(|course| Strip { is_ghost, ..course.strip(&self.scene, &self.camera, STRIP, side) }),
            );
        }
    }

    /// The angle that the ribbon has at all of its points, in degrees.
    fn ribbon_angle(&self) -> Option<f64> {
        let subject = self.ribbon_subject()?;
        let ribbon = self.ribbon(subject)?;
        let mut angles = Vec::new();
        for (point, cross) in &ribbon.cross {
            angles.push(self.angle_at(subject, *point, *cross)?);
        }
        let first = *angles.first()?;
        let alike = |angle: &f64| {
            let off = (angle - first).abs();
            off.min(360.0 - off) <= ALIKE
        };
        angles.iter().all(alike).then_some(first)
    }

    /// The angle of a direction at a point, in degrees, as the modeler understands it.
    fn angle_at(&self, (surface, curve): (SurfaceId, CurveId), point: PointId, cross: DVec3) -> Option<f64> {
        let tangent = self.present_tangent(curve, point)?.try_normalize()?;
        let plane = area(self.scene.samples(curve)).try_normalize()?;
        let inwards = plane.cross(tangent).try_normalize()?;
        let up = tangent.cross(inwards);
        let is_boundary = self.scene.curve(curve)?.role == ductile_spec::CurveRole::Boundary;
        let (along, across) = (cross.dot(up), cross.dot(inwards));
        let (sin, cos) = if is_boundary {
            // The normal, along the curve times into the surface, says which way round the surface sees the curve.
            let normal = self.surface_normal(surface, self.scene.point(point)?)?.as_dvec3();
            (if normal.dot(tangent.cross(cross)) < 0.0 { -along } else { along }, across)
        } else if across < 0.0 {
            (-along, -across)
        } else {
            (along, across)
        };
        Some(DVec2::X.angle_to(DVec2::new(cos, sin)).to_degrees())
    }
}

/// Twice the vector area of a closed polygon.
fn area(samples: impl ExactSizeIterator<Item = Vec3> + Clone) -> DVec3 {
    let count = samples.len().max(1) as f64;
    let places = samples.map(|at| at.as_dvec3());
    let centre = places.clone().sum::<DVec3>() / count;
    let next = places.clone().cycle().skip(1);
    places.zip(next).map(|(a, b)| (a - centre).cross(b - centre)).sum()
}

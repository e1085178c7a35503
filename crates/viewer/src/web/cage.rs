//! Cages in the page: which one a click places, the parts of cages that are marked and selected, and what is done to them.

use super::dom;
use super::menu;
use super::page::{Page, act};
use crate::tool::{Selection, ToolKind, face_between};
use crate::{Highlight, Hit, NetPart, cage_edge_at, cage_face, number, with_cage_face};
use ductile_spec::{
    Cage, CageBlend, CageBoundary, CageForm, CageMap, CageSettings, CageSplit, Edit, PointId, Request,
    SurfaceId,
};
use glam::{Vec2, Vec3};
use std::collections::BTreeSet;

/// The fields of index.html: size of a new cage, distance of an extrusion, order of the blend, steps along an edge.
pub(crate) const FIELDS: [&str; 4] = [SIZE, DISTANCE, ORDER, RESOLUTION];
const SIZE: &str = "cage-size";
const DISTANCE: &str = "extrude-distance";
const ORDER: &str = "cage-order";
const RESOLUTION: &str = "cage-resolution";
/// The selects.
const FORM: &str = "cage-form";
const SPLIT: &str = "cage-split";
const MAP: &str = "cage-map";
const BLEND: &str = "cage-blend";
const BOUNDARY: &str = "cage-boundary";

const SPLITS: [(CageSplit, &str); 4] = [
    (CageSplit::None, "None"),
    (CageSplit::Linear, "Linear"),
    (CageSplit::Offset, "Offset"),
    (CageSplit::CatmullClark, "Catmull-Clark"),
];
const MAPS: [(CageMap, &str); 2] = [(CageMap::Smooth, "Smooth"), (CageMap::Rational, "Rational")];
const BOUNDARIES: [(CageBoundary, &str); 2] =
    [(CageBoundary::Linear, "Linear"), (CageBoundary::Borrow, "Borrow")];
const BLENDS: [&str; 3] = ["Hermite", "Bump", "Expo-rational"];

/// A new cage fills about this part of the height of the picture, from its centre.
const SUITED: f32 = 0.2;

/// Fills the selects and listens to them.
pub(crate) fn listen() {
    menu::fill(FORM, CageForm::ALL.map(CageForm::label), |place| {
        if let Some(form) = place.and_then(|place| CageForm::ALL.get(place).copied()) {
            act(move |page| {
                page.tools.options_mut().form = form;
                page.refresh();
            });
        }
    });
    menu::fill(SPLIT, SPLITS.map(|(_, label)| label), |place| {
        let split = place.and_then(|place| SPLITS.get(place)).map(|(split, _)| *split);
        act(move |page| page.change_settings(|settings| settings.split = split));
    });
    menu::fill(MAP, MAPS.map(|(_, label)| label), |place| {
        let map = place.and_then(|place| MAPS.get(place)).map(|(map, _)| *map).unwrap_or_default();
        act(move |page| page.change_settings(|settings| settings.map = map));
    });
    menu::fill(BOUNDARY, BOUNDARIES.map(|(_, label)| label), |place| {
        let boundary = place.and_then(|place| BOUNDARIES.get(place)).map(|(rule, _)| *rule);
        act(move |page| page.change_settings(|settings| settings.boundary = boundary.unwrap_or_default()));
    });
    menu::fill(BLEND, BLENDS, |place| {
        let blend = match place {
            Some(1) => CageBlend::Bump(1),
            Some(2) => CageBlend::Erbs,
            _ => CageBlend::default(),
        };
        act(move |page| page.change_settings(|settings| settings.blend = blend));
    });
}

impl Page {
    /// The part of a cage that is meant by what was hit, for tools that take hold of them.
    pub(crate) fn cage_part_at(&self, at: Vec2, hit: Option<Hit>) -> Option<Hit> {
        let shown =
            self.settings.look.skeleton && matches!(self.tools.kind(), ToolKind::Shape | ToolKind::Cage);
        if !shown || matches!(hit, Some(Hit::Point { .. } | Hit::Curve { .. })) {
            return hit;
        }
        let edge = cage_edge_at(&self.scene, &self.document, &self.camera, at, self.hand.reach());
        edge.or_else(|| hit.map(|hit| with_cage_face(&self.scene, &self.document, hit)))
    }

    /// Marks the edge or face under the pointer, the one that is held, and the selected one.
    pub(crate) fn mark_cage(&self, mark: &mut Highlight) {
        let selected = match self.selection {
            Selection::Edge { ends, .. } => self.edge_places(ends),
            Selection::Face { surface, face } => cage_face(&self.scene, &self.document, surface, face),
            _ => None,
        };
        mark.parts.extend(selected.map(|places| NetPart { places, is_selected: true }));
        let over = match mark.hover {
            Some(Hit::Edge { ends, .. }) => self.edge_places(ends),
            Some(Hit::Face { surface, face, .. }) => cage_face(&self.scene, &self.document, surface, face),
            _ => None,
        };
        mark.parts.extend(over.map(|places| NetPart { places, is_selected: false }));
    }

    /// Whether a click on something could divide a face, or end a curve at a rim, if that is what the tool in hand does.
    pub(crate) fn could_divide(&self, hit: &Hit) -> bool {
        if let (Some(_), Hit::Point { id, .. }) = (self.tools.rim(), hit) {
            return match self.tools.stretch_from() {
                Some(first) => first == *id || self.tools.rim_part(&self.document, [first, *id]).is_some(),
                None => self.tools.rim_vertices(&self.document).contains(id),
            };
        }
        match (self.tools.kind(), hit, self.tools.stretch_from()) {
            (ToolKind::Divide, Hit::Point { id, .. }, Some(first)) => {
                first == *id || face_between(&self.document, [first, *id]).is_ok()
            }
            (ToolKind::Divide, Hit::Point { id, .. }, None) => self.document.cages_on(*id).next().is_some(),
            _ => true,
        }
    }

    /// The corner that a split begins at, where it could lead, and the new edge under the pointer.
    pub(crate) fn mark_split(&self, mark: &mut Highlight) {
        if self.tools.rim().is_some() {
            self.mark_rim_part(mark);
            return;
        }
        let Some(first) = self.tools.stretch_from() else { return };
        mark.selected.push(first);
        let faces = self.document.cages.values().flat_map(|cage| &cage.faces);
        let corners: BTreeSet<PointId> =
            faces.filter(|face| face.contains(&first)).flatten().copied().collect();
        let ends = corners.into_iter().map(|other| [first, other]);
        let ends = ends.filter(|ends| face_between(&self.document, *ends).is_ok());
        mark.sketch.extend(ends.filter_map(|ends| self.edge_places(ends)));
        if let Some(Hit::Point { id, .. }) = mark.hover
            && id != first
        {
            let places = self.edge_places([first, id]);
            mark.parts.extend(places.map(|places| NetPart { places, is_selected: false }));
        }
    }

    /// The edge at a rim that was chosen, where a curve along the rim would begin, and what would become one.
    fn mark_rim_part(&self, mark: &mut Highlight) {
        let edge = self.tools.rim().and_then(|(_, ends)| self.edge_places(ends));
        mark.parts.extend(edge.map(|places| NetPart { places, is_selected: true }));
        let Some(first) = self.tools.stretch_from() else { return };
        mark.selected.push(first);
        let over = match mark.hover {
            Some(Hit::Point { id, .. }) => self.tools.rim_part(&self.document, [first, id]),
            _ => None,
        };
        let places = over.iter().flatten().filter_map(|point| self.scene.point(*point));
        mark.sketch.extend(over.is_some().then(|| places.collect()));
    }

    /// Awaits the corners between which a face should be split; a selected vertex is the first.
    pub(crate) fn begin_split(&mut self) {
        let first = match self.selection {
            Selection::Point(id) => Some(id).filter(|id| self.document.cages_on(*id).next().is_some()),
            _ => None,
        };
        self.tools.choose_divide(first);
        self.hand.hover_is_stale = true;
        self.notices.hide_toast();
        self.refresh();
    }

    /// Where the centre of a new cage would be.
    pub(crate) fn mark_new_cage(&self, mark: &mut Highlight) {
        let at = self.hand.cursor.filter(|_| self.hand.hover_view.is_none());
        mark.ghost.extend(at.and_then(|at| self.place_on_plane(at, self.hand.modifiers)));
    }

    fn edge_places(&self, ends: [PointId; 2]) -> Option<Vec<Vec3>> {
        ends.into_iter().map(|end| self.scene.point(end)).collect()
    }

    /// The points of the selected edge or face, and where one of them is.
    pub(crate) fn selected_part(&self) -> Option<(Vec<PointId>, Vec3)> {
        let points = match self.selection {
            Selection::Edge { ends, .. } => ends.to_vec(),
            Selection::Face { surface, face } => {
                self.document.cages.get(&surface)?.faces.get(face as usize)?.clone()
            }
            _ => return None,
        };
        let at = self.scene.point(*points.first()?)?;
        Some((points, at))
    }

    /// The surface over a cage that is selected, or of which a part is.
    fn caged(&self) -> Option<(SurfaceId, &Cage)> {
        let surface = match self.selection {
            Selection::Surface(surface)
            | Selection::Edge { surface, .. }
            | Selection::Face { surface, .. } => surface,
            Selection::None | Selection::Point(_) | Selection::Curve(_) => return None,
        };
        self.document.cages.get(&surface).map(|cage| (surface, cage))
    }

    /// Changes how the selected surface is made.
    fn change_settings(&mut self, change: impl FnOnce(&mut CageSettings)) {
        let Some((surface, cage)) = self.caged() else { return };
        let (before, mut settings) = (cage.settings, cage.settings);
        change(&mut settings);
        if settings != before {
            self.request(Request::Edit(Edit::CageSettings { surface, settings }));
        }
    }

    /// Shows what can be chosen of the selected cage, and done to the selected part of it.
    pub(crate) fn show_cage(&self) {
        let (is_face, is_edge) = match self.selection {
            Selection::Face { .. } => (true, false),
            Selection::Edge { .. } => (false, true),
            _ => (false, false),
        };
        dom::show(&dom::element("face-properties"), is_face);
        dom::show(&dom::element("edge-properties"), is_edge);
        for button in ["rim-curve", "rim-between"] {
            dom::show(&dom::element(button), self.is_at_rim());
        }
        let caged = self.caged();
        dom::show(&dom::element("cage-properties"), caged.is_some());
        let Some((_, cage)) = caged else { return };
        let settings = cage.settings;
        let split = settings.split.and_then(|own| SPLITS.iter().position(|(split, _)| *split == own));
        menu::show(SPLIT, split, Some("Automatic"));
        menu::show(MAP, MAPS.iter().position(|(map, _)| *map == settings.map), None);
        let boundary = BOUNDARIES.iter().position(|(rule, _)| *rule == settings.boundary);
        menu::show(BOUNDARY, boundary, None);
        let blend = match settings.blend {
            CageBlend::Hermite(_) => 0,
            CageBlend::Bump(_) => 1,
            CageBlend::Erbs => 2,
        };
        menu::show(BLEND, Some(blend), None);
        dom::show(&dom::element("cage-order-field"), settings.blend != CageBlend::Erbs);
    }

    /// Shows which cage a click would place.
    pub(crate) fn show_cage_option(&self) -> bool {
        let is_cage = self.tools.kind() == ToolKind::Cage;
        dom::show(&dom::element("cage-option"), is_cage);
        let form = self.tools.options().form;
        menu::show(FORM, CageForm::ALL.iter().position(|other| *other == form), None);
        is_cage
    }

    /// The size of a new cage while nobody chose another, of few digits: one that fits the view.
    pub(crate) fn suited_size(&self) -> f64 {
        let at = self.camera.pose().centre;
        let size = SUITED * self.camera.viewport().min_element() * self.camera.unit_per_pixel(at);
        short(f64::from(size))
    }

    /// How far a face is extruded while nobody chose another distance: about as far as its corners are from its middle.
    fn extrude_distance(&self) -> f64 {
        self.tools.options().distance.unwrap_or_else(|| match self.selection {
            Selection::Face { surface, face } => {
                let corners = cage_face(&self.scene, &self.document, surface, face).unwrap_or_default();
                let count = glam::DVec2::new(corners.len().max(1) as f64, 0.0).as_vec2().x;
                let middle = corners.iter().sum::<Vec3>() / count;
                short(f64::from(corners.iter().map(|corner| corner.distance(middle)).sum::<f32>() / count))
            }
            _ => 0.0,
        })
    }

    /// What a field shows.
    pub(crate) fn cage_text(&self, field: &str) -> String {
        match (field, self.caged()) {
            (SIZE, _) => number::show(self.tools.options().size.unwrap_or_else(|| self.suited_size())),
            (DISTANCE, _) => number::show(self.extrude_distance()),
            (ORDER, Some((_, cage))) => match cage.settings.blend {
                CageBlend::Hermite(order) | CageBlend::Bump(order) => order.to_string(),
                CageBlend::Erbs => String::new(),
            },
            (RESOLUTION, Some((_, cage))) => {
                cage.settings.resolution.map(|steps| steps.to_string()).unwrap_or_default()
            }
            _ => String::new(),
        }
    }

    /// Takes what was typed; says what is wrong with it.
    pub(crate) fn typed_cage(&mut self, field: &str, text: &str) -> Option<String> {
        let is_empty = text.trim().is_empty();
        let value = if is_empty { Ok(0.0) } else { number::parse(text) };
        let value = match value {
            Ok(value) => value,
            Err(error) => return Some(error.to_string()),
        };
        match field {
            SIZE if !is_empty && value <= 0.0 => return Some("A size is above 0.".to_owned()),
            SIZE => self.tools.options_mut().size = Some(value).filter(|_| !is_empty),
            DISTANCE if !is_empty && value == 0.0 => {
                return Some("A distance is a number other than 0; a negative one goes inwards.".to_owned());
            }
            DISTANCE => self.tools.options_mut().distance = Some(value).filter(|_| !is_empty),
            _ => {
                let Some(count) = whole(value) else {
                    return Some("This is a whole number above 0.".to_owned());
                };
                let count = Some(count).filter(|_| !is_empty);
                if field == RESOLUTION {
                    self.change_settings(|settings| settings.resolution = count);
                } else {
                    self.change_settings(|settings| {
                        if let (CageBlend::Hermite(order) | CageBlend::Bump(order), Some(count)) =
                            (&mut settings.blend, count)
                        {
                            *order = count;
                        }
                    });
                }
            }
        }
        self.refresh();
        None
    }

    /// Does what a button asks for; says whether it was one of these.
    pub(crate) fn cage_command(&mut self, command: &str) -> bool {
        match command {
            "extrude" => self.extrude(),
            "delete-face" => {
                if let Selection::Face { surface, face } = self.selection {
                    self.request(Request::Edit(Edit::DeleteFace { surface, face }));
                }
            }
            "split-face" => {
                if let Selection::Face { surface, face } = self.selection {
                    self.request(Request::Edit(Edit::SplitFace { surface, face, between: None }));
                }
            }
            "divide" => self.begin_split(),
            "split-edge" => {
                if let Selection::Edge { surface, ends } = self.selection {
                    self.request(Request::Edit(Edit::SplitEdge { surface, ends, at: 0.5 }));
                }
            }
            "rim-curve" => {
                if let Selection::Edge { surface, ends } = self.selection {
                    self.request(Request::Edit(Edit::Rim { surface, ends, between: None }));
                }
            }
            "rim-between" => {
                if let Selection::Edge { surface, ends } = self.selection {
                    self.tools.choose_rim(surface, ends);
                    self.hand.hover_is_stale = true;
                    self.refresh();
                }
            }
            _ => return false,
        }
        true
    }

    /// Whether the selected edge is one at which its cage ends.
    fn is_at_rim(&self) -> bool {
        let (Selection::Edge { ends: [a, b], .. }, Some((_, cage))) = (self.selection, self.caged()) else {
            return false;
        };
        let rim = cage.rim();
        [(a, b), (b, a)].iter().any(|(from, to)| rim.get(from).is_some_and(|edge| edge.to == *to))
    }

    /// Extrudes the selected face.
    pub(crate) fn extrude(&mut self) {
        match self.selection {
            Selection::Face { surface, face } => {
                let distance = self.extrude_distance();
                self.request(Request::Edit(Edit::Extrude { surface, face, distance }));
            }
            _ => self.notices.refusal("Click a face of a cage first; Extrude moves it out."),
        }
    }
}

/// A whole number above 0; anything will do for a field that is empty.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked before")]
fn whole(value: f64) -> Option<u32> {
    ((0.0..=1e6).contains(&value) && value.fract() == 0.0).then_some(value as u32)
}

/// A number of two digits.
fn short(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

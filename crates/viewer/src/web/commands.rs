//! Commands: what buttons and menu items ask for by their `data-command`.

use super::page::{Page, act};
use super::{dom, files};
use crate::tool::{Selection, Toggle, ToolKey, ToolKind};
use crate::{Shading, View};
use ductile_spec::{Edit, Example, ImportAs, PointId, Request};
use wasm_bindgen::JsCast;
use web_sys::{Element, Event, HtmlDialogElement, HtmlElement, KeyboardEvent, MouseEvent};

/// Menus with the buttons that open them.
const MENUS: [(&str, &str); 3] =
    [("file-button", "file-menu"), ("edit-button", "edit-menu"), ("look-button", "look-menu")];

/// Listens to all buttons, present and future.
pub(crate) fn listen() {
    dom::listen(&dom::document(), "click", |event: MouseEvent| {
        let target = event.target().and_then(|target| target.dyn_into::<Element>().ok());
        let button = target.and_then(|target| target.closest("[data-command]").ok().flatten());
        let Some(button) = button else { return };
        let Some(command) = button.get_attribute("data-command") else { return };
        let subject = button.get_attribute("data-subject").or_else(|| button.get_attribute("data-banner"));
        let checks = button.get_attribute("aria-checked").is_some();
        if !checks {
            close_menus();
        }
        if command == "open" {
            // Browsers open the file chooser only in the very event of the designer's act.
            files::choose();
        }
        act(move |page| page.command(&command, subject.as_deref()));
    });
    for (button, menu) in MENUS {
        let button = dom::element(button);
        let menu = dom::element(menu);
        let own = menu.clone();
        dom::listen(&menu, "beforetoggle", move |event: Event| {
            let opens = dom::field(&event, "newState").as_string().as_deref() == Some("open");
            dom::attribute(&button, "aria-expanded", if opens { "true" } else { "false" });
            if opens {
                place_below(&own, &button);
            }
        });
        let own = menu.clone();
        dom::listen(&menu, "keydown", move |event: KeyboardEvent| {
            let step = match event.key().as_str() {
                "ArrowDown" | "ArrowRight" => 1,
                "ArrowUp" | "ArrowLeft" => -1,
                _ => return,
            };
            event.prevent_default();
            walk(&own, step);
        });
    }
    list_examples();
}

/// Closes the menus.
pub(crate) fn close_menus() {
    for (_, menu) in MENUS {
        let _ = dom::element(menu).hide_popover();
    }
}

/// Moves the focus among the items of a menu, round and round.
fn walk(menu: &HtmlElement, step: i32) {
    let Ok(items) = menu.query_selector_all("button:not(:disabled)") else { return };
    let count = i32::try_from(items.length()).unwrap_or(0);
    let focused = dom::document().active_element();
    let at = |index: i32| items.get(u32::try_from(index).unwrap_or(0));
    let here = (0..count).find(|index| at(*index).as_ref() == focused.as_ref().map(AsRef::as_ref));
    let next = match here {
        Some(index) => (index + step).rem_euclid(count),
        None if step > 0 => 0,
        None => count - 1,
    };
    if let Some(item) = at(next).and_then(|item| item.dyn_into::<HtmlElement>().ok()) {
        let _ = item.focus();
    }
}

/// A menu hangs below its button, within the window.
fn place_below(menu: &HtmlElement, button: &HtmlElement) {
    let place = button.get_bounding_client_rect();
    let width = dom::window().inner_width().ok().and_then(|width| width.as_f64()).unwrap_or(1024.0);
    let style = menu.style();
    let _ = style.set_property("top", &format!("{}px", place.bottom() + 8.0));
    if place.left() < 0.5 * width {
        let left = (place.left() - 4.0).min(width - 300.0).max(8.0);
        let _ = style.set_property("left", &format!("{left}px"));
        let _ = style.set_property("right", "auto");
    } else {
        let _ = style.set_property("right", &format!("{}px", (width - place.right() - 4.0).max(8.0)));
        let _ = style.set_property("left", "auto");
    }
}

fn list_examples() {
    let shelf = dom::element("examples");
    for example in Example::all() {
        let button = dom::command_button("", "", "example");
        dom::attribute(&button, "role", "menuitem");
        dom::attribute(&button, "data-subject", example.word());
        let title = dom::create_with("span", "", example.title());
        dom::append(&button, [&dom::icon(&format!("t-{}", example.word())), &title]);
        dom::append(&shelf, [&button]);
    }
}

impl Page {
    /// Does what a button asks for.
    pub(crate) fn command(&mut self, command: &str, subject: Option<&str>) {
        if let Some(word) = command.strip_prefix("tool-") {
            if let Some(kind) = ToolKind::ALL.into_iter().find(|kind| kind.word() == word) {
                self.choose_tool(kind);
            }
        } else if let Some(word) = command.strip_prefix("option-") {
            if let Some(toggle) = Toggle::ALL.into_iter().find(|toggle| toggle.word() == word) {
                self.turn(toggle);
            }
        } else if let Some(name) = command.strip_prefix("look-") {
            match Shading::ALL.into_iter().find(|shading| shading.word() == name) {
                Some(shading) => self.choose_shading(shading),
                None => self.toggle_look(name),
            }
        } else if let Some(theme) = command.strip_prefix("theme-") {
            self.choose_theme(theme);
        } else if let Some(name) = command.strip_prefix("view-") {
            self.look_from(name);
        } else if !self.displacement_command(command, subject) && !self.document_command(command, subject) {
            self.page_command(command, subject);
        }
        self.refresh();
    }

    fn document_command(&mut self, command: &str, subject: Option<&str>) -> bool {
        match command {
            "new" => self.request(Request::New),
            "save" => self.save(),
            "export-obj" => self.export(),
            "link" => self.copy_link(),
            "import-cage" => self.import_otherwise(ImportAs::Cage),
            "import-mesh" => self.import_otherwise(ImportAs::Mesh),
            "example" => {
                if let Some(example) = Example::all().find(|e| Some(e.word()) == subject) {
                    self.request(Request::OpenExample(example));
                }
            }
            "undo" => self.undo(),
            "redo" => self.request(Request::Redo),
            "reset" => self.reset(),
            "delete" => self.delete_selected(),
            "reverse" => {
                if let Selection::Surface(surface) = self.selection {
                    self.request(Request::Edit(Edit::Reverse { surface }));
                }
            }
            "propagate" => {
                if let Selection::Surface(surface) = self.selection {
                    self.request(Request::Edit(Edit::Propagate { surface }));
                }
            }
            "match" => self.begin_match(),
            "free-tangent" => self.free_tangent(),
            "free-normal" => self.free_normal(),
            "free-ribbon" => self.free_ribbon(),
            "free-shadow" => self.free_shadow(),
            "free-told" => self.free_told(),
            "release" => {
                if let Selection::Point(point) = self.selection {
                    self.request(Request::Edit(Edit::Release { point }));
                }
            }
            "fill-all" => self.fill_all(),
            "merge-closest" => self.merge_closest(),
            "make-compatible" => self.make_compatible(),
            _ => return self.cage_command(command),
        }
        true
    }

    fn page_command(&mut self, command: &str, subject: Option<&str>) {
        match command {
            "fit" => self.fit_all(),
            "fit-legend" => self.fit_legend(),
            "focus" => self.focus_selected(),
            "projection" => self.camera.toggle_projection(),
            "store-view" => {
                self.camera.store();
                self.notices.say("This view is stored; 0 comes back to it.");
            }
            "recall-view" => match self.camera.recall() {
                Some(pose) => self.fly_to(pose),
                None => self.notices.refusal("No view is stored yet. Shift+0 stores the present one."),
            },
            "hide" => self.panel.toggle_bare(),
            "scene" => self.panel.toggle_side(),
            "help" => {
                self.list_keys();
                open_dialog("keys");
            }
            "key" => self.await_key(subject.unwrap_or_default()),
            "keys-reset" => self.reset_keys(),
            "close-dialog" => {
                self.list_keys();
                close_dialogs();
            }
            "dismiss" => self.notices.dismiss(subject.unwrap_or_default()),
            "select" => self.select_listed(subject.unwrap_or_default()),
            "restart" => self.restart_worker(),
            "redo-stage" => self.retry_stage(),
            _ => {}
        }
    }

    /// Takes a tool in hand.
    pub(crate) fn choose_tool(&mut self, kind: ToolKind) {
        self.tools.choose(kind);
        self.hand.hover_is_stale = true;
        self.notices.hide_toast();
        self.refresh();
    }

    /// Takes back the last act; in the middle of a drag, the drag; of a curve under way, its last point.
    pub(crate) fn undo(&mut self) {
        if self.abandon_drag() {
            return;
        }
        if self.tools.is_under_way() {
            self.tool_key(ToolKey::Back);
        } else {
            self.request(Request::Undo);
        }
    }

    /// Deletes what is selected, or releases it if something hangs on it.
    pub(crate) fn delete_selected(&mut self) {
        if self.tools.kind() == ToolKind::Displace && self.erase_chosen() {
            return;
        }
        match self.selection.removal(&self.scene.structure) {
            None if matches!(self.selection, Selection::Edge { .. }) => {
                self.notices.refusal("An edge cannot be deleted. Delete a face beside it.");
            }
            Some(edit) => self.request(Request::Edit(edit)),
            None => self.notices.refusal("Nothing is selected. Click a point, a curve or a surface first."),
        }
    }

    fn reset(&mut self) {
        if let Some(text) = self.opened.clone() {
            self.resetting = true;
            self.request(Request::OpenText { text });
        }
    }

    fn focus_selected(&mut self) {
        let at = match self.selection {
            Selection::Point(id) => self.scene.point(id),
            Selection::Curve(id) => {
                let count = self.scene.samples(id).len().max(1);
                let sum: glam::Vec3 = self.scene.samples(id).sum();
                Some(sum / glam::DVec2::new(count as f64, 0.0).as_vec2().x)
            }
            Selection::Edge { surface, .. } | Selection::Face { surface, .. } => {
                self.scene.ball_of(surface).map(|(centre, _)| centre)
            }
            Selection::Surface(_) | Selection::None => None,
        };
        match at {
            Some(at) => {
                let pose = self.camera.pose_that_focuses(at);
                self.fly_to(pose);
            }
            None => self.fit_all(),
        }
    }

    fn look_from(&mut self, name: &str) {
        let view = match name {
            "front" => View::Front,
            "back" => View::Back,
            "right" => View::Right,
            "left" => View::Left,
            "top" => View::Top,
            "bottom" => View::Bottom,
            _ => return,
        };
        let pose = self.camera.pose_from(view);
        self.fly_to(pose);
    }

    /// A thing of the scene list was chosen: it is selected, and given to a tool that wants such a thing.
    fn select_listed(&mut self, subject: &str) {
        let Some((kind, number)) = subject.split_once(' ') else { return };
        let Ok(number) = number.parse::<u32>() else { return };
        self.selection = match kind {
            "point" => Selection::Point(PointId(number)),
            "curve" => Selection::Curve(ductile_spec::CurveId(number)),
            "surface" => Selection::Surface(ductile_spec::SurfaceId(number)),
            _ => return,
        };
        let wants = match (self.tools.kind(), self.selection) {
            (
                ToolKind::Shape | ToolKind::Point | ToolKind::Curve | ToolKind::Draw | ToolKind::Divide,
                Selection::Curve(_),
            ) => false,
            (_, Selection::Curve(_)) => true,
            (kind, Selection::Point(_)) => matches!(kind, ToolKind::Curve | ToolKind::Divide),
            // Which part of a surface is meant, a list cannot say.
            _ => false,
        };
        if wants {
            self.take_selected();
        }
    }
}

/// Opens a dialog of index.html.
pub(crate) fn open_dialog(id: &str) {
    let dialog: HtmlDialogElement = dom::element_as(id);
    if !dialog.open() {
        let _ = dialog.show_modal();
    }
}

fn close_dialogs() {
    for id in ["keys", "link-dialog"] {
        dom::element_as::<HtmlDialogElement>(id).close();
    }
}

/// Whether a dialog or a menu has the keyboard.
pub(crate) fn dialog_is_open() -> bool {
    let menu_is_open = dom::document().query_selector(":popover-open").ok().flatten().is_some();
    menu_is_open || ["keys", "link-dialog"].iter().any(|id| dom::element_as::<HtmlDialogElement>(id).open())
}

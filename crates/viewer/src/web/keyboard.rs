//! The keyboard.

use super::page::{self, Page, act};
use super::{commands, dom, files};
use crate::Shading;
use crate::keys::Chord;
use crate::tool::{Arrow, Axis, Selection, Surroundings, Toggle, ToolKey, ToolKind, nudge_direction};
use ductile_spec::{Edit, Request};
use wasm_bindgen::JsCast;
use web_sys::{Element, KeyboardEvent};

/// A key press, apart from its event.
#[derive(Clone, Debug)]
struct Key {
    name: String,
    code: String,
    shift: bool,
    ctrl: bool,
    alt: bool,
    on_canvas: bool,
}

/// Listens to the whole window.
pub(crate) fn listen() {
    dom::listen(&dom::window(), "keydown", |event: KeyboardEvent| {
        let target = event.target().and_then(|target| target.dyn_into::<Element>().ok());
        let is_typing =
            target.as_ref().is_some_and(|t| t.matches("input, textarea, select").unwrap_or(false));
        if event.is_composing() {
            return;
        }
        let key = Key {
            name: event.key(),
            code: event.code(),
            shift: event.shift_key(),
            ctrl: event.ctrl_key() || event.meta_key(),
            alt: event.alt_key(),
            on_canvas: target.as_ref().is_none_or(|t| t.id() == "view" || t.tag_name() == "BODY"),
        };
        if page::look(|page| page.keys.is_waiting()) == Some(true) && commands::dialog_is_open() {
            if !matches!(key.name.as_str(), "Shift" | "Control" | "Alt" | "AltGraph" | "Meta") {
                event.prevent_default();
                let chord = key.chord();
                act(move |page| page.change_key(&chord));
            }
            return;
        }
        if commands::dialog_is_open() {
            return;
        }
        let Some(key) = key.meant() else { return };
        // Inside a field the keys belong to the field, but for those that save and open.
        let is_global = key.ctrl && matches!(key.name.to_lowercase().as_str(), "s" | "o");
        // A focused button or menu keeps Space, Enter, Tab and the arrows.
        let is_local = matches!(key.name.as_str(), " " | "Enter" | "Tab") || key.name.starts_with("Arrow");
        if (is_typing && !is_global) || (!key.on_canvas && is_local) {
            return;
        }
        if key.name == "Tab" {
            dom::class(&dom::element("view"), "pointed", false);
        }
        if is_understood(&key) {
            event.prevent_default();
            if key.ctrl && key.name.eq_ignore_ascii_case("o") {
                files::choose();
                return;
            }
            act(move |page| page.pressed(&key));
        }
    });
    for event in ["keydown", "keyup"] {
        dom::listen(&dom::window(), event, |event: KeyboardEvent| {
            let ctrl = event.ctrl_key() || event.meta_key();
            let (shift, alt) = (event.shift_key(), event.alt_key());
            act(move |page| {
                let modifiers = crate::input::Modifiers { shift, ctrl, alt };
                if page.hand.modifiers != modifiers && page.hand.drag.is_some() {
                    page.hand.modifiers = modifiers;
                    page.follow_cursor();
                }
            });
        });
    }
}

impl Key {
    /// How the list of keys names it.
    fn chord(&self) -> Chord {
        let name = digit(&self.code).map_or_else(|| self.name.to_lowercase(), String::from);
        Chord { ctrl: self.ctrl, shift: self.shift && self.ctrl, alt: self.alt, name }
    }

    /// The key that stands for what this one means as the designer has it; none if it means nothing.
    fn meant(self) -> Option<Self> {
        let chord = self.chord();
        let meant = page::look(|page| page.keys.meaning(&chord)).unwrap_or_else(|| Some(chord.clone()))?;
        if meant == chord {
            return Some(self);
        }
        let is_digit = meant.name.len() == 1 && meant.name.as_bytes()[0].is_ascii_digit();
        let code = if is_digit { format!("Digit{}", meant.name) } else { String::new() };
        let shift = if meant.ctrl { meant.shift } else { self.shift };
        Some(Self { name: meant.name, code, shift, ctrl: meant.ctrl, alt: meant.alt, ..self })
    }
}

/// Keys that the browser must not act on as well.
fn is_understood(key: &Key) -> bool {
    let name = key.name.to_lowercase();
    if key.ctrl {
        let chord = matches!(name.as_str(), "z" | "y" | "s" | "o") || (name == "c" && key.shift);
        return chord || digit(&key.code).is_some_and(|digit| matches!(digit, '1' | '3' | '7'));
    }
    if key.alt {
        return digit(&key.code).and_then(Shading::of_digit).is_some();
    }
    match name.as_str() {
        // Tab walks only where there is something to walk through and the canvas has the focus.
        "tab" => key.on_canvas && has_canvas_focus() && has_points(),
        "escape" | "enter" | "backspace" | "delete" | " " | "home" | "." | "?" | "\\" | "h" | "r" | "e"
        | "[" | "]" => true,
        "arrowleft" | "arrowright" | "arrowup" | "arrowdown" => true,
        _ => {
            let is_view = digit(&key.code).is_some_and(|digit| "01357".contains(digit));
            is_view || ToolKind::of_key(&name).is_some() || Axis::of_key(&name).is_some()
        }
    }
}

fn has_canvas_focus() -> bool {
    dom::document().active_element().is_some_and(|element| element.id() == "view")
}

fn has_points() -> bool {
    page::look(|page| !page.scene.structure.points.is_empty()).unwrap_or(false)
}

fn digit(code: &str) -> Option<char> {
    let digit = code.strip_prefix("Digit").or_else(|| code.strip_prefix("Numpad"))?;
    digit.chars().next().filter(|c| digit.len() == 1 && c.is_ascii_digit())
}

impl Page {
    fn pressed(&mut self, key: &Key) {
        let name = key.name.to_lowercase();
        if key.ctrl && self.chord(&name, key.shift) {
            return;
        }
        if let Some(shading) = digit(&key.code).filter(|_| key.alt).and_then(Shading::of_digit) {
            self.choose_shading(shading);
            return;
        }
        if let Some(digit) = digit(&key.code) {
            self.view_key(digit, key.shift || key.ctrl);
            return;
        }
        if let (Some(axis), Some(drag)) = (Axis::of_key(&name), &mut self.hand.drag) {
            drag.toggle(axis);
            self.follow_cursor();
            self.refresh();
            return;
        }
        if let Some(toggle) = Toggle::of_key(self.tools.kind(), &name) {
            self.turn(toggle);
            return;
        }
        if name == "e" && self.tools.kind() == ToolKind::Cage && self.hand.drag.is_none() {
            self.extrude();
            return;
        }
        let splits = matches!(self.tools.kind(), ToolKind::Cage | ToolKind::Divide);
        if name == "x" && splits && self.hand.drag.is_none() {
            self.begin_split();
            return;
        }
        if let Some(kind) = ToolKind::of_key(&name).filter(|_| self.hand.drag.is_none()) {
            self.choose_tool(kind);
            return;
        }
        if self.range_key(&name) {
            return;
        }
        self.plain_key(&name, key);
        self.refresh();
    }

    fn chord(&mut self, name: &str, shift: bool) -> bool {
        match (name, shift) {
            ("z", false) => self.undo(),
            ("z", true) | ("y", _) => self.request(Request::Redo),
            ("s", _) => self.save(),
            ("c", true) => self.copy_link(),
            _ => return false,
        }
        true
    }

    fn view_key(&mut self, digit: char, opposite: bool) {
        let command = match (digit, opposite) {
            ('1', false) => "view-front",
            ('1', true) => "view-back",
            ('3', false) => "view-right",
            ('3', true) => "view-left",
            ('7', false) => "view-top",
            ('7', true) => "view-bottom",
            ('5', _) => "projection",
            ('0', false) => "recall-view",
            ('0', true) => "store-view",
            _ => return,
        };
        self.command(command, None);
    }

    fn plain_key(&mut self, name: &str, key: &Key) {
        match name {
            "escape" => self.escape(),
            "enter" if self.tools.kind() == ToolKind::Merge => self.merge_closest(),
            "enter" if self.tools.kind() == ToolKind::Fill && !self.tools.is_under_way() => self.fill_all(),
            "enter" => self.tool_key(ToolKey::Done),
            "backspace" if self.tools.is_under_way() => self.tool_key(ToolKey::Back),
            "backspace" | "delete" => self.delete_selected(),
            "tab" => {
                self.selection = self.selection.walk(&self.scene.structure, key.shift);
                self.announce_selection();
            }
            " " => self.take_selected(),
            "arrowleft" => self.nudge(Arrow::Left, key.shift),
            "arrowright" => self.nudge(Arrow::Right, key.shift),
            "arrowup" => self.nudge(Arrow::Up, key.shift),
            "arrowdown" => self.nudge(Arrow::Down, key.shift),
            "home" => self.fit_all(),
            "." => self.command("focus", None),
            "?" => self.command("help", None),
            "\\" | "h" => self.command("hide", None),
            _ => {}
        }
    }

    /// Puts a drag back, gives up what a tool has begun, leaves the tool, drops the selection, gives the
    /// focus back: the first of these that there is.
    fn escape(&mut self) {
        if self.abandon_drag() {
            return;
        }
        if self.tools.is_under_way() || self.tools.kind() != ToolKind::Shape {
            self.tool_key(ToolKey::Escape);
        } else if self.selection != Selection::None {
            self.selection = Selection::None;
        } else {
            let _ = dom::element("view").blur();
        }
        self.notices.hide_toast();
        self.refresh();
    }

    pub(crate) fn tool_key(&mut self, key: ToolKey) {
        let around = Surroundings {
            structure: &self.scene.structure,
            document: &self.document,
            forward: self.camera.forward(),
            radius: self.suited_radius(),
            size: self.suited_size(),
        };
        let acts = self.tools.key(key, around);
        self.perform(acts);
    }

    fn nudge(&mut self, arrow: Arrow, far: bool) {
        if let Some((points, at)) = self.selected_part() {
            let step = self.grid() * if far { 1.0 } else { 0.1 };
            let probe = glam::DVec2::new(step, 0.0).as_vec2().x;
            if let Some(direction) = nudge_direction(&self.camera, at, arrow, probe) {
                self.request(Request::Edit(Edit::Shift { points, by: direction.as_dvec3() * step }));
            }
            return;
        }
        let Selection::Point(point) = self.selection else {
            self.notices.refusal("Select a control point first: Tab walks through them.");
            return;
        };
        let (Some(at), Some(exact)) = (self.scene.point(point), self.exact_place(point)) else { return };
        let step = self.grid() * if far { 1.0 } else { 0.1 };
        let probe = glam::DVec2::new(step, 0.0).as_vec2().x;
        if let Some(direction) = nudge_direction(&self.camera, at, arrow, probe) {
            let to = exact + direction.as_dvec3() * step;
            self.request(Request::Edit(Edit::Move { point, to }));
        }
    }

    fn announce_selection(&mut self) {
        if let Selection::Point(id) = self.selection {
            self.notices.say(&format!("Control point {} is selected.", id.0));
        }
        self.refresh();
    }
}

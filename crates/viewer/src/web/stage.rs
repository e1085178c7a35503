//! The picture: when it is drawn, and what happens when there is no graphics device.
//!
//! A picture is drawn when something has changed, once per display tick, from the newest frame and the newest
//! view. A lost device is replaced by the same calls as at the start.

use super::dom;
use super::page::{MOST_RETRIES, Page, RETRY_MILLISECONDS, act};
use crate::limit::Limit;
use crate::tool::{Arm, Selection, ToolKind, ghost_line, work_plane};
use crate::{GpuError, Highlight, Look, Renderer, Tinted, drape};
use ductile_spec::GrabTarget;
use glam::{Vec2, Vec3};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{Event, HtmlCanvasElement};

/// A canvas larger than this is drawn coarser.
const MOST_PIXELS: f64 = 16.0e6;
/// Up to this width in CSS pixels the tools lie at the bottom edge (style.css says the same).
const NARROW: f32 = 640.0;
/// Height at the lower edge that the status line and a hint of two lines take, in CSS pixels.
const STATUS: f32 = 60.0;
/// Pause before a device is asked for again, and before a canvas that was not ready is tried again.
const PAUSE: i32 = 250;

const NO_WEBGPU: &str = "This browser shows no picture, because WebGPU is missing or switched off. Chrome and Edge have it from version 113, Safari from 26, Firefox from 141 on Windows and 145 on a Mac; on Linux it may have to be switched on (Chrome: chrome://flags, “Unsafe WebGPU Support” and “Vulkan”; Firefox: dom.webgpu.enabled in about:config). The model is here all the same: it can be opened, saved and exported.";

/// How it stands with the graphics device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Device {
    Starting,
    Ready,
    Missing,
    Lost,
}

impl Device {
    /// Its word for the inspection.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Starting => "starting",
            Self::Ready => "ready",
            Self::Missing => "missing",
            Self::Lost => "lost",
        }
    }
}

/// The picture and its device.
#[derive(Debug)]
pub(crate) struct Stage {
    canvas: HtmlCanvasElement,
    renderer: Option<Renderer>,
    pub(crate) device: Device,
    pub(crate) losses: u32,
    retries: Limit,
    /// Tells a device that was given up from the present one.
    generation: u32,
    is_due: bool,
    ratio: f64,
    pub(crate) pictures: u32,
    pub(crate) structure_is_new: bool,
    pub(crate) frame_is_new: bool,
    /// Where the numbers of a frame are copied to; kept, so that a frame allocates nothing.
    pub(crate) floats: Vec<f32>,
}

/// Follows the theme of the system.
pub(crate) fn listen() {
    if let Ok(Some(list)) = dom::window().match_media("(prefers-color-scheme: dark)") {
        dom::listen(&list, "change", |_: Event| act(|page| page.apply_settings()));
    }
}

impl Stage {
    pub(crate) fn new() -> Self {
        Self {
            canvas: dom::element_as("view"),
            renderer: None,
            device: Device::Starting,
            losses: 0,
            retries: Limit::new(MOST_RETRIES, RETRY_MILLISECONDS),
            generation: 0,
            is_due: false,
            ratio: 1.0,
            pictures: 0,
            structure_is_new: false,
            frame_is_new: false,
            floats: Vec::new(),
        }
    }

    /// Gives the device up, as if it had been lost.
    pub(crate) fn lose(&self) {
        if let Some(renderer) = &self.renderer {
            renderer.destroy_device();
        }
    }
}

impl Page {
    /// Asks for a picture at the next display tick.
    pub(crate) fn redraw(&mut self) {
        if self.stage.is_due {
            return;
        }
        let tick = Closure::once_into_js(|now: f64| act(move |page| page.tick(now)));
        self.stage.is_due = dom::window().request_animation_frame(tick.unchecked_ref()).is_ok();
    }

    /// Begins to draw, also after a loss.
    pub(crate) fn start_stage(&mut self) {
        self.measure();
        self.stage.renderer = None;
        self.stage.generation += 1;
        let generation = self.stage.generation;
        let canvas = self.stage.canvas.clone();
        wasm_bindgen_futures::spawn_local(async move {
            let lost = move |why: String| {
                act(move |page| {
                    if page.stage.generation == generation {
                        page.device_lost(&why);
                    }
                });
            };
            let made = Renderer::new_on_canvas(canvas, lost).await;
            act(move |page| {
                if page.stage.generation == generation {
                    page.stage_is_set(made);
                }
            });
        });
    }

    fn stage_is_set(&mut self, made: Result<Renderer, GpuError>) {
        match made {
            Ok(renderer) => {
                if self.stage.device == Device::Lost {
                    let text = "The graphics device was lost and has been replaced. The model is untouched.";
                    self.notices.banner_for("device", text, 8000);
                }
                self.stage.renderer = Some(renderer);
                self.stage.device = Device::Ready;
                self.stage.structure_is_new = true;
                self.stage.frame_is_new = true;
                self.stage.ratio = 0.0;
                self.measure();
            }
            Err(GpuError::NoWebGpu) if self.stage.device != Device::Lost => {
                self.stage.device = Device::Missing;
                self.notices.banner(
                    "device",
                    NO_WEBGPU,
                    &[("Save file", "save"), ("Export OBJ", "export-obj")],
                );
            }
            Err(error) => self.device_lost(&error.to_string()),
        }
        self.refresh();
    }

    /// The device is gone: another one is asked for, a few times a minute.
    fn device_lost(&mut self, why: &str) {
        self.stage.renderer = None;
        self.stage.generation += 1;
        self.stage.device = Device::Lost;
        self.stage.losses += 1;
        web_sys::console::info_1(&JsValue::from_str(&format!("graphics device lost: {why}")));
        if self.stage.retries.allows(dom::now()) {
            let generation = self.stage.generation;
            dom::after(PAUSE, move || {
                act(move |page| {
                    if page.stage.generation == generation {
                        page.start_stage();
                    }
                });
            });
            return;
        }
        let text = format!(
            "The graphics device was lost again and again ({why}). The model is untouched: it can be saved and exported."
        );
        let buttons = [("Try again", "redo-stage"), ("Save file", "save"), ("Export OBJ", "export-obj")];
        self.notices.banner("device", &text, &buttons);
    }

    /// The designer wants to try again.
    pub(crate) fn retry_stage(&mut self) {
        self.stage.retries.reset();
        self.notices.dismiss("device");
        self.start_stage();
    }

    /// Takes the size of the canvas.
    pub(crate) fn measure(&mut self) {
        let canvas = &self.stage.canvas;
        let (width, height) = (f64::from(canvas.client_width()), f64::from(canvas.client_height()));
        if width < 1.0 || height < 1.0 {
            return;
        }
        let wanted = dom::window().device_pixel_ratio().clamp(0.25, 8.0);
        let ratio = wanted.min((MOST_PIXELS / (width * height)).sqrt());
        let size = glam::DVec2::new(width, height);
        let pixels = [width * ratio, height * ratio].map(whole);
        if [canvas.width(), canvas.height()] != pixels {
            canvas.set_width(pixels[0]);
            canvas.set_height(pixels[1]);
        }
        self.stage.ratio = wanted;
        self.settings.look.device_pixel_ratio = glam::DVec2::splat(ratio).as_vec2().x;
        let size = size.as_vec2();
        self.camera.set_viewport(size.x, size.y);
        self.camera.set_free(free_part(size));
        if let Some(renderer) = &mut self.stage.renderer {
            renderer.resize(pixels[0], pixels[1]);
        }
        self.hand.hover_is_stale = true;
        self.redraw();
    }

    fn tick(&mut self, now: f64) {
        self.stage.is_due = false;
        if self.stage.ratio.to_bits() != dom::window().device_pixel_ratio().clamp(0.25, 8.0).to_bits() {
            self.measure();
        }
        if self.camera.is_flying() {
            self.camera.advance(now);
            self.hand.hover_is_stale = true;
            self.redraw();
        }
        self.update_hover();
        self.watch_tube();
        self.update_panel();
        self.draw();
    }

    fn draw(&mut self) {
        self.find_strips();
        let highlight = self.highlight();
        let look = Look { triad: self.shows_triad(), ..self.settings.look };
        let Some(renderer) = &mut self.stage.renderer else { return };
        if std::mem::take(&mut self.stage.structure_is_new) {
            renderer.upload_structure(&self.scene);
            self.stage.frame_is_new = true;
        }
        if self.scene.has_frame() && std::mem::take(&mut self.stage.frame_is_new) {
            renderer.upload_frame(&self.scene);
        }
        match renderer.draw(&self.camera, &look, &highlight) {
            Ok(()) => self.stage.pictures += 1,
            Err(GpuError::NotReady) => {
                dom::after(PAUSE, || act(|page| page.redraw()));
            }
            Err(error) => self.device_lost(&error.to_string()),
        }
    }

    /// Whether the axes are shown: on a narrow screen the tools need their place.
    pub(crate) fn shows_triad(&self) -> bool {
        self.settings.look.triad && self.camera.viewport().x > NARROW
    }

    /// What the pointer and the tools mark.
    pub(crate) fn highlight(&self) -> Highlight {
        let mut mark = Highlight {
            hover: self.hand.hover,
            hover_view: self.hand.hover_view,
            held: self.hand.drag.filter(|drag| !drag.holds_part()).and(self.scene.header.held),
            work_plane: Some(work_plane(self.camera.forward())),
            directions: self.marked_directions(),
            ..Highlight::default()
        };
        match self.selection {
            Selection::Point(id) => mark.selected.push(id),
            Selection::Curve(id) => mark.selected_curve = Some(id),
            Selection::Surface(id) => mark.tinted.push(Tinted::Surface(id)),
            Selection::Edge { .. } | Selection::Face { .. } | Selection::None => {}
        }
        self.mark_cage(&mut mark);
        if self.tools.turns() {
            let held = self.hand.drag.map(|drag| drag.target());
            let is_hot = |arm: &Arm| {
                self.hand.hover_arm.is_some_and(|over| over.handle == arm.handle)
                    || held == Some(GrabTarget::Handle(arm.handle))
            };
            mark.arms = self.arms().iter().map(|arm| (arm.foot, arm.end, is_hot(arm))).collect();
        }
        match self.tools.kind() {
            ToolKind::Point if mark.hover.is_none() => {
                let at = self.hand.cursor.filter(|_| self.hand.hover_view.is_none());
                mark.ghost.extend(at.and_then(|at| self.place_on_plane(at, self.hand.modifiers)));
            }
            ToolKind::Cage if mark.hover.is_none() && self.hand.drag.is_none() => {
                self.mark_new_cage(&mut mark)
            }
            ToolKind::Sheet => self.mark_sheet(&mut mark),
            ToolKind::Shape | ToolKind::Point | ToolKind::Ribbon | ToolKind::Cage => {}
            ToolKind::Curve | ToolKind::Draw => self.mark_curve(&mut mark),
            ToolKind::Burnout | ToolKind::Crease | ToolKind::Split => self.mark_region(&mut mark),
            ToolKind::Sweep | ToolKind::Match => self.mark_ties(&mut mark),
            ToolKind::Embed => self.mark_embedding(&mut mark),
            ToolKind::Glue => self.mark_rims(&mut mark),
            ToolKind::Merge | ToolKind::Trim => self.mark_places(&mut mark),
            ToolKind::Displace => self.mark_displacements(&mut mark),
            ToolKind::Fill => self.mark_loop(&mut mark),
            ToolKind::Divide => self.mark_split(&mut mark),
            ToolKind::Shadow => self.mark_shadow(&mut mark),
        }
        self.mark_seam(&mut mark);
        self.mark_side(&mut mark);
        self.mark_strips(&mut mark);
        mark
    }

    /// The curve under way, and on to the pointer.
    fn mark_curve(&self, mark: &mut Highlight) {
        if let Some(stroke) = &self.hand.stroke {
            mark.ghost_line = stroke.places().collect();
            return;
        }
        let mut corners: Vec<Vec3> = self.tools.corners().iter().map(|corner| corner.at).collect();
        mark.ghost.clone_from(&corners);
        let over = match (self.hand.cursor, self.hand.hover) {
            (None, _) => None,
            (_, Some(hit)) => Some(hit.at()),
            (Some(_), None) if self.tools.kind() == ToolKind::Draw => None,
            (Some(cursor), None) => self.place_on_plane(cursor, self.hand.modifiers),
        };
        let on_corner = self.hand.cursor.and_then(|cursor| self.corner_at(cursor));
        let closes = on_corner == Some(0) && corners.len() >= 3;
        if let Some(at) = over.filter(|_| on_corner.is_none() && self.hand.hover_view.is_none()) {
            corners.push(at);
            mark.ghost.push(at);
        }
        mark.ghost_line = ghost_line(&corners, closes);
        if let Some(surface) = self.tools.canvas() {
            // As far as the spline can stray from its chords on a shape of this size.
            let reach = 0.5 * self.scene.ball_of(surface).map_or(0.0, |(_, radius)| radius);
            mark.ghost_line = drape(&self.scene, &self.camera, surface, &mark.ghost_line, reach);
        }
    }
}

/// The part of the canvas between the panels at its edges, from its upper left to its lower right corner. On a
/// narrow screen they come and go, and the model has all of it.
fn free_part(size: Vec2) -> Option<(Vec2, Vec2)> {
    let place = |id: &str| dom::element(id).get_bounding_client_rect();
    let is_shown = |id: &str| place(id).width() > 0.0;
    if size.x <= NARROW || !is_shown("tools") || !is_shown("bar") {
        return None;
    }
    let right = if is_shown("side") { place("side").left() } else { f64::from(size.x) };
    let lower = glam::DVec2::new(place("tools").right(), place("bar").bottom());
    // Not the hint's own height: it changes with every tool, and the model should not move with it.
    Some((lower.as_vec2(), Vec2::new(glam::DVec2::splat(right).as_vec2().x, size.y - STATUS)))
}

/// A length in whole pixels.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before")]
fn whole(pixels: f64) -> u32 {
    pixels.round().clamp(1.0, 32_768.0) as u32
}

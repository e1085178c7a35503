//! The canvas: pointers, wheel and size.

use super::dom;
use super::page::act;
use crate::input::{Button, Device, Modifiers, Pointer};
use glam::Vec2;
use wasm_bindgen::JsCast;
use wasm_bindgen::closure::Closure;
use web_sys::{Element, Event, MouseEvent, PointerEvent, ResizeObserver, WheelEvent};

/// Pixels of a wheel that counts lines or pages.
const LINE: f32 = 33.0;
const PAGE: f32 = 400.0;

/// Listens to everything that happens on the canvas.
pub(crate) fn listen() {
    let canvas = dom::element("view");
    listen_to_pointers(&canvas);
    dom::listen(&canvas, "wheel", |event: WheelEvent| {
        event.prevent_default();
        let (at, by, modifiers) = (place(&event), turned(&event), modifiers(&event));
        act(move |page| page.wheel(at, by, modifiers));
    });
    dom::listen(&canvas, "contextmenu", |event: Event| event.prevent_default());
    // Some browsers turn a middle press into scrolling, and a touch into a selection.
    dom::listen(&canvas, "mousedown", |event: MouseEvent| {
        if event.button() == 1 {
            event.prevent_default();
        }
    });
    observe_size(&canvas);
}

fn listen_to_pointers(canvas: &Element) {
    let target = canvas.clone();
    dom::listen(canvas, "pointerdown", move |event: PointerEvent| {
        let Some(button) = button(&event) else { return };
        // A lost capture is answered by pointercancel or by the next move without a button.
        let _ = target.set_pointer_capture(event.pointer_id());
        // Who points sees where; the ring is for those who came by the keyboard.
        dom::class(&target, "pointed", true);
        let pointer = pointer(&event);
        act(move |page| {
            page.hand.is_finger = pointer.device == Device::Touch;
            page.pointer_down(pointer, button);
        });
    });
    dom::listen(canvas, "pointermove", |event: PointerEvent| {
        let (pointer, pressed) = (pointer(&event), event.buttons() != 0);
        act(move |page| {
            page.hand.is_finger = pointer.device == Device::Touch;
            page.pointer_moved(pointer, pressed);
        });
    });
    dom::listen(canvas, "pointerup", |event: PointerEvent| {
        let pointer = pointer(&event);
        act(move |page| page.pointer_up(pointer));
    });
    for lost in ["pointercancel", "lostpointercapture"] {
        dom::listen(canvas, lost, |event: PointerEvent| {
            let id = event.pointer_id();
            act(move |page| page.pointer_lost(id));
        });
    }
    dom::listen(canvas, "pointerleave", |_: PointerEvent| act(|page| page.pointer_left()));
}

fn observe_size(canvas: &Element) {
    let changed = Closure::<dyn FnMut()>::new(|| act(|page| page.measure()));
    match ResizeObserver::new(changed.as_ref().unchecked_ref()) {
        Ok(observer) => observer.observe(canvas),
        Err(error) => web_sys::console::error_2(&"the size of the canvas is not observed".into(), &error),
    }
    changed.forget();
    dom::listen(&dom::window(), "resize", |_: Event| act(|page| page.measure()));
}

fn button(event: &PointerEvent) -> Option<Button> {
    match event.button() {
        0 => Some(Button::Primary),
        1 => Some(Button::Middle),
        2 => Some(Button::Secondary),
        _ => None,
    }
}

fn pointer(event: &PointerEvent) -> Pointer {
    let device = match event.pointer_type().as_str() {
        "touch" => Device::Touch,
        "pen" => Device::Pen,
        _ => Device::Mouse,
    };
    Pointer {
        id: event.pointer_id(),
        device,
        at: place(event),
        modifiers: modifiers(event),
        // When the hand acted, not when a busy page came to look.
        time: event.time_stamp(),
    }
}

/// Where it is on the canvas, which fills the window.
fn place(event: &MouseEvent) -> Vec2 {
    Vec2::new(number(event, "clientX"), number(event, "clientY"))
}

/// Browsers give fractions of pixels, which the bindings would round.
fn number(event: &MouseEvent, name: &str) -> f32 {
    let value = dom::field(event, name).as_f64().unwrap_or(f64::NAN);
    glam::DVec2::new(value, 0.0).as_vec2().x
}

fn turned(event: &WheelEvent) -> Vec2 {
    let unit = match event.delta_mode() {
        WheelEvent::DOM_DELTA_LINE => LINE,
        WheelEvent::DOM_DELTA_PAGE => PAGE,
        _ => 1.0,
    };
    glam::DVec2::new(event.delta_x(), event.delta_y()).as_vec2() * unit
}

fn modifiers(event: &MouseEvent) -> Modifiers {
    Modifiers { shift: event.shift_key(), ctrl: event.ctrl_key() || event.meta_key(), alt: event.alt_key() }
}

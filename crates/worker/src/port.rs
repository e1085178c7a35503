//! The message port of the worker.
//!
//! Page to worker: `{ c: Request, b: Float32Array? }`, where `b` is a frame buffer that the page has done with.
//! Worker to page: the string `"ready"` once; then to each request one `{ c: Reply, b: Float32Array, i: Uint32Array? }`,
//! whose buffers are transferred, not copied. Two frame buffers circulate, so a step allocates nothing.

use ductile_modeler::Modeler;
use ductile_spec::{Refusal, Reply, Request, TRAP};
use js_sys::{Array, Float32Array, Object, Reflect, Uint32Array};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{DedicatedWorkerGlobalScope, MessageEvent};

/// Begins to listen and says that it does.
pub(crate) fn open() {
    console_error_panic_hook::set_once();
    let scope: DedicatedWorkerGlobalScope = js_sys::global().unchecked_into();
    let mut modeler = Modeler::new();
    let answering = scope.clone();
    let on_message = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
        answer(&answering, &mut modeler, &event.data());
    });
    scope.set_onmessage(Some(on_message.as_ref().unchecked_ref()));
    on_message.forget(); // The port lives as long as the worker.
    post(&scope, &JsValue::from_str("ready"), &Array::new());
}

fn answer(scope: &DedicatedWorkerGlobalScope, modeler: &mut Modeler, message: &JsValue) {
    let spare: Option<Float32Array> = field(message, "b").dyn_into().ok();
    let control = field(message, "c");
    assert!(control.as_string().as_deref() != Some(TRAP), "a trap was asked for");
    let begin = now(scope);
    let mut reply = match serde_wasm_bindgen::from_value::<Request>(control) {
        Ok(request) => modeler.handle(request),
        Err(error) => unreadable(modeler, &error.to_string()),
    };
    reply.frame.figures.step_milliseconds = now(scope) - begin;
    let envelope = Object::new();
    let transfer = Array::new();
    let floats = fill(spare, modeler.floats());
    set(&envelope, "b", &floats);
    transfer.push(&floats.buffer());
    if reply.structure.is_some() {
        let indices = Uint32Array::from(modeler.indices());
        set(&envelope, "i", &indices);
        transfer.push(&indices.buffer());
    }
    match serde_wasm_bindgen::to_value(&reply) {
        Ok(control) => set(&envelope, "c", &control),
        Err(error) => web_sys::console::error_1(&JsValue::from_str(&format!("reply not encoded: {error}"))),
    }
    post(scope, &envelope, &transfer);
}

/// A message that is no request is refused like any other bad input; the model stays.
fn unreadable(modeler: &mut Modeler, reason: &str) -> Reply {
    let mut reply = modeler.handle(Request::Describe);
    let (act, reason) = ("Message".to_owned(), format!("not understood: {reason}"));
    reply.refused = Some(Refusal { act, reason, remedy: None });
    reply
}

/// The frame in a spare buffer of the right size, or in a new one.
fn fill(spare: Option<Float32Array>, floats: &[f32]) -> Float32Array {
    match spare {
        Some(buffer) if buffer.length() as usize == floats.len() => {
            buffer.copy_from(floats);
            buffer
        }
        _ => Float32Array::from(floats),
    }
}

fn now(scope: &DedicatedWorkerGlobalScope) -> f64 {
    scope.performance().map_or(0.0, |clock| clock.now())
}

fn field(object: &JsValue, name: &str) -> JsValue {
    Reflect::get(object, &JsValue::from_str(name)).unwrap_or(JsValue::UNDEFINED)
}

fn set(object: &Object, name: &str, value: &JsValue) {
    // Setting a field of a plain object that we have just made cannot fail.
    let _ = Reflect::set(object, &JsValue::from_str(name), value);
}

fn post(scope: &DedicatedWorkerGlobalScope, message: &JsValue, transfer: &Array) {
    if let Err(error) = scope.post_message_with_transfer(message, transfer) {
        web_sys::console::error_2(&JsValue::from_str("reply not sent:"), &error);
    }
}

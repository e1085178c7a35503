//! The message port to the worker.
//!
//! Page to worker: `{ c: Request, b: Float32Array? }`, where `b` is a frame buffer that the page has done
//! with. Worker to page: `"ready"` once, then one `{ c: Reply, b: Float32Array, i: Uint32Array? }` for each
//! request. A worker is disposable: after any failure it is thrown away, never used again.

use super::dom;
use super::page::act;
use ductile_spec::{Reply, Request};
use js_sys::{Array, Float32Array, Function, Object, Reflect, Uint32Array};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{Event, MessageEvent, Worker, WorkerOptions, WorkerType};

/// Trunk writes it beside the page.
const PROGRAM: &str = "./worker_loader.js";
/// A worker that is not ready after so long never will be.
const START_MILLISECONDS: f64 = 30_000.0;

/// What comes back from the worker.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) reply: Reply,
    pub(crate) floats: Option<Float32Array>,
    pub(crate) indices: Option<Uint32Array>,
}

/// The port, open or not.
#[derive(Debug, Default)]
pub(crate) struct Port {
    worker: Option<Worker>,
    is_ready: bool,
    started: f64,
    spare: Option<Float32Array>,
    /// Tells messages of a worker that was thrown away from those of the present one.
    generation: u32,
}

impl Port {
    /// Starts a worker in place of the one before.
    pub(crate) fn start(&mut self) -> Result<(), String> {
        self.stop();
        self.started = dom::now();
        let worker = create()?;
        let generation = self.generation;
        on(&worker, "message", move |event: MessageEvent| received(generation, &event.data()));
        on(&worker, "messageerror", move |_: Event| died(generation, "its message could not be read"));
        on(&worker, "error", move |event: Event| {
            // The console has the whole story already.
            let why = dom::field(&event, "message").as_string().filter(|text| !text.is_empty());
            died(generation, &why.unwrap_or_else(|| "its program could not be loaded".to_owned()));
        });
        self.worker = Some(worker);
        Ok(())
    }

    /// Throws the worker away.
    pub(crate) fn stop(&mut self) {
        if let Some(worker) = self.worker.take() {
            worker.terminate();
        }
        self.is_ready = false;
        self.spare = None;
        self.generation += 1;
    }

    /// Stops the worker without a word, as a hanging one would; for tests of the watch.
    pub(crate) fn silence(&self) {
        if let Some(worker) = &self.worker {
            worker.terminate();
        }
    }

    /// Whether there is no worker at all.
    pub(crate) fn is_stopped(&self) -> bool {
        self.worker.is_none()
    }

    /// Whether it takes requests.
    pub(crate) fn is_ready(&self) -> bool {
        self.is_ready
    }

    /// Whether it should long be ready.
    pub(crate) fn is_late(&self, now: f64) -> bool {
        self.worker.is_some() && !self.is_ready && now - self.started > START_MILLISECONDS
    }

    /// Counts the time of waiting anew.
    pub(crate) fn wait_anew(&mut self, now: f64) {
        self.started = now;
    }

    /// A frame buffer that the page has done with goes back with the next request.
    pub(crate) fn hand_back(&mut self, floats: Float32Array) {
        self.spare = Some(floats);
    }

    /// Sends a request.
    pub(crate) fn send(&mut self, request: &Request) -> Result<(), String> {
        let control = serde_wasm_bindgen::to_value(request).map_err(|error| error.to_string())?;
        self.send_raw(&control)
    }

    /// Sends what may be no request at all.
    pub(crate) fn send_raw(&mut self, control: &JsValue) -> Result<(), String> {
        let Some(worker) = &self.worker else { return Err("there is none".to_owned()) };
        let envelope = Object::new();
        dom::put(&envelope, "c", control);
        let transfer = Array::new();
        if let Some(spare) = self.spare.take() {
            transfer.push(&spare.buffer());
            dom::put(&envelope, "b", spare);
        }
        worker.post_message_with_transfer(&envelope, &transfer).map_err(|error| dom::message(&error))
    }
}

fn create() -> Result<Worker, String> {
    let options = WorkerOptions::new();
    options.set_type(WorkerType::Module);
    let made = match trusted(PROGRAM) {
        None => Worker::new_with_options(PROGRAM, &options),
        Some(url) => {
            let class: Function = dom::field(&dom::window(), "Worker").unchecked_into();
            Reflect::construct(&class, &Array::of(&[url, options.into()])).map(JsCast::unchecked_into)
        }
    };
    made.map_err(|error| dom::message(&error))
}

/// The address as a `TrustedScriptURL`, which a strict content security policy wants; `None` where browsers
/// do not know such a thing. The policy passes on the one address of this program and no other.
fn trusted(address: &str) -> Option<JsValue> {
    thread_local!(static POLICY: Option<JsValue> = make_policy());
    let policy = POLICY.with(Clone::clone)?;
    let make: Function = dom::field(&policy, "createScriptURL").dyn_into().ok()?;
    make.call1(&policy, &JsValue::from_str(address)).ok()
}

fn make_policy() -> Option<JsValue> {
    let factory = dom::field(&dom::window(), "trustedTypes");
    let create: Function = dom::field(&factory, "createPolicy").dyn_into().ok()?;
    let pass = Closure::<dyn Fn(String) -> Option<String>>::new(|address: String| {
        (address == PROGRAM).then_some(address)
    });
    let rules = Object::new();
    dom::put(&rules, "createScriptURL", pass.into_js_value());
    create.call2(&factory, &JsValue::from_str("ductile"), &rules).ok()
}

fn on<E: wasm_bindgen::convert::FromWasmAbi + 'static>(
    worker: &Worker,
    event: &str,
    handler: impl FnMut(E) + 'static,
) {
    dom::listen(worker, event, handler);
}

fn received(generation: u32, data: &JsValue) {
    if data.as_string().as_deref() == Some("ready") {
        act(move |page| {
            if page.port.generation == generation {
                page.port.is_ready = true;
                page.refresh();
            }
        });
        return;
    }
    let reply = serde_wasm_bindgen::from_value::<Reply>(dom::field(data, "c"));
    let floats = dom::field(data, "b").dyn_into().ok();
    let indices = dom::field(data, "i").dyn_into().ok();
    match reply {
        Ok(reply) => act(move |page| {
            if page.port.generation == generation {
                page.answered(Answer { reply, floats, indices });
            }
        }),
        Err(error) => died(generation, &error.to_string()),
    }
}

fn died(generation: u32, why: &str) {
    let why = why.to_owned();
    act(move |page| {
        if page.port.generation == generation {
            page.worker_died(&why);
        }
    });
}

//! The document object model in the words of the page.

use js_sys::{Object, Reflect};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::convert::FromWasmAbi;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{AddEventListenerOptions, Document, Element, EventTarget, HtmlElement, Window};

/// The window. A program of a page always has one.
pub(crate) fn window() -> Window {
    js_sys::global().unchecked_into()
}

/// The document of the window.
pub(crate) fn document() -> Document {
    field(&window(), "document").unchecked_into()
}

/// An element of index.html. If it is missing, a detached one keeps the rest of the page alive, and the
/// console says so.
pub(crate) fn element(id: &str) -> HtmlElement {
    match document().get_element_by_id(id) {
        Some(element) => element.unchecked_into(),
        None => {
            web_sys::console::error_1(&JsValue::from_str(&format!("the page lacks #{id}")));
            create("div")
        }
    }
}

/// As [`element`], of a more particular kind.
pub(crate) fn element_as<T: JsCast>(id: &str) -> T {
    element(id).unchecked_into()
}

/// A new element.
pub(crate) fn create(tag: &str) -> HtmlElement {
    match document().create_element(tag) {
        Ok(element) => element.unchecked_into(),
        Err(error) => wasm_bindgen::throw_val(error),
    }
}

/// A new element with a class and a text.
pub(crate) fn create_with(tag: &str, class: &str, text: &str) -> HtmlElement {
    let element = create(tag);
    if !class.is_empty() {
        element.set_class_name(class);
    }
    if !text.is_empty() {
        element.set_text_content(Some(text));
    }
    element
}

/// A new button that gives a command.
pub(crate) fn command_button(class: &str, text: &str, command: &str) -> HtmlElement {
    let button = create_with("button", class, text);
    attribute(&button, "type", "button");
    attribute(&button, "data-command", command);
    button
}

/// A new icon from the symbols of index.html.
pub(crate) fn icon(symbol: &str) -> Element {
    const SVG: &str = "http://www.w3.org/2000/svg";
    let made = document().create_element_ns(Some(SVG), "svg").and_then(|svg| {
        let reference = document().create_element_ns(Some(SVG), "use")?;
        reference.set_attribute("href", &format!("#{symbol}"))?;
        svg.append_child(&reference)?;
        svg.set_attribute("aria-hidden", "true")?;
        Ok(svg)
    });
    made.unwrap_or_else(|_| create("span").unchecked_into())
}

/// Sets an attribute. Names and values of this program are never refused.
pub(crate) fn attribute(element: &Element, name: &str, value: &str) {
    if element.get_attribute(name).as_deref() != Some(value) {
        let _ = element.set_attribute(name, value);
    }
}

/// Appends children.
pub(crate) fn append<const N: usize>(parent: &Element, children: [&Element; N]) {
    for child in children {
        let _ = parent.append_child(child);
    }
}

/// Removes all children.
pub(crate) fn clear(parent: &Element) {
    parent.set_text_content(None);
}

/// Shows or hides.
pub(crate) fn show(element: &HtmlElement, visible: bool) {
    if element.hidden() == visible {
        element.set_hidden(!visible);
    }
}

/// Sets a text, touching the document only if it is another.
pub(crate) fn text(element: &Element, text: &str) {
    if element.text_content().as_deref() != Some(text) {
        element.set_text_content(Some(text));
    }
}

/// Adds or takes away a class.
pub(crate) fn class(element: &Element, name: &str, present: bool) {
    let _ = element.class_list().toggle_with_force(name, present);
}

/// Listens for as long as the page lives.
pub(crate) fn listen<E: FromWasmAbi + 'static>(
    target: &EventTarget,
    event: &str,
    handler: impl FnMut(E) + 'static,
) {
    let options = AddEventListenerOptions::new();
    options.set_passive(false);
    let closure = Closure::<dyn FnMut(E)>::new(handler);
    let function = closure.as_ref().unchecked_ref();
    let added =
        target.add_event_listener_with_callback_and_add_event_listener_options(event, function, &options);
    if let Err(error) = added {
        web_sys::console::error_2(&JsValue::from_str("cannot listen for"), &error);
    }
    closure.forget();
}

/// Calls back once, after so many milliseconds. Returns what cancels it.
pub(crate) fn after(milliseconds: i32, then: impl FnOnce() + 'static) -> i32 {
    let function = Closure::once_into_js(then);
    let timer = window()
        .set_timeout_with_callback_and_timeout_and_arguments_0(function.unchecked_ref(), milliseconds);
    timer.unwrap_or(0)
}

/// Calls back again and again for as long as the page lives.
pub(crate) fn every(milliseconds: i32, then: impl FnMut() + 'static) {
    let closure = Closure::<dyn FnMut()>::new(then);
    let function = closure.as_ref().unchecked_ref();
    let _ = window().set_interval_with_callback_and_timeout_and_arguments_0(function, milliseconds);
    closure.forget();
}

/// Milliseconds since the page was opened; never goes back.
pub(crate) fn now() -> f64 {
    window().performance().map_or_else(js_sys::Date::now, |clock| clock.now())
}

/// Whether a media query holds.
pub(crate) fn media(query: &str) -> bool {
    window().match_media(query).ok().flatten().is_some_and(|list| list.matches())
}

/// A field of a value, undefined if there is none.
pub(crate) fn field(object: &JsValue, name: &str) -> JsValue {
    Reflect::get(object, &JsValue::from_str(name)).unwrap_or(JsValue::UNDEFINED)
}

/// Sets a field of an object of our own.
pub(crate) fn put(object: &Object, name: &str, value: impl Into<JsValue>) {
    let _ = Reflect::set(object, &JsValue::from_str(name), &value.into());
}

/// What a thrown value says.
pub(crate) fn message(error: &JsValue) -> String {
    let text = field(error, "message").as_string().or_else(|| error.as_string());
    text.filter(|text| !text.is_empty()).unwrap_or_else(|| "the browser gives no reason".to_owned())
}

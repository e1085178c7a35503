//! Selects of the properties: a choice among a few words, or none, which follows what is above.

use super::dom;
use web_sys::{Event, HtmlSelectElement};

/// Fills a select and listens to it: with the place of the choice among the labels, or nothing for none.
pub(crate) fn fill<const N: usize>(id: &str, labels: [&str; N], chosen: impl Fn(Option<usize>) + 'static) {
    let select: HtmlSelectElement = dom::element_as(id);
    let places = (0..N).map(|place| place.to_string());
    for (value, name) in [(String::new(), "")].into_iter().chain(places.zip(labels)) {
        let option = dom::create_with("option", "", name);
        dom::attribute(&option, "value", &value);
        dom::append(&select, [&option]);
    }
    let own = select.clone();
    dom::listen(&select, "change", move |_: Event| chosen(own.value().parse().ok()));
}

/// Shows a choice; the entry without one is there only where something is inherited.
pub(crate) fn show(id: &str, place: Option<usize>, inherited: Option<&str>) {
    let select: HtmlSelectElement = dom::element_as(id);
    if let Some(first) = select.query_selector("option").ok().flatten() {
        dom::text(&first, inherited.unwrap_or_default());
        if inherited.is_some() {
            let _ = first.remove_attribute("hidden");
        } else {
            dom::attribute(&first, "hidden", "");
        }
    }
    let value = place.map(|place| place.to_string()).unwrap_or_default();
    if select.value() != value {
        select.set_value(&value);
    }
}

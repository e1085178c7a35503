//! Files: opened from the disk or dropped on the page, and given to the designer as downloads.

use super::dom;
use super::page::{Page, act};
use ductile_spec::{ExportFormat, ImportFormat, MAX_TEXT_BYTES, Request, ribbon_holes, to_text};
use js_sys::{Array, Uint8Array};
use wasm_bindgen::JsCast;
use wasm_bindgen::JsValue;
use wasm_bindgen_futures::JsFuture;
use web_sys::{
    Blob, BlobPropertyBag, DragEvent, Event, File, FileList, HtmlAnchorElement, HtmlInputElement, Url,
};

/// Time for the browser to begin a download before its address goes.
const DOWNLOAD_MILLISECONDS: i32 = 60_000;

/// Listens for chosen and dropped files.
pub(crate) fn listen() {
    let input = dom::element_as::<HtmlInputElement>("file");
    let chosen = input.clone();
    dom::listen(&input, "change", move |_: Event| {
        open_first(chosen.files());
        // The same file can be chosen again.
        chosen.set_value("");
    });
    let window = dom::window();
    dom::listen(&window, "dragover", |event: DragEvent| {
        event.prevent_default();
        dom::show(&dom::element("drop-target"), true);
    });
    dom::listen(&window, "dragleave", |event: DragEvent| {
        if event.related_target().is_none() {
            dom::show(&dom::element("drop-target"), false);
        }
    });
    dom::listen(&window, "drop", |event: DragEvent| {
        event.prevent_default();
        dom::show(&dom::element("drop-target"), false);
        let Some(transfer) = event.data_transfer() else { return };
        let link = transfer.get_data("text/plain").unwrap_or_default();
        if link.contains("#d1=") {
            act(move |page| page.request(Request::OpenLink { link }));
        } else {
            open_first(transfer.files());
        }
    });
}

/// Lets the designer choose a file.
pub(crate) fn choose() {
    dom::element("file").click();
}

fn open_first(files: Option<FileList>) {
    let Some(file) = files.and_then(|files| files.get(0)) else { return };
    wasm_bindgen_futures::spawn_local(async move {
        let name = file.name();
        let opened = match ImportFormat::of_name(&name) {
            Some(format) => bytes_of(&file).await.map(|bytes| act(move |page| page.import(format, bytes))),
            None => read(&file).await.map(|text| act(move |page| page.open_text(text))),
        };
        match opened {
            Ok(()) => {}
            Err(why) => act(move |page| {
                let text = format!("“{name}” was not opened: {why}. The model on the screen is as it was.");
                page.notices.banner("opening", &text, &[]);
            }),
        }
    });
}

/// What is in a file of a mesh, which need be no text.
async fn bytes_of(file: &File) -> Result<Vec<u8>, String> {
    check_size(file)?;
    let buffer = JsFuture::from(file.array_buffer()).await.map_err(|error| dom::message(&error))?;
    Ok(Uint8Array::new(&buffer).to_vec())
}

fn check_size(file: &File) -> Result<(), String> {
    let is_short = file.size() <= as_float(MAX_TEXT_BYTES);
    let too_long = || format!("it has {} bytes; the limit is {MAX_TEXT_BYTES}", file.size());
    if is_short { Ok(()) } else { Err(too_long()) }
}

async fn read(file: &File) -> Result<String, String> {
    check_size(file)?;
    let text = JsFuture::from(file.text()).await.map_err(|error| dom::message(&error))?;
    text.as_string().ok_or_else(|| "it is not a text".to_owned())
}

/// A count of bytes as JavaScript has them.
pub(crate) fn as_float(bytes: usize) -> f64 {
    f64::from(u32::try_from(bytes).unwrap_or(u32::MAX))
}

impl Page {
    /// Opens a document, or fills with the ribbons that the text has instead.
    fn open_text(&mut self, text: String) {
        match ribbon_holes(&text) {
            None => self.request(Request::OpenText { text }),
            Some(Ok(holes)) => self.fill_ribbons(holes),
            Some(Err(why)) => {
                let text =
                    format!("The ribbons were not opened: {why}. The model on the screen is as it was.");
                self.notices.banner("opening", &text, &[]);
            }
        }
    }

    /// Saves the document as a file; the worker is not needed for it.
    pub(crate) fn save(&mut self) {
        if self.committed.is_none() {
            self.notices.refusal("There is nothing to save yet.");
            return;
        }
        let name = format!("{}.ductile.json", file_name(&self.document.name));
        match download(&name, "application/json", &to_text(&self.document)) {
            Ok(()) => self.notices.say(&format!("Saved as “{name}”.")),
            Err(error) => self.notices.refusal(&format!("The file was not saved: {}", dom::message(&error))),
        }
    }

    /// Asks for the surfaces as an OBJ file.
    pub(crate) fn export(&mut self) {
        self.request(Request::Export(ExportFormat::Obj));
    }

    /// An exported file came.
    pub(crate) fn export_came(&mut self, name: &str, text: &str) {
        match download(name, "model/obj", text) {
            Ok(()) => self.notices.say(&format!("Exported as “{name}”.")),
            Err(error) => {
                self.notices.refusal(&format!("The file was not exported: {}", dom::message(&error)))
            }
        }
    }
}

/// A name that every file system takes.
fn file_name(name: &str) -> String {
    let safe: String =
        name.chars().map(|c| if c.is_alphanumeric() || "-_ .()".contains(c) { c } else { '-' }).collect();
    let safe = safe.trim_matches(['.', ' ']);
    if safe.is_empty() { "model".to_owned() } else { safe.chars().take(80).collect() }
}

fn download(name: &str, kind: &str, text: &str) -> Result<(), JsValue> {
    let options = BlobPropertyBag::new();
    options.set_type(kind);
    let blob = Blob::new_with_str_sequence_and_options(&Array::of(&[JsValue::from_str(text)]), &options)?;
    let address = Url::create_object_url_with_blob(&blob)?;
    let anchor: HtmlAnchorElement = dom::create("a").unchecked_into();
    anchor.set_href(&address);
    anchor.set_download(name);
    anchor.click();
    dom::after(DOWNLOAD_MILLISECONDS, move || {
        let _ = Url::revoke_object_url(&address);
    });
    Ok(())
}

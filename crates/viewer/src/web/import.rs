//! Meshes from files: what suits a file is made of it, and the message that names it offers the other.

use super::page::Page;
use ductile_spec::{Document, ImportAs, ImportFormat, Request, SurfaceKind};

/// The newest import, as long as the other kind can be chosen for it.
#[derive(Debug)]
pub(crate) struct Imported {
    format: ImportFormat,
    bytes: Vec<u8>,
    /// Whether this import was taken back for one of the other kind, which may be refused.
    is_other: bool,
}

impl Page {
    /// Imports a file.
    pub(crate) fn import(&mut self, format: ImportFormat, bytes: Vec<u8>) {
        self.imported = Some(Imported { format, bytes: bytes.clone(), is_other: false });
        self.request(Request::Import { format, bytes, into: None });
    }

    /// An import is done: says what became of it and offers the other kind.
    pub(crate) fn import_came(&mut self, before: &Document) {
        let now = &self.document;
        let is_new = |id| before.kind_of(id).is_none();
        let made = now.meshes.keys().chain(now.cages.keys()).copied().find(|id| is_new(*id));
        let (text, command) = match made.and_then(|id| now.kind_of(id)) {
            Some(SurfaceKind::Mesh) => ("Imported as a mesh", ("As a cage", "import-cage")),
            _ => ("Imported as a cage", ("As a mesh", "import-mesh")),
        };
        if let Some(imported) = &mut self.imported {
            imported.is_other = false;
        }
        self.notices.toast(text, self.imported.is_some().then_some(command));
    }

    /// Takes the newest import back and makes the other kind of it.
    pub(crate) fn import_otherwise(&mut self, into: ImportAs) {
        let is_newest =
            self.committed.as_ref().and_then(|committed| committed.undo.as_deref()) == Some("Import");
        let Some(imported) = self.imported.as_mut().filter(|_| is_newest) else { return };
        imported.is_other = true;
        let again =
            Request::Import { format: imported.format, bytes: imported.bytes.clone(), into: Some(into) };
        self.request(Request::Undo);
        self.request(again);
    }

    /// An import was refused: what was taken back for it comes again.
    pub(crate) fn import_refused(&mut self) {
        if self.imported.take().is_some_and(|imported| imported.is_other) {
            self.request(Request::Redo);
        }
    }
}

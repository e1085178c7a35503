//! A sequence of requests on one document, with everything checked that each of them promises.
//!
//! An act is done or refused; a refused one changes nothing. What is done gives sound meshes, which follow their curves edge
//! by edge, of just the kinds that the act promises; its document means the same; undo and redo give
//! texts to the letter, also from before a modeler died. A drag is no act until it ends, and changes no topology.

use crate::Bench;
use crate::kinds::kinds;
use crate::promise::promise;
use ductile_modeler::{Model, ModelError};
use ductile_spec::{Document, Edit, PointId, Remembered, Reply, Request, Resume, from_text, to_compact_text};

/// A document and what was done to it.
#[derive(Debug)]
pub struct Round {
    /// The modeler.
    pub bench: Bench,
    /// The texts that undo goes back through, and which of them is now.
    texts: Vec<String>,
    now: usize,
    /// The model before the drag that is under way.
    held: Option<Box<Model>>,
}

impl Round {
    /// Begins with a document.
    #[must_use]
    pub fn new(document: &str) -> Self {
        let mut bench = Bench::new();
        bench.accept(Request::OpenText { text: document.to_owned() });
        let texts = vec![bench.document.clone()];
        for _ in 0..4 {
            bench.step(None);
        }
        Self { bench, texts, now: 0, held: None }
    }

    /// Asks for one thing and checks all that is promised. Gives why it was refused, if it was.
    ///
    /// # Panics
    /// When a promise is broken.
    pub fn ask(&mut self, request: &Request) -> Option<String> {
        let before = self.bench.modeler.model().clone();
        match request {
            Request::Step(_) => {
                self.bench.accept(request.clone());
                follows(&self.bench);
                None
            }
            Request::Edit(_) | Request::Import { .. } | Request::Undo | Request::Redo | Request::Grab(_)
                if self.held.is_some() =>
            {
                let reply = self.bench.send(request.clone());
                assert!(reply.refused.is_some(), "{request:?} in the middle of a drag");
                self.is_as(&before);
                reply.refused.map(|refusal| refusal.reason)
            }
            Request::Undo | Request::Redo => {
                let is_undo = matches!(request, Request::Undo);
                let there = if is_undo { self.now.checked_sub(1) } else { Some(self.now + 1) };
                let there = there.filter(|there| *there < self.texts.len());
                let reply = self.bench.send(request.clone());
                assert_eq!(reply.refused.is_none(), there.is_some(), "{request:?}: {:?}", reply.refused);
                self.now = there.unwrap_or(self.now);
                assert_eq!(self.bench.document, self.texts[self.now], "{request:?} to the letter");
                follows(&self.bench);
                reply.refused.map(|refusal| refusal.reason)
            }
            Request::Edit(edit) => self.act(edit),
            Request::Grab(_) => {
                let reply = self.bench.send(request.clone());
                match reply.refused {
                    None => self.held = Some(Box::new(before)),
                    Some(_) => self.is_as(&before),
                }
                follows(&self.bench);
                reply.refused.map(|refusal| refusal.reason)
            }
            Request::Drop | Request::Cancel => self.let_go(request),
            Request::Resume(_) => {
                self.resume();
                None
            }
            Request::Export(_)
            | Request::Describe
            | Request::Meet { .. }
            | Request::Reach { .. }
            | Request::Loop { .. }
            | Request::Seams => {
                let reply = self.bench.send(request.clone());
                self.is_as(&before);
                reply.refused.map(|refusal| refusal.reason)
            }
            Request::OpenText { .. }
            | Request::OpenLink { .. }
            | Request::OpenExample(_)
            | Request::Import { .. }
            | Request::New => self.open(request, &before),
        }
    }

    /// Another document in place of the one before.
    fn open(&mut self, request: &Request, before: &Model) -> Option<String> {
        let reply = self.bench.send(request.clone());
        match reply.refused {
            None => {
                self.held = None;
                self.commit();
            }
            Some(_) => self.is_as(before),
        }
        follows(&self.bench);
        reply.refused.map(|refusal| refusal.reason)
    }

    fn commit(&mut self) {
        self.texts.truncate(self.now + 1);
        self.texts.push(self.bench.document.clone());
        self.now += 1;
    }

    /// Nothing has changed.
    fn is_as(&self, before: &Model) {
        assert_eq!(self.bench.document, self.texts[self.now], "the committed document has changed");
        is_untouched(before, self.bench.modeler.model());
    }

    /// The end of a drag, either way.
    fn let_go(&mut self, how: &Request) -> Option<String> {
        let Reply { refused, committed, .. } = self.bench.send(how.clone());
        let Some(before) = self.held.take() else {
            assert!(refused.is_some(), "nothing was held");
            return refused.map(|refusal| refusal.reason);
        };
        follows(&self.bench);
        if committed.is_none() {
            self.is_as(&before);
            return refused.map(|refusal| refusal.reason);
        }
        assert!(matches!(how, Request::Drop), "put back is put back");
        assert_eq!(kinds(&before), kinds(self.bench.modeler.model()), "a drag changes no topology");
        self.means_the_same(Model::skins_of);
        self.commit();
        None
    }

    /// The modeler dies; another one goes on from what the page remembers.
    fn resume(&mut self) {
        self.held = None;
        let entry = |text: &String| Remembered { act: "Act".to_owned(), document: text.clone() };
        let (undo, rest) = self.texts.split_at(self.now);
        let document = rest[0].clone();
        let redo = rest[1..].iter().rev().map(entry).collect();
        let undo = undo.iter().map(entry).collect();
        self.bench.modeler = ductile_modeler::Modeler::new();
        self.bench.accept(Request::Resume(Resume { document, undo, redo }));
        assert_eq!(self.bench.document, self.texts[self.now], "resumed to the letter");
        follows(&self.bench);
    }

    fn act(&mut self, edit: &Edit) -> Option<String> {
        let before = self.bench.modeler.model().clone();
        let text = self.bench.document.clone();
        let met = match edit {
            Edit::Trim { first, second, .. } => {
                let (first, second) = (first.surface, second.surface);
                self.bench.send(Request::Meet { first, second }).meeting
            }
            _ => None,
        };
        let promised = promise(&before, edit, met.as_ref());
        let reply = self.bench.send(Request::Edit(edit.clone()));
        if let Some(refusal) = reply.refused {
            assert!(refusal.reason.len() > 10, "{refusal:?} says nothing");
            assert!(!refusal.reason.contains("no longer follows"), "{refusal:?} is our own fault");
            self.is_as(&before);
            return Some(refusal.reason);
        }
        let after = self.bench.document.clone();
        let model = self.bench.modeler.model();
        let mut found: Vec<_> = kinds(model).into_iter().map(|(_, kind)| kind).collect();
        found.sort_unstable();
        if let Some(all) = promised {
            assert!(all.contains(&found), "kinds {found:?}; promised was one of {all:?}");
        }
        follows(&self.bench);
        leaves_nothing_lying(&before, model, edit);
        self.means_the_same(Model::skins_of);
        self.bench.accept(Request::Undo);
        assert_eq!(self.bench.document, text, "undo to the letter");
        is_untouched(&before, self.bench.modeler.model());
        self.bench.accept(Request::Redo);
        assert_eq!(self.bench.document, after, "redo to the letter");
        self.commit();
        None
    }

    /// The document as it is now, grown as a modeler grows it that opens it, still means the same.
    ///
    /// # Panics
    /// When it does not.
    pub fn opens(&self) {
        self.means_the_same(Model::from_document);
    }

    /// The committed text comes round, and what is built of it has surfaces of the same kinds.
    fn means_the_same(&self, build: impl Fn(Document) -> Result<Model, ModelError>) {
        let text = &self.bench.document;
        let document = from_text(text).unwrap_or_else(|why| panic!("{why}: {text}"));
        assert_eq!(to_compact_text(&document), *text, "the text does not come round");
        match build(document) {
            Ok(again) => {
                let model = self.bench.modeler.model();
                assert_eq!(kinds(&again), kinds(model), "the document means another surface: {text}");
            }
            Err(why) => panic!("the document cannot be opened: {why}: {text}"),
        }
    }
}

/// The same document, on the same shapes.
fn is_untouched(before: &Model, after: &Model) {
    assert_eq!(before.document, after.document);
    assert!(before.surfaces.keys().eq(after.surfaces.keys()) && before.curves.keys().eq(after.curves.keys()));
    for (old, new) in before.surfaces.values().zip(after.surfaces.values()) {
        assert_eq!(old.positions, new.positions);
        assert_eq!(old.embeddings, new.embeddings);
        assert_eq!(old.pins, new.pins);
    }
    for (old, new) in before.curves.values().zip(after.curves.values()) {
        assert_eq!(old.nodes, new.nodes);
    }
}

/// Every surface follows its curves edge by edge and holds its control points, and is marked for nothing else.
fn follows(bench: &Bench) {
    let model = bench.modeler.model();
    for (id, curve) in &model.curves {
        let own: Vec<PointId> = curve.controls.iter().map(|(_, point)| *point).collect();
        assert_eq!(own, model.document.curves[id].through, "controls of {id}");
        assert!(curve.controls.windows(2).all(|pair| pair[0].0 < pair[1].0), "controls of {id} in order");
    }
    for (id, shape) in &model.surfaces {
        let (mut edges, mut points) = (0, 0);
        let mut tagged = vec![false; shape.mesh.vertex_slots()];
        let mut lined = tagged.clone();
        for embedded in &shape.embeddings {
            let curve = &model.curves[&embedded.curve];
            for vertex in &embedded.vertices {
                let is_second = std::mem::replace(&mut lined[vertex.index()], true);
                assert!(
                    !is_second || shape.mesh.is_source_vertex(*vertex),
                    "curves of {id} meet without a hub"
                );
            }
            for k in 0..curve.edge_count() {
                let (a, b) = curve.edge(k);
                let edge = shape.mesh.edge_between(embedded.vertices[a], embedded.vertices[b]);
                let tag = edge.and_then(|e| shape.mesh.edge_source(e)).map(|tag| tag.0);
                assert_eq!(tag, Some(embedded.curve.0), "edge {k} of {} in {id}", embedded.curve);
                edges += 1;
            }
            for (sample, point) in &curve.controls {
                let vertex = embedded.vertices[*sample as usize];
                let tag = shape.mesh.vertex_source(vertex).map(|tag| tag.0);
                assert_eq!(tag, Some(point.0), "a control of {} in {id}", embedded.curve);
                points += usize::from(!std::mem::replace(&mut tagged[vertex.index()], true));
            }
        }
        for pin in &shape.pins {
            let tag = shape.mesh.vertex_source(pin.vertex).map(|tag| tag.0);
            assert_eq!(tag, Some(pin.point.0), "a pin of {id}");
            points += usize::from(!std::mem::replace(&mut tagged[pin.vertex.index()], true));
        }
        assert_eq!(
            shape.mesh.edges().filter(|e| shape.mesh.is_source_edge(*e)).count(),
            edges,
            "lines of {id}"
        );
        let sources = shape.mesh.vertices().filter(|v| shape.mesh.is_source_vertex(*v)).count();
        assert_eq!(sources, points, "marked vertices of {id}");
        let document = &model.document.surfaces[id];
        let followed = |curve| shape.embeddings.iter().any(|e| e.curve == curve);
        assert!(document.ribbons.keys().all(|curve| followed(*curve)), "ribbons of {id}");
        assert!(document.regions.iter().all(|region| followed(region.curve)), "regions of {id}");
        assert_eq!(document.skeleton.curves.len(), shape.embeddings.len(), "curves of {id}'s skeleton");
    }
}

/// No act leaves points that nothing uses, unless it was to make one.
fn leaves_nothing_lying(before: &Model, after: &Model, edit: &Edit) {
    let unused = |model: &Model, point: PointId| {
        model.document.curves_through(point).next().is_none()
            && model.document.surfaces_through(point).next().is_none()
            && model.document.cages_on(point).next().is_none()
    };
    let is_meant = matches!(edit, Edit::Point { .. });
    for point in after.document.points.keys() {
        let was = before.document.points.contains_key(point) && unused(before, *point);
        assert!(is_meant || was || !unused(after, *point), "{point} is left lying");
    }
}

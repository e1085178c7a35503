//! The one door: requests go in, replies come out, the model stays whole.

mod displacing;
mod settling;

use crate::bank;
use crate::displaced::{Displacer, Footprints};
use crate::error::ModelError;
use crate::example::example;
use crate::frame::Frame;
use crate::grab::Grab;
use crate::history::{History, State};
use crate::model::{Making, Model};
use crate::operation;
use crate::patch;
use crate::pull::Pull;
use crate::relax::Relaxer;
use crate::seams;
use crate::settle::Settling;
use crate::skeleton::renew;
use ductile_mesh::Mesh;
use ductile_mesh::io::obj;
use ductile_spec::{
    Committed, Document, Edit, ExportFormat, Exported, FoundLoop, FrameHeader, GrabTarget, Grabbed, Meeting,
    Pulled, Reach, Refusal, Reply, Request, Resume, Seams, Step, SurfaceId, from_fragment, from_text,
    to_compact_text,
};

/// The modeler behind the page, the command line and the tests.
///
/// ```
/// use ductile_modeler::Modeler;
/// use ductile_spec::{Example, Request, Step};
///
/// let mut modeler = Modeler::new();
/// modeler.handle(Request::OpenExample(Example::Disc));
/// while !modeler.handle(Request::Step(Step { drag: None, iterations: 20 })).frame.settled {}
/// assert!(modeler.model().surfaces.len() == 1);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Modeler {
    model: Model,
    history: History,
    relaxer: Relaxer,
    displacer: Displacer,
    grab: Option<Grab>,
    pull: Option<Pull>,
    /// Where feet stood when the drag under way began.
    footprints: Footprints,
    settling: Settling,
    /// How often a shape was kept that its document does not open to.
    kept: u32,
    frame: Frame,
    describe: bool,
}

/// What a request leads to beside a new frame.
#[derive(Default)]
struct Outcome {
    committed: Option<String>,
    grabbed: Option<Grabbed>,
    pulled: Option<Pulled>,
    exported: Option<Exported>,
    meeting: Option<Meeting>,
    reach: Option<Reach>,
    found: Option<FoundLoop>,
    seams: Option<Seams>,
}

impl Modeler {
    /// A modeler with an empty document.
    #[must_use]
    pub fn new() -> Self {
        Self { describe: true, ..Self::default() }
    }

    /// The model as it is now.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The numbers of the newest frame, laid out as `ductile_spec::Structure` says.
    #[must_use]
    pub fn floats(&self) -> &[f32] {
        &self.frame.floats
    }

    /// The triangles of the newest frame.
    #[must_use]
    pub fn indices(&self) -> &[u32] {
        &self.frame.indices
    }

    /// The relaxation: energies and solver figures.
    #[must_use]
    pub fn relaxer(&self) -> &Relaxer {
        &self.relaxer
    }

    /// Does what is asked, or refuses and leaves the model as it was; either way answers with the newest frame.
    pub fn handle(&mut self, request: Request) -> Reply {
        let act = label(&request);
        let mut reply = Reply::default();
        let mended = operation::mended(&request);
        match self.serve(request) {
            Ok(outcome) => {
                reply.committed = outcome.committed.map(|act| self.committed(act));
                reply.grabbed = outcome.grabbed;
                reply.pulled = outcome.pulled;
                reply.exported = outcome.exported;
                reply.meeting = outcome.meeting;
                reply.reach = outcome.reach;
                (reply.found, reply.seams) = (outcome.found, outcome.seams);
            }
            Err(error) => {
                let error = error.of_kind(&self.model.document, act);
                let remedy = mended.filter(|_| error.can_be_mended());
                reply.refused = Some(Refusal { act: act.to_owned(), reason: error.to_string(), remedy });
            }
        }
        self.relaxer.bind(&self.model);
        patch::follow(&mut self.model, Some(&self.relaxer));
        let settled = self.is_settled();
        let is_at_rest = settled && !self.is_holding();
        self.displacer.refresh(&self.model, &self.relaxer, is_at_rest);
        let changed = self.frame.write(&self.model, &self.relaxer, &self.displacer);
        if changed || self.describe {
            reply.structure = Some(self.frame.structure.clone());
            self.describe = false;
        }
        reply.frame = FrameHeader {
            topology_version: self.frame.structure.version,
            settled,
            held: self.grab.as_ref().map(|grab| grab.point),
            figures: self.relaxer.figures(&self.model),
        };
        reply
    }

    fn serve(&mut self, request: Request) -> Result<Outcome, ModelError> {
        self.make_way(&request);
        match request {
            Request::OpenText { text } => self.open("Open", from_text(&text)?),
            Request::OpenLink { link } => self.open("Open link", from_fragment(&link)?),
            Request::Import { format, bytes, into } => self.whole("Import", |modeler, _| {
                operation::import(&mut modeler.model, (format, &bytes), into).map(|()| false)
            }),
            Request::OpenExample(kind) => self.open(kind.title(), example(kind)),
            Request::New => self.open("New", Document::default()),
            Request::Resume(resume) => self.resume(&resume),
            Request::Edit(edit) => self.edit(&edit),
            Request::Grab(target) => self.take_hold(target),
            Request::Step(step) => {
                self.step(step);
                Ok(Outcome::default())
            }
            Request::Drop => self.let_go(),
            Request::Cancel => self.put_back(),
            Request::Undo => self.undo(),
            Request::Redo => self.redo(),
            Request::Export(format) => self.export(format),
            Request::Meet { first, second } => {
                let lines = operation::meeting(&self.model, first, second)?;
                Ok(Outcome { meeting: Some(Meeting { first, second, lines }), ..Outcome::default() })
            }
            Request::Reach(trial) => {
                let reach = self.displacer.reach((&self.model, &self.relaxer), &trial)?;
                Ok(Outcome { reach: Some(reach), ..Outcome::default() })
            }
            Request::Loop { curve, at, sheet } => {
                let found = operation::found_loop(&self.model, curve, at, sheet);
                Ok(Outcome { found: Some(found), ..Outcome::default() })
            }
            Request::Seams => {
                let seams = seams::seams(&self.model, &self.relaxer);
                Ok(Outcome { seams: Some(seams), ..Outcome::default() })
            }
            Request::Describe => {
                self.describe = true;
                Ok(Outcome { committed: Some(String::new()), ..Outcome::default() })
            }
        }
    }

    /// Replaces the model; the one before can be had back by undo.
    fn open(&mut self, act: &str, document: Document) -> Result<Outcome, ModelError> {
        let mut fresh = Model::from_document(document)?;
        // A drag under way was never committed: undo leads to where it began.
        if let Some(grab) = self.grab.take() {
            self.restore(grab.before);
        }
        if let Some(pull) = self.pull.take() {
            self.restore(pull.before);
        }
        self.displacer.forget();
        fresh.continue_revisions(&self.model);
        fresh.renew_revisions();
        let before = core::mem::replace(&mut self.model, fresh);
        self.record(act, before);
        self.relaxer = self.relaxer.anew();
        Ok(Outcome { committed: Some(act.to_owned()), ..Outcome::default() })
    }

    /// Goes on where another modeler stopped, with its history in place of this one's own.
    fn resume(&mut self, resume: &Resume) -> Result<Outcome, ModelError> {
        let mut fresh = Model::from_document(from_text(&resume.document)?)?;
        (self.grab, self.pull) = (None, None);
        self.displacer.forget();
        fresh.continue_revisions(&self.model);
        fresh.renew_revisions();
        self.model = fresh;
        self.history = History::remembered(&resume.undo, &resume.redo);
        self.relaxer = self.relaxer.anew();
        Ok(Outcome { committed: Some("Resume".to_owned()), ..Outcome::default() })
    }

    fn record(&mut self, act: &str, before: Model) {
        // The empty document that every modeler begins with is nobody's work.
        let is_first = self.history.next_undo().is_none() && *before.document == Document::default();
        if !is_first {
            self.history.record(act, before);
        }
    }

    fn edit(&mut self, edit: &Edit) -> Result<Outcome, ModelError> {
        self.whole(edit.label(), |modeler, before| {
            modeler.act(edit, before)?;
            let is_move = matches!(edit, Edit::Move { .. } | Edit::Shift { .. });
            Ok(is_move && renew(&before.document, &mut modeler.model))
        })
    }

    /// Does something whole, as a step of undo, or leaves the model as it was. What is done tells whether skeletons were taken anew though it
    /// only moved controls.
    fn whole(
        &mut self,
        name: &str,
        act: impl FnOnce(&mut Self, &Model) -> Result<bool, ModelError>,
    ) -> Result<Outcome, ModelError> {
        if self.is_holding() {
            return Err(ModelError::Dragging);
        }
        let before = self.model.clone();
        match act(self, &before) {
            Ok(is_renewed) => {
                // What lies over the shapes gives them no reason to move.
                if !displacing::is_over_shapes(&before.document, &self.model.document) {
                    self.model.making = settling::worked(&before, &self.model, is_renewed);
                    self.model.rests = false;
                    self.relaxer.wake();
                }
                self.history.record(name, before);
                Ok(Outcome { committed: Some(name.to_owned()), ..Outcome::default() })
            }
            Err(error) => {
                self.restore(before);
                Err(error)
            }
        }
    }

    fn take_hold(&mut self, target: GrabTarget) -> Result<Outcome, ModelError> {
        if self.is_holding() {
            return Err(ModelError::Dragging);
        }
        if let Some(outcome) = self.pull(target) {
            return outcome;
        }
        let before = self.model.clone();
        let target = self.displacer.target_on_base(target);
        match Grab::begin(&mut self.model, &self.relaxer, target) {
            Ok(grab) => {
                let at = grab.hand(&self.model);
                let grabbed = Grabbed { point: grab.point, at };
                // What rests goes on resting until the hand moves, which it soon will.
                if grab.is_new || !self.relaxer.is_at_rest() {
                    self.relaxer.wake();
                } else {
                    self.relaxer.attend(&self.model, &grab.points());
                }
                self.grab = Some(grab);
                self.footprints = self.displacer.footprints();
                self.model.making = Making::Worked;
                self.model.rests = false;
                Ok(Outcome { grabbed: Some(grabbed), ..Outcome::default() })
            }
            Err(error) => {
                self.restore(before);
                Err(error)
            }
        }
    }

    fn step(&mut self, step: Step) {
        if self.settle() {
            return;
        }
        if let Some(to) = step.drag {
            self.pull_to(to);
        }
        if let (Some(grab), Some(to)) = (self.grab.as_mut(), step.drag) {
            let has_moved = grab.has_moved;
            match grab.follow(&mut self.model, to) {
                Some(moved) => {
                    if !has_moved && grab.has_moved {
                        self.relaxer.wake();
                    }
                    self.relaxer.hand_moved(moved);
                }
                None => self.relaxer.count_rescue(),
            }
        }
        // What goes on from an exact surface needs it where its controls are now.
        patch::follow(&mut self.model, Some(&self.relaxer));
        self.relaxer.step(&mut self.model, step.iterations);
        self.note_rest();
        if let Some(grab) = self.grab.as_mut()
            && self.relaxer.is_hand_slow()
            && grab.rescue(&mut self.model, self.relaxer.energy(), false)
        {
            self.relaxer.count_rescue();
            if grab.rests_at_home() {
                self.relaxer.rest(&self.model);
            } else {
                self.relaxer.wake();
            }
        }
    }

    fn let_go(&mut self) -> Result<Outcome, ModelError> {
        if let Some(pull) = self.pull.take() {
            return self.end_pull(pull);
        }
        let mut grab = self.grab.take().ok_or(ModelError::NothingHeld)?;
        let footprints = std::mem::take(&mut self.footprints);
        if !grab.has_moved {
            self.restore(grab.before);
            return Ok(Outcome::default());
        }
        match grab.finish(&mut self.model) {
            // Brought back to where it was: no act, and the shapes are those of before, not those of a long way round.
            Ok(_) if self.model.document == grab.before.document => {
                self.restore(grab.before);
                Ok(Outcome::default())
            }
            Ok(act) => {
                if grab.rescue(&mut self.model, self.relaxer.energy(), true) {
                    self.relaxer.count_rescue();
                }
                self.carry_feet(&footprints)?;
                let is_renewed = renew(&grab.before.document, &mut self.model);
                self.model.making = settling::worked(&grab.before, &self.model, is_renewed);
                self.history.record(act, grab.before);
                self.relaxer.wake();
                Ok(Outcome { committed: Some(act.to_owned()), ..Outcome::default() })
            }
            Err(error) => {
                self.restore(grab.before);
                Err(error)
            }
        }
    }

    fn put_back(&mut self) -> Result<Outcome, ModelError> {
        if let Some(pull) = self.pull.take() {
            self.restore(pull.before);
            return Ok(Outcome::default());
        }
        let grab = self.grab.take().ok_or(ModelError::NothingHeld)?;
        self.restore(grab.before);
        Ok(Outcome::default())
    }

    fn undo(&mut self) -> Result<Outcome, ModelError> {
        if self.is_holding() {
            return Err(ModelError::Dragging);
        }
        let state = self.history.before_last().ok_or(ModelError::NothingToUndo)?;
        let now = self.go_to(state)?;
        let act = self.history.undone(&now).ok_or(ModelError::NothingToUndo)?;
        Ok(Outcome { committed: Some(format!("Undo {act}")), ..Outcome::default() })
    }

    fn redo(&mut self) -> Result<Outcome, ModelError> {
        if self.is_holding() {
            return Err(ModelError::Dragging);
        }
        let state = self.history.after_next().ok_or(ModelError::NothingToRedo)?;
        let now = self.go_to(state)?;
        let act = self.history.redone(&now).ok_or(ModelError::NothingToRedo)?;
        Ok(Outcome { committed: Some(format!("Redo {act}")), ..Outcome::default() })
    }

    /// Goes to a state of the history, if it can be built. Returns the model that was left.
    fn go_to(&mut self, state: State) -> Result<Model, ModelError> {
        let now = self.model.clone();
        match state {
            State::Whole(model) => self.restore(model),
            State::Document(document) => {
                let mut model = Model::from_document((*document).clone())?;
                model.continue_revisions(&self.model);
                model.renew_revisions();
                self.model = model;
                self.relaxer = self.relaxer.anew();
            }
        }
        Ok(now)
    }

    fn restore(&mut self, mut model: Model) {
        model.continue_revisions(&self.model);
        self.model = model;
        self.relaxer.wake();
        // The solvers that brought them here have seen other shapes since.
        if self.model.making == Making::Opened {
            self.model.making = Making::Worked;
        }
        // What rested like this rests: relaxed once more, it would end a little beside itself.
        if self.model.rests || self.model.making == Making::Own {
            self.relaxer.rest(&self.model);
        }
    }

    fn export(&self, format: ExportFormat) -> Result<Outcome, ModelError> {
        let ExportFormat::Obj = format;
        if self.model.surfaces.is_empty() && self.model.patches.is_empty() {
            return Err(ModelError::NothingToExport);
        }
        let (mut positions, mut normals, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
        for (id, shape) in &self.model.surfaces {
            let Some(bound) = self.relaxer.surface(*id, shape) else { continue };
            let first = u32::try_from(positions.len()).unwrap_or(u32::MAX);
            let shown = self.displacer.get(*id).map_or(bound.triangles(), |overlay| overlay.triangles());
            triangles.extend(shown.iter().map(|t| t.map(|v| v + first)));
            if let Some((at, upright)) = self.displacer.vertices(*id) {
                positions.extend_from_slice(at);
                normals.extend_from_slice(upright);
                continue;
            }
            positions.extend(bound.vertices().iter().map(|v| shape.positions[v.index()]));
            normals.extend_from_slice(&bank::shown(&self.model, bound, shape));
        }
        for (id, shape) in &self.model.patches {
            let first = u32::try_from(positions.len()).unwrap_or(u32::MAX);
            let overlay = self.displacer.get(*id);
            positions.extend_from_slice(overlay.map_or(shape.positions(), |overlay| overlay.positions()));
            normals.extend_from_slice(overlay.map_or(shape.normals(), |overlay| overlay.normals()));
            let shown = overlay.map_or(shape.triangles(), |overlay| overlay.triangles());
            triangles.extend(shown.iter().map(|t| t.map(|v| v + first)));
        }
        let mesh = Mesh::from_triangles(positions.len(), &triangles)
            .map_err(|reason| ModelError::NotASurface { surface: SurfaceId(0), reason })?;
        let text = format!("# A fair surface by Ductile\n{}", obj::write(&mesh, &positions, Some(&normals)));
        let name = if self.model.document.name.is_empty() { "ductile" } else { &self.model.document.name };
        Ok(Outcome { exported: Some(Exported { name: format!("{name}.obj"), text }), ..Outcome::default() })
    }

    fn committed(&self, act: String) -> Committed {
        // Asked for in the middle of a drag, the document is the one before it: a drag is no act until it ends.
        let held = self.grab.as_ref().map(|grab| &grab.before);
        let held = held.or(self.pull.as_ref().map(|pull| &pull.before));
        let document = &held.unwrap_or(&self.model).document;
        Committed {
            act,
            document: to_compact_text(document),
            name: document.name.clone(),
            undo: self.history.next_undo().map(str::to_owned),
            redo: self.history.next_redo().map(str::to_owned),
        }
    }
}

/// What a request is called when it is refused.
fn label(request: &Request) -> &'static str {
    match request {
        Request::OpenText { .. } => "Open",
        Request::OpenLink { .. } => "Open link",
        Request::Import { .. } => "Import",
        Request::OpenExample(kind) => kind.title(),
        Request::New => "New",
        Request::Resume(_) => "Resume",
        Request::Edit(edit) => edit.label(),
        Request::Grab(_) | Request::Drop | Request::Cancel => "Drag",
        Request::Step(_) => "Step",
        Request::Undo => "Undo",
        Request::Redo => "Redo",
        Request::Export(_) => "Export",
        Request::Meet { .. } => "Meet",
        Request::Reach { .. } => "Reach",
        Request::Loop { sheet, .. } => {
            if *sheet {
                "Sheet"
            } else {
                "Fill"
            }
        }
        Request::Seams => "Seams",
        Request::Describe => "Describe",
    }
}

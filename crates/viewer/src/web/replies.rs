//! What the page does with the answers of the worker, and with its death.

use super::dom;
use super::gestures::MARGIN;
use super::page::Page;
use super::port::Answer;
use crate::schedule::Answered;
use crate::tool::{Selection, ToolKind};
use ductile_spec::{
    Committed, Example, FrameHeader, GrabTarget, Grabbed, Handle, Refusal, Request, from_text,
};
use js_sys::Float32Array;
use wasm_bindgen::JsValue;

impl Page {
    /// Starts the worker, or says why it cannot.
    pub(crate) fn start_worker(&mut self) {
        if let Err(why) = self.port.start() {
            self.worker_died(&why);
        }
    }

    /// The worker is gone: a new one goes on from the last committed document.
    pub(crate) fn worker_died(&mut self, why: &str) {
        self.port.stop();
        let resume = self.memory.resume();
        self.reopening = resume.is_some();
        let nothing_yet = resume.is_none();
        let lost = self.schedule.worker_died(resume);
        self.hand.forget();
        self.meetings.forget();
        self.reaching.forget();
        self.looping.forget();
        self.reporting.forget();
        self.describing = false;
        if nothing_yet && self.schedule.is_at_rest() {
            self.schedule.push(Request::OpenExample(Example::RaisedDisc));
        }
        web_sys::console::info_1(&JsValue::from_str(&format!("the solver stopped: {why}")));
        if self.restarts.allows(dom::now()) {
            self.restart_count += 1;
            let lost = match lost {
                Some(act) => format!("Only {act} was lost"),
                None => "Nothing was lost".to_owned(),
            };
            let text = format!("The solver stopped and was started again. {lost}.");
            self.notices.banner_for("worker", &text, 20_000);
            self.start_worker();
        } else {
            let text = format!(
                "The solver stopped again and again ({why}). Your document is kept: save it as a file, or try once more."
            );
            self.notices.banner("worker", &text, &[("Save file", "save"), ("Try again", "restart")]);
        }
        self.refresh();
    }

    /// The designer wants to try again.
    pub(crate) fn restart_worker(&mut self) {
        self.restarts.reset();
        self.notices.dismiss("worker");
        self.start_worker();
    }

    /// An answer came.
    pub(crate) fn answered(&mut self, answer: Answer) {
        let Answer { reply, floats, indices } = answer;
        let Some(answered) = self.schedule.answered(&reply, dom::now()) else { return };
        match answered {
            Answered::Meeting => self.meetings.came(reply.meeting),
            Answered::Reach => self.reaching.came(reply.reach),
            Answered::Loop => self.looping.came(reply.found),
            Answered::Seams => self.reporting.came(reply.seams),
            _ => {
                self.meetings.moved();
                self.reaching.moved();
                self.looping.moved();
                self.reporting.moved();
            }
        }
        let frame = reply.frame.clone();
        let was_settled = self.scene.header.settled;
        if let Some(structure) = reply.structure {
            let indices = indices.map_or_else(Vec::new, |indices| indices.to_vec());
            match self.scene.set_structure(structure, indices) {
                Ok(()) => self.structure_came(),
                Err(error) => self.frame_refused(&error.to_string()),
            }
        }
        if let Some(floats) = floats {
            self.frame_came(frame, floats);
        }
        if let Some(grabbed) = reply.grabbed {
            self.grabbed(grabbed);
        }
        if let Some(pulled) = reply.pulled {
            self.pulled(pulled);
        }
        // Not to be told is no refusal of anything yet.
        if let Some(refusal) = reply.refused.filter(|_| !answered.is_told()) {
            self.refused(&answered, &refusal);
        }
        if let Some(committed) = reply.committed {
            self.committed(&answered, committed);
        }
        if let Some(file) = reply.exported {
            self.export_came(&file.name, &file.text);
        }
        if answered == Answered::Opening && self.openings > 0 && self.scene.has_frame() {
            self.fit_new_model();
        }
        if self.scene.header.settled != was_settled || answered != Answered::Step {
            self.refresh();
        } else {
            self.refresh_figures();
        }
    }

    fn structure_came(&mut self) {
        self.selection = self.selection.still_in(&self.scene.structure);
        self.stage.structure_is_new = true;
        self.hand.hover_is_stale = true;
    }

    fn frame_came(&mut self, header: FrameHeader, floats: Float32Array) {
        self.stage.floats.resize(floats.length() as usize, 0.0);
        floats.copy_to(&mut self.stage.floats);
        self.port.hand_back(floats);
        match self.scene.set_frame(header, &self.stage.floats) {
            Ok(()) => {
                self.describing = false;
                self.stage.frame_is_new = true;
                self.hand.hover_is_stale = true;
                self.tools.refresh(&self.scene);
                if self.scene.header.settled {
                    self.refit_legend();
                }
                if let Some((centre, radius)) = self.scene.bounds() {
                    self.camera.set_extent(centre, radius);
                }
                self.redraw();
            }
            Err(error) => self.frame_refused(&error.to_string()),
        }
    }

    /// A frame that contradicts itself is not believed; the model is asked for anew, once.
    fn frame_refused(&mut self, why: &str) {
        web_sys::console::warn_1(&JsValue::from_str(&format!("a frame was refused: {why}")));
        if !self.describing {
            self.describing = true;
            self.schedule.push(Request::Describe);
        }
    }

    fn grabbed(&mut self, grabbed: Grabbed) {
        self.selection = match self.hand.drag.map(|drag| drag.target()) {
            Some(GrabTarget::Edge { surface, ends, .. }) => Selection::Edge { surface, ends },
            Some(GrabTarget::Face { surface, face, .. }) => Selection::Face { surface, face },
            // The other handles of the curve stay in sight.
            Some(GrabTarget::Handle(Handle::Ribbon { curve, .. })) => Selection::Curve(curve),
            _ => Selection::Point(grabbed.point),
        };
        if let Some(drag) = &mut self.hand.drag {
            drag.set_origin(grabbed.at);
            self.follow_cursor();
        }
    }

    fn refused(&mut self, answered: &Answered, refusal: &Refusal) {
        if *answered == Answered::Grab {
            self.schedule.forget_drag();
            self.hand.forget();
        }
        if *answered == Answered::Opening {
            self.resetting = false;
            self.reopening = false;
            let mut text = sentence(&refusal.reason);
            if self.committed.is_some() {
                text.push_str(" The model on the screen is as it was.");
            }
            self.notices.banner("opening", &text, &[]);
            if self.committed.is_none() {
                // Nothing is on the screen yet: a refused link must not leave the page empty.
                self.open_fallback();
            }
            return;
        }
        let text = format!("{}: {}", refusal.act, refusal.reason);
        if refusal.act == "Import" {
            self.import_refused();
        }
        match &refusal.remedy {
            Some(remedy) => self.offer_remedy(&text, remedy.clone()),
            None => self.notices.refusal(&text),
        }
    }

    fn committed(&mut self, answered: &Answered, committed: Committed) {
        let before = match from_text(&committed.document) {
            Ok(document) => {
                self.selection = self.selection.still_meant(&self.document, &document);
                std::mem::replace(&mut self.document, document)
            }
            Err(_) => self.document.clone(),
        };
        let act = committed.act.clone();
        let text = committed.document.clone();
        let has_undo = committed.undo.is_some();
        let is_back = *answered == Answered::Opening && std::mem::take(&mut self.reopening);
        if !is_back {
            // Brought back, it is as it was, and so is what is remembered of it.
            self.memory.committed(&committed);
        }
        self.committed = Some(committed);
        self.keep(&text);
        if is_back {
            return;
        }
        if *answered == Answered::Opening {
            if !std::mem::take(&mut self.resetting) {
                self.opened = Some(text);
                self.openings += 1;
                self.selection = Selection::None;
                self.tools.choose(ToolKind::Shape);
                // Lengths of one model mean nothing in another.
                let options = self.tools.options_mut();
                (options.radius, options.size, options.distance) = (None, None, None);
                self.fit_legend();
                if !std::mem::take(&mut self.falling_back) {
                    self.notices.dismiss("opening");
                }
                self.fit_is_due = true;
                return;
            }
            self.notices.toast("Reset", Some(("Undo", "undo")));
            return;
        }
        self.leave_address();
        if act == "Fill" {
            self.tools.filled();
        }
        if act == "Import" {
            self.import_came(&before);
            return;
        }
        let undoes = act.starts_with("Undo");
        let button = if undoes { Some(("Redo", "redo")) } else { Some(("Undo", "undo")) };
        self.notices.toast(&act, button.filter(|_| undoes || has_undo));
    }

    /// Brings a newly opened model into view: at once the first time, in flight later.
    fn fit_new_model(&mut self) {
        if !std::mem::take(&mut self.fit_is_due) {
            return;
        }
        let Some((centre, radius)) = self.scene.bounds() else { return };
        if self.openings <= 1 {
            self.camera.fit(centre, MARGIN * radius);
        } else {
            let pose = self.camera.pose_that_fits(centre, MARGIN * radius);
            self.fly_to(pose);
        }
    }
}

/// The text with a capital at its beginning and a stop at its end.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    let stop = if text.ends_with(['.', '!', '?']) { "" } else { "." };
    format!("{first}{}{stop}", letters.as_str())
}

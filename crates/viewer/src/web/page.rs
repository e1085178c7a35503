//! The state of the page and its one entrance.

use super::dom;
use super::gestures::Hand;
use super::import::Imported;
use super::journal::Journal;
use super::keys::KeyList;
use super::legend::{self, Legend};
use super::notice::Notices;
use super::panel::Panel;
use super::port::Port;
use super::settings::Settings;
use super::stage::Stage;
use super::{
    cage, canvas, commands, density, displace, fields, files, fill, inspect, keyboard, keys, lean, link,
    objectives, opening, ribbon, seams, stage,
};
use crate::limit::Limit;
use crate::memory::Memory;
use crate::schedule::Schedule;
use crate::tool::{Selection, Toolbox};
use crate::{Camera, Looping, Meetings, Reaching, Reporting, Rims, Scene, StripCourse};
use ductile_spec::{Committed, Document, Edit, Request, SurfaceId};
use glam::Vec3;
use std::cell::RefCell;
use std::collections::VecDeque;
use wasm_bindgen::JsValue;

/// How often a worker or a graphics device is made anew within a minute before the page stops trying.
pub(crate) const MOST_RETRIES: usize = 3;
pub(crate) const RETRY_MILLISECONDS: f64 = 60_000.0;

type Deed = Box<dyn FnOnce(&mut Page)>;

thread_local! {
    static PAGE: RefCell<Option<Page>> = const { RefCell::new(None) };
    static WAITING: RefCell<VecDeque<Deed>> = const { RefCell::new(VecDeque::new()) };
}

/// Everything the page knows.
#[derive(Debug)]
pub(crate) struct Page {
    pub(crate) scene: Scene,
    pub(crate) camera: Camera,
    pub(crate) settings: Settings,
    pub(crate) keys: KeyList,
    pub(crate) tools: Toolbox,
    pub(crate) selection: Selection,
    /// Which surface was clicked last, and where: the place names a region of it.
    pub(crate) picked: Option<(SurfaceId, Vec3)>,
    /// The surface under or beside the last click: of those that follow a curve, the one that is meant.
    pub(crate) meant: Option<SurfaceId>,
    pub(crate) hand: Hand,
    /// The rims of the newest structure for which a tool wanted them.
    pub(crate) rims: Rims,
    /// Where the surfaces meet that a tool points at.
    pub(crate) meetings: Meetings,
    /// How far a displacement would reach.
    pub(crate) reaching: Reaching,
    /// The newest import, while it can be made a surface of the other kind.
    pub(crate) imported: Option<Imported>,
    /// The loop that a fill would take.
    pub(crate) looping: Looping,
    /// How well surfaces meet.
    pub(crate) reporting: Reporting,
    /// The seam of the report that is pointed at.
    pub(crate) seam_over: Option<usize>,
    /// The side of the selected fill that is pointed at in its list.
    pub(crate) side_over: Option<usize>,
    /// Where the tangent strips run that are shown.
    pub(crate) strips: Vec<StripCourse>,
    /// What would do nearly what was refused.
    pub(crate) remedies: Vec<Edit>,
    /// What the list of seams was made from.
    pub(crate) seams_shown: String,
    /// The displacement that is chosen, by surface and number.
    pub(crate) chosen_foot: Option<(SurfaceId, usize)>,
    pub(crate) schedule: Schedule,
    pub(crate) port: Port,
    pub(crate) restarts: Limit,
    pub(crate) restart_count: u32,
    pub(crate) stage: Stage,
    pub(crate) journal: Journal,
    pub(crate) notices: Notices,
    pub(crate) panel: Panel,
    pub(crate) legend: Legend,
    /// The document after the last act.
    pub(crate) committed: Option<Committed>,
    /// The same, read; what the link and the file are made of.
    pub(crate) document: Document,
    /// The acts up to there, for a worker that must begin anew.
    pub(crate) memory: Memory,
    /// The text that Reset goes back to.
    pub(crate) opened: Option<String>,
    /// How many documents were opened by the designer, not after a crash.
    pub(crate) openings: u32,
    /// The next opening only brings back what was on the screen.
    pub(crate) reopening: bool,
    /// The next opening goes back to the document as opened.
    pub(crate) resetting: bool,
    /// A newly opened model waits to be brought into view.
    pub(crate) fit_is_due: bool,
    /// How often something else had to be opened in place of what was asked for.
    pub(crate) fallbacks: u32,
    /// What opens next is not what was asked for, so the banner that says so stays.
    pub(crate) falling_back: bool,
    /// A frame did not fit and the model was asked for anew.
    pub(crate) describing: bool,
}

/// Does something with the page: at once, or, inside of another deed, right after it.
pub(crate) fn act(deed: impl FnOnce(&mut Page) + 'static) {
    WAITING.with_borrow_mut(|waiting| waiting.push_back(Box::new(deed)));
    PAGE.with(|page| {
        // Who holds the page at the moment empties the queue before letting go.
        let Ok(mut page) = page.try_borrow_mut() else { return };
        let Some(page) = page.as_mut() else { return };
        while let Some(deed) = WAITING.with_borrow_mut(VecDeque::pop_front) {
            deed(page);
            page.send_what_is_due();
        }
    });
}

/// Reads something off the page; `None` while a deed is under way or before the start.
pub(crate) fn look<T>(question: impl FnOnce(&Page) -> T) -> Option<T> {
    PAGE.with(|page| page.try_borrow().ok().and_then(|page| page.as_ref().map(question)))
}

/// Starts the page.
pub(crate) fn start() {
    console_error_panic_hook::set_once();
    let page = Page {
        scene: Scene::default(),
        camera: Camera::default(),
        settings: Settings::load(),
        keys: KeyList::load(),
        tools: Toolbox::default(),
        selection: Selection::None,
        picked: None,
        meant: None,
        hand: Hand::default(),
        rims: Rims::default(),
        meetings: Meetings::default(),
        reaching: Reaching::default(),
        imported: None,
        looping: Looping::default(),
        reporting: Reporting::default(),
        seam_over: None,
        side_over: None,
        strips: Vec::new(),
        remedies: Vec::new(),
        seams_shown: String::new(),
        chosen_foot: None,
        schedule: Schedule::default(),
        port: Port::default(),
        restarts: Limit::new(MOST_RETRIES, RETRY_MILLISECONDS),
        restart_count: 0,
        stage: Stage::new(),
        journal: Journal::open(),
        notices: Notices::default(),
        panel: Panel::new(),
        legend: Legend::default(),
        committed: None,
        memory: Memory::default(),
        document: Document::default(),
        opened: None,
        openings: 0,
        reopening: false,
        resetting: false,
        fit_is_due: false,
        fallbacks: 0,
        falling_back: false,
        describing: false,
    };
    PAGE.with_borrow_mut(|slot| *slot = Some(page));
    listen();
    act(|page| {
        page.apply_settings();
        page.refresh();
        page.start_worker();
        page.start_stage();
    });
    opening::begin();
    watch();
}

/// Listens to everything that the designer can do, and lets others look in.
fn listen() {
    commands::listen();
    keyboard::listen();
    canvas::listen();
    fields::listen();
    objectives::listen();
    density::listen();
    cage::listen();
    displace::listen();
    fill::listen();
    lean::listen();
    seams::listen();
    legend::listen();
    keys::listen();
    ribbon::listen();
    files::listen();
    link::listen();
    stage::listen();
    inspect::expose();
}

/// Looks after the worker: one that hangs is replaced. Time in the background does not count.
fn watch() {
    dom::every(2000, || {
        if dom::document().hidden() {
            return;
        }
        act(|page| {
            let now = dom::now();
            if page.schedule.is_overdue(now) || page.port.is_late(now) {
                page.worker_died("it no longer answered");
            }
        });
    });
    dom::listen(&dom::document(), "visibilitychange", |_: JsValue| {
        act(|page| {
            page.schedule.wait_anew(dom::now());
            page.port.wait_anew(dom::now());
            page.redraw();
        });
    });
}

impl Page {
    /// Asks the modeler for something.
    pub(crate) fn request(&mut self, request: Request) {
        self.schedule.push(request);
        self.refresh();
    }

    fn send_what_is_due(&mut self) {
        if !self.port.is_ready() {
            return;
        }
        if let Some(request) = self.schedule.next(dom::now())
            && let Err(why) = self.port.send(&request)
        {
            self.worker_died(&why);
        }
    }
}

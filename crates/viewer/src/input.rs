//! From pointers to gestures: mouse, pen and fingers by the conventions that most modelers share.
//!
//! One pointer acts (a left press on something holds it, on nothing orbits), right drag and Alt+left drag
//! orbit, middle and Shift+right drag pan, the wheel zooms. Two fingers pan and zoom; two down and one
//! lifted orbits; a tap of two undoes, of three does again. Positions are CSS pixels from the upper left
//! corner of the canvas, times are milliseconds. Whatever a browser leaves out (a lost capture, a missing
//! release) or makes up (coordinates that are no numbers) ends a gesture and never hangs it.

use glam::Vec2;

#[cfg(test)]
mod tests;

/// How far a press may wander and still be a click: a hand on a mouse, a fingertip on glass.
const SLOP: f32 = 4.0;
const FINGER_SLOP: f32 = 10.0;
/// Two clicks within this time are a double click.
const DOUBLE_MILLISECONDS: f64 = 380.0;
/// Fingers that come and go within this time are a tap.
const TAP_MILLISECONDS: f64 = 320.0;
/// Zoom per wheel pixel (a notch of a mouse wheel is about 100) and per pinch pixel of a trackpad.
const WHEEL_ZOOM: f32 = 0.001_6;
const PINCH_ZOOM: f32 = 0.01;

/// What points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Device {
    /// A mouse or trackpad.
    Mouse,
    /// A pen.
    Pen,
    /// A finger.
    Touch,
}

/// Which button of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// The left one, the tip of a pen, a finger.
    Primary,
    /// The wheel.
    Middle,
    /// The right one, the button of a pen.
    Secondary,
}

/// Which keys are held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Modifiers {
    /// Shift.
    pub shift: bool,
    /// Ctrl, or Command.
    pub ctrl: bool,
    /// Alt, or Option.
    pub alt: bool,
}

/// A pointer at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointer {
    /// Which one.
    pub id: i32,
    /// What it is.
    pub device: Device,
    /// Where it is.
    pub at: Vec2,
    /// The keys held with it.
    pub modifiers: Modifiers,
    /// When.
    pub time: f64,
}

/// What a hand means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gesture {
    /// Points without pressing.
    Hover(Vec2),
    /// Pressed and let go at one place.
    Click {
        /// Where.
        at: Vec2,
        /// With which keys.
        modifiers: Modifiers,
    },
    /// A second click soon after the first; the first came as a [`Gesture::Click`].
    DoubleClick {
        /// Where.
        at: Vec2,
    },
    /// Begins to drag what was pressed on.
    Grab {
        /// Where the press was.
        at: Vec2,
    },
    /// Goes on dragging.
    Drag {
        /// Where to.
        at: Vec2,
        /// With which keys.
        modifiers: Modifiers,
    },
    /// Lets go of what was dragged.
    Drop,
    /// Something came between: everything back to where it was.
    Abandon,
    /// Begins to turn the view about what lies there.
    OrbitFrom(Vec2),
    /// Turns the view by so many pixels.
    Orbit(Vec2),
    /// Shifts the view by so many pixels.
    Pan {
        /// By how much.
        by: Vec2,
        /// Where the hand is now.
        at: Vec2,
    },
    /// Comes nearer by a factor, towards a place.
    Zoom {
        /// The place that stays where it is.
        at: Vec2,
        /// Above 1 comes nearer.
        factor: f32,
    },
    /// Takes back the last act.
    Undo,
    /// Does it again.
    Redo,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Verb {
    Orbit,
    Pan,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    Idle,
    /// A primary press that has not moved yet, or that drags.
    Press {
        id: i32,
        device: Device,
        from: Vec2,
        holds: bool,
        drags: bool,
    },
    /// Turns or shifts the view.
    Eye {
        id: i32,
        verb: Verb,
        at: Vec2,
        begun: bool,
        slop: f32,
    },
    /// Two or more fingers.
    Fingers {
        since: f64,
        most: usize,
        moved: bool,
    },
    /// What is still pressed means nothing any more.
    Spent,
}

#[derive(Clone, Copy, Debug)]
struct Finger {
    id: i32,
    from: Vec2,
    at: Vec2,
}

/// Tells gestures apart.
#[derive(Debug)]
pub struct Recogniser {
    state: State,
    fingers: Vec<Finger>,
    last_click: Option<(Vec2, f64, Device)>,
}

impl Default for Recogniser {
    fn default() -> Self {
        Self { state: State::Idle, fingers: Vec::new(), last_click: None }
    }
}

impl Recogniser {
    /// Whether a press or a gesture is under way.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.state != State::Idle
    }

    /// A button or finger goes down. `holds` says whether a drag from here takes hold of something;
    /// without it a drag turns the view.
    pub fn down(&mut self, pointer: Pointer, button: Button, holds: bool) -> Vec<Gesture> {
        if !pointer.at.is_finite() {
            return Vec::new();
        }
        if pointer.device == Device::Touch {
            return self.finger_down(pointer, holds);
        }
        let out = self.abandon_drag();
        let Modifiers { shift, alt, .. } = pointer.modifiers;
        let eye = |verb| State::Eye { id: pointer.id, verb, at: pointer.at, begun: false, slop: 1.0 };
        self.state = match button {
            Button::Primary if alt => eye(Verb::Orbit),
            Button::Primary => Self::press(&pointer, holds),
            Button::Middle => eye(Verb::Pan),
            Button::Secondary => eye(if shift { Verb::Pan } else { Verb::Orbit }),
        };
        out
    }

    /// A pointer moves. `pressed` says whether any of its buttons is down.
    pub fn moved(&mut self, pointer: Pointer, pressed: bool) -> Vec<Gesture> {
        if !pointer.at.is_finite() {
            return Vec::new();
        }
        if let Some(index) = self.fingers.iter().position(|finger| finger.id == pointer.id) {
            if let State::Fingers { .. } = self.state {
                return self.fingers_moved(index, pointer.at);
            }
            self.fingers[index].at = pointer.at;
        }
        if !pressed && pointer.device != Device::Touch {
            // The release happened where the page could not see it.
            let mut out = self.abandon_drag();
            self.state = State::Idle;
            out.push(Gesture::Hover(pointer.at));
            return out;
        }
        match self.state {
            State::Press { id, device, from, holds, drags } if id == pointer.id => {
                self.press_moved(&pointer, device, from, holds, drags)
            }
            State::Eye { id, verb, at, begun, slop } if id == pointer.id => {
                self.eye_moved(pointer.at, verb, at, begun, slop)
            }
            _ => Vec::new(),
        }
    }

    /// A button or finger goes up.
    pub fn up(&mut self, pointer: Pointer) -> Vec<Gesture> {
        let finger = self.fingers.iter().position(|finger| finger.id == pointer.id);
        if let Some(index) = finger {
            self.fingers.remove(index);
        }
        match self.state {
            State::Press { id, device, from, drags, .. } if id == pointer.id => {
                self.state = State::Idle;
                if drags { vec![Gesture::Drop] } else { self.clicked(from, device, &pointer) }
            }
            State::Eye { id, .. } if id == pointer.id => {
                self.state = State::Idle;
                Vec::new()
            }
            State::Fingers { since, most, moved } if finger.is_some() => {
                self.finger_up(since, most, moved, pointer.time)
            }
            State::Spent if self.fingers.is_empty() => {
                self.state = State::Idle;
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    /// The browser takes a pointer away.
    pub fn cancelled(&mut self, id: i32) -> Vec<Gesture> {
        self.fingers.retain(|finger| finger.id != id);
        let concerned = match self.state {
            State::Press { id: own, .. } | State::Eye { id: own, .. } => own == id,
            State::Fingers { .. } | State::Spent => self.fingers.is_empty(),
            State::Idle => false,
        };
        if !concerned {
            return Vec::new();
        }
        let out = self.abandon_drag();
        self.state = State::Idle;
        out
    }

    /// The designer gives up (Escape): what is pressed means nothing until it is let go.
    pub fn abandon(&mut self) -> Vec<Gesture> {
        let out = self.abandon_drag();
        if self.state != State::Idle {
            self.state = State::Spent;
        }
        out
    }

    /// The wheel turns by so many pixels; `pinch` is how browsers tell a trackpad's pinch (ctrl held).
    #[must_use]
    pub fn wheel(at: Vec2, by: Vec2, modifiers: Modifiers) -> Option<Gesture> {
        if !at.is_finite() || !by.is_finite() || by == Vec2::ZERO {
            return None;
        }
        if modifiers.shift && !modifiers.ctrl {
            return Some(Gesture::Pan { by: -by, at });
        }
        let rate = if modifiers.ctrl { PINCH_ZOOM } else { WHEEL_ZOOM };
        Some(Gesture::Zoom { at, factor: (-by.y * rate).clamp(-1.0, 1.0).exp() })
    }

    fn press(pointer: &Pointer, holds: bool) -> State {
        let Pointer { id, device, at, .. } = *pointer;
        State::Press { id, device, from: at, holds, drags: false }
    }

    fn abandon_drag(&self) -> Vec<Gesture> {
        match self.state {
            State::Press { drags: true, .. } => vec![Gesture::Abandon],
            _ => Vec::new(),
        }
    }

    fn press_moved(
        &mut self,
        pointer: &Pointer,
        device: Device,
        from: Vec2,
        holds: bool,
        drags: bool,
    ) -> Vec<Gesture> {
        let Pointer { id, at, modifiers, .. } = *pointer;
        if drags {
            return vec![Gesture::Drag { at, modifiers }];
        }
        let slop = if device == Device::Touch { FINGER_SLOP } else { SLOP };
        if from.distance(at) < slop {
            return Vec::new();
        }
        if holds {
            self.state = State::Press { id, device, from, holds, drags: true };
            return vec![Gesture::Grab { at: from }, Gesture::Drag { at, modifiers }];
        }
        self.state = State::Eye { id, verb: Verb::Orbit, at, begun: true, slop };
        vec![Gesture::OrbitFrom(from), Gesture::Orbit(at - from)]
    }

    fn eye_moved(&mut self, to: Vec2, verb: Verb, at: Vec2, begun: bool, slop: f32) -> Vec<Gesture> {
        let by = to - at;
        if !begun && by.length() < slop {
            return Vec::new();
        }
        let mut out = Vec::new();
        if !begun && verb == Verb::Orbit {
            out.push(Gesture::OrbitFrom(at));
        }
        if let State::Eye { at, begun, .. } = &mut self.state {
            *at = to;
            *begun = true;
        }
        out.push(match verb {
            Verb::Orbit => Gesture::Orbit(by),
            Verb::Pan => Gesture::Pan { by, at: to },
        });
        out
    }

    fn clicked(&mut self, from: Vec2, device: Device, pointer: &Pointer) -> Vec<Gesture> {
        let click = Gesture::Click { at: from, modifiers: pointer.modifiers };
        let reach = if device == Device::Touch { 3.0 * FINGER_SLOP } else { 2.0 * SLOP };
        let doubled = self.last_click.is_some_and(|(at, time, by)| {
            by == device && pointer.time - time < DOUBLE_MILLISECONDS && at.distance(from) < reach
        });
        self.last_click = if doubled { None } else { Some((from, pointer.time, device)) };
        if doubled { vec![Gesture::DoubleClick { at: from }] } else { vec![click] }
    }

    fn finger_down(&mut self, pointer: Pointer, holds: bool) -> Vec<Gesture> {
        self.fingers.retain(|finger| finger.id != pointer.id);
        self.fingers.push(Finger { id: pointer.id, from: pointer.at, at: pointer.at });
        if self.fingers.len() == 1 {
            self.state = Self::press(&pointer, holds);
            return Vec::new();
        }
        let out = self.abandon_drag();
        let most = self.fingers.len();
        self.state = match self.state {
            State::Fingers { since, most: before, moved } => {
                State::Fingers { since, most: most.max(before), moved }
            }
            State::Press { drags: false, .. } => State::Fingers { since: pointer.time, most, moved: false },
            _ => State::Fingers { since: pointer.time, most, moved: true },
        };
        out
    }

    fn fingers_moved(&mut self, index: usize, to: Vec2) -> Vec<Gesture> {
        let before = self.spread();
        self.fingers[index].at = to;
        let finger = self.fingers[index];
        let State::Fingers { since, most, moved } = self.state else { return Vec::new() };
        if !moved {
            if finger.from.distance(to) >= FINGER_SLOP {
                self.state = State::Fingers { since, most, moved: true };
            }
            return Vec::new();
        }
        let after = self.spread();
        let (Some((from, was)), Some((at, is))) = (before, after) else { return Vec::new() };
        let mut out = vec![Gesture::Pan { by: at - from, at }];
        if was > 1.0 && is > 1.0 {
            out.push(Gesture::Zoom { at, factor: is / was });
        }
        out
    }

    /// The middle of the first two fingers and how far they are apart.
    fn spread(&self) -> Option<(Vec2, f32)> {
        let [first, second, ..] = self.fingers.as_slice() else { return None };
        Some(((first.at + second.at) * 0.5, first.at.distance(second.at)))
    }

    fn finger_up(&mut self, since: f64, most: usize, moved: bool, time: f64) -> Vec<Gesture> {
        let tap = !moved && time - since < TAP_MILLISECONDS;
        match self.fingers.as_slice() {
            [] => {
                self.state = State::Idle;
                match most {
                    2 if tap => vec![Gesture::Undo],
                    3 if tap => vec![Gesture::Redo],
                    _ => Vec::new(),
                }
            }
            // Two down and one lifted: the other turns the view, unless both are going up as a tap.
            [last] if most == 2 && !tap => {
                self.state =
                    State::Eye { id: last.id, verb: Verb::Orbit, at: last.at, begun: false, slop: SLOP };
                Vec::new()
            }
            _ => Vec::new(),
        }
    }
}

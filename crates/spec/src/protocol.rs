//! The messages between page and worker, in order, one reply to each request.
//!
//! The page has at most one [`Request::Step`] in flight and sends the next when its reply has come, so a
//! drag is coalesced by itself: only the newest target rides on the next step. Each reply carries the
//! newest frame. A refused request leaves the model as it was.

use crate::displacement::Displacing;
use crate::edit::Edit;
use crate::example::Example;
use crate::frame::{FrameHeader, Structure};
use crate::grab::GrabTarget;
use crate::id::{CurveId, PointId, SurfaceId};
use crate::seams::Seams;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// What a page sends in place of a [`Request`] to see its worker die of a panic. No request and no document can
/// say this: only the page's own inspection does.
pub const TRAP: &str = "trap";

/// What the page asks of the worker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Request {
    /// Opens the text of a spec file.
    OpenText {
        /// The text.
        text: String,
    },
    /// Opens a share link (a fragment or a whole address).
    OpenLink {
        /// The link.
        link: String,
    },
    /// Makes a surface of the polygons of a file: an act like any other, beside what is there.
    Import {
        /// What the bytes are.
        format: ImportFormat,
        /// What is in the file, at most [`crate::MAX_TEXT_BYTES`].
        #[serde(with = "crate::bytes")]
        bytes: Vec<u8>,
        /// What becomes of the polygons; without it [`ImportAs::suited`] decides.
        into: Option<ImportAs>,
    },
    /// Opens an example.
    OpenExample(Example),
    /// Begins again with nothing.
    New,
    /// Goes on where a modeler that died has stopped.
    Resume(Resume),
    /// Acts on the document.
    Edit(Edit),
    /// Takes hold of something; a place on a curve or surface becomes a control point there.
    Grab(GrabTarget),
    /// Relaxes the shape.
    Step(Step),
    /// Ends a drag and keeps its result: one act.
    Drop,
    /// Ends a drag and puts everything back.
    Cancel,
    /// Takes back the last act.
    Undo,
    /// Does the last undone act again.
    Redo,
    /// Writes the surfaces into a file.
    Export(ExportFormat),
    /// Asks where two surfaces run through one another, as a trim would cut them. Changes nothing.
    Meet {
        /// One surface.
        first: SurfaceId,
        /// Another one.
        second: SurfaceId,
    },
    /// Asks how far a displacement would reach. Changes nothing.
    Reach(Displacing),
    /// Asks for the loop that a fill would take through a place of a curve, or a sheet along it. Changes nothing.
    Loop {
        /// The curve.
        curve: CurveId,
        /// The place, roughly.
        at: DVec3,
        /// Whether it is a sheet that would be made.
        sheet: bool,
    },
    /// Asks how well surfaces meet along the curves that they share. Changes nothing.
    Seams,
    /// Asks for the structure and the document anew, for a page that has just connected.
    Describe,
}

/// What a page remembers of a modeler that died: all texts are its own.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Resume {
    /// The document after its last act.
    pub document: String,
    /// What undo takes back, the last act last.
    pub undo: Vec<Remembered>,
    /// What redo does again, the next act last.
    pub redo: Vec<Remembered>,
}

/// An act of a history.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Remembered {
    /// What it is called.
    pub act: String,
    /// The document that taking it back, or doing it again, leads to.
    pub document: String,
}

/// One step of relaxation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Where the held point should be now, if something is held.
    pub drag: Option<DVec3>,
    /// Most conjugate-gradient iterations that the step may spend, at least 1.
    pub iterations: u32,
}

/// A format of an exported mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ExportFormat {
    /// Wavefront OBJ: positions, normals, triangles.
    Obj,
}

/// A format of a mesh that can be imported.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ImportFormat {
    /// Wavefront OBJ.
    Obj,
    /// The polygon file format, as text or binary.
    Ply,
}

/// What becomes of the polygons of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ImportAs {
    /// A cage, with an exact surface over it.
    Cage,
    /// A fixed mesh; polygons are cut into triangles.
    Mesh,
}

/// Triangles from which on a file of nothing else is a mesh: cages that people draw have fewer faces, and scans and exported
/// surfaces more.
const MESH_FROM: usize = 300;

impl ImportAs {
    /// What a file most likely is, by the corners of its faces.
    #[must_use]
    pub fn suited(faces: &[Vec<u32>]) -> Self {
        let is_mesh = faces.len() >= MESH_FROM && faces.iter().all(|face| face.len() == 3);
        if is_mesh { Self::Mesh } else { Self::Cage }
    }
}

impl ImportFormat {
    /// The format of a file of that name, by its ending.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        let (_, ending) = name.rsplit_once('.')?;
        if ending.eq_ignore_ascii_case("obj") {
            Some(Self::Obj)
        } else {
            ending.eq_ignore_ascii_case("ply").then_some(Self::Ply)
        }
    }
}

/// What the worker answers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Reply {
    /// The newest frame; its numbers travel beside the reply.
    pub frame: FrameHeader,
    /// What the numbers belong to, when it changed; the indices travel beside the reply.
    pub structure: Option<Structure>,
    /// The document, after an act (also after undo and redo).
    pub committed: Option<Committed>,
    /// What a grab took hold of.
    pub grabbed: Option<Grabbed>,
    /// The foot of a displacement that a grab took hold of.
    pub pulled: Option<Pulled>,
    /// Why a request was refused.
    pub refused: Option<Refusal>,
    /// A file that was asked for.
    pub exported: Option<Exported>,
    /// Where two surfaces meet, if that was asked.
    pub meeting: Option<Meeting>,
    /// How far a displacement would reach, if that was asked.
    pub reach: Option<Reach>,
    /// The loop through a place of a curve, if that was asked.
    pub found: Option<FoundLoop>,
    /// How well surfaces meet, if that was asked.
    pub seams: Option<Seams>,
}

/// The document after an act.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Committed {
    /// What was done, in the words of the page: "Sheet", "Undo Sheet".
    pub act: String,
    /// The compact text of the document, for the journal and the link.
    pub document: String,
    /// Its name.
    pub name: String,
    /// What undo would take back, if anything.
    pub undo: Option<String>,
    /// What redo would do again, if anything.
    pub redo: Option<String>,
}

/// What a grab took hold of.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grabbed {
    /// The control point, new or old.
    pub point: PointId,
    /// Where it is.
    pub at: DVec3,
}

/// The foot of a displacement that a grab took hold of.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pulled {
    /// Of which surface.
    pub surface: SurfaceId,
    /// Of which of its displacements, from 1.
    pub number: usize,
    /// Where it is shown.
    pub at: DVec3,
}

/// Why a request was refused. The model is as it was.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Refusal {
    /// What was asked, in the words of the page.
    pub act: String,
    /// Why it cannot be done and what would help.
    pub reason: String,
    /// An act that does nearly the same and avoids the reason, if there is one.
    #[serde(default)]
    pub remedy: Option<Edit>,
}

/// How far a displacement would reach.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reach {
    /// Of which surface.
    pub surface: SurfaceId,
    /// Segments of the line on what is shown where it would move the surface by half of what it moves its foot.
    pub segments: Vec<[DVec3; 2]>,
    /// By how much it would move each vertex of the surface, in 255ths of what it moves its foot. Feet that are vertices of their
    /// own come last and are left out.
    #[serde(with = "crate::bytes")]
    pub influence: Vec<u8>,
}

/// Where two surfaces run through one another now.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Meeting {
    /// One surface.
    pub first: SurfaceId,
    /// The other.
    pub second: SurfaceId,
    /// The lines in which they meet; none if they do not.
    pub lines: Vec<MeetingLine>,
}

/// A line in which two surfaces meet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeetingLine {
    /// Places along it, in model units; the first of a closed one is not repeated.
    pub along: Vec<DVec3>,
    /// Whether it closes; an open one ends at rims.
    pub closed: bool,
}

/// The loop that a fill or a sheet would take.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FoundLoop {
    /// The curve that was pointed at.
    pub curve: CurveId,
    /// The place on it.
    pub at: DVec3,
    /// Places along each side, in model units; none if there is no loop, or if a sheet would take the curve by itself.
    pub sides: Vec<Vec<DVec3>>,
    /// Why there is none.
    pub why: Option<String>,
}

/// A file for the designer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Exported {
    /// A name for it.
    pub name: String,
    /// What is in it.
    pub text: String,
}

//! Why the modeler refuses: typed, with the offending thing in the message, in words for the designer.

mod hole;
mod overlay;
mod rim;
mod trim;

use crate::patch::FillError;
use ductile_mesh::io::{obj::ObjError, ply::PlyError};
use ductile_mesh::{BridgeError, BuildError, GlueError, PathError};
use ductile_patch::DisplacementError;
use ductile_patch::RibbonError;
use ductile_patch::cage::CageError;
use ductile_patch::cage::edit::EditError;
use ductile_solver::SolverError;
use ductile_spec::{CurveId, Defect, Document, LinkError, PointId, SurfaceId, SurfaceKind, TextError};
use glam::DVec3;
use thiserror::Error;

pub(crate) use hole::HoleError;
pub(crate) use overlay::ShadowError;
use overlay::displaced;
pub(crate) use rim::{RimError, TouchError};
pub use trim::TrimError;

/// Why a request was refused. The model is as it was before.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ModelError {
    /// The text is no document.
    #[error(transparent)]
    Text(#[from] TextError),
    /// The link is no document.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The act would make a document that cannot be built.
    #[error(transparent)]
    Defect(#[from] Defect),
    /// A curve is no rim of a cage, or is one.
    #[error(transparent)]
    Rim(#[from] RimError),
    /// Join one of the two by position only, then bake.
    #[error(
        "{other} joins {surface} smoothly along {curve} and would move: let one of them join by position first"
    )]
    JoinedSmoothly {
        /// The fill.
        surface: SurfaceId,
        /// The other fill.
        other: SurfaceId,
        /// Along which curve.
        curve: CurveId,
    },
    /// The triangles of a skeleton do not form a surface.
    #[error("{surface} is not a surface: {reason}")]
    NotASurface {
        /// Which surface.
        surface: SurfaceId,
        /// What is wrong with its triangles.
        reason: BuildError,
    },
    /// Two places of a surface or curve coincide, so that there is nothing to make fair between them.
    #[error("{0} has no extent: some of its controls coincide")]
    NoExtent(String),
    /// The numbers of a shape cannot be solved.
    #[error("{what} cannot be solved: {reason}")]
    Unsolvable {
        /// Which curve or surface.
        what: String,
        /// What the solver says.
        reason: SolverError,
    },
    /// The faces of a cage form no surface, or one that cannot be built.
    #[error("{surface}: {reason}")]
    Cage {
        /// Which surface.
        surface: SurfaceId,
        /// What is wrong with it.
        reason: CageError,
    },
    /// What is given, or what a file holds, is no cage.
    #[error("no cage: {0}")]
    NoCage(CageError),
    /// A cage cannot be changed like that.
    #[error("{surface}: {reason}")]
    CageEdit {
        /// Which surface.
        surface: SurfaceId,
        /// Why not.
        reason: EditError,
    },
    /// The point is no vertex of the cage.
    #[error("{point} is no vertex of the cage of {surface}")]
    NoVertex {
        /// The surface over the cage.
        surface: SurfaceId,
        /// The point.
        point: PointId,
    },
    /// The cage has no such edge.
    #[error("no edge of the cage of {surface} joins {} and {}", .ends[0], .ends[1])]
    NoEdge {
        /// The surface over the cage.
        surface: SurfaceId,
        /// The points that it was to join.
        ends: [PointId; 2],
    },
    /// The cage has no such face.
    #[error("face {face} does not exist: the cage of {surface} has {count}")]
    NoFace {
        /// The surface over the cage.
        surface: SurfaceId,
        /// The face, from 0.
        face: u32,
        /// How many there are.
        count: usize,
    },
    /// The surface has no cage that the act could change.
    #[error("{surface} is {kind}: {act} works on cages only")]
    OnlyCages {
        /// Which surface.
        surface: SurfaceId,
        /// What it is.
        kind: &'static str,
        /// What was asked for, in the words of the page.
        act: &'static str,
    },
    /// A file is no OBJ file, or holds no polygons.
    #[error("the OBJ file cannot be read: {0}")]
    Obj(ObjError),
    /// A file is no PLY file, or holds no polygons.
    #[error("the PLY file cannot be read: {0}")]
    Ply(PlyError),
    /// A file that should be a text is none.
    #[error("the OBJ file cannot be read: it is not a text")]
    NoText,
    /// A curve that is to lie in a surface touches a rim of it on its way.
    #[error("{curve} would touch a rim of {surface} at {at}: it may end there, but not pass along it")]
    TouchesRim {
        /// The curve.
        curve: CurveId,
        /// The surface.
        surface: SurfaceId,
        /// Where.
        at: DVec3,
    },
    /// The surface has the curve already.
    #[error("{curve} lies in {surface} already")]
    LiesThere {
        /// The curve.
        curve: CurveId,
        /// The surface.
        surface: SurfaceId,
    },
    /// A part of a curve has nothing below it on a surface, or something else than the part beside it.
    #[error(
        "{curve} does not lie over {surface} at {at}: it leads beyond a rim there, or the surface below is another part of it"
    )]
    NotOver {
        /// The curve.
        curve: CurveId,
        /// The surface.
        surface: SurfaceId,
        /// Where.
        at: DVec3,
    },
    /// Two stretches of a curve have a part in common.
    #[error("the stretches of {0} overlap: nothing lies between them there")]
    StretchesOverlap(CurveId),
    /// A stretch begins where it ends.
    #[error("a stretch of {0} needs two different control points")]
    NoStretch(CurveId),
    /// A size is not a usable number.
    #[error("a size must be a positive number up to 1e6")]
    BadSize,
    /// A distance is not a usable number.
    #[error("a distance must be a number between -1e6 and 1e6 that is not 0")]
    BadDistance,
    /// No points were named.
    #[error("there is nothing to move: no points were named")]
    NothingToShift,
    /// A loop cannot be filled.
    #[error("{surface}: {reason}")]
    Fill {
        /// The fill.
        surface: SurfaceId,
        /// Why not.
        reason: FillError,
    },
    /// There is no such hole, or no such side of a fill.
    #[error(transparent)]
    Hole(#[from] HoleError),
    /// The surface is of another kind than the act can deal with.
    #[error("{surface} is {kind}: {act} works on fair surfaces only")]
    OnlyFair {
        /// Which surface.
        surface: SurfaceId,
        /// What it is.
        kind: &'static str,
        /// What was asked for, in the words of the page.
        act: &'static str,
    },
    /// A cage has the point as a vertex.
    #[error("{point} is a vertex of the cage of {surface}: delete its faces or the surface first")]
    NeededByCage {
        /// The surface over the cage.
        surface: SurfaceId,
        /// The point.
        point: PointId,
    },
    /// A fill has a stretch of the curve as a side.
    #[error("{curve} is a side of {surface}: delete the surface first")]
    NeededByFill {
        /// The fill.
        surface: SurfaceId,
        /// The curve.
        curve: CurveId,
    },
    /// A displacement cannot be met.
    #[error("{surface}, displacement {number}: {}", displaced(reason))]
    Displacement {
        /// Which surface.
        surface: SurfaceId,
        /// Which displacement, from 1.
        number: usize,
        /// What is wrong with it.
        reason: DisplacementError,
    },
    /// There is no such displacement.
    #[error("{surface} has no displacement {number}")]
    NoDisplacement {
        /// Which surface.
        surface: SurfaceId,
        /// Which displacement, from 1.
        number: usize,
    },
    /// A displacement that moves a curve moves nothing else.
    #[error("displacement {number} of {surface} moves {curve}: no place can be added to it")]
    CurveIsFoot {
        /// Which surface.
        surface: SurfaceId,
        /// Which displacement, from 1.
        number: usize,
        /// The curve that it moves.
        curve: CurveId,
    },
    /// A surface has no displacements.
    #[error("{0} has no displacements")]
    NotDisplaced(SurfaceId),
    /// A displacement has the curve as its foot, or is pinned to it.
    #[error("a displacement of {surface} hangs on {curve}: erase it first")]
    NeededByDisplacement {
        /// Which surface.
        surface: SurfaceId,
        /// The curve.
        curve: CurveId,
    },
    /// The surface is a fixed mesh already, and nothing is displaced.
    #[error("{0} is a fixed mesh already, and it has no displacements")]
    NothingToBake(SurfaceId),
    /// The surface has no triangles at the moment.
    #[error("{0} shows nothing that could be baked")]
    NothingShown(SurfaceId),
    /// A region cannot shadow a surface.
    #[error("{surface} cannot shadow {of}: {reason}")]
    Shadow {
        /// Whose region it is.
        surface: SurfaceId,
        /// The stamp.
        of: SurfaceId,
        /// Why not.
        reason: ShadowError,
    },
    /// There is no shadow that could be taken away.
    #[error("this region of {0} shadows nothing")]
    NotShadowing(SurfaceId),
    /// No curve bounds the region, so that it has no name and no anchor.
    #[error("no control curve bounds this region of {0}: draw one around it first")]
    NoBorder(SurfaceId),
    /// The surface is no exact one.
    #[error("{0} is no surface over a cage, no fill and no mesh")]
    NoPatch(SurfaceId),
    /// The curve does not run along the rim of the exact surface.
    #[error("{curve} does not run along a rim of {surface}: there is nothing to go on from")]
    NotAtRim {
        /// The curve.
        curve: CurveId,
        /// The exact surface.
        surface: SurfaceId,
    },
    /// There is no such point.
    #[error("{0} does not exist")]
    NoPoint(PointId),
    /// There is no such curve.
    #[error("{0} does not exist")]
    NoCurve(CurveId),
    /// There is no such surface.
    #[error("{0} does not exist")]
    NoSurface(SurfaceId),
    /// A coordinate of the request is not a usable number.
    #[error("a position must consist of numbers between -1e6 and 1e6")]
    BadPosition,
    /// A curve must close to be skinned.
    #[error("{0} is open: only a closed curve can be skinned")]
    OpenCurve(CurveId),
    /// The curve has a sheet already.
    #[error("{curve} already bounds {surface}")]
    AlreadySkinned {
        /// The curve.
        curve: CurveId,
        /// What it bounds.
        surface: SurfaceId,
    },
    /// A sweep needs two different curves.
    #[error("a sweep needs two different curves, or two stretches of one")]
    SweepToItself,
    /// There is no room between two curves or rims somewhere.
    #[error(transparent)]
    Touch(#[from] TouchError),
    /// A curve cannot lose the point.
    #[error("{curve} needs {point}: {why}")]
    NeededByCurve {
        /// The curve.
        curve: CurveId,
        /// The point.
        point: PointId,
        /// Why it is needed.
        why: &'static str,
    },
    /// Of the normal nothing is left across the curve.
    #[error(
        "{surface}: at {point} the normal runs along {curve}; a surface that follows a curve lies along it"
    )]
    NormalAlongCurve {
        /// The surface.
        surface: SurfaceId,
        /// The curve.
        curve: CurveId,
        /// The point.
        point: PointId,
    },
    /// The surface cannot leave a curve along the curve.
    #[error("{surface}: at {point} the ribbon runs along {curve}; it must lead away from it")]
    CrossAlongCurve {
        /// The surface.
        surface: SurfaceId,
        /// The curve.
        curve: CurveId,
        /// The point.
        point: PointId,
    },
    /// Two curves of the surface cross there.
    #[error("{surface}: curves cross at {point}, so their tangents are its plane there; turn those")]
    PlaneGiven {
        /// The surface.
        surface: SurfaceId,
        /// The point.
        point: PointId,
    },
    /// A handle of a surface turns only what is prescribed.
    #[error("{surface}: no direction is prescribed at {point} that could be turned")]
    NotPrescribed {
        /// The surface.
        surface: SurfaceId,
        /// The point.
        point: PointId,
    },
    /// The curve does not lie in the surface.
    #[error("{curve} does not lie in {surface}")]
    NotInSurface {
        /// The surface.
        surface: SurfaceId,
        /// The curve.
        curve: CurveId,
    },
    /// An angle from the plane of a curve was asked for, but the curve is straight.
    #[error("{0} is straight and lies in many planes: give directions instead of an angle")]
    NoPlane(CurveId),
    /// An angle is no number, or more than half a turn.
    #[error("an angle must be a number between -180° and 180°")]
    BadAngle,
    /// A soap film has no bending that could hold a tangent plane.
    #[error("{0} is a membrane: it has no bending to hold a direction with. Choose another objective first")]
    MembraneHasNoPlane(SurfaceId),
    /// Nothing hangs on the point that could be let go.
    #[error("nothing hangs on {0}: there is nothing to release. Delete removes it")]
    NothingToRelease(PointId),
    /// A surface is bounded by the curve.
    #[error("{curve} bounds {surface}: delete the surface first")]
    BoundsSurface {
        /// The curve.
        curve: CurveId,
        /// The surface.
        surface: SurfaceId,
    },
    /// The place is taken by a control.
    #[error("there is a control at this place already")]
    Occupied,
    /// The resolution asked for needs more nodes than fit.
    #[error("a spacing of {spacing} would need about {nodes} nodes; the limit is {limit}")]
    TooFine {
        /// The spacing asked for.
        spacing: f64,
        /// How many nodes it would need.
        nodes: usize,
        /// How many fit.
        limit: usize,
    },
    /// A curve does not pass through a point, so that it has no direction there.
    #[error("{curve} does not pass through {point}")]
    NotOnCurve {
        /// The curve.
        curve: CurveId,
        /// The point.
        point: PointId,
    },
    /// A surface has no edge where a curve that it follows has one: our mistake, not the designer's.
    #[error("{surface} no longer follows {curve} edge by edge")]
    TornOff {
        /// The curve.
        curve: CurveId,
        /// The surface.
        surface: SurfaceId,
    },
    /// A region without a border towards other regions cannot be cut out.
    #[error("{0} is a single region: draw a closed curve on it first, and cut along that")]
    NothingAround(SurfaceId),
    /// The curve lies in no surface.
    #[error("{0} lies in no surface")]
    InNoSurface(CurveId),
    /// There is nothing beyond a rim from which it could be cut.
    #[error("{curve} is a rim of {surface} already: there is nothing beyond it to cut off")]
    OnRim {
        /// The curve.
        curve: CurveId,
        /// The surface.
        surface: SurfaceId,
    },
    /// An open curve of a single edge cannot be opened.
    #[error("a slit in {0} would be too short to open")]
    ShortSlit(SurfaceId),
    /// Along a one-sided curve there is only one bank.
    #[error(
        "{0} runs round a Möbius strip: the region along it has one side, so it cannot be creased. It can be split"
    )]
    OneSided(CurveId),
    /// A closed curve would begin and end at one control point.
    #[error(
        "{0} is closed and would be cut across at a single point, where both banks of a crease stay together: split instead"
    )]
    CutAcrossOnce(CurveId),
    /// Surfaces that together have one side, as three that make up a Möbius strip do, have no outside in common.
    #[error("{0} and what meets it have one side together: there is no outside that all of them could have")]
    NoCommonSide(SurfaceId),
    /// Nothing is there to be turned.
    #[error("Every surface that meets {0} at a rim has its outside there already")]
    AlreadyAgree(SurfaceId),
    /// A piece would hang together by a single point.
    #[error("{0} would hang together by a single point")]
    Pinched(SurfaceId),
    /// There is no crease at the curve.
    #[error("no two rims meet at {0}: there is no crease to smooth")]
    NoCrease(CurveId),
    /// Three surfaces or more meet at the curve.
    #[error("{count} surfaces meet at {curve}: only two can run smoothly into one another")]
    ManyRims {
        /// The curve.
        curve: CurveId,
        /// How many there are.
        count: usize,
    },
    /// Two rims cannot be glued.
    #[error("the rims cannot be joined: {0}")]
    Unjoinable(GlueError),
    /// A curve cannot be laid on a surface.
    #[error("{surface}: {why}")]
    NoWay {
        /// The surface.
        surface: SurfaceId,
        /// Why not.
        why: PathError,
    },
    /// A curve on a surface would share an edge with another one, or with the rim.
    #[error("the curve would run along another curve of {0}, or along its rim; keep off it, or cross it")]
    AlongCurve(SurfaceId),
    /// A curve would pass through a control point twice.
    #[error("the curve would pass through {0} twice; draw two curves instead")]
    TwiceThrough(PointId),
    /// A curve would cross others too often.
    #[error(
        "the curve would cross others more than {0} times; keep off them, or cross them at a wider angle"
    )]
    TooManyHubs(usize),
    /// The surface is closed.
    #[error("{0} is closed: it has no rim")]
    NoRim(SurfaceId),
    /// A rim cannot be joined with itself.
    #[error(
        "both places lie on the same rim of {0}, and it cannot be joined with itself: in its own sense opposite points would meet, and the surface would run through itself; in the other sense it would fold flat. Skin it with Sheet, or pick another rim"
    )]
    SameRim(SurfaceId),
    /// Two rims cannot be bridged.
    #[error("no band fits between the rims: {0}")]
    NoBand(BridgeError),
    /// A curve inside a surface ends at the rim that would vanish.
    #[error(
        "{curve} ends at the rim of {surface} that would be laid on the other; join them with a band instead"
    )]
    EndsAtRim {
        /// The curve.
        curve: CurveId,
        /// The surface.
        surface: SurfaceId,
    },
    /// Two holes of this size would meet.
    #[error("the two holes would meet: choose places farther apart, or a smaller radius")]
    HolesMeet,
    /// A hole does not fit.
    #[error(
        "{0} has no room for the hole here: a rim or a curve is too near, or the surface bends too sharply. Choose another place, or a smaller radius"
    )]
    NoRoom(SurfaceId),
    /// Two surfaces cannot be trimmed.
    #[error(transparent)]
    Trim(#[from] TrimError),
    /// A curve that is to lie in a surface crosses another one there.
    #[error(
        "{curve} would run over a control point of {surface} that is not its own, or cross a curve where there is no room for one; release that point, or move the curve"
    )]
    CrossesCurve {
        /// The curve.
        curve: CurveId,
        /// The surface.
        surface: SurfaceId,
    },
    /// A size is not a usable number.
    #[error("a radius must be a positive number up to 1e6")]
    BadRadius,
    /// A curve has no extent that could grow.
    #[error("the points of {0} lie on one another: there is nothing to expand")]
    NothingToExpand(CurveId),
    /// One curve closes and the other does not.
    #[error("{0} and {1} are unlike: a sweep needs two closed curves, or two open ones")]
    UnlikeCurves(CurveId, CurveId),
    /// The triangles beside a curve must be improved before it can get another sample.
    #[error("too many triangles of {surface} meet beside {curve}; wait until it rests, then try again")]
    Crowded {
        /// The curve.
        curve: CurveId,
        /// The surface.
        surface: SurfaceId,
    },
    /// Nothing is held.
    #[error("nothing is held")]
    NothingHeld,
    /// There is nothing to undo.
    #[error("there is nothing to undo")]
    NothingToUndo,
    /// There is nothing to redo.
    #[error("there is nothing to redo")]
    NothingToRedo,
    /// There is nothing to export.
    #[error("there is no surface to export yet")]
    NothingToExport,
    /// Another act has to be finished first.
    #[error("finish the drag first")]
    Dragging,
}

impl ModelError {
    /// Whether ribbons are to blame that fit at their corners, so that moving twist points would do.
    pub(crate) fn can_be_mended(&self) -> bool {
        let Self::Fill {
            reason: FillError::Ribbons(RibbonError::Incompatible { row, other_row, .. }), ..
        } = self
        else {
            return false;
        };
        *row > 0 || *other_row > 0
    }

    /// This error in view of a document: a surface that an act did not find among the fair ones may be of another kind.
    pub(crate) fn of_kind(self, document: &Document, act: &'static str) -> Self {
        let Self::NoSurface(surface) = self else { return self };
        let kind = match document.kind_of(surface) {
            Some(SurfaceKind::Cage) => "a surface over a cage",
            Some(SurfaceKind::Fill) => "a patch that fills a loop",
            Some(SurfaceKind::Mesh) => "a fixed mesh",
            Some(SurfaceKind::Fair) | None => return self,
        };
        Self::OnlyFair { surface, kind, act }
    }
}

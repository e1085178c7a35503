//! Reference files of S-patches: ribbons round a hole, and what the patch between them is like (the recipe's section 13).

mod sample;

use super::reader::{Fields, Flaw, Item, recorded};
use super::report::{Report, Tolerance};
use super::tolerances::{self, Stated};
use crate::ribbon_file;
use ductile_patch::s_patch::{Domain, Fill, Join, LabelKind, Labels, MaskCache, SPatch};
use ductile_patch::{Ribbon, RibbonError, RibbonLoop};
use glam::DVec3;

const STATED: [Stated; 5] = [
    Stated { name: "point_abs", default: 1e-9, most: 1e-3 },
    Stated { name: "normal_rad", default: 1e-8, most: 1e-3 },
    Stated { name: "control_point_abs", default: 1e-9, most: 1e-3 },
    Stated { name: "side_point_vs_ribbon_abs", default: 1e-12, most: 1e-6 },
    Stated { name: "side_normal_vs_ribbon_rad", default: 1e-9, most: 1e-6 },
];
/// Places on each side that are compared with the ribbon.
const PLACES: usize = 64;

/// Of the models for which the recipe names its tolerances (section 12).
const SIZE: f64 = 4.0;

/// How far recorded numbers may be from those found.
#[derive(Clone, Copy)]
struct Within {
    point: f64,
    normal: f64,
    control_point: f64,
}

/// A patch, and what its quantities are called.
struct Filled {
    ribbons: RibbonLoop,
    patch: SPatch,
    labels: Labels,
    domain: Domain,
    join: Join,
    word: &'static str,
    within: Within,
}

/// Checks a whole file.
pub(crate) fn check(file: &Fields<'_>, report: &mut Report) -> Result<(), Flaw> {
    check_prose(file, report)?;
    let [point, normal, control_point, side_point, side_normal] =
        tolerances::read_in(file, "tolerances", STATED, report)?;
    let within = Within { point, normal, control_point };
    let list = file.need("ribbons")?;
    let ribbons = ribbon_file::ribbons(&list, report)?;
    let degree = ribbons.iter().map(Ribbon::degree).max().unwrap_or(0);
    for (name, found) in [("sides", ribbons.len()), ("ribbon_degree", degree)] {
        if let Some(item) = file.get(name)
            && let Some(count) = recorded(item.count(), report)
        {
            report.compare(name, &item.place, count as f64, found as f64, Tolerance::EXACT);
        }
    }
    let mut cache = MaskCache::new();
    // A file of nothing but position says so by its depth.
    let is_position = file.get("depth").is_some_and(|depth| depth.count() == Ok(degree));
    let join = if is_position { Join::Position } else { Join::Tangent };
    if let Some(filled) = filled(file, &list, &ribbons, join, "", within, &mut cache, report)? {
        check_sides(&filled, &list.place, [side_point, side_normal], report);
        check_patch(&filled, file, report)?;
        if let Some(list) = file.get("c0_patches") {
            for item in list.list()? {
                let fields = item.fields()?;
                let filled = self::filled(
                    &fields,
                    &item,
                    &ribbons,
                    Join::Position,
                    "c0: ",
                    within,
                    &mut cache,
                    report,
                )?;
                if let Some(filled) = filled {
                    check_patch(&filled, &fields, report)?;
                    fields.finish(report);
                }
            }
        }
    }
    if let Some(list) = file.get("reject") {
        for item in list.list()? {
            let fields = item.fields()?;
            check_refusal(&fields, &ribbons, join, control_point, report)?;
            fields.finish(report);
        }
    }
    Ok(())
}

/// What a file says of itself in words; numbers there would be results without a rule.
fn check_prose(file: &Fields<'_>, report: &mut Report) -> Result<(), Flaw> {
    if let Some(item) = file.get("schema")
        && !item.text()?.starts_with("s-patch-")
    {
        report.pass_over(&item.place, "no such kind of file is known");
    }
    if let Some(item) = file.get("conventions") {
        item.fields()?.finish(report);
    }
    Ok(())
}

/// The patch that some fields describe; none, and the report says why, if there is no such patch.
#[expect(clippy::too_many_arguments, reason = "what the file says, what it says it of, and where it is told")]
fn filled(
    fields: &Fields<'_>,
    whole: &Item<'_>,
    ribbons: &[Ribbon],
    join: Join,
    word: &'static str,
    within: Within,
    cache: &mut MaskCache,
    report: &mut Report,
) -> Result<Option<Filled>, Flaw> {
    let fill = match fields.get("interior_fill") {
        None => Some(Fill::Biharmonic),
        Some(item) => {
            let fill = ribbon_file::fill_named(item.text()?);
            if fill.is_none() {
                report.pass_over(&item.place, "no fill of that name is known");
            }
            fill
        }
    };
    let Some(fill) = fill else { return Ok(None) };
    let ring = match join {
        Join::Tangent => RibbonLoop::new(ribbons),
        Join::Position => {
            let curves: Vec<Vec<DVec3>> = ribbons.iter().map(|ribbon| ribbon.row0.clone()).collect();
            RibbonLoop::of_curves(&curves)
        }
    };
    let ring = match ring {
        Ok(ring) => ring,
        Err(error @ RibbonError::Incompatible { residual, allowed, .. }) => {
            report.judge("fit of the ribbons", &whole.place, residual, allowed);
            report.pass_over(&whole.place, &format!("there is no patch: {error}"));
            return Ok(None);
        }
        Err(error) => return Err(whole.flaw(error.to_string())),
    };
    let depth = join.depth(ring.degree());
    if let Some(item) = fields.get("depth") {
        let quantity = format!("{word}depth");
        if let Some(count) = recorded(item.count(), report) {
            report.compare(&quantity, &item.place, count as f64, depth as f64, Tolerance::EXACT);
        }
    }
    let said = |error: &dyn std::fmt::Display| whole.flaw(error.to_string());
    let labels = Labels::new(ring.sides(), depth).map_err(|error| said(&error))?;
    let patch = SPatch::filling(&ring, join, fill, cache).map_err(|error| said(&error))?;
    let domain = Domain::new(ring.sides());
    Ok(Some(Filled { ribbons: ring, patch, labels, domain, join, word, within }))
}

/// Points and normals of the sides against the ribbons that the file gives, recorded or not.
fn check_sides(filled: &Filled, place: &str, [point, normal]: [f64; 2], report: &mut Report) {
    let rows = filled.ribbons.ribbons().iter().flat_map(|ribbon| &ribbon.row0);
    let extent = rows.map(|p| p.abs().max_element()).fold(0.0, f64::max);
    // Rounding grows with the coordinates.
    let point = point * (extent / SIZE).max(1.0);
    for (side, ribbon) in filled.ribbons.ribbons().iter().enumerate() {
        let place = format!("{place}[{side}]");
        for step in 0..=PLACES {
            let u = step as f64 / PLACES as f64;
            let at = filled.patch.at(&filled.domain, filled.domain.on_side(side, u));
            let found = at.map_or(f64::NAN, |at| at.point.distance(ribbon.point(u)));
            report.judge("side point against ribbon", &place, found, point);
            let wanted = if filled.join == Join::Tangent { ribbon.normal(u) } else { None };
            if let Some(wanted) = wanted {
                let found = at.and_then(|at| at.normal()).map_or(f64::NAN, |found| angle(found, wanted));
                report.judge("side normal against ribbon", &place, found, normal);
            }
        }
    }
}

/// Everything that is recorded of one patch.
fn check_patch(filled: &Filled, fields: &Fields<'_>, report: &mut Report) -> Result<(), Flaw> {
    let of_kind = |kind| (0..filled.labels.len()).filter(|&rank| filled.labels.kind(rank) == kind).count();
    let [boundary, panel] = [LabelKind::Boundary, LabelKind::Panel].map(of_kind);
    let all = filled.labels.len();
    let free: Vec<usize> = (0..all).filter(|&rank| filled.is_free(rank)).collect();
    if let Some(item) = fields.get("counts") {
        let counts = item.fields()?;
        for (name, found) in [
            ("control_points", all),
            ("boundary", boundary),
            ("panel_including_boundary", boundary + panel),
            ("interior", free.len()),
            ("distinct_panels", filled.labels.sides() * (filled.labels.depth() - 1)),
        ] {
            if let Some(item) = counts.get(name) {
                let quantity = format!("{}counts", filled.word);
                if let Some(count) = recorded(item.count(), report) {
                    report.compare(&quantity, &item.place, count as f64, found as f64, Tolerance::EXACT);
                }
            }
        }
        counts.finish(report);
    }
    if let Some(item) = fields.get("interior_mean")
        && let Some(mean) = recorded(item.vector(), report)
    {
        let sum: DVec3 = free.iter().map(|&rank| filled.patch.points()[rank]).sum();
        // Without interior points there is no mean: not a number, which no recorded one agrees with.
        let deviation = mean.distance(sum / free.len() as f64);
        let quantity = format!("{}interior_mean", filled.word);
        report.judge(&quantity, &item.place, deviation, filled.within.control_point);
    }
    if let Some(list) = fields.get("control_points") {
        check_control_points(filled, &list, report)?;
    }
    if let Some(list) = fields.get("samples") {
        for item in list.list()? {
            let sample = item.fields()?;
            sample::check(filled, &item, &sample, report)?;
            sample.finish(report);
        }
    }
    Ok(())
}

fn check_control_points(filled: &Filled, list: &Item<'_>, report: &mut Report) -> Result<(), Flaw> {
    let mut is_told = vec![false; filled.labels.len()];
    for item in list.list()? {
        let fields = item.fields()?;
        let label = fields.need("label")?;
        let entries = label.list()?.map(|entry| {
            entry
                .index(filled.labels.depth() + 1, "entry")
                .map(|entry| u8::try_from(entry).unwrap_or(u8::MAX))
        });
        let entries: Vec<u8> = entries.collect::<Result<_, _>>()?;
        let Some(rank) = filled.labels.rank(&entries) else {
            let (sides, depth) = (filled.labels.sides(), filled.labels.depth());
            return Err(label.flaw(format!("a label has {sides} entries with sum {depth}")));
        };
        if std::mem::replace(&mut is_told[rank], true) {
            return Err(label.flaw("this label is given twice"));
        }
        if let Some(kind) = fields.get("kind") {
            let own = filled.labels.kind(rank);
            let fits = match kind.text()? {
                "boundary" => own == LabelKind::Boundary,
                "panel" => own == LabelKind::Panel,
                "interior" => filled.is_free(rank),
                _ => {
                    report.pass_over(&kind.place, "no kind of that name is known");
                    continue;
                }
            };
            let quantity = format!("{}control_points: kind", filled.word);
            report.judge(&quantity, &kind.place, f64::from(u8::from(!fits)), 0.0);
        }
        let point = fields.need("point")?;
        if let Some(place) = recorded(point.vector(), report) {
            let deviation = place.distance(filled.patch.points()[rank]);
            let quantity = format!("{}control_points", filled.word);
            report.judge(&quantity, &point.place, deviation, filled.within.control_point);
        }
        fields.finish(report);
    }
    Ok(())
}

/// An edit of one ribbon point that must be refused.
fn check_refusal(
    fields: &Fields<'_>,
    ribbons: &[Ribbon],
    join: Join,
    tolerance: f64,
    report: &mut Report,
) -> Result<(), Flaw> {
    let side = fields.need("side")?.index(ribbons.len(), "side")?;
    let row = fields.need("row")?.index(2, "row")?;
    let mut edited = ribbons.to_vec();
    let points = if row == 0 { &mut edited[side].row0 } else { &mut edited[side].row1 };
    let column = fields.need("column")?.index(points.len(), "point")?;
    points[column] += fields.need("add")?.vector()?;
    let found = match join {
        Join::Tangent => RibbonLoop::new(&edited),
        Join::Position => {
            RibbonLoop::of_curves(&edited.into_iter().map(|ribbon| ribbon.row0).collect::<Vec<_>>())
        }
    };
    report.judge("reject", &fields.place, f64::from(u8::from(found.is_ok())), 0.0);
    if let Some(item) = fields.get("twist_residual")
        && let Some(number) = recorded(item.number(), report)
    {
        let residual = match found {
            Err(RibbonError::Incompatible { residual, .. }) => residual,
            _ => f64::NAN,
        };
        report.judge("reject: twist_residual", &item.place, (number - residual).abs(), tolerance);
    }
    Ok(())
}

impl Filled {
    /// Whether masks place this control point.
    fn is_free(&self, rank: usize) -> bool {
        match self.join {
            Join::Tangent => self.labels.kind(rank) == LabelKind::Interior,
            Join::Position => self.labels.kind(rank) != LabelKind::Boundary,
        }
    }
}

/// The angle between two directions, in radians, exact for small ones too.
fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

//! One recorded sample of a patch: where it lies, what the coordinates are there, the point and the normal.

use super::super::reader::{Fields, Flaw, Item, recorded};
use super::super::report::Report;
use super::{Filled, angle};
use glam::DVec2;

/// Places and coordinates are recorded with all their digits.
const EXACT: f64 = 1e-12;
/// On the boundary a coordinate is zero up to rounding.
const INSIDE: f64 = 1e-14;

/// Compares what a sample records.
pub(super) fn check(
    filled: &Filled,
    item: &Item<'_>,
    sample: &Fields<'_>,
    report: &mut Report,
) -> Result<(), Flaw> {
    let Some(place) = place(filled, item, sample, report)? else { return Ok(()) };
    let found = filled.patch.at(&filled.domain, place);
    let Some(found) = found else {
        // Everything else in it is unread, and told by the caller.
        report.pass_over(&item.place, "it lies outside of the domain");
        return Ok(());
    };
    let mut is_compared = false;
    if let Some(point) = sample.get("point") {
        is_compared = true;
        if let Some(place) = recorded(point.vector(), report) {
            let deviation = place.distance(found.point);
            report.judge(&format!("{}point", filled.word), &point.place, deviation, filled.within.point);
        }
    }
    if let Some(normal) = sample.get("normal") {
        is_compared = true;
        if let Some(told) = recorded(normal.vector(), report) {
            // Direction and length: a recorded normal is a unit vector.
            let deviation =
                found.normal().map_or(f64::NAN, |found| angle(found, told).max((told.length() - 1.0).abs()));
            report.judge(&format!("{}normal", filled.word), &normal.place, deviation, filled.within.normal);
        }
    }
    if !is_compared {
        report.pass_over(&item.place, "it records neither a point nor a normal");
    }
    Ok(())
}

/// The place of a sample, however it is told, after comparing all the ways in which it is.
fn place(
    filled: &Filled,
    item: &Item<'_>,
    sample: &Fields<'_>,
    report: &mut Report,
) -> Result<Option<DVec2>, Flaw> {
    let domain = &filled.domain;
    let kind = sample.get("kind").map(|kind| kind.text()).transpose()?;
    let side = sample.get("side").map(|side| side.index(domain.sides(), "side")).transpose()?;
    let u = sample.get("u").map(|u| u.number()).transpose()?;
    let on_side = match (side, u, kind) {
        (Some(side), Some(u), _) => Some(domain.on_side(side, u)),
        (Some(side), None, Some("corner")) => Some(domain.corners()[side]),
        _ => None,
    };
    let xy = sample.get("xy").map(|xy| xy.numbers().map(DVec2::from_array)).transpose()?;
    let bary = sample.get("bary").map(|bary| {
        let values: Vec<f64> = bary.list()?.map(|value| value.number()).collect::<Result<_, _>>()?;
        if values.len() == domain.sides() {
            Ok((bary.place.clone(), values))
        } else {
            Err(bary.flaw(format!("{} coordinates for {} corners", values.len(), domain.sides())))
        }
    });
    let bary = bary.transpose()?;
    let by_bary = bary.as_ref().and_then(|(_, values)| domain.point_with(values));
    let centre = (kind == Some("centre")).then_some(DVec2::ZERO);
    let Some(place) = xy.or(on_side).or(by_bary).or(centre) else {
        return Err(item.flaw("it says by no coordinates where it lies in the domain"));
    };
    if let Some((at, values)) = &bary {
        let own = domain.coordinates(place);
        let deviation = own.iter().zip(values).map(|(own, value)| (own - value).abs()).fold(0.0, f64::max);
        // Not a number is lost by the maximum; the sum keeps it.
        let deviation = if own.iter().sum::<f64>().is_nan() { f64::NAN } else { deviation };
        report.judge(&format!("{}bary", filled.word), at, deviation, EXACT);
    }
    let off = match kind {
        None => Some(0.0),
        Some("centre") => Some(place.length()),
        Some("corner") => {
            let nearest = domain.corners().iter().map(|corner| corner.distance(place));
            Some(nearest.fold(f64::INFINITY, f64::min))
        }
        Some("side") if on_side.is_some() => Some(0.0),
        Some("side") => Some(least(&domain.coordinates(place)).max(0.0)),
        Some("interior") => {
            Some(if least(&domain.coordinates(place)) > INSIDE { 0.0 } else { f64::INFINITY })
        }
        Some(_) => None,
    };
    let Some(off) = off else {
        report.pass_over(&sample.at("kind"), "no kind of sample of that name is known");
        return Ok(None);
    };
    let off = off.max(on_side.map_or(0.0, |on_side| on_side.distance(place)));
    let off = if place.is_finite() { off } else { f64::NAN };
    report.judge(&format!("{}place of samples", filled.word), &item.place, off, EXACT);
    Ok(Some(place))
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

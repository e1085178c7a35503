//! Reference files of displacement blends: Green's functions, profiles and blends on meshes, and offsets of several feet.

use super::blend::blend_named;
use super::reader::{Fields, Flaw, Item, recorded};
use super::report::{Report, Tolerance};
use super::tolerances::{self, Stated};
use ductile_patch::{Combination, Displacements, Domain, Profile, Range, Settings};
use ductile_patch::{Item as Displaced, Laplacian};
use glam::DVec3;

const STATED: [Stated; 2] = [
    Stated { name: "harmonic", default: 1e-10, most: 1e-6 },
    Stated { name: "blend", default: 1e-10, most: 1e-6 },
];

/// Tolerances of solutions, and of what is made of them.
#[derive(Clone, Copy)]
struct Within {
    harmonic: Tolerance,
    blend: Tolerance,
}

/// Checks a whole file.
pub(crate) fn check(file: &Fields<'_>, report: &mut Report) -> Result<(), Flaw> {
    let [harmonic, blend] = tolerances::read(file, STATED, report)?.map(Tolerance::absolute);
    for case in file.need("cases")?.list()? {
        let fields = case.fields()?;
        if check_case(&case, &fields, Within { harmonic, blend }, report)? {
            fields.finish(report);
        }
    }
    Ok(())
}

/// Whether the case was of a kind that is known.
fn check_case(
    case: &Item<'_>,
    fields: &Fields<'_>,
    within: Within,
    report: &mut Report,
) -> Result<bool, Flaw> {
    let laplacian = match fields.get("laplacian") {
        None => Laplacian::Cotangent,
        Some(item) => match item.text()?.to_lowercase().replace(['-', '_'], " ").as_str() {
            "cotangent" => Laplacian::Cotangent,
            "intrinsic delaunay cotangent" | "intrinsic delaunay" => Laplacian::IntrinsicDelaunay,
            _ => {
                report.pass_over(&item.place, "no Laplacian of that name is known");
                return Ok(false);
            }
        },
    };
    let domain = domain(fields)?;
    let settings = Settings {
        laplacian,
        profile: Profile::Harmonic,
        combination: Combination::Plain,
        ..Settings::default()
    };
    let surface = Displacements::new(domain, settings).map_err(|reason| case.flaw(reason.to_string()))?;
    if let Some(feet) = fields.get("feet") {
        for foot in feet.list()? {
            let fields = foot.fields()?;
            check_foot(&fields, surface.clone(), settings, within, report)?;
            fields.finish(report);
        }
    }
    if let Some(item) = fields.get("multi") {
        let several: Vec<Item<'_>> = if item.is_list() { item.list()?.collect() } else { vec![item] };
        for one in several {
            let fields = one.fields()?;
            check_several(&fields, surface.clone(), settings, within.blend, report)?;
            fields.finish(report);
        }
    }
    Ok(true)
}

fn domain(fields: &Fields<'_>) -> Result<Domain, Flaw> {
    let mut positions = Vec::new();
    for vertex in fields.need("vertices")?.list()? {
        let is_plane = vertex.list()?.len() == 2;
        positions.push(if is_plane {
            let [x, y] = vertex.numbers()?;
            DVec3::new(x, y, 0.0)
        } else {
            vertex.vector()?
        });
    }
    let item = fields.need("triangles")?;
    let mut triangles = Vec::new();
    for triangle in item.list()? {
        let corners: Vec<Item<'_>> = triangle.list()?.collect();
        if corners.len() != 3 {
            return Err(triangle.flaw(format!("a triangle has 3 corners, not {}", corners.len())));
        }
        let mut indices = [0_u32; 3];
        for (index, corner) in indices.iter_mut().zip(corners) {
            let vertex = corner.index(positions.len(), "vertex")?;
            *index = u32::try_from(vertex).map_err(|_| corner.flaw("there are too many vertices"))?;
        }
        triangles.push(indices);
    }
    let domain = Domain::new(&positions, &triangles).map_err(|reason| item.flaw(reason.to_string()))?;
    let Some(boundary) = fields.get("boundary") else { return Ok(domain) };
    let held: Result<Vec<usize>, Flaw> =
        boundary.list()?.map(|vertex| vertex.index(positions.len(), "vertex")).collect();
    domain.with_only(&held?).map_err(|reason| boundary.flaw(reason.to_string()))
}

fn check_foot(
    fields: &Fields<'_>,
    mut surface: Displacements,
    settings: Settings,
    within: Within,
    report: &mut Report,
) -> Result<(), Flaw> {
    let foot = fields.need("foot")?;
    let vertex = foot.index(surface.domain().len(), "vertex")?;
    let refused = |reason: &dyn std::fmt::Display| foot.flaw(reason.to_string());
    surface.add(Displaced::foot(vertex, DVec3::Z)).map_err(|reason| refused(&reason))?;
    let green = surface.solution(0).map_err(|reason| refused(&reason))?.to_vec();
    let raw: Vec<f64> = green.iter().map(|g| g / green[vertex]).collect();
    let clamped: Vec<f64> = raw.iter().map(|h| h.clamp(0.0, 1.0)).collect();
    for (name, found) in [("green", &green), ("harmonic_raw", &raw), ("harmonic", &clamped)] {
        check_values(fields.get(name).as_ref(), name, found, within.harmonic, report);
    }
    for (profile, blends) in [(Profile::Conformal, "blend_conformal"), (Profile::Harmonic, "blend_harmonic")]
    {
        let settings = Settings { profile, ..settings };
        surface.set_settings(settings).map_err(|reason| refused(&reason))?;
        if profile == Profile::Conformal {
            let logarithm = surface.logarithm(0).map_err(|reason| refused(&reason))?;
            let height: Vec<f64> = logarithm.iter().map(|&l| -libm::expm1(l)).collect();
            let rho: Vec<f64> = logarithm.iter().map(|&l| libm::exp(l)).collect();
            check_values(fields.get("conformal").as_ref(), "conformal", &height, within.blend, report);
            check_values(fields.get("rho").as_ref(), "rho", &rho, within.blend, report);
        }
        let Some(list) = fields.get(blends) else { continue };
        for item in list.list()? {
            let fields = item.fields()?;
            let Some(blended) = blended(&fields, settings, report)? else { continue };
            surface.set_settings(blended).map_err(|reason| item.flaw(reason.to_string()))?;
            surface.set_range(0, range(&fields)?).map_err(|reason| refused(&reason))?;
            let found = surface.blend(0).map_err(|reason| refused(&reason))?;
            check_values(Some(&fields.need("values")?), blends, found, within.blend, report);
            fields.finish(report);
        }
    }
    Ok(())
}

/// The settings with the blend that is named, if one is.
fn blended(fields: &Fields<'_>, settings: Settings, report: &mut Report) -> Result<Option<Settings>, Flaw> {
    let Some(item) = fields.get("blend") else { return Ok(Some(settings)) };
    let Some(blend) = blend_named(item.text()?) else {
        report.pass_over(&item.place, "no blend of that name is known");
        return Ok(None);
    };
    Ok(Some(Settings { blend, ..settings }))
}

/// A range, or the size that is another name for it; the range 0 where there is neither.
fn range(fields: &Fields<'_>) -> Result<Range, Flaw> {
    match fields.get("size") {
        Some(item) if !fields.has("range") => {
            Range::of_size(item.number()?).map_err(|reason| item.flaw(reason.to_string()))
        }
        Some(item) => Err(item.flaw("a size stands beside a range")),
        None => match fields.get("range") {
            Some(item) => Range::new(item.number()?).map_err(|reason| item.flaw(reason.to_string())),
            None => Ok(Range::default()),
        },
    }
}

fn check_values(item: Option<&Item<'_>>, name: &str, found: &[f64], by: Tolerance, report: &mut Report) {
    let list = item.and_then(|item| recorded(item.list_of(found.len(), "numbers", "vertices"), report));
    for (item, &found) in list.into_iter().flatten().zip(found) {
        if let Some(number) = recorded(item.number(), report) {
            report.compare(name, &item.place, number, found, by);
        }
    }
}

/// What `plain_sum_offsets`, `pairwise_conformal_offsets` and the like are made by. A sum without a profile is the paper's.
fn offsets_named(name: &str) -> Option<(Combination, Profile)> {
    let of = name.strip_suffix("_offsets")?;
    let (of, profile) = match (of.strip_suffix("_conformal"), of.strip_suffix("_harmonic")) {
        (Some(of), _) => (of, Profile::Conformal),
        (_, Some(of)) => (of, Profile::Harmonic),
        _ => (of, Profile::Harmonic),
    };
    match (of, profile) {
        ("plain_sum" | "plain", profile) => Some((Combination::Plain, profile)),
        ("gram", profile) => Some((Combination::Gram, profile)),
        ("pairwise", profile) => Some((Combination::Pairwise, profile)),
        ("cardinal", Profile::Harmonic) => Some((Combination::Cardinal, profile)),
        _ => None,
    }
}

/// The ranges of so many feet, or their sizes; the range 0 for all where there are neither.
fn ranges(fields: &Fields<'_>, count: usize) -> Result<Vec<Range>, Flaw> {
    let (by_range, by_size) = (fields.get("ranges"), fields.get("sizes"));
    let is_size = by_size.is_some();
    if let (Some(_), Some(item)) = (&by_range, &by_size) {
        return Err(item.flaw("sizes stand beside ranges"));
    }
    let Some(item) = by_range.or(by_size) else { return Ok(vec![Range::default(); count]) };
    let list = item.list()?;
    if list.len() != count {
        return Err(item.flaw(format!("{} ranges for {count} feet", list.len())));
    }
    let read = |item: Item<'_>| {
        let number = item.number()?;
        let range = if is_size { Range::of_size(number) } else { Range::new(number) };
        range.map_err(|reason| item.flaw(reason.to_string()))
    };
    list.map(read).collect()
}

fn check_several(
    fields: &Fields<'_>,
    mut surface: Displacements,
    settings: Settings,
    by: Tolerance,
    report: &mut Report,
) -> Result<(), Flaw> {
    let Some(settings) = blended(fields, settings, report)? else { return Ok(()) };
    let feet = fields.need("feet")?;
    let vertices: Vec<Item<'_>> = feet.list()?.collect();
    let displacements: Vec<Item<'_>> = fields.need("displacements")?.list()?.collect();
    if displacements.len() != vertices.len() {
        return Err(feet.flaw(format!("{} feet, {} displacements", vertices.len(), displacements.len())));
    }
    let ranges = ranges(fields, vertices.len())?;
    for ((foot, displacement), range) in vertices.iter().zip(&displacements).zip(ranges) {
        let vertex = foot.index(surface.domain().len(), "vertex")?;
        let item = Displaced::foot(vertex, displacement.vector()?).with_range(range);
        surface.add(item).map_err(|reason| foot.flaw(reason.to_string()))?;
    }
    let names: Vec<&str> = fields.names().filter(|name| name.ends_with("_offsets")).collect();
    for name in names {
        // One that is not known stays unread, and is told at the end.
        let Some((combination, profile)) = offsets_named(name) else { continue };
        let item = fields.need(name)?;
        let outcome = surface
            .set_settings(Settings { combination, profile, ..settings })
            .and_then(|()| surface.offsets());
        let offsets = match outcome {
            Ok(offsets) => offsets,
            Err(reason) => {
                report.pass_over(&item.place, &reason.to_string());
                continue;
            }
        };
        let list = recorded(item.list_of(offsets.len(), "offsets", "vertices"), report);
        for (item, found) in list.into_iter().flatten().zip(&offsets) {
            let Some(offset) = recorded(item.vector(), report) else { continue };
            let deviation = (offset - *found).abs().max_element();
            report.judge(name, &item.place, deviation, by.absolute);
        }
    }
    Ok(())
}

//! The names of the rules by which a surface over a cage is built: the same in reference files and on the command line.

use ductile_patch::cage::{Blend, Boundary, Map, Split};

/// The map of that name.
pub(crate) fn map_named(name: &str) -> Option<Map> {
    match name {
        "rational" => Some(Map::Rational),
        "smooth" => Some(Map::Smooth),
        _ => None,
    }
}

/// `hermite k=2`, `bump k=1`, `erbs`; a colon may stand for ` k=`, and a bump without a number is that of exponent 1.
pub(crate) fn blend_named(name: &str) -> Option<Blend> {
    let (kind, order) = match name.split_once([' ', ':']) {
        None => (name, None),
        Some((kind, order)) => {
            let order = order.trim();
            (kind, Some(order.strip_prefix("k=").unwrap_or(order).trim().parse().ok()?))
        }
    };
    match (kind, order) {
        ("hermite", order) => Some(Blend::Hermite(order.unwrap_or(2))),
        ("bump", order) => Some(Blend::Bump(order.unwrap_or(1))),
        ("erbs" | "expo-rational", None) => Some(Blend::Erbs),
        _ => None,
    }
}

/// The split of that name.
pub(crate) fn split_named(name: &str) -> Option<Split> {
    match name {
        "none" => Some(Split::None),
        "linear" => Some(Split::Linear),
        "offset" => Some(Split::Offset),
        "catmull-clark" => Some(Split::CatmullClark),
        _ => None,
    }
}

/// The rule at a boundary of that name.
pub(crate) fn boundary_named(name: &str) -> Option<Boundary> {
    match name {
        "linear" => Some(Boundary::Linear),
        "borrow" => Some(Boundary::Borrow),
        _ => None,
    }
}

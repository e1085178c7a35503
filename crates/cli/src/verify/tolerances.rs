//! The tolerances that a reference file states for itself, each within reason.

use super::reader::{Fields, Flaw};
use super::report::Report;

/// A tolerance with its name in the file, what it is when the file is silent, and the most that makes sense.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stated {
    pub(crate) name: &'static str,
    pub(crate) default: f64,
    pub(crate) most: f64,
}

/// Reads the field `tolerance`; see [`read_in`].
pub(crate) fn read<const N: usize>(
    file: &Fields<'_>,
    known: [Stated; N],
    report: &mut Report,
) -> Result<[f64; N], Flaw> {
    read_in(file, "tolerance", known, report)
}

/// Reads the tolerances in a field. One that is not positive, or so wide that anything would pass, is a flaw of the file.
pub(crate) fn read_in<const N: usize>(
    file: &Fields<'_>,
    field: &str,
    known: [Stated; N],
    report: &mut Report,
) -> Result<[f64; N], Flaw> {
    let Some(item) = file.get(field) else { return Ok(known.map(|stated| stated.default)) };
    let fields = item.fields()?;
    let mut values = [0.0; N];
    for (value, stated) in values.iter_mut().zip(known) {
        *value = stated.default;
        if let Some(item) = fields.get(stated.name) {
            *value = item.number()?;
            if !(*value > 0.0 && *value <= stated.most) {
                return Err(
                    item.flaw(format!("{value} is no sensible tolerance: above 0, at most {}", stated.most))
                );
            }
        }
    }
    fields.finish(report);
    Ok(values)
}

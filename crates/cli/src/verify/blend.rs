//! Reference files of blend functions: tables of values on [0, 1], and of the range that widens them.

use super::reader::{Fields, Flaw, Item, recorded};
use super::report::{Report, Tolerance};
use super::tolerances::{self, Stated};
use ductile_patch::{Blend, BlendFunction, Erbs, Range};

const STATED: [Stated; 2] = [
    Stated { name: "erbs", default: 1e-12, most: 1e-6 },
    Stated { name: "others", default: 1e-12, most: 1e-6 },
];

/// What a column of the table holds.
enum Column {
    Parameter,
    Erbs,
    Slope(Box<BlendFunction>),
    Value(Box<BlendFunction>),
    Unknown,
}

/// The blend of that name: `erbs`, `bump_k2`, `eta_delta_0.1`.
pub(super) fn blend_named(name: &str) -> Option<Blend> {
    let number = |prefix: &str| name.strip_prefix(prefix)?.trim_start_matches('_').parse().ok();
    match name {
        "erbs" => Some(Blend::Erbs),
        _ => number("bump_k").map(Blend::Bump).or_else(|| number("eta_delta").map(Blend::Eta)),
    }
}

fn column(name: &str) -> Column {
    let function =
        |name: &str| blend_named(name).and_then(|blend| BlendFunction::new(blend).ok()).map(Box::new);
    match (name, name.strip_suffix("_derivative")) {
        ("t", _) => Column::Parameter,
        ("erbs", _) => Column::Erbs,
        (_, Some(of)) => function(of).map_or(Column::Unknown, Column::Slope),
        _ => function(name).map_or(Column::Unknown, Column::Value),
    }
}

/// Checks a whole file.
pub(crate) fn check(file: &Fields<'_>, report: &mut Report) -> Result<(), Flaw> {
    let by = tolerances::read(file, STATED, report)?.map(Tolerance::absolute);
    let erbs = Erbs::new();
    if let Some(item) = file.get("inv_phi1") {
        // With more digits than a number has, it is a text.
        let spelled =
            item.text().ok().and_then(|text| text.trim().parse().ok()).filter(|x: &f64| x.is_finite());
        if let Some(number) = recorded(spelled.map_or_else(|| item.number(), Ok), report) {
            // The scale in the slope, and how far its integral is from what the scale is for.
            let found = Erbs::derivative(0.5) * 0.5 / erbs.exact(0.5);
            report.compare("inv_phi1", &item.place, number, found, by[0]);
        }
    }
    if let Some(table) = Table::read(file, "columns", "rows", report)? {
        check_blends(&table, &erbs, by, report)?;
    }
    if let Some(table) = Table::read(file, "range_columns", "range_rows", report)? {
        check_ranges(&table, by[1], report)?;
    }
    Ok(())
}

/// Rows of numbers under names.
struct Table<'a> {
    columns: Item<'a>,
    names: Vec<(&'a str, Item<'a>)>,
    rows: Vec<Vec<Item<'a>>>,
}

impl<'a> Table<'a> {
    fn read(file: &Fields<'a>, columns: &str, rows: &str, report: &mut Report) -> Result<Option<Self>, Flaw> {
        if !file.has(columns) && !file.has(rows) {
            return Ok(None);
        }
        let mut names: Vec<(&str, Item<'_>)> = Vec::new();
        let columns = file.need(columns)?;
        for item in columns.list()? {
            let name = item.text()?;
            if names.iter().any(|(other, _)| *other == name) {
                return Err(item.flaw(format!("there are two columns `{name}`")));
            }
            names.push((name, item));
        }
        let mut read = Vec::new();
        for row in file.need(rows)?.list()? {
            let numbers = recorded(row.list_of(names.len(), "numbers", "columns"), report);
            read.extend(numbers.map(Iterator::collect));
        }
        Ok(Some(Self { columns, names, rows: read }))
    }

    fn column(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|(known, _)| *known == name)
    }

    fn need(&self, name: &str) -> Result<usize, Flaw> {
        self.column(name).ok_or_else(|| self.columns.flaw(format!("no column is called `{name}`")))
    }
}

fn check_blends(
    table: &Table<'_>,
    erbs: &Erbs,
    [tight, others]: [Tolerance; 2],
    report: &mut Report,
) -> Result<(), Flaw> {
    let parameter = table.need("t")?;
    for (at, (name, item)) in table.names.iter().enumerate() {
        let column = column(name);
        for row in &table.rows {
            let t = row[parameter].number()?;
            let Some(number) = recorded(row[at].number(), report) else { continue };
            let (found, by) = match &column {
                Column::Erbs => (erbs.exact(t), tight),
                Column::Slope(function) if function.blend() == Blend::Erbs => (function.derivative(t), tight),
                Column::Slope(function) => (function.derivative(t), others),
                Column::Value(function) => (function.value(t), others),
                Column::Parameter | Column::Unknown => continue,
            };
            report.compare(name, &row[at].place, number, found, by);
        }
        if matches!(column, Column::Unknown) {
            report.pass_over(&item.place, &format!("no blend function is called `{name}`"));
        }
    }
    Ok(())
}

fn check_ranges(table: &Table<'_>, by: Tolerance, report: &mut Report) -> Result<(), Flaw> {
    let (ranges, sizes, parameter) = (table.column("r"), table.column("s"), table.need("t")?);
    let by_range = ranges.is_some();
    let Some(given) = ranges.or(sizes) else {
        table.need("r")?;
        return Ok(());
    };
    for (at, (name, item)) in table.names.iter().enumerate() {
        if at == given || at == parameter {
            continue;
        }
        if *name != "R" {
            report.pass_over(&item.place, &format!("no function of ranges is called `{name}`"));
        }
        for row in &table.rows {
            let (reach, t) = (row[given].number()?, row[parameter].number()?);
            let Some(number) = recorded(row[at].number(), report) else { continue };
            let range = if by_range { Range::new(reach) } else { Range::of_size(reach) };
            let range = range.map_err(|reason| row[given].flaw(reason.to_string()))?;
            if *name == "R" {
                report.compare("R", &row[at].place, number, range.apply(t), by);
            }
        }
    }
    Ok(())
}

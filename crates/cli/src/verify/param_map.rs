//! Reference files of parameter maps: where squares are mapped to in the kites of regular polygons, with derivatives.

use super::reader::{Fields, Flaw, Item, recorded};
use super::report::{Report, Tolerance};
use super::rules::map_named;
use super::tolerances::{self, Stated};
use ductile_patch::cage::{KitePoint, MOST_VALENCE, kite};

const STATED: [Stated; 2] = [
    Stated { name: "value", default: 1e-13, most: 1e-6 },
    Stated { name: "derivative", default: 1e-11, most: 1e-5 },
];

/// What a column holds.
#[derive(Clone, Copy, PartialEq)]
enum Column {
    U,
    V,
    Value(usize),
    First(usize, usize),
    Second(usize, usize),
}

/// Names of all columns; second derivatives are written as `d2x_du2`, `d2x_dudv`, `d2x_dv2`.
const COLUMNS: [(&str, Column); 14] = [
    ("u", Column::U),
    ("v", Column::V),
    ("x", Column::Value(0)),
    ("y", Column::Value(1)),
    ("dx_du", Column::First(0, 0)),
    ("dy_du", Column::First(0, 1)),
    ("dx_dv", Column::First(1, 0)),
    ("dy_dv", Column::First(1, 1)),
    ("d2x_du2", Column::Second(0, 0)),
    ("d2y_du2", Column::Second(0, 1)),
    ("d2x_dudv", Column::Second(1, 0)),
    ("d2y_dudv", Column::Second(1, 1)),
    ("d2x_dv2", Column::Second(2, 0)),
    ("d2y_dv2", Column::Second(2, 1)),
];

impl Column {
    /// The number of this column, or why there is none.
    fn of(self, at: &KitePoint) -> Result<f64, &'static str> {
        match self {
            Self::Value(k) => Ok(at.point[k]),
            Self::First(by, k) => Ok([at.du, at.dv][by][k]),
            Self::Second(by, k) => {
                at.second.map(|second| second[by][k]).ok_or("there are no second derivatives at the origin")
            }
            Self::U | Self::V => Err("a parameter is no result"),
        }
    }
}

/// Checks a whole file.
pub(crate) fn check(file: &Fields<'_>, report: &mut Report) -> Result<(), Flaw> {
    let tolerance = tolerances::read(file, STATED, report)?;
    for item in file.need("maps")?.list()? {
        let fields = item.fields()?;
        check_map(&fields, tolerance, report)?;
        fields.finish(report);
    }
    Ok(())
}

fn check_map(fields: &Fields<'_>, tolerance: [f64; 2], report: &mut Report) -> Result<(), Flaw> {
    let sides = fields.need("n")?;
    let n = sides.index(MOST_VALENCE + 1, "number of sides")?;
    if n < 3 {
        return Err(sides.flaw("a polygon has 3 sides at least"));
    }
    let name = fields.need("map")?;
    let Some(map) = map_named(name.text()?) else {
        report.pass_over(&name.place, "no map of that name is known");
        // The rest is of that map.
        let _ = (fields.get("columns"), fields.get("rows"));
        return Ok(());
    };
    let columns = columns(&fields.need("columns")?, report)?;
    let place_of = |wanted| columns.iter().position(|&(_, column)| column == Some(wanted));
    let (Some(at_u), Some(at_v)) = (place_of(Column::U), place_of(Column::V)) else {
        return Err(fields.need("columns")?.flaw("columns `u` and `v` are needed"));
    };
    let word = name.text()?;
    for row in fields.need("rows")?.list()? {
        let Some(items) = recorded(row.list_of(columns.len(), "numbers", "columns"), report) else {
            continue;
        };
        let items: Vec<Item<'_>> = items.collect();
        let (u, v) = (items[at_u].number()?, items[at_v].number()?);
        let at = kite(map, n, u, v).ok_or_else(|| row.flaw("the parameters lie outside [0, 1]"))?;
        for (item, &(name, column)) in items.iter().zip(&columns) {
            let Some(column) = column.filter(|column| !matches!(column, Column::U | Column::V)) else {
                continue;
            };
            let by = tolerance[usize::from(!matches!(column, Column::Value(_)))];
            let Some(number) = recorded(item.number(), report) else { continue };
            match column.of(&at) {
                Ok(found) => {
                    let quantity = format!("{word}: {name}");
                    report.compare(&quantity, &item.place, number, found, Tolerance::absolute(by));
                }
                Err(reason) => report.pass_over(&item.place, reason),
            }
        }
    }
    Ok(())
}

fn columns<'a>(item: &Item<'a>, report: &mut Report) -> Result<Vec<(&'a str, Option<Column>)>, Flaw> {
    let mut columns: Vec<(&str, Option<Column>)> = Vec::new();
    for item in item.list()? {
        let name = item.text()?;
        if columns.iter().any(|&(known, _)| known == name) {
            return Err(item.flaw(format!("column `{name}` is given twice")));
        }
        let known = COLUMNS.iter().find(|(known, _)| *known == name).map(|&(_, column)| column);
        if known.is_none() {
            report.pass_over(&item.place, "no such column is known");
        }
        columns.push((name, known));
    }
    Ok(columns)
}

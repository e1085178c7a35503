//! `ductile seams`: how well the surfaces of a specification meet along the curves that they share, at rest.

use crate::input::{self, CliError};
use ductile_modeler::Modeler;
use ductile_spec::{CurveStretch, FillFigures, Request, SeamFigures, Step};
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

/// Options of `seams`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Spec file, or - for standard input
    spec: PathBuf,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
    /// Most steps before giving up
    #[arg(long, default_value_t = 2000)]
    steps: u32,
}

/// Conjugate-gradient iterations of a step.
const ITERATIONS: u32 = 20;

/// Relaxes and prints.
pub(crate) fn run(options: &Options) -> Result<ExitCode, CliError> {
    let refuse = |reason| CliError::Refused { file: options.spec.clone(), reason };
    let (text, _) = input::document(&options.spec)?;
    let mut modeler = Modeler::new();
    let reply = modeler.handle(Request::OpenText { text });
    if let Some(refusal) = reply.refused {
        return Err(refuse(refusal.reason));
    }
    let mut settled = reply.frame.settled;
    for _ in 0..options.steps {
        if settled {
            break;
        }
        settled = modeler.handle(Request::Step(Step { drag: None, iterations: ITERATIONS })).frame.settled;
    }
    let seams = modeler.handle(Request::Seams).seams.unwrap_or_default();
    let text = if options.json {
        serde_json::to_string_pretty(&seams).map_err(|e| CliError::Option(e.to_string()))? + "\n"
    } else {
        seams.seams.iter().map(seam_line).chain(seams.fills.iter().map(fill_line)).collect()
    };
    input::write("-".as_ref(), &text)?;
    if !settled {
        eprintln!("ductile: not at rest after {} steps", options.steps);
        return Ok(ExitCode::from(1));
    }
    Ok(ExitCode::SUCCESS)
}

fn seam_line(seam: &SeamFigures) -> String {
    let CurveStretch { curve, from, to } = seam.stretch;
    let [one, other] = seam.surfaces;
    let mut line = format!(
        "{one} and {other} along {curve} from {from} to {to}: gap {:.3e}, angle {:.4}°, curvature jump {:.3e}",
        seam.gap, seam.angle, seam.curvature_jump
    );
    if seam.without_normal > 0 {
        // Writing to a String cannot fail, so the result is dropped.
        let _ = write!(line, ", {} of {} places without a normal", seam.without_normal, seam.places);
    }
    if seam.without_curvature > seam.without_normal {
        // As above.
        let _ = write!(line, ", {} of {} left out of the curvature", seam.without_curvature, seam.places);
    }
    line + "\n"
}

fn fill_line(fill: &FillFigures) -> String {
    let FillFigures { surface, sides, degree, curve_deviation, plane_deviation, .. } = fill;
    let mut line = format!(
        "{surface} fills {sides} sides with degree {degree}: curves met to {curve_deviation:.3e}, planes to {plane_deviation:.4}°"
    );
    if let Some(side) = fill.turned_out {
        // As above.
        let _ = write!(
            line,
            "; it folds over itself where side {side} begins, since the hole turns outwards there"
        );
    }
    if let Some(why) = &fill.stuck {
        // As above.
        let _ = write!(line, "; it does not follow: {why}");
    }
    line + "\n"
}

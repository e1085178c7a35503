//! `ductile run`: does the acts of a script, one after the other, as the page would.

use crate::input::{self, CliError};
use crate::script::{self, Entry};
use crate::solve::{SurfaceReport, surface_reports};
use ductile_modeler::Modeler;
use ductile_spec::{
    Document, ExportFormat, FrameHeader, ImportAs, MAX_TEXT_BYTES, Reply, Request, Step, Structure, to_text,
};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

/// Options of `run`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Script file: a JSON list of acts, or - for standard input
    script: PathBuf,
    /// Spec file to begin with, or polygons as an OBJ or PLY file, instead of an empty document
    #[arg(long, value_name = "SPEC")]
    from: Option<PathBuf>,
    /// What the polygons of --from become; left out, many triangles are a mesh, all else is a cage
    #[arg(long = "as", value_name = "KIND", requires = "from")]
    import: Option<Import>,
    /// Spec file to write, or - for standard output
    #[arg(short, long, value_name = "OUT.ductile.json")]
    out: Option<PathBuf>,
    /// OBJ file to write
    #[arg(long, value_name = "OUT.obj")]
    obj: Option<PathBuf>,
    /// Print what each act made, and the result, to standard output
    #[arg(long)]
    json: bool,
    /// Most steps of one "rest" before giving up
    #[arg(long, default_value_t = 2000)]
    steps: u32,
    /// Conjugate-gradient iterations that a step may spend
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    iterations: u32,
}

/// What polygons become.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Import {
    /// A cage, with an exact surface over it
    Cage,
    /// A fixed mesh
    Mesh,
}

impl Import {
    fn meant(self) -> ImportAs {
        match self {
            Self::Cage => ImportAs::Cage,
            Self::Mesh => ImportAs::Mesh,
        }
    }
}

#[derive(Serialize)]
struct Report {
    acts: Vec<ActReport>,
    /// The number of the act that was refused, from 1.
    refused: Option<usize>,
    at_rest: bool,
    nodes: u32,
    energy: f64,
    surfaces: Vec<SurfaceReport>,
}

#[derive(Serialize)]
struct ActReport {
    act: String,
    #[serde(skip_serializing_if = "Things::is_empty")]
    made: Things,
    #[serde(skip_serializing_if = "Things::is_empty")]
    gone: Things,
    #[serde(skip_serializing_if = "Option::is_none")]
    steps: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    refused: Option<String>,
}

/// Identities by kind.
#[derive(Default, Serialize)]
struct Things {
    #[serde(skip_serializing_if = "Vec::is_empty")]
    points: Vec<u32>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    curves: Vec<u32>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    surfaces: Vec<u32>,
}

impl Things {
    fn is_empty(&self) -> bool {
        self.points.is_empty() && self.curves.is_empty() && self.surfaces.is_empty()
    }

    /// What the first document has and the second has not.
    fn only_in(one: &Document, other: &Document) -> Self {
        Self {
            points: missing(&one.points, &other.points, |id| id.0),
            curves: missing(&one.curves, &other.curves, |id| id.0),
            surfaces: missing_surfaces(one, other),
        }
    }
}

fn missing<K: Ord, V, W>(
    one: &BTreeMap<K, V>,
    other: &BTreeMap<K, W>,
    number: impl Fn(&K) -> u32,
) -> Vec<u32> {
    one.keys().filter(|id| !other.contains_key(id)).map(number).collect()
}

fn missing_surfaces(one: &Document, other: &Document) -> Vec<u32> {
    let all = |document: &Document| -> Vec<u32> {
        let fair = document.surfaces.keys();
        let exact = document.cages.keys().chain(document.fills.keys());
        let mut all: Vec<u32> = fair.chain(exact).chain(document.meshes.keys()).map(|id| id.0).collect();
        all.sort_unstable();
        all
    };
    let there = all(other);
    all(one).into_iter().filter(|id| there.binary_search(id).is_err()).collect()
}

/// A modeler at work on a script.
struct Session {
    modeler: Modeler,
    structure: Structure,
    frame: FrameHeader,
}

impl Session {
    /// Asks; a refusal says why.
    fn ask(&mut self, request: Request) -> Result<Reply, String> {
        let mut reply = self.modeler.handle(request);
        self.frame = reply.frame.clone();
        self.structure = reply.structure.take().unwrap_or_else(|| std::mem::take(&mut self.structure));
        match reply.refused.take() {
            Some(refusal) => Err(refusal.reason),
            None => Ok(reply),
        }
    }

    fn document(&self) -> Document {
        (*self.modeler.model().document).clone()
    }

    /// Relaxes until nothing moves. Returns the steps that it took.
    fn rest(&mut self, options: &Options) -> Result<u32, String> {
        for taken in 0..options.steps {
            if self.frame.settled {
                return Ok(taken);
            }
            self.ask(Request::Step(Step { drag: None, iterations: options.iterations }))?;
        }
        if self.frame.settled {
            return Ok(options.steps);
        }
        let residual = self.frame.figures.residual;
        Err(format!("not at rest after {} steps (residual {residual:.2e})", options.steps))
    }

    fn perform(&mut self, entry: &Entry, options: &Options) -> Result<Option<u32>, String> {
        match entry {
            Entry::Rest => return self.rest(options).map(Some),
            Entry::Act(_, edit) => self.ask(Request::Edit((**edit).clone()))?,
            Entry::Undo => self.ask(Request::Undo)?,
            Entry::Redo => self.ask(Request::Redo)?,
        };
        Ok(None)
    }
}

/// Runs, writes, reports.
pub(crate) fn run(options: &Options) -> Result<ExitCode, CliError> {
    let is_stdout = |file: &Option<PathBuf>| file.as_ref().is_some_and(|file| file.as_os_str() == "-");
    if [options.json, is_stdout(&options.out), is_stdout(&options.obj)].iter().filter(|x| **x).count() > 1 {
        return Err(CliError::Option("only one result can go to standard output".into()));
    }
    let refuse = |file: &PathBuf, reason: String| CliError::Refused { file: file.clone(), reason };
    let script = script::parse(&input::read(&options.script)?)
        .map_err(|error| refuse(&options.script, error.to_string()))?;
    let mut session =
        Session { modeler: Modeler::new(), structure: Structure::default(), frame: FrameHeader::default() };
    if let Some(spec) = &options.from {
        let request = match input::import_format(spec) {
            Some(format) => {
                let bytes = input::bytes_up_to(spec, MAX_TEXT_BYTES)?;
                Request::Import { format, bytes, into: options.import.map(Import::meant) }
            }
            None => Request::OpenText { text: input::document(spec)?.0 },
        };
        session.ask(request).map_err(|reason| refuse(spec, reason))?;
    }
    let (acts, failed) = perform(&mut session, &script, options);
    if options.json {
        let report = report(&session, acts, failed.as_ref().map(|(number, _)| *number));
        let text = serde_json::to_string_pretty(&report).map_err(|e| CliError::Option(e.to_string()))?;
        input::write("-".as_ref(), &(text + "\n"))?;
    }
    if let Some((number, reason)) = failed {
        eprintln!("ductile: act {number} ({}): {reason}", script[number - 1].name());
        return Ok(ExitCode::from(1));
    }
    if let Some(out) = &options.out {
        input::write(out, &to_text(&session.document()))?;
    }
    if let Some(obj) = &options.obj {
        let exported = session.ask(Request::Export(ExportFormat::Obj));
        let exported = exported.map_err(|reason| refuse(obj, reason))?.exported;
        input::write(obj, &exported.map(|file| file.text).unwrap_or_default())?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Performs a script up to its end or to the first refusal: its number and its reason.
fn perform(
    session: &mut Session,
    script: &[Entry],
    options: &Options,
) -> (Vec<ActReport>, Option<(usize, String)>) {
    let mut acts = Vec::with_capacity(script.len());
    for (entry, number) in script.iter().zip(1..) {
        let before = session.document();
        let done = session.perform(entry, options);
        let after = session.document();
        acts.push(ActReport {
            act: entry.name().to_owned(),
            made: Things::only_in(&after, &before),
            gone: Things::only_in(&before, &after),
            steps: done.clone().ok().flatten(),
            refused: done.clone().err(),
        });
        if let Err(reason) = done {
            return (acts, Some((number, reason)));
        }
    }
    (acts, None)
}

fn report(session: &Session, acts: Vec<ActReport>, refused: Option<usize>) -> Report {
    let figures = session.frame.figures;
    Report {
        acts,
        refused,
        at_rest: session.frame.settled,
        nodes: figures.nodes,
        energy: figures.energy,
        surfaces: surface_reports(&session.structure),
    }
}

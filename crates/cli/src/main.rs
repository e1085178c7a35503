//! `ductile`: the modeler without a window. Specification in, mesh and numbers out.
//!
//! Exit status: 0 when it worked, 1 when the shape did not come to rest, an act of a script was refused or a reference file
//! is not verified, 2 when the input or the command is bad.
//! Results go to standard output or files, everything else to standard error.

mod cage;
mod check;
mod dehydrate;
mod displace;
mod fill;
mod input;
mod link;
mod ribbon_file;
mod run;
mod samples;
mod script;
mod seams;
mod solve;
mod verify;

use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// Fair surfaces from control specifications, headless.
#[derive(Debug, Parser)]
#[command(name = "ductile", version, about, disable_help_subcommand = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Relax a specification to rest and write the mesh
    Solve(solve::Options),
    /// Check that a file is a specification that can be built
    Check {
        /// Spec file, or - for standard input
        file: PathBuf,
    },
    /// Do the acts of a script and write the document, the mesh or a report
    Run(run::Options),
    /// Lay a smooth surface over a cage of polygons and write the mesh
    Cage(cage::Options),
    /// Fill holes between ribbons with S-patches and write the mesh
    Fill(fill::Options),
    /// Move points and curves of a mesh, and the surface around them smoothly
    Displace(displace::Options),
    /// Write the least meshes of a model, or what they grow to again at an edge length
    Dehydrate(dehydrate::Options),
    /// Tell how well surfaces meet along the curves that they share
    Seams(seams::Options),
    /// Print the share link of a specification
    Link {
        /// Spec file, or - for standard input
        spec: PathBuf,
        /// Address of the page, put before the link
        #[arg(long, default_value = "")]
        base: String,
    },
    /// Print the specification that a share link holds
    Unlink {
        /// A link, a fragment, or - for standard input
        link: String,
    },
    /// Compute the figures of reference files again and compare
    Verify(verify::Options),
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match arguments.command {
        Command::Solve(options) => solve::run(&options),
        Command::Run(options) => run::run(&options),
        Command::Check { file } => check::run(&file).map(|()| ExitCode::SUCCESS),
        Command::Cage(options) => cage::run(&options),
        Command::Fill(options) => fill::run(&options),
        Command::Displace(options) => displace::run(&options),
        Command::Dehydrate(options) => dehydrate::run(&options),
        Command::Link { spec, base } => link::link(&spec, &base).map(|()| ExitCode::SUCCESS),
        Command::Seams(options) => seams::run(&options),
        Command::Verify(options) => verify::run(&options),
        Command::Unlink { link } => link::unlink(&link).map(|()| ExitCode::SUCCESS),
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("ductile: {error}");
        ExitCode::from(2)
    })
}

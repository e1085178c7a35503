//! The workshop: everything that is done *to* the project rather than by it.
//!
//! `cargo xtask serve` builds the page and serves it, `cargo xtask test` runs every test; both first install what they
//! lack. The other commands are the checks that CI makes. `cargo xtask` alone prints the list.

#![allow(clippy::print_stdout, reason = "a command-line program talks on standard output")]
#![allow(
    clippy::disallowed_methods,
    reason = "the bans on clocks and threads are for code that must run in wasm"
)]

mod ci;
mod layers;
mod place;
mod project;
mod shell;
mod sizes;
mod tally;
mod test;
mod tools;
mod wasm;
mod web;

use std::process::ExitCode;

const HELP: &str = "\
cargo xtask COMMAND

  serve [--release] [--port N] [--open]   build the page and serve it; rebuild on every change
  test [--quick]                          run every test; --quick leaves out the browser
  test native|wasm|page ...               run only the tests of that kind
  web                                     build the page for release into dist and report its size
  doctor                                  say which tools are missing, and how to get them
  tools                                   install the tools that are missing
  layers                                  check who may depend on whom
  sizes                                   check the length of the source files
  ci                                      format, lints, documentation, layers, sizes, then test
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let outcome = match arguments.split_first() {
        Some((&"serve", options)) => {
            web::ServeOptions::parse(options).and_then(|options| web::serve(&options))
        }
        Some((&"test", options)) => test::run(options),
        Some((&"web", [])) => web::release(),
        Some((&"doctor", [])) => tools::doctor(),
        Some((&"tools", [])) => tools::ensure(tools::ALL).map(drop),
        Some((&"layers", [])) => layers::run(),
        Some((&"sizes", [])) => sizes::run(),
        Some((&"ci", [])) => ci::run(),
        None | Some((&("help" | "--help" | "-h"), _)) => {
            print!("{HELP}");
            Ok(())
        }
        Some(_) => Err(format!("`{}` is not understood\n\n{HELP}", arguments.join(" "))),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        // An empty message: the failure has been reported already and the last line must stay the last.
        Err(message) if message.is_empty() => ExitCode::FAILURE,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}

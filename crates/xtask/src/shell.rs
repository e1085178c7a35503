//! Running other programs: silently for an answer, or with everything they say passed on line by line.

use crate::place;
use std::env;
use std::ffi::OsStr;
use std::io::{self, BufRead, BufReader};
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

/// How long to listen on after a program has ended: a browser it left behind may hold the pipe open for ever.
const AFTERMATH: Duration = Duration::from_secs(2);

/// A program to run at the top of the repository, with our tools before the machine's own.
#[derive(Debug)]
pub(crate) struct Run {
    command: Command,
    name: String,
}

impl Run {
    pub(crate) fn new(program: impl AsRef<OsStr>) -> Self {
        let program = program.as_ref();
        let mut command = Command::new(resolve(program));
        let path = env::join_paths(place::search_path()).unwrap_or_default();
        command.current_dir(place::root()).env("PATH", path).stdin(Stdio::null());
        Self { command, name: program.to_string_lossy().into_owned() }
    }

    /// The cargo that runs us.
    pub(crate) fn cargo() -> Self {
        Self::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
    }

    /// The same at low priority where the system has `nice`: for work that something else should not wait for.
    pub(crate) fn patient_cargo() -> Self {
        let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        match place::program("nice") {
            Some(nice) => Self::new(nice).args(["-n", "10"]).args([cargo]),
            None => Self::new(cargo),
        }
    }

    pub(crate) fn args<S: AsRef<OsStr>>(mut self, args: impl IntoIterator<Item = S>) -> Self {
        self.command.args(args);
        self
    }

    pub(crate) fn env(mut self, name: &str, value: impl AsRef<OsStr>) -> Self {
        self.command.env(name, value);
        self
    }

    pub(crate) fn within(mut self, folder: &Path) -> Self {
        self.command.current_dir(folder);
        self
    }

    /// What the program prints on standard output, or nothing when it is absent or fails.
    pub(crate) fn answer(mut self) -> Option<String> {
        let output = self.command.stderr(Stdio::null()).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    }

    /// Run it with our own standard streams, as if it had been called from the command line.
    pub(crate) fn attached(mut self) -> Result<(), String> {
        let status = self.command.status().map_err(|error| self.not_started(&error))?;
        verdict(&self.name, status)
    }

    /// Become that program where the system can: what ends us then ends it. Returns only when it fails.
    #[cfg(unix)]
    pub(crate) fn replace(mut self) -> Result<(), String> {
        let error = std::os::unix::process::CommandExt::exec(&mut self.command);
        Err(self.not_started(&error))
    }

    #[cfg(not(unix))]
    pub(crate) fn replace(self) -> Result<(), String> {
        self.attached()
    }

    /// Run it and hand over every line of both its output streams, in order, while it runs.
    pub(crate) fn lines(mut self, mut on_line: impl FnMut(&str)) -> Result<(), String> {
        let (reader, writer) = io::pipe().map_err(|error| error.to_string())?;
        let second = writer.try_clone().map_err(|error| error.to_string())?;
        self.command.stdout(writer).stderr(second);
        let mut child = self.command.spawn().map_err(|error| self.not_started(&error))?;
        // The command owns our ends of the pipe: without them the reader sees the end.
        let Self { command, name } = self;
        drop(command);

        let (sender, receiver) = mpsc::channel();
        thread::spawn(move || {
            for line in BufReader::new(reader).split(b'\n').map_while(Result::ok) {
                let line = String::from_utf8_lossy(&line).trim_end().to_owned();
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
        loop {
            match receiver.recv_timeout(AFTERMATH) {
                Ok(line) => on_line(&line),
                Err(RecvTimeoutError::Disconnected) => break,
                Err(RecvTimeoutError::Timeout) => {
                    if child.try_wait().map_err(|error| error.to_string())?.is_some() {
                        break;
                    }
                }
            }
        }
        verdict(&name, child.wait().map_err(|error| error.to_string())?)
    }

    fn not_started(&self, error: &io::Error) -> String {
        format!("cannot start {}: {error}", self.name)
    }
}

/// `Command` would search the path of this process, not the one given to the child.
fn resolve(program: &OsStr) -> std::path::PathBuf {
    let bare = program.to_str().filter(|name| !name.contains(['/', '\\']));
    bare.and_then(place::program).unwrap_or_else(|| program.into())
}

fn verdict(name: &str, status: ExitStatus) -> Result<(), String> {
    if status.success() { Ok(()) } else { Err(format!("{name} ended with {status}")) }
}

/// Announce a step, do it, and say how long it took when that was noticeable.
pub(crate) fn step<T>(title: &str, work: impl FnOnce() -> T) -> T {
    println!("\n== {title}");
    let start = Instant::now();
    let outcome = work();
    let seconds = start.elapsed().as_secs();
    if seconds > 0 {
        println!("== {title}: {seconds} s");
    }
    outcome
}

#[cfg(test)]
mod tests {
    use super::Run;

    #[test]
    fn both_streams_are_heard_and_failure_is_told() {
        let mut heard = Vec::new();
        let outcome = Run::cargo().args(["--version"]).lines(|line| heard.push(line.to_owned()));
        assert_eq!(outcome, Ok(()));
        assert!(heard[0].starts_with("cargo "));

        heard.clear();
        let outcome = Run::cargo().args(["no-such-command"]).lines(|line| heard.push(line.to_owned()));
        assert!(outcome.is_err());
        assert!(!heard.is_empty());
    }

    #[test]
    fn what_is_absent_does_not_answer() {
        assert_eq!(Run::new("no-such-program-anywhere").answer(), None);
        assert!(Run::new("no-such-program-anywhere").attached().is_err());
    }
}

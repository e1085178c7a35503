//! Building and serving the page.

use crate::place;
use crate::shell::{Run, step};
use crate::tools;
use std::fs;
use std::path::Path;
use std::thread;

/// The page with everything it loads, compressed as a server would: what a first visit costs.
/// wgpu for WebGPU takes about 90 kB of it, the rest is ours; the acts that cut and join surfaces brought 80, the exact
/// surfaces and displacements with the sparse factor that they need bring the rest; of that, the tools that fill, the fixed meshes
/// and the shadows took 110, the rims that lead curves, curves as feet, stretched reaches and split faces 47, weights of patches
/// with whole nets, and skeletons that are taken anew 20.
const LIMIT_KB: u64 = 1640;

/// How to serve.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct ServeOptions {
    release: bool,
    open: bool,
    port: Option<u16>,
}

impl ServeOptions {
    pub(crate) fn parse(arguments: &[&str]) -> Result<Self, String> {
        let mut options = Self::default();
        let mut rest = arguments.iter();
        while let Some(&argument) = rest.next() {
            match argument {
                "--release" => options.release = true,
                "--open" => options.open = true,
                "--port" => {
                    let port = rest.next().and_then(|port| port.parse().ok());
                    options.port = Some(port.ok_or("--port wants a number from 0 to 65535")?);
                }
                _ => return Err(format!("serve does not know `{argument}`: --release, --port N, --open")),
            }
        }
        Ok(options)
    }
}

/// Build and serve the page, and rebuild it on every change, until interrupted.
pub(crate) fn serve(options: &ServeOptions) -> Result<(), String> {
    let needs = if options.release { tools::RELEASE_PAGE } else { tools::PAGE };
    let is_ready = tools::are_ready(needs);
    thread::scope(|scope| {
        if !is_ready {
            scope.spawn(|| build_ahead(options.release));
        }
        tools::ensure(needs)
    })?;
    fetch_crates()?;
    let port = options.port.unwrap_or(8080).to_string();
    let mut arguments = vec!["serve", "--port", &port];
    arguments.extend(options.release.then_some("--release"));
    arguments.extend(options.open.then_some("--open"));
    println!("Building; the page will be at http://127.0.0.1:{port}/ (Ctrl+C ends).");
    trunk(&arguments).replace()
}

/// Compile the page's two programs, as Trunk is going to, while the tools are being installed.
///
/// Only to save time: what goes wrong here goes wrong again when Trunk builds, and is told then.
fn build_ahead(is_release: bool) {
    for program in ["viewer", "worker"] {
        let manifest = place::root().join("crates").join(program).join("Cargo.toml");
        let build = Run::patient_cargo()
            .args(["build", "--quiet", "--locked", "--target=wasm32-unknown-unknown", "--bin", program])
            .args(is_release.then_some("--release"))
            .args(["--manifest-path".as_ref(), manifest.as_os_str()]);
        if build.lines(|_| ()).is_err() {
            return;
        }
    }
}

/// Build the page for release into `dist`.
pub(crate) fn release() -> Result<(), String> {
    tools::ensure(tools::RELEASE_PAGE)?;
    let folder = place::root().join("dist");
    build(&folder)?;
    report_size(&folder)
}

/// A release build into that folder. The tools must be there.
pub(crate) fn build(folder: &Path) -> Result<(), String> {
    fetch_crates()?;
    step("build the page", || {
        trunk(&["build", "--release"]).args(["--dist".as_ref(), folder.as_os_str()]).attached()
    })
}

/// Offline: a tool that is missing is an error, not a download from somewhere.
fn trunk(arguments: &[&str]) -> Run {
    Run::new("trunk").args(arguments).env("TRUNK_OFFLINE", "true").env("NO_COLOR", "true")
}

fn fetch_crates() -> Result<(), String> {
    Run::cargo().args(["fetch", "--locked", "--quiet"]).attached()
}

/// Print the size of every file of the page, raw and compressed; an error when it grew too large.
pub(crate) fn report_size(folder: &Path) -> Result<(), String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .map_err(|error| format!("{}: {error}", folder.display()))?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    names.sort();
    println!("\n{:>10} {:>10}", "raw", "gzip -9");
    let (mut raw_sum, mut gzip_sum) = (0, 0);
    for name in &names {
        let path = folder.join(name);
        if !path.is_file() {
            continue;
        }
        let raw = fs::metadata(&path).map_err(|error| error.to_string())?.len();
        let gzip = gzip_size(&path)?;
        println!("{:>7.1} kB {:>7.1} kB  {name}", kilobytes(raw), kilobytes(gzip));
        raw_sum += raw;
        gzip_sum += gzip;
    }
    println!("{:>7.1} kB {:>7.1} kB  together, of {LIMIT_KB} kB", kilobytes(raw_sum), kilobytes(gzip_sum));
    if gzip_sum > LIMIT_KB * 1000 {
        return Err("the page has grown over its limit (crates/xtask/src/web.rs)".to_owned());
    }
    Ok(())
}

/// Node is there whenever a page was built for release, since it brought wasm-opt.
fn gzip_size(file: &Path) -> Result<u64, String> {
    const SCRIPT: &str = "console.log(require('zlib').gzipSync(require('fs').readFileSync(process.argv[1]), { level: 9 }).length)";
    let answer = Run::new("node").args(["-e", SCRIPT]).args([file]).answer();
    answer.and_then(|size| size.parse().ok()).ok_or_else(|| format!("cannot compress {}", file.display()))
}

#[expect(clippy::cast_precision_loss, reason = "file sizes, for the eye")]
fn kilobytes(bytes: u64) -> f64 {
    bytes as f64 / 1000.0
}

#[cfg(test)]
mod tests {
    use super::ServeOptions;

    #[test]
    fn serve_understands_its_options() {
        assert_eq!(ServeOptions::parse(&[]), Ok(ServeOptions::default()));
        let wanted = ServeOptions { release: true, open: false, port: Some(9000) };
        assert_eq!(ServeOptions::parse(&["--port", "9000", "--release"]), Ok(wanted));
        for wrong in [&["--port"][..], &["--port", "none"], &["--port", "70000"], &["--fast"]] {
            assert!(ServeOptions::parse(wrong).is_err(), "{wrong:?}");
        }
    }
}

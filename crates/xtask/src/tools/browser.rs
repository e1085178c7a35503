//! Chromium and its driver, for the tests only.

use super::{State, Tool, installer, version_number};
use crate::place;
use crate::shell::Run;
use serde_json::{Value, json};
use std::env;
use std::fs;
use std::io::{IsTerminal, stdin};
use std::path::{Path, PathBuf};

pub(super) const ADVICE: &str = "Fix: install Chromium (or Chrome) and the ChromeDriver of the same version; \
    the variables CHROME and CHROMEDRIVER name them when they are not on PATH.";

const BROWSERS: &[&str] =
    &["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];
const MAC_BROWSERS: &[&str] = &[
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
];

/// The browser to test with.
pub(crate) fn chromium() -> Option<PathBuf> {
    named_by("CHROME")
        .or_else(|| BROWSERS.iter().find_map(|name| place::program(name)))
        .or_else(|| MAC_BROWSERS.iter().map(PathBuf::from).find(|path| path.is_file()))
}

fn driver() -> Option<PathBuf> {
    named_by("CHROMEDRIVER").or_else(|| place::program("chromedriver"))
}

fn named_by(variable: &str) -> Option<PathBuf> {
    env::var_os(variable).map(PathBuf::from).filter(|path| path.is_file())
}

pub(super) fn state() -> State {
    let (Some(browser), Some(driver)) = (chromium(), driver()) else {
        let which = if chromium().is_none() { "no Chromium" } else { "no ChromeDriver" };
        return State::Missing(format!("{which} found"));
    };
    let (browser, driver) = (version(&browser), version(&driver));
    let major = |version: &str| version.split('.').next().map(str::to_owned);
    if major(&browser) == major(&driver) {
        State::Ready(browser)
    } else {
        State::Missing(format!("Chromium {browser} with ChromeDriver {driver}: the versions must agree"))
    }
}

fn version(program: &Path) -> String {
    let said = Run::new(program).args(["--version"]).answer().unwrap_or_default();
    version_number(&said).unwrap_or("of unknown version").to_owned()
}

/// By apt-get, where there is one and we may use it.
pub(super) fn install() -> Result<(), String> {
    if place::program("apt-get").is_none() {
        return Err("there is no apt-get on this machine".to_owned());
    }
    apt_get(&["update", "--quiet=2"])?;
    // Fonts: without any, the text of the page is drawn as boxes.
    apt_get(&[
        "install",
        "--quiet=2",
        "--yes",
        "--no-install-recommends",
        "chromium",
        "chromium-driver",
        "fonts-liberation",
    ])
}

fn apt_get(arguments: &[&str]) -> Result<(), String> {
    let is_root = Run::new("id").args(["-u"]).answer().as_deref() == Some("0");
    let command: &[&str] = match (is_root, stdin().is_terminal()) {
        (true, _) => &["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"],
        (false, true) => &["sudo", "DEBIAN_FRONTEND=noninteractive", "apt-get"],
        (false, false) => &["sudo", "--non-interactive", "DEBIAN_FRONTEND=noninteractive", "apt-get"],
    };
    installer(Tool::Browser, Run::new(command[0]).args(&command[1..]).args(arguments))
}

/// Write the settings of the wasm test runner: the flags that the end-to-end tests use too, with the browser
/// and the driver that were found. Returns the file and the driver.
pub(crate) fn webdriver() -> Result<(PathBuf, PathBuf), String> {
    let browser = chromium().ok_or("no Chromium found")?;
    let driver = driver().ok_or("no ChromeDriver found")?;
    let source = place::browser_tests().join("webdriver.json");
    let text = fs::read_to_string(&source).map_err(|error| format!("{}: {error}", source.display()))?;
    let mut settings: Value =
        serde_json::from_str(&text).map_err(|error| format!("{}: {error}", source.display()))?;
    settings["goog:chromeOptions"]["binary"] = json!(browser);
    let made = place::tools().join("webdriver.json");
    fs::create_dir_all(place::tools()).map_err(|error| error.to_string())?;
    fs::write(&made, settings.to_string()).map_err(|error| format!("{}: {error}", made.display()))?;
    Ok((made, driver))
}

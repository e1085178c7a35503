//! What the property tests have in common.

use proptest::test_runner::{Config, RngSeed};

/// How many random cases a property is tried on. In the browser there are fewer, the same ones in every run, and no
/// file in which a failure could be kept.
pub(crate) fn cases(native: u32, browser: u32) -> Config {
    if cfg!(target_arch = "wasm32") {
        Config { rng_seed: RngSeed::Fixed(1995), failure_persistence: None, ..Config::with_cases(browser) }
    } else {
        Config::with_cases(native)
    }
}

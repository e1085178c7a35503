//! The same document and the same steps give the same bits on every machine. The browser's half of this
//! test is `crates/worker/tests`; both compare with `fixtures/bits.json`, which `BLESS=1` writes anew.

use acceptance::bits_after;
use ductile_spec::Example;
use std::collections::BTreeMap;

const STEPS: u32 = 200;

#[test]
fn examples_give_the_recorded_bits_after_200_steps() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/bits.json");
    let now: BTreeMap<&str, u32> = Example::all().map(|e| (e.word(), bits_after(e, STEPS))).collect();
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(path, serde_json::to_string_pretty(&now).unwrap() + "\n").unwrap();
    }
    let text = std::fs::read_to_string(path).unwrap();
    let recorded: BTreeMap<&str, u32> = serde_json::from_str(&text).unwrap();
    assert_eq!(now, recorded);
}

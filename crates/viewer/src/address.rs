//! What an address asks for: a document in its fragment, or a spec file named by `?spec=`.

use ductile_spec::FRAGMENT_KEY;

/// What an address asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Asked {
    /// The document in the link.
    Link(String),
    /// A spec file to fetch.
    Spec(String),
    /// Nothing in particular.
    Nothing,
}

/// Reads what an address asks for from its fragment (`#…` or empty) and its query (`?…` or empty).
///
/// A fragment that looks like a document of a newer version is a link too: the refusal says so.
#[must_use]
pub fn asked(fragment: &str, query: &str) -> Asked {
    let fragment = fragment.strip_prefix('#').unwrap_or(fragment);
    if fragment.split('&').any(is_document) {
        return Asked::Link(fragment.to_owned());
    }
    let query = query.strip_prefix('?').unwrap_or(query);
    let spec = query.split('&').find_map(|part| part.strip_prefix("spec="));
    match spec.filter(|url| !url.is_empty()) {
        Some(url) => Asked::Spec(decoded(url)),
        None => Asked::Nothing,
    }
}

fn is_document(part: &str) -> bool {
    if part.starts_with(FRAGMENT_KEY) {
        return true;
    }
    let Some((key, _)) = part.split_once('=') else { return false };
    key.strip_prefix('d').is_some_and(|version| version.parse::<u32>().is_ok())
}

/// Undoes percent-encoding; what is not well encoded stays as it is.
fn decoded(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while at < bytes.len() {
        let code = text.get(at + 1..at + 3).and_then(|hex| u8::from_str_radix(hex, 16).ok());
        match (bytes[at], code) {
            (b'%', Some(byte)) => {
                out.push(byte);
                at += 3;
            }
            (b'+', _) => {
                out.push(b' ');
                at += 1;
            }
            (byte, _) => {
                out.push(byte);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn a_link_comes_before_a_spec_file() {
        assert_eq!(asked("#d1=abc", "?spec=x.json"), Asked::Link("d1=abc".into()));
        assert_eq!(asked("#view=1&d1=abc", ""), Asked::Link("view=1&d1=abc".into()));
        assert_eq!(asked("#d2=abc", ""), Asked::Link("d2=abc".into()), "the refusal names the version");
    }

    #[test]
    fn a_spec_address_is_decoded() {
        let wanted = Asked::Spec("https://a.example/b c.json?x=1&y=2".into());
        assert_eq!(asked("", "?v=1&spec=https%3A%2F%2Fa.example%2Fb+c.json%3Fx=1%26y=2"), wanted);
        assert_eq!(asked("", "?spec=%zz%4"), Asked::Spec("%zz%4".into()));
        assert_eq!(asked("", "?spec=%é"), Asked::Spec("%é".into()));
    }

    #[test]
    fn anything_else_asks_for_nothing() {
        for (fragment, query) in
            [("", ""), ("#", "?"), ("#top", "?spec="), ("#dx=1", "?specs=1"), ("#d=", "")]
        {
            assert_eq!(asked(fragment, query), Asked::Nothing, "{fragment}{query}");
        }
    }
}

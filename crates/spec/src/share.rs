//! The share link: the whole document in the fragment of an address, which browsers never send to a server.
//!
//! The fragment is `d1=` followed by the compact text (see [`crate::to_compact_text`]), compressed with
//! zlib (RFC 1950, whose checksum finds damage) and written in base64url without padding (RFC 4648).

use crate::document::Document;
use crate::text::{MAX_TEXT_BYTES, TextError, from_text, to_compact_text};
use base64::engine::general_purpose::URL_SAFE_NO_PAD;
use base64::{DecodeError, Engine as _};
use miniz_oxide::deflate::compress_to_vec_zlib;
use miniz_oxide::inflate::{TINFLStatus, decompress_to_vec_zlib_with_limit};
use thiserror::Error;

/// The key that stands before the document in a fragment; the digit is the version of the packing.
pub const FRAGMENT_KEY: &str = "d1=";

/// Longest fragment that is unpacked, in bytes. Chromium itself cuts addresses at 2 MiB.
pub const MAX_LINK_BYTES: usize = 2 << 20;

/// Best ratio; documents are small, so time does not matter.
const COMPRESSION_LEVEL: u8 = 10;

/// Why a link holds no document.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LinkError {
    /// There is no document in the link.
    #[error("this link holds no document: it should have a part that begins with #{FRAGMENT_KEY}")]
    Missing,
    /// The packing is newer than this program.
    #[error(
        "this link is packed in a way that this program does not know ({0}). Open it with a newer Ductile"
    )]
    Newer(String),
    /// The link is longer than any that is unpacked.
    #[error("this link has {0} characters; the limit is {MAX_LINK_BYTES}")]
    TooLong(usize),
    /// A character cannot occur in a link.
    #[error("this link is damaged: {0}")]
    Alphabet(String),
    /// The packed bytes end early or their checksum is wrong.
    #[error("this link is damaged or was cut off: {0}. Ask for it again, or for the file")]
    Damaged(&'static str),
    /// What was packed is not a document.
    #[error("in this link: {0}")]
    Text(#[from] TextError),
}

/// The fragment that holds a document, without the leading `#`.
#[must_use]
pub fn to_fragment(document: &Document) -> String {
    let packed = compress_to_vec_zlib(to_compact_text(document).as_bytes(), COMPRESSION_LEVEL);
    let mut fragment = String::from(FRAGMENT_KEY);
    URL_SAFE_NO_PAD.encode_string(packed, &mut fragment);
    fragment
}

/// Reads the document from a fragment or from a whole address.
///
/// # Errors
/// [`LinkError`] says what is wrong with it.
pub fn from_fragment(link: &str) -> Result<Document, LinkError> {
    if link.len() > MAX_LINK_BYTES {
        return Err(LinkError::TooLong(link.len()));
    }
    let link = link.trim();
    let fragment = link.rsplit_once('#').map_or(link, |(_, fragment)| fragment);
    let Some(code) = fragment.split('&').find_map(|part| part.strip_prefix(FRAGMENT_KEY)) else {
        let other = fragment.split('&').filter_map(|part| part.split_once('=')).map(|(key, _)| key);
        let newer = other.into_iter().find(|key| key.starts_with("d") && key[1..].parse::<u32>().is_ok());
        return Err(newer.map_or(LinkError::Missing, |key| LinkError::Newer(key.to_owned())));
    };
    let packed = URL_SAFE_NO_PAD.decode(code).map_err(|e| match e {
        // Letters that end in the middle of a byte: most cuts show here first.
        DecodeError::InvalidLength(_) | DecodeError::InvalidLastSymbol(..) => {
            LinkError::Damaged("it ends early")
        }
        DecodeError::InvalidByte(..) | DecodeError::InvalidPadding => LinkError::Alphabet(e.to_string()),
    })?;
    let bytes = decompress_to_vec_zlib_with_limit(&packed, MAX_TEXT_BYTES).map_err(|e| match e.status {
        TINFLStatus::HasMoreOutput => LinkError::Damaged("it would unpack to more than any document holds"),
        TINFLStatus::Adler32Mismatch => LinkError::Damaged("its checksum is wrong"),
        TINFLStatus::FailedCannotMakeProgress | TINFLStatus::NeedsMoreInput => {
            LinkError::Damaged("it ends early")
        }
        _ => LinkError::Damaged("it does not unpack"),
    })?;
    let text = String::from_utf8(bytes).map_err(|_| LinkError::Damaged("it does not unpack to text"))?;
    Ok(from_text(&text)?)
}

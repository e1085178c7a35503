//! The web worker: decode, handle, encode.

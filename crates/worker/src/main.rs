//! The web worker that owns the model: decode, handle, encode, and nothing else.
//!
//! Runs as a module worker in the browser; elsewhere there is nothing for it to do.

#[cfg(target_arch = "wasm32")]
mod port;

fn main() {
    #[cfg(target_arch = "wasm32")]
    port::open();
}

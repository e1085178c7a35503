//! `ductile verify` on reference files of every format: the true ones pass, every kind of damage makes the exit status 1 or 2.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

mod cage;
mod displacement;
mod energies;
mod s_patch;
mod support;

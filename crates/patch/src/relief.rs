//! Reliefs: how a surface departs from the membrane in its rim, and the same relief on a region of another surface.
//!
//! Region shadowing (W. Welch, *Serious Putty*, 1995, section 7.3.3) asks for a correspondence between stamp and region and
//! leaves open which. Here both are discs, and both are spread over the unit disc by harmonic functions with positive
//! weights, which makes the charts one to one (Tutte 1963; Radó, Kneser and Choquet for the smooth case). Along the rims the
//! correspondence is that of lengths, from an anchor on. The relief is a vector, not a height: so a stamp with overhangs is
//! copied as it is, and a flat round region gets the very shape of a stamp with a round rim.

mod chart;
mod disc;
mod error;
mod ground;
mod lookup;
mod stamp;
#[cfg(test)]
mod tests;

pub use disc::Disc;
pub use error::ReliefError;
pub use ground::{Ground, Impression};
pub use stamp::Stamp;

//! The leaves of a scene: what a line crosses, where, and with which normal.

mod primitive;

pub use primitive::{BadParameter, Primitive, Profile};

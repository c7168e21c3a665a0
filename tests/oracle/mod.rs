//! What is right: spans of a [`Model`](crate::support::model::Model) found by exact
//! arithmetic and no code of the kernel.
//!
//! A test file takes what it needs: `#[expect(dead_code, reason = "…")] mod oracle;`.

pub(crate) mod compare;
pub(crate) mod equal;
pub(crate) mod lattice;
pub(crate) mod placed;
pub(crate) mod real;
pub(crate) mod surface;
pub(crate) mod sweep;

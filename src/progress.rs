//! How long work tells how it gets on.

/// Called from any thread with a number of rays done since the last call.
pub type Progress<'a> = &'a (dyn Fn(u64) + Sync);

//! How long work tells how it gets on, and is told to stop.

use std::ops::ControlFlow;

/// Called from any thread with a number of rays done since the last call.
pub type Progress<'a> = &'a (dyn Fn(u64) + Sync);

/// The same of work that can stop at any time with what it has found so far, which it does
/// soon after the answer is to break off.
pub type Watch<'a> = &'a (dyn Fn(u64) -> ControlFlow<()> + Sync);

/// A [`Watch`] that never stops anything.
pub fn unwatched(_rays: u64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

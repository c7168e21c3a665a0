//! Ctrl-C while something is measured: the first ends the work, the second the program.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// From now on the first Ctrl-C is for whoever asks the function.
pub(super) fn watched() -> anyhow::Result<impl Fn() -> bool + Sync + Copy> {
    ctrlc::set_handler(|| {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            /// What shells report of a program that Ctrl-C has ended.
            const ENDED: i32 = 130;
            std::process::exit(ENDED);
        }
    })?;
    Ok(|| INTERRUPTED.load(Ordering::Relaxed))
}

/// Whether to go on.
pub(super) fn flow(interrupted: impl Fn() -> bool) -> ControlFlow<()> {
    if interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

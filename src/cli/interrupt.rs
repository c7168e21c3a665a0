//! Ctrl-C while something is measured: the first ends the work, the second the program.

use std::sync::atomic::{AtomicBool, Ordering};

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// From now on the first Ctrl-C is for whoever asks.
pub(super) fn watch() -> anyhow::Result<()> {
    ctrlc::set_handler(|| {
        if INTERRUPTED.swap(true, Ordering::Relaxed) {
            /// What shells report of a program that Ctrl-C has ended.
            const ENDED: i32 = 130;
            std::process::exit(ENDED);
        }
    })?;
    Ok(())
}

/// What it was meant for has ended: the next is for what comes now.
pub(super) fn forget() {
    INTERRUPTED.store(false, Ordering::Relaxed);
}

/// Whether there was one.
pub(super) fn interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

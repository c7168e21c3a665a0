//! Progress on standard error, for what takes longer than a second, on a terminal only.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::Global;

/// Work shorter than this shows nothing.
const PATIENCE: Duration = Duration::from_secs(1);

/// A progress bar that stays hidden at first; ticked from any thread.
pub(super) struct Meter {
    bar: ProgressBar,
    start: Instant,
    wanted: bool,
    shown: AtomicBool,
}

impl Meter {
    /// A bar for so many rays, or a count where nobody knows how many there will be.
    pub(super) fn new(global: Global, what: &'static str, rays: Option<u64>) -> Self {
        let bar = ProgressBar::with_draw_target(rays, ProgressDrawTarget::hidden());
        let template = match rays {
            Some(_) => "{msg} {wide_bar} {percent} %, {eta} left",
            None => "{msg} {spinner} {human_pos} rays, {elapsed}",
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message(what);
        let wanted = !global.quiet;
        Self { bar, start: Instant::now(), wanted, shown: AtomicBool::new(false) }
    }

    /// So many rays more are done.
    pub(super) fn tick(&self, rays: u64) {
        self.bar.inc(rays);
        let due = self.wanted && self.start.elapsed() >= PATIENCE;
        if due && !self.shown.swap(true, Ordering::Relaxed) {
            // Standard error that is no terminal stays silent: indicatif sees to that.
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }
}

impl Drop for Meter {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

//! Progress on standard error, for what takes longer than a second, on a terminal only.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::Global;
use super::interrupt::{self, interrupted};

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
        let template = match rays {
            Some(_) => "{msg} {wide_bar} {percent} %, {eta} left",
            None => "{msg} {spinner} {human_pos} rays, {elapsed}",
        };
        Self::with(global, what, rays, template)
    }

    /// A count of triangles.
    pub(super) fn of_triangles(global: Global, what: &'static str) -> Self {
        Self::with(global, what, None, "{msg} {spinner} {human_pos} triangles, {elapsed}")
    }

    fn with(
        global: Global,
        what: &'static str,
        goal: Option<u64>,
        template: &str,
    ) -> Self {
        let bar = ProgressBar::with_draw_target(goal, ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message(what);
        let wanted = !global.quiet;
        Self { bar, start: Instant::now(), wanted, shown: AtomicBool::new(false) }
    }

    /// A count of work that the first Ctrl-C stops.
    pub(super) fn interruptible(
        global: Global,
        what: &'static str,
    ) -> anyhow::Result<Self> {
        interrupt::watch()?;
        Ok(Self::new(global, what, None))
    }

    /// So many rays more are done; whether to go on.
    pub(super) fn step(&self, rays: u64) -> ControlFlow<()> {
        self.tick(rays);
        if interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
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

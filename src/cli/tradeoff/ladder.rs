//! Larger and larger budgets, as long as there is time.

use std::time::{Duration, Instant};

use super::super::interrupt::interrupted;
use super::Trial;

/// How many runs with different random numbers each budget gets, if there is time.
const RUNS: u32 = 8;

/// What one run brought.
pub(super) struct Outcome {
    pub(super) samples: u64,
    /// Relative to the truth.
    pub(super) error: f64,
    pub(super) half_width: Option<f64>,
}

/// One budget.
pub(super) struct Rung<'a> {
    /// As options would say it.
    pub(super) setting: String,
    /// One run with a seed, if it comes to an end.
    pub(super) run: Box<dyn Fn(u64) -> Option<Outcome> + 'a>,
    /// Whether other seeds change anything.
    pub(super) is_random: bool,
}

/// Climbs from the first rung that comes to something as far as the time allows, and no farther than
/// a rung that comes to nothing again. The next
/// rung is taken for `growth` times as long as the one before, or for as many times as long as
/// that was longer than its own.
pub(super) fn climb<'a>(
    rungs: impl IntoIterator<Item = Rung<'a>>,
    limit: Duration,
    growth: f64,
) -> Vec<Trial> {
    let start = Instant::now();
    let mut trials: Vec<Trial> = Vec::new();
    for rung in rungs {
        let left = limit.saturating_sub(start.elapsed()).as_secs_f64();
        let next = match &trials[..] {
            [] => 0.0,
            [only] => growth * only.seconds,
            [.., before, last] => {
                let seen = last.seconds / before.seconds;
                last.seconds * seen.clamp(growth, 4.0 * growth)
            }
        };
        if next > left || interrupted() {
            break;
        }
        match trial(&rung, left / 3.0) {
            Some(trial) => trials.push(trial),
            // The first rungs can be too low to say anything.
            None if trials.is_empty() => {}
            None => break,
        }
    }
    trials
}

/// Runs one budget, more than once if that takes few seconds.
fn trial(rung: &Rung<'_>, seconds: f64) -> Option<Trial> {
    let start = Instant::now();
    let mut fastest = f64::INFINITY;
    let mut outcomes = Vec::new();
    let runs = if rung.is_random { RUNS } else { 1 };
    for seed in 0..u64::from(runs) {
        if interrupted() && !outcomes.is_empty() {
            break;
        }
        let before = Instant::now();
        outcomes.push((rung.run)(seed)?);
        fastest = fastest.min(before.elapsed().as_secs_f64());
        let took = start.elapsed().as_secs_f64();
        let done = outcomes.len() as f64;
        if took * (done + 1.0) / done > seconds {
            break;
        }
    }
    let count = outcomes.len() as f64;
    let squares: f64 = outcomes.iter().map(|o| o.error * o.error).sum();
    let samples: u64 = outcomes.iter().map(|o| o.samples).sum();
    let mut half_widths: Vec<f64> =
        outcomes.iter().filter_map(|o| o.half_width).collect();
    half_widths.sort_by(f64::total_cmp);
    let error = (squares / count).sqrt();
    let runs = u32::try_from(outcomes.len()).unwrap_or(RUNS);
    error.is_finite().then(|| Trial {
        setting: rung.setting.clone(),
        samples: samples / u64::from(runs),
        seconds: fastest,
        error,
        half_width: half_widths.get(half_widths.len() / 2).copied(),
        runs,
    })
}

//! Processor time.

use std::time::Duration;

use anyhow::Result;
use nix::sys::resource::{UsageWho, getrusage};
use nix::sys::time::TimeValLike;
use nix::time::{ClockId, clock_gettime};

/// The processor time of all threads of this process.
fn now() -> Result<Duration> {
    Ok(Duration::from(clock_gettime(ClockId::CLOCK_PROCESS_CPUTIME_ID)?))
}

/// The processor time of one call in seconds: the mean of as many as take 20 ms.
pub fn seconds<T>(mut call: impl FnMut() -> T) -> Result<f64> {
    let (start, mut calls) = (now()?, 0_u32);
    loop {
        std::hint::black_box(call());
        calls += 1;
        let took = (now()? - start).as_secs_f64();
        if took > 0.02 {
            return Ok(took / f64::from(calls));
        }
    }
}

/// What a call gives, and the user time of the processes that it starts and waits for, in
/// seconds.
pub fn child_seconds<T>(call: impl FnOnce() -> T) -> Result<(T, f64)> {
    let user = || -> Result<i64> {
        Ok(getrusage(UsageWho::RUSAGE_CHILDREN)?.user_time().num_microseconds())
    };
    let before = user()?;
    let given = call();
    Ok((given, 1e-6 * (user()? - before) as f64))
}

/// The middle one.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

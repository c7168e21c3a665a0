//! How fast errors fall.

use super::Trial;

/// For 1, 2, … runs: the mean and the variance of the logarithm of the root of the mean square of as
/// many normal errors of variance 1, (ψ(k/2) − ln(k/2)) / 2 and ψ′(k/2) / 4 (Bartlett and Kendall,
/// "The statistical analysis of variance-heterogeneity and the logarithmic transformation", 1946).
const LOG_OF_RMS: [[f64; 2]; 8] = [
    [-0.63518, 1.23370],
    [-0.28861, 0.41123],
    [-0.18449, 0.23370],
    [-0.13518, 0.16123],
    [-0.10657, 0.12259],
    [-0.08791, 0.09873],
    [-0.07480, 0.08259],
    [-0.06509, 0.07096],
];

/// The slope of the logarithm of the error over that of the samples, by least squares, of trials
/// whose error is above a floor; nothing if there are fewer than three. A trial counts by what its
/// runs know about the error: one lucky run must not bend the line.
pub(super) fn order(trials: &[Trial], floor: f64) -> Option<f64> {
    let told = trials.iter().filter(|trial| trial.error > floor && trial.samples > 0);
    let points: Vec<[f64; 3]> = told
        .map(|trial| {
            let runs = LOG_OF_RMS.len().min(trial.runs.max(1) as usize);
            let [mean, variance] = LOG_OF_RMS[runs - 1];
            [(trial.samples as f64).ln(), trial.error.ln() - mean, 1.0 / variance]
        })
        .collect();
    let weight: f64 = points.iter().map(|p| p[2]).sum();
    let mean = |axis: usize| points.iter().map(|p| p[axis] * p[2]).sum::<f64>() / weight;
    let [x, y] = [mean(0), mean(1)];
    let both: f64 = points.iter().map(|p| p[2] * (p[0] - x) * (p[1] - y)).sum();
    let squares: f64 = points.iter().map(|p| p[2] * (p[0] - x) * (p[0] - x)).sum();
    (points.len() >= 3 && squares > 0.0).then(|| both / squares)
}

/// The least seconds after which no trial has an error above `tol`, nor an interval whose half is
/// wider; nothing below the floor of what can be told.
pub(super) fn seconds_to(trials: &[Trial], tol: f64, floor: f64) -> Option<f64> {
    if tol < floor {
        return None;
    }
    let good = trials.iter().rev().take_while(|trial| {
        trial.error <= tol && trial.half_width.is_none_or(|half_width| half_width <= tol)
    });
    good.map(|trial| trial.seconds).reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(samples: u64, seconds: f64, error: f64) -> Trial {
        Trial {
            setting: String::new(),
            samples,
            seconds,
            error,
            half_width: None,
            runs: 1,
        }
    }

    #[test]
    fn powers_are_found() {
        let power = |n: u64| trial(n, 1.0, 3.0 * (n as f64).powf(-1.5));
        let trials: Vec<Trial> = [10, 100, 1000, 10_000].map(power).to_vec();
        assert!((order(&trials, 0.0).expect("four trials") + 1.5).abs() < 1e-12);
        assert_eq!(order(&trials, 1.0), None);
        assert_eq!(order(&trials[..2], 0.0), None);
    }

    #[test]
    fn one_lucky_run_does_not_bend_the_line() {
        let of = |runs: u32, samples: u64, error: f64| Trial {
            runs,
            ..trial(samples, 1.0, error)
        };
        let mut trials: Vec<Trial> = (1..7)
            .map(|k| of(8, 10_u64.pow(k), 10_f64.powf(-0.5 * f64::from(k))))
            .collect();
        trials.push(of(1, 10_000_000, 1e-5));
        let found = order(&trials, 0.0).expect("seven trials");
        assert!((found + 0.5).abs() < 0.05, "{found}");
    }

    #[test]
    fn luck_is_not_counted() {
        let trials =
            [trial(1, 1.0, 1e-9), trial(2, 2.0, 1e-3), trial(3, 3.0, 1e-4)].to_vec();
        assert_eq!(seconds_to(&trials, 1e-3, 0.0), Some(1.0));
        assert_eq!(seconds_to(&trials, 5e-4, 0.0), Some(3.0));
        assert_eq!(seconds_to(&trials, 1e-5, 0.0), None);
        assert_eq!(seconds_to(&trials, 1e-3, 1e-2), None);
        let wide = Trial { half_width: Some(1e-2), ..trial(4, 4.0, 1e-5) };
        let wide = [wide];
        assert_eq!(seconds_to(&wide, 1e-3, 0.0), None);
        assert_eq!(seconds_to(&wide, 1e-2, 0.0), Some(4.0));
    }
}

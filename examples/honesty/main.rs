//! Whether intervals hold as often as they say, and how errors fall: for ten solids, how many of
//! the 95 % intervals of how many seeds hold the true volume, and the order in which the error of
//! each method falls with its cost. And how far off the volume is where views from three sides
//! agree, of solids that were chosen for it, and whether intervals hold for these, too.
//!
//! ```sh
//! cargo run --release --example honesty -- 300
//! ```

mod solids;
mod views;

use std::error::Error;

use solidray::measure::{self, Estimate, Sampling};
use solidray::unwatched;

use solids::{Subject, subjects, traps};
use views::where_views_agree;

/// What part of the intervals of so many seeds hold the truth, and how many are not resolved.
fn coverage(subject: &Subject, seeds: u64, rel_tol: f64) -> String {
    let (mut holds, mut resolved) = (0, 0);
    for seed in 0..seeds {
        let sampling = Sampling { rel_tol, seed, ..Sampling::default() };
        let found = measure::volume(&subject.scene, &sampling);
        resolved += u64::from(found.resolved);
        holds += u64::from(subject.is_held_by(&found));
    }
    let all =
        if resolved == seeds { String::new() } else { format!(" ({resolved} resolved)") };
    format!("{:.1} %{all}", 100.0 * holds as f64 / seeds as f64)
}

/// The slope of the logarithm of the error over that of the cost, by least squares, where errors
/// are those of many seeds and not yet rounding.
fn order(
    subject: &Subject,
    seeds: u64,
    volume: impl Fn(&Sampling) -> Estimate,
) -> Option<f64> {
    let mut points = Vec::new();
    for power in 12..19 {
        let (mut squares, mut cost) = (0.0, 0.0);
        for seed in 0..seeds {
            let max_rays = 1 << power;
            let sampling =
                Sampling { rel_tol: 0.0, max_rays, seed, ..Sampling::default() };
            let found = volume(&sampling);
            let error = found.value / subject.truth - 1.0;
            squares += error * error / seeds as f64;
            cost += found.rays as f64 / seeds as f64;
        }
        let error = squares.sqrt();
        if error > 1e-11 {
            points.push((cost.ln(), error.ln()));
        }
    }
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let both: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let squares: f64 = points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
    (points.len() >= 3 && squares > 0.0).then(|| both / squares)
}

#[expect(clippy::print_stdout, reason = "an example shows what it found")]
fn main() -> Result<(), Box<dyn Error>> {
    let seeds = match std::env::args().nth(1) {
        Some(text) => text.parse()?,
        None => 8,
    };
    println!("| solid | intervals that hold, 1e-3 | 1e-4 | lattice | points | bracket |");
    println!("|---|---|---|---|---|---|");
    for subject in subjects() {
        let held = [1e-3, 1e-4].map(|rel_tol| coverage(&subject, seeds, rel_tol));
        let few = seeds.min(24);
        let shown =
            |order: Option<f64>| order.map_or("–".to_owned(), |o| format!("{o:.2}"));
        let lattice = order(&subject, few, |s| measure::volume(&subject.scene, s));
        let points =
            order(&subject, few, |s| measure::points(&subject.scene, s, &unwatched));
        let bracket = order(&subject, 1, |s| {
            // Its error is what it says.
            let found = measure::bracket(&subject.scene, s, &unwatched);
            Estimate { value: subject.truth + found.half_width(), ..found }
        });
        println!(
            "| {} | {} | {} | {} | {} | {} |",
            subject.name,
            held[0],
            held[1],
            shown(lattice),
            shown(points),
            shown(bracket)
        );
    }
    println!(
        "\n| solid | error where views agree | rays | intervals that hold, 1e-2 | 1e-3 |"
    );
    println!("|---|---|---|---|---|");
    for subject in traps() {
        let agreed = match where_views_agree(&subject.scene, 1e-3) {
            Some((found, rays)) => {
                format!("{:+.1} % | {rays}", 100.0 * (found / subject.truth - 1.0))
            }
            None => "do not agree | –".to_owned(),
        };
        let held = [1e-2, 1e-3].map(|rel_tol| coverage(&subject, seeds, rel_tol));
        println!("| {} | {agreed} | {} | {} |", subject.name, held[0], held[1]);
    }
    Ok(())
}

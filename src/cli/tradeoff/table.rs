//! What was measured, as text.

use std::io::Write;

use super::fit::seconds_to;
use super::pictures::WIDTH;
use super::{Report, Series};
use crate::cli::output::number;

/// The errors for which the table says what they cost.
const TOLERANCES: [f64; 6] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-9];
/// The same for outlines, in pixels.
const PIXELS: [f64; 6] = [1.0, 0.3, 0.1, 0.03, 0.01, 0.003];

/// Prints, for each method, its order and the seconds that each tolerance costs.
pub(super) fn print(report: &Report, out: &mut dyn Write) -> anyhow::Result<()> {
    let reference = &report.volumes.reference;
    let volume = number(reference.value, reference.half_width);
    writeln!(out, "volume {volume} ({})", reference.method)?;
    writeln!(out)?;
    head(out, "seconds for a volume to", &TOLERANCES.map(|tol| format!("{tol:.0e}")))?;
    for series in &report.volumes.series {
        row(out, series, &TOLERANCES, reference.floor())?;
    }
    let Some(pictures) = &report.pictures else { return Ok(()) };
    writeln!(out)?;
    let about = format!("outline, {WIDTH} px wide, to");
    head(out, &about, &PIXELS.map(|tol| format!("{tol} px")))?;
    for series in &pictures.series {
        row(out, series, &PIXELS, 0.0)?;
    }
    Ok(())
}

fn head(out: &mut dyn Write, about: &str, columns: &[String; 6]) -> std::io::Result<()> {
    write!(out, "{about:27} order")?;
    columns.iter().try_for_each(|column| write!(out, " {column:>8}"))?;
    writeln!(out)
}

fn row(
    out: &mut dyn Write,
    series: &Series,
    tolerances: &[f64],
    floor: f64,
) -> std::io::Result<()> {
    let order = series.order.map_or("–".to_owned(), |order| format!("{order:.2}"));
    write!(out, "{:27} {order:>5}", series.name)?;
    for &tol in tolerances {
        let found = seconds_to(&series.trials, tol, floor);
        write!(out, " {:>8}", found.map_or("–".to_owned(), seconds))?;
    }
    writeln!(out)
}

/// Seconds with two digits and a unit that fits.
pub(super) fn seconds(seconds: f64) -> String {
    let (value, unit) = match seconds {
        s if s < 1e-3 => (1e6 * s, "µs"),
        s if s < 1.0 => (1e3 * s, "ms"),
        s => (s, "s"),
    };
    if value < 9.95 { format!("{value:.1} {unit}") } else { format!("{value:.0} {unit}") }
}

/// One line for each budget.
pub(super) fn csv(report: &Report) -> anyhow::Result<Vec<u8>> {
    let mut out = Vec::new();
    writeln!(out, "what,method,setting,unit,samples,seconds,error,half_width,runs")?;
    let volumes = report.volumes.series.iter().map(|series| ("volume", series));
    let pictures = report.pictures.iter().flat_map(|pictures| &pictures.series);
    for (what, series) in volumes.chain(pictures.map(|series| ("outline", series))) {
        let Series { name, unit, .. } = series;
        for trial in &series.trials {
            let half_width = trial.half_width.map_or(String::new(), |h| format!("{h:e}"));
            writeln!(
                out,
                "{what},{name},\"{}\",{unit},{},{:e},{:e},{half_width},{}",
                trial.setting, trial.samples, trial.seconds, trial.error, trial.runs
            )?;
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_have_a_unit() {
        assert_eq!(seconds(0.000_312), "312 µs");
        assert_eq!(seconds(0.002_34), "2.3 ms");
        assert_eq!(seconds(12.3), "12 s");
    }
}

//! Results: JSON on standard output, and files that appear whole or not at all.

use std::io::{Read, Write};
use std::path::Path;

use anyhow::{Context, bail};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use solidray::Aabb;
use solidray::measure::{Estimate, Method};

/// The version of the JSON that commands print: names keep their meaning within one.
pub(super) const SCHEMA: u32 = 1;

/// A JSON object with the version in front.
#[derive(Serialize)]
struct Versioned<T> {
    schema: u32,
    #[serde(flatten)]
    body: T,
}

/// Prints one JSON object on a line of its own.
pub(super) fn json(out: &mut dyn Write, body: impl Serialize) -> anyhow::Result<()> {
    serde_json::to_writer(&mut *out, &Versioned { schema: SCHEMA, body })?;
    Ok(writeln!(out)?)
}

/// An [`Estimate`] as JSON.
#[derive(Serialize)]
pub(super) struct EstimateJson {
    value: f64,
    interval: [f64; 2],
    rays: u64,
    method: &'static str,
    target_met: bool,
    resolved: bool,
    spans: u64,
    uncertain: u64,
}

impl From<&Estimate> for EstimateJson {
    fn from(estimate: &Estimate) -> Self {
        let Estimate { value, interval, rays, method, .. } = *estimate;
        let Estimate { target_met, resolved, spans, uncertain, .. } = *estimate;
        let method = method.name();
        Self { value, interval, rays, method, target_met, resolved, spans, uncertain }
    }
}

/// An estimate in words: digits that were earned, then the half width of the interval.
pub(super) fn in_words(estimate: &Estimate) -> String {
    if !estimate.resolved {
        let [low, high] = estimate.interval;
        let least =
            if low > 0.0 { format!("at least {low:.3e}, ") } else { String::new() };
        return format!("not resolved: {least}at most {high:.3e} (95 %)");
    }
    let number = number(estimate.value, estimate.half_width());
    match confidence(estimate) {
        Some(kind) => format!("{number} ({kind})"),
        None => number,
    }
}

/// How sure the interval of an estimate is, or what kind of interval it is; none of one without
/// width.
pub(super) fn confidence(estimate: &Estimate) -> Option<&'static str> {
    match estimate.method {
        _ if estimate.half_width() == 0.0 => None,
        Method::Lattice | Method::Points => Some("95 %"),
        Method::Bracket => Some("certain"),
        Method::Exact => Some("rounding"),
        Method::Adaptive | _ => Some("estimated"),
    }
}

/// Digits that were earned, then the half width of the interval, if it has any.
pub(super) fn number(value: f64, half_width: f64) -> String {
    let value = earned(value, half_width);
    if half_width == 0.0 {
        value
    } else if takes_powers(half_width) {
        format!("{value} ± {half_width:.1e}")
    } else {
        let decimals = decimals(half_width);
        format!("{value} ± {half_width:.decimals$}")
    }
}

/// The digits of a number that an interval of this half width has earned.
pub(super) fn earned(value: f64, half_width: f64) -> String {
    if half_width == 0.0 {
        format!("{value}")
    } else if takes_powers(half_width) {
        let digits = (value.abs() / half_width).max(1.0).log10().floor() + 1.0;
        let digits = decimals_of(digits);
        format!("{value:.digits$e}")
    } else {
        let decimals = decimals(half_width);
        format!("{value:.decimals$}")
    }
}

/// Whether numbers with such an error bar are written with a power of ten: from 100 on the bar has
/// more digits in front of the point than it is worth.
fn takes_powers(half_width: f64) -> bool {
    decimals(half_width) > 12 || half_width >= 99.5
}

/// How many spans there were and how many of them rounding decided.
pub(super) fn uncertain_in_words(spans: u64, uncertain: u64) -> String {
    match uncertain {
        0 => format!("{spans}, none of them shorter than rounding"),
        n => format!(
            "{spans}, and {n} of them or of the gaps between shorter than rounding"
        ),
    }
}

/// How many decimals show two digits of an error bar.
fn decimals(half_width: f64) -> usize {
    decimals_of(1.0 - half_width.log10().floor())
}

/// A number of decimals that can be printed.
fn decimals_of(digits: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is clamped to a small positive number"
    )]
    let decimals = digits.clamp(0.0, 400.0) as usize;
    decimals
}

/// A box as JSON.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(super) struct BoundsJson {
    pub(super) min: [f64; 3],
    pub(super) max: [f64; 3],
}

/// `null` for an empty box.
pub(super) fn bounds_json(bounds: &Aabb) -> Option<BoundsJson> {
    (!bounds.is_empty())
        .then(|| BoundsJson { min: bounds.min.to_array(), max: bounds.max.to_array() })
}

/// A point as `x,y,z`, which the program reads back.
pub(super) fn point(p: DVec3) -> String {
    format!("{},{},{}", p.x, p.y, p.z)
}

/// Refuses the name of a file to write before the work.
pub(super) fn check_name(
    path: Option<&Path>,
    ending: &str,
    why: &str,
) -> anyhow::Result<()> {
    let Some(path) = path else { return Ok(()) };
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    if extension.as_deref() != Some(ending) {
        bail!("{}: {why}", path.display());
    }
    check_folder(path)
}

/// Refuses a file whose folder does not exist.
pub(super) fn check_folder(path: &Path) -> anyhow::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        bail!("{}: there is no folder {}", path.display(), folder.display());
    }
    Ok(())
}

/// Writes a file beside its place and moves it there when it is complete. What was there
/// keeps its permissions, and a link stays a link.
pub(super) fn save(path: &Path, mut bytes: &[u8]) -> anyhow::Result<()> {
    save_from(path, &mut bytes)
}

/// The same with what is read from somewhere.
pub(super) fn save_from(path: &Path, bytes: &mut dyn Read) -> anyhow::Result<()> {
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    write_beside(&target, bytes)
        // The name of the file beside it would be no help.
        .map_err(|error| std::io::Error::from(error.kind()))
        .with_context(|| path.display().to_string())
}

fn write_beside(target: &Path, bytes: &mut dyn Read) -> std::io::Result<()> {
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty());
    let mut builder = tempfile::Builder::new();
    builder.prefix(".solidray-").suffix(".part");
    if let Ok(old) = std::fs::metadata(target) {
        if old.permissions().readonly() {
            return Err(std::io::ErrorKind::PermissionDenied.into());
        }
        builder.permissions(old.permissions());
    } else {
        #[cfg(unix)]
        {
            // A file like any other that the user makes, not one only they may read.
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
    }
    let mut file = builder.tempfile_in(folder.unwrap_or(Path::new(".")))?;
    std::io::copy(bytes, &mut file)?;
    file.persist(target).map_err(|error| error.error)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_digits_that_were_earned_are_shown() {
        let estimate = |value, half| Estimate {
            value,
            interval: [value - half, value + half],
            rays: 1,
            method: Method::Lattice,
            target_met: true,
            resolved: true,
            spans: 1,
            uncertain: 0,
        };
        assert_eq!(in_words(&estimate(113.097_335, 0.0123)), "113.097 ± 0.012 (95 %)");
        assert_eq!(in_words(&estimate(113_097.335, 12.3)), "113097 ± 12 (95 %)");
        assert_eq!(in_words(&estimate(8.0, 0.0)), "8");
        let large = estimate(4_581_056_081.0, 635_555.0);
        assert_eq!(in_words(&large), "4.5811e9 ± 6.4e5 (95 %)");
        assert_eq!(in_words(&estimate(8.627e-14, 2.4e-15)), "8.63e-14 ± 2.4e-15 (95 %)");
    }
}

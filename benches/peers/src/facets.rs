//! Manifold: curves become facets, and the volume is that of the facets. A process of
//! Python, in which Manifold itself is the compiled library.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::part::Part;

/// The program, and the scene that it builds.
pub struct Facets {
    python: PathBuf,
    script: PathBuf,
    tree: PathBuf,
}

/// How long Manifold takes to an error.
pub struct Found {
    /// Processor time in seconds to the error that was asked for.
    pub seconds: f64,
    /// Whether that is what the last two measurements lead to, and not measured.
    pub extrapolated: bool,
    /// The segments of a circle, the seconds and the relative error of the last measurement.
    pub last: (u32, f64, f64),
}

impl Facets {
    /// Writes a tree where the process finds it.
    pub fn new(part: &Part, python: &Path, folder: &Path) -> Result<Self> {
        let tree = folder.join("tree.json");
        fs::write(&tree, part.to_json().to_string())?;
        Ok(Self { python: python.to_owned(), script: script(), tree })
    }

    /// The time to a relative error, by ever more segments until it is reached or the next
    /// step would take more than `limit` seconds.
    pub fn time_to(&self, error: f64, exact: f64, limit: f64) -> Result<Found> {
        let mut measured: Vec<(u32, f64, f64)> = Vec::new();
        let mut segments = 16;
        loop {
            let (seconds, volume) = self.run(segments)?;
            let now = (volume / exact - 1.0).abs();
            measured.push((segments, seconds, now));
            // The error falls with the square of the segments, the time grows with a power
            // that the last two tell.
            let power = match measured[..] {
                [.., (m, before, _), (n, after, _)] if before > 0.0 => {
                    (after / before).ln() / (f64::from(n) / f64::from(m)).ln()
                }
                _ => 2.0,
            };
            let growth = (now / error).sqrt();
            let predicted = seconds * growth.powf(power.clamp(1.0, 2.0));
            let last = (segments, seconds, now);
            if now <= error && measured.len() > 1 {
                return Ok(Found { seconds: predicted, extrapolated: false, last });
            }
            if seconds * 4.0 > limit {
                return Ok(Found { seconds: predicted, extrapolated: true, last });
            }
            segments *= 2;
        }
    }

    fn run(&self, segments: u32) -> Result<(f64, f64)> {
        let said = Command::new(&self.python)
            .args([&self.script, &self.tree])
            .arg(segments.to_string())
            .output()?;
        ensure!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
        let text = String::from_utf8(said.stdout)?;
        let (seconds, volume) = text.trim().split_once(' ').context("two numbers")?;
        Ok((seconds.parse()?, volume.parse()?))
    }
}

/// Which Manifold a Python has.
pub fn version(python: &Path) -> Option<String> {
    let said = Command::new(python).arg(script()).arg("version").output().ok()?;
    let text = String::from_utf8(said.stdout).ok()?;
    said.status.success().then(|| format!("Manifold {}", text.trim()))
}

fn script() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("children").join("manifold.py")
}

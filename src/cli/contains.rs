//! `solidray contains`

use std::io::Write;
use std::path::PathBuf;

use anyhow::bail;
use clap::Args;
use glam::DVec3;
use serde::Serialize;
use solidray::Membership;

use super::input::{Reading, lines_of_numbers};
use super::numbers::Numbers;
use super::output::{SCHEMA, point};
use super::{Answer, Global};

/// Say for points whether they are inside
///
/// Prints `in`, `out` or, where the boundary is nearer than rounding can tell, `on` for each
/// point. The exit code is 1 if any of them is out. On standard
/// input numbers are separated by commas or blanks; `#` begins a comment, and a first line of
/// names is skipped.
#[derive(Args, Debug)]
pub(super) struct Contains {
    /// The model
    file: PathBuf,
    /// Points; without any, they are read from standard input, one on a line
    #[arg(value_name = "X,Y,Z")]
    points: Vec<Numbers<3>>,
    #[command(flatten)]
    reading: Reading,
}

#[derive(Serialize)]
struct PointJson {
    point: [f64; 3],
    r#where: &'static str,
}

impl Contains {
    pub(super) fn run(
        &self,
        global: Global,
        out: &mut dyn Write,
    ) -> anyhow::Result<Answer> {
        if self.points.is_empty() && self.file.as_os_str() == "-" {
            bail!("standard input cannot be both the model and the list");
        }
        let scene = self.reading.load(&self.file, global)?.scene;
        let mut tracer = scene.tracer();
        let (mut answer, mut separator) = (Answer::Yes, "");
        if global.json {
            write!(out, "{{\"schema\":{SCHEMA},\"points\":[")?;
        }
        let each = |numbers: Option<[f64; 3]>| -> anyhow::Result<()> {
            let Some(numbers) = numbers else { return Ok(out.flush()?) };
            let p = DVec3::from_array(numbers);
            let found = tracer.classify(p);
            if found == Membership::Out {
                answer = Answer::No;
            }
            let r#where = found.name();
            if global.json {
                // Written as it comes: there may be more points than memory.
                write!(out, "{separator}")?;
                separator = ",";
                serde_json::to_writer(&mut *out, &PointJson { point: numbers, r#where })?;
            } else if global.quiet {
                writeln!(out, "{}", r#where)?;
            } else {
                writeln!(out, "{} {}", point(p), r#where)?;
            }
            Ok(())
        };
        let done = if self.points.is_empty() {
            lines_of_numbers(each)
        } else {
            self.points.iter().map(|p| Some(p.0)).try_for_each(each)
        };
        if global.json {
            // The object is whole even if the list of points is not.
            write!(out, "]")?;
            if let Err(error) = &done {
                write!(out, ",\"error\":")?;
                serde_json::to_writer(&mut *out, &format!("{error:#}"))?;
            }
            writeln!(out, "}}")?;
        }
        done?;
        Ok(answer)
    }
}

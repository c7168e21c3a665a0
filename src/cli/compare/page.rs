//! A report as one page of HTML that needs nothing else: no script, no network, no other file.
//!
//! It is well-formed XML as well, so that a strict reader finds what a browser would mend.

use std::fmt::Write;
use std::path::Path;

use glam::DVec3;
use quick_xml::escape::escape;
use solidray::Aabb;
use solidray::measure::{Comparison, Sampling, Verdict, Worst};

use super::super::output::number;
use super::super::ticks::short;
use super::commands::Command;
use super::figures::figures;
use super::measures;
use super::pictures::Pictures;
use super::words::{PERCENT, last_name, name, percent, place};
use super::{only_in, verdict_name};

/// All that a report says.
pub(super) struct Page<'a> {
    pub(super) files: [&'a Path; 2],
    pub(super) bounds: [Aabb; 2],
    pub(super) found: &'a Comparison,
    pub(super) tolerance: f64,
    pub(super) sampling: &'a Sampling,
    pub(super) seconds: f64,
    /// None where there is nothing to see.
    pub(super) pictures: Option<&'a Pictures>,
    pub(super) commands: &'a [Command],
}

/// Even if a file's name got past the escaping, a browser would load and run nothing for it.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";
const VERSION: &str = env!("CARGO_PKG_VERSION");

impl Page<'_> {
    pub(super) fn html(&self) -> String {
        let [a, b] = self.files.map(last_name);
        format!(
            r#"<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8" />
<meta http-equiv="Content-Security-Policy" content="{POLICY}" />
<meta name="viewport" content="width=device-width, initial-scale=1" />
<title>{title}: {a} and {b}</title>
<style>
{css}</style>
</head>
<body class="{verdict}">
<main>
{header}{pictures}{measures}{worst}{conditions}{commands}<footer>solidray {VERSION}</footer>
</main>
</body>
</html>
"#,
            title = self.heading(),
            css = include_str!("page.css"),
            verdict = verdict_name(self.found.verdict),
            header = self.header(),
            pictures = self.pictures.map(|p| figures(self.files, p)).unwrap_or_default(),
            measures = measures::table(self.found),
            worst = self.found.worst.map(|worst| self.worst(&worst)).unwrap_or_default(),
            conditions = self.conditions(),
            commands = self.commands(),
        )
    }

    /// The answer, for those who read nothing else.
    fn header(&self) -> String {
        let [a, b] = self.files.map(name);
        let sign = match self.found.verdict {
            Verdict::Same => "✓",
            Verdict::Different => "✗",
            Verdict::Undecided => "?",
        };
        let mut text = format!(
            "<header>\n<h1>{sign} {}</h1>\n<p class=\"models\">A is {a}, B is {b}</p>\n<p>{}</p>\n",
            self.heading(),
            self.share(),
        );
        if let Some(worst) = &self.found.worst {
            let [has, lacks] = if worst.in_a { ["A", "B"] } else { ["B", "A"] };
            let is_ringed =
                self.pictures.is_some_and(|pictures| pictures.worst.is_some());
            let ringed = if is_ringed { ", ringed in the pictures" } else { "" };
            let length = short(worst.length);
            let middle = self.place(worst.from.midpoint(worst.to));
            let _ = writeln!(
                text,
                "<p>The longest disagreement is <b>{length}</b> long, near {middle}{ringed}: {has} is solid there and {lacks} is not.</p>",
            );
        }
        text + "</header>\n"
    }

    fn heading(&self) -> String {
        let tolerance = percent(self.tolerance);
        match self.found.verdict {
            Verdict::Same => format!("The same within {tolerance}"),
            Verdict::Different => format!("Different by more than {tolerance}"),
            Verdict::Undecided => {
                format!("Undecided whether the same within {tolerance}")
            }
        }
    }

    /// How much of the larger volume differs, and how much may.
    fn share(&self) -> String {
        let Comparison { a, b, difference, .. } = self.found;
        match self.bounds.map(|bounds| bounds.is_empty()) {
            [true, true] => return "Both are empty.".to_owned(),
            [true, false] => return "A is empty and B is not.".to_owned(),
            [false, true] => return "B is empty and A is not.".to_owned(),
            [false, false] => {}
        }
        let larger = a.value.max(b.value);
        if larger == 0.0 {
            return "Too few rays met either to say how much differs.".to_owned();
        }
        let part = |volume: f64| volume / larger;
        let share = match difference.resolved {
            true => {
                let [value, half_width] = [difference.value, difference.half_width()];
                format!(
                    "{}{PERCENT}",
                    number(100.0 * part(value), 100.0 * part(half_width))
                )
            }
            false => {
                format!(
                    "at most {}{PERCENT}",
                    short(100.0 * part(difference.interval[1]))
                )
            }
        };
        let allowed = percent(self.tolerance);
        format!(
            "What only one of them has is <b>{share}</b> of the larger volume; {allowed} may differ."
        )
    }

    fn worst(&self, worst: &Worst) -> String {
        let length = format!("{:.6}", worst.length);
        list(
            "Longest disagreement",
            &[
                (
                    "Length",
                    format!(
                        "{length}, the longest stretch of any ray in one of them only"
                    ),
                ),
                ("Only in", only_in(worst).to_owned()),
                ("From", self.place(worst.from)),
                ("To", self.place(worst.to)),
            ],
        )
    }

    fn conditions(&self) -> String {
        let Sampling { rel_tol, seed, .. } = self.sampling;
        let [a, b] = [0, 1].map(|i| {
            format!("{}, {}", name(self.files[i]), self.extent(&self.bounds[i]))
        });
        let lengths = "in the units of the models: millimetres by OpenSCAD's custom";
        list(
            "Conditions",
            &[
                ("A", a),
                ("B", b),
                ("Lengths", lengths.to_owned()),
                ("Tolerance", format!("{} of the larger volume", self.tolerance)),
                ("Precision", format!("{rel_tol} of each volume")),
                ("Rays", format!("{}, seed {seed}", self.found.a.rays)),
                ("Seconds", format!("{:.3}", self.seconds)),
                ("Program", format!("solidray {VERSION}")),
            ],
        )
    }

    fn commands(&self) -> String {
        let mut text = "<h2>To see for yourself</h2>\n".to_owned();
        if self.files.iter().any(|file| file.as_os_str() == "-") {
            text += "<p class=\"note\">Where a command has <code>-</code> for a file it reads that model from standard input, as this comparison did.</p>\n";
        }
        for Command { what, line } in self.commands {
            let _ = writeln!(
                text,
                "<div class=\"command\">{what}\n<pre><code>{}</code></pre></div>",
                escape(line)
            );
        }
        text
    }

    /// How large a model is, and where.
    fn extent(&self, bounds: &Aabb) -> String {
        if bounds.is_empty() {
            return "empty".to_owned();
        }
        let [x, y, z] = bounds.size().to_array().map(short);
        let [from, to] = [bounds.min, bounds.max].map(|corner| self.place(corner));
        format!("within {x} × {y} × {z}, from {from} to {to}")
    }

    fn place(&self, point: DVec3) -> String {
        let [a, b] = self.bounds;
        place(point, a.hull(b).size().length())
    }
}

/// Terms and what they are, under a heading.
fn list(heading: &str, rows: &[(&str, String)]) -> String {
    let mut text = format!("<h2>{heading}</h2>\n<dl>\n");
    for (term, what) in rows {
        let _ = writeln!(text, "<dt>{term}</dt><dd>{what}</dd>");
    }
    text + "</dl>\n"
}

//! The commands by which others see what a report shows.

use std::ffi::OsString;
use std::path::Path;

use solidray::measure::Worst;
use solidray::render::{Camera, Projection};

use super::super::output::point;
use super::pictures::SIZE;
use super::{Compare, shell};

/// A command, and what it is good for.
pub(super) struct Command {
    pub(super) what: &'static str,
    pub(super) line: String,
}

impl Compare {
    /// The comparison, what is on the line of the longest disagreement, and the pictures, as far as
    /// there are any.
    pub(super) fn commands(
        &self,
        report: &Path,
        worst: Option<&Worst>,
        camera: Option<&Camera>,
    ) -> Vec<Command> {
        let mut commands = vec![Command {
            what: "The comparison, and this page again",
            line: self.again(report, camera),
        }];
        if let Some(worst) = worst {
            let dir = (worst.to - worst.from).normalize_or(worst.to - worst.from);
            let words =
                [option("--origin", &point(worst.from)), option("--dir", &point(dir))];
            for (file, what) in [
                (
                    &self.a,
                    "What of A is on the line of the longest disagreement, from its start",
                ),
                (&self.b, "What of B is on that line"),
            ] {
                commands.push(Command { what, line: self.line("ray", file, &words) });
            }
        }
        if let Some(camera) = camera {
            for (file, output, what) in
                [(&self.a, "a", "The picture of A"), (&self.b, "b", "The picture of B")]
            {
                // Beside the page, under a name that says whose it is.
                let mut name = report.file_stem().unwrap_or_default().to_owned();
                name.push(format!("-{output}.png"));
                let mut output = option("--output", "");
                output.push("=");
                output.push(report.with_file_name(name));
                let [width, height] = SIZE;
                let size = option("--imgsize", &format!("{width},{height}"));
                let mut words = vec![output, size];
                words.extend(["--edges", "--opaque"].map(OsString::from));
                words.extend(view(camera));
                commands.push(Command { what, line: self.line("render", file, &words) });
            }
        }
        commands
    }

    fn again(&self, report: &Path, camera: Option<&Camera>) -> String {
        let mut words = ["solidray", "compare"].map(OsString::from).to_vec();
        words.extend([shell::file(&self.a), shell::file(&self.b)]);
        words.push(option("--tol", &self.tol.to_string()));
        words.extend_from_slice(&self.sampling.words);
        words.extend_from_slice(&self.reading.words);
        words.extend(camera.into_iter().flat_map(view));
        let mut page = option("--report", "");
        page.push("=");
        page.push(report);
        words.push(page);
        shell::line(words.iter().map(OsString::as_os_str))
    }

    /// A command for one of the models.
    fn line(&self, command: &str, file: &Path, words: &[OsString]) -> String {
        let start = ["solidray".into(), command.into(), shell::file(file)];
        let all = start.iter().chain(&self.reading.words).chain(words);
        shell::line(all.map(OsString::as_os_str))
    }
}

/// The options of a camera, to the last bit.
fn view(camera: &Camera) -> Vec<OsString> {
    let Camera { center, rotation_deg, distance, projection } = camera;
    let numbers = format!("{},{},{distance}", point(*center), point(*rotation_deg));
    let mut words = vec![option("--camera", &numbers)];
    if *projection == Projection::Orthographic {
        words.push(option("--projection", "o"));
    }
    words
}

/// An option and its value in one word, so that the value may begin with a minus.
fn option(name: &str, value: &str) -> OsString {
    if value.is_empty() { name.into() } else { format!("{name}={value}").into() }
}

//! Messages for people, on standard error.

use std::io::{self, Write};

use solidray::read::Warning;

use super::excerpt;

/// Why the program could not do what it was asked, and the line of the file at fault.
pub(super) fn error(error: &anyhow::Error) {
    say(&format!("solidray: error: {error:#}"));
    if let Some(lines) = excerpt::of(error) {
        say(&lines);
    }
}

/// Something the user should know though it stopped nothing.
pub(super) fn warning(file: &str, warning: &Warning) {
    say(&format!("solidray: warning: {}", located(file, warning)));
}

/// A warning with its place, as `file:line:column: message`.
pub(super) fn located(file: &str, warning: &Warning) -> String {
    match warning.place {
        Some(place) => {
            format!("{file}:{}:{}: {}", place.line, place.column, warning.message)
        }
        None => format!("{file}: {}", warning.message),
    }
}

/// A line of additional information.
pub(super) fn note(text: &str) {
    say(&format!("solidray: {text}"));
}

/// If even standard error is gone there is nobody left to tell.
fn say(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

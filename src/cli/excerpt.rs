//! The line of a file that an error is about, with a mark under the column.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use solidray::Place;
use solidray::read::{ReadError, ReadErrorKind};

/// How much of a line is shown, in characters.
const WIDTH: usize = 76;

/// How far into a file is looked. Whoever waits for a message should not wait long.
const FARTHEST: u64 = 1 << 26;

/// How many bytes of a line are looked at; what stands behind them is not shown.
const LONGEST: u64 = 1 << 16;

/// The line an error is about and a caret under the place, if that is in a file that can be
/// read once more.
pub(super) fn of(error: &anyhow::Error) -> Option<String> {
    let mut error = error.chain().find_map(|cause| cause.downcast_ref::<ReadError>())?;
    while let ReadErrorKind::Import(inner) = &error.kind {
        error = inner;
    }
    let line = line(&error.path, error.place?)?;
    marked(&line, error.place?.column)
}

/// The text of a line, without what is in its way: none if it is not there or no text.
fn line(path: &Path, place: Place) -> Option<String> {
    // Only of files: what a pipe has said it does not say again.
    let is_file = std::fs::metadata(path).is_ok_and(|metadata| metadata.is_file());
    let file = is_file.then(|| File::open(path).ok()).flatten()?;
    let mut file = BufReader::new(file).take(FARTHEST);
    for _ in 1..place.line {
        if file.skip_until(b'\n').ok()? == 0 {
            return None;
        }
    }
    let mut line = Vec::new();
    file.take(LONGEST).read_until(b'\n', &mut line).ok()?;
    let line = String::from_utf8_lossy(&line);
    let line = line.trim_start_matches('\u{feff}').trim_end();
    // One column for each character.
    let shown = |c: char| if c.is_control() { ' ' } else { c };
    (!line.trim().is_empty()).then(|| line.chars().map(shown).collect())
}

/// A line, or as much of a long one as stands around a column, and a caret under that.
fn marked(line: &str, column: u32) -> Option<String> {
    let column = usize::try_from(column).ok()?.checked_sub(1)?;
    let length = line.chars().count();
    if column > length {
        return None;
    }
    let start = if length <= WIDTH { 0 } else { column.saturating_sub(WIDTH / 2) };
    let before = if start > 0 { "…" } else { "" };
    let after = if length > start + WIDTH { "…" } else { "" };
    let shown: String = line.chars().skip(start).take(WIDTH).collect();
    let gap = " ".repeat(column - start + before.chars().count());
    Some(format!("  {before}{shown}{after}\n  {gap}^"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_caret_is_under_the_column() {
        assert_eq!(marked("cube(-);", 6).as_deref(), Some("  cube(-);\n       ^"));
        assert_eq!(marked("cube(1)", 8).as_deref(), Some("  cube(1)\n         ^"));
        assert_eq!(marked("cube(1)", 9), None);
    }

    #[test]
    fn little_of_a_long_line_is_shown() {
        let line = format!("{}x{}", "a".repeat(5000), "b".repeat(5000));
        let marked = marked(&line, 5001).expect("it is there");
        let (text, caret) = marked.split_once('\n').expect("two lines");
        assert!(text.chars().count() <= WIDTH + 4, "{text}");
        assert_eq!(text.chars().position(|c| c == 'x'), caret.find('^'));
    }
}

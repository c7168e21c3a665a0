//! Tables in Markdown, in a file that keeps the rows that a run does not measure.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

/// A table with a name, of which rows are known by their first cell.
pub struct Table {
    name: &'static str,
    head: &'static [&'static str],
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows.
    pub fn new(name: &'static str, head: &'static [&'static str]) -> Self {
        Self { name, head, rows: Vec::new() }
    }

    /// Adds a row, and shows it.
    pub fn row(&mut self, cells: Vec<String>) {
        assert_eq!(cells.len(), self.head.len(), "a cell for each column");
        println!("{}: {}", self.name, line(&cells));
        self.rows.push(cells);
    }

    /// Puts the table between its marks in a file, its rows in place of those with the same
    /// first cell, and a sentence behind it. A table without rows changes nothing.
    pub fn save(&self, path: &Path, sentence: &str) -> Result<()> {
        if self.rows.is_empty() {
            return Ok(());
        }
        replace(path, self.name, |old| {
            let mut rows: Vec<String> = old
                .lines()
                .filter(|line| line.starts_with("| "))
                .skip(1)
                .map(str::to_owned)
                .collect();
            for cells in &self.rows {
                let (key, new) = (format!("| {} |", cells[0]), line(cells));
                match rows.iter_mut().find(|row| row.starts_with(&key)) {
                    Some(row) => *row = new,
                    None => rows.push(new),
                }
            }
            let rule = "|---".repeat(self.head.len());
            format!("{}\n{rule}|\n{}\n\n{sentence}", line(self.head), rows.join("\n"))
        })
    }
}

/// Replaces what is between two marks in a file.
pub fn replace(path: &Path, name: &str, new: impl FnOnce(&str) -> String) -> Result<()> {
    let text = fs::read_to_string(path)?;
    let [open, close] = [format!("<!-- {name} -->\n"), format!("\n<!-- end {name} -->")];
    let marked = || format!("{} has no mark {name}", path.display());
    let (before, rest) = text.split_once(&open).with_context(marked)?;
    // Between marks that stand together there is nothing.
    let (old, after) = match rest.split_once(&close) {
        Some(parts) => parts,
        None => ("", rest.strip_prefix(&close[1..]).with_context(marked)?),
    };
    fs::write(path, format!("{before}{open}{}{close}{after}", new(old)))?;
    Ok(())
}

fn line<T: AsRef<str>>(cells: &[T]) -> String {
    let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
    format!("| {} |", cells.join(" | "))
}

/// A number with three digits, or a dash for none.
pub fn number(value: Option<f64>) -> String {
    let Some(value) = value else { return "–".to_owned() };
    let digits = 2 - value.abs().max(1e-6).log10().floor() as i32;
    let places = digits.clamp(0, 6) as usize;
    format!("{value:.places$}")
}

/// How many times as much one is as another, or a dash.
pub fn ratio(much: Option<f64>, little: f64) -> String {
    match much {
        Some(much) => format!("{}×", number(Some(much / little))),
        None => "–".to_owned(),
    }
}

/// What was reached of a goal and a floor.
pub fn reached(goal: Option<bool>, floor: Option<bool>) -> String {
    match (goal, floor) {
        (_, Some(false)) => "no",
        (Some(true), _) => "goal",
        (_, Some(true)) => "floor",
        (Some(false), None) => "no",
        (None, None) => "–",
    }
    .to_owned()
}

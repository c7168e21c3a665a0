//! The words of a text, with their places, for the mesh formats.

use super::error::Located;
use crate::solid::Place;

/// A cursor over words separated by white space.
#[derive(Clone, Debug)]
pub(super) struct Words<'a> {
    rest: &'a [u8],
    place: Place,
    comment: Option<u8>,
}

/// A word and where it stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<'a> {
    pub(super) text: &'a [u8],
    pub(super) place: Place,
}

impl<'a> Words<'a> {
    /// The words of a text, in which a comment runs from the given character to the end
    /// of the line.
    pub(super) fn new(text: &'a [u8], comment: Option<u8>) -> Self {
        let rest = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
        Self { rest, place: Place { line: 1, column: 1 }, comment }
    }

    /// The next word, on whatever line.
    pub(super) fn next(&mut self) -> Option<Word<'a>> {
        loop {
            if let Some(word) = self.next_on_line() {
                return Some(word);
            }
            if self.rest.is_empty() {
                return None;
            }
            self.step();
        }
    }

    /// The next word of this line; the cursor stays on the line.
    pub(super) fn next_on_line(&mut self) -> Option<Word<'a>> {
        while let Some(&byte) = self.rest.first() {
            if byte == b'\n' {
                return None;
            }
            if Some(byte) == self.comment {
                self.skip_line();
                return None;
            }
            if !is_space(byte) {
                break;
            }
            self.step();
        }
        let ends = |&b: &u8| is_space(b) || Some(b) == self.comment;
        let length = self.rest.iter().position(ends).unwrap_or(self.rest.len());
        if length == 0 {
            return None;
        }
        let word = Word { text: &self.rest[..length], place: self.place };
        for _ in 0..length {
            self.step();
        }
        Some(word)
    }

    /// Goes to the end of this line.
    pub(super) fn skip_line(&mut self) {
        while self.rest.first().is_some_and(|&b| b != b'\n') {
            self.step();
        }
    }

    /// A number, on whatever line.
    pub(super) fn number(&mut self) -> Result<f64, Located> {
        match self.next() {
            Some(word) => word.number(),
            None => Err(self.ended("a number")),
        }
    }

    /// An index or a count, on whatever line.
    pub(super) fn count(&mut self) -> Result<u32, Located> {
        match self.next() {
            Some(word) => word.parsed("a count"),
            None => Err(self.ended("a count")),
        }
    }

    /// That the text ends where something was due.
    pub(super) fn ended(&self, expected: &str) -> Located {
        Located::syntax(self.place, expected, "the end of the file")
    }

    fn step(&mut self) {
        let Some((&byte, rest)) = self.rest.split_first() else { return };
        self.rest = rest;
        if byte == b'\n' {
            self.place.line = self.place.line.saturating_add(1);
            self.place.column = 1;
        } else if rest.first().is_none_or(|&b| !is_continuation(b)) {
            self.place.column = self.place.column.saturating_add(1);
        }
    }
}

impl Word<'_> {
    pub(super) fn number(&self) -> Result<f64, Located> {
        self.parsed("a number")
    }

    pub(super) fn parsed<T: std::str::FromStr>(
        &self,
        expected: &str,
    ) -> Result<T, Located> {
        let text = std::str::from_utf8(self.text).ok();
        text.and_then(|t| t.parse().ok()).ok_or_else(|| self.unexpected(expected))
    }

    /// That this word stands where something else was due.
    pub(super) fn unexpected(&self, expected: &str) -> Located {
        Located::syntax(self.place, expected, quoted(self.text))
    }
}

/// Bytes as a message shows them: as text, in back-quotes, not too much of it.
pub(super) fn quoted(text: &[u8]) -> String {
    const SHOWN: usize = 40;
    let whole = String::from_utf8_lossy(&text[..text.len().min(4 * SHOWN)]);
    let shown: String = whole.chars().take(SHOWN).flat_map(char::escape_debug).collect();
    let more = if whole.chars().count() > SHOWN { "…" } else { "" };
    format!("`{shown}{more}`")
}

fn is_space(byte: u8) -> bool {
    byte.is_ascii_whitespace() || byte == 0x0b
}

/// Whether a byte continues a UTF-8 character, so that it does not start a column.
pub(super) fn is_continuation(byte: u8) -> bool {
    byte & 0xc0 == 0x80
}

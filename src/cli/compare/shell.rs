//! Commands that a shell takes as they are meant.

use std::ffi::{OsStr, OsString};
use std::fmt::Write;
use std::path::Path;

/// A command line of words, whatever is in them.
pub(super) fn line<'a>(words: impl IntoIterator<Item = &'a OsStr>) -> String {
    words.into_iter().map(quoted).collect::<Vec<_>>().join(" ")
}

/// A file as an argument: no option, though its name begins with a dash.
pub(super) fn file(path: &Path) -> OsString {
    let name = path.as_os_str();
    if name != "-" && name.as_encoded_bytes().starts_with(b"-") {
        return Path::new(".").join(path).into_os_string();
    }
    name.to_owned()
}

/// One word, in quotes if a shell would see more in it than its letters.
fn quoted(word: &OsStr) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=+@%".contains(c);
    let is_plain = |text: &str| !text.starts_with('=') && text.chars().all(is_plain);
    // What acts on a terminal, or turns the line around, is not shown as it is. A shell takes away
    // ends of lines behind what it is told in numbers.
    let acts = |c: char| (c.is_control() && c != '\n') || is_bidirectional(c);
    match word.to_str().filter(|text| !text.contains(acts) || text.ends_with('\n')) {
        Some(text) if !text.is_empty() && is_plain(text) => text.to_owned(),
        Some(text) => format!("'{}'", text.replace('\'', r"'\''")),
        // Bytes that are no text cannot be shown either, but they can be said.
        None => {
            let mut octal = String::new();
            for byte in word.as_encoded_bytes() {
                let _ = write!(octal, r"\0{byte:03o}");
            }
            format!(r#""$(printf '%b' '{octal}')""#)
        }
    }
}

/// Whether a character says in which direction text runs (Unicode Standard Annex 9, §2).
fn is_bidirectional(c: char) -> bool {
    matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_where_they_must_be() {
        let words =
            ["solidray", "a.csg", "b c", "it's", "$(x)", "", "x=1,-2", "~", "ü", "=ls"];
        assert_eq!(
            line(words.map(OsStr::new)),
            r"solidray a.csg 'b c' 'it'\''s' '$(x)' '' x=1,-2 '~' 'ü' '=ls'"
        );
    }

    #[test]
    fn files_are_no_options() {
        for (name, said) in [("-", "-"), ("-x", "./-x"), ("a", "a"), ("a/-x", "a/-x")] {
            assert_eq!(file(Path::new(name)), said);
        }
    }

    #[cfg(unix)]
    #[test]
    fn shells_read_what_was_meant() {
        use std::os::unix::ffi::OsStrExt;
        let hard: [&[u8]; 7] = [
            b"plain",
            b"two words",
            b"'\"`$HOME\\ *?[a]!#&;|<>(){}",
            b"line\nbreak\ttab",
            "\u{202e}\u{1f600}".as_bytes(),
            b"\xff%s\\n'\xfe",
            b"-n",
        ];
        let words = hard.map(OsStr::from_bytes);
        let script = format!("printf '%s\\0' {}", line(words));
        let done = std::process::Command::new("sh").arg("-c").arg(script).output();
        let said = done.expect("a shell").stdout;
        let said: Vec<&[u8]> = said.split(|&byte| byte == 0).collect();
        assert_eq!(said[..7], hard);
    }
}

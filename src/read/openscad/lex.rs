//! Bytes to tokens.

use super::super::error::Located;
use super::super::words::quoted;
use super::value::place;

/// The smallest meaningful pieces of the text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'a> {
    /// A name or a word such as `true`.
    Name(&'a str),
    /// A number without its sign.
    Number(f64),
    /// Where the bytes between two quotes are.
    Text { start: u32, end: u32 },
    /// Any other character.
    Symbol(u8),
    /// The end of the text.
    End,
}

/// A cursor over tokens.
#[derive(Debug)]
pub(super) struct Lexer<'a> {
    text: &'a [u8],
    at: usize,
    /// The token under the cursor.
    pub(super) token: Token<'a>,
    /// Where it starts.
    pub(super) offset: u32,
}

impl<'a> Lexer<'a> {
    /// A cursor on the first token. The text is shorter than 4 GiB.
    pub(super) fn new(text: &'a [u8]) -> Result<Self, Located> {
        let mut lexer = Self { text, at: 0, token: Token::End, offset: 0 };
        lexer.advance()?;
        Ok(lexer)
    }

    /// Goes to the next token.
    pub(super) fn advance(&mut self) -> Result<(), Located> {
        self.skip_blanks()?;
        self.offset = offset(self.at);
        let rest = &self.text[self.at..];
        self.token = match rest.first() {
            None => Token::End,
            Some(&b) if is_name_start(b) => {
                let length = run(rest, |b| is_name_start(b) || b.is_ascii_digit());
                self.at += length;
                Token::Name(std::str::from_utf8(&rest[..length]).unwrap_or_default())
            }
            Some(&b) if b.is_ascii_digit() || b == b'.' => self.number(rest)?,
            Some(b'"') => self.string(rest)?,
            Some(&b) => {
                self.at += 1;
                Token::Symbol(b)
            }
        };
        Ok(())
    }

    /// That something else was due where the cursor is.
    pub(super) fn unexpected(&self, expected: &str) -> Located {
        let found = match self.token {
            Token::End => "the end of the file".to_owned(),
            Token::Text { start, end } => {
                let text = &self.text[start as usize..end as usize];
                format!("the string {}", quoted(text))
            }
            Token::Symbol(b) if !b.is_ascii() => self.character(),
            Token::Name(_) | Token::Number(_) | Token::Symbol(_) => {
                quoted(&self.text[self.offset as usize..self.at])
            }
        };
        Located::syntax(place(self.text, self.offset), expected, found)
    }

    /// The character that is not ASCII under the cursor.
    fn character(&self) -> String {
        let rest = &self.text[self.offset as usize..];
        let piece = String::from_utf8_lossy(&rest[..rest.len().min(4)]).into_owned();
        piece
            .chars()
            .next()
            .map_or_else(String::new, |c| quoted(c.to_string().as_bytes()))
    }

    fn skip_blanks(&mut self) -> Result<(), Located> {
        loop {
            let rest = &self.text[self.at..];
            self.at += match rest {
                [b, ..] if b.is_ascii_whitespace() || *b == 0x0b => 1,
                [b'/', b'/', ..] => run(rest, |b| b != b'\n'),
                [b'/', b'*', body @ ..] => {
                    let Some(end) = body.windows(2).position(|w| w == b"*/") else {
                        let found = "a comment that does not end";
                        let place = place(self.text, offset(self.at));
                        return Err(Located::syntax(place, "`*/`", found));
                    };
                    end + 4
                }
                _ => return Ok(()),
            };
        }
    }

    fn number(&mut self, rest: &[u8]) -> Result<Token<'a>, Located> {
        let mut length = run(rest, |b| b.is_ascii_digit() || b == b'.');
        if let [b'e' | b'E', power @ ..] = &rest[length..] {
            let sign = usize::from(matches!(power.first(), Some(b'+' | b'-')));
            length += 1 + sign + run(&power[sign..], |b| b.is_ascii_digit());
        }
        self.at += length;
        let digits = std::str::from_utf8(&rest[..length]).ok();
        digits.and_then(|d| d.parse().ok()).map(Token::Number).ok_or_else(|| {
            let place = place(self.text, self.offset);
            Located::syntax(place, "a number", quoted(&rest[..length]))
        })
    }

    fn string(&mut self, rest: &[u8]) -> Result<Token<'a>, Located> {
        let mut length = 1;
        loop {
            match rest.get(length) {
                Some(b'"') => break,
                Some(b'\\') => length += 2,
                Some(_) => length += 1,
                None => {
                    let place = place(self.text, self.offset);
                    let found = "a string that does not end";
                    return Err(Located::syntax(place, "`\"`", found));
                }
            }
        }
        let start = offset(self.at + 1);
        self.at += length + 1;
        Ok(Token::Text { start, end: offset(self.at - 1) })
    }
}

/// An offset as it is kept; the text is shorter than 4 GiB.
fn offset(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}

fn run(text: &[u8], belongs: impl Fn(u8) -> bool) -> usize {
    text.iter().position(|&b| !belongs(b)).unwrap_or(text.len())
}

fn is_name_start(b: u8) -> bool {
    b.is_ascii_alphabetic() || b == b'_' || b == b'$'
}

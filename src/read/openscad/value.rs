//! The parsed text: statements, arguments and values in flat lists.

use std::ops::Range;

use super::super::words::is_continuation;
use crate::shown::Shown;
use crate::solid::Place;

/// A parsed file.
#[derive(Debug)]
pub(super) struct Document<'a> {
    pub(super) text: &'a [u8],
    /// In the order of the text, each followed by what is in its braces.
    pub(super) statements: Vec<Statement<'a>>,
    pub(super) arguments: Vec<Argument<'a>>,
    /// In the order of the text, each vector followed by its elements.
    pub(super) values: Vec<Value>,
    /// Where each value starts.
    pub(super) offsets: Vec<u32>,
}

/// `name(arguments);` or `name(arguments) { … }`.
#[derive(Debug)]
pub(super) struct Statement<'a> {
    pub(super) name: &'a str,
    pub(super) place: Place,
    pub(super) modifiers: Modifiers,
    pub(super) arguments: Range<u32>,
    /// The index of the first statement that is not in this one's braces.
    pub(super) end: u32,
}

/// The characters before a statement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Modifiers {
    /// `*`: as if it were not there.
    pub(super) disabled: bool,
    /// `!`: as if nothing else were there.
    pub(super) root: bool,
    /// `%`: shown by OpenSCAD, but no part of the model.
    pub(super) background: bool,
    /// `#`: shown by OpenSCAD whole, whatever is left of it in the model.
    pub(super) highlighted: bool,
}

/// `value` or `name = value`.
#[derive(Debug)]
pub(super) struct Argument<'a> {
    pub(super) name: Option<&'a str>,
    /// The index of its value.
    pub(super) value: u32,
}

/// A value; vectors say where their elements end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value {
    Undef,
    Bool(bool),
    Number(f64),
    /// The bytes between the quotes, escapes and all.
    Text {
        start: u32,
        end: u32,
    },
    Vector {
        end: u32,
    },
}

impl Document<'_> {
    /// The indices of the elements of a vector; nothing for any other value.
    pub(super) fn elements(&self, vector: u32) -> impl Iterator<Item = u32> + '_ {
        let end = match self.values[vector as usize] {
            Value::Vector { end } => end,
            Value::Undef | Value::Bool(_) | Value::Number(_) | Value::Text { .. } => 0,
        };
        let mut next = vector + 1;
        std::iter::from_fn(move || {
            let this = next;
            if this >= end {
                return None;
            }
            next = match self.values[this as usize] {
                Value::Vector { end } => end,
                Value::Undef | Value::Bool(_) | Value::Number(_) | Value::Text { .. } => {
                    this + 1
                }
            };
            Some(this)
        })
    }

    /// The number that a value is.
    pub(super) fn number(&self, value: u32) -> Option<f64> {
        match self.values[value as usize] {
            Value::Number(number) => Some(number),
            Value::Undef | Value::Bool(_) | Value::Text { .. } | Value::Vector { .. } => {
                None
            }
        }
    }

    /// The N numbers that a vector starts with, if it has as many.
    pub(super) fn numbers<const N: usize>(&self, vector: u32) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        let mut elements = self.elements(vector);
        for number in &mut numbers {
            *number = self.number(elements.next()?)?;
        }
        Some(numbers)
    }

    /// The decoded text that a value is; bytes that are not UTF-8 become U+FFFD.
    pub(super) fn string(&self, value: u32) -> Option<String> {
        let Value::Text { start, end } = self.values[value as usize] else { return None };
        let raw = String::from_utf8_lossy(&self.text[start as usize..end as usize]);
        let mut decoded = String::with_capacity(raw.len());
        let mut chars = raw.chars();
        while let Some(c) = chars.next() {
            decoded.push(match c {
                '\\' => match chars.next() {
                    Some('n') => '\n',
                    Some('t') => '\t',
                    Some('r') => '\r',
                    Some(other) => other,
                    None => break,
                },
                c => c,
            });
        }
        Some(decoded)
    }

    /// What a value is, for messages.
    pub(super) fn described(&self, value: u32) -> String {
        match self.values[value as usize] {
            Value::Undef => "undef".to_owned(),
            Value::Bool(b) => b.to_string(),
            Value::Number(x) => Shown(x).to_string(),
            Value::Text { start, end } => {
                let text = &self.text[start as usize..end as usize];
                format!("the string {}", super::super::words::quoted(text))
            }
            Value::Vector { .. } => {
                format!("a vector of {}", self.elements(value).count())
            }
        }
    }

    /// The place of a value.
    pub(super) fn place(&self, value: u32) -> Place {
        place(self.text, self.offsets[value as usize])
    }
}

/// The place of an offset. Linear in the offset, so for messages only.
pub(super) fn place(text: &[u8], offset: u32) -> Place {
    let mut place = Place { line: 1, column: 1 };
    advance(&mut place, &text[..(offset as usize).min(text.len())]);
    place
}

/// Moves a place over a piece of text.
pub(super) fn advance(place: &mut Place, text: &[u8]) {
    for &byte in text {
        if byte == b'\n' {
            place.line += 1;
            place.column = 1;
        } else if !is_continuation(byte) {
            place.column += 1;
        }
    }
}

//! The arguments of a statement, by name or position.

use super::super::error::{Located, ReadErrorKind};
use super::super::words::quoted;
use super::evaluate::Reading;
use super::value::{Document, Statement, Value};
use crate::solid::Place;

/// A statement that is being evaluated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Call<'a> {
    pub(super) document: &'a Document<'a>,
    pub(super) statement: &'a Statement<'a>,
    /// The names its arguments may have, in the order in which those without a name come.
    pub(super) parameters: &'static [&'static str],
}

impl Call<'_> {
    pub(super) fn place(&self) -> Place {
        self.statement.place
    }

    pub(super) fn name(&self) -> &str {
        self.statement.name
    }

    /// The index of the value given for a parameter; of several the last.
    pub(super) fn value(&self, parameter: &str) -> Option<u32> {
        let (mut found, mut position) = (None, 0);
        for argument in &self.document.arguments[self.range()] {
            let name = match argument.name {
                Some(name) => Some(name),
                None => {
                    position += 1;
                    self.parameters.get(position - 1).copied()
                }
            };
            if name == Some(parameter) {
                found = Some(argument.value);
            }
        }
        found.filter(|&v| self.document.values[v as usize] != Value::Undef)
    }

    /// The number given for a parameter.
    pub(super) fn number(&self, parameter: &str) -> Result<Option<f64>, Located> {
        let Some(value) = self.value(parameter) else { return Ok(None) };
        let number = self.document.number(value);
        number.map(Some).ok_or_else(|| self.wrong(parameter, "a number", value))
    }

    /// The truth given for a parameter; false when there is none.
    pub(super) fn truth(&self, parameter: &str) -> Result<bool, Located> {
        let Some(value) = self.value(parameter) else { return Ok(false) };
        match self.document.values[value as usize] {
            Value::Bool(truth) => Ok(truth),
            Value::Number(number) => Ok(number != 0.0),
            Value::Undef | Value::Text { .. } | Value::Vector { .. } => {
                Err(self.wrong(parameter, "true or false", value))
            }
        }
    }

    /// The text given for a parameter.
    pub(super) fn text(&self, parameter: &str) -> Result<Option<String>, Located> {
        let Some(value) = self.value(parameter) else { return Ok(None) };
        let text = self.document.string(value);
        text.map(Some).ok_or_else(|| self.wrong(parameter, "a string", value))
    }

    /// N numbers given for a parameter as a vector, or as one number that stands for all.
    pub(super) fn sizes<const N: usize>(
        &self,
        parameter: &str,
    ) -> Result<Option<[f64; N]>, Located> {
        let Some(value) = self.value(parameter) else { return Ok(None) };
        let one = self.document.number(value).map(|x| [x; N]);
        let sizes = one.or_else(|| self.document.numbers(value));
        let expected = || format!("a number or a vector of {N} numbers");
        sizes.map(Some).ok_or_else(|| self.wrong(parameter, &expected(), value))
    }

    /// The indices of the elements of the vector given for a parameter.
    pub(super) fn vector(&self, parameter: &str) -> Result<Option<Vec<u32>>, Located> {
        let Some(value) = self.value(parameter) else { return Ok(None) };
        self.elements(parameter, value).map(Some)
    }

    /// The indices of the elements of a vector that is part of an argument.
    pub(super) fn elements(
        &self,
        parameter: &str,
        value: u32,
    ) -> Result<Vec<u32>, Located> {
        match self.document.values[value as usize] {
            Value::Vector { .. } => Ok(self.document.elements(value).collect()),
            Value::Undef | Value::Bool(_) | Value::Number(_) | Value::Text { .. } => {
                Err(self.wrong(parameter, "a vector", value))
            }
        }
    }

    /// That a value is not what an argument may be.
    pub(super) fn wrong(&self, argument: &str, expected: &str, value: u32) -> Located {
        let kind = ReadErrorKind::Argument {
            node: self.name().into(),
            argument: argument.into(),
            expected: expected.into(),
            found: self.document.described(value).into(),
        };
        Located::at(self.document.place(value), kind)
    }

    /// That something about this statement is not implemented.
    pub(super) fn unsupported(&self, what: impl Into<String>) -> Located {
        Located::at(self.place(), ReadErrorKind::Unsupported(what.into()))
    }

    /// Warns of arguments that have no meaning here, or are given again. Names that start
    /// with `$` have a meaning everywhere.
    ///
    /// Warnings stand at the statement: to find the place of an argument takes as long as
    /// the text before it, too long where every statement has one.
    pub(super) fn warn_of_unknown(&self, reading: &mut Reading<'_>) {
        let (mut position, mut given) = (0, 0_u64);
        for argument in &self.document.arguments[self.range()] {
            let parameter = match argument.name {
                Some(name) if name.starts_with('$') => continue,
                Some(name) => self.parameters.iter().position(|p| *p == name),
                None => {
                    position += 1;
                    Some(position - 1).filter(|p| *p < self.parameters.len())
                }
            };
            let node = self.name();
            let message = match (parameter, argument.name) {
                (Some(index), _) if given & (1 << index) == 0 => {
                    given |= 1 << index;
                    continue;
                }
                (Some(index), _) => {
                    let name = self.parameters[index];
                    format!("`{node}` has `{name}` more than once; the last one counts")
                }
                (None, Some(name)) => {
                    let name = quoted(name.as_bytes());
                    format!("`{node}` has no argument {name}; it is ignored")
                }
                (None, None) => {
                    let count = self.parameters.len();
                    format!(
                        "`{node}` has at most {count} arguments without a name; more are ignored"
                    )
                }
            };
            reading.warn(self.place(), message);
        }
    }

    fn range(&self) -> std::ops::Range<usize> {
        self.statement.arguments.start as usize..self.statement.arguments.end as usize
    }
}

//! Lists of numbers as users type them.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;

/// `N` finite numbers separated by commas, semicolons or white space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Numbers<const N: usize>(pub(super) [f64; N]);

/// Why a text is not so many numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum NumbersError {
    Count { want: usize, got: usize },
    NotFinite(String),
}

impl std::error::Error for NumbersError {}

impl fmt::Display for NumbersError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count { want, got } => {
                write!(f, "expected {want} numbers separated by commas, found {got}")
            }
            Self::NotFinite(text) => write!(f, "`{text}` is not a finite number"),
        }
    }
}

impl<const N: usize> FromStr for Numbers<N> {
    type Err = NumbersError;

    fn from_str(text: &str) -> Result<Self, NumbersError> {
        let list = list(text)?;
        let got = list.len();
        list.try_into().map(Self).map_err(|_| NumbersError::Count { want: N, got })
    }
}

impl From<Numbers<3>> for DVec3 {
    fn from(numbers: Numbers<3>) -> Self {
        Self::from_array(numbers.0)
    }
}

/// Any number of finite numbers.
pub(super) fn list(text: &str) -> Result<Vec<f64>, NumbersError> {
    text.split(|c: char| c == ',' || c == ';' || c.is_whitespace())
        .filter(|word| !word.is_empty())
        .map(|word| {
            let number: Option<f64> = word.parse().ok();
            number
                .filter(|x| x.is_finite())
                .ok_or_else(|| NumbersError::NotFinite(word.to_owned()))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_and_spaces_separate() {
        for text in ["1,-2.5,3e2", " 1 -2.5 3e2 ", "1, -2.5; 3e2", "1\t-2.5\t3e2"] {
            assert_eq!(text.parse(), Ok(Numbers([1.0, -2.5, 300.0])), "{text}");
        }
    }

    #[test]
    fn what_is_no_number_is_named() {
        let error = "1,2".parse::<Numbers<3>>().unwrap_err();
        assert_eq!(error.to_string(), "expected 3 numbers separated by commas, found 2");
        let error = "1,nan,3".parse::<Numbers<3>>().unwrap_err();
        assert_eq!(error.to_string(), "`nan` is not a finite number");
        assert!("1,x,3".parse::<Numbers<3>>().is_err());
    }
}

//! Options as they were typed, beside what they mean: for commands that others are to repeat.

use std::ffi::OsString;

use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Args, Command, Error, FromArgMatches, Id};

/// A group of options, and the words that were typed for it.
#[derive(Clone, Debug)]
pub(super) struct Typed<A> {
    pub(super) meant: A,
    /// Each option with its value in one word, without those that were left out.
    pub(super) words: Vec<OsString>,
}

impl<A: Args> FromArgMatches for Typed<A> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        Self::from_arg_matches_mut(&mut matches.clone())
    }

    fn from_arg_matches_mut(matches: &mut ArgMatches) -> Result<Self, Error> {
        // Before their meaning is taken out of the matches.
        let words = words::<A>(matches);
        Ok(Self { meant: A::from_arg_matches_mut(matches)?, words })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl<A: Args> Args for Typed<A> {
    fn augment_args(command: Command) -> Command {
        A::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        A::augment_args_for_update(command)
    }

    fn group_id() -> Option<Id> {
        A::group_id()
    }
}

fn words<A: Args>(matches: &ArgMatches) -> Vec<OsString> {
    let group = A::augment_args(Command::new("group"));
    let is_typed = |arg: &&Arg| {
        matches.value_source(arg.get_id().as_str()) == Some(ValueSource::CommandLine)
    };
    group.get_arguments().filter(is_typed).flat_map(|arg| of_one(arg, matches)).collect()
}

/// The words of one option, which may be given several times.
fn of_one(arg: &Arg, matches: &ArgMatches) -> Vec<OsString> {
    let (flag, equals) = match (arg.get_long(), arg.get_short()) {
        (Some(long), _) => (format!("--{long}"), "="),
        (None, Some(short)) => (format!("-{short}"), ""),
        // What has a place and no name is no option.
        (None, None) => return Vec::new(),
    };
    if !arg.get_action().takes_values() {
        return vec![flag.into()];
    }
    let word = |value: &std::ffi::OsStr| {
        let mut word = OsString::from(format!("{flag}{equals}"));
        word.push(value);
        word
    };
    matches.get_raw(arg.get_id().as_str()).into_iter().flatten().map(word).collect()
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::super::input::Reading;
    use super::super::sampling::SamplingArgs;
    use super::*;

    #[derive(Parser, Debug)]
    struct Line {
        #[command(flatten)]
        sampling: Typed<SamplingArgs>,
        #[command(flatten)]
        reading: Typed<Reading>,
    }

    #[test]
    fn what_was_typed_is_kept_and_nothing_else() {
        let words = |args: &[&str]| {
            let line = Line::try_parse_from([&["line"], args].concat()).expect("options");
            assert_eq!(line.sampling.meant.meant().seed, 7);
            [line.sampling.words, line.reading.words]
        };
        let none: [&str; 0] = [];
        assert_eq!(words(&["--seed", "7"]), [vec!["--seed=7"], none.to_vec()]);
        let all = words(&[
            "-D",
            "x=-1",
            "--seed=7",
            "--allow-outside",
            "-Dname=\"a b\"",
            "--rel-tol",
            "1e-3",
        ]);
        assert_eq!(all[0], ["--rel-tol=1e-3", "--seed=7"]);
        assert_eq!(all[1], ["-Dx=-1", "-Dname=\"a b\"", "--allow-outside"]);
    }
}

//! `solidray completions` and `solidray man`: what other programs know of the command line.

use std::io::Write;

use anyhow::Context;
use clap::{Args, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;

use super::{Answer, Cli};

/// Print a script that completes commands and options in a shell
///
/// For bash: solidray completions bash > ~/.local/share/bash-completion/completions/solidray
#[derive(Args, Debug)]
pub(super) struct Completions {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

/// Print a page of the manual
///
/// To read one: solidray man render | man -l -
#[derive(Args, Debug)]
pub(super) struct ManPage {
    /// The command the page is about [default: the program]
    command: Option<String>,
}

impl Completions {
    pub(super) fn run(&self, out: &mut dyn Write) -> anyhow::Result<Answer> {
        // Written to memory first: the generator panics where writing fails.
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), "solidray", &mut script);
        out.write_all(&script)?;
        Ok(Answer::Yes)
    }
}

impl ManPage {
    pub(super) fn run(&self, out: &mut dyn Write) -> anyhow::Result<Answer> {
        let mut program = Cli::command();
        program.build();
        let page = match &self.command {
            None => program,
            Some(name) => program
                .find_subcommand(name)
                .with_context(|| format!("there is no command `{name}`"))?
                .clone(),
        };
        Man::new(page).render(out)?;
        Ok(Answer::Yes)
    }
}

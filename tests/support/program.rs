//! Programs that some tests need.

use std::process::{Command, Stdio};

/// Whether a program runs and knows an option; what is done without it is said. Where a variable of
/// the environment says that it must be there, its absence is a failure.
#[expect(clippy::print_stderr, reason = "a check left out is not left out in silence")]
pub(crate) fn is_installed(
    program: &str,
    option: &str,
    required: &str,
    without: &str,
) -> bool {
    let found = runs(program, option);
    if !found {
        let is_required = std::env::var_os(required).is_some();
        assert!(
            !is_required,
            "{program} is required here, but `{program} {option}` fails"
        );
        eprintln!("{program} is not installed: {without}");
    }
    found
}

/// Whether a program runs and knows an option. Some systems have programs that only say how to
/// install others.
pub(crate) fn runs(program: &str, option: &str) -> bool {
    let silent = || Stdio::null();
    let mut command = Command::new(program);
    let command = command.arg(option).stdin(silent()).stdout(silent()).stderr(silent());
    command.status().is_ok_and(|status| status.success())
}

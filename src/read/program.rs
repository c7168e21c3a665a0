//! The installed OpenSCAD, run for at most so long.

use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::ReadOptions;
use super::error::ReadErrorKind;

/// How the program ended.
#[derive(Debug)]
pub(super) struct Done {
    pub(super) status: ExitStatus,
    /// What it said on standard error, of a very long speech the beginning.
    pub(super) said: String,
}

/// Why it did not end by itself.
#[derive(Debug)]
pub(super) enum Fault {
    /// There is no such program.
    Missing { program: PathBuf },
    /// What else can be wrong.
    Other(ReadErrorKind),
}

/// Which program it is; with its folder, if it was given with one, because it may be run in another.
fn name(options: &ReadOptions) -> io::Result<PathBuf> {
    match &options.openscad {
        Some(program) if program.components().count() > 1 => std::path::absolute(program),
        Some(program) => Ok(program.clone()),
        None => Ok(PathBuf::from("openscad")),
    }
}

/// A file that is its standard input.
pub(super) fn input(text: &[u8]) -> io::Result<Stdio> {
    // A pipe would have to be filled while somebody looks at the clock.
    let mut file = tempfile::tempfile()?;
    file.write_all(text)?;
    file.seek(SeekFrom::Start(0))?;
    Ok(file.into())
}

/// Lets the program make a file of another one, with more arguments in between.
///
/// It stays in the group of processes of this one, so that Ctrl-C on a terminal ends both. Beyond
/// [`ReadOptions::openscad_limit`] it is killed; what it has started itself is not.
pub(super) fn run(
    made: &Path,
    of: &OsStr,
    options: &ReadOptions,
    more: impl FnOnce(&mut Command) -> io::Result<()>,
) -> Result<Done, Fault> {
    let other = |error| Fault::Other(ReadErrorKind::Io(error));
    let mut log = tempfile::tempfile().map_err(other)?;
    let program = name(options).map_err(other)?;
    let mut command = Command::new(&program);
    // Without --render, $preview is true and many models leave parts out.
    command.arg("--render=1").arg("-o").arg(made);
    command.stdin(Stdio::null()).stdout(Stdio::null());
    command.stderr(log.try_clone().map_err(other)?);
    more(&mut command).map_err(other)?;
    let mut child = match command.arg(of).spawn() {
        Ok(child) => child,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return Err(Fault::Missing { program });
        }
        Err(error) => return Err(other(error)),
    };
    let (start, limit) = (Instant::now(), options.openscad_limit);
    let status = loop {
        if let Some(status) = child.try_wait().map_err(other)? {
            break status;
        }
        if start.elapsed() > limit {
            child.kill().and_then(|()| child.wait()).map_err(other)?;
            let seconds = limit.as_secs_f64();
            return Err(Fault::Other(ReadErrorKind::OpenscadSlow { seconds }));
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let said = speech(&mut log).map_err(other)?;
    Ok(Done { status, said })
}

/// What is in its log.
fn speech(log: &mut File) -> io::Result<String> {
    const MOST: u64 = 1 << 20;
    let mut said = Vec::new();
    log.seek(SeekFrom::Start(0))?;
    log.take(MOST).read_to_end(&mut said)?;
    Ok(String::from_utf8_lossy(&said).trim().to_owned())
}

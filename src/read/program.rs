//! The installed OpenSCAD, run for at most so long.

use std::ffi::OsStr;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, Mutex};
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
    let program = name(options).map_err(other)?;
    let mut command = Command::new(&program);
    // Without --render, $preview is true and many models leave parts out.
    command.arg("--render=1").arg("-o").arg(made);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    more(&mut command).map_err(other)?;
    let mut child = match command.arg(of).spawn() {
        Ok(child) => child,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return Err(Fault::Missing { program });
        }
        Err(error) => return Err(other(error)),
    };
    let speech = child.stderr.take().map(Speech::of);
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
    Ok(Done { status, said: speech.map(Speech::end).unwrap_or_default() })
}

/// What a program says, of which the beginning is kept.
struct Speech {
    beginning: Arc<Mutex<Vec<u8>>>,
    end: Receiver<()>,
}

impl Speech {
    /// How much of it is kept: 1 MiB.
    const MOST: usize = 1 << 20;

    /// Listens in a thread of its own, so that the program never waits for somebody to listen.
    fn of(mut said: impl Read + Send + 'static) -> Self {
        let beginning = Arc::new(Mutex::new(Vec::new()));
        let (send, end) = mpsc::channel();
        let kept = beginning.clone();
        std::thread::spawn(move || {
            let mut some = [0; 1 << 13];
            while let Ok(length @ 1..) = said.read(&mut some) {
                let Ok(mut kept) = kept.lock() else { return };
                let room = Self::MOST - kept.len();
                kept.extend_from_slice(&some[..length.min(room)]);
            }
            // Nobody waits for it if the program was too slow.
            let _ = send.send(());
        });
        Self { beginning, end }
    }

    /// All of it, when the program has ended. What that has started itself may go on, and hold its
    /// standard error: it is not waited for.
    fn end(self) -> String {
        let _ = self.end.recv_timeout(Duration::from_secs(1));
        let beginning = self.beginning.lock();
        let bytes = beginning.map(|bytes| bytes.clone()).unwrap_or_default();
        String::from_utf8_lossy(&bytes).trim().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_long_speech_the_beginning_is_kept() {
        let speech = Speech::of(io::repeat(b'a').take(5 << 20));
        assert_eq!(speech.end().len(), Speech::MOST);
        assert_eq!(Speech::of(&b" all is well\n"[..]).end(), "all is well");
        assert_eq!(Speech::of(io::empty()).end(), "");
    }
}

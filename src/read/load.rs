//! Files into memory, as far as they may be long.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::error::ReadErrorKind;

/// How many bytes may be read, and how many have been.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    limit: u64,
    left: u64,
}

impl Budget {
    pub(super) fn new(limit: u64) -> Self {
        Self { limit, left: limit }
    }

    /// Counts bytes that are in memory.
    pub(super) fn spend(&mut self, bytes: &[u8]) -> Result<(), ReadErrorKind> {
        let left = self.left.checked_sub(bytes.len() as u64);
        self.left = left.ok_or(ReadErrorKind::TooManyBytes { limit: self.limit })?;
        Ok(())
    }

    /// The bytes of a file. Pipes and devices do not say how long they are, so no more is
    /// read than there may be, whatever the file says.
    pub(super) fn load(&mut self, path: &Path) -> Result<Vec<u8>, ReadErrorKind> {
        let file = File::open(path).map_err(ReadErrorKind::Io)?;
        let said = file.metadata().map_or(0, |metadata| metadata.len());
        if said > self.left {
            return Err(ReadErrorKind::TooManyBytes { limit: self.limit });
        }
        self.drain(file, said)
    }

    /// The bytes that something yields until it ends, of which it says how many there are at
    /// least.
    pub(super) fn drain(
        &mut self,
        from: impl Read,
        said: u64,
    ) -> Result<Vec<u8>, ReadErrorKind> {
        let mut bytes = Vec::new();
        let room = usize::try_from(said).unwrap_or(usize::MAX);
        bytes.try_reserve_exact(room).map_err(|_| {
            ReadErrorKind::Io(io::Error::from(io::ErrorKind::OutOfMemory))
        })?;
        let mut some = from.take(self.left.saturating_add(1));
        some.read_to_end(&mut bytes).map_err(ReadErrorKind::Io)?;
        self.spend(&bytes)?;
        Ok(bytes)
    }
}

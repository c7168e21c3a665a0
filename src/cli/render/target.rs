//! Where pictures go.

use std::io::{Seek, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use tempfile::{SpooledTempFile, spooled_tempfile_in};

use super::super::output;
use super::numbers::IN_MEMORY;

/// The file or the files that are written.
pub(super) struct Target {
    path: PathBuf,
    format: Format,
    /// How many pictures there are, if they are numbered.
    count: Option<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    /// Colours in 8 bits, or grey in 16.
    Png,
    /// Numbers in 32 bits.
    Tiff,
}

impl Target {
    /// Refuses what would only be found out after the work.
    pub(super) fn new(path: &Path, count: Option<u32>) -> anyhow::Result<Self> {
        let is_standard_output = path.as_os_str() == "-";
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let format = match extension.as_deref() {
            _ if is_standard_output => Format::Png,
            Some("png") => Format::Png,
            Some("tif" | "tiff") => Format::Tiff,
            _ => bail!(
                "{}: pictures are written as .png, and depths and thicknesses as .tiff as well",
                path.display()
            ),
        };
        output::check_folder(path)?;
        if is_standard_output && count.is_some() {
            bail!("standard output takes one picture, not those of a turntable");
        }
        Ok(Self { path: path.to_owned(), format, count })
    }

    pub(super) fn is_standard_output(&self) -> bool {
        self.path.as_os_str() == "-"
    }

    /// Whether numbers are wanted and not colours.
    pub(super) fn takes_numbers(&self) -> bool {
        self.format == Format::Tiff
    }

    /// The name of one of the pictures.
    pub(super) fn name(&self, index: u32) -> PathBuf {
        let Some(count) = self.count else { return self.path.clone() };
        let digits = (count - 1).to_string().len().max(3);
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let extension = self.path.extension().unwrap_or_default().to_string_lossy();
        self.path.with_file_name(format!("{stem}-{index:0digits$}.{extension}"))
    }

    /// Where there is room for what is being made: the folder of the pictures.
    pub(super) fn folder(&self) -> PathBuf {
        match self.path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
            _ if self.is_standard_output() => std::env::temp_dir(),
            _ => PathBuf::from("."),
        }
    }

    /// Writes one of the pictures, whole or not at all.
    pub(super) fn write(
        &self,
        index: u32,
        make: impl FnOnce(&mut SpooledTempFile) -> anyhow::Result<()>,
        out: &mut dyn Write,
    ) -> anyhow::Result<()> {
        let mut file = spooled_tempfile_in(IN_MEMORY, self.folder());
        make(&mut file).with_context(|| self.name(index).display().to_string())?;
        file.rewind()?;
        if self.is_standard_output() {
            std::io::copy(&mut file, out)?;
            return Ok(());
        }
        output::save_from(&self.name(index), &mut file)
    }
}

//! A picture of numbers, which have no colours until all of them are known.

use std::io::{self, Read, Seek, Write};
use std::path::Path;

use tempfile::{SpooledTempFile, spooled_tempfile_in};

/// How much is kept in memory; more is kept in a file without a name.
pub(super) const IN_MEMORY: usize = 64 << 20;

/// How many numbers are looked at at once, unless a row has more.
const BAND: u32 = 1 << 20;

/// A number for each pixel, row by row from the upper left.
pub(super) struct Numbers {
    size: [u32; 2],
    file: SpooledTempFile,
    /// The least and the largest of those that are finite.
    pub(super) range: Option<[f32; 2]>,
}

impl Numbers {
    /// Keeps numbers in a folder as they come.
    pub(super) fn kept(
        folder: &Path,
        size: [u32; 2],
        bands: impl Iterator<Item = Vec<f32>>,
    ) -> io::Result<Self> {
        let mut numbers =
            Self { size, file: spooled_tempfile_in(IN_MEMORY, folder), range: None };
        for band in bands {
            let finite = band.iter().copied().filter(|n| n.is_finite());
            numbers.range = finite.map(|n| [n, n]).chain(numbers.range).reduce(joined);
            let bytes: Vec<u8> = band.into_iter().flat_map(f32::to_le_bytes).collect();
            numbers.file.write_all(&bytes)?;
        }
        Ok(numbers)
    }

    /// How many rows are in each of the bands but the last.
    pub(super) fn rows_per_band(&self) -> u32 {
        let [width, height] = self.size;
        (BAND / width.max(1)).clamp(1, height.max(1))
    }

    /// All of them, in bands of whole rows.
    pub(super) fn bands(
        &mut self,
    ) -> io::Result<impl Iterator<Item = io::Result<Vec<f32>>> + '_> {
        let [width, height] = self.size;
        let step = self.rows_per_band();
        self.file.rewind()?;
        let file = &mut self.file;
        let starts = (0..height.div_ceil(step)).map(move |i| i * step);
        Ok(starts.map(move |start| {
            let rows = step.min(height - start);
            let mut bytes = vec![0; 4 * width as usize * rows as usize];
            file.read_exact(&mut bytes)?;
            let (numbers, _) = bytes.as_chunks();
            Ok(numbers.iter().map(|number| f32::from_le_bytes(*number)).collect())
        }))
    }
}

/// The range that holds two ranges.
pub(super) fn joined([a, b]: [f32; 2], [c, d]: [f32; 2]) -> [f32; 2] {
    [a.min(c), b.max(d)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back() {
        // More than is kept in memory, and more than a band.
        let size = [5000, 4001];
        let all = |i: u32| if i.is_multiple_of(11) { f32::NAN } else { i as f32 };
        let row = |y: u32| (0..size[0]).map(|x| all(y * size[0] + x)).collect();
        let folder = std::env::temp_dir();
        let mut numbers =
            Numbers::kept(&folder, size, (0..size[1]).map(row)).expect("a file");
        assert_eq!(numbers.range, Some([1.0, all(size[0] * size[1] - 1)]));
        for _ in 0..2 {
            let mut next = 0;
            for band in numbers.bands().expect("bands") {
                for number in band.expect("a band") {
                    assert_eq!(number.to_bits(), all(next).to_bits());
                    next += 1;
                }
            }
            assert_eq!(next, size[0] * size[1]);
        }
    }
}

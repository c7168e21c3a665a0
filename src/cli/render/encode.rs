//! Pictures as the bytes of files, band by band.

use std::io::{self, Seek, Write};

use image::RgbImage;
use png::{BitDepth, ColorType, Encoder};
use tiff::encoder::{TiffEncoder, colortype::Gray32Float};

/// Colours in 8 bits.
pub(super) fn png(
    out: impl Write,
    size: [u32; 2],
    bands: impl Iterator<Item = io::Result<RgbImage>>,
) -> anyhow::Result<()> {
    let encoder = encoder(out, size, ColorType::Rgb, BitDepth::Eight);
    rows(encoder, bands.map(|band| Ok(band?.into_raw())))
}

/// Grey in 16 bits, with a comment on what it means.
pub(super) fn png16(
    out: impl Write,
    size: [u32; 2],
    comment: String,
    bands: impl Iterator<Item = io::Result<Vec<u16>>>,
) -> anyhow::Result<()> {
    let mut encoder = encoder(out, size, ColorType::Grayscale, BitDepth::Sixteen);
    encoder.add_itxt_chunk("Comment".to_owned(), comment)?;
    let bytes = |band: Vec<u16>| band.into_iter().flat_map(u16::to_be_bytes).collect();
    rows(encoder, bands.map(|band| Ok(bytes(band?))))
}

/// Numbers in 32 bits.
pub(super) fn tiff(
    out: impl Write + Seek,
    [width, height]: [u32; 2],
    rows_per_band: u32,
    bands: impl Iterator<Item = io::Result<Vec<f32>>>,
) -> anyhow::Result<()> {
    let mut encoder = TiffEncoder::new(out)?;
    let mut image = encoder.new_image::<Gray32Float>(width, height)?;
    image.rows_per_strip(rows_per_band)?;
    for band in bands {
        image.write_strip(&band?)?;
    }
    Ok(image.finish()?)
}

fn encoder<W: Write>(
    out: W,
    [width, height]: [u32; 2],
    color: ColorType,
    depth: BitDepth,
) -> Encoder<'static, W> {
    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    encoder
}

fn rows<W: Write>(
    encoder: Encoder<'_, W>,
    bands: impl Iterator<Item = io::Result<Vec<u8>>>,
) -> anyhow::Result<()> {
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer()?;
    for band in bands {
        stream.write_all(&band?)?;
    }
    stream.finish()?;
    // Left to itself it would not say whether the end was written.
    Ok(writer.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file on a disk with so much room.
    struct Full(usize);

    impl Write for Full {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let length = bytes.len().min(self.0);
            self.0 -= length;
            if length == 0 { Err(io::ErrorKind::StorageFull.into()) } else { Ok(length) }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_picture_without_its_end_is_an_error() {
        let bands = || (0..3).map(|_| Ok(RgbImage::new(8, 4)));
        let mut whole = Vec::new();
        png(&mut whole, [8, 12], bands()).expect("memory");
        for room in 0..whole.len() {
            assert!(png(Full(room), [8, 12], bands()).is_err(), "{room}");
        }
        assert!(png(Full(whole.len()), [8, 12], bands()).is_ok());
    }
}

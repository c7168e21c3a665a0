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
    Ok(stream.finish()?)
}

//! Any bytes as `.3mf`, or as the text in one.

#![no_main]

use std::io::{Cursor, Write};

use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use solidray::read::{Format, ReadOptions};
use zip::result::ZipResult;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// What leads from an archive to the text of its model.
const RELATIONSHIPS: &[u8] = b"<Relationships><Relationship Target=\"/a\" \
    Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";

fuzz_target!(|bytes: &[u8]| {
    let options = ReadOptions { max_bytes: 1 << 22, ..ReadOptions::default() };
    if bytes.starts_with(b"PK") {
        solidray_fuzz::check(bytes, Format::ThreeMf, &options);
    } else if let Ok(archive) = archive(bytes) {
        solidray_fuzz::check(&archive, Format::ThreeMf, &options);
    }
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    if seed.is_multiple_of(2) {
        return fuzzer_mutate(data, size, max_size);
    }
    solidray_fuzz::words::mutate(&mut data[..max_size], size, seed)
});

/// An archive with a model, which is not packed.
fn archive(model: &[u8]) -> ZipResult<Vec<u8>> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in [("_rels/.rels", RELATIONSHIPS), ("a", model)] {
        let options =
            SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        archive.start_file(name, options)?;
        archive.write_all(bytes)?;
    }
    Ok(archive.finish()?.into_inner())
}

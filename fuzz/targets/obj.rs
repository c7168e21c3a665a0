//! Any bytes as .obj.

#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use solidray::read::{Format, ReadOptions};

fuzz_target!(|bytes: &[u8]| {
    solidray_fuzz::check(bytes, Format::Obj, &ReadOptions::default());
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    if seed.is_multiple_of(2) {
        return fuzzer_mutate(data, size, max_size);
    }
    solidray_fuzz::words::mutate(&mut data[..max_size], size, seed)
});

//! Any bytes as `.csg`, with curves as the first byte says.

#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use solidray::read::{Curves, Format, ReadOptions};

fuzz_target!(|bytes: &[u8]| {
    let Some((&first, text)) = bytes.split_first() else { return };
    let curves = match first % 3 {
        0 => Curves::Auto,
        1 => Curves::Exact,
        _ if is_coarse(text) => Curves::Faceted,
        _ => return,
    };
    // No other program is started.
    let openscad = Some("no-such-program".into());
    let options = ReadOptions { curves, openscad, ..ReadOptions::default() };
    solidray_fuzz::check(text, Format::Csg, &options);
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    if seed.is_multiple_of(2) {
        return fuzzer_mutate(data, size, max_size);
    }
    solidray_fuzz::words::mutate(&mut data[..max_size], size, seed)
});

/// Whether all curves of a text have few facets for certain: one line can ask for millions,
/// which is legal and takes seconds.
fn is_coarse(text: &[u8]) -> bool {
    let text = String::from_utf8_lossy(text);
    let numbers = |name: &'static str| {
        text.split(name).skip(1).map(|rest| {
            let rest = rest.trim_start_matches([' ', '=', '-']);
            let end = rest.find([',', ')', ' ']).unwrap_or(rest.len());
            rest[..end].parse().unwrap_or(f64::NAN)
        })
    };
    numbers("$fn").all(|n: f64| n < 40.0)
        && numbers("$fa").chain(numbers("$fs")).all(|n: f64| n >= 1.0)
}

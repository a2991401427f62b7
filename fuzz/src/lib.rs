//! What the fuzzers share: the targets, which the tests of the crate run too, and changes to texts that libFuzzer, which
//! knows bytes only, does not hit upon.

#[path = "../../tests/suite/files/fuzz/mod.rs"]
pub mod targets;

use std::sync::OnceLock;

pub use libfuzzer_sys;
use targets::{Dictionary, Random, mutated, target};

/// Changes the first `size` bytes of `data` and returns how many there are then, at most `most`: a text mostly by its words.
pub fn mutate(name: &str, data: &mut [u8], (size, most): (usize, usize), seed: u32) -> usize {
    static DICTIONARY: OnceLock<Dictionary> = OnceLock::new();
    let dictionary = DICTIONARY.get_or_init(|| Dictionary::read(target(name).dictionary));
    match std::str::from_utf8(&data[..size]) {
        Ok(text) if !seed.is_multiple_of(4) => {
            let text = mutated(text, dictionary, &mut Random(seed.into()));
            let length = text.floor_char_boundary(most);
            data[..length].copy_from_slice(&text.as_bytes()[..length]);
            length
        }
        _ => libfuzzer_sys::fuzzer_mutate(data, size, most),
    }
}

/// The fuzzer of one target.
#[macro_export]
macro_rules! fuzz {
    ($name:literal) => {
        use $crate::libfuzzer_sys;

        libfuzzer_sys::fuzz_target!(|data: &[u8]| {
            static TARGET: std::sync::LazyLock<&$crate::targets::Target> =
                std::sync::LazyLock::new(|| $crate::targets::target($name));
            (TARGET.run)(data);
        });

        libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
            $crate::mutate($name, data, (size, max_size), seed)
        });
    };
}

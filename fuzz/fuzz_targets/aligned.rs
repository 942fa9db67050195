#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    continuum_testing::fuzz::aligned(bytes);
});

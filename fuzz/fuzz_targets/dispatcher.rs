#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| parry_continuum_fuzz::bodies::dispatcher(bytes));

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| cellcaster_fuzz::checkpoint::run(data));

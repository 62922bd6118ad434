//! Any bytes as a file of this format.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| hexfill_fuzz::read(data, hexfill_io::Format::Unv));

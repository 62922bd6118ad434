//! Any bytes as a packed OFF file: the first byte chooses gzip or Zstandard, whose magic is put in front.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Some((choice, rest)) = data.split_first() else { return };
    let magic: &[u8] = if choice % 2 == 0 { &[0x1f, 0x8b, 8] } else { &[0x28, 0xb5, 0x2f, 0xfd] };
    hexfill_fuzz::check(&[magic, rest].concat(), hexfill_io::Format::Off);
});

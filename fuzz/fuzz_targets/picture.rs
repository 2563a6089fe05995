//! Pictures of the sky: OpenEXR and Radiance HDR; finished frames.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| floe_fuzz::picture(bytes));

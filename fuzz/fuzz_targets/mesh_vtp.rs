//! VTK's XML.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| floe_fuzz::mesh(floe::mesh::Syntax::Vtp, false, bytes));

//! Binary OBJ, and the velocities beside it.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| floe_fuzz::mesh(floe::mesh::Syntax::Bobj, false, bytes));

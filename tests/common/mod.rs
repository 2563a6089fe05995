//! What the tests of light transport share: scenes made on the spot, renders through the library, statistics.

// Each test file is a crate of its own and uses a part of this one.
#![allow(dead_code, unused_imports)]

pub mod files;
pub mod mesh;
pub mod numbers;
pub mod reference;
pub mod render;
pub mod scene;

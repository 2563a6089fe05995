//! Meshes that overlap: the strongest is there, whatever the others say.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../photons/seeds.rs"]
#[allow(dead_code)]
mod seeds;

mod floes;
mod furnace;
mod plates;
mod refused;
mod shapes;
mod straight;
mod tanks;

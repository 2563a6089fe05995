//! What may be done to a scene without changing its picture: it may be scaled, turned and moved, its labels renamed, its
//! triangles put in another order or split, and surfaces added that bend nothing.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../small/mod.rs"]
mod small;

mod bodies;
mod meshes;
mod nothing;
mod pictures;
mod places;

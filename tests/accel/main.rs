//! The hierarchy against brute force, aimed rays against leaks, and independence of the tree.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // a test that cannot go on fails

mod agreement;
mod brute_force;
mod leaks;
mod meshes;
mod odd;

//! A page that shows a watch in a browser on this machine: newest picture, filmstrip, state, error against time.
//!
//! ```text
//! GET /                  the page; it holds all that it needs
//! GET /status.json       state and frames that changed, since ?since=REVISION
//! GET /latest.png        the newest picture
//! GET /frame/NUMBER.png  the picture of a frame
//! GET /thumb/NUMBER.png  the same, small
//! ```
//! Names of frames are looked up in a table and never become part of a path. Nothing can be changed from the page.

mod board;
mod http;
mod server;
mod thumbnail;

pub use board::{Board, Both};
pub use server::serve;

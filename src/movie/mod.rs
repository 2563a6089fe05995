//! From the pictures of a sequence to something to look at: a movie, or a sheet of small pictures.
//!
//! * [`pictures`] finds the pictures of a scene, a folder or a pattern, and shows an EXR as its PNG would.
//! * [`encode`](mod@encode) lets an installed ffmpeg make a movie of them.
//! * [`sheet`] puts them all into one picture, with their numbers beneath.

mod digits;
pub mod encode;
pub mod error;
pub mod pictures;
pub mod sheet;

pub use encode::{EncodeOptions, encode};
pub use error::MovieError;
pub use pictures::{FRAME_RATES, Pictures};
pub use sheet::contact_sheet;

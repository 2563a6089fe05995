//! Texts that C may read: each thread has one of each kind, which stays until the thread asks for another of that kind.

use std::cell::RefCell;
use std::ffi::{CString, c_char};

thread_local! {
    /// Of the last call on this thread that failed without a scene.
    static WITHOUT_SCENE: RefCell<String> = const { RefCell::new(String::new()) };
    static MESSAGE: RefCell<CString> = RefCell::default();
    static RECORD: RefCell<CString> = RefCell::default();
}

/// Keeps what is wrong with a call that had no scene.
pub(super) fn keep_without_scene(text: &str) {
    WITHOUT_SCENE.with_borrow_mut(|kept| text.clone_into(kept));
}

/// What was wrong with the last such call.
pub(super) fn without_scene() -> String {
    WITHOUT_SCENE.with_borrow(Clone::clone)
}

/// Lends a message.
pub(super) fn lend_message(text: String) -> *const c_char {
    MESSAGE.with(|place| lend(place, text))
}

/// Lends a record.
pub(super) fn lend_record(text: String) -> *const c_char {
    RECORD.with(|place| lend(place, text))
}

fn lend(place: &RefCell<CString>, text: String) -> *const c_char {
    // Paths may have anything in them, but the text ends at the first zero.
    let text = CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default();
    place.replace(text);
    place.borrow().as_ptr()
}

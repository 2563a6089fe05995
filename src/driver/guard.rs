//! Panics over one frame, as errors of that frame: what floe fails on does not cost the others.
//!
//! Nothing that guarded work leaves half done may be used after it has failed.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use super::error::RenderError;

/// Does some work, or tells what it panicked of.
pub(crate) fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("it does not say why").into()
    })
}

/// Does some work on a file, and makes a panic an error of that file.
pub(super) fn guarded<T>(
    path: &Path,
    work: impl FnOnce() -> Result<T, RenderError>,
) -> Result<T, RenderError> {
    caught(work).unwrap_or_else(|reason| Err(RenderError::Fault { path: path.into(), reason }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::driver::error::Blame;

    #[test]
    fn a_panic_is_an_error_of_its_file() {
        let path = Path::new("a/frame_7.vtp");
        assert_eq!(guarded(path, || Ok(7)).unwrap(), 7);
        let passed_on = guarded(path, || Err::<(), _>(RenderError::Interrupted));
        assert!(matches!(passed_on, Err(RenderError::Interrupted)));
        let number = 7;
        for error in [
            guarded(path, || -> Result<(), _> { panic!("index {number}") }).unwrap_err(),
            guarded(path, || -> Result<(), _> { panic!("index 7") }).unwrap_err(),
        ] {
            let text = error.to_string();
            assert!(text.starts_with("a/frame_7.vtp: ") && text.contains("(index 7)"), "{text}");
            assert!(text.contains("report"), "{text}");
            assert_eq!(error.blame(), Blame::Internal);
        }
    }
}

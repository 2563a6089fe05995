//! Why a picture was not denoised.

/// What a denoiser lacks. The picture with its noise is not concerned.
#[derive(Debug, thiserror::Error)]
pub enum DenoiseError {
    /// The program was built without it.
    #[error(
        "this floe cannot denoise: build it with `cargo install --path . --features denoise`, or render without --denoise \
         and output.denoise"
    )]
    NotBuilt,
    /// The library is not there, or is not one that can be used.
    #[error(
        "Open Image Denoise 2 was not found ({tried}); install it (openimagedenoise.org, or `pip download pyoidn` and unzip \
         it) and let FLOE_OIDN name the file or the folder of libOpenImageDenoise.so.2, or render without --denoise and \
         output.denoise"
    )]
    NotFound {
        /// What was tried, with the system's reasons.
        tried: String,
    },
    /// The library says no.
    #[error("Open Image Denoise failed: {reason}; render without --denoise and output.denoise")]
    Failed {
        /// What it says.
        reason: String,
    },
}

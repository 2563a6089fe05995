//! Pictures without noise, by Intel Open Image Denoise 2 (`[OIDN]`), which the user has installed.
//!
//! It gets the mean radiance of each pixel, and to guide it the albedo and the normal of the first surfaces, which are
//! nearly free of noise. It guesses: detail may be smoothed away and may flicker from frame to frame, so the picture with
//! its noise is always kept. What it takes for a fault, it changes: components below 0 become 0. Its result
//! depends on its version and on the processor; the bytes of denoised files are not the same everywhere.
//!
//! The library is looked for at run time: the file or folder that `FLOE_OIDN` names, else the system's own places. The
//! ignored test in `tests/denoise.rs` runs it.

mod error;
#[cfg(feature = "denoise")]
mod library;

pub use error::DenoiseError;

use super::accumulate::Pixel;
use super::frame_image::FrameImage;

/// A library that takes the noise out of pictures.
#[derive(Debug)]
pub struct Denoiser {
    #[cfg(feature = "denoise")]
    library: library::Library,
}

impl Denoiser {
    /// Loads the library.
    ///
    /// # Errors
    /// [`DenoiseError::NotBuilt`] without the feature `denoise`, else when the library is not there or is another one.
    #[cfg(feature = "denoise")]
    pub fn load() -> Result<Self, DenoiseError> {
        Ok(Self { library: library::Library::load()? })
    }

    /// Tells that this program cannot denoise.
    ///
    /// # Errors
    /// Always.
    #[cfg(not(feature = "denoise"))]
    pub fn load() -> Result<Self, DenoiseError> {
        Err(DenoiseError::NotBuilt)
    }

    /// The picture without its noise. All but the radiance is as it was; its variance is unknown.
    ///
    /// # Errors
    /// [`DenoiseError::Failed`] with what the library says.
    pub fn denoised(&self, image: &FrameImage) -> Result<FrameImage, DenoiseError> {
        let radiance = self.filtered(image)?;
        let pixels = image.pixels.iter().zip(radiance);
        let clean = |(pixel, rgb): (&Pixel, [f32; 3])| Pixel { rgb: rgb.into(), replicates: 0, ..*pixel };
        Ok(FrameImage { width: image.width, height: image.height, pixels: pixels.map(clean).collect() })
    }

    #[cfg(feature = "denoise")]
    fn filtered(&self, image: &FrameImage) -> Result<Vec<[f32; 3]>, DenoiseError> {
        let layer = |value: fn(&Pixel) -> glam::Vec3| -> Vec<[f32; 3]> {
            image.pixels.iter().map(|pixel| value(pixel).to_array()).collect()
        };
        let guides = [layer(|pixel| pixel.albedo), layer(|pixel| pixel.normal)];
        self.library.run([image.width, image.height], &layer(|pixel| pixel.rgb), &guides)
    }

    #[cfg(not(feature = "denoise"))]
    fn filtered(&self, _: &FrameImage) -> Result<Vec<[f32; 3]>, DenoiseError> {
        Err(DenoiseError::NotBuilt)
    }
}

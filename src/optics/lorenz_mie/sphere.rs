//! A sphere in a host.

use num_complex::Complex64;

/// Least 2 pi r / lambda: the squares of coefficients, which fall as its sixth power, have all digits there.
const SMALLEST: f64 = 1e-20;
/// Greatest |x|: there the coefficients take 64 MB.
const LARGEST_HOST: f64 = 1e6;
/// Greatest |y|: the recurrence that begins there takes seconds.
const LARGEST_PARTICLE: f64 = 1e8;
/// Greatest Im x: of the light on one side of the sphere exp(-600) comes to the other. The square of a_1 is exp(600) then,
/// and f64 ends at exp(709).
const DARKEST_HOST: f64 = 150.0;

/// A sphere in a host, at one wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    particle: Complex64,
    host: Complex64,
    size: f64,
}

/// Why there is no such sphere.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SphereError {
    /// An index that no matter has.
    #[error(
        "the refractive index of the {of} is {index}: its real part must be above 0, its imaginary part not below \
             (n + ik with k >= 0 absorbs)"
    )]
    Index {
        /// "sphere" or "host".
        of: &'static str,
        /// The index.
        index: Complex64,
    },
    /// A size that is next to 0 or below, or not finite.
    #[error("the size parameter is {size:?}: it must be above 0, from {SMALLEST:e} on, and finite")]
    Size {
        /// 2 pi r / lambda.
        size: f64,
    },
    /// More terms than memory and time allow.
    #[error(
        "the size parameter is {host} in the host and {particle} by the sphere's own index: spheres beyond \
             {LARGEST_HOST:e} and {LARGEST_PARTICLE:e} are a matter of geometrical optics; take a smaller radius"
    )]
    Large {
        /// |x|.
        host: f64,
        /// |y|.
        particle: f64,
    },
    /// Next to no light comes from one side of the sphere to the other.
    #[error(
        "the host absorbs all light within the size of the sphere (Im x = {depth}, at most {DARKEST_HOST}): \
             nothing that far away is seen in it"
    )]
    BlackHost {
        /// Im x.
        depth: f64,
    },
}

impl Sphere {
    /// A sphere of index `particle` in a host of index `host`; `size` is 2 pi r / lambda with the wavelength in vacuum.
    ///
    /// # Errors
    /// What is wrong with the numbers, or that they are beyond what is computed.
    pub fn new(particle: Complex64, host: Complex64, size: f64) -> Result<Self, SphereError> {
        for (of, index) in [("sphere", particle), ("host", host)] {
            if !(index.is_finite() && index.re > 0.0 && index.im >= 0.0) {
                return Err(SphereError::Index { of, index });
            }
        }
        if !(size.is_finite() && size >= SMALLEST) {
            return Err(SphereError::Size { size });
        }
        let sphere = Self { particle, host, size };
        let (host, particle) = (magnitude(sphere.x()), magnitude(sphere.y()));
        if host > LARGEST_HOST || particle > LARGEST_PARTICLE {
            return Err(SphereError::Large { host, particle });
        }
        if sphere.x().im > DARKEST_HOST {
            return Err(SphereError::BlackHost { depth: sphere.x().im });
        }
        Ok(sphere)
    }

    /// Index of the sphere.
    pub fn particle(&self) -> Complex64 {
        self.particle
    }

    /// Index of the host.
    pub fn host(&self) -> Complex64 {
        self.host
    }

    /// 2 pi r / lambda with the wavelength in vacuum.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// The size parameter in the host.
    pub fn x(&self) -> Complex64 {
        self.size * self.host // (1)
    }

    /// The size parameter by the sphere's own index.
    pub fn y(&self) -> Complex64 {
        self.size * self.particle // (1)
    }
}

/// |z|.
pub(super) fn magnitude(z: Complex64) -> f64 {
    libm::hypot(z.re, z.im)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_that_cannot_be_are_refused() {
        let one = Complex64::ONE;
        let index = |re, im| Sphere::new(Complex64::new(re, im), one, 1.0);
        for (re, im) in [(0.0, 0.0), (-1.0, 0.0), (1.5, -0.1), (f64::NAN, 0.0), (1.5, f64::INFINITY)] {
            assert!(matches!(index(re, im), Err(SphereError::Index { of: "sphere", .. })), "{re} {im}");
        }
        for size in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(Sphere::new(one, one, size), Err(SphereError::Size { .. })), "{size}");
        }
        assert!(matches!(Sphere::new(one, one, 1.1e6), Err(SphereError::Large { .. })));
        let black = Sphere::new(one, Complex64::new(1.0, 1.0), 151.0);
        assert!(black.unwrap_err().to_string().contains("Im x = 151"));
        assert!(Sphere::new(one, Complex64::new(1.0, 1.0), 150.0).is_ok());
    }
}

//! Which numbers a key takes.

use crate::optics::milk::PRESSURE_RANGE as MILK_PRESSURE;
use crate::optics::water::SALINITY_RANGE as WATER_SALINITY;

/// A range of numbers with the words that ask for one of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowed {
    least: f64,
    greatest: f64,
    /// Whether the ends themselves are refused.
    open: bool,
    /// What to write instead, such as "a number above 0".
    pub words: &'static str,
}

impl Allowed {
    /// Above 0.
    pub const POSITIVE: Self = Self::open(0.0, f64::INFINITY, "a number above 0");
    /// 0 or above.
    pub const NOT_NEGATIVE: Self = Self::closed(0.0, f64::MAX, "a number that is not below 0");
    /// A relative error to stop at.
    pub const TARGET_ERROR: Self =
        Self::closed(1e-6, 1.0, "a relative error from 0.000001 to 1, such as 0.02 for 2 %");
    /// The confidence of an interval.
    pub const CONFIDENCE: Self = Self::closed(0.5, 0.9999, "a confidence from 0.5 to 0.9999");
    /// A length in metres.
    pub const LENGTH: Self = Self::closed(1e-9, 1e9, "a length from 1e-9 to 1e9 metres");
    /// alpha of progressive photon mapping.
    pub const SHRINKAGE: Self = Self::closed(0.01, 1.0, "a number from 0.01 to 1");
    /// A reflectance.
    pub const UNIT: Self = Self::closed(0.0, 1.0, "a number from 0 to 1");
    /// A mean cosine.
    pub const MEAN_COSINE: Self = Self::open(-1.0, 1.0, "a number between -1 and 1, both excluded");
    /// The parameter of a phase function whose narrowest peaks are tabulated.
    pub const PEAKED: Self = Self::closed(-0.99999, 0.99999, "a number from -0.99999 to 0.99999");
    /// A slope of the cosine.
    pub const SLOPE: Self = Self::closed(-1.0, 1.0, "a number from -1 to 1");
    /// The exponent of a phase function.
    pub const EXPONENT: Self = Self::closed(0.0, 1000.0, "a number from 0 to 1000");
    /// How fast a Gaussian lobe falls.
    pub const GAUSSIAN: Self = Self::closed(0.0, 1e8, "a number from 0 to 1e8, per radian squared");
    /// An index relative to the medium around.
    pub const RELATIVE_INDEX: Self =
        Self::closed(0.05, 20.0, "an index relative to the medium from 0.05 to 20");
    /// The imaginary part of an index relative to the medium around.
    pub const RELATIVE_ABSORPTION: Self =
        Self::closed(0.0, 20.0, "the imaginary part of a relative index, from 0 to 20");
    /// The index of particles in the ocean, relative to water.
    pub const OCEAN_INDEX: Self = Self::closed(1.01, 1.4, "an index relative to water from 1.01 to 1.4");
    /// The slope of the size distribution of particles in the ocean.
    pub const OCEAN_SLOPE: Self = Self::closed(3.05, 4.95, "a slope of the sizes, from 3.05 to 4.95");
    /// The share that particles in the ocean scatter back.
    pub const BACKSCATTER: Self = Self::closed(1e-4, 0.2, "a share of light from 0.0001 to 0.2");
    /// An angle of deflection in degrees.
    pub const DEFLECTION: Self = Self::closed(0.0, 180.0, "an angle from 0 to 180 degrees");
    /// An angle in degrees below a half turn.
    pub const HALF_TURN: Self = Self::open(0.0, 180.0, "an angle between 0 and 180 degrees, both excluded");
    /// An angle above the horizon, or north of the equator, in degrees.
    pub const QUARTER_TURN: Self = Self::closed(-90.0, 90.0, "an angle from -90 to 90 degrees");
    /// An azimuth, or an angle east of Greenwich, in degrees.
    pub const TURN: Self = Self::closed(-360.0, 360.0, "an angle from -360 to 360 degrees");
    /// Haze of a clear sky.
    pub const TURBIDITY: Self = Self::closed(1.0, 10.0, "a turbidity from 1 to 10");
    /// Frames in which a turntable goes round once; below 0 it goes the other way.
    pub const FRAMES_PER_TURN: Self = Self::closed(-1e6, 1e6, "a number of frames from -1000000 to 1000000");
    /// An angle in degrees from frame to frame.
    pub const DEGREES_PER_FRAME: Self = Self::closed(-360.0, 360.0, "an angle from -360 to 360 degrees");
    /// A coordinate. Beyond this even re-centred positions lose the scene.
    pub const COORDINATE: Self = Self::closed(-1e12, 1e12, "a number from -1e12 to 1e12");
    /// Metres per unit.
    pub const SCALE: Self = Self::closed(1e-12, 1e12, "a number from 1e-12 to 1e12");
    /// A wavelength in nanometres.
    pub const WAVELENGTH: Self = Self::closed(1.0, 1e6, "a wavelength from 1 to 1e6 nanometres");
    /// Temperature of a body that glows, in kelvin.
    pub const KELVIN: Self = Self::closed(1.0, 1e6, "a temperature from 1 to 1e6 kelvin");
    /// Temperature of a light whose luminance is given: below this it is too dark to be scaled.
    pub const KELVIN_OF_LIGHT: Self = Self::closed(500.0, 1e6, "a temperature from 500 to 1e6 kelvin");
    /// Temperature of liquid water in degrees Celsius.
    pub const CELSIUS_OF_WATER: Self =
        Self::closed(-10.0, 100.0, "a temperature from -10 to 100 degrees Celsius");
    /// Any temperature in degrees Celsius that ice may have been said to have.
    pub const CELSIUS: Self =
        Self::closed(-273.15, 100.0, "a temperature from -273.15 to 100 degrees Celsius");
    /// A share of a volume.
    pub const VOLUME_FRACTION: Self = Self::closed(0.0, 1.0, "a share of the volume from 0 to 1");
    /// A coefficient in 1/m that is not too large for anything.
    pub const ABSORBED_AT_440: Self = Self::closed(0.0, 1e6, "an absorption at 440 nm from 0 to 1e6 1/m");
    /// Density of ice with all that is in it.
    pub const ICE_DENSITY: Self = Self::closed(1.0, 1000.0, "a density from 1 to 1000 kg/m^3");
    /// Fat in milk.
    pub const FAT: Self = Self::closed(0.0, 50.0, "fat from 0 to 50 % of the mass");
    /// Protein in milk.
    pub const PROTEIN: Self = Self::closed(0.0, 20.0, "protein from 0 to 20 % of the mass");
    /// Pressure at which milk is homogenised.
    pub const HOMOGENISATION: Self =
        Self::closed(MILK_PRESSURE[0], MILK_PRESSURE[1], "a pressure from 0 to 50 MPa");
    /// Radius of a particle.
    pub const RADIUS: Self = Self::closed(1e-4, 3000.0, "a radius from 0.0001 to 3000 micrometres");
    /// How steeply the number of particles falls with their radius.
    pub const SIZE_EXPONENT: Self = Self::closed(-20.0, 20.0, "an exponent from -20 to 20");
    /// Standard deviation of the logarithm of a radius.
    pub const SIZE_DEVIATION: Self = Self::closed(1e-3, 2.0, "a deviation of ln r from 0.001 to 2");
    /// Salinity in parts per thousand of water, whose index is known for these.
    pub const SALINITY_OF_WATER: Self = Self::closed(
        WATER_SALINITY[0] as f64,
        WATER_SALINITY[1] as f64,
        "a salinity from 0 to 35 parts per thousand",
    );
    /// Salinity of ice in parts per thousand.
    pub const SALINITY: Self = Self::closed(0.0, 100.0, "a salinity from 0 to 100 parts per thousand");
    /// Exposure in stops.
    pub const STOPS: Self = Self::closed(-100.0, 100.0, "a number of stops from -100 to 100");

    const fn closed(least: f64, greatest: f64, words: &'static str) -> Self {
        Self { least, greatest, open: false, words }
    }

    const fn open(least: f64, greatest: f64, words: &'static str) -> Self {
        Self { least, greatest, open: true, words }
    }

    /// Whether a number may be used; never one that is not finite.
    pub fn contains(&self, number: f64) -> bool {
        let inside = if self.open {
            self.least < number && number < self.greatest
        } else {
            self.least <= number && number <= self.greatest
        };
        inside && number.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_what_is_not_finite() {
        assert!(
            Allowed::UNIT.contains(0.0) && Allowed::UNIT.contains(1.0) && !Allowed::UNIT.contains(1.0 + 1e-9)
        );
        assert!(!Allowed::MEAN_COSINE.contains(1.0) && !Allowed::POSITIVE.contains(0.0));
        for allowed in [Allowed::COORDINATE, Allowed::POSITIVE, Allowed::NOT_NEGATIVE] {
            assert!(allowed.contains(5.0));
            for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                assert!(!allowed.contains(number));
            }
        }
    }
}

//! Why a mixture cannot be computed, and what to do about it.

use super::super::lorenz_mie::SphereError;

/// What is wrong with a mixture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MixtureError {
    /// A share of the volume that cannot be.
    #[error("{species}: the volume fraction is {value}: it must be from 0 to 1")]
    VolumeFraction {
        /// Name of the species.
        species: String,
        /// Volume fraction.
        value: f64,
    },
    /// More than there is room for.
    #[error("the volume fractions of {species} are {sum} altogether: there is room for 1, the host included")]
    NoRoom {
        /// Names of the species.
        species: String,
        /// Sum of their volume fractions.
        sum: f64,
    },
    /// Sizes that cannot be.
    #[error("{species}: {source}")]
    Sizes {
        /// Name of the species.
        species: String,
        /// What is wrong with them.
        source: SizesError,
    },
    /// A sphere that cannot be, or that is not computed.
    #[error("{species}, radius {radius:e} m at {wavelength} nm: {source}")]
    Sphere {
        /// Name of the species.
        species: String,
        /// Radius in m.
        radius: f64,
        /// Wavelength in nm.
        wavelength: f64,
        /// What is wrong with it.
        source: SphereError,
    },
    /// A coefficient of the host that cannot be.
    #[error("the host's {coefficient} is {value} 1/m at {wavelength} nm: it must be finite and not below 0")]
    Host {
        /// "absorption" or "molecular scattering".
        coefficient: &'static str,
        /// Wavelength in nm.
        wavelength: f64,
        /// Coefficient in 1/m.
        value: f64,
    },
    /// A wavelength that cannot be.
    #[error("a wavelength is {value} nm: it must be finite and above 0")]
    Wavelength {
        /// Wavelength in nm.
        value: f64,
    },
}

/// What is wrong with a distribution of sizes.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SizesError {
    /// A number that must be above 0.
    #[error("the {what} is {value}: it must be finite and above 0")]
    NotPositive {
        /// Which number.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// An exponent that is no number.
    #[error("the exponent is {value}: it must be finite")]
    Exponent {
        /// The exponent.
        value: f64,
    },
    /// Ends of a range in the wrong order.
    #[error("the least radius, {least:e} m, is not below the greatest, {greatest:e} m: exchange them")]
    Range {
        /// Least radius in m.
        least: f64,
        /// Greatest radius in m.
        greatest: f64,
    },
    /// A table without rows.
    #[error("the table of radii is empty: give one radius or more")]
    Empty,
    /// Columns of different lengths.
    #[error("there are {radii} radii and {numbers} numbers: give one number for each radius")]
    Lengths {
        /// Count of radii.
        radii: usize,
        /// Count of numbers.
        numbers: usize,
    },
    /// Radii out of order.
    #[error("radius {index} of the table, {value:e} m, is not above the one before it: sort them, each once")]
    Unsorted {
        /// Which, from 0 on.
        index: usize,
        /// Radius in m.
        value: f64,
    },
    /// Numbers that cannot be.
    #[error("number {index} of the table is {value}: it must be finite and not below 0")]
    Number {
        /// Which, from 0 on.
        index: usize,
        /// The number.
        value: f64,
    },
    /// No particles at all.
    #[error("every number of the table is 0: give the relative number of particles of each radius")]
    Nothing,
    /// Numbers whose sum is 0, or none that f64 has, at the radii of the quadrature.
    #[error(
        "the sizes are too steep to be summed up: give them a lower exponent, and each narrow peak of a table a species of its own"
    )]
    Steep,
}

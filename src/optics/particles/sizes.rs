//! How many spheres there are of each size.
//!
//! ```text
//! integral of 4/3 pi r^3 N(r) dr = volume fraction                                                    (1)
//! r = 3 V / A,   N(r) dr = N(l) dl 3 V / (4 pi r^3)                                                   (2)
//! V = pi c^2 l,   A = 2 pi c (c + l):   r = 3 c l / (2 (c + l))                                       (3)
//! ```
//!
//! (1) scales N. (2) stands bodies of volume V and surface A in by spheres with the same volume and surface altogether
//! `[GRENFELL99]`, (3) closed cylinders of radius c and length l.

use std::f64::consts::PI;

use super::SizesError;
use super::quadrature::Quadrature;

/// Number of spheres over radius. Only ratios count: the volume fraction of the species scales it.
#[derive(Clone, Debug, PartialEq)]
pub enum SizeDistribution {
    /// N(r) ~ r^-exponent between two radii in m.
    PowerLaw {
        /// The exponent.
        exponent: f64,
        /// Least radius in m.
        least: f64,
        /// Greatest radius in m.
        greatest: f64,
    },
    /// ln r has a normal distribution; cut where the rest has less than a millionth of the volume.
    LogNormal {
        /// Median radius in m.
        median: f64,
        /// Standard deviation of ln r.
        deviation: f64,
    },
    /// Numbers at some radii. In between a power of the radius, or linear in it beside a number of 0. One radius alone
    /// is that of all spheres.
    Table {
        /// Radii in m, strictly rising.
        radii: Vec<f64>,
        /// Relative number of spheres per metre of radius.
        number: Vec<f64>,
    },
}

/// A closed cylinder, in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Radius in m.
    pub radius: f64,
    /// Length in m.
    pub length: f64,
}

/// Standard deviations that are kept on either side of the median volume: less than 1e-6 of the volume is beyond.
const DEVIATIONS_KEPT: f64 = 4.9;

impl SizeDistribution {
    /// Spheres that stand in for closed cylinders, by (2) and (3): of each length, in rising order, one cylinder and the
    /// number of such per metre of length.
    ///
    /// # Errors
    /// Lengths, radii or numbers that cannot be, or cylinders whose spheres do not grow with their length.
    pub fn equal_volume_to_area(cylinders: &[Cylinder], number: &[f64]) -> Result<Self, SizesError> {
        if cylinders.len() != number.len() {
            return Err(SizesError::Lengths { radii: cylinders.len(), numbers: number.len() });
        }
        for cylinder in cylinders {
            positive("length of a cylinder", cylinder.length)?;
            positive("radius of a cylinder", cylinder.radius)?;
        }
        let sphere = |c: &Cylinder| 1.5 * c.radius * c.length / (c.radius + c.length); // (3)
        let radii: Vec<f64> = cylinders.iter().map(sphere).collect();
        let count = |i: usize| {
            let Cylinder { radius, length } = cylinders[i];
            let (before, after) = (i.saturating_sub(1), (i + 1).min(cylinders.len() - 1));
            // dl / dr = l / r d(ln l) / d(ln r), which varies least.
            let slope = if before == after {
                1.0
            } else {
                let stretch = libm::log(cylinders[after].length / cylinders[before].length);
                length / radii[i] * stretch / libm::log(radii[after] / radii[before])
            };
            let volume = PI * radius * radius * length;
            number[i] * slope * 3.0 * volume / (4.0 * PI * radii[i].powi(3)) // (2)
        };
        let spheres = Self::Table { number: (0..number.len()).map(count).collect(), radii };
        spheres.validate().map(|()| spheres)
    }

    /// # Errors
    /// What is wrong with the numbers.
    pub(super) fn validate(&self) -> Result<(), SizesError> {
        self.validate_numbers()?;
        let rule = Quadrature::new(self);
        let is_summed = rule.numbers.iter().all(|numbers| numbers[0].is_finite());
        if is_summed { Ok(()) } else { Err(SizesError::Steep) }
    }

    fn validate_numbers(&self) -> Result<(), SizesError> {
        match self {
            Self::PowerLaw { exponent, least, greatest } => {
                positive("least radius in m", *least)?;
                positive("greatest radius in m", *greatest)?;
                if !exponent.is_finite() {
                    return Err(SizesError::Exponent { value: *exponent });
                }
                if least >= greatest {
                    return Err(SizesError::Range { least: *least, greatest: *greatest });
                }
                Ok(())
            }
            Self::LogNormal { median, deviation } => {
                positive("median radius in m", *median)?;
                positive("deviation of ln r", *deviation)
            }
            Self::Table { radii, number } => validate_table(radii, number),
        }
    }

    /// The radii between which there are spheres.
    pub(super) fn range(&self) -> [f64; 2] {
        match self {
            Self::PowerLaw { least, greatest, .. } => [*least, *greatest],
            Self::LogNormal { median, deviation } => {
                // The volume is log-normal as well, about median exp(3 deviation^2).
                let middle = libm::log(*median) + 3.0 * deviation * deviation;
                let side = DEVIATIONS_KEPT * deviation;
                [libm::exp(middle - side), libm::exp(middle + side)]
            }
            Self::Table { radii, .. } => [radii[0], radii[radii.len() - 1]],
        }
    }

    /// N(r) up to a factor, within [`Self::range`].
    pub(super) fn number(&self, r: f64) -> f64 {
        match self {
            // Relative to an end, so that it stays a number that f64 has.
            Self::PowerLaw { exponent, greatest, .. } => libm::exp(-exponent * libm::log(r / greatest)),
            Self::LogNormal { median, deviation } => {
                let t = libm::log(r / median) / deviation;
                libm::exp(-0.5 * t * t) * median / r
            }
            Self::Table { radii, number } => between(radii, number, r),
        }
    }
}

fn positive(what: &'static str, value: f64) -> Result<(), SizesError> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(SizesError::NotPositive { what, value }) }
}

fn validate_table(radii: &[f64], number: &[f64]) -> Result<(), SizesError> {
    if radii.is_empty() {
        return Err(SizesError::Empty);
    }
    if radii.len() != number.len() {
        return Err(SizesError::Lengths { radii: radii.len(), numbers: number.len() });
    }
    positive("least radius of the table in m", radii[0])?;
    positive("greatest radius of the table in m", radii[radii.len() - 1])?;
    for index in 1..radii.len() {
        let rises = radii[index] > radii[index - 1];
        if !rises {
            return Err(SizesError::Unsorted { index, value: radii[index] });
        }
    }
    if let Some(index) = number.iter().position(|n| !(n.is_finite() && *n >= 0.0)) {
        return Err(SizesError::Number { index, value: number[index] });
    }
    if number.iter().all(|n| *n == 0.0) { Err(SizesError::Nothing) } else { Ok(()) }
}

/// A power of r between two radii of a table, linear where one of the numbers is 0.
fn between(radii: &[f64], number: &[f64], r: f64) -> f64 {
    let above = radii.partition_point(|radius| *radius <= r).clamp(1, radii.len().max(2) - 1);
    let Some(end) = radii.get(above) else { return number[0] };
    let (start, from, to) = (radii[above - 1], number[above - 1], number[above]);
    if from > 0.0 && to > 0.0 {
        let t = libm::log(r / start) / libm::log(end / start);
        libm::exp(libm::log(from) + (libm::log(to) - libm::log(from)) * t)
    } else {
        from + (to - from) * ((r - start) / (end - start))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cylinders that grow slimmer with their length, as many of each length as l^-2 says.
    fn cylinders(count: u32) -> (Vec<Cylinder>, Vec<f64>) {
        let cylinder = |i: u32| {
            let length = 1e-5 * 800_f64.powf(f64::from(i) / f64::from(count));
            Cylinder { radius: 2e-3 * length.powf(0.8), length }
        };
        let cylinders: Vec<Cylinder> = (0..=count).map(cylinder).collect();
        let number = cylinders.iter().map(|c| c.length.powi(-2)).collect();
        (cylinders, number)
    }

    /// Integrals over all cylinders, by the trapezoid rule in ln l: their volume and their surface.
    fn volume_and_area(cylinders: &[Cylinder], number: &[f64]) -> [f64; 2] {
        let of_one = |(c, n): (&Cylinder, &f64)| {
            let (radius, length) = (c.radius, c.length);
            [PI * radius * radius * length, 2.0 * PI * radius * (radius + length)].map(|x| x * n * length)
        };
        let values: Vec<[f64; 2]> = cylinders.iter().zip(number).map(of_one).collect();
        let ends = [values[0], values[values.len() - 1]];
        [0, 1].map(|k| values.iter().map(|v| v[k]).sum::<f64>() - 0.5 * (ends[0][k] + ends[1][k]))
    }

    #[test]
    fn a_sphere_has_the_ratio_of_volume_to_area_of_its_cylinder() {
        let cylinder = Cylinder { radius: 2e-5, length: 6e-5 };
        let spheres = SizeDistribution::equal_volume_to_area(&[cylinder], &[1.0]).unwrap();
        let SizeDistribution::Table { radii, .. } = spheres else { panic!("{spheres:?}") };
        // 3 c l / (2 (c + l)) = 22.5 um.
        assert!((radii[0] / 2.25e-5 - 1.0).abs() < 1e-14, "{radii:?}");
    }

    /// All together as well, with an error of the order of the step of the table, squared.
    #[test]
    fn all_spheres_have_the_ratio_of_volume_to_area_of_all_cylinders() {
        let error = |count: u32| {
            let (cylinders, number) = cylinders(count);
            let [volume, area] = volume_and_area(&cylinders, &number);
            let spheres = SizeDistribution::equal_volume_to_area(&cylinders, &number).unwrap();
            let Quadrature { radii, numbers } = Quadrature::new(&spheres);
            let surface: f64 = radii.iter().zip(&numbers).map(|(r, n)| 4.0 * PI * r * r * n[0]).sum();
            // The spheres' volume is 1.
            (surface * volume / area - 1.0).abs()
        };
        let (coarse, fine) = (error(25), error(100));
        // A quarter of the step.
        assert!(fine < 1e-3 && (coarse / fine - 16.0).abs() < 1.0, "{coarse:e} {fine:e}");
    }

    #[test]
    fn tables_are_powers_of_the_radius_between_their_radii() {
        let table = SizeDistribution::Table { radii: vec![1.0, 4.0, 8.0], number: vec![16.0, 1.0, 0.0] };
        for (r, expected) in [(1.0, 16.0), (2.0, 4.0), (6.0, 0.5), (8.0, 0.0)] {
            assert!((table.number(r) - expected).abs() < 1e-14, "{r}");
        }
        assert_eq!(SizeDistribution::Table { radii: vec![2.0], number: vec![3.0] }.number(2.0), 3.0);
    }

    /// The tails that are cut have less than a millionth of the volume: erfc(4.9 / sqrt 2) = 9.6e-7.
    #[test]
    fn a_log_normal_distribution_keeps_its_volume() {
        let sizes = SizeDistribution::LogNormal { median: 1e-6, deviation: 0.5 };
        let [least, greatest] = sizes.range();
        let volume = |from: f64, to: f64| -> f64 {
            let r = |i: u32| from * (to / from).powf((f64::from(i) + 0.5) / 5000.0);
            (0..5000).map(|i| sizes.number(r(i)) * r(i).powi(4)).sum::<f64>() * (to / from).ln() / 5000.0
        };
        let rest = 1.0 - volume(least, greatest) / volume(least * 0.1, greatest * 10.0);
        assert!(rest > 1e-7 && rest < 1e-6, "{rest:e}");
    }
}

//! A quantity over wavelength, prepared for the lanes of paths.
//!
//! | spectrum | coefficient | reflectance | illuminant |
//! |---|---|---|---|
//! | constant | itself | itself | times D65 of luminance 1 |
//! | RGB | scale times a smooth curve | smooth curve in (0, 1) | D65 times [`super::light_primaries`] |
//! | table | itself | itself | itself |
//! | blackbody, Planck | Planck's law | Planck's law | Planck's law |
//!
//! So a grey light on grey things makes the same picture in RGB and over wavelength, and white stays white. Spectral
//! quantities are sampled at whole nanometres and linear in between: features narrower than that are not seen.

use glam::Vec3;

use super::cie::{self, NANOMETRES};
use super::rgb::RgbCurve;
use super::wavelength::{Wavelengths, nanometre_cell};
use super::{LaneMode, Lanes, Spectrum, blackbody, light_primaries};

/// What a spectrum is the spectrum of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Not bounded above, and not light: 1/m, refractive index.
    Coefficient,
    /// Between 0 and 1, and not light.
    Reflectance,
    /// Light: radiance or irradiance.
    Illuminant,
}

/// A quantity as paths look it up.
#[derive(Clone, Debug, PartialEq)]
pub enum LaneCurve {
    /// The same value at every wavelength, on all four lanes.
    Constant(f32),
    /// (R, G, B, 0).
    Rgb(Lanes),
    /// Values at whole nanometres from 380 to 780 nm.
    Sampled(Box<[f32; NANOMETRES]>),
}

impl LaneCurve {
    /// A curve from its values over nm.
    pub fn sampled(value: impl Fn(f64) -> f64) -> Self {
        Self::Sampled(Box::new(std::array::from_fn(|i| value(cie::nanometre(i)) as f32)))
    }

    /// The quantity on the lanes of a path.
    #[inline]
    pub fn lanes(&self, wavelengths: &Wavelengths) -> Lanes {
        match self {
            Self::Constant(value) => Lanes::splat(*value),
            Self::Rgb(lanes) => *lanes,
            Self::Sampled(table) => Lanes::from_array(wavelengths.lambda.map(|lambda| {
                let (index, t) = nanometre_cell(lambda);
                table[index] + (table[index + 1] - table[index]) * t
            })),
        }
    }

    /// The greatest value that any lane can take.
    pub fn maximum(&self) -> f32 {
        match self {
            Self::Constant(value) => *value,
            Self::Rgb(lanes) => lanes.max_element(),
            Self::Sampled(table) => table.iter().fold(f32::NEG_INFINITY, |most, value| most.max(*value)),
        }
    }

    /// The least value that any lane can take.
    pub fn minimum(&self) -> f32 {
        match self {
            Self::Constant(value) => *value,
            Self::Rgb(lanes) => lanes.truncate().min_element(),
            Self::Sampled(table) => table.iter().fold(f32::INFINITY, |least, value| least.min(*value)),
        }
    }

    /// True when no lane can be anything but zero.
    pub fn is_zero(&self) -> bool {
        match self {
            Self::Constant(value) => *value == 0.0,
            Self::Rgb(lanes) => *lanes == Lanes::ZERO,
            Self::Sampled(table) => table.iter().all(|value| *value == 0.0),
        }
    }
}

impl LaneCurve {
    /// The curve whose lanes are a function of those of two curves, both prepared for the same mode.
    pub fn combined(&self, other: &Self, value: impl Fn(f32, f32) -> f32) -> Self {
        let table = |curve: &Self, i: usize| match curve {
            Self::Constant(value) => *value,
            Self::Rgb(lanes) => lanes[i.min(3)],
            Self::Sampled(table) => table[i],
        };
        match (self, other) {
            (Self::Constant(a), Self::Constant(b)) => Self::Constant(value(*a, *b)),
            (Self::Sampled(_), _) | (_, Self::Sampled(_)) => {
                Self::Sampled(Box::new(std::array::from_fn(|i| value(table(self, i), table(other, i)))))
            }
            _ => {
                Self::Rgb(Lanes::from_array(std::array::from_fn(|i| value(table(self, i), table(other, i)))))
            }
        }
    }
}

impl Spectrum {
    /// A table of a function of the wavelength in nm, at strictly rising ones.
    pub fn tabulated(wavelengths: impl IntoIterator<Item = f64>, value: impl Fn(f64) -> f64) -> Self {
        let entry = |lambda: f64| (lambda as f32, value(lambda) as f32);
        let (wavelengths, values) = wavelengths.into_iter().map(entry).unzip();
        Self::Table { wavelengths, values }
    }

    /// True when it is zero at every wavelength.
    pub fn is_zero(&self) -> bool {
        match self {
            Self::Constant(value) => *value == 0.0,
            Self::Rgb(rgb) => *rgb == [0.0; 3],
            Self::Table { values, .. } => values.iter().all(|value| *value == 0.0),
            Self::Blackbody { luminance, .. } => *luminance == 0.0,
            Self::Planck { .. } => false,
        }
    }

    /// True when RGB cannot express it: tables and thermal radiation.
    pub fn is_spectral(&self) -> bool {
        !matches!(self, Self::Constant(_) | Self::Rgb(_))
    }

    /// The quantity for paths whose lanes are of this mode.
    ///
    /// In RGB the components of a spectral coefficient or reflectance that lie outside of the gamut are cut at 0.
    pub fn prepare(&self, role: Role, mode: LaneMode) -> LaneCurve {
        match (mode, self) {
            (LaneMode::Rgb, _) => {
                let rgb = self.to_rgb(role);
                let inside = if role == Role::Illuminant { rgb } else { rgb.max(Vec3::ZERO) };
                LaneCurve::Rgb(inside.extend(0.0))
            }
            (LaneMode::Spectral, Self::Constant(value)) if role != Role::Illuminant => {
                LaneCurve::Constant(*value)
            }
            (LaneMode::Spectral, _) => LaneCurve::Sampled(Box::new(self.tabulate(role).map(|v| v as f32))),
        }
    }

    /// Linear Rec. 709: of the light itself, or of what is not light under D65 of luminance 1.
    pub fn to_rgb(&self, role: Role) -> Vec3 {
        match self {
            Self::Constant(value) => Vec3::splat(*value),
            Self::Rgb(rgb) => Vec3::from_array(*rgb),
            _ => {
                let table = self.tabulate(role);
                let seen = |lambda: f64| {
                    let value = table[(lambda - cie::LAMBDA_MIN) as usize];
                    if role == Role::Illuminant { value } else { value * cie::d65(lambda) }
                };
                cie::rgb(seen).as_vec3()
            }
        }
    }

    /// Values at whole nanometres.
    fn tabulate(&self, role: Role) -> [f64; NANOMETRES] {
        match self {
            Self::Constant(value) => {
                let value = f64::from(*value);
                at_nanometres(
                    |lambda| {
                        if role == Role::Illuminant { value * cie::d65(lambda) } else { value }
                    },
                )
            }
            Self::Rgb(rgb) => match role {
                Role::Illuminant => at_nanometres(|lambda| light_primaries::radiance(*rgb, lambda)),
                Role::Reflectance => curve_at_nanometres(RgbCurve::reflectance(*rgb)),
                Role::Coefficient => curve_at_nanometres(RgbCurve::unbounded(*rgb)),
            },
            Self::Table { wavelengths, values } => {
                at_nanometres(|lambda| interpolate(wavelengths, values, lambda))
            }
            Self::Blackbody { temperature, luminance } => {
                let temperature = f64::from(*temperature);
                let scale = f64::from(*luminance) * blackbody::scale_to_unit_luminance(temperature);
                at_nanometres(|lambda| scale * blackbody::planck(lambda, temperature))
            }
            Self::Planck { temperature } => {
                at_nanometres(|lambda| blackbody::planck(lambda, f64::from(*temperature)))
            }
        }
    }
}

fn at_nanometres(value: impl Fn(f64) -> f64) -> [f64; NANOMETRES] {
    std::array::from_fn(|i| value(cie::nanometre(i)))
}

fn curve_at_nanometres(curve: RgbCurve) -> [f64; NANOMETRES] {
    at_nanometres(|lambda| curve.eval(lambda))
}

/// Linear between the entries of a table and constant beyond its ends; an empty table is zero.
pub fn interpolate<T: Copy + Into<f64>>(wavelengths: &[T], values: &[T], lambda: f64) -> f64 {
    let length = wavelengths.len().min(values.len());
    let (wavelengths, values) = (&wavelengths[..length], &values[..length]);
    let above = wavelengths.partition_point(|w| (*w).into() <= lambda);
    match (above.checked_sub(1), above < length) {
        (None, false) => 0.0,
        (None, true) => values[0].into(),
        (Some(below), false) => values[below].into(),
        (Some(below), true) => {
            let [start, end]: [f64; 2] = [below, above].map(|i| wavelengths[i].into());
            let [from, to]: [f64; 2] = [below, above].map(|i| values[i].into());
            from + (to - from) * ((lambda - start) / (end - start))
        }
    }
}

/// Linear between the entries, two or more, of a table from `first` nm in equal steps, and constant beyond its ends.
pub fn interpolate_even(table: &[f64], [first, step]: [f64; 2], lambda: f64) -> f64 {
    let last = table.len() - 1;
    let position = ((lambda - first) / step).clamp(0.0, last as f64);
    let index = (position as usize).min(last - 1);
    table[index] + (table[index + 1] - table[index]) * (position - index as f64)
}

#[cfg(test)]
mod tests {
    use super::super::lab::delta_e;
    use super::super::wavelength::film_rgb;
    use super::*;
    use glam::DVec3;

    /// The film's colour of the product of two quantities, with the mean over u taken by the midpoint rule.
    fn film(mode: LaneMode, light: &LaneCurve, surface: &LaneCurve, bounces: i32) -> DVec3 {
        let count = 4096;
        let mut sum = DVec3::ZERO;
        for i in 0..count {
            let w = Wavelengths::for_mode(mode, (i as f32 + 0.5) / count as f32);
            let albedo = surface.lanes(&w);
            let mut lanes = light.lanes(&w);
            for _ in 0..bounces {
                lanes *= albedo;
            }
            sum += film_rgb(mode, &w, lanes).as_dvec3();
        }
        sum / f64::from(count)
    }

    fn both(light: &Spectrum, surface: &Spectrum, bounces: i32) -> [DVec3; 2] {
        [LaneMode::Rgb, LaneMode::Spectral].map(|mode| {
            let light = light.prepare(Role::Illuminant, mode);
            film(mode, &light, &surface.prepare(Role::Reflectance, mode), bounces)
        })
    }

    #[test]
    fn white_stays_white() {
        let [_, spectral] = both(&Spectrum::Constant(1.0), &Spectrum::Rgb([1.0; 3]), 8);
        assert!((spectral - DVec3::ONE).abs().max_element() < 1e-5, "{spectral}");
    }

    #[test]
    fn a_grey_furnace_is_the_same_in_both_modes() {
        for reflectance in [0.05, 0.5, 0.9] {
            for surface in [Spectrum::Constant(reflectance), Spectrum::Rgb([reflectance; 3])] {
                for light in [Spectrum::Constant(0.8), Spectrum::Rgb([0.8; 3])] {
                    let [rgb, spectral] = both(&light, &surface, 3);
                    // Both are exact up to the quadrature over u.
                    assert!((rgb - spectral).abs().max_element() < 1e-5 * rgb.max_element());
                    assert!(delta_e(rgb, spectral) < 0.01);
                }
            }
        }
    }

    #[test]
    fn coloured_surfaces_under_white_and_coloured_lights_on_white_are_the_same_in_both_modes() {
        for colour in [[0.8, 0.3, 0.1], [0.1, 0.6, 0.2], [0.05, 0.2, 0.9], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0]] {
            let [rgb, spectral] = both(&Spectrum::Constant(1.0), &Spectrum::Rgb(colour), 1);
            assert!(delta_e(rgb, spectral) < 0.5, "surface {colour:?}: {spectral}");
            let [rgb, spectral] = both(&Spectrum::Rgb(colour), &Spectrum::Constant(1.0), 1);
            assert!(delta_e(rgb, spectral) < 0.1, "light {colour:?}: {spectral}");
        }
    }

    #[test]
    fn thermal_light_keeps_its_luminance() {
        let light = Spectrum::Blackbody { temperature: 5778.0, luminance: 3.0 };
        let [rgb, spectral] = both(&light, &Spectrum::Constant(1.0), 1);
        for colour in [rgb, spectral] {
            assert!((cie::rgb_to_xyz(colour).y - 3.0).abs() < 1e-4, "{colour}");
        }
        assert!(rgb.x > rgb.z, "5778 K is warmer than D65");
    }

    #[test]
    fn tables_are_absolute_in_every_role() {
        let table = Spectrum::Table { wavelengths: vec![400.0, 500.0, 700.0], values: vec![1.0, 3.0, 2.0] };
        let w = Wavelengths { lambda: [390.0, 450.0, 600.0, 750.0], pdf: [1.0; 4] };
        for role in [Role::Coefficient, Role::Reflectance, Role::Illuminant] {
            let curve = table.prepare(role, LaneMode::Spectral);
            assert_eq!(curve.lanes(&w), Lanes::new(1.0, 2.0, 2.5, 2.0));
            assert_eq!(curve.maximum(), 3.0);
        }
        assert!(table.is_spectral() && !Spectrum::Rgb([1.0; 3]).is_spectral());
    }

    #[test]
    fn broken_tables_do_not_panic() {
        assert_eq!(interpolate::<f32>(&[], &[], 500.0), 0.0);
        assert_eq!(interpolate(&[400.0, 500.0], &[2.0], 450.0), 2.0);
        assert_eq!(interpolate(&[500.0], &[2.0], 450.0), 2.0);
        for (lambda, value) in
            [(300.0, 1.0), (400.0, 1.0), (410.0, 2.0), (420.0, 3.0), (430.0, 1.0), (999.0, -1.0)]
        {
            assert_eq!(interpolate_even(&[1.0, 3.0, -1.0], [400.0, 20.0], lambda), value);
        }
    }

    #[test]
    fn constants_cost_no_table_and_rgb_leaves_the_fourth_lane_dark() {
        let w = Wavelengths::sample(0.4);
        assert_eq!(
            Spectrum::Constant(2.0).prepare(Role::Coefficient, LaneMode::Spectral),
            LaneCurve::Constant(2.0)
        );
        let rgb = Spectrum::Constant(2.0).prepare(Role::Coefficient, LaneMode::Rgb);
        assert_eq!(rgb.lanes(&w), Lanes::new(2.0, 2.0, 2.0, 0.0));
        assert!(Spectrum::Rgb([0.0; 3]).prepare(Role::Illuminant, LaneMode::Spectral).is_zero());
    }

    #[test]
    fn a_table_under_d65_has_the_colour_that_paths_find() {
        let table = Spectrum::Table { wavelengths: vec![420.0, 560.0, 680.0], values: vec![0.1, 0.7, 0.3] };
        let surface = table.prepare(Role::Reflectance, LaneMode::Spectral);
        let light = Spectrum::Constant(1.0).prepare(Role::Illuminant, LaneMode::Spectral);
        let found = film(LaneMode::Spectral, &light, &surface, 1);
        assert!(delta_e(found, table.to_rgb(Role::Reflectance).as_dvec3()) < 0.05);
    }
}

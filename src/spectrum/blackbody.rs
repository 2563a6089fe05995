//! Planck's law.
//!
//! ```text
//! B(lambda, T) = 2 h c^2 / lambda^5 / (exp(h c / (lambda k T)) - 1)         W m^-2 sr^-1 m^-1, given here per nm
//! ```
//! The constants are exact in the SI of 2019 `[SI19]`. Valid for every temperature above 0 K; at or below it the
//! radiation is 0. Relative error 1e-15 times the exponent.

use super::cie;

/// Planck's constant in J s.
const PLANCK: f64 = 6.626_070_15e-34;
/// Speed of light in m/s.
const LIGHT: f64 = 299_792_458.0;
/// Boltzmann's constant in J/K.
const BOLTZMANN: f64 = 1.380_649e-23;

/// Radiance in W m^-2 sr^-1 nm^-1 of a blackbody of `temperature` K at `lambda` nm.
pub fn planck(lambda: f64, temperature: f64) -> f64 {
    if temperature <= 0.0 || lambda <= 0.0 {
        return 0.0;
    }
    let metres = lambda * 1e-9;
    let exponent = PLANCK * LIGHT / (metres * BOLTZMANN * temperature);
    let per_metre = 2.0 * PLANCK * LIGHT * LIGHT / (metres * metres * metres * metres * metres);
    per_metre / libm::expm1(exponent) * 1e-9
}

/// What Planck's radiation of `temperature` K is multiplied by to have the luminance 1 (integral with ybar).
///
/// Zero where the radiation has no luminance that double precision can hold (below about 25 K).
pub fn scale_to_unit_luminance(temperature: f64) -> f64 {
    let luminance = cie::xyz(|lambda| planck(lambda, temperature)).y;
    if luminance > f64::MIN_POSITIVE { 1.0 / luminance } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Total radiance is sigma T^4 / pi with the CODATA sigma = 5.670374419e-8 W m^-2 K^-4. Simpson's rule in
    /// x = h c / (lambda k T) from 1e-3 to 60 leaves out x^2 / 2 ... = 5e-11 of the whole.
    #[test]
    fn total_radiance_is_that_of_stefan_and_boltzmann() {
        for temperature in [300.0, 1500.0, 5778.0, 20_000.0] {
            let hc_over_kt = PLANCK * LIGHT / (BOLTZMANN * temperature) * 1e9;
            let steps = 20_000;
            let (a, b) = (1e-3, 60.0);
            let h = (b - a) / f64::from(steps);
            let mut sum = 0.0;
            for i in 0..=steps {
                let x = a + f64::from(i) * h;
                let weight = if i == 0 || i == steps { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
                let lambda = hc_over_kt / x;
                sum += weight * planck(lambda, temperature) * lambda / x;
            }
            let total = sum * h / 3.0;
            let want = 5.670_374_419e-8 * temperature.powi(4) / std::f64::consts::PI;
            assert!((total / want - 1.0).abs() < 1e-9, "{temperature} K: {total} is not {want}");
        }
    }

    /// Wien's displacement constant, CODATA: 2897.771955 um K.
    #[test]
    fn the_peak_is_where_wien_puts_it() {
        for temperature in [1000.0, 5778.0] {
            let peak = 2_897_771.955 / temperature;
            // Near the peak B is a parabola: compare the two sides at one part in ten thousand.
            let (below, above) = (peak * (1.0 - 1e-4), peak * (1.0 + 1e-4));
            let [l, m, r] = [below, peak, above].map(|lambda| planck(lambda, temperature));
            let offset = 0.5 * (l - r) / (l - 2.0 * m + r);
            assert!(m > l && m > r && offset.abs() < 1e-3, "the peak is {offset} steps of 1e-4 away");
        }
    }

    /// CIE illuminant A is Planck's radiation at 2855.54 K (x 0.44758, y 0.40745 published); the locus at 6504 K is
    /// (0.3134, 0.3237), below D65 by 0.005 in y, and at 5778 K (0.3262, 0.3358).
    #[test]
    fn chromaticities_are_on_the_published_locus() {
        for (temperature, x, y, tolerance) in [
            (2855.54, 0.44758, 0.40745, 5e-5),
            (6504.0, 0.3134, 0.3237, 5e-4),
            (5778.0, 0.3262, 0.3358, 5e-4),
        ] {
            let colour = cie::xyz(|lambda| planck(lambda, temperature));
            let sum = colour.element_sum();
            let (got_x, got_y) = (colour.x / sum, colour.y / sum);
            assert!((got_x - x).abs() < tolerance && (got_y - y).abs() < tolerance, "{got_x} {got_y}");
        }
    }

    #[test]
    fn luminance_is_scaled_to_one_and_cold_bodies_are_dark() {
        let scale = scale_to_unit_luminance(5778.0);
        assert!((cie::xyz(|lambda| scale * planck(lambda, 5778.0)).y - 1.0).abs() < 1e-12);
        assert_eq!(planck(500.0, 0.0), 0.0);
        assert_eq!(scale_to_unit_luminance(5.0), 0.0);
        assert!(scale_to_unit_luminance(300.0).is_finite());
    }
}

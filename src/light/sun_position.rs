//! Where the sun stands at a time and a place.
//!
//! ```text
//! T = (JD - 2451545) / 36525
//! L = 280.46646 + 36000.76983 T + 0.0003032 T^2,   M = 357.52911 + 35999.05029 T - 0.0001537 T^2
//! C = (1.914602 - 0.004817 T - 0.000014 T^2) sin M + (0.019993 - 0.000101 T) sin 2M + 0.000289 sin 3M
//! lambda = L + C - 0.00569 - 0.00478 sin Omega,   Omega = 125.04 - 1934.136 T
//! epsilon = 23.439291 - 0.0130042 T + 0.00256 cos Omega                       [MEEUS98 chapter 25], degrees
//! theta = 280.46061837 + 360.98564736629 (JD - 2451545) + 0.000387933 T^2     [MEEUS98 chapter 12]
//! R = 1.02' / tan(h + 10.3 / (h + 5.11))                                      [MEEUS98 chapter 16]
//! ```
//! R lifts the sun by refraction in air of 10 degrees Celsius and 1010 hPa. The theory is good to 0.01 degree between 1900
//! and 2100; differences between UTC, UT1 and dynamical time (0.001 degree) and the parallax (0.0024) are left out.

/// A time in UTC, as days since 2000-01-01 12:00.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Days(f64);

/// A place of the sun in the sky, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPosition {
    /// Above the horizon, as it is seen: with refraction.
    pub elevation: f64,
    /// Clockwise from north.
    pub azimuth: f64,
}

impl Days {
    /// Of a date of the Gregorian calendar and seconds since its midnight; `None` for a date that is not there or outside
    /// of the years 1900 to 2100.
    pub fn new([year, month, day]: [u32; 3], seconds: f64) -> Option<Self> {
        let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
        let length = match month {
            2 => 28 + u32::from(leap),
            4 | 6 | 9 | 11 => 30,
            1..=12 => 31,
            _ => 0,
        };
        if !(1900..=2100).contains(&year) || !(1..=length).contains(&day) {
            return None;
        }
        // Years begin in March here, so that the leap day is their last.
        let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
        let days = 365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day;
        // 2000-01-01 is day 730426 of this count, and noon half a day later.
        Some(Self(f64::from(days) - 730_426.5 + seconds / 86_400.0))
    }
}

/// The sun at a latitude (north is positive) and a longitude (east is positive), in degrees.
pub fn sun_position(Days(days): Days, latitude: f64, longitude: f64) -> SunPosition {
    let t = days / 36_525.0;
    let omega = degrees(125.04 - 1934.136 * t);
    let obliquity = degrees(23.439_291 - 0.013_004_2 * t + 0.002_56 * libm::cos(omega));
    let (sin, cos) = libm::sincos(ecliptic_longitude(t, omega));
    let right_ascension = libm::atan2(libm::cos(obliquity) * sin, cos);
    let declination = libm::asin(libm::sin(obliquity) * sin);
    // Apparent sidereal time: nutation moves the equinox that right ascensions count from.
    let nutation = -0.004_78 * libm::sin(omega) * libm::cos(obliquity);
    let sidereal = 280.460_618_37 + 360.985_647_366_29 * days + 0.000_387_933 * t * t + nutation;
    let hour_angle = degrees((sidereal + longitude) % 360.0) - right_ascension;

    let (sin_lat, cos_lat) = libm::sincos(degrees(latitude));
    let (sin_dec, cos_dec) = libm::sincos(declination);
    let (sin_hour, cos_hour) = libm::sincos(hour_angle);
    let [north, east, up] = [
        cos_lat * sin_dec - sin_lat * cos_dec * cos_hour,
        -cos_dec * sin_hour,
        sin_lat * sin_dec + cos_lat * cos_dec * cos_hour,
    ];
    let elevation = libm::atan2(up, libm::hypot(north, east)).to_degrees();
    SunPosition {
        elevation: elevation + refraction(elevation),
        azimuth: libm::atan2(east, north).to_degrees().rem_euclid(360.0),
    }
}

fn degrees(angle: f64) -> f64 {
    angle.to_radians()
}

/// Apparent longitude in radians.
fn ecliptic_longitude(t: f64, omega: f64) -> f64 {
    let mean_longitude = 280.466_46 + (36_000.769_83 + 0.000_303_2 * t) * t;
    let anomaly = degrees(357.529_11 + (35_999.050_29 - 0.000_153_7 * t) * t);
    let centre = (1.914_602 - (0.004_817 + 0.000_014 * t) * t) * libm::sin(anomaly)
        + (0.019_993 - 0.000_101 * t) * libm::sin(2.0 * anomaly)
        + 0.000_289 * libm::sin(3.0 * anomaly);
    degrees((mean_longitude + centre - 0.005_69 - 0.004_78 * libm::sin(omega)) % 360.0)
}

/// By how many degrees the air lifts what stands at an elevation; below -1 degree, where the formula ends, it fades as 1/h.
fn refraction(elevation: f64) -> f64 {
    let h = elevation.max(-1.0);
    let lifts = 1.02 / 60.0 / libm::tan(degrees(h + 10.3 / (h + 5.11)));
    lifts / (-elevation).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// astropy 8.0.2, `get_sun` in `AltAz` without an atmosphere: date, seconds, latitude, longitude, elevation, azimuth.
    /// North and south, the tropics, polar day and night, a leap day, the first half of the theory's time.
    #[rustfmt::skip]
    const ASTROPY: [([u32; 3], [f64; 5]); 12] = [
        ([2026, 6, 21], [43_200.0, 55.7, 12.6, 56.5148, 200.4810]),
        ([2026, 3, 20], [23_400.0, 0.0, 0.0, 5.6218, 90.1367]),
        ([2026, 12, 21], [7200.0, -33.87, 151.21, 79.4533, 351.2199]),
        ([2024, 2, 29], [65_700.0, 40.0, -105.25, 40.5521, 160.8185]),
        ([2026, 7, 1], [84_600.0, 78.2, 15.6, 11.3328, 6.6648]),
        ([2026, 12, 21], [39_600.0, 69.65, 18.96, -3.1444, 184.0870]),
        ([1990, 10, 17], [45_030.0, 39.742476, -105.1786, -8.9004, 94.6933]),
        ([2003, 10, 17], [70_230.0, 39.742476, -105.1786, 39.8723, 194.3383]),
        ([2049, 8, 5], [32_400.0, -77.85, 166.67, -22.5629, 243.6848]),
        ([2026, 6, 21], [14_400.0, -54.8, -68.3, -57.9701, 195.2325]),
        ([2026, 9, 23], [60_000.0, -54.8, -68.3, 35.3859, 355.5534]),
        ([1950, 1, 1], [43_200.0, 51.48, 0.0, 15.4822, 179.1731]),
    ];

    /// The theory's 0.01 degree. Azimuths are compared as what they are on the sky, times the cosine of the elevation.
    #[test]
    fn the_sun_is_where_astropy_has_it() {
        for (date, [seconds, latitude, longitude, elevation, azimuth]) in ASTROPY {
            let found = sun_position(Days::new(date, seconds).unwrap(), latitude, longitude);
            let up = found.elevation - refraction(elevation) - elevation;
            let round = (found.azimuth - azimuth) * elevation.to_radians().cos();
            assert!(up.abs() < 0.01 && round.abs() < 0.01, "{date:?}: {up} {round}");
        }
    }

    /// The worked example of Reda and Andreas, Solar Position Algorithm (NREL/TP-560-34302, 2008): zenith
    /// 50.11162 and azimuth 194.34024 degrees, at 820 hPa and 11 degrees Celsius and 1830 m, whose refraction is 0.0163
    /// instead of 0.0194 here.
    #[test]
    fn the_worked_example_of_nrel() {
        let found = sun_position(Days::new([2003, 10, 17], 70_230.0).unwrap(), 39.742_476, -105.1786);
        assert!(
            (found.elevation - 39.888_38).abs() < 0.01 && (found.azimuth - 194.340_24).abs() < 0.01,
            "{found:?}"
        );
    }

    /// astropy at 1010 hPa, 10 degrees Celsius and 550 nm; the formula is good to 0.07 arc minutes above 15 degrees, and
    /// departs from that of astropy by up to 0.005 degree below.
    #[test]
    fn refraction_lifts_the_sun() {
        for (elevation, apparent) in
            [(5.6218, 5.7640), (11.3328, 11.4106), (15.4822, 15.5394), (35.3859, 35.4085), (79.4533, 79.4563)]
        {
            let lifted = elevation + refraction(elevation);
            assert!((lifted - apparent).abs() < 0.006, "{lifted} {apparent}");
        }
        assert!((refraction(0.0) - 0.48).abs() < 0.01 && refraction(-60.0) < 0.02);
    }

    #[test]
    fn days_are_those_of_the_calendar() {
        assert_eq!(Days::new([2000, 1, 1], 43_200.0), Some(Days(0.0)));
        // Julian days 2446895.5 and 2415020.5 [MEEUS98 chapter 7].
        assert_eq!(Days::new([1987, 4, 10], 0.0), Some(Days(2_446_895.5 - 2_451_545.0)));
        assert_eq!(Days::new([1900, 1, 1], 0.0), Some(Days(2_415_020.5 - 2_451_545.0)));
        for date in [
            [2026, 2, 29],
            [1900, 2, 29],
            [2026, 4, 31],
            [2026, 13, 1],
            [2026, 0, 1],
            [2026, 1, 0],
            [1899, 12, 31],
        ] {
            assert_eq!(Days::new(date, 0.0), None, "{date:?}");
        }
        assert!(Days::new([2024, 2, 29], 0.0).is_some() && Days::new([2000, 2, 29], 0.0).is_some());
    }
}

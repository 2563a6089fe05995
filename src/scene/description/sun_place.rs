//! Reads where the sun stands: a direction, an elevation and an azimuth, or a time and a place.
//!
//! Azimuths are clockwise from north, seen from above. North is +y, or -z where y is the axis that is up; `north` says
//! otherwise.

use glam::{DVec3, Vec3};

use super::allowed::Allowed;
use super::document::Table;
use super::error::SceneError;
use super::value::Value;
use super::{Axis, SunDescription};
use crate::light::sun_position::{Days, SunPosition, sun_position};

const FORMS: &str = "write the direction towards the sun, such as [0.4, 0.2, 0.9]; or `elevation` and `azimuth` in degrees; \
                     or `date`, `time`, `latitude` and `longitude`";

impl SunDescription {
    /// Elevation and azimuth in degrees.
    pub fn angles(&self, up: Axis) -> [f64; 2] {
        let [direction, north, up] = [self.direction, self.north, up.vector()].map(Vec3::as_dvec3);
        let [ahead, right] = [direction.dot(north), direction.dot(north.cross(up))];
        let elevation = libm::atan2(direction.dot(up), libm::hypot(ahead, right));
        [elevation.to_degrees(), libm::atan2(right, ahead).to_degrees().rem_euclid(360.0)]
    }
}

/// The direction towards the sun and north, both unit vectors.
pub(super) fn read(table: &Table<'_>, up: Axis) -> Result<(Vec3, Vec3), SceneError> {
    let [direction, elevation, date] = ["direction", "elevation", "date"].map(|key| table.get(key));
    let (position, second) = match (direction, elevation, date) {
        (None, Some(elevation), date) => (of_angles(table, &elevation)?, date),
        (None, None, Some(date)) => (of_time(table, &date)?, None),
        (direction, elevation, date) => {
            let direction =
                direction.map_or_else(|| mistyped(table).and(table.require("direction", FORMS)), Ok)?;
            one_place(elevation.or(date))?;
            return Ok((direction.direction()?, default_north(up).as_vec3()));
        }
    };
    one_place(second)?;
    let north = table.get("north").map_or_else(|| Ok(default_north(up)), |v| north(&v, up))?;
    Ok((towards(position, north, up).as_vec3(), north.as_vec3()))
}

fn one_place(second: Option<Value<'_>>) -> Result<(), SceneError> {
    second.map_or(Ok(()), |value| {
        Err(value.invalid("the sun has one place: remove this, or what else says where it is"))
    })
}

/// An error where the key that begins one of the other two forms is there with a slip.
fn mistyped(table: &Table<'_>) -> Result<(), SceneError> {
    for key in ["elevation", "date"] {
        if let Err(error @ SceneError::UnknownKey { .. }) = table.require(key, FORMS) {
            return Err(error);
        }
    }
    Ok(())
}

fn of_angles(table: &Table<'_>, elevation: &Value<'_>) -> Result<SunPosition, SceneError> {
    let azimuth = table.require("azimuth", "write the degrees from north by east, such as 180 for south")?;
    Ok(SunPosition {
        elevation: elevation.number(&Allowed::QUARTER_TURN)?,
        azimuth: azimuth.number(&Allowed::TURN)?,
    })
}

fn of_time(table: &Table<'_>, date: &Value<'_>) -> Result<SunPosition, SceneError> {
    let time = table.require("time", "write for example \"14:30\" (UTC) or \"14:30+02:00\"")?;
    let latitude = table.require("latitude", "write the degrees north of the equator")?;
    let longitude = table.require("longitude", "write the degrees east of Greenwich")?;
    let seconds = seconds(&time)?;
    let position = sun_position(
        days(date, seconds)?,
        latitude.number(&Allowed::QUARTER_TURN)?,
        longitude.number(&Allowed::TURN)?,
    );
    if position.elevation < 0.0 {
        return Err(time.invalid(format!(
            "the sun is {:.2} degrees below the horizon then: write a time of the day, or leave this sun out",
            -position.elevation
        )));
    }
    Ok(position)
}

/// `date = "2026-06-21"`
fn days(value: &Value<'_>, seconds: f64) -> Result<Days, SceneError> {
    const FORM: &str = "a date of the years 1900 to 2100, such as \"2026-06-21\",";
    let numbers: Option<Vec<u32>> = value.text(FORM)?.split('-').map(whole).collect();
    let date = numbers.and_then(|numbers| <[u32; 3]>::try_from(numbers).ok());
    date.and_then(|date| Days::new(date, seconds))
        .ok_or_else(|| value.invalid(format!("write {FORM} that is in the calendar")))
}

/// `time = "14:30"`, `"14:30:15+02:00"`: seconds in UTC since midnight of the date, which may be below 0 or beyond a day.
fn seconds(value: &Value<'_>) -> Result<f64, SceneError> {
    const FORM: &str = "a time such as \"14:30\" (UTC), \"14:30:15\" or \"14:30+02:00\",";
    let text = value.text(FORM)?;
    let (time, sign, zone) = match text.find(['+', '-']) {
        Some(at) => (&text[..at], if text[at..].starts_with('+') { -1.0 } else { 1.0 }, &text[at + 1..]),
        None => (text.strip_suffix('Z').unwrap_or(text), 0.0, "00:00"),
    };
    let offset = clock(zone).filter(|_| zone.len() == 5);
    let found = clock(time).zip(offset).map(|(time, offset)| time + sign * offset);
    found.ok_or_else(|| value.invalid(format!("write {FORM} in quotes")))
}

/// Seconds of `hh:mm` or `hh:mm:ss`.
fn clock(text: &str) -> Option<f64> {
    let parts: Vec<u32> = text.split(':').map(whole).collect::<Option<_>>()?;
    let (hours, minutes, seconds) = match parts.as_slice() {
        [hours, minutes] => (*hours, *minutes, 0),
        [hours, minutes, seconds] => (*hours, *minutes, *seconds),
        _ => return None,
    };
    let inside = hours < 24 && minutes < 60 && seconds < 60;
    inside.then(|| f64::from(hours * 3600 + minutes * 60 + seconds))
}

/// Digits and nothing else.
fn whole(text: &str) -> Option<u32> {
    text.bytes().all(|b| b.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}

fn default_north(up: Axis) -> DVec3 {
    if up.index == 1 { DVec3::NEG_Z } else { DVec3::Y }
}

/// `north = [..]`, made horizontal.
fn north(value: &Value<'_>, up: Axis) -> Result<DVec3, SceneError> {
    let up = up.vector().as_dvec3();
    let given = value.direction()?.as_dvec3();
    let level = given - up * given.dot(up);
    // Single precision has no direction in what is left of a vector that is upright to its digits.
    level
        .try_normalize()
        .filter(|_| level.length() > 1e-3)
        .ok_or_else(|| value.invalid("write a direction that is not upright"))
}

fn towards(position: SunPosition, north: DVec3, up: Axis) -> DVec3 {
    let up = up.vector().as_dvec3();
    let (sin, cos) = libm::sincos(position.elevation.to_radians());
    let (east, ahead) = libm::sincos(position.azimuth.to_radians());
    (cos * (ahead * north + east * north.cross(up)) + sin * up).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A compass on a map: north is up on it, east to the right.
    #[test]
    fn azimuths_are_clockwise_from_north_whatever_is_up() {
        let z = Axis::Z;
        let y = Axis { index: 1, negative: false };
        for (up, north, east) in [(z, DVec3::Y, DVec3::X), (y, DVec3::NEG_Z, DVec3::X)] {
            assert_eq!(default_north(up), north);
            let level = |azimuth| towards(SunPosition { elevation: 0.0, azimuth }, north, up);
            assert!(level(0.0).distance(north) < 1e-15 && level(90.0).distance(east) < 1e-15);
            assert!(level(-180.0).distance(-north) < 1e-15 && level(270.0).distance(-east) < 1e-15);
            let raised = towards(SunPosition { elevation: 30.0, azimuth: 77.0 }, north, up);
            assert!((raised.dot(up.vector().as_dvec3()) - 0.5).abs() < 1e-15);
        }
    }

    #[test]
    fn clocks_have_whole_numbers_in_their_ranges() {
        assert_eq!(
            (clock("14:30"), clock("00:00:01"), clock("23:59:59")),
            (Some(52_200.0), Some(1.0), Some(86_399.0))
        );
        for wrong in [
            "",
            "14",
            "24:00",
            "12:60",
            "12:00:60",
            "12:00:00:00",
            "+1:00",
            "1e1:00",
            " 1:00",
            ":",
            "99999999999:00",
        ] {
            assert_eq!(clock(wrong), None, "{wrong}");
        }
    }
}

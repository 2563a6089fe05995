//! Where the camera is over time: keys that are joined smoothly, and a turntable.
//!
//! Between two keys every number (coordinates, field of view, focus) follows Hermite's cubic,
//!
//! ```text
//! x(s) = (1 + 2 s) (1 - s)^2 x0 + s (1 - s)^2 h m0 + s^2 (3 - 2 s) x1 + s^2 (s - 1) h m1,   s = (t - t0) / h      (1)
//! m = (a + b) / (a / d0 + b / d1),   a = h0 + 2 h1,  b = 2 h0 + h1,   0 where d0 d1 <= 0                         (2)
//! ```
//! with the slopes d0 and d1 of the straight lines on either side of a key, h0 and h1 frames long `[FRITSCH84]`. It
//! never leaves the range of the two keys: a camera does not swing past where it was put. The slope is 0 at the first and
//! the last key, before and after which the camera stands: its velocity is continuous everywhere.

use std::borrow::Cow;

use glam::{DQuat, DVec3, Vec2, Vec3};

use super::camera::Camera;
use super::description::{CameraDescription, CameraKey, FieldOfView, Placement, TurntableDescription};
use super::frame::Place;
use crate::sequence::FrameNumber;

/// Eye, target, angle of view and distance of focus.
type Numbers = [f64; 8];

/// Where the camera is in every frame and between them.
#[derive(Clone, Debug)]
pub struct CameraPath {
    /// Frame and numbers of each key, in order; at least one.
    keys: Vec<(f64, Numbers)>,
    turntable: Option<TurntableDescription>,
    /// What is in focus is at the target, wherever that is.
    focus_follows: bool,
    /// Which angle of view the numbers have.
    fov: fn(f32) -> FieldOfView,
    up: Vec3,
    aperture: f32,
    resolution: [u32; 2],
    /// The scene's.
    origin: DVec3,
}

impl CameraPath {
    /// The path that a scene asks for; `placement` is where the camera is without keys.
    pub fn new(camera: &CameraDescription, placement: Placement, origin: DVec3) -> Self {
        let still =
            CameraKey { frame: 0.0, placement, fov: camera.fov, focus_distance: camera.focus_distance };
        let keys = if camera.keys.is_empty() { &[still][..] } else { &camera.keys[..] };
        let numbers = |key: &CameraKey| {
            let Placement { eye, target } = key.placement;
            let (FieldOfView::Vertical(degrees) | FieldOfView::Horizontal(degrees)) = key.fov;
            let focus = key.focus_distance.unwrap_or_else(|| eye.distance(target));
            [eye.x, eye.y, eye.z, target.x, target.y, target.z, f64::from(degrees), focus]
        };
        Self {
            keys: keys.iter().map(|key| (key.frame, numbers(key))).collect(),
            turntable: camera.turntable,
            focus_follows: keys.iter().all(|key| key.focus_distance.is_none()),
            fov: match keys[0].fov {
                FieldOfView::Vertical(_) => FieldOfView::Vertical,
                FieldOfView::Horizontal(_) => FieldOfView::Horizontal,
            },
            up: camera.up,
            aperture: camera.aperture,
            resolution: camera.resolution,
            origin,
        }
    }

    /// True when the camera is not the same in every frame.
    pub fn moves(&self) -> bool {
        self.keys.len() > 1 || self.turntable.is_some()
    }

    /// The camera at a time in frames.
    pub fn at(&self, frame: f64) -> Camera {
        let [ex, ey, ez, tx, ty, tz, degrees, focus] = interpolated(&self.keys, frame);
        let (mut eye, target) = (DVec3::new(ex, ey, ez), DVec3::new(tx, ty, tz));
        if let Some(turntable) = self.turntable {
            let angle = ((frame - turntable.frame) * turntable.degrees_per_frame).to_radians();
            eye = target + turned(eye - target, self.up.as_dvec3().normalize(), angle);
        }
        let focus = if self.focus_follows { eye.distance(target) } else { focus };
        let fov = (self.fov)(degrees as f32);
        Camera::new(eye - self.origin, target - self.origin, self.up, fov, self.resolution)
            .with_lens(self.aperture, focus as f32)
    }
}

/// A vector turned around a unit axis.
fn turned(vector: DVec3, axis: DVec3, angle: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(0.5 * angle);
    DQuat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos) * vector
}

/// The numbers at a time, from keys in rising order.
fn interpolated<const N: usize>(keys: &[(f64, [f64; N])], t: f64) -> [f64; N] {
    let after = keys.partition_point(|key| key.0 <= t);
    if after == 0 || after == keys.len() {
        return keys[after.saturating_sub(1)].1;
    }
    let before = after - 1;
    let h = keys[after].0 - keys[before].0;
    let s = (t - keys[before].0) / h;
    let rest = 1.0 - s;
    std::array::from_fn(|i| {
        let [x0, x1] = [before, after].map(|key| keys[key].1[i]);
        let [m0, m1] = [before, after].map(|key| slope(keys, key, i));
        // (1)
        (1.0 + 2.0 * s) * rest * rest * x0
            + s * rest * rest * h * m0
            + s * s * (3.0 - 2.0 * s) * x1
            + s * s * (s - 1.0) * h * m1
    })
}

/// The slope of number `i` at a key (2).
fn slope<const N: usize>(keys: &[(f64, [f64; N])], key: usize, i: usize) -> f64 {
    if key == 0 || key + 1 == keys.len() {
        return 0.0;
    }
    let (before, at, after) = (&keys[key - 1], &keys[key], &keys[key + 1]);
    let (h0, h1) = (at.0 - before.0, after.0 - at.0);
    let (d0, d1) = ((at.1[i] - before.1[i]) / h0, (after.1[i] - at.1[i]) / h1);
    if d0 * d1 <= 0.0 {
        return 0.0;
    }
    let (a, b) = (h0 + 2.0 * h1, 2.0 * h0 + h1);
    (a + b) / (a / d0 + b / d1)
}

/// What the camera sees of one frame while the shutter is open.
#[derive(Clone, Debug)]
pub struct Views {
    /// The camera when the shutter opens.
    pub opening: Camera,
    /// When it closes, in frames; 0 when everything happens at the time of the frame.
    pub shutter: f32,
    /// The path and the frame on it, where the camera moves.
    moving: Option<(CameraPath, f64)>,
    /// Somebody asks for motions in the picture.
    tells_motion: bool,
}

/// Where the eye rays of a frame begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartPlaces {
    /// The same for all.
    One(Place),
    /// The camera passes through a surface, or one through the camera, while the shutter is open, or its lens reaches
    /// through one: each ray has its own.
    Several,
}

/// Moments at which it is asked where the camera is.
const ASKED: u32 = 16;

impl Views {
    /// The views of a frame.
    pub fn new(path: &CameraPath, number: FrameNumber, shutter: f32, tells_motion: bool) -> Self {
        let frame = number.millionths() as f64 / 1e6;
        let moving = path.moves().then(|| (path.clone(), frame));
        Self { opening: path.at(frame), shutter, moving, tells_motion }
    }

    /// A time while the shutter is open, in frames, of a number in [0, 1).
    pub fn time(&self, u: f32) -> f32 {
        self.shutter * u
    }

    /// The camera at a time in frames since the shutter opened.
    pub fn at(&self, time: f32) -> Cow<'_, Camera> {
        match &self.moving {
            Some((path, frame)) if time != 0.0 => Cow::Owned(path.at(frame + f64::from(time))),
            _ => Cow::Borrowed(&self.opening),
        }
    }

    /// Where a point that moves goes in a frame from a time on, in pixels: to the right and down. Zero where nobody asks, and
    /// for what will be behind the camera.
    pub fn motion(&self, camera: &Camera, time: f32, point: Vec3, motion: Vec3) -> Vec2 {
        if !self.tells_motion {
            return Vec2::ZERO;
        }
        let next = self.at(time + 1.0);
        let moved = point + motion;
        let way = if next.depth(moved) > 0.0 { next.pixel(moved) - camera.pixel(point) } else { Vec2::ZERO };
        if way.is_finite() { way } else { Vec2::ZERO }
    }

    /// Where eye rays begin, `opening` being the place of the camera when the shutter opens. Places between those that are
    /// asked are taken to be alike.
    pub(super) fn start_places(
        &self,
        opening: Place,
        something_moves: bool,
        place_of: impl Fn(Vec3, f32) -> Place,
    ) -> StartPlaces {
        let changes = self.shutter > 0.0 && (something_moves || self.moving.is_some());
        let moments = if changes { ASKED } else { 0 };
        let is_other = (0..=moments).any(|i| {
            let time = self.shutter * i as f32 / ASKED as f32;
            let camera = self.at(time);
            (changes || camera.has_lens()) && camera.rim().any(|point| place_of(point, time) != opening)
        });
        if is_other { StartPlaces::Several } else { StartPlaces::One(opening) }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn keys(values: &[(f64, f64)]) -> Vec<(f64, [f64; 1])> {
        values.iter().map(|&(t, x)| (t, [x])).collect()
    }

    #[test]
    fn keys_are_met_exactly_and_the_camera_stands_beyond_them() {
        let keys = keys(&[(1.0, 0.3), (4.0, -2.7), (4.5, 9.1), (20.0, 9.2)]);
        for &(t, x) in &keys {
            assert_eq!(interpolated(&keys, t), x);
        }
        assert_eq!((interpolated(&keys, -5.0), interpolated(&keys, 99.0)), ([0.3], [9.2]));
        // A straight line of even keys is followed but for its ends, where it starts and stops.
        let line = self::keys(&[(0.0, 0.0), (1.0, 2.0), (2.0, 4.0), (3.0, 6.0)]);
        assert!((interpolated(&line, 1.25)[0] - 2.5).abs() < 1e-12);
    }

    proptest! {
        /// One-sided difference quotients on both sides of every point differ by no more than the second derivative allows:
        /// that of (1) is at most 24 / h^2 times the greatest difference of two keys.
        #[test]
        fn velocity_is_continuous_and_nothing_overshoots(
            steps in prop::collection::vec((0.5_f64..5.0, -10.0_f64..10.0), 1..6)
        ) {
            let mut t = 0.0;
            let path: Vec<(f64, f64)> = steps.iter().map(|&(h, x)| { t += h; (t, x) }).collect();
            let keys = keys(&path);
            let at = |t: f64| interpolated(&keys, t)[0];
            let e = 1e-5;
            for i in 0..600 {
                let t = t * f64::from(i) / 500.0;
                let (left, right) = ((at(t) - at(t - e)) / e, (at(t + e) - at(t)) / e);
                prop_assert!((left - right).abs() <= 24.0 / 0.25 * 20.0 * 2.0 * e, "{} {} at {}", left, right, t);
            }
            for pair in path.windows(2) {
                let (low, high) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
                for i in 0..=50 {
                    let x = at(pair[0].0 + (pair[1].0 - pair[0].0) * f64::from(i) / 50.0);
                    prop_assert!(x >= low - 1e-9 && x <= high + 1e-9);
                }
            }
        }
    }

    #[test]
    fn a_turntable_goes_round_the_target() {
        let eye = DVec3::new(3.0, 1.0, 2.0);
        let placement = Placement { eye, target: DVec3::new(1.0, 1.0, 1.0) };
        let turntable = TurntableDescription { degrees_per_frame: 10.0, frame: 2.0 };
        let camera = CameraDescription { turntable: Some(turntable), ..CameraDescription::new(Vec3::Z) };
        let path = CameraPath::new(&camera, placement, DVec3::ZERO);
        assert_eq!(path.at(2.0).eye(), eye.as_vec3());
        assert!(path.at(11.0).eye().distance(Vec3::new(1.0, 3.0, 2.0)) < 1e-6);
        assert!(path.at(38.0).eye().distance(eye.as_vec3()) < 1e-6, "a turn in 36 frames");
    }
}

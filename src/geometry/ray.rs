//! A half line.

use glam::Vec3;

/// A half line from `origin` along the unit vector `direction`, up to the distance `t_max`, at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where the ray starts, in metres from the scene's origin.
    pub origin: Vec3,
    /// Unit direction of travel.
    pub direction: Vec3,
    /// Only hits nearer than this count, in metres.
    pub t_max: f32,
    /// When it meets what moves, in frames since the shutter opened.
    pub time: f32,
}

impl Ray {
    /// A ray without end, when the shutter opens.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction, t_max: f32::INFINITY, time: 0.0 }
    }

    /// The same ray at another time.
    #[must_use]
    pub fn at_time(self, time: f32) -> Self {
        Self { time, ..self }
    }

    /// The point at distance `t`.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

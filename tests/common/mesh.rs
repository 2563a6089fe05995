//! Small meshes, those of the stability battery, and what moves them.

pub use floe::study::stability::shapes::{Shape as TestMesh, cuboid, parallelogram, sphere};
use glam::DVec3;

/// Lines of the header of a file with velocities.
const HEADER_LINES: usize = 12;
const VELOCITY: &str = "property double vx\nproperty double vy\nproperty double vz\n";

/// What moves a mesh.
pub trait Moving {
    /// The same mesh some time later.
    #[must_use]
    fn moved(self, velocity: impl Fn(DVec3) -> DVec3, seconds: f64) -> Self;
    /// The text of an ASCII PLY file with the velocities of the vertices.
    fn moving_ply(&self, velocity: impl Fn(DVec3) -> DVec3) -> String;
}

impl Moving for TestMesh {
    fn moved(mut self, velocity: impl Fn(DVec3) -> DVec3, seconds: f64) -> Self {
        for p in &mut self.positions {
            *p += velocity(*p) * seconds;
        }
        self
    }

    fn moving_ply(&self, velocity: impl Fn(DVec3) -> DVec3) -> String {
        let declared = "property double z\n";
        let text = self.ply().replacen(declared, &format!("{declared}{}", VELOCITY), 1);
        let vertex = |(i, line): (usize, &str)| match i
            .checked_sub(HEADER_LINES)
            .and_then(|v| self.positions.get(v))
        {
            Some(&p) => {
                let v = velocity(p);
                format!("{line} {} {} {}\n", v.x, v.y, v.z)
            }
            None => format!("{line}\n"),
        };
        text.lines().enumerate().map(vertex).collect()
    }
}

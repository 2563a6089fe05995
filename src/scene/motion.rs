//! What moves while the shutter is open.
//!
//! The shutter opens at the time of the frame, where everything is as its files say, and closes a part `s` of a frame
//! later. In between vertices keep their velocities:
//!
//! ```text
//! p(t) = p + t v / fps,   n(t) = n(0) + t (n(s) - n(0)) / s,   0 <= t <= s
//! ```
//! with t in frames; the shading normals n(s) are those of the surface as it is when the shutter closes. Shading normals
//! that come from files stay as they are.

use glam::Vec3;

use super::description::{Aov, VelocityDescription};
use super::world::World;
use crate::mesh::{CornerNormals, RawMesh, VelocityName, normals};

/// How velocities become motions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pace {
    /// Frames a second.
    pub fps: f64,
    /// When the shutter closes, in frames; 0 when it never opens.
    pub shutter: f32,
}

impl World {
    /// How velocities become motions; `None` where nobody asks for them.
    pub(super) fn pace(&self) -> Option<Pace> {
        let shutter = self.description.camera.shutter;
        let is_asked =
            (self.tells_motion() || shutter > 0.0) && self.velocities() != &VelocityDescription::None;
        is_asked.then(|| Pace { fps: self.fps(), shutter })
    }

    /// True when pictures tell where things go until the next frame.
    pub(super) fn tells_motion(&self) -> bool {
        self.description.output.aovs.contains(&Aov::Motion)
    }

    /// Which velocities are read from meshes that change from frame to frame.
    pub fn velocity_name(&self) -> VelocityName {
        match (self.pace(), self.velocities()) {
            (Some(_), VelocityDescription::Auto) => VelocityName::Known,
            (Some(_), VelocityDescription::Property(name)) => VelocityName::Only(name.clone()),
            _ => VelocityName::Nothing,
        }
    }

    /// True when velocities follow from where the vertices are in the next frame.
    pub fn follows_vertices(&self) -> bool {
        self.pace().is_some() && self.velocities() == &VelocityDescription::Frames
    }

    fn velocities(&self) -> &VelocityDescription {
        self.frames().map_or(&VelocityDescription::Auto, |frames| &frames.velocity)
    }
}

impl Pace {
    /// Metres a frame of a velocity in units a second.
    pub fn motion(self, velocity: Vec3, scale: f64) -> Vec3 {
        (velocity.as_dvec3() * (scale / self.fps)).as_vec3()
    }

    /// What smooth normals change by in a frame; `None` where they are other ones when the shutter closes.
    pub fn normal_changes(self, mesh: &RawMesh, group: &[u32], open: &CornerNormals) -> Option<Vec<Vec3>> {
        let velocities = mesh.velocities.as_ref().filter(|_| self.shutter > 0.0)?;
        let seconds = f64::from(self.shutter) / self.fps;
        let moved = mesh.positions.iter().zip(velocities).map(|(p, v)| *p + v.as_dvec3() * seconds);
        let closing = RawMesh {
            positions: moved.collect(),
            triangles: mesh.triangles.clone(),
            interfaces: mesh.interfaces.clone(),
            ..RawMesh::default()
        };
        let close = normals::smooth(&closing, group);
        (close.corners == open.corners).then(|| {
            let both = open.values.iter().zip(&close.values);
            both.map(|(open, close)| (*close - *open) / self.shutter).collect()
        })
    }
}

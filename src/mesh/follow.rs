//! Velocities from where the vertices are in the next frame.
//!
//! Equal numbers need not be the same vertex: simulators give those of deleted vertices to new ones. Numbers are believed
//! only where both frames list the same triangles in the same order over as many vertices, and where no vertex has jumped.
//! Neighbours move alike, so a jump is what changes the vector along an edge by many edges:
//!
//! ```text
//! |d_a - d_b| <= 4 l      for every edge ab of a triangle, d being displacements and l the mean length of all edges
//! ```

use std::fmt;

use glam::DVec3;

use super::RawMesh;

/// Times the mean length of an edge by which one may change from frame to frame.
const GREATEST_CHANGE: f64 = 4.0;

/// Why the vertices of a frame are not those of the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NotFollowed {
    /// The frames have other triangles or another number of vertices.
    OtherTriangles,
    /// Vertices jump from their neighbours.
    Jumps {
        /// Corners of triangles that do.
        corners: usize,
        /// Where the first is in this frame, in the file's units.
        first: DVec3,
    },
}

impl fmt::Display for NotFollowed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherTriangles => write!(f, "the next frame has other triangles"),
            Self::Jumps { corners, first } => write!(
                f,
                "until the next frame {corners} corners of triangles jump from their neighbours, the first from {first}: \
                 the numbers of vertices have been used again"
            ),
        }
    }
}

/// Gives the vertices of a mesh the velocities that take them to those of the next frame in some seconds.
///
/// # Errors
/// [`NotFollowed`] where that would be a guess; the mesh is left as it is.
pub fn follow(mesh: &mut RawMesh, next: &RawMesh, seconds: f64) -> Result<(), NotFollowed> {
    if mesh.triangles != next.triangles || mesh.positions.len() != next.positions.len() {
        return Err(NotFollowed::OtherTriangles);
    }
    let displacement = |index: u32| next.positions[index as usize] - mesh.positions[index as usize];
    let edges = || mesh.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    let length = |(a, b): (u32, u32)| mesh.positions[a as usize].distance(mesh.positions[b as usize]);
    let mean = edges().map(length).sum::<f64>() / (3 * mesh.triangles.len()).max(1) as f64;
    let mut jumps = edges()
        .filter(|&(a, b)| displacement(a).distance(displacement(b)) > GREATEST_CHANGE * mean)
        .map(|(a, _)| mesh.positions[a as usize]);
    if let Some(first) = jumps.next() {
        return Err(NotFollowed::Jumps { corners: 1 + jumps.count(), first });
    }
    let velocity = |(from, to): (&DVec3, &DVec3)| ((*to - *from) / seconds).as_vec3();
    mesh.velocities = Some(mesh.positions.iter().zip(&next.positions).map(velocity).collect());
    Ok(())
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// A sheet of n x n squares.
    fn sheet(n: u32) -> RawMesh {
        let row = n + 1;
        let at = |i: u32| DVec3::new(f64::from(i % row), f64::from(i / row), 0.0);
        let corners = (0..n * n).map(|i| i / n * row + i % n);
        RawMesh {
            positions: (0..row * row).map(at).collect(),
            triangles: corners.flat_map(|i| [[i, i + 1, i + row + 1], [i, i + row + 1, i + row]]).collect(),
            ..RawMesh::default()
        }
    }

    #[test]
    fn vertices_go_where_they_are_next() {
        let mut mesh = sheet(5);
        let mut next = mesh.clone();
        // However far, as long as neighbours go along.
        next.positions.iter_mut().for_each(|p| *p = *p * 1.5 + DVec3::new(100.0, 0.0, 2.0));
        follow(&mut mesh, &next, 0.5).unwrap();
        let velocities = mesh.velocities.unwrap();
        assert_eq!((velocities[0], velocities[1]), (Vec3::new(200.0, 0.0, 4.0), Vec3::new(201.0, 0.0, 4.0)));
    }

    #[test]
    fn other_triangles_and_jumps_are_not_followed() {
        let mut mesh = sheet(5);
        let mut turned = mesh.clone();
        turned.triangles[7].rotate_left(1);
        assert_eq!(follow(&mut mesh, &turned, 1.0), Err(NotFollowed::OtherTriangles));
        let mut more = mesh.clone();
        more.positions.push(DVec3::ZERO);
        assert_eq!(follow(&mut mesh, &more, 1.0), Err(NotFollowed::OtherTriangles));
        let mut jump = mesh.clone();
        jump.positions[14] = DVec3::new(2.0, 30.0, 1.0);
        let error = follow(&mut mesh, &jump, 1.0).unwrap_err();
        // Six triangles around it, two edges each.
        assert!(matches!(error, NotFollowed::Jumps { corners: 12, .. }), "{error}");
        assert_eq!(mesh.velocities, None);
    }
}

//! The planes of the simulated box: what the faces on them are, and how a sea goes on beyond them.
//!
//! Where a fluid touches the box of its simulation, the mesh has caps that carry the same labels as the free
//! surface. The scene's `[domain]` table says what they are: interfaces like any other (`keep`), index-matched
//! boundaries (`open`), diffuse walls (`opaque`), or no boundary at all: the surface goes on to the horizon
//! (`extend`). A face lies on a wall when its three vertices are within 1e-5 of the box's longest edge of the
//! wall's plane.
//!
//! * [`apply`] tags the faces on the walls and extends the surface.
//! * [`detect_box`] finds the box when the scene does not say it.

mod detect;
mod extend;
mod rim;
mod stitch;
mod walls;

pub use detect::detect_box;
pub use walls::apply;

use glam::DVec3;

use crate::mesh::Region;

/// One of the six planes of the box: 2 * axis for the lower, 2 * axis + 1 for the upper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Side(pub u8);

impl Side {
    /// The six planes.
    pub const ALL: [Self; 6] = [Self(0), Self(1), Self(2), Self(3), Self(4), Self(5)];

    /// The axis that the plane is perpendicular to: 0, 1, 2 for x, y, z.
    pub fn axis(self) -> usize {
        usize::from(self.0 / 2)
    }
}

/// What a triangle is to the domain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum WallTag {
    /// Not on a wall: the free surface, or an interface inside.
    #[default]
    None,
    /// On a wall that is an interface like any other; normals are not smoothed across its edges.
    Keep(Side),
    /// An index-matched boundary: the region changes, nothing bends.
    Open(Side),
    /// A diffuse wall.
    Opaque(Side),
}

impl WallTag {
    /// The wall that the triangle is on.
    pub fn side(self) -> Option<Side> {
        match self {
            Self::None => None,
            Self::Keep(side) | Self::Open(side) | Self::Opaque(side) => Some(side),
        }
    }

    /// A number that differs between walls: 0 off the walls, 1 + side on them (for
    /// [`group_keys`](crate::mesh::normals::group_keys)).
    pub fn wall(self) -> u32 {
        self.side().map_or(0, |side| 1 + u32::from(side.0))
    }
}

/// What [`apply`] made of a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DomainOutcome {
    /// One tag for each triangle that the mesh has now.
    pub walls: Vec<WallTag>,
    /// The regions below extended surfaces, in rising order, without the outside: they have no end, and a ray
    /// that leaves the scene through one of them meets nothing.
    pub extended: Vec<Region>,
    /// What the user should look at.
    pub warnings: Vec<DomainWarning>,
}

/// Something about a mesh and its box that is probably not what the user wants.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DomainWarning {
    /// A wall with a setting of its own has no faces.
    #[error(
        "no face lies on the {walls} of the box: the mesh spans {mesh_min} to {mesh_max}, [domain] box is {box_min} to {box_max}"
    )]
    NoFaces {
        /// "sides", "bottom" or "top".
        walls: &'static str,
        /// Least corner of the mesh.
        mesh_min: DVec3,
        /// Greatest corner of the mesh.
        mesh_max: DVec3,
        /// Least corner of the box.
        box_min: DVec3,
        /// Greatest corner of the box.
        box_max: DVec3,
    },
    /// Faces lie on the sides, but no surface that could go on ends there.
    #[error(
        "no surface runs round the sides of the box or down to its bottom, so there is nothing to extend"
    )]
    NothingExtended,
    /// A rim stops without another one going on from there.
    #[error(
        "the surface between regions {} and {} stops at {at} on the sides of the box: its extension has an open edge there",
        front.0, back.0
    )]
    OpenRim {
        /// The lesser label.
        front: Region,
        /// The greater label.
        back: Region,
        /// The last vertex.
        at: DVec3,
    },
    /// A surface ends on a bottom that was removed.
    #[error(
        "{edges} edges of the surface lie on the bottom of the box, which is removed where the sides extend: the fluid is open there (walls.bottom = \"opaque\" keeps a sea bed)"
    )]
    DryBottom {
        /// How many edges.
        edges: usize,
    },
}

/// A `[domain]` table that cannot be applied.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DomainError {
    /// The box is empty, inside out or not finite.
    #[error(
        "[domain] box = {min} to {max} is no box: its first corner must be below its second on every axis"
    )]
    Box {
        /// Least corner.
        min: DVec3,
        /// Greatest corner.
        max: DVec3,
    },
    /// The fluid goes on without end but would keep its bottom.
    #[error(
        "[domain] walls.bottom = \"keep\" contradicts walls.sides = \"extend\", with fluid below the surface without end: set bottom to \"open\" or \"opaque\""
    )]
    BottomKept,
    /// The bottom extends although the sides do not.
    #[error("[domain] walls.bottom = \"extend\" needs walls.sides = \"extend\"")]
    BottomAlone,
    /// The top cannot extend.
    #[error("[domain] walls.top = \"extend\" has no meaning: only the sides and the bottom extend")]
    TopExtended,
    /// The mesh does not say what lies on the two sides of its triangles.
    #[error("{labelled} of {triangles} triangles carry labels: a domain applies to labelled meshes only")]
    Unlabelled {
        /// Triangles with labels.
        labelled: usize,
        /// All triangles.
        triangles: usize,
    },
    /// The extension has more vertices than an index can count.
    #[error("extending a rim of {rim} vertices makes more vertices than the {limit} that a mesh can have")]
    TooLarge {
        /// Vertices on the rim.
        rim: usize,
        /// The limit.
        limit: u32,
    },
}

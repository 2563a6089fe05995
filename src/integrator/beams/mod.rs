//! Path tracing in which suns are found through one refracting interface, whichever way they are bent there.
//!
//! A path that turns at a point x behind an interface would have to run into a disc of half a degree by chance. Instead a
//! direction w to the disc is drawn at x, and all triangles of interfaces through which its light is bent to x are found. Each
//! adds what an eye path would see that goes there from x along -d:
//!
//! ```text
//! L = f (1 - F) T E |dw_x / dw| (n_x / n_i)^2 = f (1 - F) T E  2A |d . n_g| (cos_i / cos_t) / (d_z |det(dg / d(u, v))|)
//! ```
//! with f the phase function, or the BRDF times its cosine, E the irradiance of the sun, T what media leave on both sides, n_g the
//! normal of the triangle of area A, and g, by which rays miss x, as in the page of the patch. It follows from
//! dw_x = 2A |d . n_g| / r^2 d(u, v), Snell's law in the form n_i^2 cos_i dw = n_x^2 cos_t dw_t, and g = 0 for fixed x. With flat
//! normals it is the flux through the triangle over the area that it falls on. Flat water has E cos_i (1 - F) / cos_t.
//!
//! | step | page |
//! |---|---|
//! | once a frame: the triangles that bend light, in pieces where their normals turn much | `gather.rs`, `piece.rs` |
//! | but those that stand in the shade of something opaque | `shade.rs` |
//! | where each can send light of the whole disc | `spread.rs` |
//! | a hierarchy over these, asked for a point, and a first look at what it gives | `index.rs`, `sieve.rs` |
//! | directions towards the glow around a sun | `glow.rs` |
//! | all solutions g = 0 in a triangle | `patch.rs`, `roots.rs` |
//! | the search as a whole: these for a point of the disc, and the one through a point of the triangle | `query.rs` |
//! | what they bring, and what is in the way | `light.rs` |
//!
//! Nishita and Nakamae `[NISHITA94]` follow the volumes that triangles sweep, Walter, Zhao, Holzschuch and Bala `[WALTER09]` the
//! paths from a point; this is the second for light of one direction. Each vertex draws a point of the disc of its own, so what
//! goes to infinity at a caustic is smoothed as the disc smooths it, and a point of each triangle too, which bounds it. Nothing
//! is blurred and nothing is left from pass to pass.
//!
//! What is found so has one refracting interface between the vertex and the sun, and otherwise only index-matched boundaries.
//! Light that is bent twice or reflected on its way, as that through meshes that overlap others, is that of photons
//! ([`super::strays`]). A path that sees the disc through interfaces alone has it as before, and one that was lit never sees
//! it: nothing counts twice.
//!
//! Each sun has beams of its own, in a frame of its own, and a vertex looks for all of them with the same random numbers.

mod gather;
mod glow;
mod index;
mod light;
mod patch;
mod piece;
mod query;
mod roots;
mod shade;
mod sieve;
mod spread;

use glam::DVec2;

use crate::optics::medium::MediumId;
pub use query::Searcher;
pub(super) use query::Ways;

use glow::Directions;
use index::Index;
use patch::SunFrame;
use piece::Piece;
use sieve::Sieves;

/// The triangles that bend light of suns, and where they can send it.
#[derive(Clone, Debug)]
pub struct Beams {
    /// Those of each, in the order of the frame's.
    of_suns: Vec<SunBeams>,
    /// Media that any of these reach, by [`MediumId`]. What photons leave to beams hangs on it too.
    reached: Vec<bool>,
    /// From where the light of the brightest sun comes, in the media that show a glow around it.
    glows: Vec<Option<Directions>>,
}

/// Those that bend light of one sun.
#[derive(Clone, Debug)]
struct SunBeams {
    sun: SunFrame,
    /// The mean slope of all rays, which the index leaves out.
    shear: DVec2,
    beams: Vec<Beam>,
    /// From where light comes in the mean, and from where most of it does on each side.
    mean: Directions,
    /// A first look at eight each.
    sieves: Vec<Sieves>,
    index: Index,
}

/// A triangle, or a part of one, that bends light about its interpolated normals, or about its own.
#[derive(Clone, Copy, Debug)]
struct Beam {
    triangle: u32,
    /// The sun is on its front.
    front: bool,
    shaded: bool,
    /// The part of it, where its normals turn too much for the whole.
    piece: Piece,
}

impl Beams {
    /// True where light is looked for in a medium.
    pub(super) fn reach(&self, medium: MediumId) -> bool {
        self.reached[medium.0 as usize]
    }

    /// From where the light of a medium's glow comes, if it has one.
    fn glow(&self, medium: MediumId) -> Option<Directions> {
        self.glows[medium.0 as usize]
    }

    /// True where any medium has one.
    pub(super) fn show_glow(&self) -> bool {
        self.glows.iter().any(Option::is_some)
    }

    /// Triangles, or pieces of them, through which light is looked for; those whose own normal may be taken for the
    /// interpolated one twice.
    pub fn len(&self) -> usize {
        self.of_suns.iter().map(|own| own.beams.len()).sum()
    }

    /// True without triangles.
    pub fn is_empty(&self) -> bool {
        self.of_suns.iter().all(|own| own.beams.is_empty())
    }

    /// Bytes that they occupy.
    pub fn bytes(&self) -> usize {
        self.of_suns.iter().map(SunBeams::bytes).sum()
    }
}

impl SunBeams {
    fn bytes(&self) -> usize {
        size_of_val(&*self.beams) + size_of_val(&*self.sieves) + self.index.bytes()
    }
}

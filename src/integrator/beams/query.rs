//! The ways of light of the sun's disc to a vertex, whatever blocks them.
//!
//! Through each triangle they are drawn in two ways: by a point of the disc, for which all roots are found, and by a point of the
//! triangle, through which one ray comes from somewhere, and counts where that is on the disc. The first has no bound at a
//! caustic, where light of a point gathers without end, so that its variance has none either; the second has, and has nothing
//! where a triangle is much wider than what it shows of the disc. Each way weighs by the balance heuristic
//! `[VEACH97 section 9.2.2]` as much, whichever found it, by the densities over the weights (u, v),
//!
//! ```text
//! p = |dw / d(u, v)| / Omega,     |dw / d(u, v)| = d_z^3 |det(dg / d(u, v))| (cos_t / cos_i) / ((x - p)_z eta)^2     (1)
//! p = 1 / A,     A the area of the piece in (u, v)                                                                   (2)
//! ```
//! with the names of [`super::patch`], and Omega the solid angle of the disc.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::super::dispersion::Carried;
use super::index::sheared;
use super::patch::{Aim, Pass, Patch};
use super::piece::Piece;
use super::roots::{self, Root};
use super::{Beam, Beams, SunBeams};
use crate::optics::medium::{MediumId, MediumLanes};
use crate::scene::frame::Frame;
use crate::scene::surface::Surface;
use crate::spectrum::{Lanes, Wavelengths};

/// What ways are looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Query {
    /// The vertex, in the frame of the sun.
    pub(super) x: DVec3,
    /// Direction to the point of the disc, there too.
    pub(super) to_sun: DVec3,
    /// 1 less the cosine of half the angular diameter of the disc.
    pub(super) one_minus_cos: f64,
    /// A point of the unit square, for one on each triangle.
    pub(super) place: [f32; 2],
    /// What the vertex is in.
    pub(super) medium: MediumId,
    /// The lanes that matter.
    pub(super) carried: Carried,
    /// In frames since the shutter opened.
    pub(super) time: f32,
}

/// A way through a triangle.
#[derive(Clone, Copy, Debug)]
pub(in crate::integrator) struct Way {
    pub(super) beam: Beam,
    /// The triangle.
    pub(super) corners: [Vec3; 3],
    pub(super) root: Root,
    /// Direction to where on the disc it leads, in the frame of the sun.
    pub(super) to_sun: DVec3,
    /// Irradiance across the ray at the vertex over that across the sun's light, without what is lost, times its weight by the
    /// balance heuristic.
    pub(super) gathered: f64,
    /// Index on the side of the sun over that beyond.
    pub(super) eta: f32,
    /// 1 on the lanes that it holds for.
    pub(super) shown: Lanes,
}

/// What a search finds, and what it needs room for.
#[derive(Clone, Debug, Default)]
pub(in crate::integrator) struct Ways {
    pub(super) found: Vec<Way>,
    /// The triangles that were searched.
    candidates: Vec<u32>,
    roots: Vec<Root>,
}

impl SunBeams {
    /// Lists all ways, and tells how many triangles were searched; `media` are those of the frame.
    pub(super) fn ways(&self, frame: &Frame, query: &Query, media: &[MediumLanes], ways: &mut Ways) -> u64 {
        let mut searched = 0;
        let Ways { found, candidates, roots } = ways;
        found.clear();
        self.candidates(query.x, candidates);
        for beam in candidates.iter().map(|number| self.beams[*number as usize]) {
            let Surface::Interface(pair) = frame.surface(beam.triangle) else { continue };
            let (outer, inner) = pair.crossed(beam.front);
            if inner != query.medium && !frame.needs.matched_interfaces {
                continue;
            }
            searched += 1;
            let corners = frame.geometry.vertices_at(beam.triangle, query.time);
            let normals =
                beam.shaded.then(|| frame.geometry.shading_normals(beam.triangle, query.time)).flatten();
            let patch = Patch::new(&self.sun, &corners, normals, if beam.front { 1.0 } else { -1.0 });
            let etas = media[outer.0 as usize].n / media[inner.0 as usize].n;
            for lane in 0..4 {
                let shown = match query.carried {
                    Carried::One(own) if usize::from(own) != lane => continue,
                    Carried::All if etas == Lanes::splat(etas.x) => Lanes::ONE,
                    _ => Lanes::AXES[lane],
                };
                let eta = etas[lane];
                let aim = Aim { patch: &patch, x: query.x, to_sun: query.to_sun, eta: eta.into() };
                let mut add = |aim: &Aim, root: &Root| {
                    let gathered = aim.gathered(&root.pass) * share(aim, &root.pass, &beam.piece, query);
                    found.push(Way { beam, corners, root: *root, to_sun: aim.to_sun, gathered, eta, shown });
                };
                roots::find(&aim, &beam.piece, roots);
                roots.iter().for_each(|root| add(&aim, root));
                if let Some((aim, root)) = through(&aim, &beam.piece, query) {
                    add(&aim, &root);
                }
                if shown == Lanes::ONE {
                    break;
                }
            }
        }
        searched
    }

    /// Lists the numbers of all beams that may reach a point, in place of what is in the list.
    fn candidates(&self, x: DVec3, found: &mut Vec<u32>) {
        let x = x.as_vec3();
        self.index.find(sheared(x, self.shear.as_vec2()), x, &self.sieves, found);
    }
}

/// The ray through the place that was drawn in a piece, if it comes from the disc.
fn through<'a>(aim: &Aim<'a>, piece: &Piece, query: &Query) -> Option<(Aim<'a>, Root)> {
    if aim.patch.is_flat() {
        return None;
    }
    let uv = piece.at(query.place);
    let to_sun = aim.source(uv)?;
    let is_in_disc = 0.5 * (to_sun - DVec3::NEG_Z).length_squared() <= query.one_minus_cos;
    let aim = Aim { to_sun, ..*aim };
    is_in_disc.then(|| aim.pass(uv)).flatten().map(|pass| (aim, Root { uv, pass }))
}

/// The weight of a way by the balance heuristic, (1) over the sum of (1) and (2); 1 behind a flat triangle, where light gathers
/// nowhere.
fn share(aim: &Aim, pass: &Pass, piece: &Piece, query: &Query) -> f64 {
    if aim.patch.is_flat() {
        return 1.0;
    }
    let by_disc = aim.sun_by_place(pass) / (TAU * query.one_minus_cos); // (1)
    let by_place = 1.0 / piece.area(); // (2)
    by_disc / (by_disc + by_place)
}

/// Searches as paths do, to be timed: for light of the middle of the first sun's disc, when the shutter opens, at indices of
/// the middle of the wavelengths.
#[derive(Debug)]
pub struct Searcher<'a> {
    frame: &'a Frame,
    beams: &'a Beams,
    media: Vec<MediumLanes>,
    ways: Ways,
}

impl<'a> Searcher<'a> {
    /// Through the beams of a frame.
    pub fn new(frame: &'a Frame, beams: &'a Beams) -> Self {
        let wavelengths = Wavelengths::for_mode(frame.mode, 0.5);
        let media = frame.media.iter().map(|medium| medium.lanes(&wavelengths)).collect();
        Self { frame, beams, media, ways: Ways::default() }
    }

    /// How many beams may reach a point.
    pub fn candidates(&mut self, point: Vec3) -> usize {
        let Some(first) = self.beams.of_suns.first() else { return 0 };
        first.candidates(first.sun.local(point), &mut self.ways.candidates);
        self.ways.candidates.len()
    }

    /// How many ways there are to a point in a medium.
    pub fn ways(&mut self, point: Vec3, medium: MediumId) -> usize {
        let (Some(first), Some(sun)) = (self.beams.of_suns.first(), self.frame.lights.suns.first()) else {
            return 0;
        };
        let query = Query {
            x: first.sun.local(point),
            to_sun: DVec3::NEG_Z,
            one_minus_cos: sun.one_minus_cos().into(),
            place: [0.5; 2],
            medium,
            carried: Carried::All,
            time: 0.0,
        };
        first.ways(self.frame, &query, &self.media, &mut self.ways);
        self.ways.found.len()
    }
}

//! The triangles of a frame that bend light of its suns, and where they can send it.
//!
//! A triangle that is long, or whose normals turn much, lights a thin strip across a wide box. It is cut into halves, each
//! with a box of its own, as long as these cover much less.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::glow::{self, Directions};
use super::index::{Index, Reach, WIDTH};
use super::patch::SunFrame;
use super::piece::Piece;
use super::shade::Shade;
use super::sieve::{Sieve, Sieves};
use super::spread::{Fan, Slopes, angle, slope_about};
use super::{Beam, Beams, SunBeams};
use crate::geometry::triangle::scaled_normal;
use crate::light::Sun;
use crate::optics::medium::Medium;
use crate::scene::frame::Frame;
use crate::scene::surface::{MediumPair, Surface};
use crate::spectrum::Wavelengths;

/// Halves must cover less than this part of the whole.
const GAIN: f32 = 0.7;
/// Triangles that cover less than so many times their own area behind them are not worth a try.
const COMPACT: f32 = 3.0;
/// Slopes that are farther than this from linear tell too little.
const LOOSE: f64 = 0.02;
/// Triangles are cut so often, at most.
const MOST_CUTS: u32 = 8;

/// Most rays are within so many times the root of the mean square.
const SPREADS: f64 = 1.5;

/// Wavelengths at which indices are looked up: so many times four.
const STEPS: u32 = 16;

impl Beams {
    /// Those of a frame; `None` without any.
    pub fn new(frame: &Frame) -> Option<Self> {
        let of_suns: Vec<SunBeams> = frame.lights.suns.iter().map(|sun| SunBeams::new(frame, sun)).collect();
        let mut reached = vec![false; frame.media.len()];
        for beam in of_suns.iter().flat_map(|own| &own.beams) {
            if let Surface::Interface(pair) = frame.surface(beam.triangle) {
                reached[pair.crossed(beam.front).1.0 as usize] = true;
            }
        }
        let glows = glow::of_media(frame, &of_suns, &reached);
        Some(Self { of_suns, reached, glows }).filter(|beams| !beams.is_empty())
    }
}

impl SunBeams {
    fn new(frame: &Frame, sun: &Sun) -> Self {
        let depth = 0.5 * frame.accel.bounds().size().max_element();
        let gatherer = Gatherer::new(frame, sun, depth);
        let (beams, (reaches, sieves)): (Vec<Beam>, (Vec<Reach>, Vec<Sieve>)) =
            (0..frame.geometry.triangles.len() as u32)
                .into_par_iter()
                .flat_map_iter(|triangle| gatherer.beams(triangle))
                .unzip();
        let (index, order) = Index::new(&reaches, depth);
        let of_eight = |eight: &[u32]| {
            let all: Vec<Sieve> = eight.iter().map(|number| sieves[*number as usize]).collect();
            Sieves::new(&all)
        };
        let sieves = order.chunks(WIDTH).map(of_eight).collect();
        let beams = order.into_iter().map(|number| beams[number as usize]).collect();
        let Gatherer { sun, shear, spread, .. } = gatherer;
        let mean = beams_come_from(&sun, shear, spread);
        Self { sun, shear, mean, beams, sieves, index }
    }
}

struct Gatherer<'a> {
    frame: &'a Frame,
    sun: SunFrame,
    shade: Shade<'a>,
    /// Half angle of the disc.
    alpha: f64,
    /// Least and greatest index of each medium.
    indices: Vec<[f64; 2]>,
    /// How far behind triangles light is looked for, about.
    depth: f32,
    /// The mean slope of all rays, about.
    shear: DVec2,
    /// Root of the mean square of how far slopes are from it.
    spread: DVec2,
}

/// A triangle at the first and the last moment, in the frame of the sun; once where these are the same.
struct Turning {
    corners: Vec<[DVec3; 3]>,
    /// None where they are not interpolated.
    normals: Vec<[DVec3; 3]>,
    /// Its own.
    own: Fan,
    eta: [f64; 2],
}

/// A beam, its bounds, and a first look at it.
type Gathered = (Beam, (Reach, Sieve));

impl Turning {
    /// The corner opposite to the edge of a piece along which normals turn most.
    fn steadiest(&self, piece: &Piece) -> usize {
        let turn = |corner: usize| {
            let [from, to] = [(corner + 1) % 3, (corner + 2) % 3].map(|k| piece.corners[k]);
            let apart = |of_time: &[DVec3; 3]| mixed(of_time, from).distance(mixed(of_time, to));
            self.normals.iter().map(apart).fold(0.0, f64::max)
        };
        (0..3).max_by(|a, b| turn(*a).total_cmp(&turn(*b))).unwrap_or(0)
    }
}

impl<'a> Gatherer<'a> {
    fn new(frame: &'a Frame, sun: &Sun, depth: f32) -> Self {
        let mut own = Self {
            frame,
            sun: SunFrame::new(sun.direction()),
            shade: Shade::new(frame, sun),
            alpha: f64::from(sun.half_angle()),
            indices: indices(frame),
            depth,
            shear: DVec2::ZERO,
            spread: DVec2::ZERO,
        };
        (own.shear, own.spread) = own.mean_slope();
        own
    }

    /// The beams of both sides of a triangle.
    fn beams(&self, triangle: u32) -> Vec<Gathered> {
        let mut found = Vec::new();
        let frame = self.frame;
        let Surface::Interface(pair) = frame.surface(triangle) else { return found };
        for front in [true, false] {
            let outer = pair.crossed(front).0;
            if pair.matched || !frame.lit[outer.0 as usize] || frame.reflects_beyond(pair, front) {
                continue;
            }
            let Some(turning) = self.turning(triangle, pair, front) else { continue };
            let whole = Beam { triangle, front, shaded: false, piece: Piece::WHOLE };
            if !turning.normals.is_empty() {
                self.pieces(&turning, Beam { shaded: true, ..whole }, &mut found);
            }
            self.pieces(&turning, whole, &mut found);
        }
        found
    }

    /// The slope of rays that are bent about the triangles' own normals, in the mean over the light that they take, and the root
    /// of the mean square of how far it is from that.
    fn mean_slope(&self) -> (DVec2, DVec2) {
        let (mut sum, mut squares, mut light) = (DVec2::ZERO, DVec2::ZERO, 0.0);
        for triangle in 0..self.frame.geometry.triangles.len() as u32 {
            let Surface::Interface(pair) = self.frame.surface(triangle) else { continue };
            let area = self.sun.local(scaled_normal(&self.frame.geometry.vertices(triangle)));
            let front = area.z < 0.0;
            if pair.matched || area.z == 0.0 || !self.frame.lit[pair.crossed(front).0.0 as usize] {
                continue;
            }
            let normal = if front { area } else { -area }.normalize();
            let [least, most] = self.eta(pair, front);
            let slope = slope_about(normal, 0.5 * (least + most));
            if slope.is_finite() {
                sum += slope * area.z.abs();
                squares += slope * slope * area.z.abs();
                light += area.z.abs();
            }
        }
        if light <= 0.0 {
            return (DVec2::ZERO, DVec2::ZERO);
        }
        let mean = sum / light;
        (mean, (squares / light - mean * mean).max(DVec2::ZERO).map(f64::sqrt))
    }

    /// The triangle as the sun sees it; none where it shines on its other side only.
    fn turning(&self, triangle: u32, pair: &MediumPair, front: bool) -> Option<Turning> {
        let side = if front { 1.0 } else { -1.0 };
        let geometry = &self.frame.geometry;
        let ends = [self.frame.views.time(0.0), self.frame.views.time(1.0)];
        let times = if ends[0] == ends[1] { &ends[..1] } else { &ends[..] };
        let eta = self.eta(pair, front);
        // Interpolated normals may let light through where its own reflects all of it.
        let own = Fan::new(&self.own_normals(triangle, ends, side), self.alpha, eta);
        let own = own.filter(Fan::faces_the_sun)?;
        let corners = times.iter().map(|&t| geometry.vertices_at(triangle, t).map(|p| self.sun.local(p)));
        let normals = times.iter().filter_map(|&t| geometry.shading_normals(triangle, t));
        let normals = normals.map(|all| all.map(|n| self.sun.local(n) * side));
        Some(Turning { corners: corners.collect(), normals: normals.collect(), own, eta })
    }

    /// Those of a piece, in halves where its rays are within wide bounds.
    fn pieces(&self, turning: &Turning, beam: Beam, found: &mut Vec<Gathered>) {
        let Some((reach, bulge)) = self.piece(turning, beam) else { return };
        if self.shade.covers(beam.triangle, &beam.piece) {
            return;
        }
        if beam.piece.cuts < MOST_CUTS
            && let Some(halves) = self.halves(turning, &beam, reach.area(self.depth), bulge)
        {
            for piece in halves {
                self.pieces(turning, Beam { piece, ..beam }, found);
            }
            return;
        }
        found.push((beam, (reach, self.sieve(turning, &beam))));
    }

    /// Halves of a piece that covers so much, where these cover much less or it turns too much to tell.
    fn halves(&self, turning: &Turning, beam: &Beam, area: f32, bulge: f64) -> Option<[Piece; 2]> {
        if bulge > LOOSE {
            return Some(beam.piece.halves(turning.steadiest(&beam.piece)));
        }
        if area < COMPACT * self.own_area(turning, &beam.piece) {
            return None;
        }
        let covered = |halves: &[Piece; 2]| {
            let halves = halves.iter().filter_map(|&piece| self.piece(turning, Beam { piece, ..*beam }));
            halves.map(|(reach, _)| reach.area(self.depth)).sum::<f32>()
        };
        let ways = [0, 1, 2].map(|corner| beam.piece.halves(corner)).map(|halves| (covered(&halves), halves));
        let best = ways.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        best.filter(|best| best.0 < GAIN * area).map(|best| best.1)
    }

    /// Bounds of a piece, and how far its slopes are from linear, at most; none where it bends no light.
    fn piece(&self, turning: &Turning, beam: Beam) -> Option<(Reach, f64)> {
        let of_piece = |all: &[[DVec3; 3]]| -> Vec<DVec3> {
            all.iter().flat_map(|of_time| beam.piece.corners.map(|uv| mixed(of_time, uv))).collect()
        };
        let shading = || Fan::new(&of_piece(&turning.normals), self.alpha, turning.eta);
        let (slopes, bulge) = if beam.shaded {
            match shading() {
                Some(fan) if !fan.is_lit() => return None,
                Some(fan) => (fan.slopes(), fan.bulge()),
                None => (Slopes::widest(turning.eta, self.alpha), f64::INFINITY),
            }
        } else if !turning.own.is_lit() || shading().is_some_and(|fan| is_sound(&fan, &turning.own)) {
            return None;
        } else {
            (turning.own.slopes(), 0.0)
        };
        let reach = Reach::new(of_piece(&turning.corners).into_iter(), &slopes, self.shear);
        Some((reach, bulge))
    }

    /// A first look at a piece, where it stands still.
    fn sieve(&self, turning: &Turning, beam: &Beam) -> Sieve {
        let [corners] = &*turning.corners else { return Sieve::OPEN };
        let corners = beam.piece.corners.map(|uv| mixed(corners, uv));
        match &*turning.normals {
            [normals] if beam.shaded => {
                let normals = beam.piece.corners.map(|uv| mixed(normals, uv));
                let fan = Fan::new(&normals, self.alpha, turning.eta);
                fan.map_or(Sieve::OPEN, |fan| Sieve::new(corners, normals, &fan))
            }
            _ => Sieve::new(corners, [turning.own.normal; 3], &turning.own),
        }
    }

    /// About what a piece of a flat triangle lights.
    fn own_area(&self, turning: &Turning, piece: &Piece) -> f32 {
        let [a, b, c] = piece.corners.map(|uv| mixed(&turning.corners[0], uv).truncate());
        let blur = 2.0 * self.alpha * f64::from(self.depth);
        ((b - a).perp_dot(c - a).abs() + blur * blur) as f32
    }

    fn eta(&self, pair: &MediumPair, front: bool) -> [f64; 2] {
        let (outer, inner) = pair.crossed(front);
        let [outer, inner] = [outer, inner].map(|id| self.indices[id.0 as usize]);
        [outer[0] / inner[1], outer[1] / inner[0]]
    }

    /// Vectors whose cone holds the triangle's normal at all times: while its corners move evenly it is quadratic in time, with
    /// these Bernstein coefficients.
    fn own_normals(&self, triangle: u32, [first, last]: [f32; 2], side: f64) -> [DVec3; 3] {
        let at = |time: f32| {
            let v = self.frame.geometry.vertices_at(triangle, time);
            self.sun.local(scaled_normal(&v)).normalize_or_zero() * side
        };
        if first == last {
            return [at(first); 3];
        }
        let scaled = |time: f32| {
            self.sun.local(scaled_normal(&self.frame.geometry.vertices_at(triangle, time))) * side
        };
        let [start, middle, end] = [first, 0.5 * (first + last), last].map(scaled);
        [start, 2.0 * middle - 0.5 * (start + end), end]
    }
}

/// Directions from which rays of a mean slope come, and of those that are as far from it as most.
fn beams_come_from(sun: &SunFrame, mean: DVec2, spread: DVec2) -> Directions {
    let [s, t] = [DVec2::X, DVec2::Y].map(|axis| SPREADS * spread * axis);
    [mean, mean + s, mean - s, mean + t, mean - t].map(|slope| -sun.world(slope.extend(1.0).normalize()))
}

/// Least and greatest index of each medium over wavelength.
fn indices(frame: &Frame) -> Vec<[f64; 2]> {
    let of_medium = |medium: &Medium| {
        let all = (0..STEPS).flat_map(|i| {
            let at = (i as f32 + 0.5) / STEPS as f32;
            medium.lanes(&Wavelengths::for_mode(frame.mode, 0.25 * at)).n.to_array()
        });
        let (least, most) = all.fold((f32::MAX, 0.0_f32), |(l, m), n| (l.min(n), m.max(n)));
        // Between two of the wavelengths, and beyond the last, it may be a little off.
        let beyond = 0.2 * (most - least);
        [f64::from(least - beyond), f64::from(most + beyond)]
    };
    frame.media.iter().map(of_medium).collect()
}

/// True when no ray of the sun can be bent about the triangle's own normal in the place of interpolated ones: the normals, the
/// light and what is reflected about them on the far side all keep to their side of the triangle.
fn is_sound(shading: &Fan, own: &Fan) -> bool {
    let quarter = std::f64::consts::FRAC_PI_2 - 1e-4;
    let lean = angle(shading.normal, own.normal) + shading.phi + own.phi;
    let sun = angle(own.normal, DVec3::NEG_Z) + own.phi + own.alpha;
    // A ray bent about the own normal is mirrored about an interpolated one to at most twice the lean from where it was.
    let by_own = 2.0 * lean + own.steepest() < quarter && lean + sun < quarter;
    by_own && lean + shading.steepest() < quarter
}

/// What is linear over a triangle.
fn mixed([a, b, c]: &[DVec3; 3], uv: DVec2) -> DVec3 {
    *a + (*b - *a) * uv.x + (*c - *a) * uv.y
}

#[cfg(test)]
mod tests {
    use super::super::super::interface;
    use super::super::spread::refracted;
    use super::*;
    use crate::sampling::{SampleSeed, SampleStream};

    /// An eye path that runs along a ray which the triangle's own normal bends takes the interpolated one where it is told to be
    /// sound, at normals up to a right angle apart and indices on both sides of 1; and some triangles are.
    #[test]
    fn sound_normals_are_taken_for_rays_bent_about_the_own() {
        let (mut sound, mut cases) = (0, 0);
        for i in 0..400_000 {
            let mut stream = SampleStream::new(SampleSeed::new(3), i, 0, 0);
            let mut vector =
                || DVec3::from_array(stream.next4().map(f64::from)[..3].try_into().unwrap()) * 2.0 - 1.0;
            let own = (vector() - DVec3::Z).normalize();
            let lean = [0.05, 0.3, 1.0][i as usize % 3];
            let normals = [0; 3].map(|_| (own + lean * vector()).normalize());
            let weights = vector().abs();
            let ns = (normals[0] * weights.x + normals[1] * weights.y + normals[2] * weights.z).normalize();
            let eta = [0.75, 1.3, 0.98, 0.5][i as usize / 3 % 4];
            let alpha = 0.0046;
            let fans = [&normals[..], &[own]].map(|n| Fan::new(n, alpha, [eta; 2]));
            let [Some(shading), Some(own_fan)] = fans else { continue };
            let Some(d) = refracted(own, eta) else { continue };
            cases += 1;
            if is_sound(&shading, &own_fan) {
                sound += 1;
                let ways = interface::ways(d.as_vec3(), -ns.as_vec3(), -own.as_vec3(), eta as f32);
                assert!(ways.shaded, "{i}: own {own} interpolated {ns} index {eta}");
            }
        }
        assert!(sound * 5 > cases, "{sound} of {cases}");
    }
}

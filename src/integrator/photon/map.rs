//! Photons in space, asked for those around a point or around a ray.
//!
//! Each photon has a reach, the radius over which its flux is spread: the map's radius times the photon's own spread.
//! Photons are sorted along a Morton curve and taken together by eight, and these groups by eight again, up to one root:
//! a tree without pointers whose boxes, which hold the reaches, lie in structures of arrays. Sorting by (place on the
//! curve, number of the photon) makes the order, and with it every sum, independent of threads.

use glam::Vec3;
use rayon::prelude::*;

use crate::geometry::machine::{Work, in_wide_registers};
use crate::geometry::{Bounds, Ray};
use crate::optics::medium::MediumId;
use crate::spectrum::Lanes;

/// Light that has arrived somewhere.
#[derive(Clone, Copy, Debug)]
pub struct Photon {
    /// Where, in metres from the scene's origin.
    pub position: Vec3,
    /// Unit direction of travel on arrival.
    pub direction: Vec3,
    /// Unit normal of the surface on the side of arrival; zero in a medium.
    pub normal: Vec3,
    /// The medium that it has arrived in.
    pub medium: MediumId,
    /// Flux in W (per nm where lanes are wavelengths) on the lanes. In a medium it is what is scattered there, before
    /// the phase function; on a surface what would be reflected by an albedo of 1.
    pub flux: Lanes,
    /// It was scattered before it arrived, and not only within the peaks of phase functions.
    pub scattered: bool,
    /// How much wider than others it is spread, at least 1: photons that stand for much light, being emitted where there
    /// are few, would be seen one by one.
    pub spread: f32,
}

/// Children of a group.
const WIDTH: usize = 8;
/// Groups waiting to be visited at most: seven left behind on each of eleven levels, which hold 2^33 photons.
const STACK: usize = 80;

/// Boxes of eight groups, or of the reaches of eight photons.
#[derive(Clone, Copy, Debug)]
struct Group {
    min: [[f32; WIDTH]; 3],
    max: [[f32; WIDTH]; 3],
}

/// A map of photons.
#[derive(Clone, Debug, Default)]
pub struct PhotonMap {
    photons: Vec<Photon>,
    /// Level 0 has the reaches of eight photons each, every other the boxes of eight groups below.
    levels: Vec<Vec<Group>>,
    /// Reach of a photon of spread 1, in metres.
    radius: f32,
    /// Greatest reach.
    widest: f32,
}

impl PhotonMap {
    /// A map of photons, whose order is part of the result, that are spread over `radius` metres times their own spread.
    pub fn new(photons: &[Photon], radius: f32) -> Self {
        let bounds = Bounds::of_points(photons.iter().map(|p| p.position));
        let mut order: Vec<(u64, u32)> = photons
            .par_iter()
            .zip(0_u32..photons.len() as u32)
            .map(|(photon, index)| (morton(photon.position, &bounds), index))
            .collect();
        order.par_sort_unstable();
        let photons: Vec<Photon> = order.par_iter().map(|&(_, index)| photons[index as usize]).collect();
        let mut levels: Vec<Vec<Group>> = Vec::new();
        if !photons.is_empty() {
            levels.push(photons.par_chunks(WIDTH).map(|eight| Group::of_photons(eight, radius)).collect());
            while let Some(below) = levels.last().filter(|level| level.len() > 1) {
                levels.push(below.chunks(WIDTH).map(Group::of_groups).collect());
            }
        }
        let widest = photons.iter().map(|p| radius * p.spread).fold(0.0, f32::max);
        Self { photons, levels, radius, widest }
    }

    /// How many photons there are.
    pub fn len(&self) -> usize {
        self.photons.len()
    }

    /// True without photons.
    pub fn is_empty(&self) -> bool {
        self.photons.is_empty()
    }

    /// The photons in the order of the map.
    pub fn photons(&self) -> &[Photon] {
        &self.photons
    }

    /// Shows each photon whose reach comes within `radius` of a point, with the square of its distance and its reach.
    #[inline]
    pub fn each_around(&self, centre: Vec3, radius: f32, mut visit: impl FnMut(&Photon, f32, f32)) {
        self.walk(centre, (radius * radius).max(f32::MIN_POSITIVE), |photon| {
            let squared = photon.position.distance_squared(centre);
            let reach = self.radius * photon.spread;
            if squared < (radius + reach) * (radius + reach) {
                visit(photon, squared, reach);
            }
        });
    }

    /// Shows each photon that reaches the line of a ray, with the distance along the line, the square of that from it,
    /// and its reach.
    ///
    /// Photons may lie `beyond` times their reach before the start of the ray and behind its end.
    #[inline]
    pub fn each_around_ray(
        &self,
        ray: &Ray,
        beyond: [f32; 2],
        mut visit: impl FnMut(&Photon, f32, f32, f32),
    ) {
        let slabs = RaySlabs::new(ray, [-beyond[0] * self.widest, ray.t_max + beyond[1] * self.widest]);
        self.walk(slabs, 0.5, |photon| {
            let to = photon.position - ray.origin;
            let along = to.dot(ray.direction);
            let squared = (to - ray.direction * along).length_squared();
            let reach = self.radius * photon.spread;
            let is_beside = along > -beyond[0] * reach && along < ray.t_max + beyond[1] * reach;
            if squared < reach * reach && is_beside {
                visit(photon, along, squared, reach);
            }
        });
    }

    /// How far a point is from what the nearest photon reaches, at most `most`; 0 within.
    pub fn clearance(&self, point: Vec3, most: f32) -> f32 {
        let Some(top) = self.levels.len().checked_sub(1) else { return most };
        let mut nearest = most.max(0.0);
        let mut stack = [(0_u8, 0_u32, 0.0_f32); STACK];
        stack[0] = (top as u8, 0, 0.0);
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let (level, index, squared) = stack[waiting];
            if squared >= nearest * nearest {
                continue;
            }
            let mut squares = [0.0; WIDTH];
            self.levels[level as usize][index as usize].squared_distances(point, &mut squares);
            let first = index as usize * WIDTH;
            let below = if level == 0 { self.photons.len() } else { self.levels[level as usize - 1].len() };
            for (child, squared) in (first..below).zip(squares) {
                if squared >= nearest * nearest {
                    continue;
                }
                if level == 0 {
                    let photon = &self.photons[child];
                    let distance = photon.position.distance(point) - self.radius * photon.spread;
                    nearest = nearest.min(distance.max(0.0));
                } else {
                    stack[waiting] = (level - 1, child as u32, squared);
                    waiting += 1;
                }
            }
        }
        nearest
    }

    /// Visits the photons of all groups whose measure is below `limit`.
    #[inline(always)]
    fn walk(&self, measure: impl Measure, limit: f32, visit: impl FnMut(&Photon)) {
        in_wide_registers(Walk { map: self, measure, limit, visit });
    }
}

/// What is asked of the boxes of a group. No closure: it would not be compiled for wide registers.
trait Measure {
    fn of(&self, group: &Group, out: &mut [f32; WIDTH]);
}

/// Squared distances.
impl Measure for Vec3 {
    #[inline(always)]
    fn of(&self, group: &Group, out: &mut [f32; WIDTH]) {
        group.squared_distances(*self, out);
    }
}

/// 0 for the boxes that a ray enters, 1 for others.
impl Measure for RaySlabs {
    #[inline(always)]
    fn of(&self, group: &Group, out: &mut [f32; WIDTH]) {
        group.entered(self, out);
    }
}

struct Walk<'a, M, V> {
    map: &'a PhotonMap,
    measure: M,
    limit: f32,
    visit: V,
}

impl<M: Measure, V: FnMut(&Photon)> Work for Walk<'_, M, V> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { map, measure, limit, mut visit } = self;
        let Some(top) = map.levels.len().checked_sub(1) else { return };
        let mut stack = [(0_u8, 0_u32); STACK];
        stack[0] = (top as u8, 0);
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let (level, index) = stack[waiting];
            let mut measures = [0.0; WIDTH];
            measure.of(&map.levels[level as usize][index as usize], &mut measures);
            let first = index as usize * WIDTH;
            let below = if level == 0 { map.photons.len() } else { map.levels[level as usize - 1].len() };
            for (child, measure) in (first..below).zip(measures) {
                if measure >= limit {
                    continue;
                }
                if level == 0 {
                    visit(&map.photons[child]);
                } else {
                    stack[waiting] = (level - 1, child as u32);
                    waiting += 1;
                }
            }
        }
    }
}

/// A ray as boxes see it.
struct RaySlabs {
    origin: [f32; 3],
    inverse: [f32; 3],
    /// Where it starts and ends.
    range: [f32; 2],
}

impl RaySlabs {
    fn new(ray: &Ray, range: [f32; 2]) -> Self {
        // A direction along an axis gets a tiny component, so that no slab is 0 times infinity.
        let inverse =
            ray.direction.to_array().map(|d| 1.0 / if d.abs() < 1e-20 { 1e-20_f32.copysign(d) } else { d });
        Self { origin: ray.origin.to_array(), inverse, range }
    }
}

impl Group {
    const EMPTY: Self = Self { min: [[f32::INFINITY; WIDTH]; 3], max: [[f32::NEG_INFINITY; WIDTH]; 3] };

    fn of_photons(photons: &[Photon], radius: f32) -> Self {
        let mut group = Self::EMPTY;
        for (child, photon) in photons.iter().enumerate() {
            // By rounding the slabs of a box may just miss what lies on its rim.
            let reach = radius * photon.spread * 1.0001;
            for (axis, value) in photon.position.to_array().into_iter().enumerate() {
                group.min[axis][child] = value - reach;
                group.max[axis][child] = value + reach;
            }
        }
        group
    }

    fn of_groups(groups: &[Self]) -> Self {
        let mut group = Self::EMPTY;
        for (child, below) in groups.iter().enumerate() {
            for axis in 0..3 {
                group.min[axis][child] = below.min[axis].iter().copied().fold(f32::INFINITY, f32::min);
                group.max[axis][child] = below.max[axis].iter().copied().fold(f32::NEG_INFINITY, f32::max);
            }
        }
        group
    }

    #[inline(always)]
    fn squared_distances(&self, point: Vec3, out: &mut [f32; WIDTH]) {
        for ((min, max), at) in self.min.iter().zip(&self.max).zip(point.to_array()) {
            for ((out, min), max) in out.iter_mut().zip(min).zip(max) {
                let outside = (min - at).max(at - max).max(0.0);
                *out += outside * outside;
            }
        }
    }

    /// 0 for the boxes that a ray enters, 1 for others.
    #[inline(always)]
    fn entered(&self, ray: &RaySlabs, out: &mut [f32; WIDTH]) {
        let mut near = [ray.range[0]; WIDTH];
        let mut far = [ray.range[1]; WIDTH];
        for axis in 0..3 {
            for child in 0..WIDTH {
                let a = (self.min[axis][child] - ray.origin[axis]) * ray.inverse[axis];
                let b = (self.max[axis][child] - ray.origin[axis]) * ray.inverse[axis];
                near[child] = near[child].max(a.min(b));
                far[child] = far[child].min(a.max(b));
            }
        }
        for child in 0..WIDTH {
            out[child] = if near[child] <= far[child] { 0.0 } else { 1.0 };
        }
    }
}

/// Place on the Morton curve through 2^21 cells along each edge of the bounds' greatest side.
fn morton(position: Vec3, bounds: &Bounds) -> u64 {
    let scale = 2_097_151.0 / bounds.size().max_element().max(f32::MIN_POSITIVE);
    let cell = ((position - bounds.min) * scale).to_array().map(|x| spread(x as u64));
    cell[0] | cell[1] << 1 | cell[2] << 2
}

/// Puts two zero bits between the 21 bits of a number.
fn spread(mut x: u64) -> u64 {
    x &= 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff_u64),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{SampleSeed, SampleStream};

    fn number(i: u32) -> Vec3 {
        let u = SampleStream::new(SampleSeed::new(5), i, 0, 0).next4();
        Vec3::new(u[0], u[1], u[2] * u[2])
    }

    /// Every fifth is spread three times as wide.
    fn photons(count: u32) -> Vec<Photon> {
        let photon = |i| Photon {
            position: number(i),
            direction: Vec3::Z,
            normal: Vec3::ZERO,
            medium: MediumId(0),
            flux: Lanes::splat(i as f32),
            scattered: false,
            spread: if i % 5 == 0 { 3.0 } else { 1.0 },
        };
        (0..count).map(photon).collect()
    }

    fn names(photons: &[Photon], holds: impl Fn(&Photon) -> bool) -> Vec<u32> {
        photons.iter().filter(|p| holds(p)).map(|p| p.flux.x as u32).collect()
    }

    #[test]
    fn points_are_reached_by_what_is_around_them() {
        for count in [0, 1, 7, 8, 9, 64, 65, 5000] {
            let photons = photons(count);
            for (own, radius) in [(0.0, 0.1), (0.05, 0.0), (0.2, 0.1), (2.0, 0.0)] {
                let map = PhotonMap::new(&photons, own);
                assert_eq!(map.len(), count as usize);
                for i in 0..50 {
                    let centre = number(90_000 + i) * 1.2 - 0.1;
                    let mut found: Vec<u32> = Vec::new();
                    map.each_around(centre, radius, |p, squared, reach| {
                        assert_eq!((squared, reach), (p.position.distance_squared(centre), own * p.spread));
                        found.push(p.flux.x as u32);
                    });
                    found.sort_unstable();
                    let expected = names(&photons, |p| {
                        p.position.distance_squared(centre)
                            < (radius + own * p.spread) * (radius + own * p.spread)
                    });
                    assert_eq!(found, expected);
                }
            }
        }
    }

    #[test]
    fn rays_are_reached_by_what_is_around_them() {
        let photons = photons(3000);
        let axes = [Vec3::X, Vec3::NEG_Y, Vec3::Z];
        let mut met = 0;
        for (own, beyond) in [(0.005, [0.0, 0.0]), (0.1, [0.0, 0.0]), (0.05, [1.0, 3.0])] {
            let map = PhotonMap::new(&photons, own);
            for i in 0..300 {
                let direction =
                    if i < 9 { axes[i as usize % 3] } else { (number(i) - number(i + 7000)).normalize() };
                let t_max = if i % 3 == 0 { f32::INFINITY } else { 0.4 };
                let ray = Ray { t_max, ..Ray::new(number(40_000 + i) * 1.5 - 0.2, direction) };
                let mut found: Vec<u32> = Vec::new();
                map.each_around_ray(&ray, beyond, |p, _, _, _| found.push(p.flux.x as u32));
                found.sort_unstable();
                let expected = names(&photons, |p| {
                    let (to, reach) = (p.position - ray.origin, own * p.spread);
                    let along = to.dot(direction);
                    let squared = (to - direction * along).length_squared();
                    let is_beside = along > -beyond[0] * reach && along < t_max + beyond[1] * reach;
                    squared < reach * reach && is_beside
                });
                met += expected.len();
                assert_eq!(found, expected, "{ray:?} {own}");
            }
        }
        assert!(met > 1000, "{met} photons are too few for a test");
    }

    #[test]
    fn the_way_to_the_nearest_reach_is_that_of_a_search_through_all() {
        for count in [0, 1, 8, 9, 65, 3000] {
            let photons = photons(count);
            for (own, most) in [(0.0, 1.0), (0.02, 0.3), (0.02, 0.01), (0.3, 2.0)] {
                let map = PhotonMap::new(&photons, own);
                for i in 0..50 {
                    let centre = number(90_000 + i) * 1.6 - 0.3;
                    let reach = |p: &Photon| (p.position.distance(centre) - own * p.spread).max(0.0);
                    let expected = photons.iter().map(reach).fold(most, f32::min);
                    assert_eq!(map.clearance(centre, most), expected, "{count} {own} {most}");
                }
            }
        }
    }

    #[test]
    fn photons_in_one_place_are_all_found() {
        let here = Photon { position: Vec3::ONE, ..photons(1)[0] };
        let map = PhotonMap::new(&[here; 1000], 1e-6);
        let mut count = 0;
        map.each_around(Vec3::ONE, 0.0, |_, _, _| count += 1);
        assert_eq!(count, 1000);
    }
}

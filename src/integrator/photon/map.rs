//! Photons in space, asked for those in a ball or around a ray.
//!
//! Photons are sorted along a Morton curve and taken together by eight, and these groups by eight again, up to one root:
//! a tree without pointers whose boxes lie in structures of arrays. Sorting by (place on the curve, number of the photon)
//! makes the order, and with it every sum, independent of threads.

use glam::Vec3;
use rayon::prelude::*;

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
}

/// Children of a group.
const WIDTH: usize = 8;
/// Groups waiting to be visited at most: seven left behind on each of eleven levels, which hold 2^33 photons.
const STACK: usize = 80;

/// Boxes of eight groups, or eight points.
#[derive(Clone, Copy, Debug)]
struct Group {
    min: [[f32; WIDTH]; 3],
    max: [[f32; WIDTH]; 3],
}

/// A map of photons.
#[derive(Clone, Debug, Default)]
pub struct PhotonMap {
    photons: Vec<Photon>,
    /// Level 0 has the points of eight photons each, every other the boxes of eight groups below.
    levels: Vec<Vec<Group>>,
}

impl PhotonMap {
    /// A map of photons, whose order is part of the result.
    pub fn new(photons: &[Photon]) -> Self {
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
            levels.push(photons.par_chunks(WIDTH).map(Group::of_points).collect());
            while let Some(below) = levels.last().filter(|level| level.len() > 1) {
                levels.push(below.chunks(WIDTH).map(Group::of_groups).collect());
            }
        }
        Self { photons, levels }
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

    /// Shows each photon within `radius` of a point with the square of its distance.
    #[inline]
    pub fn each_in_ball(&self, centre: Vec3, radius: f32, mut visit: impl FnMut(&Photon, f32)) {
        let reach = radius * radius;
        self.walk(
            |group, out| group.squared_distances(centre, out),
            reach,
            |photon| {
                let squared = photon.position.distance_squared(centre);
                if squared < reach {
                    visit(photon, squared);
                }
            },
        );
    }

    /// Shows each photon within `radius` of the line of a ray, and no more than `beyond` before its start and behind its
    /// end, with the distance along the line and the square of that from it.
    #[inline]
    pub fn each_around_ray(
        &self,
        ray: &Ray,
        radius: f32,
        beyond: [f32; 2],
        mut visit: impl FnMut(&Photon, f32, f32),
    ) {
        let reach = radius * radius;
        let (first, last) = (-beyond[0], ray.t_max + beyond[1]);
        let slabs = RaySlabs::new(ray, radius, [first, last]);
        self.walk(
            |group, out| group.entered(&slabs, out),
            0.5,
            |photon| {
                let to = photon.position - ray.origin;
                let along = to.dot(ray.direction);
                let squared = (to - ray.direction * along).length_squared();
                if squared < reach && along > first && along < last {
                    visit(photon, along, squared);
                }
            },
        );
    }

    /// Visits the photons of all groups whose measure is below `limit`.
    #[inline(always)]
    fn walk(&self, measure: impl Fn(&Group, &mut [f32; WIDTH]), limit: f32, mut visit: impl FnMut(&Photon)) {
        let Some(top) = self.levels.len().checked_sub(1) else { return };
        let mut stack = [(0_u8, 0_u32); STACK];
        stack[0] = (top as u8, 0);
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let (level, index) = stack[waiting];
            let mut measures = [0.0; WIDTH];
            measure(&self.levels[level as usize][index as usize], &mut measures);
            let first = index as usize * WIDTH;
            let below = if level == 0 { self.photons.len() } else { self.levels[level as usize - 1].len() };
            for (child, measure) in (first..below).zip(measures) {
                if measure >= limit {
                    continue;
                }
                if level == 0 {
                    visit(&self.photons[child]);
                } else {
                    stack[waiting] = (level - 1, child as u32);
                    waiting += 1;
                }
            }
        }
    }
}

/// A ray as boxes see it that are wider by a radius on all sides.
struct RaySlabs {
    origin: [f32; 3],
    inverse: [f32; 3],
    radius: f32,
    /// Where it starts and ends.
    range: [f32; 2],
}

impl RaySlabs {
    fn new(ray: &Ray, radius: f32, range: [f32; 2]) -> Self {
        // A direction along an axis gets a tiny component, so that no slab is 0 times infinity.
        let inverse =
            ray.direction.to_array().map(|d| 1.0 / if d.abs() < 1e-20 { 1e-20_f32.copysign(d) } else { d });
        // By rounding the slabs of a box may just miss what lies on its rim.
        Self { origin: ray.origin.to_array(), inverse, radius: radius * 1.0001, range }
    }
}

impl Group {
    const EMPTY: Self = Self { min: [[f32::INFINITY; WIDTH]; 3], max: [[f32::NEG_INFINITY; WIDTH]; 3] };

    fn of_points(photons: &[Photon]) -> Self {
        let mut group = Self::EMPTY;
        for (child, photon) in photons.iter().enumerate() {
            for (axis, value) in photon.position.to_array().into_iter().enumerate() {
                group.min[axis][child] = value;
                group.max[axis][child] = value;
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
                let a = (self.min[axis][child] - ray.radius - ray.origin[axis]) * ray.inverse[axis];
                let b = (self.max[axis][child] + ray.radius - ray.origin[axis]) * ray.inverse[axis];
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
        let u = SampleStream::new(SampleSeed { seed: 5, frame: 0 }, i, 0, 0).next4();
        Vec3::new(u[0], u[1], u[2] * u[2])
    }

    fn photons(count: u32) -> Vec<Photon> {
        let photon = |i| Photon {
            position: number(i),
            direction: Vec3::Z,
            normal: Vec3::ZERO,
            medium: MediumId(0),
            flux: Lanes::splat(i as f32),
        };
        (0..count).map(photon).collect()
    }

    #[test]
    fn balls_hold_what_is_in_them() {
        for count in [0, 1, 7, 8, 9, 64, 65, 5000] {
            let photons = photons(count);
            let map = PhotonMap::new(&photons);
            assert_eq!(map.len(), count as usize);
            for (i, radius) in [0.01, 0.1, 0.3, 2.0].into_iter().cycle().take(100).enumerate() {
                let centre = number(90_000 + i as u32) * 1.2 - 0.1;
                let mut found: Vec<u32> = Vec::new();
                map.each_in_ball(centre, radius, |p, squared| {
                    assert_eq!(squared, p.position.distance_squared(centre));
                    found.push(p.flux.x as u32);
                });
                found.sort_unstable();
                let near = |p: &&Photon| p.position.distance_squared(centre) < radius * radius;
                let expected: Vec<u32> = photons.iter().filter(near).map(|p| p.flux.x as u32).collect();
                assert_eq!(found, expected);
            }
        }
    }

    #[test]
    fn rays_meet_what_is_around_them() {
        let photons = photons(3000);
        let map = PhotonMap::new(&photons);
        let axes = [Vec3::X, Vec3::NEG_Y, Vec3::Z];
        let mut met = 0;
        for i in 0..300 {
            let direction =
                if i < 9 { axes[i as usize % 3] } else { (number(i) - number(i + 7000)).normalize() };
            let t_max = if i % 3 == 0 { f32::INFINITY } else { 0.4 };
            let ray = Ray { origin: number(40_000 + i) * 1.5 - 0.2, direction, t_max };
            for (radius, beyond) in [(0.005, [0.0, 0.0]), (0.1, [0.0, 0.0]), (0.1, [0.1, 0.3])] {
                let mut found: Vec<u32> = Vec::new();
                map.each_around_ray(&ray, radius, beyond, |p, _, _| found.push(p.flux.x as u32));
                found.sort_unstable();
                let near = |p: &&Photon| {
                    let to = p.position - ray.origin;
                    let along = to.dot(direction);
                    let squared = (to - direction * along).length_squared();
                    along > -beyond[0] && along < t_max + beyond[1] && squared < radius * radius
                };
                let expected: Vec<u32> = photons.iter().filter(near).map(|p| p.flux.x as u32).collect();
                met += expected.len();
                assert_eq!(found, expected, "{ray:?} {radius}");
            }
        }
        assert!(met > 1000, "{met} photons are too few for a test");
    }

    #[test]
    fn photons_in_one_place_are_all_found() {
        let here = Photon { position: Vec3::ONE, ..photons(1)[0] };
        let map = PhotonMap::new(&[here; 1000]);
        let mut count = 0;
        map.each_in_ball(Vec3::ONE, 1e-6, |_, _| count += 1);
        assert_eq!(count, 1000);
    }
}

//! Whether coordinates have lost their detail: numbers of single precision, far from zero.
//!
//! Between 2^e and 2^(e + 1) a number of single precision is a multiple of
//! ```text
//! step = 2^(e - 23)
//! ```
//! whether its file holds it as such or as a double that was one once. A mesh has lost its detail where half of its edges
//! are shorter than 100 steps: directions of faces are then off by up to half a degree. A mesh around zero would need
//! 80,000 edges in a row for that; so it is the mark of one that stands far from it, as in coordinates of a survey.

use std::fmt;

use glam::DVec3;

use super::RawMesh;

/// Edges of so many steps show no steps.
const FINE: f64 = 100.0;

/// So many triangles are looked at.
const SAMPLE: usize = 1024;

/// Of numbers that were rounded half are odd multiples of their step. Where less than this share is, as on a grid of whole
/// metres, the numbers are what their writer meant.
const ROUNDED: f64 = 0.125;

/// Coordinates that have lost their detail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coarse {
    /// How far from zero the farthest coordinate is that was looked at, in the file's units.
    pub far: f64,
    /// What numbers so far away are multiples of.
    pub step: f64,
    /// Length of the median edge.
    pub edge: f64,
}

impl fmt::Display for Coarse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { far, step, edge } = self;
        write!(
            f,
            "the detail of the mesh is lost: its coordinates, up to {far} from zero, are numbers of single precision, \
             which lie {step} apart there, and its median edge is {} long; write double precision, or \
             subtract an origin before writing",
            *edge as f32
        )
    }
}

impl Coarse {
    /// Looks at some triangles of a mesh as its file has it.
    pub(super) fn of(mesh: &RawMesh) -> Option<Self> {
        let stride = mesh.triangles.len().div_ceil(SAMPLE).max(1);
        let corners = |triangle: &[u32; 3]| triangle.map(|index| mesh.positions[index as usize]);
        let sample: Vec<[DVec3; 3]> = mesh.triangles.iter().step_by(stride).map(corners).collect();
        let edges = || sample.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let lost = median(edges().map(|[a, b]| step(a).max(step(b)) / a.distance(b)))? * FINE > 1.0;
        if !lost || !are_rounded(sample.as_flattened()) {
            return None;
        }
        let far = sample.as_flattened().iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let edge = median(edges().map(|[a, b]| a.distance(b)))?;
        Some(Self { far, step: step(DVec3::splat(far)), edge })
    }
}

/// What single-precision numbers as great as the greatest coordinate are multiples of.
fn step(point: DVec3) -> f64 {
    let greatest = point.abs().max_element() as f32;
    f64::from(greatest.next_up()) - f64::from(greatest)
}

/// Whether all coordinates are numbers of single precision that were rounded to it.
fn are_rounded(points: &[DVec3]) -> bool {
    let is_single = |p: &DVec3| p.as_vec3().as_dvec3() == *p;
    let is_odd = |p: &&DVec3| (p.abs().max_element() as f32).to_bits() & 1 == 1;
    points.iter().all(is_single)
        && points.iter().filter(is_odd).count() as f64 >= ROUNDED * points.len() as f64
}

/// The middle one; edges without length make no number of it.
fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.filter(|value| !value.is_nan()).collect();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wavy sheet of squares of this width.
    fn sheet(width: f64, origin: DVec3) -> RawMesh {
        let at = |i: u32, j: u32| {
            let [x, y] = [i, j].map(|k| f64::from(k) * width);
            DVec3::new(
                x + 0.3 * width * libm::sin(7.0 * y),
                y + 0.3 * width * libm::cos(3.0 * x),
                0.2 * width * libm::cos(5.0 * x),
            ) + origin
        };
        let cells = || (0..30).flat_map(|i| (0..30).map(move |j| (i, j)));
        RawMesh {
            positions: (0..31).flat_map(|i| (0..31).map(move |j| at(i, j))).collect(),
            triangles: cells().map(|(i, j)| [31 * i + j, 31 * i + 31 + j, 31 * i + 32 + j]).collect(),
            ..RawMesh::default()
        }
    }

    fn single(mut mesh: RawMesh) -> RawMesh {
        mesh.positions.iter_mut().for_each(|p| *p = p.as_vec3().as_dvec3());
        mesh
    }

    #[test]
    fn far_from_zero_single_precision_is_told() {
        let survey = DVec3::new(500_001.0, 9_999_999.0, 30.0);
        let told = Coarse::of(&single(sheet(2.0, survey))).unwrap();
        assert!(told.step == 1.0 && (told.far - 1e7).abs() < 100.0, "{told:?}");
        assert!((1.0..4.0).contains(&told.edge), "{told:?}");
        for part in ["single precision", "1 apart", "double precision", "subtract an origin"] {
            assert!(told.to_string().contains(part), "{told}");
        }
        // All of the mesh in one point, and most of it.
        assert!(Coarse::of(&single(sheet(1e-4, survey))).is_some());
        assert!(Coarse::of(&single(sheet(0.2, survey))).is_some());
        // 2^23 / 100 = 83,886 edges from zero.
        assert!(Coarse::of(&single(sheet(0.1, DVec3::X * 20_000.0))).is_some());
    }

    #[test]
    fn nothing_is_told_of_ordinary_meshes() {
        for width in [1e-6, 0.01, 2.0, 1e5] {
            assert_eq!(Coarse::of(&single(sheet(width, DVec3::ZERO))), None);
            assert_eq!(Coarse::of(&single(sheet(width, DVec3::splat(1e4 * width)))), None);
            assert_eq!(Coarse::of(&sheet(width, DVec3::splat(1e7))), None, "double precision");
        }
        assert_eq!(Coarse::of(&RawMesh::default()), None);
        let whole = |mut mesh: RawMesh| {
            mesh.positions.iter_mut().for_each(|p| *p = (*p * 4.0).round());
            mesh
        };
        assert_eq!(Coarse::of(&whole(sheet(1.0, DVec3::X * 1e6))), None, "whole numbers, as they were meant");
    }
}

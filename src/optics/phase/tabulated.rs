//! Values at given angles, as a measurement or a Lorenz-Mie computation leaves them.
//!
//! Linear in the cosine between the angles, constant beyond the first and the last; normalised on reading, so that any
//! unit will do. Samples follow the values exactly. Forward and backward peaks of any height keep their digits when
//! the angles resolve them: the nodes are kept as 1 - cos, or beyond 90 degrees as 1 + cos, down to 2^-40 (1e-6 rad).

use std::sync::Arc;

use super::Lobe;
use super::angle_table::{AngleTable, Node};
use super::deflection::Deflection;

/// A tabulated phase function.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated {
    table: Arc<AngleTable>,
}

impl Tabulated {
    /// Values that are not negative at strictly rising angles in radians, from 0 to pi; `None` when they are not, when
    /// all values are zero, or when there are not as many of them as of angles.
    pub fn new(angles: &[f64], values: &[f64]) -> Option<Self> {
        let in_range = angles.iter().all(|a| (0.0..=std::f64::consts::PI).contains(a));
        let rising = angles.windows(2).all(|w| w[0] < w[1]);
        let valid = values.iter().all(|v| *v >= 0.0 && v.is_finite());
        if angles.is_empty() || angles.len() != values.len() || !(in_range && rising && valid) {
            return None;
        }
        let points = || angles.iter().copied().zip(values.iter().copied());
        let ahead = points().map(|(angle, value)| (one_minus_cos(angle), value));
        let back = points().rev().map(|(angle, value)| (one_minus_cos(std::f64::consts::PI - angle), value));
        let table = AngleTable::new([hemisphere(ahead), hemisphere(back)])?;
        Some(Self { table: Arc::new(table) })
    }

    /// As [`AngleTable::nodes`].
    pub(super) fn nodes(&self) -> [(&[f32], &[f32]); 2] {
        self.table.nodes()
    }
}

impl Lobe for Tabulated {
    fn value(&self, deflection: Deflection) -> f32 {
        self.table.pdf_w(deflection)
    }

    fn sample(&self, u: f32) -> Deflection {
        self.table.sample(u)
    }

    fn mean_cosine(&self) -> f32 {
        self.table.mean_cosine()
    }
}

fn one_minus_cos(angle: f64) -> f64 {
    let sine = libm::sin(0.5 * angle);
    2.0 * sine * sine
}

/// The nodes up to 90 degrees from one pole, of points (1 -+ cos, value) that rise from it to the other.
fn hemisphere(points: impl Iterator<Item = (f64, f64)>) -> Vec<Node> {
    let mut nodes: Vec<Node> = Vec::new();
    let mut last: Option<(f64, f64)> = None;
    for (t, value) in points {
        if nodes.is_empty() && t > 0.0 {
            nodes.push(Node { t: 0.0, density: value });
        }
        if t >= 1.0 {
            let density = last.map_or(value, |(s, from)| from + (value - from) * (1.0 - s) / (t - s));
            push(&mut nodes, Node { t: 1.0, density });
            return nodes;
        }
        push(&mut nodes, Node { t: t as f32, density: value });
        last = Some((t, value));
    }
    let density = last.map_or(0.0, |(_, value)| value);
    push(&mut nodes, Node { t: 1.0, density });
    nodes
}

/// Adds a node unless it coincides with the one before it in single precision.
fn push(nodes: &mut Vec<Node>, node: Node) {
    if nodes.last().is_none_or(|before| before.t < node.t) {
        nodes.push(node);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn nodes_have_their_values_and_the_space_between_is_linear_in_the_cosine() {
        let angles: Vec<f64> = [0.0, 30.0, 80.0, 130.0, 180.0].map(f64::to_radians).to_vec();
        let phase = Tabulated::new(&angles, &[8.0, 2.0, 1.0, 0.5, 3.0]).unwrap();
        let scale = phase.value(Deflection::FORWARD) / 8.0;
        let at = |cos: f64| phase.value(Deflection::from_one_minus_cos((1.0 - cos) as f32)) / scale;
        for (angle, value) in angles.iter().zip([8.0, 2.0, 1.0, 0.5, 3.0]) {
            assert!((at(angle.cos()) - value).abs() < 1e-5, "{angle}");
        }
        let (a, b) = (angles[2].cos(), angles[3].cos());
        for s in [0.1, 0.3, 0.5, 0.9] {
            let expected = 1.0 - 0.5 * s;
            assert!((f64::from(at(a + (b - a) * s)) - expected).abs() < 1e-5, "{s}");
        }
    }

    #[test]
    fn one_value_is_isotropic_and_nonsense_is_refused() {
        let even = Tabulated::new(&[0.7], &[3.0]).unwrap();
        for d in [Deflection::FORWARD, Deflection::BACKWARD, Deflection::from_one_minus_cos(0.9)] {
            assert!((f64::from(even.value(d)) * 4.0 * PI - 1.0).abs() < 1e-6);
        }
        let refused: [(&[f64], &[f64]); 7] = [
            (&[], &[]),
            (&[0.0, 1.0], &[1.0]),
            (&[1.0, 0.5], &[1.0, 1.0]),
            (&[0.0, 4.0], &[1.0, 1.0]),
            (&[0.0, 1.0], &[0.0, 0.0]),
            (&[0.0, 1.0], &[1.0, -1.0]),
            (&[0.0, 1.0], &[f64::NAN, 1.0]),
        ];
        for (angles, values) in refused {
            assert_eq!(Tabulated::new(angles, values), None, "{angles:?} {values:?}");
        }
    }
}

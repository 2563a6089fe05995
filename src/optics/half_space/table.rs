//! The H-function ([`super::h_function`]) as light transport looks it up.
//!
//! A table over s = sqrt(1 - albedo) and t = mu^(1/4), in which H is smooth: it goes like 1 - k mu with k like sqrt(3) s
//! where little is absorbed, and like 1 - (albedo / 2) mu ln(mu) at the horizon. Cubic through the four nearest nodes in
//! either variable. It is right to 2e-6 (measured, see the test) and made when it is first asked for, in some 20 ms.

use std::sync::OnceLock;

use glam::Vec4;

use super::h_function::HFunction;
use crate::spectrum::Lanes;

/// Cells in either variable.
const CELLS: usize = 64;
/// Nodes of a row.
const NODES: usize = CELLS + 1;

static TABLE: OnceLock<HTable> = OnceLock::new();

/// H over s, in rows over t.
#[derive(Debug)]
pub struct HTable {
    values: Vec<f32>,
}

impl HTable {
    /// The one table that there is.
    pub fn get() -> &'static Self {
        TABLE.get_or_init(Self::new)
    }

    fn new() -> Self {
        let h = HFunction::default();
        let even = |i: usize| i as f64 / CELLS as f64;
        let row = |i: usize| (0..NODES).map(move |j| (even(i), even(j)));
        let values = (0..NODES).flat_map(row).map(|(s, t)| h.at(s, t * t * t * t) as f32).collect();
        Self { values }
    }

    /// H at a cosine, in lanes of these sqrt(1 - albedo).
    pub fn at(&self, s: Lanes, mu: f32) -> Lanes {
        let column = column_of(mu);
        Lanes::from_array(s.to_array().map(|s| self.in_column(s, column)))
    }

    /// The same in one lane.
    pub fn in_lane(&self, s: f32, mu: f32) -> f32 {
        self.in_column(s, column_of(mu))
    }

    fn in_column(&self, s: f32, (column, across): (usize, Vec4)) -> f32 {
        let (row, down) = stencil(s.clamp(0.0, 1.0));
        let along = |i: usize| {
            let start = (row + i) * NODES + column;
            Vec4::from_slice(&self.values[start..start + 4]).dot(across)
        };
        Vec4::from_array([0, 1, 2, 3].map(along)).dot(down)
    }
}

fn column_of(mu: f32) -> (usize, Vec4) {
    stencil(mu.clamp(0.0, 1.0).sqrt().sqrt())
}

/// The first of the four nodes around a place in [0, 1], and the weights of Lagrange's cubic through them.
fn stencil(place: f32) -> (usize, Vec4) {
    let cells = place * CELLS as f32;
    let first = (cells as usize).saturating_sub(1).min(CELLS - 3);
    let x = cells - first as f32;
    let [a, b, c] = [x - 1.0, x - 2.0, x - 3.0];
    (first, Vec4::new(-a * b * c / 6.0, x * b * c * 0.5, -x * a * c * 0.5, x * a * b / 6.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Between all nodes in both variables, at the ends, and where nearly nothing is absorbed.
    #[test]
    fn the_table_is_right_to_two_millionths() {
        let (h, table) = (HFunction::default(), HTable::get());
        let places: Vec<f32> = (0..=2 * CELLS).map(|i| i as f32 / (2 * CELLS) as f32).collect();
        let mut worst = 0.0_f64;
        for s in [1e-5, 3.2e-4, 5e-3].into_iter().chain(places.iter().copied()) {
            for mu in [1e-8, 1e-6].into_iter().chain(places.iter().map(|t| t.powi(4))) {
                let off = f64::from(table.at(Lanes::splat(s), mu).x) - h.at(s.into(), mu.into());
                worst = worst.max(off.abs());
            }
        }
        println!("H is off by {worst:.1e} at most");
        assert!(worst < 2e-6, "{worst}");
    }
}

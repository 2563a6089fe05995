//! Draine's family between Henyey and Greenstein's lobe and Rayleigh's `[DRAINE03]`.
//!
//! ```text
//! p = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^(3/2)) (1 + alpha cos^2) / (1 + alpha (1 + 2 g^2) / 3)
//! mean cosine g (1 + alpha (3 + 2 g^2) / 5) / (1 + alpha (1 + 2 g^2) / 3)
//! ```
//! alpha = 0 is Henyey and Greenstein's, alpha = 1 and g = 0 Rayleigh's, alpha = 1 Cornette and Shanks'. Samples come
//! from a table through the values, 16 nodes an octave of 1 - cos; their weights are within 0.5 % of 1.

use std::sync::Arc;

use super::Lobe;
use super::angle_table::AngleTable;
use super::deflection::Deflection;
use super::henyey_greenstein::HenyeyGreenstein;

/// Draine's phase function.
#[derive(Clone, Debug, PartialEq)]
pub struct Draine {
    lobe: HenyeyGreenstein,
    alpha: f32,
    table: Arc<AngleTable>,
}

impl Draine {
    /// Greatest |g|: narrower peaks are not resolved by the table.
    pub const GREATEST_G: f32 = 0.99999;

    /// With |g| up to [`Draine::GREATEST_G`] and alpha not negative; `None` outside.
    pub fn new(g: f32, alpha: f32) -> Option<Self> {
        if !(g.abs() <= Self::GREATEST_G && alpha >= 0.0 && alpha.is_finite()) {
            return None;
        }
        let lobe = HenyeyGreenstein { g };
        let table = AngleTable::of(|d| f64::from(value(lobe, alpha, d)))?;
        Some(Self { lobe, alpha, table: Arc::new(table) })
    }
}

impl Lobe for Draine {
    fn value(&self, deflection: Deflection) -> f32 {
        value(self.lobe, self.alpha, deflection)
    }

    fn table(&self) -> Option<&AngleTable> {
        Some(&self.table)
    }

    fn sample(&self, u: f32) -> Deflection {
        self.table.sample(u)
    }

    fn mean_cosine(&self) -> f32 {
        let (g, alpha) = (self.lobe.g, self.alpha);
        g * (1.0 + alpha * (3.0 + 2.0 * g * g) / 5.0) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0)
    }
}

fn value(lobe: HenyeyGreenstein, alpha: f32, deflection: Deflection) -> f32 {
    let (g, cos) = (lobe.g, deflection.cosine());
    lobe.value(deflection) * (1.0 + alpha * cos * cos) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0)
}

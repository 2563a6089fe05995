//! Spheres much larger than the wavelength whose surface is diffuse `[BLINN82]`.
//!
//! ```text
//! p = 2 / (3 pi^2) (sin theta - theta cos theta),   mean cosine -4/9
//! ```
//! theta = 0 is straight on: a diffuse sphere lit from one side scatters mostly back. Valid for 2 pi r > 5 wavelengths.

use std::f32::consts::FRAC_1_PI;
use std::sync::Arc;

use super::Lobe;
use super::angle_table::AngleTable;
use super::deflection::Deflection;

/// The phase function of large diffuse spheres.
#[derive(Clone, Debug, PartialEq)]
pub struct DiffuseSpheres {
    table: Arc<AngleTable>,
}

/// Below this angle sin theta - theta cos theta is taken from its series.
const SMALL: f32 = 0.3;

impl DiffuseSpheres {
    /// The function has no parameters; `None` never.
    pub fn new() -> Option<Self> {
        AngleTable::of(|d| f64::from(value(d))).map(|table| Self { table: Arc::new(table) })
    }
}

impl Lobe for DiffuseSpheres {
    fn value(&self, deflection: Deflection) -> f32 {
        value(deflection)
    }

    fn table(&self) -> Option<&AngleTable> {
        Some(&self.table)
    }

    fn sample(&self, u: f32) -> Deflection {
        self.table.sample(u)
    }

    fn mean_cosine(&self) -> f32 {
        -4.0 / 9.0
    }
}

fn value(deflection: Deflection) -> f32 {
    let theta = deflection.angle();
    let lit = if theta < SMALL {
        let squared = theta * theta;
        theta * squared / 3.0 * (1.0 - squared * (0.1 - squared / 280.0))
    } else {
        deflection.sine() - theta * deflection.cosine()
    };
    2.0 / 3.0 * FRAC_1_PI * FRAC_1_PI * lit
}

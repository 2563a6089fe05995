//! Cornette and Shanks' lobe, which ends in Rayleigh's at g = 0 `[CORNETTE92]`.
//!
//! ```text
//! p = 3 (1 - g^2) / (8 pi (2 + g^2)) (1 + cos^2) / (1 + g^2 - 2 g cos)^(3/2)
//! mean cosine 3 g (4 + g^2) / (5 (2 + g^2))
//! ```
//! It is [`Draine`]'s function with alpha = 1.

use super::Lobe;
use super::angle_table::AngleTable;
use super::deflection::Deflection;
use super::draine::Draine;

/// Cornette and Shanks' phase function.
#[derive(Clone, Debug, PartialEq)]
pub struct CornetteShanks {
    g: f32,
    draine: Draine,
}

impl CornetteShanks {
    /// With |g| up to [`Draine::GREATEST_G`]; `None` outside. g is not the mean cosine.
    pub fn new(g: f32) -> Option<Self> {
        Draine::new(g, 1.0).map(|draine| Self { g, draine })
    }
}

impl Lobe for CornetteShanks {
    fn value(&self, deflection: Deflection) -> f32 {
        self.draine.value(deflection)
    }

    fn table(&self) -> Option<&AngleTable> {
        self.draine.table()
    }

    fn sample(&self, u: f32) -> Deflection {
        self.draine.sample(u)
    }

    fn mean_cosine(&self) -> f32 {
        let g = self.g;
        3.0 * g * (4.0 + g * g) / (5.0 * (2.0 + g * g))
    }
}

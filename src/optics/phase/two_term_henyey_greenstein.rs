//! A forward and a backward Henyey-Greenstein lobe.
//!
//! ```text
//! p = r HG(g1) + (1 - r) HG(g2),   mean cosine r g1 + (1 - r) g2
//! ```

use super::Lobe;
use super::deflection::Deflection;
use super::henyey_greenstein::HenyeyGreenstein;

/// Two Henyey-Greenstein lobes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoTermHenyeyGreenstein {
    /// Share of the first lobe, in [0, 1].
    pub share: f32,
    /// The first lobe.
    pub first: HenyeyGreenstein,
    /// The second lobe.
    pub second: HenyeyGreenstein,
}

impl Lobe for TwoTermHenyeyGreenstein {
    fn value(&self, deflection: Deflection) -> f32 {
        self.share * self.first.value(deflection) + (1.0 - self.share) * self.second.value(deflection)
    }

    fn sample(&self, u: f32) -> Deflection {
        if u < self.share {
            self.first.sample((u / self.share).min(1.0))
        } else {
            self.second.sample(((u - self.share) / (1.0 - self.share)).min(1.0))
        }
    }

    fn mean_cosine(&self) -> f32 {
        self.share * self.first.g + (1.0 - self.share) * self.second.g
    }
}

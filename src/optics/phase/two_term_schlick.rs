//! Two of Schlick's lobes, and the published fits of other phase functions by them `[BLASI93]`.
//!
//! ```text
//! p = r S(k1) + (1 - r) S(k2)
//!
//! fit          r     k1     k2     mean cosine
//! Rayleigh    .50   -.46    .46     0
//! hazy        .12   -.50    .70     .4205
//! murky       .19   -.65    .91     .5423
//! ```

use super::Lobe;
use super::deflection::Deflection;
use super::schlick::Schlick;

/// Two Schlick lobes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoTermSchlick {
    /// Share of the first lobe, in [0, 1].
    pub share: f32,
    /// The first lobe.
    pub first: Schlick,
    /// The second lobe.
    pub second: Schlick,
}

impl TwoTermSchlick {
    /// Fit of [`super::Rayleigh`].
    pub const RAYLEIGH: Self = Self::fit(0.5, -0.46, 0.46);
    /// Fit of [`super::Atmosphere::HAZY`].
    pub const HAZY: Self = Self::fit(0.12, -0.5, 0.7);
    /// Fit of [`super::Atmosphere::MURKY`].
    pub const MURKY: Self = Self::fit(0.19, -0.65, 0.91);

    const fn fit(share: f32, k1: f32, k2: f32) -> Self {
        Self { share, first: Schlick { k: k1 }, second: Schlick { k: k2 } }
    }
}

impl Lobe for TwoTermSchlick {
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
        self.share * self.first.mean_cosine() + (1.0 - self.share) * self.second.mean_cosine()
    }
}

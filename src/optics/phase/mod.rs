//! Phase functions: where scattered light goes.
//!
//! Each is normalised over the sphere and depends on the [`Deflection`] alone, the angle between the directions of
//! *travel* before and after. One file a function; [`EXAMPLES`] is the list that tests walk. Most are sampled exactly
//! by their inverted cumulative distribution. Those that have none in closed form are sampled through a table of their
//! values, and the samples' weight, value over density, makes good what is lost between its nodes.
//!
//! A medium has one of them, or one over wavelength ([`MediumPhase`]).

mod angle_table;
mod atmosphere;
mod cornette_shanks;
mod deflection;
mod diffuse_spheres;
mod draine;
mod examples;
mod fournier_forand;
mod gaussian;
mod henyey_greenstein;
mod isotropic;
mod legendre;
mod linear_anisotropic;
mod medium_phase;
mod rayleigh;
mod sakas;
mod schlick;
mod spectral;
mod specular_spheres;
mod tabulated;
mod two_term_henyey_greenstein;
mod two_term_schlick;

use angle_table::AngleTable;
use glam::Vec3;

pub use atmosphere::Atmosphere;
pub use cornette_shanks::CornetteShanks;
pub use deflection::Deflection;
pub use diffuse_spheres::DiffuseSpheres;
pub use draine::Draine;
pub use examples::{EXAMPLES, Examples, SPECTRAL_EXAMPLES};
pub use fournier_forand::FournierForand;
pub use gaussian::Gaussian;
pub use henyey_greenstein::HenyeyGreenstein;
pub use isotropic::Isotropic;
pub use legendre::legendre;
pub use linear_anisotropic::LinearAnisotropic;
pub use medium_phase::{LanesSample, MediumPhase, PhaseLanes};
pub use rayleigh::Rayleigh;
pub use sakas::Sakas;
pub use schlick::Schlick;
pub use spectral::{SpectralLanes, SpectralPhase};
pub use specular_spheres::SpecularSpheres;
pub use tabulated::Tabulated;
pub use two_term_henyey_greenstein::TwoTermHenyeyGreenstein;
pub use two_term_schlick::TwoTermSchlick;

use crate::geometry::Frame;
use crate::geometry::machine::{Eight, Lanes};

/// Any phase function. Copies share their tables.
#[derive(Clone, Debug, PartialEq)]
pub enum PhaseFunction {
    /// The same in every direction.
    Isotropic(Isotropic),
    /// One plus a multiple of the cosine.
    LinearAnisotropic(LinearAnisotropic),
    /// Particles much smaller than the wavelength.
    Rayleigh(Rayleigh),
    /// Hazy and murky air.
    Atmosphere(Atmosphere),
    /// One lobe of given mean cosine.
    HenyeyGreenstein(HenyeyGreenstein),
    /// Two such lobes.
    TwoTermHenyeyGreenstein(TwoTermHenyeyGreenstein),
    /// Henyey and Greenstein's lobe with Rayleigh's limit.
    CornetteShanks(CornetteShanks),
    /// A rational lobe.
    Schlick(Schlick),
    /// Two such lobes.
    TwoTermSchlick(TwoTermSchlick),
    /// Large spheres with a diffuse surface.
    DiffuseSpheres(DiffuseSpheres),
    /// Large spheres with a mirroring surface.
    SpecularSpheres(SpecularSpheres),
    /// One plus a power of the cosine.
    Sakas(Sakas),
    /// A Gaussian of the angle.
    Gaussian(Gaussian),
    /// Particles of ocean water.
    FournierForand(FournierForand),
    /// Between Henyey and Greenstein's and Rayleigh's.
    Draine(Draine),
    /// Given values.
    Tabulated(Tabulated),
}

/// A sampled direction; `weight` is value / pdf.
#[derive(Clone, Copy, Debug)]
pub struct PhaseSample {
    /// New direction of travel.
    pub wi: Vec3,
    /// Value over density.
    pub weight: f32,
    /// Density per solid angle.
    pub pdf_w: f32,
}

/// What each phase function says of itself.
trait Lobe {
    /// Density of scattered light per solid angle.
    fn value(&self, deflection: Deflection) -> f32;

    /// The angle that belongs to a random number in [0, 1).
    fn sample(&self, u: f32) -> Deflection;

    /// Mean cosine of the angle; positive is forward.
    fn mean_cosine(&self) -> f32;

    /// The table that samples come from, where they do not follow the value itself.
    #[inline]
    fn table(&self) -> Option<&AngleTable> {
        None
    }

    /// Density of [`Lobe::sample`].
    #[inline]
    fn pdf_w(&self, deflection: Deflection) -> f32 {
        self.table().map_or_else(|| self.value(deflection), |table| table.pdf_w(deflection))
    }

    /// Value over the density `pdf_w`; where both are 0, as straight on from some spheres, what it goes to.
    #[inline]
    fn weight(&self, deflection: Deflection, pdf_w: f32) -> f32 {
        if self.table().is_some() && pdf_w > 0.0 { self.value(deflection) / pdf_w } else { 1.0 }
    }

    /// An angle with its weight.
    #[inline]
    fn weighted(&self, u: f32) -> (Deflection, f32) {
        let deflection = self.sample(u);
        let weight = self.table().map_or(1.0, |_| self.weight(deflection, self.pdf_w(deflection)));
        (deflection, weight)
    }

    /// An angle with its density and its weight.
    #[inline]
    fn sampled(&self, u: f32) -> (Deflection, f32, f32) {
        let deflection = self.sample(u);
        let pdf_w = self.pdf_w(deflection);
        (deflection, pdf_w, self.weight(deflection, pdf_w))
    }
}

/// The same expression for every kind.
macro_rules! each {
    ($phase:expr, $lobe:ident => $value:expr) => {
        match $phase {
            PhaseFunction::Isotropic($lobe) => $value,
            PhaseFunction::LinearAnisotropic($lobe) => $value,
            PhaseFunction::Rayleigh($lobe) => $value,
            PhaseFunction::Atmosphere($lobe) => $value,
            PhaseFunction::HenyeyGreenstein($lobe) => $value,
            PhaseFunction::TwoTermHenyeyGreenstein($lobe) => $value,
            PhaseFunction::CornetteShanks($lobe) => $value,
            PhaseFunction::Schlick($lobe) => $value,
            PhaseFunction::TwoTermSchlick($lobe) => $value,
            PhaseFunction::DiffuseSpheres($lobe) => $value,
            PhaseFunction::SpecularSpheres($lobe) => $value,
            PhaseFunction::Sakas($lobe) => $value,
            PhaseFunction::Gaussian($lobe) => $value,
            PhaseFunction::FournierForand($lobe) => $value,
            PhaseFunction::Draine($lobe) => $value,
            PhaseFunction::Tabulated($lobe) => $value,
        }
    };
}

impl PhaseFunction {
    /// Density of scattered light per solid angle, in 1/sr.
    #[inline]
    pub fn value(&self, deflection: Deflection) -> f32 {
        match self {
            Self::Isotropic(lobe) => lobe.value(deflection),
            Self::HenyeyGreenstein(lobe) => lobe.value(deflection),
            _ => self.any_value(deflection),
        }
    }

    /// Density with which [`PhaseFunction::sample`] takes that angle, per solid angle.
    #[inline]
    pub fn pdf_w(&self, deflection: Deflection) -> f32 {
        match self {
            Self::Isotropic(lobe) => lobe.pdf_w(deflection),
            Self::HenyeyGreenstein(lobe) => lobe.pdf_w(deflection),
            _ => self.any_pdf_w(deflection),
        }
    }

    /// A new direction for light (or an eye path) that travelled along `forward`.
    #[inline]
    pub fn sample(&self, forward: Vec3, u: [f32; 2]) -> PhaseSample {
        let (deflection, pdf_w, weight) = match self {
            Self::Isotropic(lobe) => lobe.sampled(u[0]),
            Self::HenyeyGreenstein(lobe) => lobe.sampled(u[0]),
            _ => self.any_sampled(u[0]),
        };
        let wi = Frame::around(forward).to_world(deflection.around_z(u[1])).normalize();
        PhaseSample { wi, weight, pdf_w }
    }

    /// Direction and weight as of [`PhaseFunction::sample`], whose density is not asked for, but for the rounding of
    /// the direction's length.
    #[inline]
    pub fn turn(&self, forward: Vec3, u: [f32; 2]) -> (Vec3, f32) {
        let (deflection, weight) = match self {
            // Any axis will do.
            Self::Isotropic(lobe) => return (lobe.sample(u[0]).around_z(u[1]), 1.0),
            Self::HenyeyGreenstein(lobe) => lobe.weighted(u[0]),
            _ => self.any_weighted(u[0]),
        };
        (Frame::around(forward).to_world(deflection.around_z(u[1])), weight)
    }

    /// Cosines and sines of the angles of deflection that [`PhaseFunction::turn`] draws with eight numbers, and their
    /// weights.
    #[inline(always)]
    pub(crate) fn eight<L: Lanes>(&self, u: L) -> (L, L, L) {
        if let Self::HenyeyGreenstein(lobe) = self {
            let (cos, sin) = lobe.sample_eight(u);
            return (cos, sin, L::splat(1.0));
        }
        let mut all = Eight([0.0; 8]);
        u.store(&mut all);
        let [cos, sin, weights] = &self.any_eight(&all);
        (L::load(cos), L::load(sin), L::load(weights))
    }

    /// Mean cosine of the angle of deflection; positive is forward.
    pub fn mean_cosine(&self) -> f32 {
        each!(self, lobe => lobe.mean_cosine())
    }

    /// True where directions are drawn from the value itself, so that [`PhaseFunction::mean_cosine`] is theirs too.
    pub fn is_sampled_exactly(&self) -> bool {
        each!(self, lobe => lobe.table().is_none())
    }

    // Kept out of the callers' loops, where the two commonest kinds are.
    #[inline(never)]
    fn any_value(&self, deflection: Deflection) -> f32 {
        each!(self, lobe => lobe.value(deflection))
    }

    #[inline(never)]
    fn any_pdf_w(&self, deflection: Deflection) -> f32 {
        each!(self, lobe => lobe.pdf_w(deflection))
    }

    #[inline(never)]
    fn any_weighted(&self, u: f32) -> (Deflection, f32) {
        each!(self, lobe => lobe.weighted(u))
    }

    #[inline(never)]
    fn any_eight(&self, u: &Eight) -> [Eight; 3] {
        let drawn = each!(self, lobe => u.0.map(|u| lobe.weighted(u)));
        let (cos, sin) = (drawn.map(|(turned, _)| turned.cosine()), drawn.map(|(turned, _)| turned.sine()));
        [cos, sin, drawn.map(|(_, weight)| weight)].map(Eight)
    }

    #[inline(never)]
    fn any_sampled(&self, u: f32) -> (Deflection, f32, f32) {
        each!(self, lobe => lobe.sampled(u))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::machine::{WithLanes, with_best};
    use crate::geometry::portable::Portable;

    struct Angles<'a>(&'a PhaseFunction, [f32; 8]);

    impl WithLanes for Angles<'_> {
        type Output = [[f32; 8]; 3];

        #[inline(always)]
        fn run<L: Lanes>(self) -> Self::Output {
            let (cos, sin, weights) = self.0.eight(L::load(&Eight(self.1)));
            [cos, sin, weights].map(|lanes| {
                let mut all = Eight([0.0; 8]);
                lanes.store(&mut all);
                all.0
            })
        }
    }

    #[test]
    fn eight_angles_and_weights_are_those_of_each_number() {
        let mut weighted = 0;
        for (name, phase) in EXAMPLES.iter() {
            for i in (0..1 << 24).step_by(8 * 9973).chain([(1 << 24) - 8]) {
                let u: [f32; 8] = std::array::from_fn(|k| (i + k) as f32 / 16_777_216.0);
                let one = u.map(|u| phase.any_weighted(u));
                let alone = [one.map(|(d, _)| d.cosine()), one.map(|(d, _)| d.sine()), one.map(|(_, w)| w)];
                assert_eq!(with_best(Angles(phase, u)), alone, "{name} {u:?}");
                assert_eq!(Angles(phase, u).run::<Portable>(), alone, "{name} {u:?}");
                let sampled = u.map(|u| phase.sample(Vec3::Z, [u, 0.0]).weight);
                assert_eq!(sampled, alone[2], "{name} {u:?}");
                weighted += alone[2].iter().filter(|&&weight| weight != 1.0).count();
            }
        }
        assert!(weighted > 0);
    }
}

//! What the scattering of a mixture follows from, as one number.

use sha2::{Digest, Sha256};

use super::cache::Key;
use super::quadrature::Quadrature;
use super::{Mixture, Species};

/// Another one whenever the same mixture leads to other numbers, or entries are written otherwise.
const VERSION: &str = concat!("floe particles 2 ", env!("CARGO_PKG_VERSION"));

impl Mixture {
    /// The SHA-256 of all that coefficients and phase functions at these wavelengths follow from.
    pub(super) fn key(&self, coefficients: &[f64], phases: &[f64]) -> Key {
        let mut hasher = Hasher { digest: Sha256::new() };
        hasher.text(VERSION);
        hasher.numbers(coefficients);
        hasher.numbers(phases);
        let wavelengths = || coefficients.iter().chain(phases);
        for &lambda in wavelengths() {
            let index = &self.host.index;
            let [absorption, molecular] = self.host.coefficients_at(lambda);
            hasher.numbers(&[index.n(lambda), index.k(lambda), absorption, molecular]);
        }
        for Species { name, index, sizes, volume_fraction } in &self.species {
            hasher.text(name);
            let Quadrature { radii, numbers } = Quadrature::new(sizes);
            hasher.numbers(&[*volume_fraction]);
            hasher.numbers(&sizes.range());
            hasher.numbers(&radii);
            hasher.numbers(numbers.as_flattened());
            wavelengths().for_each(|&lambda| hasher.numbers(&[index.n(lambda), index.k(lambda)]));
        }
        hasher.digest.finalize().into()
    }
}

struct Hasher {
    digest: Sha256,
}

impl Hasher {
    fn text(&mut self, text: &str) {
        self.digest.update((text.len() as u64).to_le_bytes());
        self.digest.update(text);
    }

    fn numbers(&mut self, numbers: &[f64]) {
        self.digest.update((numbers.len() as u64).to_le_bytes());
        numbers.iter().for_each(|number| self.digest.update(number.to_le_bytes()));
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Host, SizeDistribution};
    use super::*;
    use crate::optics::RefractiveIndex;
    use crate::spectrum::Spectrum;

    #[test]
    fn whatever_is_changed_changes_the_key() {
        let sizes = SizeDistribution::PowerLaw { exponent: 3.4, least: 1e-8, greatest: 1e-4 };
        let index = RefractiveIndex::Constant(1.5);
        let species = Species { name: "silt".into(), index, sizes, volume_fraction: 1e-6 };
        let host = Host {
            index: RefractiveIndex::Constant(1.33),
            absorption: Spectrum::Constant(0.1),
            molecular: None,
        };
        let mixture = Mixture { host, species: vec![species] };
        let mut others = vec![mixture.clone(); 9];
        others[0].species[0].name = "clay".into();
        others[1].species[0].index = RefractiveIndex::Constant(1.51);
        others[2].species[0].volume_fraction = 2e-6;
        others[3].species[0].sizes =
            SizeDistribution::PowerLaw { exponent: 3.5, least: 1e-8, greatest: 1e-4 };
        others[4].species.clear();
        others[5].host.index = RefractiveIndex::Constant(1.34);
        others[6].host.absorption = Spectrum::Constant(0.2);
        others[7].host.molecular = Some(Spectrum::Constant(0.01));
        others[8].species.push(mixture.species[0].clone());
        let key = |mixture: &Mixture| mixture.key(&[400.0, 500.0], &[450.0]);
        let mut keys: Vec<Key> = others.iter().map(key).collect();
        keys.push(mixture.key(&[400.0], &[500.0, 450.0]));
        assert_eq!(key(&mixture), key(&mixture.clone()));
        keys.push(key(&mixture));
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), 11);
    }
}

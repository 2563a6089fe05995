//! How fast particles are computed: `cargo bench --bench spheres`.
//!
//! First the scattering of turbid sea water (minerals and algae) and of sea ice (bubbles and brine) on all threads, in
//! milliseconds of the clock and of the processor: computed, and read from a cache.
//!
//! Then 1000 radii, even in their logarithm from 0.01 to 100 um, of minerals in water at 40 wavelengths, on one thread. What is
//! printed are user CPU seconds, the least of some passes, and sums by which `tests/bench/peers/miepython_spheres.py`
//! sees that both computed the same.

// What it is for.
#![allow(clippy::print_stdout)]

use std::f64::consts::PI;
use std::time::Instant;

use floe::optics::RefractiveIndex;
use floe::optics::lorenz_mie::{Complex64, Sphere, SphereError, efficiencies};
use floe::optics::particles::{Cache, Host, Mixture, SizeDistribution, Species};
use floe::spectrum::Spectrum;

const RADII: u32 = 1000;
const WAVELENGTHS: u32 = 40;
const PASSES: u32 = 5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (name, mixture) in mixtures() {
        cold_and_cached(name, &mixture)?;
    }
    many_spheres()
}

/// The least of some passes.
fn cold_and_cached(name: &str, mixture: &Mixture) -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let cache = Cache::in_folder(folder.path());
    let kept = mixture.scattering(&cache)?;
    let [mut clock, mut processor, mut cached] = [f64::INFINITY; 3];
    for _ in 0..PASSES {
        let (start, used) = (Instant::now(), cpu_time::ProcessTime::try_now()?);
        let found = mixture.scattering(&Cache::off())?;
        clock = clock.min(start.elapsed().as_secs_f64() * 1e3);
        processor = processor.min(used.try_elapsed()?.as_secs_f64() * 1e3);
        let start = Instant::now();
        let remembered = mixture.scattering(&cache)?;
        cached = cached.min(start.elapsed().as_secs_f64() * 1e3);
        assert!(found == kept && remembered == kept, "{name}");
    }
    println!("{name}: {clock:.0} ms, of the processor {processor:.0} ms; cached {cached:.2} ms");
    Ok(())
}

fn mixtures() -> [(&'static str, Mixture); 2] {
    let index = |n, k| RefractiveIndex::Table { wavelengths: vec![550.0], n: vec![n], k: vec![k] };
    let species = |name: &str, index, exponent, least, greatest, volume_fraction| Species {
        name: name.to_owned(),
        index,
        sizes: SizeDistribution::PowerLaw { exponent, least, greatest },
        volume_fraction,
    };
    let host = |n| Host { index: index(n, 2e-9), absorption: Spectrum::Constant(0.05), molecular: None };
    let minerals = species("minerals", index(1.58, 1e-3), 3.4, 1e-8, 1e-4, 5.4e-7);
    let algae = species("algae", index(1.41, 1e-4), 3.6, 2.25e-7, 1e-4, 1.9e-6);
    let air = species("air", index(1.0, 0.0), 1.24, 4e-6, 7e-5, 0.01);
    let brine = species("brine", index(1.353, 2e-9), 2.5, 7.5e-6, 1.5e-4, 0.02);
    [
        ("turbid sea", Mixture { host: host(1.34), species: vec![minerals, algae] }),
        ("sea ice", Mixture { host: host(1.311), species: vec![air, brine] }),
    ]
}

fn many_spheres() -> Result<(), Box<dyn std::error::Error>> {
    let spheres = (0..WAVELENGTHS).flat_map(|i| (0..RADII).map(move |j| sphere(i, j)));
    let spheres: Vec<Sphere> = spheres.collect::<Result<_, _>>()?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let mut least = f64::INFINITY;
    let mut sums = [0.0; 3];
    for _ in 0..PASSES {
        let start = cpu_time::ProcessTime::try_now()?;
        let found = pool.install(|| efficiencies(&spheres));
        least = least.min(start.try_elapsed()?.as_secs_f64());
        sums = [0.0; 3];
        for e in found {
            sums = [sums[0] + e.extinction, sums[1] + e.scattering, sums[2] + e.asymmetry];
        }
    }
    println!("floe {least:.6} {} {} {}", sums[0], sums[1], sums[2]);
    Ok(())
}

/// Index 1.58 + 0.001 i in water of 1.34, at one of the wavelengths from 380 nm in steps of 10.
fn sphere(wavelength: u32, radius: u32) -> Result<Sphere, SphereError> {
    let lambda = 0.38 + 0.01 * f64::from(wavelength);
    let t = (f64::from(radius) + 0.5) / f64::from(RADII);
    let r = 0.01 * 1e4_f64.powf(t);
    Sphere::new(Complex64::new(1.58, 0.001), Complex64::new(1.34, 0.0), 2.0 * PI * r / lambda)
}

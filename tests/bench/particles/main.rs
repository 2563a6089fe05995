//! How fast particles are computed: `cargo bench --bench particles`.
//!
//! 1000 radii, even in their logarithm from 0.01 to 100 um, of minerals in water at 40 wavelengths, on one thread. What is
//! printed are user CPU seconds, the least of some passes, and sums by which `tests/bench/peers/miepython_spheres.py`
//! sees that both computed the same.

// What it is for.
#![allow(clippy::print_stdout)]

use std::f64::consts::PI;

use floe::optics::lorenz_mie::{Complex64, Sphere, SphereError, efficiencies};

const RADII: u32 = 1000;
const WAVELENGTHS: u32 = 40;
const PASSES: u32 = 5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
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

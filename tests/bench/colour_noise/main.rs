//! Noise of luminance and of colour on RGB lanes, on wavelengths, and with dispersion. `cargo bench --bench colour_noise`.
//!
//! A shipped scene is rendered as it is, with something given over wavelength, and with the indices of water and ice that
//! bend each wavelength its own way; in turns on one thread, with several seeds. Of each pixel the variance between seeds
//! is taken of luminance Y and of the colour differences of linear Rec. 709, relative to Y^2 + 0.02^2:
//!
//! ```text
//! Cb = (B - Y) / 1.8556,   Cr = (R - Y) / 1.5748                                             [BT709]
//! ```

#![allow(clippy::print_stdout)] // the table is what it is for
#![allow(clippy::unwrap_used)] // a bench that cannot open its scene has nothing to say

#[allow(dead_code)] // of the parts only the scenes are needed
#[path = "../forced/parts.rs"]
mod parts;

use cpu_time::ProcessTime;
use floe::driver::Job;
use floe::driver::tiles::{Sampling, render_pixels};
use floe::sampling::SampleSeed;
use floe::scene::frame::Frame;
use floe::spectrum::luminance::luminance_f64;
use glam::DVec3;
use parts::{SCENES, Scene};

const SEEDS: u64 = 6;
const SAMPLES: u32 = 32;

/// A way to give the scene.
struct Lanes {
    name: &'static str,
    /// Takes the place of lines that begin so, without what follows them.
    replaces: &'static [(&'static str, &'static str)],
    /// Is added below a table.
    adds: &'static [(&'static str, &'static str)],
}

const WATER: &str = "ior = { table = \"water\" }";
const UNUSED: (&str, &str) = ("[media.unused]", "absorption = { wavelength = [400, 700], value = [1, 1] }");

const LANES: [Lanes; 3] = [
    Lanes { name: "RGB", replaces: &[], adds: &[] },
    Lanes { name: "wavelengths", replaces: &[], adds: &[UNUSED] },
    Lanes {
        name: "wavelengths, dispersion",
        replaces: &[
            ("ior = 1.34", WATER),
            ("ior = 1.333", WATER),
            ("ior = 1.31", "ior = { table = \"ice\" }"),
        ],
        adds: &[UNUSED, ("[render]", "dispersion = true")],
    },
];

/// One scene on one kind of lanes: what its pixels have come to.
#[derive(Default)]
struct Tally {
    seconds: f64,
    /// By seed and pixel.
    pictures: Vec<Vec<DVec3>>,
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    println!("| scene | lanes | CPU | luminance | colour |");
    println!("|---|---|---|---|---|");
    for scene in SCENES.iter().filter(|scene| !scene.photons()) {
        let tallies = pool.install(|| in_turns(scene));
        let plain = (tallies[0].seconds, tallies[0].variances());
        for (lanes, tally) in LANES.iter().zip(&tallies) {
            let (cpu, variances) = (tally.seconds / plain.0, tally.variances());
            let [y, c] = [0, 1].map(|i| variances[i] / plain.1[i] * cpu);
            println!("| {} | {} | {cpu:.2} | {y:.2} | {c:.2} |", scene.name, lanes.name);
            let [y, c] = variances.map(f64::sqrt);
            println!("<!-- deviations at {SAMPLES} samples: luminance {y:.4}, colour {c:.4} -->");
        }
    }
}

fn in_turns(scene: &Scene) -> Vec<Tally> {
    let frames: Vec<(Frame, Sampling)> = LANES.iter().map(|lanes| frame_of(scene, lanes)).collect();
    let mut tallies: Vec<Tally> = LANES.iter().map(|_| Tally::default()).collect();
    for seed in 0..SEEDS {
        for ((frame, sampling), tally) in frames.iter().zip(&mut tallies) {
            let seed = SampleSeed { seed, ..sampling.seed };
            let sampling = Sampling { samples: SAMPLES, seed, ..sampling.clone() };
            let before = ProcessTime::now();
            let (image, _) = render_pixels(frame, &sampling, &|_, _| ());
            tally.seconds += before.elapsed().as_secs_f64();
            tally.pictures.push(image.pixels.iter().map(|p| p.rgb.as_dvec3()).collect());
        }
    }
    tallies
}

fn frame_of(scene: &Scene, lanes: &Lanes) -> (Frame, Sampling) {
    let folder = tempfile::tempdir().unwrap();
    let file = scene.write(folder.path(), None);
    let text = std::fs::read_to_string(&file).unwrap();
    let replaced = |line: &str| {
        let found =
            lanes.replaces.iter().find(|(old, _)| line.split_once(" #").map_or(line, |l| l.0).trim() == *old);
        found.map_or(line, |(_, new)| new).to_owned()
    };
    let mut lines: Vec<String> = text.lines().map(replaced).collect();
    for (table, line) in lanes.adds {
        match lines.iter().position(|l| l.starts_with(table)) {
            Some(at) => lines.insert(at + 1, (*line).to_owned()),
            None => lines.extend([(*table).to_owned(), (*line).to_owned()]),
        }
    }
    std::fs::write(&file, lines.join("\n")).unwrap();
    let job = Job::open(&file).unwrap_or_else(|e| panic!("{}, {}: {e}", scene.name, lanes.name));
    let task =
        job.tasks().into_iter().find(|task| scene.frame.is_none_or(|n| task.number == n.into())).unwrap();
    let meshes = task.read(&job.world).unwrap_or_else(|e| panic!("{e}")).meshes;
    let frame = job.world.assemble(task.number, meshes, None).unwrap_or_else(|e| panic!("{e}")).frame;
    (frame, Sampling::new(&job.world.description.render))
}

impl Tally {
    /// Mean relative variances of luminance and colour over the pixels.
    fn variances(&self) -> [f64; 2] {
        let n = self.pictures.len() as f64;
        let pixels = self.pictures[0].len();
        let mut sums = [0.0; 2];
        for pixel in 0..pixels {
            let seen: Vec<DVec3> = self.pictures.iter().map(|picture| colour(picture[pixel])).collect();
            let mean = seen.iter().sum::<DVec3>() / n;
            let squares = seen.iter().map(|c| (*c - mean) * (*c - mean)).sum::<DVec3>() / (n - 1.0);
            let of = mean.x * mean.x + 0.02 * 0.02;
            sums[0] += squares.x / of;
            sums[1] += (squares.y + squares.z) / of;
        }
        sums.map(|sum| sum / pixels as f64)
    }
}

/// Y, Cb and Cr.
fn colour(rgb: DVec3) -> DVec3 {
    let y = luminance_f64(rgb);
    DVec3::new(y, (rgb.z - y) / 1.8556, (rgb.x - y) / 1.5748)
}

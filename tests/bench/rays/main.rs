//! Rays a second, builds and refits of the hierarchy on one thread: `cargo bench --bench rays -- --help`.

#![allow(clippy::print_stdout, clippy::print_stderr)] // the table is what it is for

mod meshes;
mod options;
mod random;
mod rays;
mod timing;
mod tracing;

use std::process::ExitCode;

use floe::accel::Accel;

use meshes::Mesh;
use options::Options;
use timing::{in_turns, median, time};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), String> {
    let options = Options::read()?;
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().map_err(|e| e.to_string())?;
    println!("| mesh | row | Mray/s | ns/ray | hits |\n|---|---|---|---|---|");
    let mut builds = Vec::new();
    for mesh in options.meshes() {
        let (build, mut accel) = time(|| Accel::build(&mesh.positions, &mesh.triangles));
        print_rays(&options, &mesh, &accel);
        let moved = mesh.moved();
        let refit = time(|| accel.refit(&moved, &mesh.triangles)).0;
        let bytes = accel.bytes() as f64 / accel.len() as f64;
        builds.push(format!("| {} | {:.1} | {:.1} | {bytes:.0} |", mesh.name, 1e3 * build, 1e3 * refit));
    }
    if options.build {
        println!("\n| mesh | build, ms | refit, ms | bytes a triangle |\n|---|---|---|---|");
        println!("{}", builds.join("\n"));
    }
    Ok(())
}

fn print_rays(options: &Options, mesh: &Mesh, accel: &Accel) {
    let sets = rays::all(mesh, accel, options.side);
    for set in sets.iter().filter(|set| options.wants(set.name)) {
        let count = set.rays.len();
        let hits = tracing::trace(accel, set, 0..count);
        let seconds = in_turns(count, options.repeat, &mut [&mut |range| tracing::trace(accel, set, range)]);
        let each = median(&seconds[0]) / count as f64;
        let share = 100.0 * hits as f64 / count as f64;
        println!("| {} | {} | {:.2} | {:.0} | {share:.0} % |", mesh.name, set.name, 1e-6 / each, 1e9 * each);
    }
}

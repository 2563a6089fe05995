//! Times floe's ray tracing against Embree 4 on one thread; see README.md.

mod builds;
mod compare;
mod embree;

// What is traced is what the benchmark of floe alone traces.
#[path = "../../rays/meshes.rs"]
mod meshes;
#[path = "../../rays/options.rs"]
mod options;
#[path = "../../rays/random.rs"]
mod random;
#[path = "../../rays/rays.rs"]
mod rays;
#[path = "../../rays/timing.rs"]
mod timing;
#[path = "../../rays/tracing.rs"]
mod tracing;

use std::process::ExitCode;
use std::rc::Rc;

use floe::accel::Accel;

use compare::Scenes;
use embree::{Device, Kind, Scene, padded};
use meshes::Mesh;
use options::Options;

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
    let device = match std::env::var("EMBREE_LIBRARY") {
        Ok(path) => Some(Device::open(&path, &std::env::var("EMBREE_CONFIG").unwrap_or_default())?),
        Err(_) => {
            println!("EMBREE_LIBRARY is not set: floe alone.\n");
            None
        }
    };
    println!(
        "| mesh | rays | Embree robust | Embree | floe, Mray/s | floe / robust | hits | other hit | other t |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for mesh in options.meshes() {
        print_rays(&options, device.as_ref(), &mesh)?;
    }
    if options.build {
        println!("\n| mesh | tree | Embree robust, ms | floe, ms | floe / robust |\n|---|---|---|---|---|");
        for mesh in options.meshes() {
            print_builds(&options, device.as_ref(), &mesh)?;
        }
    }
    Ok(())
}

fn print_rays(options: &Options, device: Option<&Rc<Device>>, mesh: &Mesh) -> Result<(), String> {
    let accel = Accel::build(&mesh.positions, &mesh.triangles);
    let scene = |device, kind| Scene::build(device, kind, padded(&mesh.positions), mesh.triangles.clone());
    let scenes = match device {
        Some(device) => {
            Some(Scenes { robust: scene(device, Kind::Robust)?, fast: scene(device, Kind::Fast)? })
        }
        None => None,
    };
    for set in rays::all(mesh, &accel, options.side).iter().filter(|set| options.wants(set.name)) {
        println!(
            "| {} | {} {}",
            mesh.name,
            set.name,
            compare::row(&accel, scenes.as_ref(), set, options.repeat)
        );
    }
    Ok(())
}

fn print_builds(options: &Options, device: Option<&Rc<Device>>, mesh: &Mesh) -> Result<(), String> {
    let cells = builds::rows(device, mesh, options.repeat)?;
    for (name, cells) in ["build", "refit"].iter().zip(cells) {
        println!("| {} | {name} {cells}", mesh.name);
    }
    Ok(())
}

/// How many times as fast the second is, pass by pass: the median, and the least and the most.
fn ratio(theirs: &[f64], ours: &[f64]) -> String {
    let ratios: Vec<f64> = theirs.iter().zip(ours).map(|(theirs, ours)| theirs / ours).collect();
    let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let most = ratios.iter().copied().fold(0.0, f64::max);
    format!("**{:.2}** ({least:.2} to {most:.2})", timing::median(&ratios))
}

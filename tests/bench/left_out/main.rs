//! What scattering costs where there is none: `cargo bench --bench left_out`.
//!
//! A clear iceberg is rendered by this build and by one that knows of no medium that scatters
//! (`--cfg floe_without_scattering`), in turns on one thread. The medians of the seconds of light transport that the
//! ledgers state may differ by 2 %; beyond that the command fails.

#![allow(clippy::print_stdout, clippy::print_stderr)] // the ratio is what it is for

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Pictures by each build.
const TURNS: usize = 11;
/// Ratio that is still no cost.
const ALLOWED: f64 = 1.02;

fn main() -> ExitCode {
    match compare() {
        Ok(ratio) if ratio <= ALLOWED => ExitCode::SUCCESS,
        Ok(ratio) => {
            eprintln!("scattering costs scenes without it {:.1} %, more than 2 %", 100.0 * (ratio - 1.0));
            ExitCode::FAILURE
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn compare() -> Result<f64, String> {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let builds =
        [("with scattering", ""), ("without it", "--cfg floe_without_scattering")].map(|(name, flags)| {
            let target = project.join("target").join(format!("left_out {name}").replace(' ', "_"));
            build(project, &target, flags).map(|floe| (name, floe))
        });
    let [with, without] = builds;
    let builds = [with?, without?];
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let scene = clear_iceberg(project, folder.path())?;
    let mut seconds = [const { Vec::new() }; 2];
    for _ in 0..TURNS {
        for ((_, floe), seconds) in builds.iter().zip(&mut seconds) {
            seconds.push(render(floe, &scene, folder.path())?);
        }
    }
    let medians = seconds.map(|mut s: Vec<f64>| {
        s.sort_unstable_by(f64::total_cmp);
        s[TURNS / 2]
    });
    for ((name, _), median) in builds.iter().zip(medians) {
        println!("{name}: {median:.3} s");
    }
    println!("ratio {:.4}", medians[0] / medians[1]);
    Ok(medians[0] / medians[1])
}

/// Builds floe in a folder of its own; both builds are made alike but for the flags.
fn build(project: &Path, target: &Path, flags: &str) -> Result<PathBuf, String> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(project).args(["build", "--release", "--bin", "floe", "--target-dir"]).arg(target);
    run(cargo.env("RUSTFLAGS", flags))?;
    Ok(target.join("release/floe"))
}

/// The scene of the example with nothing in the ice that scatters.
fn clear_iceberg(project: &Path, folder: &Path) -> Result<PathBuf, String> {
    let example = project.join("sequences/iceberg");
    let text = std::fs::read_to_string(example.join("scene.toml")).map_err(|e| e.to_string())?;
    let kept: Vec<&str> = text.lines().filter(|line| !line.starts_with("scattering")).collect();
    if kept.len() + 1 != text.lines().count() {
        return Err("the example has not one line that begins with `scattering`".into());
    }
    let at_home = |text: String, name: &str| {
        text.replace(&format!("\"{name}"), &format!("\"{}", example.join(name).display()))
    };
    let text = ["frames/", "sky.exr"].into_iter().fold(kept.join("\n"), at_home);
    let scene = folder.join("clear.toml");
    std::fs::write(&scene, text).map_err(|e| e.to_string())?;
    Ok(scene)
}

/// Renders a frame; seconds of light transport.
fn render(floe: &Path, scene: &Path, folder: &Path) -> Result<f64, String> {
    let mut command = Command::new(floe);
    command.arg("render").arg(scene).args(["--frames", "6", "--samples", "8", "--threads", "1", "-q", "-o"]);
    run(command.arg(folder.join("####.exr")))?;
    let ledger = std::fs::read_to_string(folder.join("ledger.jsonl")).map_err(|e| e.to_string())?;
    let last = ledger.lines().last().unwrap_or("");
    let record: serde_json::Value = serde_json::from_str(last).map_err(|e| e.to_string())?;
    record["render_seconds"].as_f64().ok_or_else(|| format!("no render_seconds in {last}"))
}

fn run(command: &mut Command) -> Result<(), String> {
    let output = command.output().map_err(|e| format!("{command:?}: {e}"))?;
    if output.status.success() {
        return Ok(());
    }
    Err(format!("{command:?}: {}", String::from_utf8_lossy(&output.stderr)))
}

//! What a part of the renderer costs scenes that do without it: `cargo bench --bench left_out`.
//!
//! | part | scene | against a build with | may cost |
//! |---|---|---|---|
//! | scattering | a clear iceberg | `--cfg floe_without_scattering`, which knows of no medium that scatters | 2 % |
//! | guards against what ought not to be | the iceberg as it is | `--cfg floe_without_guards`, which counts no label that disagrees and no path that leaves a fluid through a hole, takes samples that are not finite, and does not care for slivers, for paths far outside or for chances below 2^-24 | 1 % |
//!
//! Both builds render in turns on one thread. The medians of the seconds of light transport that the ledgers state are
//! compared. `cargo bench --bench left_out guards` compares these only.

#![allow(clippy::print_stdout, clippy::print_stderr)] // the ratio is what it is for

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// Pictures by each build.
const TURNS: usize = 11;

struct Comparison {
    part: &'static str,
    flags: &'static str,
    /// What lines of the example's scene begin with that are left out of it.
    without: &'static str,
    samples: &'static str,
    /// Ratio of times that is still no cost.
    allowed: f64,
}

const COMPARISONS: [Comparison; 2] = [
    Comparison {
        part: "scattering",
        flags: "--cfg floe_without_scattering",
        without: "scattering",
        samples: "8",
        allowed: 1.02,
    },
    Comparison {
        part: "guards",
        flags: "--cfg floe_without_guards",
        without: "#",
        samples: "4",
        allowed: 1.01,
    },
];

fn main() -> ExitCode {
    let chosen: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let is_chosen = |part: &str| chosen.is_empty() || chosen.iter().any(|word| word == part);
    let mut exit = ExitCode::SUCCESS;
    for comparison in COMPARISONS.iter().filter(|comparison| is_chosen(comparison.part)) {
        let Comparison { part, allowed, .. } = comparison;
        match compare(comparison) {
            Ok(ratio) if ratio <= *allowed => {}
            Ok(ratio) => {
                let [is, may_be] = [ratio, *allowed].map(|r| 100.0 * (r - 1.0));
                eprintln!("{part} cost {is:.1} %, more than {may_be:.0} %");
                exit = ExitCode::FAILURE;
            }
            Err(message) => {
                eprintln!("{message}");
                exit = ExitCode::FAILURE;
            }
        }
    }
    exit
}

fn compare(comparison: &Comparison) -> Result<f64, String> {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let part = comparison.part;
    let build = |name: String, flags: &str| {
        let target = project.join("target").join(format!("left_out {name}").replace(' ', "_"));
        build(project, &target, flags).map(|floe| (name, floe))
    };
    let builds = [build("with all".into(), "")?, build(format!("without {part}"), comparison.flags)?];
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let scene = iceberg(project, folder.path(), comparison.without)?;
    let mut seconds = [const { Vec::new() }; 2];
    for _ in 0..TURNS {
        for ((_, floe), seconds) in builds.iter().zip(&mut seconds) {
            seconds.push(render(floe, &scene, comparison.samples, folder.path())?);
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

/// The scene of the example without lines that begin so.
fn iceberg(project: &Path, folder: &Path, without: &str) -> Result<PathBuf, String> {
    let example = project.join("sequences/iceberg");
    let text = std::fs::read_to_string(example.join("scene.toml")).map_err(|e| e.to_string())?;
    let kept: Vec<&str> = text.lines().filter(|line| !line.starts_with(without)).collect();
    if kept.len() + 1 != text.lines().count() {
        return Err(format!("the example has not one line that begins with `{without}`"));
    }
    let at_home = |text: String, name: &str| {
        text.replace(&format!("\"{name}"), &format!("\"{}", example.join(name).display()))
    };
    let text = ["frames/", "sky.exr"].into_iter().fold(kept.join("\n"), at_home);
    let scene = folder.join("iceberg.toml");
    std::fs::write(&scene, text).map_err(|e| e.to_string())?;
    Ok(scene)
}

/// Renders a frame; seconds of light transport.
fn render(floe: &Path, scene: &Path, samples: &str, folder: &Path) -> Result<f64, String> {
    let mut command = Command::new(floe);
    command.arg("render").arg(scene).args([
        "--frames",
        "6",
        "--samples",
        samples,
        "--threads",
        "1",
        "-q",
        "-o",
    ]);
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

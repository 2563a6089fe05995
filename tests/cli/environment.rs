//! What jobs of a farm find around them: few cores of many, and no home.

use std::process::{Command, Stdio};

use super::command;
use super::small::{Folder, cube, labelled, ply, scene};

/// Variables that say how many threads there are.
const THREADS: [&str; 4] = ["FLOE_THREADS", "RAYON_NUM_THREADS", "SLURM_CPUS_PER_TASK", "SLURM_CPUS_ON_NODE"];

/// A frame for which particles are computed first.
fn turbid() -> Folder {
    let folder = Folder::new();
    let tables = "[media.water]\nmodel = \"natural-water\"\npreset = \"atlantic\"\n[render]\nsamples = 1\n";
    folder.write("boxes/scene.toml", scene(tables));
    folder.write("boxes/frames/frame_0001.ply", ply(&labelled(cube(), 0, 1)));
    folder
}

/// How many threads of a process render.
#[cfg(target_os = "linux")]
fn rendering(process: u32) -> usize {
    let Ok(threads) = std::fs::read_dir(format!("/proc/{process}/task")) else { return 0 };
    let names = threads.flatten().map(|thread| std::fs::read_to_string(thread.path().join("comm")));
    names.filter(|name| name.as_ref().is_ok_and(|name| name.starts_with("render-"))).count()
}

/// Starts a long frame, waits until so many threads render, and returns what it says.
#[cfg(target_os = "linux")]
fn renders_on(threads: usize, mut command: Command) -> String {
    use std::time::{Duration, Instant};
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let start = Instant::now();
    while rendering(child.id()) != threads && start.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(10));
    }
    // Nor are there more of them a little later.
    std::thread::sleep(Duration::from_millis(100));
    let found = rendering(child.id());
    child.kill().unwrap();
    let said = String::from_utf8(child.wait_with_output().unwrap().stderr).unwrap();
    assert_eq!(found, threads, "{said}");
    said
}

#[cfg(target_os = "linux")]
#[test]
fn a_job_has_the_threads_that_it_was_given() {
    let folder = super::boxes(1, "");
    let long = ["render", "boxes", "--samples", "4000000"];
    let run = |more: &[&str], variables: &[(&str, &str)]| {
        let mut command = command(&folder, &[&long[..], more].concat());
        for name in THREADS {
            command.env_remove(name);
        }
        command.envs(variables.iter().copied());
        command
    };
    // Of a job, which may have several tasks on a node, each bound to its cores.
    let node = ("SLURM_CPUS_ON_NODE", "4");
    let cores = std::thread::available_parallelism().unwrap().get();
    for (threads, more, variables) in [
        (cores.min(4), &[][..], &[node][..]),
        (3, &[], &[("SLURM_CPUS_PER_TASK", "3"), node]),
        (5, &[], &[("FLOE_THREADS", "5"), ("SLURM_CPUS_PER_TASK", "3"), node]),
        (1, &["--threads", "1"], &[("FLOE_THREADS", "5")]),
    ] {
        assert_eq!(renders_on(threads, run(more, variables)), "", "{variables:?}");
    }
    let said =
        renders_on(cores.min(4), run(&[], &[("FLOE_THREADS", "all"), ("SLURM_CPUS_PER_TASK", "0"), node]));
    for words in ["warning: FLOE_THREADS: `all`", "warning: SLURM_CPUS_PER_TASK: `0`"] {
        assert!(said.contains(words), "{said}");
    }
}

/// The first core of those that this test may use.
#[cfg(target_os = "linux")]
#[test]
fn a_process_renders_on_the_cores_that_its_mask_leaves() {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let allowed = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:")).unwrap();
    let first = allowed.trim().split([',', '-']).next().unwrap();
    let folder = super::boxes(1, "");
    let floe = command(&folder, &["render", "boxes", "--samples", "4000000"]);
    let mut masked = Command::new("taskset");
    masked.args(["-c", first]).arg(floe.get_program()).args(floe.get_args()).current_dir(folder.path(""));
    for name in THREADS {
        masked.env_remove(name);
    }
    renders_on(1, masked);
}

/// Renders with caches and temporary files in folders of the test, and a home that is one too.
fn without_home(folder: &Folder, home: Option<&str>, variables: &[(&str, &str)]) {
    let mut command = command(folder, &["render", "boxes"]);
    for name in ["HOME", "FLOE_CACHE", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME"]
    {
        command.env_remove(name);
    }
    command.envs(home.map(|home| ("HOME", folder.path(home))));
    command.envs(variables.iter().map(|(name, value)| (name, folder.path(value))));
    let output = command.stdout(Stdio::piped()).stderr(Stdio::piped()).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{home:?} {output:?}");
    assert_eq!(String::from_utf8(output.stderr).unwrap().matches("warning").count(), 0);
}

#[test]
fn nothing_is_written_into_the_home() {
    let folder = turbid();
    let picture = |folder: &Folder| folder.read("out/boxes/frame_0001.exr");
    let below = |name: &str| {
        let inside = |file: &String| file.starts_with(&format!("{name}/"));
        folder.files().into_iter().filter(inside).collect::<Vec<_>>()
    };
    for name in ["home", "node", "cache"] {
        std::fs::create_dir(folder.path(name)).unwrap();
    }
    folder.write("file", "");
    // No home, one that is none, and one that is empty.
    without_home(&folder, None, &[("TMPDIR", "nowhere")]);
    let first = picture(&folder);
    without_home(&folder, Some("file/home"), &[("TMPDIR", "nowhere")]);
    without_home(&folder, Some("home"), &[("TMPDIR", "node")]);
    let kept = below("node");
    assert!(kept.len() == 1 && kept[0].ends_with(".optics"), "{kept:?}");
    without_home(&folder, Some("home"), &[("TMPDIR", "nowhere"), ("XDG_CACHE_HOME", "cache")]);
    let kept = below("cache");
    assert!(kept.len() == 1 && kept[0].starts_with("cache/floe/"), "{kept:?}");
    assert_eq!(below("home"), [""; 0]);
    assert!(!folder.path("nowhere").exists() && picture(&folder) == first);
    let others = ["boxes/", "cache/", "file", "node/", "out/boxes/"];
    let elsewhere =
        folder.files().into_iter().find(|file| !others.iter().any(|place| file.starts_with(place)));
    assert_eq!(elsewhere, None);
}

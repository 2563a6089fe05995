//! `floe submit` as a user meets it. What its scripts do on real schedulers is tested by the scripts in `tests/farm`.
#![cfg(all(unix, feature = "cli"))]
#![allow(clippy::unwrap_used)]

mod small;

use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Output};

use small::{Folder, cube, labelled, scene};

/// A scene with frames 1 to `frames` in a folder whose name takes care.
fn boxes(frames: u32) -> Folder {
    let folder = Folder::new();
    folder.write("it's a box/scene.toml", scene(""));
    for number in 1..=frames {
        folder
            .write(&format!("it's a box/frames/frame_{number:04}.ply"), small::ply(&labelled(cube(), 0, 1)));
    }
    // Whatever Slurm there is on this machine is not asked.
    pretend(&folder, "scontrol", "exit 1");
    folder
}

/// Puts a program of this name into the path of [`submit`].
fn pretend(folder: &Folder, name: &str, script: &str) {
    let name = format!("bin/{name}");
    folder.write(&name, format!("#!/bin/sh\n{script}\n"));
    std::fs::set_permissions(folder.path(&name), std::fs::Permissions::from_mode(0o755)).unwrap();
}

fn submit(folder: &Folder, arguments: &[&str]) -> Output {
    let path = format!("{}:{}", folder.path("bin").display(), std::env::var("PATH").unwrap());
    let mut command = Command::new(env!("CARGO_BIN_EXE_floe"));
    command.arg("submit").args(arguments).current_dir(folder.path("")).env("PATH", path).output().unwrap()
}

fn printed(folder: &Folder, arguments: &[&str]) -> String {
    let output = submit(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{output:#?}");
    String::from_utf8(output.stdout).unwrap()
}

fn refused(folder: &Folder, arguments: &[&str], code: i32, words: &[&str]) {
    let output = submit(folder, arguments);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{text}");
    assert!(output.stdout.is_empty());
    for word in words {
        assert!(text.contains(word), "no \"{word}\" in {text}");
    }
}

/// The lines of a script that a shell runs, with `exec` and what follows instead of it.
fn options(script: &str) -> Vec<&str> {
    script.lines().filter_map(|line| line.strip_prefix("#SBATCH ")).collect()
}

/// Runs a script of a scheduler with a program that prints its words in place of floe.
fn words(folder: &Folder, script: &str, variables: &[(&str, &str)]) -> Vec<String> {
    pretend(folder, "words", "printf '%s\\n' \"$@\"");
    let mut shell = Command::new("sh");
    let output = shell.args(["-c", script]).envs(variables.iter().copied()).output().unwrap();
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

fn printer(folder: &Folder) -> String {
    folder.path("bin/words").to_str().unwrap().to_owned()
}

fn absolute(folder: &Folder, name: &str) -> String {
    folder.path("").canonicalize().unwrap().join(name).to_str().unwrap().to_owned()
}

const SCENE: &str = "it's a box";

#[test]
fn a_batch_script_renders_its_share_of_the_frames() {
    let folder = boxes(5);
    let program = printer(&folder);
    let arguments = [
        "slurm",
        SCENE,
        "--output",
        "my shots/####.exr",
        "--samples",
        "8",
        "--tasks",
        "2",
        "--cpus",
        "4",
        "--time",
        "90m",
        "--memory",
        "2G",
        "--partition",
        "long",
        "--at-once",
        "1",
        "--sbatch=--account=fluids",
        "--program",
        &program,
        "--requeue-by",
        "slurm",
        "--",
        "--denoise",
    ];
    let script = printed(&folder, &arguments);
    assert!(script.starts_with("#!/bin/sh\n") && script.contains("\nexec "), "{script}");
    let wanted = [
        "--job-name=it_s_a_box",
        "--output=it_s_a_box.%A_%a.log",
        "--open-mode=append",
        "--partition=long",
        "--account=fluids",
        "--nodes=1",
        "--ntasks=1",
        "--array=1-2%1",
        "--cpus-per-task=4",
        "--time=0-01:30:00",
        "--mem=2048M",
        "--requeue",
        "--signal=B:TERM@60",
    ];
    assert_eq!(options(&script), wanted);
    let scene = absolute(&folder, "it's a box/scene.toml");
    let output = format!("--output={}", absolute(&folder, "my shots/####.exr"));
    let wanted = [
        "render",
        &scene,
        "--frames=1-5",
        "--samples=8",
        &output,
        "--resume",
        "--keep-going",
        "--threads=4",
        "--denoise",
        "--shard=2/2",
    ];
    assert_eq!(words(&folder, &script, &[("SLURM_ARRAY_TASK_ID", "2")]), wanted);
}

#[test]
fn arrays_are_no_larger_than_slurm_allows_and_75_is_put_into_the_queue_by_whom_slurm_says() {
    let folder = boxes(5);
    pretend(&folder, "scontrol", "echo 'MaxArraySize            = 4'; echo 'RequeueExit             = 75'");
    let script = printed(&folder, &["slurm", SCENE]);
    assert!(options(&script).contains(&"--array=1-3") && script.contains("\nexec "), "{script}");
    refused(&folder, &["slurm", SCENE, "--chunk", "1"], 2, &["5 tasks", "--tasks 3", "--chunk 2"]);
    pretend(&folder, "scontrol", "exit 1");
    let script = printed(&folder, &["slurm", SCENE]);
    assert!(options(&script).contains(&"--signal=B:USR2@60") && !script.contains("exec "), "{script}");
}

/// The renderer ends with a code, or is killed; the script asks for another turn or does not, and ends with that code.
#[test]
fn a_script_that_stays_puts_itself_into_the_queue_again_when_it_was_interrupted() {
    let folder = boxes(1);
    pretend(&folder, "scontrol", "echo \"$*\" >> \"$ASKED\"");
    let program = folder.path("bin/renderer").to_str().unwrap().to_owned();
    let script = printed(&folder, &["slurm", SCENE, "--requeue-by", "script", "--program", &program]);
    let asked = folder.path("asked");
    for (renderer, signal, code, again, restarts) in [
        ("exit 0", "", 0, false, "0"),
        ("exit 65", "", 65, false, "0"),
        ("exit 75", "", 75, true, "0"),
        ("kill -KILL $$", "", 137, true, "0"),
        ("kill -ILL $$", "", 132, true, "9"),
        ("kill -ILL $$", "", 132, false, "10"),
        ("exit 75", "", 75, true, "10"),
        ("trap 'exit 75' TERM; echo; sleep 9 > /dev/null 2>&1 & wait", "USR2", 75, true, "0"),
        ("trap 'exit 75' TERM; echo; sleep 9 > /dev/null 2>&1 & wait", "TERM", 75, false, "0"),
        ("trap 'exit 0' TERM; echo; sleep 9 > /dev/null 2>&1 & wait", "USR2", 0, false, "0"),
    ] {
        pretend(&folder, "renderer", renderer);
        folder.write("script", &script);
        folder.write("asked", "");
        // The script is signalled once its renderer can hear; `TERM` goes to both, as Slurm does it.
        let group = if signal == "TERM" { "-" } else { "" };
        let run = format!(
            "set -m; rm -f pipe; mkfifo pipe; sh script > pipe & job=$!; read -r _ < pipe; \
             [ -z '{signal}' ] || kill -{signal} {group}$job; wait $job; code=$?; \
             while [ $code -gt 128 ] && kill -0 $job 2>/dev/null; do wait $job; code=$?; done; exit $code"
        );
        let path = format!("{}:{}", folder.path("bin").display(), std::env::var("PATH").unwrap());
        let mut shell = Command::new("bash");
        shell.args(["-c", &run]).current_dir(folder.path("")).env("PATH", path);
        let output = shell
            .env("ASKED", &asked)
            .env("SLURM_JOB_ID", "7")
            .env("SLURM_ARRAY_TASK_ID", "1")
            .env("SLURM_RESTART_COUNT", restarts)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(code), "{renderer} {signal} {restarts}: {output:?}");
        let wanted = if again { "requeue 7\n" } else { "" };
        assert_eq!(std::fs::read_to_string(&asked).unwrap(), wanted, "{renderer} {signal} {restarts}");
    }
}

#[test]
fn a_folder_gets_the_array_the_check_after_it_and_what_submits_both() {
    let folder = boxes(3);
    let program = printer(&folder);
    printed(&folder, &["slurm", SCENE, "--write", "my job", "--program", &program]);
    let there: Vec<_> = folder.files().into_iter().filter(|name| name.starts_with("my job")).collect();
    assert_eq!(there, ["my job/check.sbatch", "my job/render.sbatch", "my job/submit.sh"]);
    let check = String::from_utf8(folder.read("my job/check.sbatch")).unwrap();
    assert!(options(&check).contains(&"--no-requeue"));
    let output = format!("--output={}", absolute(&folder, "out/it's a box/frame_####.exr"));
    let scene = absolute(&folder, "it's a box/scene.toml");
    // Frames that are cut as they are asked to be are all that is asked for.
    printed(
        &folder,
        &["slurm", SCENE, "--write", "cut", "--program", &program, "--", "--time-budget", "90s"],
    );
    let cut = String::from_utf8(folder.read("cut/check.sbatch")).unwrap();
    assert!(words(&folder, &cut, &[]).contains(&"--time-budget=90s".to_owned()), "{cut}");
    let report = ["report", &scene, "--frames=1-3", &output];
    let status = ["status", &scene, "--frames=1-3", "--expect=3", &output, "--require-complete"];
    assert_eq!(words(&folder, &check, &[]), [&report[..], &status].concat());
    pretend(&folder, "sbatch", "pwd >> \"$ASKED\"; echo \"$*\" >> \"$ASKED\"; echo '41;cluster'");
    let path = format!("{}:{}", folder.path("bin").display(), std::env::var("PATH").unwrap());
    let mut shell = Command::new("sh");
    shell.args(["my job/submit.sh", "--hold"]).current_dir(folder.path("")).env("PATH", path);
    let said = shell.env("ASKED", folder.path("asked")).output().unwrap();
    assert_eq!(String::from_utf8(said.stdout).unwrap(), "render 41, check 41\n");
    let job = absolute(&folder, "my job");
    let asked = String::from_utf8(folder.read("asked")).unwrap();
    let wanted = format!(
        "{job}\n--parsable --hold render.sbatch\n{job}\n--parsable --dependency=afterany:41 check.sbatch\n"
    );
    assert_eq!(asked, wanted);
}

#[test]
fn commands_are_a_line_a_task_that_any_shell_runs() {
    let folder = boxes(5);
    let program = printer(&folder);
    let lines = printed(&folder, &["commands", SCENE, "--chunk", "2", "--program", &program]);
    assert_eq!(lines.lines().count(), 3);
    let read = words(&folder, &lines, &[]);
    let shards: Vec<_> = read.iter().filter(|word| word.starts_with("--shard")).collect();
    assert_eq!(shards, ["--shard=1/3", "--shard=2/3", "--shard=3/3"]);
    assert_eq!(read.iter().filter(|word| **word == absolute(&folder, "it's a box/scene.toml")).count(), 3);
    printed(&folder, &["commands", SCENE, "--chunk", "2", "--program", &program, "--write", "my job"]);
    let task = format!("cd '{}'; sh 'my job/task.sh' 2", absolute(&folder, ""));
    assert!(words(&folder, &task, &[]).contains(&"--shard=2/3".to_owned()));
    assert!(words(&folder, &task.replace(" 2", " 4"), &[]).is_empty());
}

#[test]
fn templates_count_as_open_job_description_does() {
    let folder = boxes(5);
    let template =
        printed(&folder, &["openjd", SCENE, "--frames", "-3--1,1-5x2", "--tasks", "2", "--cpus", "4"]);
    for line in [
        "extensions: [TASK_CHUNKING]",
        "    default: \"-3--1,1-5:2\"",
        "    default: 6",
        "    default: 3",
        "            - \"--expect={{Param.FrameCount}}\"",
        "            - \"--frames={{Task.Param.Frame}}\"",
        "        - name: amount.worker.vcpu",
        "            mode: NOTIFY_THEN_TERMINATE",
        "      - dependsOn: Render",
    ] {
        assert!(template.lines().any(|other| other == line), "no \"{line}\" in {template}");
    }
    let plain = printed(&folder, &["openjd", SCENE, "--tasks", "2", "--plain"]);
    assert!(!plain.contains("extensions") && plain.contains("--shard={{Task.Param.Shard}}/2"), "{plain}");
    refused(&folder, &["openjd", SCENE, "--frames", "1,2.5"], 2, &["frame 2.5", "whole numbers", "--frames"]);
    refused(&folder, &["openjd", SCENE, "--output", "{{x}}_####.exr"], 2, &["{{x}}_####.exr", "rename"]);
}

#[test]
fn frames_may_be_submitted_before_they_are_there_and_stills_have_none() {
    let folder = boxes(0);
    folder.write("it's a box/frames/readme.txt", "");
    let lines = printed(&folder, &["commands", SCENE, "--frames", "1-40"]);
    assert!(lines.lines().count() == 40 && lines.contains("--frames=1-40 "), "{lines}");
    let early = ["commands", SCENE, "--frames", "1-2"];
    let said = String::from_utf8(submit(&folder, &early).stderr).unwrap();
    assert!(said.contains("# not there yet: 1,2\n"), "{said}");
    refused(&folder, &[&early[..], &["--trial"]].concat(), 2, &["no frame is there yet", "--trial"]);
    refused(&folder, &["commands", SCENE], 66, &["no frames", "frames.path"]);
    folder.write(
        "still.toml",
        scene("").replace("[frames]", "[output]").replace("frames/frame_####.ply", "still.exr"),
    );
    let lines = printed(&folder, &["commands", "still.toml"]);
    assert!(lines.lines().count() == 1 && !lines.contains("--frames"), "{lines}");
}

#[test]
fn what_no_task_could_run_is_refused() {
    let folder = boxes(2);
    refused(
        &folder,
        &["commands", SCENE, "--", "--sampels", "3"],
        2,
        &["--sampels", "options of floe render"],
    );
    // The check would look for other pictures.
    refused(&folder, &["commands", SCENE, "--", "--seed", "3"], 2, &["--seed", "before the --"]);
    refused(&folder, &["commands", SCENE, "--", "--samples-range", "0..1"], 2, &["--samples-range", "leave"]);
    refused(&folder, &["commands", SCENE, "--", "--preview"], 2, &["--preview", "leave it out"]);
    refused(&folder, &["commands", SCENE, "--memory", "8"], 2, &["--memory", "8G"]);
    refused(&folder, &["commands", SCENE, "--output", "shot.exr"], 2, &["shot.exr", "####"]);
    refused(&folder, &["commands", SCENE, "--shard", "1/2"], 2, &["--shard", "--tasks"]);
    refused(&folder, &["slurm", SCENE, "--output", "a\nb_####.exr"], 2, &["line break"]);
    refused(&folder, &["commands", SCENE, "--tasks", "2", "--chunk", "2"], 2, &["--chunk"]);
    for (scheduler, given) in
        [("commands", "--shard=1/2"), ("slurm", "--shard=1/2"), ("openjd", "--progress=json")]
    {
        refused(&folder, &[scheduler, SCENE, "--", given], 2, &[given, "leave it out"]);
    }
    refused(&folder, &["commands", SCENE, "--time", "1h"], 2, &["--time", "scheduler"]);
    refused(&folder, &["slurm", SCENE, "--time", "2m"], 2, &["--time", "at least 3m"]);
    refused(&folder, &["commands", SCENE, "--frames", "1-99999999999"], 2, &["1-99999999999", "fewer"]);
}

#[test]
fn a_trial_says_what_all_will_cost() {
    let folder = boxes(7);
    let output = submit(&folder, &["commands", SCENE, "--trial", "--tasks", "3"]);
    assert_eq!(output.status.code(), Some(0), "{output:#?}");
    let said = String::from_utf8(output.stderr).unwrap();
    for words in
        ["# trial: frame 1\n", "7 frames with 4 samples a pixel: 0.0000 core hours (95 %: ", "a task of 3"]
    {
        assert!(said.contains(words), "no \"{words}\" in {said}");
    }
    assert_eq!(String::from_utf8(output.stdout).unwrap().lines().count(), 3);
    // It leaves nothing behind.
    assert!(
        folder.files().iter().all(|name| !name.contains("out/") && !name.contains(".exr")),
        "{:?}",
        folder.files()
    );
}

//! A batch script for Slurm.
//!
//! Slurm signals the processes of a job before it kills them, when its time is nearly up only the one that it started
//! (`--signal=B:`). So the renderer takes the place of the script (`exec`), ends with 75, and Slurm puts it into the queue again
//! where it is told to (`RequeueExit`). Where it is not the script stays and asks for that itself; it hears of the time by a
//! signal of its own, since one that the renderer gets twice ends it at once.

use std::time::Duration;

use clap::{Args, ValueEnum};

use super::common::Common;
use super::site::Site;
use super::work::{Work, absolute};
use super::{Papers, Refusal, shell};
use crate::cli::exit::Exit;

#[derive(Debug, Args)]
pub struct SlurmArguments {
    #[command(flatten)]
    pub common: Common,
    /// Partition of the cluster
    #[arg(long, value_name = "NAME")]
    partition: Option<String>,
    /// Tasks that run at once, at most
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    at_once: Option<u32>,
    /// Further options of sbatch, one each, such as --sbatch=--account=fluids
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true)]
    sbatch: Vec<String>,
    /// Who puts what was interrupted into the queue again: Slurm, where RequeueExit has 75, or the script
    /// [default: what the Slurm of this machine says, else the script]
    #[arg(long, value_name = "WHO")]
    requeue_by: Option<Requeue>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Requeue {
    Slurm,
    Script,
}

/// The signal comes 60 s before the end, or up to 60 s earlier; a task has to get on before.
const LEAST_TIME: Duration = Duration::from_secs(180);

/// Restarts after which a script that stays does not ask for another one when its renderer was killed.
const MOST_KILLS: u32 = 10;

const RENDER: &str = "render.sbatch";
const CHECK: &str = "check.sbatch";
const SUBMIT: &str = "submit.sh";

pub fn papers(arguments: &SlurmArguments, work: &Work) -> Result<Papers, Refusal> {
    let site = Site::ask();
    let common = &arguments.common;
    let tasks = common.tasks(work.numbers.len(), site.most_tasks)?;
    check_options(arguments)?;
    common.check_given(&["--shard"])?;
    let by_slurm = site.requeues(Exit::Interrupted as u8);
    let requeue = arguments.requeue_by.unwrap_or(if by_slurm { Requeue::Slurm } else { Requeue::Script });
    let files = vec![
        (RENDER, render_script(arguments, work, tasks, requeue)),
        (CHECK, check_script(arguments, work)),
        (SUBMIT, submit_script()),
    ];
    let guess = if site.is_known {
        ""
    } else {
        " (no Slurm answers here: arrays are of 1000 at most, as by default)"
    };
    let about = format!("{} in {tasks} tasks{guess}", work.count());
    let once_printed = format!(
        "# {about}; pipe it into sbatch, and then: sbatch --dependency=afterany:JOB --no-requeue --wrap {}",
        shell::quoted(&check_command(work))
    );
    let folder = common.write.as_deref().map(absolute).transpose()?.unwrap_or_default();
    let once_written = format!("{about}; now: sh {}", shell::quoted(&format!("{folder}/{SUBMIT}")));
    Ok(Papers { tasks, files, once_printed, once_written })
}

/// Lines of a script cannot quote what ends them, and a task needs time before it is told to stop.
fn check_options(arguments: &SlurmArguments) -> Result<(), Refusal> {
    let words = arguments.sbatch.iter().chain(&arguments.partition);
    let broken = words.clone().find(|word| word.contains(char::is_control));
    if let Some(word) = broken {
        return Err(format!("{word:?} has a line break in it: give one option at a time").into());
    }
    if arguments.common.time.is_some_and(|time| time < LEAST_TIME) {
        let least = LEAST_TIME.as_secs() / 60;
        return Err(format!(
            "--time: Slurm asks a task to stop one or two minutes before its end, so it would do nothing: give at least {least}m"
        )
        .into());
    }
    Ok(())
}

/// `#SBATCH` lines that both jobs have.
fn shared_head(arguments: &SlurmArguments, name: &str, log: &str) -> String {
    let mut head =
        format!("#!/bin/sh\n#SBATCH --job-name={name}\n#SBATCH --output={log}\n#SBATCH --open-mode=append\n");
    let partition = arguments.partition.iter().map(|name| format!("--partition={name}"));
    for option in partition.chain(arguments.sbatch.iter().cloned()) {
        head += &format!("#SBATCH {option}\n");
    }
    head + "#SBATCH --nodes=1\n#SBATCH --ntasks=1\n"
}

fn render_script(arguments: &SlurmArguments, work: &Work, tasks: usize, requeue: Requeue) -> String {
    let common = &arguments.common;
    let mut text = shared_head(arguments, &work.name, &format!("{}.%A_%a.log", work.name));
    let at_once = arguments.at_once.map_or_else(String::new, |most| format!("%{most}"));
    // The line that is signalled a minute before the end; Slurm is right to within another.
    let signal = if requeue == Requeue::Slurm { "B:TERM@60" } else { "B:USR2@60" };
    let options = [
        Some(format!("--array=1-{tasks}{at_once}")),
        common.cpus.map(|cpus| format!("--cpus-per-task={cpus}")),
        common.time.map(|time| format!("--time={}", slurm_time(time))),
        common.memory.map(|mebibytes| format!("--mem={mebibytes}M")),
        Some("--requeue".into()),
        Some(format!("--signal={signal}")),
    ];
    for option in options.into_iter().flatten() {
        text += &format!("#SBATCH {option}\n");
    }
    let command = shell::line(work.render(&work.all_frames()));
    // The shell fills this word in; N is written out, since Slurm's own count changes when a part is submitted again.
    let command = format!("{command} --shard=\"$SLURM_ARRAY_TASK_ID/{tasks}\"");
    text + &match requeue {
        Requeue::Slurm => format!("\nexec {command}\n"),
        Requeue::Script => waiting(&command),
    }
}

/// Runs a command and puts the job into the queue again when it was interrupted.
fn waiting(command: &str) -> String {
    let interrupted = Exit::Interrupted as u8;
    format!(
        "
# Where RequeueExit of Slurm does not have {interrupted} the script puts itself into the queue again.
again=
trap 'again=yes; kill -s TERM \"$!\"' USR2   # the time is nearly up
trap 'again=no' TERM                     # cancelled or preempted: Slurm tells the renderer too, and knows what is next

{command} &
wait \"$!\"; code=$?
# A signal ends a wait, which then says no more than that; of what has ended before there is nothing to wait for (127).
for signal in USR2 TERM; do
    if [ \"$code\" -gt 128 ]; then wait \"$!\"; next=$?; if [ \"$next\" -ne 127 ]; then code=$next; fi; fi
done

# Above 128 it was killed, for want of memory perhaps: floe gives up (70) once that has brought nothing new several times,
# but not where it is killed before it can count, by a processor that lacks its instructions perhaps.
if [ \"$code\" -eq {interrupted} ]; then again=${{again:-yes}}; fi
if [ \"$code\" -gt 128 ] && [ \"${{SLURM_RESTART_COUNT:-0}}\" -lt {MOST_KILLS} ]; then again=${{again:-yes}}; fi
if [ \"$again\" = yes ] && [ \"$code\" -ne 0 ]; then scontrol requeue \"$SLURM_JOB_ID\"; fi
exit \"$code\"
"
    )
}

fn check_script(arguments: &SlurmArguments, work: &Work) -> String {
    let log = format!("{}.check.%j.log", work.name);
    let head = shared_head(arguments, &format!("{}-check", work.name), &log);
    let report = shell::line(work.report(&work.all_frames()));
    let code = Exit::Interrupted as u8;
    let status = check_command(work);
    format!(
        "{head}#SBATCH --no-requeue

{report}
# Not {code}, with which RequeueExit would let it go round for ever.
{status}
"
    )
}

fn check_command(work: &Work) -> String {
    format!("{} || exit 1", shell::line(work.status(&work.expected_frames())))
}

/// Array and check: with `afterok` in place of `afterany` the check would never run, since a task that is put into the
/// queue again has failed once.
fn submit_script() -> String {
    format!(
        "#!/bin/sh
# Puts the array and the job that looks whether all is there into the queue. Logs come to lie beside this script.
set -eu
cd \"$(dirname \"$0\")\"
array=$(sbatch --parsable \"$@\" {RENDER})
check=$(sbatch --parsable --dependency=\"afterany:${{array%%;*}}\" {CHECK})
echo \"render ${{array%%;*}}, check ${{check%%;*}}\"
"
    )
}

/// Days, hours, minutes and seconds, rounded up.
fn slurm_time(time: Duration) -> String {
    let seconds = time.as_secs() + u64::from(time.subsec_nanos() > 0);
    let (days, seconds) = (seconds / 86_400, seconds % 86_400);
    format!("{days}-{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_as_slurm_reads_them() {
        for (milliseconds, text) in [(1, "0-00:00:01"), (90_000, "0-00:01:30"), (90_000_000, "1-01:00:00")] {
            assert_eq!(slurm_time(Duration::from_millis(milliseconds)), text);
        }
    }
}

//! What the environment of a job says: how many threads it has, and how often it was started again.
//!
//! Slurm without cgroups shows a job all cores of its node, so what the job was given is asked for first. Otherwise the
//! standard library counts the cores that the affinity mask and the cgroup leave.

use super::exit::Exit;
use super::streams::say;
use crate::driver::Restart;

/// The first that is set holds; the second is of the library that shares out work to threads.
const THREADS: [&str; 4] = ["FLOE_THREADS", "RAYON_NUM_THREADS", "SLURM_CPUS_PER_TASK", OF_JOB];
/// What all tasks of a job have on a node: Slurm may have bound this one to fewer.
const OF_JOB: &str = "SLURM_CPUS_ON_NODE";

/// Gives everything as many threads as the environment says, for which nobody says otherwise.
///
/// # Errors
/// The exit code when they cannot be started; it is said why.
pub fn obey() -> Result<(), Exit> {
    let (found, ignored) = threads(variable, cores());
    for (name, value) in ignored {
        say(&format!(
            "warning: {name}: `{value}` is no number of threads and ignored: set it to 1 or more, or unset it"
        ));
    }
    let Some((name, threads)) = found else { return Ok(()) };
    let started = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global();
    started.map_err(|reason| {
        say(&format!("error: {name}: cannot start {threads} threads: {reason}; set it to fewer"));
        Exit::Internal
    })
}

/// How often, and as which job, Slurm has started this command again; `None` when this is the first time, or not Slurm.
pub fn restart() -> Option<Restart> {
    let count = variable("SLURM_RESTART_COUNT")?.trim().parse().ok().filter(|&count| count > 0)?;
    let job = variable("SLURM_JOB_ID").and_then(|id| id.trim().parse().ok()).unwrap_or(0);
    Some(Restart { job, count })
}

fn variable(name: &str) -> Option<String> {
    std::env::var_os(name).map(|value| value.to_string_lossy().into_owned())
}

type Named<T> = (&'static str, T);

/// Those that the affinity mask and the cgroup leave.
fn cores() -> u16 {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    u16::try_from(cores).unwrap_or(u16::MAX)
}

/// The number of threads and the variable with it, and those before it with values that are none.
fn threads(
    variable: impl Fn(&str) -> Option<String>,
    cores: u16,
) -> (Option<Named<u16>>, Vec<Named<String>>) {
    let mut ignored = Vec::new();
    for name in THREADS {
        let Some(value) = variable(name).filter(|value| !value.is_empty()) else { continue };
        match value.trim().parse() {
            Ok(threads) if threads > 0 => {
                let threads = if name == OF_JOB { cores.min(threads) } else { threads };
                return (Some((name, threads)), ignored);
            }
            _ => ignored.push((name, value)),
        }
    }
    (None, ignored)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_number_of_threads_holds() {
        let of = |set: &[(&str, &str)]| {
            threads(|name| set.iter().find(|(n, _)| *n == name).map(|(_, value)| value.to_string()), 16)
        };
        let all = [("SLURM_CPUS_ON_NODE", "8"), ("SLURM_CPUS_PER_TASK", "4"), ("RAYON_NUM_THREADS", "3")];
        assert_eq!(of(&all).0, Some(("RAYON_NUM_THREADS", 3)));
        assert_eq!(of(&all[..2]).0, Some(("SLURM_CPUS_PER_TASK", 4)));
        assert_eq!(of(&all[..1]).0, Some(("SLURM_CPUS_ON_NODE", 8)));
        assert_eq!(of(&[("FLOE_THREADS", " 2 "), all[1]]), (Some(("FLOE_THREADS", 2)), Vec::new()));
        assert_eq!(of(&[("SLURM_CPUS_ON_NODE", "64")]).0, Some(("SLURM_CPUS_ON_NODE", 16)));
        assert_eq!(of(&[]), (None, Vec::new()));
        for nonsense in ["0", "-1", "2.5", "many", "4(x2)", "99999"] {
            let (found, ignored) = of(&[("FLOE_THREADS", nonsense), all[0]]);
            assert_eq!(found, Some(("SLURM_CPUS_ON_NODE", 8)));
            assert_eq!(ignored, [("FLOE_THREADS", nonsense.to_owned())]);
        }
        assert_eq!(of(&[("FLOE_THREADS", "")]), (None, Vec::new()));
    }
}

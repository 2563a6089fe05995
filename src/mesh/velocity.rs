//! Which properties of a file are the velocities of its vertices.
//!
//! Every simulator has a name of its own for them. `U` and `v` are vectors where they are found: the numbers `u` and `v`
//! alone are texture coordinates. Units are those of the file per second.

/// Which velocities a reader takes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum VelocityName {
    /// None, whatever the file has.
    #[default]
    Nothing,
    /// Those of the first name that simulators are known to use.
    Known,
    /// Those of this name.
    Only(String),
}

/// Velocities that a file has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VelocityProperty {
    /// A list of vectors of this name.
    Vectors(String),
    /// A list of numbers for each axis.
    Components([String; 3]),
}

/// A form that a name may take.
#[derive(Clone, Copy, Debug)]
enum Form<'a> {
    Vectors(&'a str),
    /// What stands before `x`, `y` and `z`.
    Components(&'a str),
}

/// What simulators write, the most telling first.
const KNOWN: [Form; 10] = [
    Form::Vectors("velocity"),
    Form::Components("velocity_"),
    Form::Components("velocity."),
    Form::Components("v"),
    Form::Vectors("vel"),
    Form::Components("vel_"),
    Form::Vectors("v"),
    Form::Vectors("u"),
    Form::Vectors("velocities"),
    Form::Vectors("flip_velocity"),
];

impl VelocityName {
    /// The velocities among the vectors and the numbers that a file has for each vertex, whatever the case of letters.
    pub(super) fn find(&self, vectors: &[&str], numbers: &[&str]) -> Option<VelocityProperty> {
        match self {
            Self::Nothing => None,
            Self::Known => KNOWN.iter().find_map(|form| form.find(vectors, numbers)),
            Self::Only(name) => {
                let prefixes = ["_", ".", ""].map(|joint| format!("{name}{joint}"));
                let components = prefixes.iter().map(|prefix| Form::Components(prefix));
                let mut forms = std::iter::once(Form::Vectors(name)).chain(components);
                forms.find_map(|form| form.find(vectors, numbers))
            }
        }
    }
}

impl Form<'_> {
    fn find(self, vectors: &[&str], numbers: &[&str]) -> Option<VelocityProperty> {
        let among = |names: &[&str], wanted: &str| {
            names.iter().find(|name| name.eq_ignore_ascii_case(wanted)).map(|&name| name.to_owned())
        };
        match self {
            Self::Vectors(name) => among(vectors, name).map(VelocityProperty::Vectors),
            Self::Components(prefix) => {
                let [x, y, z] = ["x", "y", "z"].map(|axis| among(numbers, &format!("{prefix}{axis}")));
                Some(VelocityProperty::Components([x?, y?, z?]))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn components(names: [&str; 3]) -> Option<VelocityProperty> {
        Some(VelocityProperty::Components(names.map(str::to_owned)))
    }

    fn vectors(name: &str) -> Option<VelocityProperty> {
        Some(VelocityProperty::Vectors(name.to_owned()))
    }

    #[test]
    fn the_first_known_name_is_taken_in_any_case() {
        let known = |vectors: &[&str], numbers: &[&str]| VelocityName::Known.find(vectors, numbers);
        assert_eq!(known(&[], &["x", "y", "z", "vx", "vy", "vz"]), components(["vx", "vy", "vz"]));
        assert_eq!(known(&[], &["VZ", "Vx", "vY"]), components(["Vx", "vY", "VZ"]));
        let both = ["vx", "vy", "vz", "velocity_x", "velocity_y", "velocity_z"];
        assert_eq!(known(&[], &both), components(["velocity_x", "velocity_y", "velocity_z"]));
        assert_eq!(known(&["U", "Velocity"], &both), vectors("Velocity"));
        assert_eq!(known(&["p", "U"], &[]), vectors("U"));
        assert_eq!(known(&["v", "vel"], &[]), vectors("vel"));
    }

    #[test]
    fn texture_coordinates_and_parts_of_vectors_are_none() {
        for numbers in [&["u", "v"][..], &["s", "t", "v"], &["vx", "vy"], &["velocity"]] {
            assert_eq!(VelocityName::Known.find(&[], numbers), None, "{numbers:?}");
        }
        assert_eq!(VelocityName::Known.find(&["uv", "normal"], &[]), None);
    }

    #[test]
    fn a_name_of_the_user_is_the_only_one() {
        let own = VelocityName::Only("Motion".into());
        assert_eq!(own.find(&["velocity"], &["vx", "vy", "vz"]), None);
        assert_eq!(own.find(&["velocity", "motion"], &[]), vectors("motion"));
        assert_eq!(
            own.find(&[], &["motionx", "motiony", "motionz"]),
            components(["motionx", "motiony", "motionz"])
        );
        assert_eq!(VelocityName::Nothing.find(&["velocity"], &["vx", "vy", "vz"]), None);
    }
}

//! The stability battery: whether numbers stay right where a parameter makes a scene hard.
//!
//! A [`Group`] is about one such parameter and has a [`Case`] for each of its values; a case renders small scenes that are
//! put together in memory ([`scene`]) and compares a number with what is known of it: a closed form, a limit, or an
//! invariance. [`case`] judges, [`table`] and [`diagram`] show. A new group is a file here and a line in [`GROUPS`].
//!
//! These are the results of `floe study --stability --output FOLDER` in `stability.md`, of all cases:
#![doc = include_str!("../stability.md")]

pub mod case;
pub mod diagram;
pub mod h_function;
pub mod picture;
pub mod pieces;
pub mod scene;
pub mod shapes;
pub mod table;

mod albedo;
mod asymmetry;
mod bodies;
mod chromatic;
mod contacts;
mod extinction;
mod frames;
mod grazing;
mod half_spaces;
mod index;
mod labels;
mod limits;
mod offsets;
mod radiance;
mod scale;
mod slivers;
mod spheres;
mod sun;

pub use case::{Case, Loss, Measurement, Outcome, Reference, Row};
pub use picture::{Picture, render};
pub use scene::{Prepared, Scene};

/// Cases that are hard for the same reason.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// Its name on the command line.
    pub name: &'static str,
    /// What its parameter is, with its unit.
    pub parameter: &'static str,
    /// What is checked, in a sentence.
    pub about: &'static str,
    /// Its cases, in the order of the parameter.
    pub cases: fn() -> Vec<Case>,
}

/// Every group, in the order in which they are run.
pub const GROUPS: [Group; 19] = [
    extinction::GROUP,
    half_spaces::GROUP,
    albedo::GROUP,
    asymmetry::GROUP,
    index::GROUP,
    grazing::GROUP,
    sun::GROUP,
    radiance::GROUP,
    chromatic::GROUP,
    limits::DEPTH,
    limits::SAMPLES,
    limits::RESOLUTION,
    scale::GROUP,
    offsets::GROUP,
    slivers::GROUP,
    contacts::GROUP,
    labels::GROUP,
    frames::GROUP,
    spheres::GROUP,
];

/// Which cases are run.
#[derive(Clone, Debug, Default)]
pub struct Selection {
    /// Of these groups only; all where there are none.
    pub only: Vec<String>,
    /// The quick subset only.
    pub quick: bool,
}

/// Runs one case after the other; `hear` is told of each row when it is there.
pub fn run(selection: &Selection, mut hear: impl FnMut(&Row)) -> Vec<Row> {
    let is_asked_for =
        |group: &&Group| selection.only.is_empty() || selection.only.iter().any(|name| name == group.name);
    let cases = GROUPS.iter().filter(is_asked_for).flat_map(|group| (group.cases)());
    let cases = cases.filter(|case| case.is_quick || !selection.quick);
    let mut run = |case: Case| {
        let row = case.run();
        hear(&row);
        row
    };
    cases.map(&mut run).collect()
}

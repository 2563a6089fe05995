//! `floe optics`: one file a form. `sphere` is a subcommand; whatever else is named is a medium.

mod medium;
mod named;
mod sphere;
mod wavelengths;

use clap::{Args, Subcommand};

use super::exit::Exit;

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, after_help = medium::EXAMPLES)]
pub struct OpticsArguments {
    #[command(subcommand)]
    of: Option<Of>,
    #[command(flatten)]
    medium: medium::MediumArguments,
}

#[derive(Debug, Subcommand)]
enum Of {
    /// One sphere, by Lorenz-Mie theory
    Sphere(sphere::SphereArguments),
}

/// Computes and prints.
pub fn run(arguments: &OpticsArguments) -> Exit {
    match &arguments.of {
        Some(Of::Sphere(sphere)) => sphere::run(sphere),
        None => medium::run(&arguments.medium),
    }
}

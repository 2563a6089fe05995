//! `floe optics sphere`

use clap::Args;
use serde::Serialize;

use crate::cli::exit::Exit;
use crate::cli::streams::{print, say};
use crate::optics::lorenz_mie::{Coefficients, Complex64, Sphere, SphereError};

#[derive(Debug, Args)]
pub(super) struct SphereArguments {
    /// Refractive index relative to the host, n+ki with k >= 0 absorbing: 1.33, 1.5+0.1i
    #[arg(long, value_name = "INDEX", allow_hyphen_values = true, value_parser = index)]
    m: Complex64,
    /// Size parameter, the sphere's circumference over the wavelength in the host
    #[arg(long, value_name = "X", allow_hyphen_values = true)]
    x: f64,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// What is printed of a sphere.
#[derive(Serialize)]
struct SphereReport {
    m: [f64; 2],
    x: f64,
    qext: f64,
    qsca: f64,
    qback: f64,
    /// 0 where nothing is scattered.
    g: f64,
}

/// Computes and prints.
pub(super) fn run(arguments: &SphereArguments) -> Exit {
    match report(arguments) {
        Ok(report) if arguments.json => print(&(serde_json::to_string(&report).unwrap_or_default() + "\n")),
        Ok(report) => print(&text(&report)),
        Err(error) => {
            say(&format!("error: {error}"));
            Exit::Usage
        }
    }
}

fn report(arguments: &SphereArguments) -> Result<SphereReport, SphereError> {
    let SphereArguments { m, x, .. } = *arguments;
    let found = Coefficients::new(Sphere::new(m, Complex64::ONE, x)?).efficiencies();
    Ok(SphereReport {
        m: [m.re, m.im],
        x,
        qext: found.extinction,
        qsca: found.scattering,
        qback: found.backward,
        g: if found.scattering > 0.0 { found.asymmetry } else { 0.0 },
    })
}

/// 17 digits tell every f64 from every other.
fn text(report: &SphereReport) -> String {
    let SphereReport { qext, qsca, qback, g, .. } = report;
    format!("Qext  {qext:.16e}\nQsca  {qsca:.16e}\nQback {qback:.16e}\ng     {g:.16e}\n")
}

fn index(text: &str) -> Result<Complex64, String> {
    text.trim().parse().map_err(|_| format!("\"{text}\" is no complex number such as 1.33 or 1.5+0.1i"))
}

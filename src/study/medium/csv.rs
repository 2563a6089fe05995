//! Reports as comma-separated values, in as many digits as tell a number from every other.

use std::fmt::Write;

use super::quantity::{OF_SPECIES, QUANTITIES};
use super::{Comparison, MediumReport};

/// A line of heads and a line a wavelength: all quantities, then those of each species.
pub fn coefficients(report: &MediumReport) -> String {
    table(&columns(report, ""))
}

/// The same of two media: A, B, and B over A; empty where A has nothing.
pub fn both(comparison: &Comparison) -> String {
    let Comparison { a, b } = comparison;
    let mut all = columns(a, "a_");
    all.extend(columns(b, "b_").into_iter().skip(1));
    all.extend(QUANTITIES.iter().map(|quantity| {
        let pairs = (quantity.values)(a).iter().zip((quantity.values)(b));
        (format!("{}_b_over_a", quantity.key), pairs.map(|(a, b)| b / a).collect())
    }));
    table(&all)
}

/// A line of heads and a line an angle: the phase function in 1/sr at each wavelength.
pub fn phase(report: &MediumReport) -> String {
    let phase = &report.phase;
    let degrees = phase.angles.iter().map(|angle| angle.to_degrees()).collect();
    let values = phase.wavelengths.iter().zip(&phase.values);
    let values = values.map(|(lambda, values)| (format!("p_per_sr_at_{lambda}_nm"), values.clone()));
    table(&[("angle_degrees".to_owned(), degrees)].into_iter().chain(values).collect::<Vec<_>>())
}

type Column = (String, Vec<f64>);

fn columns(report: &MediumReport, prefix: &str) -> Vec<Column> {
    let wavelengths = ("wavelength_nm".to_owned(), report.wavelengths.clone());
    let own = QUANTITIES.iter().map(|quantity| {
        (format!("{prefix}{}{}", quantity.key, quantity.unit), (quantity.values)(report).to_vec())
    });
    let of_species = report.species.iter().flat_map(|species| {
        OF_SPECIES.iter().map(|(key, unit, values)| {
            (quoted(&format!("{prefix}{} {key}{unit}", species.name)), values(species).to_vec())
        })
    });
    [wavelengths].into_iter().chain(own).chain(of_species).collect()
}

/// Heads are free names where species have them.
fn quoted(head: &str) -> String {
    if head.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", head.replace('"', "\"\"").replace(['\n', '\r'], " "))
    } else {
        head.into()
    }
}

fn table(columns: &[Column]) -> String {
    let heads: Vec<&str> = columns.iter().map(|(head, _)| head.as_str()).collect();
    let mut text = heads.join(",") + "\n";
    for i in 0..columns.first().map_or(0, |(_, values)| values.len()) {
        for (j, (_, values)) in columns.iter().enumerate() {
            text.push_str(if j > 0 { "," } else { "" });
            if values[i].is_finite() {
                let _ = write!(text, "{}", values[i]);
            }
        }
        text.push('\n');
    }
    text
}

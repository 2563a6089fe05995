//! Reports to look at.

use std::fmt::Write;

use super::quantity::{OF_SPECIES, QUANTITIES};
use super::{Colour, Comparison, MediumReport};

/// The wavelength in nm whose lengths stand beside the colours.
const MIDDLE: f64 = 550.0;

/// Columns of all quantities, of the species, and the colours.
pub fn of(report: &MediumReport) -> String {
    let mut text = format!("{}; coefficients in 1/m\n{:>6}", report.medium, "nm");
    QUANTITIES.iter().for_each(|quantity| text += &format!("{:>11}", quantity.symbol));
    for (i, lambda) in report.wavelengths.iter().enumerate() {
        let _ = write!(text, "\n{lambda:>6}");
        QUANTITIES.iter().for_each(|quantity| text += &cell((quantity.values)(report)[i]));
    }
    text + "\n" + &species(report) + &colours(report)
}

/// Six digits that mean something, never more than ten letters.
fn cell(value: f64) -> String {
    let shown = match value.abs() {
        0.0 => "0".into(),
        size if (1e-3..1e5).contains(&size) => {
            let digits = 5 - libm::log10(size).floor() as i32;
            format!("{value:.*}", usize::try_from(digits.clamp(0, 6)).unwrap_or(0))
        }
        _ => format!("{value:.3e}"),
    };
    format!("{shown:>11}")
}

/// A ratio in at most eight letters.
fn quotient(ratio: f64) -> String {
    match ratio.abs() {
        size if !size.is_finite() => "-".into(),
        size if size == 0.0 || (1e-3..999.0).contains(&size) => format!("{ratio:.4}"),
        _ => format!("{ratio:.2e}"),
    }
}

fn species(report: &MediumReport) -> String {
    if report.species.is_empty() {
        return String::new();
    }
    let mut text = "\nof each species, without the host\n      ".to_owned();
    let width = 11 * OF_SPECIES.len();
    report.species.iter().for_each(|species| {
        // Longer names would run into each other.
        let name: String = species.name.chars().take(width - 1).collect();
        text += &format!("{name:>width$}");
    });
    text += "\n      ";
    report.species.iter().for_each(|species| {
        text += &format!("{:>width$}", format!("{:.4e} of the volume", species.volume_fraction));
    });
    let _ = write!(text, "\n{:>6}", "nm");
    for _ in &report.species {
        OF_SPECIES.iter().for_each(|(key, ..)| text += &format!("{key:>11}"));
    }
    for (i, lambda) in report.wavelengths.iter().enumerate() {
        let _ = write!(text, "\n{lambda:>6}");
        for species in &report.species {
            OF_SPECIES.iter().for_each(|(_, _, values)| text += &cell(values(species)[i]));
        }
    }
    text + "\n"
}

fn colours(report: &MediumReport) -> String {
    let length = report.column.length;
    let mut text = format!(
        "\n{:<40}{:>10}{:>9}{:>9}  sRGB     as bright as can be\n",
        "colour of white light", "Y", "x", "y"
    );
    for (what, colour) in [
        (format!("straight through {length} m, exp(-sigma_t d)"), &report.column.straight),
        (format!("daylight in {length} m, exp(-K d)"), &report.column.diffuse),
        ("an endless depth from above, R".into(), &report.depth),
    ] {
        let Colour { luminance, x, y, srgb, srgb_bright } = colour;
        let _ = writeln!(text, "{what:<40}{luminance:>10.3e}{x:>9.4}{y:>9.4}  {srgb}  {srgb_bright}");
    }
    let middle = |lambda: &f64| (lambda - MIDDLE).abs();
    let nearest = report.wavelengths.iter().enumerate().min_by(|a, b| middle(a.1).total_cmp(&middle(b.1)));
    if let Some((i, lambda)) = nearest {
        let length =
            |rate: f64| if rate > 0.0 { format!("{} m", cell(1.0 / rate).trim()) } else { "no end".into() };
        let _ = writeln!(
            text,
            "at {lambda} nm light falls to 1/e within {} straight on (1 / sigma_t), daylight within {} (1 / K)",
            length(report.sigma_t[i]),
            length(report.diffuse_attenuation[i])
        );
    }
    if !report.species.is_empty() {
        let _ = writeln!(text, "integrals over radius are off by {:.1e} at most", report.quadrature_error);
    }
    text
}

/// Columns of two media and what the second has over the first.
pub fn of_both(comparison: &Comparison) -> String {
    let Comparison { a, b } = comparison;
    let mut text = format!("A {}, B {}; coefficients in 1/m\n", a.medium, b.medium);
    for quantities in QUANTITIES[1..].chunks(3) {
        let _ = write!(text, "{:>6}", "nm");
        for quantity in quantities {
            let symbol = quantity.symbol;
            text += &format!("{:>12}{:>11}{:>9}", format!("{symbol} A"), "B", "B/A");
        }
        for (i, lambda) in a.wavelengths.iter().enumerate() {
            let _ = write!(text, "\n{lambda:>6}");
            for quantity in quantities {
                let [of_a, of_b] = [a, b].map(|report| (quantity.values)(report)[i]);
                text += &format!(" {}{}{:>9}", cell(of_a), cell(of_b), quotient(of_b / of_a));
            }
        }
        text += "\n\n";
    }
    for (name, report) in [("A", a), ("B", b)] {
        text += &format!("{name}: {}{}\n", report.medium, colours(report));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_keep_to_their_column() {
        for (ratio, shown) in [
            (1.25, "1.2500"),
            (0.0, "0.0000"),
            (998.99999, "999.0000"),
            (1412.5671, "1.41e3"),
            (3.2e-7, "3.20e-7"),
            (f64::NAN, "-"),
            (f64::INFINITY, "-"),
        ] {
            assert_eq!(quotient(ratio), shown);
        }
    }
}

use super::*;
use crate::optics::density::Density;
use crate::optics::particles::{Cache, Host, SizeDistribution, Species};
use crate::optics::phase::{Isotropic, PhaseFunction};
use crate::spectrum::{LaneCurve, Spectrum};
use crate::study::plot::parsed;

/// Water with two kinds of small grains.
fn mixture() -> Mixture {
    let species = |name: &str, n: f32, median: f64| Species {
        name: name.into(),
        index: RefractiveIndex::Constant(n),
        sizes: SizeDistribution::LogNormal { median, deviation: 0.2 },
        volume_fraction: 1e-6,
    };
    let absorption = Spectrum::Table { wavelengths: vec![380.0, 780.0], values: vec![0.05, 2.0] };
    Mixture {
        host: Host { index: RefractiveIndex::Constant(1.33), absorption, molecular: None },
        species: vec![species("clay, fine", 1.58, 2e-7), species("algae", 1.41, 5e-7)],
    }
}

fn study(name: &str, subject: Subject, wavelengths: &[f64]) -> MediumStudy {
    let warnings = vec!["temperature = -20: extrapolated".into()];
    MediumStudy { name: name.into(), subject, warnings, wavelengths: wavelengths.to_vec(), column: 10.0 }
}

fn of_mixture(wavelengths: &[f64]) -> MediumReport {
    let subject = Subject::Mixture { mixture: mixture(), one_lobe: false };
    study("<muddy> & \"clear\"", subject, wavelengths).run(&Cache::off()).unwrap()
}

/// A medium as a scene file gives it: white scattering, blue gets farthest.
fn given(wavelengths: &[f64]) -> MediumReport {
    let medium = Medium {
        name: "sea".into(),
        n: 1.33,
        index: LaneCurve::Constant(1.33),
        sigma_a: LaneCurve::sampled(|lambda| if lambda < 500.0 { 0.02 } else { 0.3 }),
        sigma_s: LaneCurve::Constant(0.5),
        emission: LaneCurve::Constant(0.0),
        phase: PhaseFunction::Isotropic(Isotropic).into(),
        density: Density::default(),
    };
    let subject = Subject::Given { index: RefractiveIndex::Constant(1.33), medium: Box::new(medium) };
    study("sea", subject, wavelengths).run(&Cache::off()).unwrap()
}

/// Numbers are written with all their digits; the reader of this test rounds the last one.
fn same(read: &[f64], expected: &[f64]) -> bool {
    read.len() == expected.len()
        && read.iter().zip(expected).all(|(a, b)| (a - b).abs() <= f64::EPSILON * b.abs())
}

#[test]
fn coefficients_are_those_of_the_mixture_in_every_digit() {
    // The first are among those that scattering is kept at; the others are not.
    for wavelengths in [&[380.0, 580.0][..], &[401.5, 550.0, 700.0]] {
        let (report, bulk) = (of_mixture(wavelengths), mixture().bulk(wavelengths).unwrap());
        let value: serde_json::Value = serde_json::from_str(&report.json(false)).unwrap();
        let list = |value: &serde_json::Value| -> Vec<f64> {
            value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
        };
        for (key, expected) in [
            ("wavelengths", &bulk.wavelengths),
            ("n", &bulk.n),
            ("sigma_a", &bulk.sigma_a),
            ("sigma_s", &bulk.sigma_s),
            ("g", &bulk.g),
        ] {
            assert!(same(&list(&value[key]), expected), "{key}");
        }
        for (i, species) in bulk.species.iter().enumerate() {
            let told = &value["species"][i];
            assert_eq!(told["name"], species.name.as_str());
            assert!(same(&list(&told["sigma_t"]), &species.sigma_t) && same(&list(&told["g"]), &species.g));
        }
        for (i, t) in report.sigma_t.iter().enumerate() {
            assert_eq!(*t, report.sigma_a[i] + report.sigma_s[i]);
            assert_eq!(report.albedo[i], report.sigma_s[i] / t);
            assert_eq!(report.reduced_sigma_s[i], report.sigma_s[i] * (1.0 - report.g[i]));
        }
        assert!(value.get("phase").is_none() && value["warnings"][0].as_str().unwrap().contains("-20"));
    }
}

#[test]
fn the_phase_function_is_told_where_it_is_asked_for() {
    let report = of_mixture(&[550.0]);
    let value: serde_json::Value = serde_json::from_str(&report.json(true)).unwrap();
    let phase = &value["phase"];
    let angles = phase["angles"].as_array().unwrap();
    assert_eq!((angles[0].as_f64(), angles[angles.len() - 1].as_f64()), (Some(0.0), Some(180.0)));
    assert_eq!(phase["values"].as_array().unwrap().len(), report.phase.wavelengths.len());
    assert!(same(&[phase["values"][0][7].as_f64().unwrap()], &report.phase.values[0][7..8]));
}

/// The cells of a file, whose heads may be quoted.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut is_quoted) = (vec![String::new()], false);
    for letter in line.chars() {
        match letter {
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(String::new()),
            _ => cells.last_mut().unwrap().push(letter),
        }
    }
    cells
}

#[test]
fn files_hold_every_bit() {
    let report = of_mixture(&[400.0, 550.0, 700.0]);
    let text = csv::coefficients(&report);
    let lines: Vec<Vec<String>> = text.lines().map(cells).collect();
    assert_eq!(lines.len(), 4);
    assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{text}");
    let column = |head: &str| -> Vec<f64> {
        let place =
            lines[0].iter().position(|other| other == head).unwrap_or_else(|| panic!("{head}: {text}"));
        lines[1..].iter().map(|line| line[place].parse().unwrap()).collect()
    };
    assert_eq!(column("wavelength_nm"), report.wavelengths);
    assert_eq!(column("sigma_a_per_m"), report.sigma_a);
    assert_eq!(column("reduced_sigma_s_per_m"), report.reduced_sigma_s);
    assert_eq!(column("clay, fine sigma_s_per_m"), report.species[0].sigma_s);
    assert_eq!(column("algae g"), report.species[1].g);
    let text = csv::phase(&report);
    assert!(text.starts_with("angle_degrees,p_per_sr_at_380_nm,"), "{text}");
    let row = text.lines().nth(8).unwrap().split(',').map(|cell| cell.parse::<f64>().unwrap());
    let phase = &report.phase;
    let expected = [phase.angles[7].to_degrees()].into_iter().chain(phase.values.iter().map(|v| v[7]));
    assert!(row.eq(expected));
}

#[test]
fn both_media_stand_beside_each_other() {
    let wavelengths = [400.0, 600.0];
    let both = Comparison { a: of_mixture(&wavelengths), b: given(&wavelengths) };
    let value: serde_json::Value = serde_json::from_str(&both.json(false)).unwrap();
    let ratio = both.b.sigma_s[1] / both.a.sigma_s[1];
    assert!(same(&[value["b_over_a"]["sigma_s"][1].as_f64().unwrap()], &[ratio]));
    assert_eq!(
        (&value["a"]["medium"], &value["b"]["medium"]),
        (&both.a.medium.as_str().into(), &"sea".into())
    );
    let turned = Comparison { a: both.b.clone(), b: both.a.clone() };
    let value: serde_json::Value = serde_json::from_str(&turned.json(false)).unwrap();
    assert!(value["b_over_a"]["g"][0].is_null(), "g of the first is 0");
    let text = csv::both(&both);
    assert!(text.contains(",a_sigma_s_per_m,") && text.contains(",b_sigma_s_per_m,"), "{text}");
    assert!(text.lines().nth(2).unwrap().contains(&format!(",{ratio},")), "{text}");
    assert_eq!(text.lines().next().unwrap().matches("wavelength_nm").count(), 1);
    let text = text::of_both(&both);
    assert!(text.contains(&format!("{ratio:.4}")) && text.contains("B: sea"), "{text}");
}

#[test]
fn a_given_medium_is_as_its_curves_are() {
    let report = given(&[450.0, 600.0]);
    assert!((report.sigma_a[0] - 0.02).abs() < 1e-8 && (report.sigma_a[1] - 0.3).abs() < 1e-7);
    assert_eq!((report.g[0], report.backscattering.len(), report.species.len()), (0.0, 2, 0));
    // Values are f32.
    assert!((report.backscattering[0] - 0.25).abs() < 1e-6);
    assert_eq!(report.quadrature_error, 0.0);
    // What is bluer than white lies at smaller x and y.
    for colour in [&report.column.straight, &report.column.diffuse, &report.depth] {
        assert!(colour.x < 0.3 && colour.luminance < 0.6, "{colour:?}");
    }
    // exp(-0.52 x 10) is what is left of the best.
    assert!(report.column.straight.luminance < 0.0056, "{report:?}");
    assert!(report.column.diffuse.luminance > report.column.straight.luminance);
}

#[test]
fn tables_have_straight_columns() {
    let text = text::of(&of_mixture(&[400.0, 550.0]));
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[1..4].iter().all(|line| line.len() == lines[1].len()), "{text}");
    assert!(lines[6..10].iter().all(|line| line.len() == lines[6].len()), "{text}");
    for words in ["clay, fine", "straight through 10 m", "an endless depth", "at 550 nm", "off by"] {
        assert!(text.contains(words), "{words} of {text}");
    }
}

#[test]
fn diagrams_are_well_formed_and_always_the_same() {
    let (a, b) = (of_mixture(&[400.0, 550.0, 700.0]), given(&[400.0, 550.0, 700.0]));
    for (reports, curves) in [(vec![&a], [4, 3, 3, 3]), (vec![&a, &b], [8, 6, 6, 6])] {
        let diagrams = diagrams::all(&reports);
        assert_eq!(diagrams, diagrams::all(&reports));
        assert_eq!(diagrams.len(), 4);
        for ((name, svg), curves) in diagrams.iter().zip(curves) {
            let (_, texts) = parsed(svg);
            assert!(texts.iter().any(|text| text.contains("muddy")), "{name}: {texts:?}");
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
            // A line with its name each.
            assert_eq!(svg.matches("stroke-width=\"1.6\"").count(), 2 * curves, "{name}: {svg}");
            let dashed = svg.matches("stroke-dasharray=\"5 3\"").count();
            assert_eq!(dashed, if reports.len() > 1 { curves } else { 0 }, "{name}");
        }
        let page = diagrams::html("<a>", &diagrams, "1 < 2");
        assert!(
            page.contains("<title>&lt;a&gt;</title>")
                && page.contains("1 &lt; 2")
                && page.matches("<svg").count() == 4
        );
    }
}

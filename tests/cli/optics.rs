//! `floe optics`

use super::*;

#[test]
fn a_sphere_is_printed_with_17_digits() {
    let folder = Folder::new();
    let sphere =
        |more: &[&str]| floe(&folder, &[&["optics", "sphere", "--m", "1.5+1i", "--x", "100"], more].concat());
    let text = sphere(&[]).ended(0).stdout;
    let json: serde_json::Value = serde_json::from_str(&sphere(&["--json"]).ended(0).stdout).unwrap();
    for (label, key, expected) in [
        ("Qext", "qext", 2.0975017556062),
        ("Qsca", "qsca", 1.2836970493733477),
        ("Qback", "qback", 0.17242143940279012),
        ("g", "g", 0.8502519976527821),
    ] {
        let line = text.lines().find(|line| line.split(' ').next() == Some(label)).unwrap();
        let number = line.rsplit(' ').next().unwrap();
        assert_eq!(number.split('e').next().unwrap().len(), 18, "{line}");
        let value: f64 = number.parse().unwrap();
        assert_eq!(json[key].as_f64(), Some(value), "{key}");
        assert!((value / expected - 1.0).abs() < 1e-9, "{label}: {value} is not {expected}");
    }
    assert_eq!(
        (json["m"][0].as_f64(), json["m"][1].as_f64(), json["x"].as_f64()),
        (Some(1.5), Some(1.0), Some(100.0))
    );
}

#[test]
fn spheres_that_cannot_be_are_usage_errors() {
    let folder = Folder::new();
    for (m, x, says) in [
        ("1.5-1i", "1", "n + ik with k >= 0 absorbs"),
        ("0", "1", "must be above 0"),
        ("water", "1", "no complex number such as 1.33 or 1.5+0.1i"),
        ("1.5", "0", "must be above 0"),
        ("1.5", "-3", "must be above 0"),
        ("1.5", "nan", "must be above 0"),
        ("1.5", "2e6", "geometrical optics"),
    ] {
        let refused = floe(&folder, &["optics", "sphere", "--m", m, "--x", x]).ended(2);
        assert!(refused.stderr.contains(says) && refused.stdout.is_empty(), "{m} {x}: {refused:#?}");
    }
}

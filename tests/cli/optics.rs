//! `floe optics`

use floe::optics::water::natural::PRESETS;

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
        ("1.5", "inf", "and finite"),
        ("1.5", "1e-30", "from 1e-20 on"),
        ("1.5", "2e6", "the size parameter is 2000000 in the host and 3000000 by the sphere's own index"),
        ("1.5", "2e6", "geometrical optics; take a smaller radius"),
    ] {
        let refused = floe(&folder, &["optics", "sphere", "--m", m, "--x", x]).ended(2);
        assert!(refused.stderr.contains(says) && refused.stdout.is_empty(), "{m} {x}: {refused:#?}");
    }
}

/// Blanks around an index do no harm; a sphere of its host's index scatters nothing, and g is a number all the same.
#[test]
fn a_sphere_of_nothing_is_printed() {
    let folder = Folder::new();
    let found = floe(&folder, &["optics", "sphere", "--m", " 1+0i ", "--x", "1", "--json"]).ended(0);
    let value = json(&found);
    for key in ["qext", "qsca", "qback", "g"] {
        assert_eq!(value[key].as_f64(), Some(0.0), "{value}");
    }
}

fn json(outcome: &Outcome) -> serde_json::Value {
    serde_json::from_str(&outcome.stdout).unwrap_or_else(|error| panic!("{error}: {outcome:#?}"))
}

/// Numbers have all their digits; the reader of this test rounds the last one.
fn assert_same(read: &serde_json::Value, expected: &[f64]) {
    let read: Vec<f64> = read.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect();
    let are_same = |(a, b): (&f64, &f64)| (a - b).abs() <= f64::EPSILON * b.abs();
    assert!(
        read.len() == expected.len() && read.iter().zip(expected).all(are_same),
        "{read:?} is not {expected:?}"
    );
}

#[test]
fn a_preset_is_what_its_mixture_does() {
    let folder = Folder::new();
    let wavelengths = [450.0, 550.0, 651.5];
    let found =
        floe(&folder, &["optics", "mediterranean", "--wavelengths", "450,550,651.5", "--json"]).ended(0);
    let value = json(&found);
    let (_, water) = PRESETS.into_iter().find(|(name, _)| *name == "mediterranean").unwrap();
    let bulk = water.mixture().bulk(&wavelengths).unwrap();
    assert_eq!(value["medium"], "mediterranean");
    for (key, expected) in
        [("n", &bulk.n), ("sigma_a", &bulk.sigma_a), ("sigma_s", &bulk.sigma_s), ("g", &bulk.g)]
    {
        assert_same(&value[key], expected);
    }
    assert_eq!(value["species"].as_array().unwrap().len(), bulk.species.len());
    assert_same(&value["species"][1]["sigma_t"], &bulk.species[1].sigma_t);
    assert_eq!(value["species"][1]["volume_fraction"].as_f64(), Some(water.algae));
    assert!(value.get("phase").is_none());
    // Clear blue water: what comes from its depth is bluer than white.
    assert!(value["depth"]["x"].as_f64().unwrap() < 0.25, "{value}");
    let keys: Vec<&String> = value.as_object().unwrap().keys().collect();
    let mut documented = [
        "medium",
        "wavelengths",
        "n",
        "sigma_a",
        "sigma_s",
        "sigma_t",
        "albedo",
        "g",
        "reduced_sigma_s",
        "backscattering",
        "diffuse_attenuation",
        "reflectance",
        "species",
        "quadrature_error",
        "column",
        "depth",
        "warnings",
    ];
    documented.sort_unstable();
    assert_eq!(keys, documented);
}

#[test]
fn settings_change_a_preset_and_another_medium_stands_beside_it() {
    let folder = Folder::new();
    let both = ["optics", "atlantic", "--set", "cdom=0.5", "--compare", "atlantic", "--wavelengths", "440"];
    let value = json(&floe(&folder, &[&both[..], &["--json"]].concat()).ended(0));
    let at = |which: &str| value[which]["sigma_a"][0].as_f64().unwrap();
    // Single precision of what the host absorbs.
    assert!((at("a") - at("b") - 0.5).abs() < 1e-6, "{value}");
    assert_eq!(value["a"]["medium"], "atlantic, cdom=0.5");
    assert!((value["b_over_a"]["sigma_a"][0].as_f64().unwrap() - at("b") / at("a")).abs() < 1e-15);
    let text = floe(&folder, &both).ended(0).stdout;
    assert!(text.starts_with("A atlantic, cdom=0.5, B atlantic; ") && text.contains("B/A"), "{text}");
}

#[test]
fn tables_name_what_they_show_and_how_long_it_took() {
    let folder = Folder::new();
    let found = floe(&folder, &["optics", "iceberg", "--set", "temperature=-40", "--column", "0.5"]).ended(0);
    for words in ["iceberg, temperature=-40; ", "sigma_s'", "air", "straight through 0.5 m", "computed in "] {
        assert!(found.stdout.contains(words), "no \"{words}\" in {}", found.stdout);
    }
    // 21 wavelengths in two tables, each under a line of heads.
    assert_eq!(found.stdout.lines().filter(|line| line.starts_with("   580 ")).count(), 2, "{found:#?}");
    found.says(&[
        "warning: iceberg, temperature=-40: temperature = -40: what ice encloses is known from -30 to 0",
    ]);
}

#[test]
fn everything_is_written_into_a_folder_the_same_each_time() {
    let folder = Folder::new();
    for output in ["a", "b"] {
        let found =
            floe(&folder, &["optics", "skimmed", "--output", output, "--csv", &format!("{output}.csv")])
                .ended(0);
        assert!(found.stderr.is_empty(), "{found:#?}");
    }
    let mut names = Vec::new();
    for name in folder.files().iter().filter_map(|name| name.strip_prefix("a/")) {
        let (first, second) = (folder.read(&format!("a/{name}")), folder.read(&format!("b/{name}")));
        assert!(first == second, "{name}");
        let text = String::from_utf8(first).unwrap();
        assert!(!text.contains("computed in") && !text.contains("NaN"), "{name}");
        names.push(name.to_owned());
    }
    names.sort();
    assert_eq!(
        names,
        [
            "albedo.svg",
            "coefficients.svg",
            "optics.csv",
            "optics.html",
            "optics.json",
            "phase.csv",
            "phase.svg",
            "phase_polar.svg"
        ]
    );
    assert_eq!(folder.read("a.csv"), folder.read("a/optics.csv"));
    let page = String::from_utf8(folder.read("a/optics.html")).unwrap();
    assert!(
        page.matches("<svg").count() == 4 && page.contains("sigma_t") && !page.contains("href"),
        "{page}"
    );
    folder.write("taken", "");
    floe(&folder, &["optics", "skimmed", "--csv", "taken/a.csv"]).ended(73).says(&["taken"]);
}

#[test]
fn media_of_scene_files_are_shown() {
    let folder = boxes(
        1,
        "[media.milk]\nmodel = \"milk\"\npreset = \"skimmed\"\n[media.ice]\nior = 1.31\nabsorption = 0.1\nscattering = 2\nphase = { kind = \"henyey-greenstein\", g = 0.5 }\n",
    );
    let show = |medium: &str| {
        json(&floe(&folder, &["optics", medium, "--json", "--wavelengths", "500,600"]).ended(0))
    };
    for medium in ["boxes:ice", "boxes/scene.toml:ice"] {
        let value = show(medium);
        assert_eq!((&value["medium"], &value["sigma_s"][1]), (&medium.into(), &2.0.into()));
        assert!((value["sigma_a"][0].as_f64().unwrap() - 0.1).abs() < 1e-8, "{value}");
        assert_eq!((&value["g"][0], &value["reduced_sigma_s"][0]), (&0.5.into(), &1.0.into()));
    }
    let preset = json(&floe(&folder, &["optics", "skimmed", "--json", "--wavelengths", "500,600"]).ended(0));
    assert_eq!(show("boxes:milk")["sigma_s"], preset["sigma_s"]);
    // Red is absorbed most.
    let water = show("boxes:water");
    assert!(water["sigma_a"][1].as_f64() > water["sigma_a"][0].as_f64(), "{water}");
    floe(&folder, &["optics", "boxes:ic"]).ended(2).says(&["has no medium `ic`", "did you mean `ice`?"]);
    floe(&folder, &["optics", "boxes:ice", "--set", "g=1"]).ended(2).says(&["changed in the scene file"]);
    floe(&folder, &["optics", "no/scene.toml:ice"]).ended(66).says(&["no/scene.toml"]);
    folder.write("bad/scene.toml", "[media.ice]\nscatering = 2\n");
    floe(&folder, &["optics", "bad:ice"]).ended(78).says(&["scene.toml:2:1", "scattering"]);
}

#[test]
fn media_that_are_not_there_are_told_with_those_that_are() {
    let folder = Folder::new();
    let everything =
        ["natural-water", "baltic", "iceberg", "bubbly", "milk", "whole", "particles", "SCENE:NAME"];
    floe(&folder, &["optics"]).ended(2).says(&everything).says(&["name a medium"]);
    let refused = floe(&folder, &["optics", "batlic"]).ended(2).says(&everything);
    assert!(
        refused.stdout.is_empty() && refused.stderr.contains("no medium `batlic`: did you mean `baltic`?")
    );
    floe(&folder, &["optics", "xyzzy"]).ended(2).says(&["no medium `xyzzy`: There are"]);
    floe(&folder, &["optics", "baltic", "--compare", "mlk"]).ended(2).says(&["did you mean `milk`?"]);
    floe(&folder, &["optics", "--help"]).ended(0);
}

#[test]
fn settings_and_wavelengths_that_cannot_be_are_usage_errors() {
    let folder = Folder::new();
    for (settings, says) in [
        (&["mineral=-1"][..], "--set:1:9: baltic.mineral: -1: write a share of the volume from 0 to 1"),
        (&["cdom=1", "minerl=1e-6"], "--set:2:1: unknown key `minerl` in [baltic]; did you mean `mineral`?"),
        (&["temperature=cold"], "--set:1:13: baltic.temperature: \"cold\": write a temperature"),
        (&["algae="], "--set:1:"),
        (&["algae"], "--set algae: write a key and a value"),
        (&["algae=0.9", "mineral=0.9"], "there is room for 1"),
        (&["scattering=1"], "\"natural-water\" computes this"),
    ] {
        let settings: Vec<&str> = settings.iter().flat_map(|setting| ["--set", setting]).collect();
        let refused = floe(&folder, &[&["optics", "baltic"], &settings[..]].concat()).ended(2).says(&[says]);
        assert!(refused.stdout.is_empty(), "{refused:#?}");
    }
    floe(&folder, &["optics", "particles"]).ended(2).says(&["[particles] has no `ior`"]);
    for (list, says) in [
        ("700,400", "in rising order"),
        ("400..900:50", "800 nm is not between 380 and 780 nm"),
        ("blue", "nanometres such as 400,550,700"),
    ] {
        floe(&folder, &["optics", "baltic", "--wavelengths", list]).ended(2).says(&[says]);
    }
    floe(&folder, &["optics", "baltic", "--column", "-1"]).ended(2).says(&["metres above 0"]);
    floe(&folder, &["optics", "baltic", "--phase"]).ended(2).says(&["--json"]);
}

#[test]
fn only_the_line_of_the_time_tells_what_the_cache_had() {
    let folder = Folder::new();
    let run = |cache: &str, more: &[&str]| {
        let output =
            command(&folder, &[&["optics", "skimmed"], more].concat()).env("FLOE_CACHE", cache).output();
        String::from_utf8(output.unwrap().stdout).unwrap()
    };
    let tables = |text: &str| text.split("computed in ").next().unwrap().to_owned();
    let [first, again, off] = ["cache", "cache", "off"].map(|cache| run(cache, &[]));
    let kept = "with scattering from the cache";
    assert!(!first.contains(kept) && again.contains(kept) && !off.contains(kept), "{first}{again}{off}");
    assert!(tables(&first) == tables(&again) && tables(&first) == tables(&off), "{first}{again}{off}");
    let [kept, computed] = ["cache", "off"].map(|cache| run(cache, &["--json", "--phase"]));
    assert!(kept == computed && kept.contains("\"phase\""));
}

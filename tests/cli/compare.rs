//! `floe compare`.

use super::*;

const SMALL: &str = "[camera]\neye = [0.4, -4, 0.9]\ntarget = [0, 0, 0]\nvertical_fov = 40\nresolution = [48, 27]\n\
                     [render]\nsamples = 16\n[output]\naovs = [\"variance\"]\n";

/// `boxes` with small pictures that have their variance.
fn noisy_boxes(frames: u32) -> Folder {
    boxes(frames, SMALL)
}

fn render(folder: &Folder, more: &[&str]) {
    floe(folder, &[&["render", "boxes", "-q"], more].concat()).ended(0);
}

/// Another scene in the same place: water that absorbs more green, by a part of it.
fn darken(folder: &Folder, green: f64) {
    let text = String::from_utf8(folder.read("boxes/scene.toml")).unwrap();
    let darker = text.replace("[0.35, 0.07, 0.03]", &format!("[0.35, {}, 0.03]", 0.07 * (1.0 + green)));
    assert_ne!(darker, text);
    folder.write("boxes/scene.toml", darker);
}

#[test]
fn identical_pictures_are_identical_with_or_without_variance() {
    let folder = boxes(1, "");
    render(&folder, &["-o", "a.exr"]);
    render(&folder, &["-o", "b.exr", "--threads", "1"]);
    let outcome = floe(&folder, &["compare", "a.exr", "b.exr"]).ended(0);
    assert!(outcome.stderr.is_empty() && outcome.stdout.ends_with("\nidentical\n"), "{outcome:#?}");
    for words in ["size       16 x 9 pixels", "relMSE     0.0000e0", "FLIP       0.00000", "z-test     none"]
    {
        assert!(outcome.stdout.contains(words), "no \"{words}\" in {outcome:#?}");
    }
}

#[test]
fn other_seeds_are_within_noise_and_another_absorption_is_not() {
    let folder = noisy_boxes(1);
    render(&folder, &["-o", "a.exr"]);
    render(&folder, &["-o", "b.exr", "--seed", "1"]);
    let outcome = floe(&folder, &["compare", "a.exr", "b.exr"]).ended(0);
    assert!(outcome.stdout.ends_with("\nwithin noise\n"), "{outcome:#?}");
    darken(&folder, 3.0);
    render(&folder, &["-o", "dark.exr"]);
    let outcome = floe(&folder, &["compare", "dark.exr", "b.exr"]).ended(1);
    let last = outcome.stdout.lines().last().unwrap();
    assert!(
        last.starts_with("different: more than noise: p = ") && last.contains(" G of the "),
        "{outcome:#?}"
    );
    // The candidate is the darker one, and where it differs is said.
    let line = outcome.stdout.lines().find(|line| line.starts_with("difference ")).unwrap();
    assert!(line.contains(" -"), "{outcome:#?}");
    assert!(outcome.stdout.contains("\ngreatest   at ("), "{outcome:#?}");
}

#[test]
fn without_variance_only_limits_allow_for_a_difference() {
    let folder = boxes(1, "");
    render(&folder, &["-o", "a.exr"]);
    render(&folder, &["-o", "b.exr", "--seed", "1"]);
    let compare = |more: &[&str]| floe(&folder, &[&["compare", "a.exr", "b.exr"], more].concat());
    let outcome = compare(&[]).ended(1);
    assert!(
        outcome.stdout.contains("aovs = [\"variance\"]") && outcome.stdout.contains("--max-relmse"),
        "{outcome:#?}"
    );
    assert!(compare(&["--max-relmse", "1"]).ended(0).stdout.ends_with("\nwithin the limits\n"));
    assert!(
        compare(&["--max-flip", "0.5", "--max-relmse", "1"]).ended(0).stdout.contains("within the limits")
    );
    assert!(compare(&["--max-relmse", "1e-9"]).ended(1).stdout.contains("relMSE "));
    assert!(compare(&["--max-flip", "0", "--max-relmse", "1"]).ended(1).stdout.contains("FLIP "));
    assert!(compare(&["--max-relmse", "1", "--significance", "0.01"]).ended(1).stdout.contains("no z-test"));
}

#[test]
fn frames_of_sequences_are_matched_by_number_and_missing_ones_named() {
    let folder = noisy_boxes(3);
    render(&folder, &["-o", "a/frame_####.exr", "--frames", "1-2"]);
    render(&folder, &["-o", "b/shot.#.exr", "--frames", "2-3", "--seed", "1"]);
    for b in ["b", "b/shot.#.exr"] {
        let outcome = floe(&folder, &["compare", "a", b]).ended(66).says(&["not in A: 3", "not in B: 1"]);
        let lines: Vec<&str> = outcome.stdout.lines().collect();
        assert!(lines[0].starts_with("frame ") && lines[0].ends_with(" verdict"), "{lines:?}");
        assert!(lines[1].starts_with("2 ") && lines[1].ends_with("  within noise"), "{lines:?}");
        assert_eq!(lines[2..], ["not in A: 3", "not in B: 1"]);
    }
    // A bad picture takes none of the others with it.
    folder.write("b/shot.3.exr", "no picture");
    render(&folder, &["-o", "a/frame_####.exr", "--frames", "3"]);
    std::fs::remove_file(folder.path("a/frame_0001.exr")).unwrap();
    let outcome = floe(&folder, &["compare", "a", "b"]).ended(65).says(&["error: frame 3: ", "shot.3.exr"]);
    assert!(outcome.stdout.contains("within noise") && outcome.stdout.contains("\n3 "), "{outcome:#?}");
}

#[test]
fn json_has_all_that_was_found() {
    let folder = noisy_boxes(2);
    render(&folder, &["-o", "a/frame_####.exr"]);
    render(&folder, &["-o", "b/frame_####.exr", "--seed", "1", "--frames", "1"]);
    darken(&folder, 20.0);
    render(&folder, &["-o", "b/frame_####.exr", "--frames", "2"]);
    let outcome = floe(&folder, &["compare", "a", "b", "--json"]).ended(1);
    let found: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    assert_eq!((&found["differs"], &found["not_in_a"]), (&true.into(), &"".into()));
    let frames = found["frames"].as_array().unwrap();
    assert_eq!(frames.iter().map(|f| f["frame"].as_str().unwrap()).collect::<Vec<_>>(), ["1", "2"]);
    assert_eq!(
        frames.iter().map(|f| f["verdict"].as_str().unwrap()).collect::<Vec<_>>(),
        ["within_noise", "different"]
    );
    for key in
        ["relmse", "rmse", "flip", "relative_difference", "means", "greatest", "z_test", "size", "identical"]
    {
        assert!(!frames[0][key].is_null(), "no {key} in {outcome:#?}");
    }
    let p = |frame: usize| frames[frame]["z_test"]["p"].as_f64().unwrap();
    assert!(p(0) > 0.0005 && p(1) < 1e-6, "{outcome:#?}");
    assert!(frames[1]["reasons"][0].as_str().unwrap().starts_with("more than noise"), "{outcome:#?}");
}

#[test]
fn differences_are_shown_as_colours_and_as_numbers() {
    let folder = noisy_boxes(1);
    render(&folder, &["-o", "a.exr"]);
    darken(&folder, 20.0);
    render(&folder, &["-o", "b.exr"]);
    floe(&folder, &["compare", "a.exr", "b.exr", "--difference", "new/d.png"]).ended(1);
    let png = image::load_from_memory(&folder.read("new/d.png")).unwrap().into_rgb8();
    assert_eq!(png.dimensions(), (48, 27));
    // Magma begins with nearly black: of the sky in the corner, and not of the box in the middle.
    assert_eq!(png.get_pixel(0, 0).0, [0, 0, 4]);
    assert!(png.get_pixel(24, 13).0[0] > 20, "{:?}", png.get_pixel(24, 13));
    floe(&folder, &["compare", "a.exr", "b.exr", "--difference", "d.exr"]).ended(1);
    let exr = floe::film::exr_layers::read_layers(&folder.read("d.exr")).unwrap();
    let [a, b] = ["a.exr", "b.exr"].map(|f| floe::film::exr_layers::read_layers(&folder.read(f)).unwrap());
    let middle = 13 * 48 + 24;
    assert_eq!(exr.colours[middle], a.colours[middle] - b.colours[middle]);
    assert!(exr.colours[middle].y > 0.0);
    // Of sequences each frame has its own.
    render(&folder, &["-o", "c/frame_####.exr"]);
    floe(&folder, &["compare", "c", "c", "--difference", "same_##.png"]).ended(0);
    assert!(folder.files().contains(&"same_01.png".to_owned()));
}

#[test]
fn what_cannot_be_compared_says_why() {
    let folder = noisy_boxes(2);
    render(&folder, &["-o", "a/frame_####.exr"]);
    let text = String::from_utf8(folder.read("boxes/scene.toml")).unwrap();
    folder.write("boxes/scene.toml", text.replace("[48, 27]", "[16, 9]"));
    render(&folder, &["-o", "small/frame_####.exr", "--frames", "1"]);
    let a = "a/frame_0001.exr";
    let compare = |a: &str, b: &str, more: &[&str]| floe(&folder, &[&["compare", a, b], more].concat());
    compare(a, "small/frame_0001.exr", &[]).ended(65).says(&[
        "has 48 x 27 pixels",
        "has 16 x 9",
        "one resolution",
    ]);
    compare(a, "nothing.exr", &[]).ended(66).says(&["nothing.exr", "no such picture"]);
    compare("a", "empty_####.exr", &[]).ended(66).says(&["empty_####.exr", "no pictures"]);
    std::fs::create_dir(folder.path("empty")).unwrap();
    compare("empty", "a", &[]).ended(66).says(&["empty", "no pictures"]);
    compare("a", a, &[]).ended(2).says(&["a is a folder", "a/frame_0001.exr is one picture"]);
    compare(a, a, &["--difference", "d.jpg"]).ended(2).says(&[".png or .exr"]);
    compare(a, a, &["--significance", "2"]).ended(2).says(&["between 0 and 1"]);
    compare(a, a, &["--max-relmse", "-1"]).ended(2);
    compare(a, a, &["--max-flip", "NaN"]).ended(2).says(&["not negative"]);
    compare("a", "a", &["--difference", "d.png"]).ended(2).says(&["d_####.png"]);
    folder.write("file", "");
    compare(a, a, &["--difference", "file/d.png"]).ended(73).says(&["file"]);
    std::fs::create_dir(folder.path("d.png")).unwrap();
    compare(a, a, &["--difference", "d.png"]).ended(74).says(&["d.png", "cannot write"]);
    let whole = folder.read(a);
    folder.write("cut.exr", &whole[..whole.len() - 7]);
    compare(a, "cut.exr", &[]).ended(65).says(&["cut.exr", "cut short"]);
    folder.write("changed.exr", [&whole[..whole.len() - 7], &[1; 7]].concat());
    compare("changed.exr", a, &[]).ended(65).says(&["changed.exr", "checksum"]);
    compare(a, "boxes/scene.toml", &[]).ended(65).says(&["scene.toml"]);
    std::fs::rename(folder.path("a/frame_0002.exr"), folder.path("small/frame_0009.exr")).unwrap();
    std::fs::remove_file(folder.path("small/frame_0001.exr")).unwrap();
    compare("a", "small", &[]).ended(66).says(&["no frame in common", "1 and 9"]);
}

/// Pictures of photons share their noise between pixels.
#[test]
fn photons_have_no_z_test() {
    let folder = boxes(1, &SMALL.replace("samples = 16", "samples = 4\nintegrator = \"photon\""));
    render(&folder, &["-o", "a.exr"]);
    render(&folder, &["-o", "b.exr", "--seed", "1"]);
    let outcome = floe(&folder, &["compare", "a.exr", "b.exr"]).ended(1);
    assert!(outcome.stdout.contains("photons is shared"), "{outcome:#?}");
    floe(&folder, &["compare", "a.exr", "b.exr", "--max-relmse", "0.1"]).ended(0);
}

/// The commands of the README's workflow do what it says.
#[test]
fn the_workflow_of_the_readme_finds_a_changed_simulation() {
    let readme = include_str!("../../README.md");
    let workflow = readme.split("```yaml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let commands: Vec<Vec<&str>> = workflow
        .lines()
        .filter_map(|line| line.trim().strip_prefix("- run: floe "))
        .map(|command| command.split(' ').collect())
        .collect();
    let [render, compare] = &commands[..] else { panic!("{commands:?}") };
    let golden =
        readme.lines().find_map(|line| line.strip_prefix("floe render check --output golden")).unwrap();
    let golden: Vec<&str> = golden.split(' ').filter(|word| !word.is_empty()).collect();
    assert!(golden[0].starts_with('/'), "{golden:?}");

    let folder = noisy_boxes(2);
    std::fs::rename(folder.path("boxes"), folder.path("check")).unwrap();
    floe(&folder, &["render", "check", "--output", &format!("golden{}", golden[0])]).ended(0);
    floe(&folder, render).ended(0);
    let outcome = floe(&folder, compare).ended(0);
    assert!(outcome.stdout.contains("identical"), "{outcome:#?}");

    std::fs::rename(folder.path("check"), folder.path("boxes")).unwrap();
    darken(&folder, 20.0);
    std::fs::rename(folder.path("boxes"), folder.path("check")).unwrap();
    floe(&folder, render).ended(0);
    floe(&folder, compare).ended(1);
    let shown = folder
        .files()
        .into_iter()
        .find(|name| name.ends_with("0002.png") && !name.starts_with("out"))
        .unwrap();
    // What is uploaded on failure is there.
    let uploaded = workflow.split("if: failure()").nth(1).unwrap();
    assert!(uploaded.contains(shown.split('/').next().unwrap()), "{shown}");
}

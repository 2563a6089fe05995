//! What the README says is true of the code.

use std::path::Path;

use floe::accel::REBUILD_ABOVE;
use floe::scene::description::SceneDescription;

const README: &str = include_str!("../README.md");

/// The texts of scene files, and what a part of one needs besides to be whole.
#[test]
fn the_scene_files_of_the_readme_parse() {
    let texts = README.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    let media = "[media.sea]\n[media.ice]\n[media.snow]\n[media.glass]\n";
    let whole =
        texts.map(|text| if text.contains("[[meshes]]") { format!("{text}\n{media}") } else { text.into() });
    let scenes: Vec<SceneDescription> = whole
        .map(|text| SceneDescription::parse(&text, Path::new("README.md")).unwrap_or_else(|e| panic!("{e}")))
        .collect();
    assert_eq!(scenes.iter().map(|scene| scene.meshes.len()).max(), Some(3));
    assert_eq!(scenes[1].camera.keys.len(), 2);
}

#[test]
fn the_test_command_of_the_readme_is_what_the_checks_run() {
    let command = "cargo test --release";
    assert!(README.contains(command));
    assert!(include_str!("../.ci/run").lines().any(|line| line == command));
}

#[test]
fn every_file_that_the_readme_names_is_there() {
    let pictures = README.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    for path in pictures.chain(["sequences/iceberg", "LICENSE-MIT", "LICENSE-APACHE", "src/references.md"]) {
        assert!(Path::new(path).exists(), "{path}");
    }
}

#[test]
fn the_cost_above_which_hierarchies_are_rebuilt_is_that_of_the_code() {
    let claim = format!("`cost_ratio` {REBUILD_ABOVE};");
    assert!(README.contains(&claim), "{claim}");
}

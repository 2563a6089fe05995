//! What the README says is true of the code.

use std::path::Path;

use floe::accel::REBUILD_ABOVE;
use floe::scene::description::SceneDescription;

const README: &str = include_str!("../README.md");

#[test]
fn the_scene_files_of_the_readme_parse() {
    let texts = README.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    let scenes: Vec<_> = texts.map(|text| SceneDescription::parse(text, Path::new("README.md"))).collect();
    assert!(scenes.len() >= 2, "the README has scene files");
    scenes.into_iter().for_each(|scene| assert!(scene.is_ok(), "{}", scene.unwrap_err()));
}

/// Of media that the first scene file of the README has, or that are left to the reader.
#[test]
fn the_meshes_of_the_readme_parse() {
    let text = README.split("```toml\n").nth(2).and_then(|rest| rest.split("```").next());
    let media = "[media.sea]\n[media.ice]\n[media.snow]\n[media.glass]\n";
    let text = media.to_owned() + text.unwrap_or_else(|| panic!("the README has no meshes"));
    let scene = SceneDescription::parse(&text, Path::new("README.md"));
    assert_eq!(scene.unwrap_or_else(|e| panic!("{e}")).meshes.len(), 3);
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

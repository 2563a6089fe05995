//! Folders of frames without a scene file.

use super::*;

#[test]
fn a_scene_written_for_another_folder_of_the_same_name_is_refused() {
    let folder = Folder::new();
    let mesh = std::fs::read(shipped_frame(0)).unwrap();
    folder.write("a/frames/f_0001.ply", &mesh);
    folder.write("b/frames/f_0001.ply", &mesh);
    floe(&folder, &["info", "a/frames"]).ended(0);
    floe(&folder, &["info", "a/frames"]).ended(0);
    floe(&folder, &["info", "b/frames"]).ended(78).says(&["out/frames/scene.toml", "a/frames", "b/frames"]);
}

#[test]
fn a_folder_of_frames_gets_a_scene_once() {
    let folder = Folder::new();
    folder.write("drops/drop.7.ply", small::ply(&labelled(cube(), 0, 2)));
    let quick = ["render", "drops", "--samples", "1", "--threads", "2"];
    floe(&folder, &quick).ended(0).says(&["wrote out/drops/scene.toml"]);
    let written = String::from_utf8(folder.read("out/drops/scene.toml")).unwrap();
    assert!(written.contains("[camera]") && written.contains("2 = \"ice\""), "{written}");
    assert_eq!(pictures(&folder), ["out/drops/frame_0007.exr"]);
    let edited = written.replace("[640, 360]", "[16, 9]");
    assert_ne!(edited, written);
    folder.write("out/drops/scene.toml", &edited);
    let again = floe(&folder, &quick).ended(0);
    assert!(!again.stderr.contains("wrote"), "{again:#?}");
    assert_eq!(folder.read("out/drops/scene.toml"), edited.as_bytes());
    assert_eq!(folder.ledger("out/drops/ledger.jsonl")[1]["samples"], 16 * 9);
}

#[test]
fn a_folder_for_each_time_is_a_sequence() {
    let folder = Folder::new();
    let mesh = include_bytes!("../data/meshes/cube_ascii.vtp");
    folder.write("cut/0.5/surface.vtp", mesh).write("cut/1e-05/surface.vtp", mesh);
    let ran = floe(&folder, &["info", "cut"]).ended(0);
    assert!(ran.stdout.contains("0.00001") && ran.stdout.contains("0.5"), "{ran:#?}");
    folder.write("scene.toml", scene("[frames]\npath = \"cut/*/surface.vtp\"\n"));
    floe(&folder, &["render", "scene.toml", "--samples", "1", "--output", "out/f_#.exr"]).ended(0);
    assert_eq!(pictures(&folder), ["out/f_0.00001.exr", "out/f_0.5.exr"]);
}

/// The illuminances of `[sun]` and `[sky]`, and the exposure that follows from them.
#[test]
fn info_prints_where_the_sun_stands_and_the_light_of_sun_and_sky() {
    let folder = Folder::new();
    let sky = "[sky]\nradiance = { model = \"hosek-wilkie\" }\n";
    folder.write("scene.toml", format!("[sun]\nelevation = 60\nazimuth = 200.5\n{sky}"));
    let info = floe(&folder, &["info", "scene.toml"]).ended(0).stdout;
    for words in ["elevation 60.00, azimuth 200.50 degrees, 91", "sky       16", "exposure  -5.6 stops"] {
        assert!(info.contains(words), "no `{words}` in {info}");
    }
    assert!(!info.contains("suns"), "{info}");
}

#[test]
fn info_tells_how_many_suns_there_are_and_the_light_of_each() {
    let folder = Folder::new();
    let sun = |elevation: u32, lux: u32| {
        format!(
            "[[sun]]\nelevation = {elevation}\nazimuth = 90\nirradiance = {{ blackbody = 5778, illuminance = {lux} }}\n"
        )
    };
    folder.write("scene.toml", sun(30, 1000) + &sun(90, 200));
    let info = floe(&folder, &["info", "scene.toml"]).ended(0).stdout;
    for words in [
        "suns      2, 1200 lx, 700 on level ground",
        "sun       elevation 30.00, azimuth 90.00 degrees, 1000 lx, 500 on",
        "degrees, 200 lx, 200 on",
    ] {
        assert!(info.contains(words), "no `{words}` in {info}");
    }
}

#[cfg(unix)]
#[test]
fn a_written_scene_may_be_read_by_others_as_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    folder.write("drops/drop.7.ply", small::ply(&labelled(cube(), 0, 1))).write("ordinary", "");
    floe(&folder, &["info", "drops"]).ended(0);
    let mode = |name: &str| folder.path(name).metadata().unwrap().permissions().mode();
    assert_eq!(mode("out/drops/scene.toml"), mode("ordinary"));
}

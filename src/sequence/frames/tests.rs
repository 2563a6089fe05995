use super::*;

use tempfile::TempDir;

fn folder(names: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in names {
        fs::write(folder.path().join(name), b"").unwrap();
    }
    folder
}

fn found(names: &[&str], pattern: &str) -> Vec<(String, String)> {
    let folder = folder(names);
    let entry = |frame: FrameFile| {
        (frame.number.to_string(), frame.path.file_name().unwrap().to_string_lossy().into_owned())
    };
    discover(folder.path(), pattern).unwrap().into_iter().map(entry).collect()
}

fn numbers(names: &[&str], pattern: &str) -> Vec<String> {
    found(names, pattern).into_iter().map(|(number, _)| number).collect()
}

fn failure(names: &[&str], pattern: &str) -> String {
    let folder = folder(names);
    let text = discover(folder.path(), pattern).unwrap_err().to_string();
    text.replace(&folder.path().display().to_string(), "DIR")
}

#[test]
fn natural_order_with_any_padding() {
    let names = ["f_10.ply", "f_9.ply", "f_0100.ply", "f_001.ply"];
    for pattern in
        ["f_####.ply", "f_%04d.ply", "f_%d.ply", "f_$F4.ply", "f_$F.ply", "f_*.ply", "*.ply", "", "."]
    {
        assert_eq!(numbers(&names, pattern), ["1", "9", "10", "100"], "{pattern}");
    }
    assert_eq!(found(&names, "f_?.ply"), [("9".to_owned(), "f_9.ply".to_owned())]);
}

#[test]
fn decimal_numbers_sort_by_value() {
    let names = ["iter_100.dsc", "iter_12.5.dsc", "iter_0.5.dsc", "iter_9.dsc"];
    for pattern in ["", "*.dsc", "iter_#.dsc", "iter_%d.dsc"] {
        assert_eq!(numbers(&names, pattern), ["0.5", "9", "12.5", "100"], "{pattern}");
    }
}

#[test]
fn a_version_is_not_the_whole_part_of_a_decimal() {
    assert_eq!(numbers(&["v1.0002.ply", "v1.0001.ply"], ""), ["1", "2"]);
    assert_eq!(numbers(&["a.1.0002.ply", "a.1.0001.ply"], ""), ["1", "2"]);
    assert_eq!(numbers(&["water.0001.ply"], ""), ["1"]);
    assert_eq!(numbers(&["0.25.obj", "0.5.obj"], ""), ["0.25", "0.5"]);
    assert_eq!(numbers(&["mp4_run2_0007_final.obj"], ""), ["7"]);
}

#[test]
fn folders_take_finished_meshes_only() {
    let names = [
        "w_1.ply",
        "w_2.PLY.gz",
        "w_3.obj.GZ",
        "w_4.dsc",
        "w_5.vtk",
        "w_6.vtp.gz",
        "w_7.stl",
        "w_8.bobj.gz",
        ".w_9.ply",
        "w_9.ply.tmp",
        "w_9.part",
        "w_9.json",
        "velocity0001.bobj",
        "tank.obj",
    ];
    assert_eq!(numbers(&names, ""), ["1", "2", "3", "4", "5", "6", "7", "8"]);
    let dir = folder(&names);
    fs::create_dir(dir.path().join("w_9.ply")).unwrap();
    assert_eq!(discover(dir.path(), "").unwrap().len(), 8);
    fs::create_dir(dir.path().join("run#2")).unwrap();
    fs::write(dir.path().join("run#2/a_1.ply"), b"").unwrap();
    assert_eq!(discover(dir.path(), "run#2").unwrap().len(), 1);
    assert_eq!(discover(dir.path(), "run#2/a_##.ply").unwrap().len(), 1);
}

#[test]
fn patterns_read_signs_and_folders_do_not() {
    assert_eq!(numbers(&["f_-2.ply", "f_-1.ply", "f_0.ply"], "f_####.ply"), ["-2", "-1", "0"]);
    assert_eq!(numbers(&["f-2.ply", "f-1.ply"], "f-####.ply"), ["1", "2"]);
    assert!(failure(&["f_-1.ply", "f_0.ply"], "").contains("more than one sequence"));
}

#[test]
fn unicode_names() {
    assert_eq!(numbers(&["bølge_02_é.ply", "bølge_01_é.ply"], ""), ["1", "2"]);
    assert_eq!(numbers(&["bølge_02_é.ply", "bølge_01_é.ply"], "bølge_##_é.ply"), ["1", "2"]);
    // Digits of other scripts are letters of the name.
    assert_eq!(numbers(&["波٣_7.ply"], ""), ["7"]);
}

#[test]
fn one_mesh_without_a_number_is_frame_1() {
    assert_eq!(numbers(&["bunny.ply"], ""), ["1"]);
    assert_eq!(numbers(&["bunny.ply", "other.obj"], "bunny.ply"), ["1"]);
    assert_eq!(numbers(&["bunny_12.ply", "bunny_13.ply"], "bunny_12.ply"), ["12"]);
    let text = failure(&["a.ply", "b.ply"], "");
    assert_eq!(
        text,
        "a.ply and b.ply in DIR have no number in their names: number the frames, or name one file in `frames.path`"
    );
}

#[test]
fn one_number_twice_names_both_files() {
    for (names, pattern) in [
        (["a_1.ply", "a_01.ply"], "a_##.ply"),
        (["a_1.ply", "a_01.ply"], ""),
        (["f_0001.ply", "f_0001.ply.gz"], ""),
        (["f_0001.ply", "f_0001.obj"], "f_*"),
        (["f_2.5.ply", "f_2.50.ply"], "f_#.ply"),
    ] {
        let text = failure(&names, pattern);
        assert!(text.starts_with("frame ") && text.contains("there twice"), "{text}");
        assert!(
            names
                .iter()
                .all(|name| text.contains(&format!("DIR/{name} ")) || text.contains(&format!("DIR/{name}:")))
        );
    }
}

#[test]
fn two_sequences_in_one_folder_are_refused() {
    let text = failure(&["water_001.ply", "water_002.ply", "ice_001.ply"], "");
    assert_eq!(
        text,
        "DIR holds more than one sequence, such as ice_###.ply and water_###.ply: name one of them in `frames.path`"
    );
    assert_eq!(numbers(&["water_001.ply", "ice_001.ply"], "water_*.ply"), ["1"]);
    assert!(failure(&["a1b.ply", "a2c.ply"], "*").contains("a#b.ply and a#c.ply"));
}

#[test]
fn nothing_found_says_where_and_what() {
    assert!(failure(&[], "").starts_with(
        "no frames in DIR: looked for meshes (.ply, .obj, .dsc, .vtk, .vtp, .stl, .bobj, also with .gz)"
    ));
    assert!(failure(&["x_1.ply"], "f_####.ply").starts_with("no frames in DIR: looked for `f_####.ply`"));
    assert!(failure(&["x_1.ply"], "y*").contains("looked for meshes named `y*`"));
    assert!(failure(&["x_1.ply"], "y.ply").contains("looked for `y.ply`, a file or a folder"));
    assert!(failure(&[], "missing/f_####.ply").starts_with("cannot list the folder DIR/missing/"));
}

#[test]
fn impossible_patterns() {
    assert!(failure(&[], "f_*_##.ply").contains("both a place for the number"));
    assert!(failure(&[], "f_##_##.ply").contains("two places"));
    assert!(failure(&[], "run*/f_##.ply").contains("write the others out"));
}

#[test]
fn a_huge_number_is_an_error_that_names_the_file() {
    let name = format!("f_{}.ply", "9".repeat(60));
    for pattern in ["", "f_##.ply", name.as_str()] {
        let text = failure(&[&name], pattern);
        assert!(text.starts_with("the number `999") && text.contains("is not a frame number"), "{text}");
    }
    assert!(failure(&["f_1.1234567.ply"], "").contains("up to 6 decimals"));
}

#[cfg(unix)]
#[test]
fn links_to_files_are_frames_and_links_to_nothing_and_folders_are_none() {
    use std::os::unix::fs::symlink;
    let folder = folder(&["f_1.ply", "elsewhere"]);
    fs::create_dir(folder.path().join("f_4.ply")).unwrap();
    for (target, link) in [("elsewhere", "f_2.ply"), ("nothing", "f_3.ply"), ("f_4.ply", "f_5.ply")] {
        symlink(target, folder.path().join(link)).unwrap();
    }
    let frames = discover(folder.path(), "f_#.ply").unwrap();
    assert_eq!(frames.iter().map(|frame| frame.number.to_string()).collect::<Vec<_>>(), ["1", "2"]);
}

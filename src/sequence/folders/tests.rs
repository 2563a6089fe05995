use std::fs;

use tempfile::TempDir;

use super::super::discover;

fn folder(files: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, b"").unwrap();
    }
    folder
}

/// Numbers and paths within the folder, or the message.
fn found(files: &[&str], pattern: &str) -> Result<Vec<String>, String> {
    let folder = folder(files);
    let within = |text: String| text.replace(&format!("{}/", folder.path().display()), "");
    match discover(folder.path(), pattern) {
        Ok(frames) => {
            Ok(frames.iter().map(|f| within(format!("{} {}", f.number, f.path.display()))).collect())
        }
        Err(error) => Err(within(error.to_string())),
    }
}

const SAMPLED: [&str; 7] = [
    "cut/0/surface.vtp",
    "cut/0.05/surface.vtp",
    "cut/1e-05/surface.vtp",
    "cut/10/surface.vtp",
    "cut/2.5/surface.vtp",
    "cut/constant/surface.vtp",
    "cut/0.1/notes.txt",
];

#[test]
fn a_folder_for_each_time_is_a_sequence_in_the_order_of_times() {
    let expected = [
        "0 cut/0/surface.vtp",
        "0.00001 cut/1e-05/surface.vtp",
        "0.05 cut/0.05/surface.vtp",
        "2.5 cut/2.5/surface.vtp",
        "10 cut/10/surface.vtp",
    ];
    for pattern in
        ["cut", "cut/", "cut/*/surface.vtp", "cut/#/surface.vtp", "cut/%d/surface.vtp", "cut/$F/surface.vtp"]
    {
        assert_eq!(found(&SAMPLED, pattern), Ok(expected.map(str::to_owned).to_vec()), "{pattern}");
    }
    assert_eq!(found(&SAMPLED, "cut/0*/surface.vtp").unwrap().len(), 2);
}

#[test]
fn the_folder_that_varies_may_be_further_up() {
    let files = ["run/t_2/out/w.stl", "run/t_10/out/w.stl", "run/t_3/w.stl", "run/u_4/out/w.stl"];
    let expected = Ok(vec!["2 run/t_2/out/w.stl".to_owned(), "10 run/t_10/out/w.stl".to_owned()]);
    assert_eq!(found(&files, "run/t_*/out/w.stl"), expected);
    assert_eq!(found(&files, "run/t_####/out/w.stl"), expected);
    let message = found(&files, "run/*/out/w.stl").unwrap_err();
    assert!(message.contains("such as t_##/out/w.stl and u_#/out/w.stl"), "{message}");
}

#[test]
fn several_surfaces_in_each_folder_are_refused_and_named() {
    let files = ["cut/0.1/free.vtp", "cut/0.1/wall.vtp", "cut/0.2/free.vtp", "cut/0.2/wall.vtp"];
    let message = found(&files, "cut").unwrap_err();
    assert!(message.contains("more than one sequence, such as #/free.vtp and #/wall.vtp"), "{message}");
    assert_eq!(found(&files, "cut/#/free.vtp").unwrap().len(), 2);
}

#[test]
fn meshes_beside_folders_of_times_are_a_second_sequence() {
    let message = found(&["cut/f_0001.ply", "cut/0.1/surface.vtp"], "cut").unwrap_err();
    assert!(message.contains("such as f_####.ply and #/surface.vtp"), "{message}");
    assert_eq!(found(&["cut/f_0001.ply", "cut/old/surface.vtp", "cut/7/a.txt"], "cut").unwrap().len(), 1);
}

#[test]
fn one_time_twice_names_both_files() {
    for pattern in ["cut", "cut/*/s.vtp", "cut/#/s.vtp"] {
        let message = found(&["cut/0.1/s.vtp", "cut/0.10/s.vtp"], pattern).unwrap_err();
        assert!(
            message.starts_with("frame 0.1 is there twice, as cut/0.1/s.vtp and as cut/0.10/s.vtp:"),
            "{message}"
        );
    }
}

#[test]
fn times_that_are_no_frame_numbers_name_the_file() {
    let message = found(&["cut/0.00000012/s.vtp"], "cut").unwrap_err();
    assert!(message.starts_with("the number `0.00000012` in cut/0.00000012/s.vtp"), "{message}");
}

#[test]
fn what_cannot_be_used_says_so() {
    for (pattern, reason) in [
        ("cut/*/s_*.vtp", "one part of the path only"),
        ("*/#/s.vtp", "one part of the path only"),
        ("cut/t_*_#/s.vtp", "both a place for the number and"),
        ("cut/#_#/s.vtp", "two places"),
    ] {
        let message = found(&SAMPLED, pattern).unwrap_err();
        assert!(message.contains(reason), "{pattern}: {message}");
    }
    let message = found(&SAMPLED, "cut/*/other.vtp").unwrap_err();
    assert!(message.starts_with("no frames in cut/: looked for files named `cut/*/other.vtp`"), "{message}");
    assert!(found(&SAMPLED, "missing/#/s.vtp").unwrap_err().starts_with("cannot list the folder missing/"));
}

#[test]
fn folders_with_such_a_name_are_no_patterns() {
    let files = ["run#2/f_1.ply", "run*/f_2.ply"];
    assert_eq!(found(&files, "run#2/f_#.ply"), Ok(vec!["1 run#2/f_1.ply".to_owned()]));
    assert_eq!(found(&files, "run*/f_*.ply"), Ok(vec!["2 run*/f_2.ply".to_owned()]));
}

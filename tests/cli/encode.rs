//! `floe encode`, with a program in place of ffmpeg that writes down what it is asked for.
#![cfg(unix)]

use std::os::unix::fs::PermissionsExt;

use super::*;

/// Writes its arguments into `asked`, the pictures that it would read into `read`, and `movie` into the last argument.
const FFMPEG: &str = r#"#!/bin/sh
[ "$1" = -version ] && exit 0
[ -e fail ] && { echo "no such codec" >&2; exit 3; }
echo "$@" > asked
while [ $# -gt 1 ]; do
    [ "$1" = -i ] && for file in "$(dirname "$2")"/0*.png; do cksum < "$file"; done > read
    shift
done
echo movie > "$1"
"#;

/// A folder with `shot/frame_####.png` of 6 x 4 pixels, each of its own colour.
fn shots(numbers: &[u32]) -> Folder {
    let folder = Folder::new();
    folder.write("bin/ffmpeg", FFMPEG);
    std::fs::set_permissions(folder.path("bin/ffmpeg"), std::fs::Permissions::from_mode(0o755)).unwrap();
    for &number in numbers {
        let colour = image::Rgb([50, 100, 10 * number as u8]);
        let name = format!("shot/frame_{number:04}.png");
        folder.write(&name, []);
        image::RgbImage::from_pixel(6, 4, colour).save(folder.path(&name)).unwrap();
    }
    folder
}

/// Runs the command with the folder's `bin` before all else, or with that alone.
fn encode(folder: &Folder, path: &str, arguments: &[&str]) -> Outcome {
    let output = command(folder, &[&["encode"], arguments].concat()).env("PATH", path).output().unwrap();
    assert_eq!(folder.leftovers(), [""; 0], "{arguments:?}");
    Outcome {
        code: output.status.code().unwrap(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

fn with_fake(folder: &Folder, arguments: &[&str]) -> Outcome {
    encode(folder, &format!("{}:/usr/bin:/bin", folder.path("bin").display()), arguments)
}

fn text(folder: &Folder, name: &str) -> String {
    String::from_utf8(folder.read(name)).unwrap()
}

#[test]
fn a_movie_has_every_frame_and_holds_those_before_a_gap() {
    let folder = shots(&[1, 2, 5, 6]);
    let outcome =
        with_fake(&folder, &["shot", "--fps", "30"]).ended(0).says(&["frame 3-4 is missing", "held"]);
    assert_eq!(outcome.stdout, "6 frames at 30 a second in shot/movie.mp4\n");
    assert_eq!(text(&folder, "shot/movie.mp4"), "movie\n");
    let asked = text(&folder, "asked");
    for words in ["-framerate 30 ", "libx264 -crf 18 ", "-pix_fmt yuv420p", "-f mp4 ", "%08d.png"] {
        assert!(asked.contains(words), "no {words} in {asked}");
    }
    let read = text(&folder, "read");
    let sums: Vec<&str> = read.lines().collect();
    assert_eq!(sums.len(), 6);
    assert!(sums[1] == sums[2] && sums[1] == sums[3] && sums[0] != sums[1] && sums[4] != sums[5], "{read}");
}

#[test]
fn a_pattern_and_other_kinds_of_movies() {
    let folder = shots(&[1, 2]);
    for (output, words) in [
        ("a.webm", ["libvpx-vp9 -crf 20 ", "-f webm "]),
        ("b/c.gif", ["palettegen", "-f gif "]),
        ("d.MP4", ["-crf 20 ", "-framerate 24 "]),
    ] {
        with_fake(&folder, &["shot/frame_####.png", "-o", output, "--crf", "20"]).ended(0);
        let asked = text(&folder, "asked");
        assert!(words.iter().all(|w| asked.contains(w)), "{asked}");
        assert_eq!(text(&folder, output), "movie\n");
    }
}

#[test]
fn denoised_copies_are_no_frames_unless_they_are_named() {
    let folder = shots(&[1, 2, 3]);
    folder.write("shot/frame_0002.denoised.png", folder.read("shot/frame_0001.png"));
    with_fake(&folder, &["shot"]).ended(0);
    assert_eq!(text(&folder, "read").lines().count(), 3);
    with_fake(&folder, &["shot/frame_####.denoised.png"]).ended(0);
    assert_eq!(text(&folder, "read").lines().count(), 1);
}

#[test]
fn a_scene_stands_for_its_pictures_and_an_exr_for_its_png() {
    let folder = boxes(2, "");
    folder.write("bin/ffmpeg", FFMPEG);
    std::fs::set_permissions(folder.path("bin/ffmpeg"), std::fs::Permissions::from_mode(0o755)).unwrap();
    with_fake(&folder, &["boxes"]).ended(66).says(&["out/boxes/frame_####.exr", "render them first"]);
    floe(&folder, &["render", "boxes"]).ended(0);
    with_fake(&folder, &["boxes"]).ended(0);
    let shown = text(&folder, "read");
    // Another encoder may compress otherwise, so pixels are compared, on the sheets.
    with_fake(&folder, &["boxes", "--contact-sheet", "png.png"]).ended(0);
    // From elsewhere, and through the folder of the pictures with a scene of its own, they are the same.
    folder.write(
        "out/boxes/scene.toml",
        text(&folder, "boxes/scene.toml").replace("frames/", "../../boxes/frames/"),
    );
    folder.write("away/here", "");
    let path = format!("{}:/usr/bin:/bin", folder.path("bin").display());
    let mut away = command(&folder, &["encode", "../out/boxes", "-o", "movie.mp4"]);
    let away = away.current_dir(folder.path("away")).env("PATH", path).output().unwrap();
    assert!(away.status.success(), "{away:?}");
    assert_eq!(text(&folder, "away/read"), shown);
    std::fs::remove_file(folder.path("out/boxes/frame_0001.png")).unwrap();
    std::fs::remove_file(folder.path("out/boxes/frame_0002.png")).unwrap();
    with_fake(&folder, &["boxes"]).ended(0);
    assert_eq!(shown.lines().count(), text(&folder, "read").lines().count());
    with_fake(&folder, &["boxes", "--contact-sheet", "exr.png"]).ended(0);
    assert_eq!(folder.read("png.png"), folder.read("exr.png"));
}

/// Previews of a watch that was broken off are PNGs alone, and PNGs from before `png = false` are older than their EXRs.
#[test]
fn a_png_is_taken_for_a_picture_only_where_it_is_one() {
    let folder = boxes(3, "[frames]\npath = \"frames/frame_####.ply\"\nfps = 30\n[output]\nexposure = 1\n");
    floe(&folder, &["render", "boxes"]).ended(0);
    let sheet = |name: &str, what: &str| {
        let outcome = encode(&folder, "", &[what, "--contact-sheet", name]).ended(0);
        (folder.read(name), outcome)
    };
    let (whole, _) = sheet("whole.png", "boxes");
    let other = folder.path("out/boxes/frame_0002.png");
    image::RgbImage::new(16, 9).save(&other).unwrap();
    let (newer, _) = sheet("newer.png", "boxes");
    assert_ne!(newer, whole);
    let long_ago = std::time::SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_000_000_000);
    std::fs::File::options().append(true).open(&other).unwrap().set_modified(long_ago).unwrap();
    let (older, _) = sheet("older.png", "boxes");
    assert_eq!(older, whole);
    std::fs::remove_file(folder.path("out/boxes/frame_0003.exr")).unwrap();
    let (of_scene, outcome) = sheet("two.png", "boxes");
    let outcome = outcome.says(&["may be previews", ": 3\n"]);
    assert_eq!(outcome.stdout, "2 pictures in two.png\n");
    // Without a scene nobody knows better. EXRs say how many there are a second.
    folder.write("bin/ffmpeg", FFMPEG);
    std::fs::set_permissions(folder.path("bin/ffmpeg"), std::fs::Permissions::from_mode(0o755)).unwrap();
    assert_eq!(
        with_fake(&folder, &["out/boxes"]).ended(0).stdout,
        "3 frames at 30 a second in out/boxes/movie.mp4\n"
    );
    assert_ne!(of_scene, whole);
    for number in [1, 2] {
        std::fs::remove_file(folder.path(&format!("out/boxes/frame_{number:04}.exr"))).unwrap();
    }
    with_fake(&folder, &["boxes"]).ended(66).says(&["no pictures", "PNGs of 1-3 alone"]);
}

/// ffmpeg that would take a minute.
#[test]
fn a_signal_ends_ffmpeg_and_leaves_nothing() {
    for signal in ["INT", "TERM"] {
        let folder = shots(&[1, 2]);
        folder.write(
            "bin/ffmpeg",
            "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\necho begun > begun\nexec sleep 60\n",
        );
        folder.write("temporary/kept", "");
        let path = format!("{}:/usr/bin:/bin", folder.path("bin").display());
        let mut child = command(&folder, &["encode", "shot"])
            .env("PATH", path)
            .env("TMPDIR", folder.path("temporary"))
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        while !folder.path("begun").exists() {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        let id = child.id().to_string();
        Command::new("sh").args(["-c", "kill -$0 $1", signal, &id]).status().unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(75));
        assert_eq!(folder.leftovers(), [""; 0]);
        assert_eq!(std::fs::read_dir(folder.path("temporary")).unwrap().count(), 1);
        assert!(!folder.path("shot/movie.mp4").exists());
    }
}

#[test]
fn a_sheet_shows_every_frame_with_its_number() {
    let folder = shots(&[1, 2, 3]);
    let sheet = ["shot", "--contact-sheet", "sheet.png", "--columns", "2"];
    let outcome = encode(&folder, "", &sheet).ended(0);
    assert_eq!(outcome.stdout, "3 pictures in sheet.png\n");
    let sheet = image::load_from_memory(&folder.read("sheet.png")).unwrap().into_rgb8();
    // Cells of 6 + 8 by 4 + 10 + 16 pixels, and a margin of 8.
    assert_eq!(sheet.dimensions(), (2 * 14 + 8, 2 * 30 + 8));
    for (number, [x, y]) in [(1_u8, [8, 8]), (2, [22, 8]), (3, [8, 38])] {
        assert_eq!(sheet.get_pixel(x, y).0, [50, 100, 10 * number]);
        assert_eq!(sheet.get_pixel(x + 5, y + 3).0, [50, 100, 10 * number]);
        let ink = (0..6).flat_map(|dx| (12..22).map(move |dy| (x + dx, y + dy)));
        assert!(ink.filter(|(x, y)| sheet.get_pixel(*x, *y).0 == [208; 3]).count() > 20, "{number}");
    }
}

#[test]
fn what_cannot_be_encoded_is_told_and_leaves_nothing() {
    let folder = shots(&[1, 2]);
    encode(&folder, "", &["shot"]).ended(70).says(&[
        "apt install ffmpeg",
        "-start_number 1 -i shot/frame_%04d.png ",
        "shot/movie.mp4",
    ]);
    folder.write("fail", "");
    with_fake(&folder, &["shot"]).ended(70).says(&["no such codec", "libx264"]);
    std::fs::remove_file(folder.path("fail")).unwrap();
    with_fake(&folder, &["shot", "-o", "a.avi"]).ended(2).says(&["a.avi", ".webm"]);
    with_fake(&folder, &["shot", "--crf", "52"]).ended(2).says(&["--crf 52", "0 to 51"]);
    with_fake(&folder, &["shot", "--fps", "0"]).ended(2);
    with_fake(&folder, &["shot", "--columns", "2"]).ended(2).says(&["--contact-sheet"]);
    with_fake(&folder, &["nowhere"]).ended(66).says(&["nowhere"]);
    with_fake(&folder, &["bin"]).ended(66).says(&["no pictures bin"]);
    let far = folder.path("shot/frame_20000000.png");
    image::RgbImage::new(6, 4).save(&far).unwrap();
    with_fake(&folder, &["shot"]).ended(65).says(&[
        "frame_20000000.png",
        "frames 3-19999999",
        "at most 10000",
    ]);
    std::fs::rename(far, folder.path("shot/frame_100000000000.png")).unwrap();
    with_fake(&folder, &["shot"]).ended(65).says(&["3-99999999999", "another folder"]);
    std::fs::remove_file(folder.path("shot/frame_100000000000.png")).unwrap();
    image::RgbImage::new(8, 4).save(folder.path("shot/frame_0003.png")).unwrap();
    with_fake(&folder, &["shot"]).ended(65).says(&["frame_0003.png: 8 x 4", "6 x 4"]);
    folder.write("shot/frame_0003.png", "no picture");
    with_fake(&folder, &["shot"]).ended(65).says(&["frame_0003.png", "render this frame again"]);
    assert!(!folder.files().iter().any(|name| name.contains("movie") || name.contains("avi")));
}

/// `cargo test --release --test cli -- --ignored --nocapture real_ffmpeg`
#[test]
#[ignore = "needs an installed ffmpeg and ffprobe"]
fn the_real_ffmpeg_makes_movies_that_can_be_read() {
    let folder = shots(&[1, 2, 4]);
    let path = std::env::var("PATH").unwrap();
    for name in ["movie.mp4", "movie.webm", "movie.gif"] {
        encode(&folder, &path, &["shot", "-o", name]).ended(0);
        let probe = Command::new("ffprobe")
            .args([
                "-v",
                "error",
                "-count_frames",
                "-show_entries",
                "stream=width,height,nb_read_frames",
                "-of",
                "csv=p=0",
            ])
            .arg(folder.path(name))
            .output()
            .unwrap();
        let probed = String::from_utf8(probe.stdout).unwrap();
        eprintln!("{name}: {probed}");
        assert!(probed.starts_with("6,4,4"), "{name}: {probed}");
        let first = folder.read(name);
        encode(&folder, &path, &["shot", "-o", name]).ended(0);
        assert!(first == folder.read(name), "{name}: other bytes from the same pictures");
    }
}

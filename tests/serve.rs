//! The page of `floe watch --serve`, asked over plain HTTP.
#![cfg(feature = "serve")]
#![allow(clippy::unwrap_used)]

mod small;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use small::{Folder, cube, labelled, scene};

/// A watch that serves; it ends with its test.
struct Served {
    child: Child,
    address: String,
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Served {
    fn start(folder: &Folder) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_floe"))
            .args([
                "watch",
                "scene.toml",
                "--output",
                "out/frame_####.exr",
                "--settle",
                "0.02",
                "--serve",
                "0",
            ])
            .current_dir(folder.path(""))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let address = lines.by_ref().find_map(|line| {
            let line = line.unwrap();
            Some(line.strip_prefix("page at http://")?.trim_end_matches('/').to_owned())
        });
        // Read on, or the pipe fills up.
        std::thread::spawn(move || lines.for_each(drop));
        Self { child, address: address.unwrap() }
    }

    /// The status, the head and the body of an answer.
    fn ask(&self, request: &str) -> (u16, String, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        let end = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").unwrap();
        let head = String::from_utf8(answer[..end].to_vec()).unwrap();
        let code = head.split(' ').nth(1).unwrap().parse().unwrap();
        (code, head, answer[end + 4..].to_vec())
    }

    fn get(&self, path: &str) -> (u16, String, Vec<u8>) {
        self.ask(&format!("GET {path} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", self.address))
    }

    /// Asks for the state until it is as it is wanted.
    fn state(&self, wanted: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            let (code, head, body) = self.get("/status.json");
            assert_eq!(code, 200, "{head}");
            let state: Value = serde_json::from_slice(&body).unwrap();
            if wanted(&state) {
                return state;
            }
            assert!(start.elapsed() < Duration::from_secs(60), "{state}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

/// `scene.toml` with frames 1 and 2, the second of which is cut.
fn frames() -> Folder {
    let folder = Folder::with_scene(&scene("[render]\nsamples = 8\n"));
    let whole = small::ply(&labelled(cube(), 0, 1));
    folder.write("frames/frame_0001.ply", &whole);
    folder.write("frames/frame_0002.ply", &whole[..whole.len() / 2]);
    folder
}

#[test]
fn the_page_shows_pictures_and_state_and_nothing_else() {
    let folder = frames();
    let served = Served::start(&folder);
    let state = served.state(|state| state["drawn"] == 1 && state["failed"] == 1);
    let [first, second] = [&state["frames"][0], &state["frames"][1]];
    assert_eq!((&first["frame"], &first["state"]), (&"1".into(), &"complete".into()));
    // Of its preview and of the picture.
    assert_eq!(first["points"].as_array().unwrap().len(), 2);
    assert_eq!(second["state"], "failed");
    assert!(second["problem"].as_str().unwrap().contains("frame_0002.ply"));
    let since = format!("/status.json?since={}", state["revision"]);
    let unchanged: Value = serde_json::from_slice(&served.get(&since).2).unwrap();
    assert!(unchanged["frames"].as_array().unwrap().is_empty());

    let (code, head, page) = served.get("/");
    assert_eq!(code, 200);
    assert!(head.contains("text/html") && head.contains("Content-Security-Policy: default-src 'none'"));
    let page = String::from_utf8(page).unwrap();
    assert!(
        !page.contains("http://")
            || page.matches("http").count() == page.matches("http://www.w3.org/2000/svg").count()
    );

    assert_eq!(served.get("/frame/1.png?5").2, folder.read("out/frame_0001.png"));
    assert_eq!(served.get("/latest.png").2, folder.read("out/latest.png"));
    let (code, head, small) = served.get("/thumb/1.png");
    assert!(code == 200 && head.contains("image/png") && small.starts_with(b"\x89PNG"));
}

#[test]
fn no_path_leads_out_and_no_other_site_leads_in() {
    let folder = frames();
    folder.write("secret.png", "secret");
    let served = Served::start(&folder);
    served.state(|state| state["drawn"] == 1);
    for path in [
        "/frame/../secret.png",
        "/frame/..%2f..%2fsecret.png",
        "/frame/%2e%2e/secret.png",
        "/thumb//etc/passwd.png",
        "/secret.png",
        "/out/frame_0001.png",
        "//secret.png",
        "/frame/3.png",
        "/frame/.png",
        "/ledger.jsonl",
        "/frame/1.png/../../secret.png",
    ] {
        assert_eq!(served.get(path).0, 404, "{path}");
    }
    let foreign = "GET / HTTP/1.1\r\nHost: example.org\r\nConnection: close\r\n\r\n";
    assert_eq!(served.ask(foreign).0, 403);
    let post = format!(
        "POST / HTTP/1.1\r\nHost: {}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n",
        served.address
    );
    assert_eq!(served.ask(&post).0, 405);
}

/// A page that is opened later, or after a restart, has the frames of before.
#[test]
fn what_was_drawn_before_is_in_the_ledger() {
    let folder = frames();
    drop({
        let served = Served::start(&folder);
        served.state(|state| state["drawn"] == 1);
        served
    });
    let served = Served::start(&folder);
    let state = served.state(|state| state["drawn"] == 1);
    assert_eq!(state["frames"][0]["state"], "complete");
    assert_eq!(served.get("/frame/1.png").2, folder.read("out/frame_0001.png"));
}

/// Writes a picture of the page of a folder of your own, in a browser without a window:
/// `FLOE_BROWSER=chromium cargo test --release --test serve -- --ignored --nocapture screenshot`
#[test]
#[ignore = "needs a Chromium; FLOE_BROWSER names it"]
fn screenshot() {
    let browser = std::env::var("FLOE_BROWSER").unwrap_or_else(|_| "chromium".into());
    let folder = frames();
    let served = Served::start(&folder);
    served.state(|state| state["drawn"] == 1 && state["failed"] == 1);
    let shot = folder.path("page.png");
    let status = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=1200,760"])
        .args(["--virtual-time-budget=4000", &format!("--screenshot={}", shot.display())])
        .arg(format!("http://{}/", served.address))
        .status()
        .unwrap();
    assert!(status.success());
    let page = image::open(&shot).unwrap().to_rgb8();
    // The blue of finished pictures in the curve: only the script draws it, and only with data.
    let blue = page.pixels().filter(|p| p.0 == [0x58, 0xa6, 0xd6]).count();
    println!("{} x {}, {blue} blue pixels", page.width(), page.height());
    assert!(blue > 20, "{blue}");
}

//! Answers requests for the page.

use std::io;
use std::net::{IpAddr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;

use super::board::Board;
use super::http::{LIMITS, Request, Response, answer_all};
use super::thumbnail::thumbnail;

const PAGE: &str = include_str!("page.html");

/// What the page may load: from here, and nothing from elsewhere.
const POLICY: &str = "default-src 'none'; img-src 'self'; connect-src 'self'; style-src 'unsafe-inline'; \
                      script-src 'unsafe-inline'";

/// A kind of contents, and the contents.
type Found = (&'static str, Vec<u8>);

/// Answers at an address from now until the process ends, on threads of its own; port 0 is one that is free. Returns
/// where it listens.
///
/// # Errors
/// What the system says when it cannot.
pub fn serve(address: IpAddr, port: u16, board: Arc<Board>) -> io::Result<SocketAddr> {
    let listener = TcpListener::bind((address, port))?;
    let bound = listener.local_addr()?;
    let is_local = bound.ip().is_loopback();
    // Nobody waits for it: a browser that does not take its answer must not keep the watch from ending.
    std::thread::Builder::new().name("page".into()).spawn(move || {
        answer_all(&listener, LIMITS, move |request| answer(request, &board, is_local));
    })?;
    Ok(bound)
}

fn answer(request: &Request, board: &Board, is_local: bool) -> Response {
    // Pages of other sites may not read this one under a name of theirs that they let point to this machine.
    let is_own = request.host.as_deref().is_none_or(is_own_name);
    let status = if request.method != "GET" {
        Err(405)
    } else if is_local && !is_own {
        Err(403)
    } else {
        found(&request.target, board).ok_or(404)
    };
    let (code, kind, body) = match status {
        Ok((kind, body)) => (200, kind, body),
        Err(code) => (code, "text/plain", format!("{code}\n").into_bytes()),
    };
    let headers = vec![
        ("Content-Type", kind),
        ("Content-Security-Policy", POLICY),
        ("X-Content-Type-Options", "nosniff"),
        ("Cache-Control", if kind == "image/png" { "max-age=3600" } else { "no-store" }),
    ];
    Response { code, headers, body }
}

fn is_own_name(host: &str) -> bool {
    let name = match host.strip_prefix('[') {
        Some(rest) => rest.split(']').next().unwrap_or(rest),
        None => host.split(':').next().unwrap_or(host),
    };
    name.eq_ignore_ascii_case("localhost")
        || name.parse::<IpAddr>().is_ok_and(|address| address.is_loopback())
}

/// What is there under a name.
fn found(url: &str, board: &Board) -> Option<Found> {
    let (path, query) = url.split_once('?').unwrap_or((url, ""));
    let frame = |prefix: &str| path.strip_prefix(prefix)?.strip_suffix(".png");
    let png = |path: PathBuf| std::fs::read(path).ok();
    if path == "/" {
        Some(("text/html; charset=utf-8", PAGE.into()))
    } else if path == "/status.json" {
        let since = query.strip_prefix("since=").and_then(|number| number.parse().ok()).unwrap_or(0);
        Some(("application/json", board.json(since).into_bytes()))
    } else if path == "/latest.png" {
        Some(("image/png", png(board.latest()?)?))
    } else if let Some(number) = frame("/frame/") {
        Some(("image/png", png(board.png(number)?)?))
    } else {
        let number = frame("/thumb/")?;
        Some(("image/png", thumbnail(&png(board.png(number)?)?)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_this_machine_are_its_own() {
        for host in ["localhost", "LOCALHOST:8000", "127.0.0.1:80", "127.1.2.3", "[::1]:8000", "[::1]"] {
            assert!(is_own_name(host), "{host}");
        }
        for host in
            ["example.org", "127.0.0.1.example.org", "localhost.example.org:80", "10.0.0.1", "", "[::2]"]
        {
            assert!(!is_own_name(host), "{host}");
        }
    }
}

//! Answers requests for the page.

use std::io::Cursor;
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;

use tiny_http::{Header, Method, Request, Response};

use super::board::Board;
use super::thumbnail::thumbnail;

const PAGE: &str = include_str!("page.html");

/// What the page may load: from here, and nothing from elsewhere.
const POLICY: &str = "default-src 'none'; img-src 'self'; connect-src 'self'; style-src 'unsafe-inline'; \
                      script-src 'unsafe-inline'";

/// A kind of contents, and the contents.
type Found = (&'static str, Vec<u8>);

/// Answers at an address from now until the process ends, on a thread of its own; port 0 is one that is free. Returns
/// where it listens.
///
/// # Errors
/// What the system says when it cannot.
pub fn serve(address: IpAddr, port: u16, board: Arc<Board>) -> Result<SocketAddr, String> {
    let http = tiny_http::Server::http((address, port)).map_err(|error| error.to_string())?;
    let bound = http.server_addr().to_ip().unwrap_or(SocketAddr::new(address, port));
    // Nobody waits for it: a browser that does not take its answer must not keep the watch from ending.
    std::thread::spawn(move || {
        for request in http.incoming_requests() {
            answer(request, &board, bound.ip().is_loopback());
        }
    });
    Ok(bound)
}

fn answer(request: Request, board: &Board, is_local: bool) {
    let status = if *request.method() != Method::Get {
        Err(405)
    } else if is_local && !names_this_machine(&request) {
        Err(403)
    } else {
        found(request.url(), board).ok_or(404)
    };
    let (code, kind, body) = match status {
        Ok((kind, body)) => (200, kind, body),
        Err(code) => (code, "text/plain", format!("{code}\n").into_bytes()),
    };
    let length = body.len();
    let headers = [
        ("Content-Type", kind),
        ("Content-Security-Policy", POLICY),
        ("X-Content-Type-Options", "nosniff"),
        ("Cache-Control", if kind == "image/png" { "max-age=3600" } else { "no-store" }),
    ];
    let headers = headers.iter().filter_map(|(name, value)| Header::from_bytes(*name, *value).ok()).collect();
    // A browser that has gone away needs no answer.
    let _ = request.respond(Response::new(code.into(), headers, Cursor::new(body), Some(length), None));
}

/// Pages of other sites may not read this one under a name of theirs that they let point to this machine.
fn names_this_machine(request: &Request) -> bool {
    let host = request.headers().iter().find(|header| header.field.equiv("Host"));
    host.is_none_or(|host| is_own_name(host.value.as_str()))
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

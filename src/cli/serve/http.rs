//! As much of HTTP/1.1 as one page needs: a request a connection, answered, and closed.
//!
//! Whoever connects costs a thread for a while, so there is an end to how many may, how long they may take and how much
//! they may say: a client that is slow, silent or endless takes nothing from the others, and nothing from the watch.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// What clients may take.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Connections at once; a browser has some six.
    pub connections: usize,
    /// Bytes of a request's line and headers.
    pub head: usize,
    /// From connecting to the end of the request, and then between two parts of the answer.
    pub patience: Duration,
    /// For the whole answer.
    pub longest: Duration,
}

/// What a page on this machine, or one room away, needs.
pub const LIMITS: Limits = Limits {
    connections: 16,
    head: 8 << 10,
    patience: Duration::from_secs(5),
    longest: Duration::from_secs(60),
};

/// A request without its body, which nothing here takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request {
    /// `GET` and the like.
    pub method: String,
    /// Path and query.
    pub target: String,
    /// The name under which the client knows the server, if it says one.
    pub host: Option<String>,
}

/// An answer.
#[derive(Clone, Debug)]
pub struct Response {
    /// The status.
    pub code: u16,
    /// Names and values, but for the length and the end of the connection.
    pub headers: Vec<(&'static str, &'static str)>,
    /// The contents.
    pub body: Vec<u8>,
}

impl Response {
    fn refusal(code: u16) -> Self {
        let headers = vec![("Content-Type", "text/plain")];
        Self { code, headers, body: format!("{code}\n").into_bytes() }
    }

    fn bytes(&self) -> Vec<u8> {
        let mut head = format!("HTTP/1.1 {} {}\r\n", self.code, reason(self.code));
        for (name, value) in &self.headers {
            head += &format!("{name}: {value}\r\n");
        }
        head += &format!("Content-Length: {}\r\nConnection: close\r\n\r\n", self.body.len());
        [head.as_bytes(), &self.body].concat()
    }
}

fn reason(code: u16) -> &'static str {
    match code {
        200 => "OK",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        431 => "Request Header Fields Too Large",
        503 => "Service Unavailable",
        _ => "Error",
    }
}

/// Answers whoever connects, for ever.
pub fn answer_all(
    listener: &TcpListener,
    limits: Limits,
    answer: impl Fn(&Request) -> Response + Send + Sync + 'static,
) {
    let answer = Arc::new(answer);
    let open = Arc::new(AtomicUsize::new(0));
    for stream in listener.incoming() {
        let Ok(stream) = stream else {
            // Such as when there are no descriptors left, which would fail again at once.
            std::thread::sleep(Duration::from_millis(100));
            continue;
        };
        let place = Place::take(&open);
        if open.load(Ordering::Acquire) > limits.connections {
            refuse(stream);
            continue;
        }
        let answer = answer.clone();
        // Without a thread for it the client finds the connection closed.
        let _ = std::thread::Builder::new().name("page".into()).spawn(move || {
            let _place = place;
            // A client that has gone away needs no answer.
            let _ = converse(stream, &limits, &*answer);
        });
    }
}

/// One of the connections at once.
struct Place(Arc<AtomicUsize>);

impl Place {
    fn take(open: &Arc<AtomicUsize>) -> Self {
        open.fetch_add(1, Ordering::AcqRel);
        Self(open.clone())
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

/// What is so short fits the system's own buffer; it is not waited for.
fn refuse(mut stream: TcpStream) {
    let _ = stream.set_nonblocking(true).and_then(|()| stream.write_all(&Response::refusal(503).bytes()));
}

fn converse(mut stream: TcpStream, limits: &Limits, answer: &dyn Fn(&Request) -> Response) -> io::Result<()> {
    let response = match read_head(&mut stream, limits)? {
        None => Response::refusal(431),
        Some(head) => request(&head).map_or_else(|| Response::refusal(400), |request| answer(&request)),
    };
    write_slowly(&mut stream, &response.bytes(), limits)?;
    stream.shutdown(Shutdown::Write)?;
    // Closing with something unread would take the answer back. What comes now is thrown away, but not for long.
    stream.set_read_timeout(Some(limits.patience / 5))?;
    let mut rest = [0; 4 << 10];
    for _ in 0..16 {
        if stream.read(&mut rest)? == 0 {
            break;
        }
    }
    Ok(())
}

/// A request up to its empty line; `None` when that does not come in time, byte by byte or not.
fn read_head(stream: &mut TcpStream, limits: &Limits) -> io::Result<Option<Vec<u8>>> {
    let start = Instant::now();
    let mut head = Vec::new();
    let mut part = [0; 1 << 10];
    while head.len() < limits.head {
        let left = limits.patience.saturating_sub(start.elapsed());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        stream.set_read_timeout(Some(left))?;
        let room = part.len().min(limits.head - head.len());
        match stream.read(&mut part[..room])? {
            0 => return Err(ErrorKind::UnexpectedEof.into()),
            read => head.extend_from_slice(&part[..read]),
        }
        if let Some(end) = head.windows(4).position(|bytes| bytes == b"\r\n\r\n") {
            head.truncate(end);
            return Ok(Some(head));
        }
    }
    Ok(None)
}

/// The request that a head is; `None` when it is none, or leaves open which host is meant.
fn request(head: &[u8]) -> Option<Request> {
    let text = std::str::from_utf8(head).ok()?;
    let mut lines = text.split("\r\n");
    let mut words = lines.next()?.split(' ');
    let (method, target, version) = (words.next()?, words.next()?, words.next()?);
    if words.next().is_some() || !version.starts_with("HTTP/1.") {
        return None;
    }
    let mut hosts = lines.filter_map(|line| {
        let (name, value) = line.split_once(':')?;
        name.eq_ignore_ascii_case("host").then(|| value.trim().to_owned())
    });
    let host = hosts.next();
    hosts.next().is_none().then(|| Request { method: method.into(), target: target.into(), host })
}

fn write_slowly(stream: &mut TcpStream, mut bytes: &[u8], limits: &Limits) -> io::Result<()> {
    let start = Instant::now();
    while !bytes.is_empty() {
        let left = limits.longest.saturating_sub(start.elapsed());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        stream.set_write_timeout(Some(left.min(limits.patience)))?;
        match stream.write(bytes)? {
            0 => return Err(ErrorKind::WriteZero.into()),
            written => bytes = &bytes[written..],
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;

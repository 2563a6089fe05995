//! Clients of every kind of manners.

use std::net::SocketAddr;

use super::*;

const SHORT: Limits =
    Limits { patience: Duration::from_millis(900), longest: Duration::from_secs(2), ..LIMITS };

/// Answers with the target, or with 8 MB for `/large`.
fn server(limits: Limits) -> SocketAddr {
    let listener = TcpListener::bind(("127.0.0.1", 0)).unwrap();
    let address = listener.local_addr().unwrap();
    std::thread::spawn(move || {
        answer_all(&listener, limits, |request| {
            let body = match request.target.as_str() {
                "/large" => vec![7; 8 << 20],
                target => target.as_bytes().to_vec(),
            };
            Response { code: 200, headers: vec![("X-Host", "a")], body }
        });
    });
    address
}

fn send(address: SocketAddr, request: &[u8]) -> TcpStream {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.write_all(request).unwrap();
    stream
}

fn answer_of(mut stream: TcpStream) -> String {
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    String::from_utf8_lossy(&answer).into_owned()
}

fn get(address: SocketAddr, target: &str) -> String {
    answer_of(send(address, format!("GET {target} HTTP/1.1\r\nHost: a\r\n\r\n").as_bytes()))
}

#[test]
fn a_request_is_answered_and_the_connection_closed() {
    let answer = get(server(LIMITS), "/a?b=c");
    assert_eq!(
        answer,
        "HTTP/1.1 200 OK\r\nX-Host: a\r\nContent-Length: 6\r\nConnection: close\r\n\r\n/a?b=c"
    );
}

#[test]
fn heads_are_read_as_far_as_they_count() {
    let of = |text: &str| request(text.as_bytes());
    let wanted = Request { method: "GET".into(), target: "/a".into(), host: Some("b:1".into()) };
    assert_eq!(of("GET /a HTTP/1.1\r\nAccept: x\r\nhOST:  b:1 "), Some(wanted.clone()));
    assert_eq!(of("GET /a HTTP/1.0"), Some(Request { host: None, ..wanted }));
    for wrong in
        ["", "GET", "GET /a", "GET /a HTTP/2", "GET /a b HTTP/1.1", "GET /a HTTP/1.1\r\nHost: a\r\nHost: b"]
    {
        assert_eq!(of(wrong), None, "{wrong}");
    }
    assert_eq!(request(b"GET /\xff HTTP/1.1"), None);
}

/// Of what never ends 8 kB are read.
#[test]
fn endless_requests_are_refused() {
    let address = server(LIMITS);
    for endless in
        ["GET /".to_owned() + &"a".repeat(20_000), "GET / HTTP/1.1\r\n".to_owned() + &"A: b\r\n".repeat(4000)]
    {
        let answer = answer_of(send(address, endless.as_bytes()));
        assert!(answer.starts_with("HTTP/1.1 431 "), "{answer}");
    }
}

/// As many as may, less one, say nothing, say it byte by byte, or do not take their answer.
#[test]
fn slow_clients_hold_up_nobody_and_are_cut_off() {
    let address = server(SHORT);
    let mut slow: Vec<TcpStream> = (0..SHORT.connections - 1)
        .map(|k| send(address, [&b""[..], b"GET / HT", b"GET /large HTTP/1.1\r\n\r\n"][k % 3]))
        .collect();
    assert!(get(address, "/b").ends_with("/b"));
    // The first one says nothing and is still there; after the patience it is not.
    let silent = &mut slow[0];
    silent.set_nonblocking(true).unwrap();
    assert_eq!(silent.read(&mut [0; 9]).unwrap_err().kind(), ErrorKind::WouldBlock);
    silent.set_nonblocking(false).unwrap();
    silent.set_read_timeout(Some(LIMITS.longest)).unwrap();
    assert_eq!(silent.read(&mut [0; 9]).unwrap(), 0);
}

#[test]
fn more_than_may_are_refused_until_there_is_room() {
    let address = server(SHORT);
    let idle: Vec<TcpStream> = (0..SHORT.connections).map(|_| send(address, b"GET ")).collect();
    let mut refused = TcpStream::connect(address).unwrap();
    let mut answer = Vec::new();
    refused.read_to_end(&mut answer).unwrap();
    assert!(answer.starts_with(b"HTTP/1.1 503 "));
    drop(idle);
    let start = Instant::now();
    while !get(address, "/d").ends_with("/d") {
        assert!(start.elapsed() < SHORT.longest);
    }
}

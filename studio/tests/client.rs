//! A client of a few lines: one request a connection.

use serde_json::Value;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Duration;

/// An answer.
#[derive(Debug)]
pub(crate) struct Reply {
    pub(crate) status: u16,
    /// Names in lower case.
    pub(crate) headers: Vec<(String, String)>,
    pub(crate) body: Vec<u8>,
}

impl Reply {
    pub(crate) fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str())
    }

    pub(crate) fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|e| panic!("{e}: {}", self.text()))
    }

    pub(crate) fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }

    /// Status, code and message of a refusal.
    pub(crate) fn refusal(&self) -> (u16, String, String) {
        let error = &self.json()["error"];
        let text = |name: &str| error[name].as_str().unwrap().to_owned();
        (self.status, text("code"), text("message"))
    }
}

/// Sends bytes and takes what comes until the end.
pub(crate) fn raw(port: u16, request: &[u8]) -> Reply {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(120))).unwrap();
    stream.write_all(request).unwrap();
    let mut bytes = Vec::new();
    stream.read_to_end(&mut bytes).unwrap();
    parsed(&bytes)
}

fn parsed(bytes: &[u8]) -> Reply {
    let end = bytes.windows(4).position(|w| w == b"\r\n\r\n").unwrap_or_else(|| panic!("{bytes:?}"));
    let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
    let mut lines = head.lines();
    let status = lines.next().unwrap().split(' ').nth(1).unwrap().parse().unwrap();
    let header = |line: &str| line.split_once(": ").map(|(n, v)| (n.to_lowercase(), v.to_owned()));
    Reply { status, headers: lines.filter_map(header).collect(), body: bytes[end + 4..].to_vec() }
}

/// A page of a studio.
#[derive(Debug, Clone)]
pub(crate) struct Client {
    pub(crate) port: u16,
    pub(crate) token: String,
}

impl Client {
    /// By the address that a studio prints.
    pub(crate) fn of(address: &str) -> Self {
        let rest = address.strip_prefix("http://127.0.0.1:").unwrap();
        let (port, token) = rest.split_once("/?token=").unwrap();
        Client { port: port.parse().unwrap(), token: token.to_owned() }
    }

    /// A request with its cookie; more headers end with `\r\n` each.
    pub(crate) fn request(&self, method: &str, path: &str, headers: &str, body: &[u8]) -> Reply {
        let Client { port, token } = self;
        let head = format!(
            "{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nCookie: toile_{port}={token}\r\nConnection: close\r\n{headers}Content-Length: {}\r\n\r\n",
            body.len()
        );
        raw(*port, &[head.as_bytes(), body].concat())
    }

    pub(crate) fn get(&self, path: &str) -> Reply {
        self.request("GET", path, "", b"")
    }

    pub(crate) fn post(&self, path: &str, body: &Value) -> Reply {
        self.request("POST", path, "", body.to_string().as_bytes())
    }

    pub(crate) fn state(&self) -> Value {
        self.get("/api/state").json()
    }

    /// The number of the present text.
    pub(crate) fn edit_number(&self) -> u64 {
        self.state()["project"]["edit"].as_u64().unwrap()
    }

    /// Waits until the state is as wanted.
    pub(crate) fn wait(&self, what: &str, wanted: impl Fn(&Value) -> bool) -> Value {
        for _ in 0..2400 {
            let state = self.state();
            if wanted(&state) {
                return state;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        panic!("{what}: {:#}", self.state());
    }

    /// The events of a connection, while `more` asks for them.
    pub(crate) fn events(&self, mut more: impl FnMut(&str, &Value) -> bool) {
        let Client { port, token } = self;
        let mut stream = TcpStream::connect(("127.0.0.1", *port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        let head = format!(
            "GET /api/events HTTP/1.1\r\nHost: localhost:{port}\r\nAuthorization: Bearer {token}\r\n\r\n"
        );
        stream.write_all(head.as_bytes()).unwrap();
        let (mut text, mut buffer) = (String::new(), vec![0; 1 << 16]);
        loop {
            let n = stream.read(&mut buffer).unwrap();
            assert!(n > 0, "the events end: {text}");
            text.push_str(std::str::from_utf8(&buffer[..n]).unwrap());
            while let Some(end) = text.find("\n\n") {
                let event: String = text.drain(..end + 2).collect();
                let line = |name: &str| event.lines().find_map(|l| l.strip_prefix(name));
                let Some(data) = line("data: ") else { continue };
                let data = serde_json::from_str(data).unwrap_or_else(|e| panic!("{e}: {event}"));
                if !more(line("event: ").unwrap(), &data) {
                    return;
                }
            }
        }
    }
}

//! [`Server`]: serves a page over HTTP to this machine alone. It answers GET and HEAD for the page's files below a
//! secret path if the Host header names this machine; pages of other sites can neither guess nor read a file.

use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::page::Page;
use crate::Failure;

/// Maximum size of a request's head in bytes, and the time limit for reading it and for each write.
const MAX_HEAD: usize = 1 << 14;
const TIMEOUT: Duration = Duration::from_secs(10);

/// Maximum number of requests that are answered at a time.
const MAX_REQUESTS: usize = 64;

/// The page may run its own scripts and the simulator, and load its own files. A notebook on this machine may frame it.
const POLICY: &str = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' blob: data:; \
                      connect-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; \
                      frame-ancestors 'self' http://localhost:* http://127.0.0.1:*";

pub(super) struct Server {
    listener: TcpListener,
    site: Arc<Site>,
}

/// The page with the secrets of access to it. Each request that is being answered holds a reference to it.
struct Site {
    page: Page,
    /// The secret with which every path begins.
    token: String,
    port: u16,
}

/// A file of the page: its name and its bytes.
type File<'a> = (&'a str, &'a [u8]);

impl Server {
    pub(super) fn new(listener: TcpListener, page: Page) -> std::io::Result<Self> {
        let port = listener.local_addr()?.port();
        let site = Site {
            page,
            token: token(),
            port,
        };
        Ok(Self {
            listener,
            site: Arc::new(site),
        })
    }

    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.site.port, self.site.token)
    }

    /// Answers requests until the process ends.
    pub(super) fn serve(self) -> Result<(), Failure> {
        for stream in self.listener.incoming() {
            // It is not an error if the client aborts the connection before it is accepted.
            let Ok(stream) = stream else { continue };
            let site = Arc::clone(&self.site);
            // The server has a reference, too.
            if Arc::strong_count(&site) > MAX_REQUESTS + 1 {
                continue;
            }
            let work = move || {
                // On an error the client has gone away, so there is nobody to report it to.
                let _ = site.handle(stream);
            };
            std::thread::Builder::new().spawn(work).map_err(|error| {
                Failure::input(format!("threads: could not start one ({error}); end other programs"))
            })?;
        }
        Ok(())
    }
}

impl Site {
    fn handle(&self, mut stream: TcpStream) -> std::io::Result<()> {
        stream.set_read_timeout(Some(TIMEOUT))?;
        stream.set_write_timeout(Some(TIMEOUT))?;
        let head = head(&mut stream)?;
        let answer = self.answer(&head);
        let status = answer.err().unwrap_or("200 OK");
        let (name, bytes) = answer.unwrap_or(("", b""));
        let headers = format!(
            "HTTP/1.1 {status}\r\nContent-Type: {}\r\nContent-Length: {}\r\nContent-Security-Policy: {POLICY}\r\nX-Content-Type-Options: \
             nosniff\r\nReferrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\nCache-Control: \
             no-store\r\nConnection: close\r\n\r\n",
            media_type(name),
            bytes.len()
        );
        stream.write_all(headers.as_bytes())?;
        if !head.starts_with("HEAD ") {
            stream.write_all(bytes)?;
        }
        stream.flush()
    }

    /// The file that a request asks for, or else the status that refuses it.
    fn answer(&self, head: &str) -> Result<File<'_>, &'static str> {
        let mut lines = head.split("\r\n");
        let words: Vec<&str> = lines.next().unwrap_or_default().split(' ').collect();
        let [method, path, "HTTP/1.1" | "HTTP/1.0"] = words[..] else {
            return Err("400 Bad Request");
        };
        if !["GET", "HEAD"].contains(&method) {
            return Err("405 Method Not Allowed");
        }
        // Refuse other names that resolve to this machine (DNS rebinding).
        let host = lines.find_map(|line| {
            let (name, value) = line.split_once(':')?;
            name.eq_ignore_ascii_case("host").then_some(value.trim())
        });
        let own = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", self.port));
        if !host.is_some_and(|host| own.iter().any(|own| own == host)) {
            return Err("421 Misdirected Request");
        }
        let path = path.split('?').next().unwrap_or_default();
        let name = path
            .strip_prefix('/')
            .and_then(|path| path.strip_prefix(self.token.as_str()))
            .and_then(|path| path.strip_prefix('/'));
        let name = name.map(|name| if name.is_empty() { "index.html" } else { name });
        let file = name.and_then(|name| self.page.files().find(|(known, _)| *known == name));
        file.ok_or("404 Not Found")
    }
}

/// The head of a request, up to the empty line.
fn head(stream: &mut TcpStream) -> std::io::Result<String> {
    let (start, mut head, mut piece) = (Instant::now(), Vec::new(), [0; 1024]);
    while !head.windows(4).any(|end| end == b"\r\n\r\n") {
        let length = stream.read(&mut piece)?;
        if length == 0 || head.len() + length > MAX_HEAD || start.elapsed() > TIMEOUT {
            return Err(std::io::ErrorKind::InvalidData.into());
        }
        head.extend_from_slice(&piece[..length]);
    }
    Ok(String::from_utf8_lossy(&head).into_owned())
}

/// The media type of a file.
fn media_type(name: &str) -> &'static str {
    match name.rsplit('.').next().unwrap_or_default() {
        "html" => "text/html; charset=utf-8",
        "js" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "svg" => "image/svg+xml",
        "json" => "application/json",
        _ => "application/octet-stream",
    }
}

/// 128 random bits in hexadecimal: empty hashes under random keys from the system.
fn token() -> String {
    let random = |_| RandomState::new().build_hasher().finish();
    [0, 1].map(random).map(|half: u64| format!("{half:016x}")).concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn site() -> Site {
        let mut page = Page::of(&[("index.html", b"<p>"), ("networks/a.safetensors", b"1")]);
        page.add("task.json", b"{}".to_vec());
        Site {
            page,
            token: "secret".into(),
            port: 8008,
        }
    }

    #[test]
    fn only_files_of_the_page_are_served_below_the_token() {
        let site = site();
        let check = |line: &str, host: &str, expected: &str| {
            let answer = site.answer(&format!("{line} HTTP/1.1\r\nAccept: */*\r\nhost: {host}\r\n\r\n"));
            assert_eq!(answer.err().unwrap_or("200 OK"), expected, "{line} {host}");
        };
        let own = "127.0.0.1:8008";
        check("GET /secret/", own, "200 OK");
        check("GET /secret/index.html?x=1", "localhost:8008", "200 OK");
        check("HEAD /secret/networks/a.safetensors", own, "200 OK");
        for path in [
            "/",
            "/index.html",
            "/secre/",
            "/secret",
            "/secretx/",
            "/secret/../secret/",
            "/secret//etc/passwd",
            "/secret/%2e%2e/x",
        ] {
            check(&format!("GET {path}"), own, "404 Not Found");
        }
        for host in ["evil.example", "127.0.0.1", "127.0.0.1:80", "evil.example:8008"] {
            check("GET /secret/", host, "421 Misdirected Request");
        }
        check("POST /secret/", own, "405 Method Not Allowed");
        check("GET", own, "400 Bad Request");
        assert_eq!(
            site.answer("GET /secret/ HTTP/1.1\r\n\r\n"),
            Err("421 Misdirected Request")
        );
    }

    #[test]
    fn tokens_differ() {
        assert_ne!(token(), token());
        assert_eq!(token().len(), 32);
    }
}

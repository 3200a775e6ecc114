//! Serves a folder over HTTP on this machine alone.

use std::fs;
use std::io::{self, BufRead, BufReader, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;

use anyhow::{Context, Result, anyhow, bail, ensure};

/// What a page may load and run, a directive a line. The built page says the same of itself for hosts without headers,
/// but its workers only know what comes with them.
const POLICY: &str = include_str!("../../web/content_security_policy.txt");

/// The longest head of a request that is read.
const LONGEST_HEAD: usize = 64 * 1024;
/// Most header fields of a request; browsers send some twenty.
const MOST_FIELDS: usize = 100;

/// Kinds of files that a page consists of, by the ends of their names.
const TYPES: [(&str, &str); 15] = [
    ("css", "text/css; charset=utf-8"),
    ("html", "text/html; charset=utf-8"),
    ("ico", "image/x-icon"),
    ("jpg", "image/jpeg"),
    ("js", "text/javascript; charset=utf-8"),
    ("json", "application/json"),
    ("map", "application/json"),
    ("mjs", "text/javascript; charset=utf-8"),
    ("png", "image/png"),
    ("stl", "model/stl"),
    ("svg", "image/svg+xml"),
    ("txt", "text/plain; charset=utf-8"),
    ("wasm", "application/wasm"),
    ("webmanifest", "application/manifest+json"),
    ("woff2", "font/woff2"),
];

/// A running server; it lives until the process ends.
pub(crate) struct Server {
    address: SocketAddr,
    thread: JoinHandle<io::Result<()>>,
}

impl Server {
    /// Serves `folder` on 127.0.0.1 at `port` (0: a free one), with a thread for each connection: a browser keeps six.
    ///
    /// Errors when the port is taken.
    pub(crate) fn start(folder: &Path, port: u16) -> Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).with_context(|| {
            format!("cannot listen on port {port} of 127.0.0.1; choose another with --port (0: any free one)")
        })?;
        let address = listener.local_addr()?;
        let folder: Arc<Path> = folder.into();
        let thread = std::thread::spawn(move || {
            for stream in listener.incoming() {
                let (stream, folder) = (stream?, Arc::clone(&folder));
                // Who asked may go at any time, which is no failure of ours.
                std::thread::spawn(move || converse(stream, &folder));
            }
            Ok(())
        });
        Ok(Self { address, thread })
    }

    /// Where the folder is served, such as `http://127.0.0.1:8080/`.
    pub(crate) fn url(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// Asks for the page as a browser does.
    ///
    /// Errors when it is not answered.
    pub(crate) fn check(&self) -> Result<()> {
        let mut stream = TcpStream::connect(self.address)?;
        write!(
            stream,
            "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"
        )?;
        let mut status = String::new();
        BufReader::new(stream).read_line(&mut status)?;
        ensure!(
            status.contains(" 200 "),
            "the page is answered with {status}"
        );
        Ok(())
    }

    /// Waits until the server fails, which it normally does not.
    pub(crate) fn wait(self) -> Result<()> {
        let ended = self.thread.join();
        Ok(ended.map_err(|_| anyhow!("the server's thread ended in a panic"))??)
    }
}

/// Answers the requests of one connection until either side has had enough.
fn converse(stream: TcpStream, folder: &Path) -> Result<()> {
    stream.set_nodelay(true)?;
    let mut from = BufReader::new(stream.try_clone()?);
    let mut to = stream;
    loop {
        let head = match read_head(&mut from)? {
            Some(head) => head,
            None => return Ok(()),
        };
        let Ok(request) = Request::parse(&head) else {
            Answer::refusal("400 Bad Request").send(&mut to, true, true)?;
            bail!("not a request");
        };
        // A body that is not read would be taken for the next request.
        let last = request.wants_close || !request.may_be_answered();
        let answer = request.answer(folder);
        answer.send(&mut to, request.method != "HEAD", last)?;
        if last {
            return Ok(());
        }
    }
}

/// The lines up to the empty one; nothing where the other side has gone.
fn read_head(from: &mut impl BufRead) -> Result<Option<Vec<u8>>> {
    let mut head = Vec::new();
    while !head.ends_with(b"\r\n\r\n") {
        if from.read_until(b'\n', &mut head)? == 0 {
            return Ok(None);
        }
        if head.len() > LONGEST_HEAD {
            bail!("the head of a request is too long");
        }
    }
    Ok(Some(head))
}

/// What is asked for.
struct Request {
    method: String,
    path: String,
    wants_close: bool,
}

impl Request {
    fn parse(head: &[u8]) -> Result<Self> {
        let mut fields = [httparse::EMPTY_HEADER; MOST_FIELDS];
        let mut request = httparse::Request::new(&mut fields);
        if request.parse(head)?.is_partial() {
            bail!("the request is not complete");
        }
        let wants_close = request.headers.iter().any(|field| {
            field.name.eq_ignore_ascii_case("connection")
                && field.value.eq_ignore_ascii_case(b"close")
        });
        Ok(Self {
            method: request.method.context("no method")?.to_owned(),
            path: request.path.context("no path")?.to_owned(),
            wants_close: wants_close || request.version == Some(0),
        })
    }

    fn may_be_answered(&self) -> bool {
        matches!(self.method.as_str(), "GET" | "HEAD")
    }

    fn answer(&self, folder: &Path) -> Answer {
        if !self.may_be_answered() {
            return Answer::refusal("405 Method Not Allowed");
        }
        let file = file_of(&self.path, folder);
        let found = file.and_then(|file| Some((fs::read(&file).ok()?, file)));
        found.map_or(Answer::refusal("404 Not Found"), |(body, file)| Answer {
            status: "200 OK",
            fields: fields(&file, folder),
            body,
        })
    }
}

/// What is answered.
struct Answer {
    status: &'static str,
    fields: Vec<(&'static str, String)>,
    body: Vec<u8>,
}

impl Answer {
    fn refusal(status: &'static str) -> Self {
        Self {
            status,
            fields: vec![("Content-Type", "text/plain; charset=utf-8".to_owned())],
            body: status.into(),
        }
    }

    fn send(&self, to: &mut impl Write, with_body: bool, last: bool) -> io::Result<()> {
        let mut head = format!("HTTP/1.1 {}\r\n", self.status);
        for (name, value) in &self.fields {
            head += &format!("{name}: {value}\r\n");
        }
        if last {
            head += "Connection: close\r\n";
        }
        head += &format!("Content-Length: {}\r\n\r\n", self.body.len());
        let mut bytes = head.into_bytes();
        if with_body {
            bytes.extend(&self.body);
        }
        to.write_all(&bytes)
    }
}

/// The file that a request means: inside the folder, and a folder's `index.html`.
fn file_of(url: &str, folder: &Path) -> Option<PathBuf> {
    let path = url.split(['?', '#']).next()?.strip_prefix('/')?;
    let path = PathBuf::from(decoded(path)?);
    let inside = |part| matches!(part, Component::Normal(_));
    if !path.components().all(inside) {
        return None;
    }
    let mut file = folder.join(path);
    if file.is_dir() {
        file.push("index.html");
    }
    file.is_file().then_some(file)
}

/// Text whose `%41` are letters again.
fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, others @ ..] = rest {
        rest = others;
        if *first != b'%' {
            bytes.push(*first);
            continue;
        }
        let hex = std::str::from_utf8(others.get(..2)?).ok()?;
        bytes.push(u8::from_str_radix(hex, 16).ok()?);
        rest = &others[2..];
    }
    String::from_utf8(bytes).ok()
}

/// Files the bundler names by a hash of their content never change; everything else is asked for again.
fn fields(file: &Path, folder: &Path) -> Vec<(&'static str, String)> {
    let ending = file.extension().and_then(|ending| ending.to_str());
    let kind = TYPES.iter().find(|(known, _)| Some(*known) == ending);
    let kind = kind.map_or("application/octet-stream", |(_, kind)| kind);
    let lasting = if file.starts_with(folder.join("assets")) {
        "public, max-age=31536000, immutable"
    } else {
        "no-cache"
    };
    // That no other page may frame this one can be said in a header alone.
    let policy: Vec<&str> = POLICY.lines().chain(["frame-ancestors 'none'"]).collect();
    vec![
        ("Content-Type", kind.to_owned()),
        ("Cache-Control", lasting.to_owned()),
        ("Content-Security-Policy", policy.join("; ")),
        ("X-Content-Type-Options", "nosniff".to_owned()),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    /// A folder to serve inside a folder with a secret, removed at the end.
    struct Site(PathBuf);

    impl Site {
        fn new(name: &str) -> Self {
            let outer =
                std::env::temp_dir().join(format!("fluoropose-{name}-{}", std::process::id()));
            std::fs::create_dir_all(outer.join("site/assets")).unwrap();
            std::fs::write(outer.join("secret"), "secret").unwrap();
            std::fs::write(outer.join("site/index.html"), "<p>page").unwrap();
            std::fs::write(outer.join("site/assets/core.wasm"), b"\0asm").unwrap();
            Self(outer)
        }

        fn get(&self, server: &Server, path: &str) -> String {
            self.ask(server, "GET", path)
        }

        fn ask(&self, server: &Server, method: &str, path: &str) -> String {
            let mut stream = TcpStream::connect(server.address).unwrap();
            write!(
                stream,
                "{method} {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"
            )
            .unwrap();
            let mut answer = Vec::new();
            stream.read_to_end(&mut answer).unwrap();
            String::from_utf8_lossy(&answer).into_owned()
        }
    }

    impl Drop for Site {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn files_come_with_type_and_cache_headers() {
        let site = Site::new("serve");
        let server = Server::start(&site.0.join("site"), 0).unwrap();
        let page = site.get(&server, "/").to_lowercase();
        assert!(
            page.starts_with("http/1.1 200") && page.ends_with("<p>page"),
            "{page}"
        );
        assert!(
            page.contains("content-type: text/html") && page.contains("cache-control: no-cache"),
            "{page}"
        );
        assert!(
            page.contains("content-security-policy: default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; "),
            "{page}"
        );
        let module = site.get(&server, "/assets/core.wasm").to_lowercase();
        assert!(
            module.contains("content-type: application/wasm") && module.contains("immutable"),
            "{module}"
        );
    }

    #[test]
    fn nothing_outside_the_folder_is_served() {
        let site = Site::new("outside");
        let server = Server::start(&site.0.join("site"), 0).unwrap();
        for path in [
            "/../secret",
            "/%2e%2e/secret",
            "/assets/..%2f..%2fsecret",
            "//etc/passwd",
            "/missing",
        ] {
            let answer = site.get(&server, path);
            assert!(answer.starts_with("HTTP/1.1 4"), "{path}: {answer}");
        }
    }

    #[test]
    fn a_taken_port_is_told() {
        let site = Site::new("taken");
        let first = Server::start(&site.0.join("site"), 0).unwrap();
        let error = Server::start(&site.0.join("site"), first.address.port())
            .err()
            .unwrap();
        assert!(error.to_string().contains("--port"), "{error}");
    }

    #[test]
    fn a_head_has_the_length_and_no_body_and_nothing_else_is_answered() {
        let site = Site::new("head");
        let server = Server::start(&site.0.join("site"), 0).unwrap();
        let head = site.ask(&server, "HEAD", "/index.html").to_lowercase();
        assert!(
            head.starts_with("http/1.1 200") && head.contains("content-length: 7"),
            "{head}"
        );
        assert!(head.ends_with("\r\n\r\n"), "{head}");
        let nonsense = site.ask(&server, "G E T", "/");
        assert!(nonsense.starts_with("HTTP/1.1 400"), "{nonsense}");
        let post = site.ask(&server, "POST", "/");
        assert!(post.starts_with("HTTP/1.1 405"), "{post}");
    }

    #[test]
    fn a_long_file_comes_whole_with_its_length() {
        let site = Site::new("long");
        std::fs::write(site.0.join("site/long.bin"), vec![b'x'; 200_000]).unwrap();
        let server = Server::start(&site.0.join("site"), 0).unwrap();
        let answer = site.get(&server, "/long.bin");
        assert!(answer.to_lowercase().contains("content-length: 200000"));
        assert_eq!(answer.split("\r\n\r\n").nth(1).unwrap().len(), 200_000);
    }

    #[test]
    fn connections_are_kept_and_several_are_served_at_once() {
        let site = Site::new("kept");
        let server = Server::start(&site.0.join("site"), 0).unwrap();
        let connect = || {
            let stream = TcpStream::connect(server.address).unwrap();
            let limit = std::time::Duration::from_secs(20);
            stream.set_read_timeout(Some(limit)).unwrap();
            stream
        };
        let mut streams: Vec<TcpStream> = (0..8).map(|_| connect()).collect();
        for _ in 0..3 {
            for stream in &mut streams {
                write!(
                    stream,
                    "GET /a%73sets/core.wasm?x HTTP/1.1\r\nHost: localhost\r\n\r\n"
                )
                .unwrap();
            }
            for stream in &mut streams {
                let mut answer = Vec::new();
                while !answer.ends_with(b"\0asm") {
                    let mut bytes = [0; 256];
                    let count = stream.read(&mut bytes).unwrap();
                    assert!(count > 0, "the connection was closed");
                    answer.extend(&bytes[..count]);
                }
            }
        }
    }
}

//! Serves a folder over HTTP on this machine alone.

use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::Path;
use std::thread::JoinHandle;

use anyhow::{Context, Result, anyhow};
use axum::Router;
use axum::http::HeaderValue;
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, HeaderName, X_CONTENT_TYPE_OPTIONS,
};
use tower_http::services::ServeDir;
use tower_http::set_header::SetResponseHeaderLayer;

/// What a page may load and run, a directive a line. The built page says the same of itself for hosts without headers,
/// but its workers only know what comes with them.
const POLICY: &str = include_str!("../../web/content_security_policy.txt");

/// A running server; it lives until the process ends.
pub struct Server {
    address: SocketAddr,
    thread: JoinHandle<Result<()>>,
}

impl Server {
    /// Serves `folder` on 127.0.0.1 at `port` (0: a free one) from a thread of its own.
    ///
    /// Errors when the port is taken.
    pub fn start(folder: &Path, port: u16) -> Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).with_context(|| {
            format!("cannot listen on port {port} of 127.0.0.1; choose another with --port (0: any free one)")
        })?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        let app = router(folder)?;
        let thread = std::thread::spawn(move || serve(listener, app));
        Ok(Self { address, thread })
    }

    /// Where the folder is served, such as `http://127.0.0.1:8080/`.
    pub fn url(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// Waits until the server fails, which it normally does not.
    pub fn wait(self) -> Result<()> {
        self.thread
            .join()
            .map_err(|_| anyhow!("the server's thread ended in a panic"))?
    }
}

/// Files the bundler names by a hash of their content never change; everything else is asked for again.
fn router(folder: &Path) -> Result<Router> {
    let hashed = Router::new()
        .fallback_service(ServeDir::new(folder.join("assets")))
        .layer(header(CACHE_CONTROL, "public, max-age=31536000, immutable"));
    let rest = Router::new()
        .fallback_service(ServeDir::new(folder))
        .layer(header(CACHE_CONTROL, "no-cache"));
    Ok(Router::new()
        .nest("/assets", hashed)
        .fallback_service(rest)
        .layer(SetResponseHeaderLayer::overriding(
            CONTENT_SECURITY_POLICY,
            policy()?,
        ))
        .layer(header(X_CONTENT_TYPE_OPTIONS, "nosniff")))
}

fn policy() -> Result<HeaderValue> {
    // That no other page may frame this one can be said in a header alone.
    let directives: Vec<&str> = POLICY.lines().chain(["frame-ancestors 'none'"]).collect();
    Ok(HeaderValue::from_str(&directives.join("; "))?)
}

fn header(name: HeaderName, value: &'static str) -> SetResponseHeaderLayer<HeaderValue> {
    SetResponseHeaderLayer::overriding(name, HeaderValue::from_static(value))
}

fn serve(listener: TcpListener, app: Router) -> Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_io()
        .enable_time()
        .build()?;
    runtime.block_on(async {
        let listener = tokio::net::TcpListener::from_std(listener)?;
        axum::serve(listener, app).await?;
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read, Write};
    use std::net::TcpStream;
    use std::path::PathBuf;

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
            let mut stream = TcpStream::connect(server.address).unwrap();
            write!(
                stream,
                "GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"
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
}

//! What is refused, word for word.

use crate::client::{Client, raw};
use crate::kit::{MASKS, Served, folder};
use serde_json::json;

fn of(text: &str) -> (u16, String, String) {
    let mut parts = text.splitn(3, ' ');
    let mut next = || parts.next().unwrap().to_owned();
    (next().parse().unwrap(), next(), next())
}

#[test]
fn the_address_with_the_token_gives_a_cookie_and_nothing_else_does() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let Client { port, token } = &served.client;
    let ask = |path: &str, more: &str| {
        raw(
            *port,
            format!("GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: close\r\n{more}\r\n")
                .as_bytes(),
        )
    };
    let welcome = ask(&format!("/?token={token}"), "");
    assert_eq!((welcome.status, welcome.header("location")), (303, Some("/")));
    let cookie = format!("toile_{port}={token}; HttpOnly; SameSite=Strict; Path=/");
    assert_eq!(welcome.header("set-cookie"), Some(cookie.as_str()));
    assert_eq!(token.len(), 64);
    let page = ask("/", &format!("Cookie: other=1; toile_{port}={token}\r\n"));
    assert_eq!((page.status, page.header("content-type")), (200, Some("text/html; charset=utf-8")));
    assert!(page.text().contains("<html"));
    assert_eq!(ask("/api/state", &format!("Authorization: Bearer {token}\r\n")).status, 200);

    let lacks = of("403 forbidden the request lacks the token of this studio");
    let wrong = token.replace(|c: char| c.is_ascii_digit(), "f");
    for more in
        ["".to_owned(), format!("Cookie: toile_{port}={wrong}\r\n"), "Authorization: Bearer \r\n".into()]
    {
        assert_eq!(ask("/api/state", &more).refusal(), lacks, "{more}");
        assert_eq!(ask("/", &more).refusal(), lacks, "{more}");
    }
    let other = of("403 forbidden the token in the address is not that of this studio");
    assert_eq!(ask(&format!("/?token={wrong}"), "").refusal(), other);
    assert_eq!(ask("/?token=", "").json()["error"]["hint"], "open the address that `toile studio` printed");
    assert_eq!(ask(&format!("/api/state?token={token}"), "").refusal(), lacks);
}

#[test]
fn other_hosts_and_origins_are_refused() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let Client { port, token } = &served.client;
    let ask = |host: &str, more: &str| {
        let head = format!(
            "GET /api/state HTTP/1.1\r\n{host}Authorization: Bearer {token}\r\nConnection: close\r\n{more}\r\n"
        );
        raw(*port, head.as_bytes())
    };
    let ours = format!("Host: localhost:{port}\r\n");
    assert_eq!(ask(&ours, "").status, 200);
    assert_eq!(ask(&ours, &format!("Origin: http://127.0.0.1:{port}\r\n")).status, 200);
    assert_eq!(
        ask("Host: evil.example\r\n", "").refusal(),
        of("403 forbidden the host \"evil.example\" is not this server")
    );
    assert_eq!(ask("Host: localhost\r\n", "").status, 403, "without the port");
    assert_eq!(ask("Host: \r\n", "").refusal(), of("403 forbidden the host \"\" is not this server"));
    for origin in ["http://evil.example", "null", "https://localhost:1", "http://127.0.0.1:1"] {
        let refusal = ask(&ours, &format!("Origin: {origin}\r\n")).refusal();
        assert_eq!(refusal, of(&format!("403 forbidden the origin \"{origin}\" is not this server")));
    }
    assert_eq!(raw(*port, b"GET / HTTP/1.0\r\n\r\n").status, 403, "without a host");
}

#[test]
fn every_answer_has_the_headers_that_keep_the_page_apart() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let client = &served.client;
    let refused = raw(client.port, b"GET / HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
    for reply in [client.get("/"), client.get("/api/state"), client.get("/api/nothing"), refused] {
        assert_eq!(
            reply.header("content-security-policy"),
            Some(
                "default-src 'self'; img-src 'self' data: blob:; style-src 'self'; connect-src 'self'; frame-ancestors 'none'"
            )
        );
        assert_eq!(reply.header("x-content-type-options"), Some("nosniff"));
        assert_eq!(reply.header("referrer-policy"), Some("no-referrer"));
        assert_eq!(reply.header("cache-control"), Some("no-store"));
    }
}

#[test]
fn bodies_beyond_their_limit_are_not_read() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let Client { port, token } = &served.client;
    let announced = |path: &str, bytes: u64| {
        let head = format!(
            "POST {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nAuthorization: Bearer {token}\r\nConnection: close\r\nContent-Length: {bytes}\r\n\r\n"
        );
        raw(*port, head.as_bytes()).refusal()
    };
    let large = of("413 too_large the body is larger than 64 MB");
    assert_eq!(announced("/api/upload?name=a.jpg", 1_000_000_000), large);
    assert_eq!(announced("/api/edit", 2 << 20), of("413 too_large the body is larger than 1 MB"));
    // Without a word of its length.
    let mut sent = format!(
        "POST /api/edit HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nAuthorization: Bearer {token}\r\nConnection: close\r\nTransfer-Encoding: chunked\r\n\r\n"
    )
    .into_bytes();
    for _ in 0..17 {
        sent.extend_from_slice(b"10000\r\n");
        sent.extend(std::iter::repeat_n(b' ', 0x10000));
        sent.extend_from_slice(b"\r\n");
    }
    assert_eq!(raw(*port, &sent).refusal(), of("413 too_large the body is larger than 1 MB"));
    assert!(!dir.path().join("a.jpg").exists());
}

#[test]
fn malformed_requests_are_refused_in_words() {
    let dir = folder(MASKS);
    let served = Served::new(dir.path(), false);
    let client = &served.client;
    let sent = |body: &str| client.request("POST", "/api/edit", "", body.as_bytes()).refusal();
    let is_not = "400 malformed the body is not what is asked for: ";
    assert_eq!(sent("{"), of(&format!("{is_not}EOF while parsing an object at line 1 column 1")));
    assert_eq!(sent("{\"edit\": 1}"), of(&format!("{is_not}missing field `changes` at line 1 column 11")));
    assert_eq!(
        sent("{\"edit\": 1, \"changes\": [{\"sett\": 1}]}"),
        of(&format!(
            "{is_not}unknown variant `sett`, expected one of `set`, `remove`, `swap`, `add`, `text` at line 1 column 31"
        ))
    );
    assert_eq!(sent("{\"edit\": 1, \"changes\": []}"), of("400 malformed there is no change in `changes`"));
    assert_eq!(
        client.get("/api/nothing").refusal(),
        of("404 not_found there is nothing at \"/api/nothing\"")
    );
    assert_eq!(client.get("/missing.js").refusal(), of("404 not_found there is nothing at \"/missing.js\""));
    assert_eq!(client.get("/api/edit").refusal(), of("405 no_method \"/api/edit\" does not take GET"));
    assert_eq!(client.get("/api/photo/front").refusal(), of("404 not_found there is no photo \"front\" yet"));
    assert_eq!(client.get("/api/garment").refusal(), of("404 not_found there is no garment yet"));
    assert_eq!(client.get("/api/texture/x").refusal(), of("404 not_found there is no texture x"));
    let before = "404 not_found there is no garment from before the last edit";
    assert_eq!(client.get("/api/before").refusal(), of(before));
    assert_eq!(
        client.post("/api/print", &json!({ "writer": "Glb()" })).refusal(),
        of("400 malformed `Glb` is no writer of patterns")
    );
    assert_eq!(raw(client.port, b"nonsense\r\n\r\n").status, 400);
    assert_eq!(client.state()["project"]["edit"], 1, "nothing was changed");
}

#[test]
fn no_path_leaves_the_folders() {
    let dir = folder(MASKS);
    std::fs::create_dir(dir.path().join("out")).unwrap();
    std::fs::write(dir.path().join("out/a.txt"), "result").unwrap();
    std::fs::create_dir(dir.path().join("out/deep")).unwrap();
    std::fs::write(dir.path().join("out/deep/b.txt"), "deeper").unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink(dir.path().join("front.jpg"), dir.path().join("out/link.jpg")).unwrap();
    let served = Served::new(dir.path(), false);
    let client = &served.client;
    assert_eq!(client.get("/api/out/deep/b.txt").text(), "deeper");
    let listed = json!({ "files": [{ "path": "a.txt", "bytes": 6 }, { "path": "deep/b.txt", "bytes": 6 }] });
    assert_eq!(client.get("/api/out").json(), listed);
    let policy = client.get("/api/out/a.txt").header("content-security-policy").unwrap().to_owned();
    assert!(policy.starts_with("sandbox allow-scripts; default-src 'none';"), "{policy}");
    for path in [
        "../pipeline.ron",
        "..%2fpipeline.ron",
        "deep/../../pipeline.ron",
        "%2e%2e/pipeline.ron",
        "/etc/passwd",
        "%2fetc%2fpasswd",
        "..%5cpipeline.ron",
        "link.jpg",
        "a.txt%00",
        "deep",
    ] {
        let reply = client.get(&format!("/api/out/{path}"));
        assert_eq!(reply.status, 404, "{path}: {}", reply.text());
    }
    let message = "404 not_found there is no file \"../pipeline.ron\" in \"out\"";
    assert_eq!(client.get("/api/out/..%2fpipeline.ron").refusal(), of(message));
    for path in ["/../Cargo.toml", "/%2e%2e/Cargo.toml", "//etc/passwd"] {
        assert_eq!(client.get(path).status, 404, "{path}");
    }
}

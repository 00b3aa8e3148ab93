//! Who may ask: pages of this very server, by a token that stands in the address that is printed.
//!
//! A page of another origin can send requests to 127.0.0.1, and a name of its own may lead there:
//! so `Host` and `Origin` must be this server's, and the cookie is never sent by other sites.

use super::answer::{AnswerBody, HttpAnswer, refused};
use crate::fault::StudioFault;
use hyper::header::{self, HeaderMap, HeaderName, HeaderValue};
use hyper::{Request, Response, StatusCode, Uri};

/// Bytes of the token.
const TOKEN_BYTES: usize = 32;

/// What helps who has no token.
const PRINTED: &str = "open the address that `toile studio` printed";

/// What every answer carries: the page takes nothing from elsewhere, and nothing is kept.
const HEADERS: [(HeaderName, &str); 4] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'self'; img-src 'self' data: blob:; style-src 'self'; connect-src 'self'; frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (header::CACHE_CONTROL, "no-store"),
];

/// The token and the names under which the server is known.
#[derive(Debug)]
pub(super) struct Guard {
    port: u16,
    token: String,
    hosts: [String; 2],
}

impl Guard {
    /// With a new token.
    ///
    /// Errors: the system gives no random bytes.
    pub(super) fn new(port: u16) -> Result<Self, StudioFault> {
        let mut bytes = [0; TOKEN_BYTES];
        let failed = |e| StudioFault::new("internal", format!("the system gives no random bytes: {e}"));
        getrandom::fill(&mut bytes).map_err(failed)?;
        let token = bytes.iter().map(|b| format!("{b:02x}")).collect();
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}"));
        Ok(Guard { port, token, hosts })
    }

    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.port, self.token)
    }

    fn cookie_name(&self) -> String {
        format!("toile_{}", self.port)
    }

    /// The answer to the address with the token: the page, from now on by a cookie.
    fn welcome(&self) -> HttpAnswer {
        let cookie = format!("{}={}; HttpOnly; SameSite=Strict; Path=/", self.cookie_name(), self.token);
        let mut answer = Response::new(AnswerBody::Whole(None));
        *answer.status_mut() = StatusCode::SEE_OTHER;
        answer.headers_mut().insert(header::LOCATION, HeaderValue::from_static("/"));
        if let Ok(cookie) = HeaderValue::from_str(&cookie) {
            answer.headers_mut().insert(header::SET_COOKIE, cookie);
        }
        answer
    }

    /// The answer to a request that may not ask for more; none where it may.
    pub(super) fn refusal<B>(&self, request: &Request<B>) -> Option<HttpAnswer> {
        if let Err(fault) = self.check_place(request.headers()) {
            return Some(refused(fault));
        }
        match self.asked_by_address(request.uri()) {
            Some(true) => Some(self.welcome()),
            Some(false) => {
                let message = "the token in the address is not that of this studio";
                Some(refused(StudioFault::new("forbidden", message).hint(PRINTED)))
            }
            None => self.check_token(request.headers()).err().map(refused),
        }
    }

    /// Whether a request comes to this server, from its own pages.
    fn check_place(&self, headers: &HeaderMap) -> Result<(), StudioFault> {
        let is_ours = |host: &str| self.hosts.iter().any(|h| h == host);
        let text = |name: HeaderName| headers.get(name).map(|v| v.to_str().unwrap_or(""));
        match text(header::HOST) {
            Some(host) if is_ours(host) => {}
            host => {
                let message = format!("the host \"{}\" is not this server", host.unwrap_or(""));
                return Err(StudioFault::new("forbidden", message));
            }
        }
        match text(header::ORIGIN) {
            Some(origin) if !origin.strip_prefix("http://").is_some_and(is_ours) => {
                Err(StudioFault::new("forbidden", format!("the origin \"{origin}\" is not this server")))
            }
            _ => Ok(()),
        }
    }

    /// Whether the token that the address gives is right; none where it gives none.
    fn asked_by_address(&self, uri: &Uri) -> Option<bool> {
        let query = uri.query().filter(|_| uri.path() == "/")?;
        let token = query.split('&').find_map(|part| part.strip_prefix("token="))?;
        Some(self.is_token(token))
    }

    fn check_token(&self, headers: &HeaderMap) -> Result<(), StudioFault> {
        let name = format!("{}=", self.cookie_name());
        let cookies = headers.get_all(header::COOKIE).iter().filter_map(|v| v.to_str().ok());
        let mut by_cookie =
            cookies.flat_map(|all| all.split(';')).filter_map(|c| c.trim().strip_prefix(&name));
        let bearer =
            headers.get(header::AUTHORIZATION).and_then(|v| v.to_str().ok()?.strip_prefix("Bearer "));
        match by_cookie.any(|token| self.is_token(token)) || bearer.is_some_and(|token| self.is_token(token))
        {
            true => Ok(()),
            false => {
                Err(StudioFault::new("forbidden", "the request lacks the token of this studio").hint(PRINTED))
            }
        }
    }

    /// Compares all bytes, so that the time tells nothing.
    fn is_token(&self, token: &str) -> bool {
        let differs = |(a, b): (u8, u8)| a ^ b;
        token.len() == self.token.len()
            && token.bytes().zip(self.token.bytes()).map(differs).fold(0, |all, d| all | d) == 0
    }
}

/// An answer with the headers that every one has; those that it brings stay.
pub(super) fn sealed(mut answer: HttpAnswer) -> HttpAnswer {
    for (name, value) in HEADERS {
        answer.headers_mut().entry(name).or_insert(HeaderValue::from_static(value));
    }
    answer
}

/// What holds of results in place of the page's own rule: reports bring scripts and looks within
/// them, which run apart from this server, without its cookie, and reach nothing.
pub(super) const APART: (HeaderName, HeaderValue) = (
    header::CONTENT_SECURITY_POLICY,
    HeaderValue::from_static(
        "sandbox allow-scripts; default-src 'none'; script-src 'unsafe-inline' blob:; style-src 'unsafe-inline'; \
         img-src data: blob:; media-src data: blob:; font-src data:; worker-src blob:; frame-ancestors 'none'",
    ),
);

//! The studio over HTTP, on this machine alone.
//!
//! - `guard`: who may ask; `routes`: what can be asked; `events`: news as they come; `answer`:
//!   bodies and refusals.
//!
//! Requests are answered on threads for blocking work, so that the one thread of the server is free
//! for others meanwhile.

mod answer;
mod events;
mod guard;
mod routes;

use crate::fault::StudioFault;
use crate::studio::{Studio, StudioOptions};
use guard::Guard;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::TokioIo;
use std::convert::Infallible;
use std::net::{Ipv4Addr, TcpListener};
use std::sync::Arc;
use std::time::Duration;
use tokio::time::timeout;

/// Time between two looks whether to stop.
const LOOK: Duration = Duration::from_millis(50);

/// A studio that listens.
#[derive(Debug)]
pub struct StudioServer {
    listener: TcpListener,
    guard: Arc<Guard>,
    studio: Arc<Studio>,
}

impl StudioServer {
    /// Opens a project and listens on a port, or on a free one.
    ///
    /// Errors: those of [`Studio::open`]; the port is taken; the system gives no random bytes.
    pub fn open(options: StudioOptions, port: Option<u16>) -> Result<Self, StudioFault> {
        let studio = Arc::new(Studio::open(options)?);
        let refused = |e: std::io::Error| {
            let at = port.map_or_else(|| "a free port".to_owned(), |port| format!("port {port}"));
            let fault = StudioFault::new("port", format!("cannot listen on {at} of 127.0.0.1: {e}"));
            if port.is_some() { fault.hint("take another with --port, or leave it out") } else { fault }
        };
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port.unwrap_or(0))).map_err(refused)?;
        listener.set_nonblocking(true).map_err(refused)?;
        let port = listener.local_addr().map_err(refused)?.port();
        let guard = Arc::new(Guard::new(port)?);
        Ok(StudioServer { listener, guard, studio })
    }

    /// The address to open, with its token.
    pub fn address(&self) -> String {
        self.guard.address()
    }

    /// Answers until `stopped`.
    ///
    /// Errors: the system refuses to listen any longer.
    pub fn serve(self, stopped: impl Fn() -> bool) -> Result<(), StudioFault> {
        let failed = |e: std::io::Error| StudioFault::new("internal", format!("the server ended: {e}"));
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(failed)?;
        let StudioServer { listener, guard, studio } = self;
        let outcome = runtime.block_on(async move {
            let listener = tokio::net::TcpListener::from_std(listener)?;
            while !stopped() {
                // Of the errors of one connection the others know nothing.
                if let Ok(Ok((stream, _))) = timeout(LOOK, listener.accept()).await {
                    let _ = stream.set_nodelay(true);
                    tokio::spawn(connection(stream, guard.clone(), studio.clone()));
                }
            }
            Ok(())
        });
        // Pages that listen for events would never end by themselves.
        runtime.shutdown_background();
        outcome.map_err(failed)
    }
}

/// Answers the requests of one connection.
async fn connection(stream: tokio::net::TcpStream, guard: Arc<Guard>, studio: Arc<Studio>) {
    let answer = service_fn(move |request| {
        let (guard, studio) = (guard.clone(), studio.clone());
        async move {
            let answer = match guard.refusal(&request) {
                Some(answer) => answer,
                None => routes::answer(studio, request).await,
            };
            Ok::<_, Infallible>(guard::sealed(answer))
        }
    });
    // A client that goes away is no fault.
    let _ = http1::Builder::new().serve_connection(TokioIo::new(stream), answer).await;
}

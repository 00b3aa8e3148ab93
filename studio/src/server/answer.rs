//! Bodies of requests, and answers.

use crate::fault::StudioFault;
use hyper::body::{Body, Bytes, Frame, Incoming, SizeHint};
use hyper::header::{self, HeaderName, HeaderValue};
use hyper::{Request, Response, StatusCode};
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::convert::Infallible;
use std::future::poll_fn;
use std::pin::Pin;
use std::task::{Context, Poll};
use tokio::sync::mpsc::Receiver;

/// The largest body of a request, bytes.
pub(super) const MOST_BODY: usize = 1 << 20;
/// The largest upload, bytes.
pub(super) const MOST_UPLOAD: usize = 64 << 20;

/// An answer.
pub(super) type HttpAnswer = Response<AnswerBody>;

/// What an answer holds.
#[derive(Debug)]
pub(super) enum AnswerBody {
    /// All of it; none once it is sent.
    Whole(Option<Bytes>),
    /// What comes, until its sender ends.
    Pieces(Receiver<String>),
}

impl Body for AnswerBody {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(
        self: Pin<&mut Self>,
        cx: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        match self.get_mut() {
            AnswerBody::Whole(bytes) => Poll::Ready(bytes.take().map(|bytes| Ok(Frame::data(bytes)))),
            AnswerBody::Pieces(pieces) => {
                pieces.poll_recv(cx).map(|piece| piece.map(|text| Ok(Frame::data(text.into()))))
            }
        }
    }

    fn is_end_stream(&self) -> bool {
        matches!(self, AnswerBody::Whole(None))
    }

    fn size_hint(&self) -> SizeHint {
        match self {
            AnswerBody::Whole(bytes) => SizeHint::with_exact(bytes.as_ref().map_or(0, |b| b.len() as u64)),
            AnswerBody::Pieces(_) => SizeHint::default(),
        }
    }
}

/// The body of a request, of so many bytes at most.
///
/// Errors: `too_large`; what is beyond is not read. `malformed` where it breaks off.
pub(super) async fn body(mut request: Request<Incoming>, most: usize) -> Result<Vec<u8>, StudioFault> {
    let too_large = || StudioFault::new("too_large", format!("the body is larger than {} MB", most >> 20));
    if request.body().size_hint().lower() > most as u64 {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    while let Some(frame) = poll_fn(|cx| Pin::new(request.body_mut()).poll_frame(cx)).await {
        let frame = frame.map_err(|e| StudioFault::malformed(format!("the body breaks off: {e}")))?;
        if let Ok(data) = frame.into_data() {
            if bytes.len() + data.len() > most {
                return Err(too_large());
            }
            bytes.extend_from_slice(&data);
        }
    }
    Ok(bytes)
}

/// The body of a request as JSON of a form.
///
/// Errors: those of [`body`]; `malformed` with what the reader says.
pub(super) async fn form<T: DeserializeOwned>(request: Request<Incoming>) -> Result<T, StudioFault> {
    let bytes = body(request, MOST_BODY).await?;
    serde_json::from_slice(&bytes)
        .map_err(|e| StudioFault::malformed(format!("the body is not what is asked for: {e}")))
}

/// Does the work of a request on a thread where it may block.
pub(super) async fn answered(
    work: impl FnOnce() -> Result<HttpAnswer, StudioFault> + Send + 'static,
) -> HttpAnswer {
    match tokio::task::spawn_blocking(work).await {
        Ok(Ok(answer)) => answer,
        Ok(Err(fault)) => refused(fault),
        Err(_) => refused(
            StudioFault::new("internal", "the studio panicked over this request")
                .hint(toile_core::panics::REPORT),
        ),
    }
}

/// A refusal as an answer.
pub(super) fn refused(fault: StudioFault) -> HttpAnswer {
    let status = StatusCode::from_u16(fault.status()).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
    let mut answer = as_json(&json!({ "error": fault }));
    *answer.status_mut() = status;
    answer
}

/// JSON as an answer.
pub(super) fn as_json(value: &Value) -> HttpAnswer {
    bytes("application/json", value.to_string().into_bytes())
}

/// Bytes of a kind as an answer.
pub(super) fn bytes(kind: &'static str, bytes: impl Into<Bytes>) -> HttpAnswer {
    with(AnswerBody::Whole(Some(bytes.into())), header::CONTENT_TYPE, HeaderValue::from_static(kind))
}

/// A body with a header as an answer.
pub(super) fn with(body: AnswerBody, name: HeaderName, value: HeaderValue) -> HttpAnswer {
    let mut answer = Response::new(body);
    answer.headers_mut().insert(name, value);
    answer
}

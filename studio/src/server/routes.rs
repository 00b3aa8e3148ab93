//! What can be asked.

use super::answer::{HttpAnswer, MOST_UPLOAD, answered, as_json, body, bytes, form, refused};
use super::events::events;
use super::guard::APART;
use crate::fault::StudioFault;
use crate::page;
use crate::project::begin::BeginWith;
use crate::project::change::StudioChange;
use crate::studio::Studio;
use hyper::body::Incoming;
use hyper::header::{HeaderName, HeaderValue};
use hyper::{Method, Request, Uri};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::json;
use std::sync::Arc;

/// Meshes of garments and bodies.
const MESH: &str = "application/octet-stream";

/// The scale of a photo on the page.
const SCALE: HeaderName = HeaderName::from_static("x-scale");

/// Requests by POST.
const POSTS: [&str; 10] = ["edit", "sew", "undo", "redo", "save", "run", "stop", "upload", "begin", "print"];

/// Requests by GET; some go on with a name behind `/`.
const GETS: [&str; 15] = [
    "state", "events", "cards", "photo", "mask", "view", "garment", "moving", "start", "before", "body",
    "texture", "out", "measures", "trade",
];

/// Answers a request that the guard has let in.
pub(super) async fn answer(studio: Arc<Studio>, request: Request<Incoming>) -> HttpAnswer {
    let path = request.uri().path().to_owned();
    let Some(asked) = path.strip_prefix("/api/") else { return file(&request) };
    let (what, name) = asked.split_once('/').map_or((asked, None), |(what, name)| (what, Some(name)));
    let is_known = |all: &[&str]| all.contains(&what);
    match *request.method() {
        Method::POST if is_known(&POSTS) && name.is_none() => post(studio, what, request).await,
        Method::GET if is_known(&GETS) => match decoded(name.unwrap_or("")) {
            Some(name) if what == "events" && name.is_empty() => events(studio),
            Some(name) => {
                let what = what.to_owned();
                answered(move || get(&studio, &what, &name)).await
            }
            None => refused(nothing(&path)),
        },
        _ if is_known(&POSTS) || is_known(&GETS) => no_method(&request),
        _ => refused(nothing(&path)),
    }
}

fn nothing(path: &str) -> StudioFault {
    StudioFault::not_found(format!("there is nothing at \"{path}\""))
}

fn no_method(request: &Request<Incoming>) -> HttpAnswer {
    let (method, path) = (request.method(), request.uri().path());
    refused(StudioFault::new("no_method", format!("\"{path}\" does not take {method}")))
}

/// A file of the page.
fn file(request: &Request<Incoming>) -> HttpAnswer {
    let path = request.uri().path();
    match page::file(path) {
        Some(_) if request.method() != Method::GET => no_method(request),
        Some((kind, content)) => bytes(kind, content),
        None => refused(nothing(path)),
    }
}

/// What is asked without changing anything; `name` is what stands behind it.
fn get(studio: &Studio, what: &str, name: &str) -> Result<HttpAnswer, StudioFault> {
    match (what, name) {
        ("photo", name) if !name.is_empty() => {
            let (picture, scale) = studio.photo(name)?;
            let mut answer = bytes("image/png", picture);
            if let Ok(scale) = HeaderValue::from_str(&scale.to_string()) {
                answer.headers_mut().insert(SCALE, scale);
            }
            Ok(answer)
        }
        ("mask", name) if !name.is_empty() => Ok(bytes("image/png", studio.mask(name)?)),
        ("texture", number) => {
            let none = |_| StudioFault::not_found(format!("there is no texture {number}"));
            Ok(bytes("image/jpeg", studio.texture(number.parse().map_err(none)?)?))
        }
        ("out", path) if !path.is_empty() => {
            let mut answer = bytes(page::media_type(path), studio.written_file(path)?);
            answer.headers_mut().insert(APART.0, APART.1);
            Ok(answer)
        }
        ("state", "") => Ok(as_json(&studio.state(true))),
        ("cards", "") => Ok(bytes("application/json", studio.cards().to_owned())),
        ("view", "") => Ok(as_json(&studio.view())),
        ("garment", "") => Ok(bytes(MESH, studio.garment()?.to_vec())),
        ("moving", "") => Ok(bytes(MESH, studio.moving())),
        ("start", "") => Ok(bytes(MESH, studio.start()?)),
        ("before", "") => Ok(bytes(MESH, studio.before()?)),
        ("body", "") => Ok(bytes(MESH, studio.body()?)),
        ("out", "") => Ok(as_json(&studio.written())),
        ("measures", "") => Ok(as_json(&studio.measures())),
        ("trade", "") => Ok(as_json(&studio.trade()?)),
        _ => Err(nothing(&format!("/api/{what}/{name}"))),
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EditForm {
    edit: u64,
    #[serde(default)]
    words: String,
    changes: Vec<StudioChange>,
    #[serde(default)]
    draft: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SewForm {
    edit: u64,
    #[serde(default)]
    words: String,
    seams: Vec<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NumberedForm {
    edit: u64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RunForm {
    #[serde(default)]
    quality: Option<String>,
    #[serde(default)]
    full: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PrintForm {
    writer: String,
}

/// What changes something.
async fn post(studio: Arc<Studio>, what: &str, request: Request<Incoming>) -> HttpAnswer {
    match what {
        "edit" => {
            let edit = |s: &Studio, f: EditForm| s.edit(f.edit, &f.words, &f.changes, f.draft);
            formed(studio, request, move |s, f| number(edit(s, f)?)).await
        }
        "sew" => {
            let sew = |s: &Studio, f: SewForm| s.sew(f.edit, &f.words, &f.seams);
            formed(studio, request, move |s, f| number(sew(s, f)?)).await
        }
        "undo" => formed(studio, request, |s, f: NumberedForm| number(s.undo(f.edit)?)).await,
        "redo" => formed(studio, request, |s, f: NumberedForm| number(s.redo(f.edit)?)).await,
        "begin" => formed(studio, request, |s, with: BeginWith| number(s.begin(&with)?)).await,
        "save" => answered(move || Ok(as_json(&json!({ "file": studio.save()? })))).await,
        "run" => {
            let run = |s: &Studio, f: RunForm| s.run(f.quality, f.full);
            formed(studio, request, move |s, f| run(s, f).map(|()| as_json(&json!({})))).await
        }
        "stop" => {
            studio.stop();
            as_json(&json!({}))
        }
        "upload" => upload(studio, request).await,
        _ => {
            let print = |s: &Studio, f: PrintForm| s.print(&f.writer);
            formed(studio, request, move |s, f| Ok(as_json(&json!({ "files": print(s, f)? })))).await
        }
    }
}

/// Does work with the form that a request brings.
async fn formed<F: DeserializeOwned + Send + 'static>(
    studio: Arc<Studio>,
    request: Request<Incoming>,
    work: impl FnOnce(&Studio, F) -> Result<HttpAnswer, StudioFault> + Send + 'static,
) -> HttpAnswer {
    match form::<F>(request).await {
        Ok(form) => answered(move || work(&studio, form)).await,
        Err(fault) => refused(fault),
    }
}

/// The answer of a request that leaves a text of that number.
fn number(edit: u64) -> Result<HttpAnswer, StudioFault> {
    Ok(as_json(&json!({ "edit": edit })))
}

async fn upload(studio: Arc<Studio>, request: Request<Incoming>) -> HttpAnswer {
    let name = match name_of(request.uri()) {
        Ok(name) => name,
        Err(fault) => return refused(fault),
    };
    match body(request, MOST_UPLOAD).await {
        Ok(content) => {
            answered(move || Ok(as_json(&json!({ "file": studio.upload(&name, &content)? })))).await
        }
        Err(fault) => refused(fault),
    }
}

/// The name that the query of an upload gives.
fn name_of(uri: &Uri) -> Result<String, StudioFault> {
    let none = || StudioFault::malformed("an upload needs a name").hint("/api/upload?name=tee.jpg");
    let query = uri.query().unwrap_or("");
    let name = query.split('&').find_map(|part| part.strip_prefix("name=")).ok_or_else(none)?;
    decoded(&name.replace('+', " "))
        .ok_or_else(|| StudioFault::malformed("the name of the upload is no text"))
}

/// A part of an address as text: `%20` is a space.
fn decoded(part: &str) -> Option<String> {
    let mut decoded = Vec::new();
    let mut rest = part.bytes();
    while let Some(byte) = rest.next() {
        decoded.push(match byte {
            b'%' => {
                let digit = |b: u8| char::from(b).to_digit(16);
                let (high, low) = (digit(rest.next()?)?, digit(rest.next()?)?);
                (16 * high + low) as u8
            }
            byte => byte,
        });
    }
    String::from_utf8(decoded).ok()
}

//! `toile studio`: the page in the browser.

use crate::args::StudioArgs;
use crate::cards;
use crate::{Streams, cache, exit, terminal::interrupt, terminal::stdin};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::Arc;
use toile_core::Registry;
use toile_studio::{StudioFault, StudioOptions, StudioServer};

/// Serves the page until Ctrl-C.
pub(crate) fn studio(args: &StudioArgs, registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let target = args.target.clone().unwrap_or_else(|| PathBuf::from("."));
    if let Err(e) = stdin::refused(&target, "cannot be opened in the studio") {
        return streams.refuse(false, e);
    }
    let stop = interrupt::on_ctrl_c();
    let options = StudioOptions {
        target,
        registry: Arc::new(registry.clone()),
        cards: cards::listing(registry).to_string(),
        cache: cache::chosen(&args.cache, streams),
        threads: args.threads.map(usize::from),
        runs: true,
    };
    let server = match StudioServer::open(options, args.port) {
        Ok(server) => server,
        Err(fault) => return refused(&fault, streams),
    };
    let address = server.address();
    streams.say(format!("studio: {address}  (Ctrl-C ends it)"));
    // Who waits for the line reads it from a pipe, too.
    let _ = streams.out.flush();
    if !args.no_open && !open(&address) {
        streams.notice("note: no browser was opened; open the address in one");
    }
    match server.serve(|| stop.is_cancelled()) {
        Ok(()) => exit::DONE,
        Err(fault) => refused(&fault, streams),
    }
}

fn refused(fault: &StudioFault, streams: &mut Streams<'_>) -> u8 {
    streams.tell(format!("error: {fault}"));
    if let Some(hint) = &fault.hint {
        streams.tell(format!("  help: {hint}"));
    }
    exit::INVALID
}

/// Asks the system to show an address; whether there is somebody to ask.
fn open(address: &str) -> bool {
    let (program, before): (&str, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        "windows" => ("cmd", &["/C", "start", ""]),
        _ => ("xdg-open", &[]),
    };
    let mut command = Command::new(program);
    command.args(before).arg(address);
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().is_ok()
}

//! One run of a measurement in a process of its own: the hidden `toile run-apart`.

use crate::{Streams, exit, terminal::last_words};
use std::ffi::OsString;
use std::io::{BufRead, BufReader, Read, stdin};
use std::path::PathBuf;
use std::process::Command;
use toile_core::Registry;
use toile_trade::measure::apart::{Apart, answer};

/// The program as it runs one task with the same plugins.
pub(crate) fn with_plugins(program: Apart, plugins: &[PathBuf]) -> Apart {
    let named = plugins.iter().flat_map(|p| [OsString::from("--plugin"), p.clone().into_os_string()]);
    Apart { arguments: named.chain([OsString::from("run-apart")]).collect(), ..program }
}

/// The program to be started once more, for another of its commands, with the same plugins.
pub(crate) fn again(program: Option<&Apart>) -> Command {
    let mut command = Command::new(program.map_or_else(PathBuf::new, |p| p.program.clone()));
    let plugins = program.and_then(|p| p.arguments.split_last()).map(|(_, plugins)| plugins);
    command.args(plugins.unwrap_or_default());
    command
}

/// Runs the task on the first line of standard input. The rest of the input stays open while the
/// parent runs: if it ends before the answer, the parent has ended and the task stops.
pub(crate) fn run(registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let (mut input, mut line) = (BufReader::new(stdin()), String::new());
    if let Err(e) = input.read_line(&mut line) {
        streams.tell(format!("error: no task can be read: {e}"));
        return exit::INVALID;
    }
    std::thread::spawn(move || {
        let _ = input.read(&mut [0]);
        last_words::leave(exit::STOPPED);
    });
    let written = answer(&line, registry).and_then(|bytes| {
        streams.out.write_all(&bytes).and_then(|()| streams.out.flush()).map_err(|e| e.to_string())
    });
    match written {
        Ok(()) => exit::DONE,
        Err(why) => {
            streams.tell(format!("error: {why}"));
            exit::INVALID
        }
    }
}

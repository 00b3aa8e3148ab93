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
    command.args(program.map_or(&[][..], |p| &p.launch));
    command.args(program.map_or(&[][..], plugins));
    command
}

/// The program as it runs another command with the same plugins.
pub(crate) fn for_command(program: &Apart, command: &str) -> Apart {
    let arguments = plugins(program).iter().cloned().chain([command.into()]).collect();
    Apart { arguments, ..program.clone() }
}

/// The arguments that name plugins.
fn plugins(program: &Apart) -> &[OsString] {
    program.arguments.split_last().map_or(&[], |(_, plugins)| plugins)
}

/// The task of a process of its own: the first line of standard input. The rest of the input stays
/// open while the parent runs: if it ends before the answer, the parent has ended and this process
/// ends, too.
///
/// Errors: a sentence.
pub(crate) fn task() -> Result<String, String> {
    let (mut input, mut line) = (BufReader::new(stdin()), String::new());
    input.read_line(&mut line).map_err(|e| format!("no task can be read: {e}"))?;
    std::thread::spawn(move || {
        let _ = input.read(&mut [0]);
        last_words::leave(exit::STOPPED);
    });
    Ok(line)
}

/// Runs the task of this process.
pub(crate) fn run(registry: &Registry, streams: &mut Streams<'_>) -> u8 {
    let line = match task() {
        Ok(line) => line,
        Err(why) => {
            streams.tell(format!("error: {why}"));
            return exit::INVALID;
        }
    };
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

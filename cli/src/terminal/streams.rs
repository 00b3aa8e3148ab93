//! Where a command writes, and its manners: colour, and how much it says.

use crate::args::color::Color;
use crate::exit;
use std::io::{self, ErrorKind, Write};
use toile_core::panics;
use toile_pipeline::Faults;
use toile_trade::measure::apart::Apart;

/// Where a command writes: `out` for its answer, `err` for progress and messages; and how the
/// program starts itself.
pub(crate) struct Streams<'a> {
    /// Starts a process for a run that is measured; none where the command is called as a function.
    pub(crate) apart: Option<Apart>,
    pub(crate) out: &'a mut dyn Write,
    err: &'a mut dyn Write,
    /// Why the answer could not be written.
    lost: Option<io::Error>,
    colour: bool,
    quiet: bool,
}

impl<'a> Streams<'a> {
    pub(crate) fn new(apart: Option<Apart>, out: &'a mut dyn Write, err: &'a mut dyn Write) -> Self {
        Streams { apart, out, err, lost: None, colour: Color::Auto.is_on(), quiet: false }
    }

    /// Sets colour and quietness as the user asks.
    pub(crate) fn behave(&mut self, color: Color, quiet: bool) {
        (self.colour, self.quiet) = (color.is_on(), quiet);
    }

    /// Whether nothing but errors and answers is to be said.
    pub(crate) fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// Writes a line of the answer.
    pub(crate) fn say(&mut self, line: impl std::fmt::Display) {
        let written = writeln!(self.out, "{line}");
        self.note(written);
    }

    /// Prints that work went well and what came of it, unless `--quiet` is given.
    pub(crate) fn report(&mut self, line: impl std::fmt::Display) {
        if !self.quiet {
            self.say(line);
        }
    }

    /// Writes a line for the person at the terminal.
    pub(crate) fn tell(&mut self, line: impl std::fmt::Display) {
        let _ = writeln!(self.err, "{line}");
    }

    /// Says what is wrong with the arguments; the exit code for that.
    pub(crate) fn misused(&mut self, message: &str) -> u8 {
        self.tell(format!("error: {message}"));
        exit::USAGE
    }

    /// Shows the person at the terminal how work goes.
    pub(crate) fn notice(&mut self, line: impl std::fmt::Display) {
        if !self.quiet {
            self.tell(line);
        }
    }

    /// Warns the person at the terminal.
    pub(crate) fn warn(&mut self, words: impl std::fmt::Display) {
        self.notice(format!("warning: {words}"));
    }

    /// Shows what is wrong with a pipeline file.
    pub(crate) fn fault(&mut self, faults: &Faults) {
        let text = faults.render(self.colour);
        self.tell(text.trim_end());
    }

    /// Says why a command is refused: to a program that asked for JSON in its answer, else to the
    /// person at the terminal.
    pub(crate) fn refuse(&mut self, json: bool, words: impl std::fmt::Display) -> u8 {
        match json {
            true => {
                let code = toile_core::ErrorCode::InvalidInput.as_str();
                self.say(serde_json::json!({ "error": code, "message": words.to_string() }));
            }
            false => self.tell(format!("error: {words}")),
        }
        exit::INVALID
    }

    /// Says that the program panicked, and what to do about it.
    pub(crate) fn bug(&mut self, json: bool, words: &str) -> u8 {
        let message = format!("the program panicked: {words}");
        match json {
            true => {
                let code = toile_core::ErrorCode::Internal.as_str();
                self.say(serde_json::json!({ "error": code, "message": message, "hint": panics::REPORT }));
            }
            false => {
                self.tell(format!("error: {message}"));
                self.tell(format!("  help: {}", panics::REPORT));
            }
        }
        exit::BUG
    }

    /// The exit code of a command that ends with `code`: an answer that could not be written is not
    /// done.
    pub(crate) fn ended(&mut self, code: u8) -> u8 {
        let flushed = self.out.flush();
        self.note(flushed);
        match self.lost.take() {
            None => code,
            Some(e) => {
                self.tell(format!("error: standard output cannot be written: {e}"));
                if code == exit::DONE { exit::INVALID } else { code }
            }
        }
    }

    /// Keeps the first failure. A closed pipe is the reader's choice.
    fn note(&mut self, written: io::Result<()>) {
        if let Err(e) = written
            && e.kind() != ErrorKind::BrokenPipe
        {
            self.lost.get_or_insert(e);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stream that fails in one way.
    struct Fails(ErrorKind);

    impl Write for Fails {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn ended(kind: ErrorKind, code: u8) -> (u8, String) {
        let (mut out, mut err) = (Fails(kind), Vec::new());
        let mut streams = Streams::new(None, &mut out, &mut err);
        streams.say("an answer");
        streams.say("and more");
        let code = streams.ended(code);
        (code, String::from_utf8_lossy(&err).into_owned())
    }

    #[test]
    fn an_answer_that_cannot_be_written_is_a_failure_and_a_closed_pipe_is_not() {
        let words = "error: standard output cannot be written: no storage space\n";
        assert_eq!(ended(ErrorKind::StorageFull, exit::DONE), (exit::INVALID, words.into()));
        assert_eq!(ended(ErrorKind::StorageFull, exit::QUALITY), (exit::QUALITY, words.into()));
        assert_eq!(ended(ErrorKind::BrokenPipe, exit::DONE), (exit::DONE, String::new()));
    }
}

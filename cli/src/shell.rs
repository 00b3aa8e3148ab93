//! `toile completions SHELL` and `toile man`: shell completions and a manual page, made from the
//! definitions of the arguments.

use crate::args::Arguments;
use crate::{Streams, exit};
use clap::{Command, CommandFactory};
use clap_complete::Shell;

/// Prints the completions of a shell.
pub(crate) fn completions(shell: Shell, streams: &mut Streams<'_>) -> u8 {
    let mut bytes = Vec::new();
    clap_complete::generate(shell, &mut visible(Arguments::command()), "toile", &mut bytes);
    streams.say(String::from_utf8_lossy(&bytes).trim_end());
    exit::DONE
}

/// Prints a page of the manual: the program's, or that of one of its commands.
pub(crate) fn man(names: &[String], streams: &mut Streams<'_>) -> u8 {
    let mut command = visible(Arguments::command());
    command.build();
    let mut title = String::from("toile");
    for name in names {
        let Some(sub) = command.find_subcommand(name).cloned() else {
            return streams.misused(&format!("`{title}` has no command `{name}`"));
        };
        title = format!("{title}-{name}");
        command = sub;
    }
    let mut bytes = Vec::new();
    match clap_mangen::Man::new(command).title(title).render(&mut bytes) {
        Ok(()) => {
            streams.say(String::from_utf8_lossy(&bytes).trim_end());
            exit::DONE
        }
        Err(e) => {
            streams.tell(format!("error: the page cannot be made: {e}"));
            exit::BUG
        }
    }
}

/// The command without what is for the program itself.
fn visible(command: Command) -> Command {
    let shown = command.get_subcommands().filter(|c| !c.is_hide_set()).cloned().collect::<Vec<_>>();
    let bare = Command::new("toile").about(command.get_about().cloned().unwrap_or_default());
    let bare = bare.version(env!("TOILE_VERSION")).args(command.get_arguments().cloned());
    bare.subcommand_required(true).arg_required_else_help(true).subcommands(shown)
}

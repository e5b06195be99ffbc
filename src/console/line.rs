//! The commands of the console, with help texts and expected arguments.

use crate::spec::did_you_mean;

/// Every command with its arguments, and what it does from column [`DESCRIPTIONS`] on.
const HELP: &str = "\
help [COMMAND]                                   list the commands, or explain one
info                                             summarise the world and its episode
objects                                          list the objects: position, reward, whether present
state [--json | FILE]                            show the agent; with an argument, the current world as JSON, or write it to a file
step [N] [A B C | ROW]                           take N steps (1) with action A B C (0 0 0), or with a row of the action table
action [-c N] -a A B C | ROW                     like step, with options: -c count, -a action
reset [INDEX | FILE]                             reset to the start, to world INDEX of the variant, or to another world
spawn CLASS X Y [KEY=VALUE ...] | JSON           add an object to the world
destroy INDEX | NAME                             remove an object for good
teleport X Y [HEADING]                           move the agent somewhere else
show [MODALITY] [COLUMNS]                        show the agent's view in the terminal
map [COLUMNS]                                    show the world from above in the terminal
screenshot FILE [MODALITY | map] [WIDTHxHEIGHT]  write a picture into a PNG file inside --output
snapshot [NAME]                                  take a snapshot, or list the snapshots
restore NAME                                     go back to a snapshot
send_message JSON | FILE                         send a message of L2Explorer's channels, or a file of them
log [CATEGORY on|off]                            show log messages: agent, communications, worldmaker, academy
quit                                             leave; so does Ctrl-D
exit                                             the same as quit";

/// The column in [`HELP`] where the descriptions start.
const DESCRIPTIONS: usize = 48;

/// Each command's name, its arguments, and its line of [`HELP`].
fn commands() -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
    HELP.lines().map(|line| {
        let command = line[..DESCRIPTIONS].trim_end();
        let (name, usage) = command.split_once(' ').unwrap_or((command, ""));
        (name, usage, line)
    })
}

/// The names of all commands.
pub(super) fn names() -> Vec<&'static str> {
    commands().map(|(name, ..)| name).collect()
}

/// Help on one command, by default on all.
pub(super) fn help(command: Option<&str>) -> Result<String, String> {
    let Some(command) = command else {
        return Ok(HELP.to_owned());
    };
    let found = commands().find(|(name, ..)| *name == command);
    found.map(|(.., line)| line.to_owned()).ok_or_else(|| misused(command))
}

/// The error for an unknown command, or for wrong arguments.
pub(super) fn misused(name: &str) -> String {
    if let Some((_, usage, _)) = commands().find(|(known, ..)| *known == name) {
        let takes = if usage.is_empty() { "no arguments" } else { usage };
        return format!("{name}: expected {takes}");
    }
    let near = did_you_mean(name, names());
    format!("found command {name:?}, expected one listed by help{near}")
}

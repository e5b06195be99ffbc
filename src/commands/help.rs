//! Groups the commands in `driftworld --help` by purpose.

use std::fmt::Write;

use clap::Command;

use crate::style;

/// The groups in order, each with its commands.
const GROUPS: [(&str, &[&str]); 7] = [
    ("Start here", &["demo", "tasks", "doctor"]),
    (
        "Author tasks and worlds",
        &[
            "new",
            "export",
            "validate",
            "vary",
            "sample",
            "render",
            "sheet",
            "assets",
            "photograph",
            "schema",
        ],
    ),
    ("Measure how tasks differ", &["distance", "order", "elements"]),
    ("Teach: design and run curricula", &["curriculum", "run", "audit"]),
    (
        "Score what was learned",
        &["scales", "metrics", "report", "transfer-report", "logs"],
    ),
    ("Watch and play", &["studio", "play", "console", "film", "replay"]),
    ("Work with other tools", &["convert", "completions", "bench", "help"]),
];

/// Spaces before a command's name, and between the longest name and the descriptions.
const GAP: usize = 2;

/// The command with its subcommands listed in groups.
pub(super) fn grouped(command: Command) -> Command {
    let template = format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n\n{}{}:\n{{options}}{{after-help}}",
        groups(&command),
        heading("Options")
    );
    command.help_template(template).after_help(
        "'driftworld COMMAND --help' shows examples of each. A task is a built-in one, or the path of a task spec. A variant is \
         TASK#VARIANT, such as find_objects#red; a family or a pattern, such as find_objects#any_*, stands for its members. \
         Instead of a file, - stands for standard input, or with -o for standard output.",
    )
}

/// The groups with their commands, then commands without a group under "Others".
fn groups(command: &Command) -> String {
    let known: Vec<(&str, String)> = command
        .get_subcommands()
        .filter(|one| !one.is_hide_set())
        .map(|one| {
            (
                one.get_name(),
                one.get_about().map(ToString::to_string).unwrap_or_default(),
            )
        })
        .chain([("help", "Describe a command in detail".to_owned())])
        .collect();
    let has_group = |name: &str| GROUPS.iter().any(|(_, names)| names.contains(&name));
    let others: Vec<&str> = known
        .iter()
        .map(|(name, _)| *name)
        .filter(|name| !has_group(name))
        .collect();
    let width = known.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for (title, names) in GROUPS.into_iter().chain([("Others", others.as_slice())]) {
        let found: Vec<_> = names
            .iter()
            .filter_map(|name| known.iter().find(|(known, _)| known == name))
            .collect();
        if found.is_empty() {
            continue;
        }
        let _ = writeln!(text, "{}:", heading(title));
        for (name, about) in found {
            let blanks = width - name.len() + GAP;
            let _ = writeln!(text, "{:GAP$}{}{:blanks$}{about}", "", styled("1", name), "");
        }
        text.push('\n');
    }
    text
}

fn heading(text: &str) -> String {
    styled("1;4", text)
}

fn styled(codes: &str, text: &str) -> String {
    if style::of_stdout() {
        format!("\u{1b}[{codes}m{text}\u{1b}[0m")
    } else {
        text.to_owned()
    }
}

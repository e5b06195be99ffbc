//! The `driftworld` command: its subcommands, one file each, and error reporting.
//!
//! [`run`] is the whole command, including its output. The rest of the library never prints.

mod agent;
mod assets;
mod audit;
mod bench;
mod completions;
mod console;
mod convert;
mod curriculum;
mod demo;
mod distance;
mod doctor;
mod elements;
mod film;
mod film_choice;
mod help;
mod interrupt;
mod logs;
mod metrics;
mod new;
mod optional;
mod order;
mod output;
mod photograph;
mod play;
mod render;
mod replay;
mod report;
mod run;
mod sample;
mod scales;
mod schema;
mod sheet;
mod studio;
mod tasks;
mod transfer_report;
mod validate;
mod vary;
mod weights;

use std::borrow::Cow;
use std::ffi::OsString;
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ColorChoice, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use driftworld_text::{WordKind, is_unprintable, printable, removed};

pub(crate) use crate::Failure;
use crate::{documents, overwrite, style};

/// The arguments of the running command.
static WORDS: Mutex<Vec<OsString>> = Mutex::new(Vec::new());

/// Runs the command like the `driftworld` program, and prints its output; `args` begins with the program's name.
///
/// Returns the exit code: 0 for success, 1 for invalid input or an invalid output path, 2 for invalid
/// arguments. If the reader of the output goes away, as with `| head`, the process ends. It also ends within two
/// seconds of an interrupt, a termination or a hang-up, leaving no partial files: with a message if the work can be
/// resumed or repeated, otherwise by the signal. Either way the exit code is 128 plus the signal's number: 130 for an
/// interrupt, as in shells.
pub fn run(args: impl IntoIterator<Item = OsString>) -> u8 {
    /// Signals belong to the process, so one command runs at a time.
    static RUNNING: Mutex<()> = Mutex::new(());
    let _one_at_a_time = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
    translate_panics();
    documents::accept_standard_input();
    let args: Vec<OsString> = args.into_iter().map(variant_of_standard_input).collect();
    WORDS.lock().unwrap_or_else(PoisonError::into_inner).clone_from(&args);
    style::follow(requested_color(&args));
    match parse(&args) {
        Ok((command, outputs)) => {
            let done = overwrite::refuse_same(&outputs).and_then(|()| interrupt::watch());
            let done = done.and_then(|_watch| command.run());
            let reported = output::report_written_files();
            done.and(reported).map_or_else(|failure| report(&failure), |()| 0)
        }
        Err(help) => {
            if help.use_stderr() {
                output::note(help.render().to_string().trim_end());
            } else {
                let printed = help.print().and_then(|()| std::io::stdout().flush());
                // If the reader has gone, there is no one to report the error to.
                if let Err(error) = printed.or_else(|error| match error.kind() {
                    std::io::ErrorKind::BrokenPipe => Ok(()),
                    _ => Err(error),
                }) {
                    return report(&Failure::input(format!("standard output: {error}")));
                }
            }
            u8::try_from(help.exit_code()).unwrap_or(2)
        }
    }
}

/// The command's definition for clap.
fn command() -> clap::Command {
    help::grouped(Driftworld::command())
}

/// The value of `--color`, read before everything else: argument errors are coloured, too.
fn requested_color(args: &[OsString]) -> ColorChoice {
    let mut args = args
        .iter()
        .filter_map(|arg| arg.to_str())
        .take_while(|arg| *arg != "--");
    let mut requested = ColorChoice::Auto;
    while let Some(arg) = args.next() {
        let word = match arg.strip_prefix("--color") {
            Some("") => args.next(),
            Some(rest) => rest.strip_prefix('='),
            None => None,
        };
        requested = word
            .and_then(|word| ColorChoice::from_str(word, false).ok())
            .unwrap_or(requested);
    }
    requested
}

/// The output files of a command, each with the option that names it.
type Outputs = Vec<(&'static str, PathBuf)>;

/// Parses arguments. Error messages quote them on one line each, with control characters escaped.
fn parse(args: &[OsString]) -> Result<(Command, Outputs), clap::Error> {
    let read = |args: Vec<OsString>| {
        let mut command = command().color(requested_color(&args));
        let matches = command.try_get_matches_from_mut(args)?;
        let read = Driftworld::from_arg_matches(&matches).map_err(|error| error.format(&mut command))?;
        Ok((read.command, outputs(&matches)))
    };
    read(args.to_vec()).map_err(|error| {
        let error = with_printable_words(error);
        if !error.render().to_string().contains(|c| c != '\n' && is_unprintable(c)) {
            return removed_word(args, &error).unwrap_or(error);
        }
        let shown = |arg: &OsString| match arg.to_str().map(printable) {
            Some(Cow::Owned(shown)) => shown.into(),
            _ => arg.clone(),
        };
        let error = read(args.iter().map(shown).collect()).err().unwrap_or(error);
        removed_word(args, &error).unwrap_or(error)
    })
}

/// Finds the output files among parsed arguments.
fn outputs(matches: &clap::ArgMatches) -> Outputs {
    let mut leaf = matches;
    while let Some((_, below)) = leaf.subcommand() {
        leaf = below;
    }
    let file = |option| match leaf.try_get_one::<PathBuf>(option) {
        Ok(path) => Some((option, path?.clone())),
        // The command has no such option, or the option does not name a file.
        Err(_) => None,
    };
    ["output", "record", "matrix", "plot"]
        .into_iter()
        .filter_map(file)
        .collect()
}

/// Escapes the arguments quoted in an error so that each stays on one line; messages of our own parsers are escaped already.
fn with_printable_words(mut error: clap::Error) -> clap::Error {
    let shown = error.context().filter_map(|(kind, value)| match value {
        ContextValue::String(text) => match printable(text) {
            Cow::Owned(shown) => Some((kind, ContextValue::String(shown))),
            Cow::Borrowed(_) => None,
        },
        _ => None,
    });
    for (kind, value) in shown.collect::<Vec<_>>() {
        error.insert(kind, value);
    }
    error
}

/// The error for an option, command or format that was removed, in place of clap's.
fn removed_word(args: &[OsString], error: &clap::Error) -> Option<clap::Error> {
    let text = |kind| match error.get(kind)? {
        ContextValue::String(text) => Some(text.as_str()),
        _ => None,
    };
    let mut root = command();
    let below_command = |word: &str| format!("{} {word}", command_path(&root, args)).trim_start().to_owned();
    let (kind, word) = match error.kind() {
        ErrorKind::InvalidSubcommand => (WordKind::Command, below_command(text(ContextKind::InvalidSubcommand)?)),
        ErrorKind::UnknownArgument => (WordKind::Option, below_command(text(ContextKind::InvalidArg)?)),
        ErrorKind::InvalidValue => (WordKind::Format, text(ContextKind::InvalidValue)?.to_owned()),
        _ => return None,
    };
    let message = removed(kind, &word)?;
    Some(root.error(error.kind(), format!("{word}: {message}")))
}

/// The subcommands named by arguments, such as `logs aggregate`.
fn command_path(root: &clap::Command, args: &[OsString]) -> String {
    let (mut at, mut path) = (root, Vec::new());
    for word in args.iter().skip(1).filter_map(|arg| arg.to_str()) {
        if let Some(command) = at.find_subcommand(word) {
            (at, path) = (command, [path, vec![word]].concat());
        }
    }
    path.join(" ")
}

/// Turns a variant of standard input, `-#red`, which looks like an option, into a path.
fn variant_of_standard_input(arg: OsString) -> OsString {
    match arg.to_str().and_then(|arg| arg.strip_prefix("-#")) {
        Some(variant) => format!("/dev/stdin#{variant}").into(),
        None => arg,
    }
}

/// Lifelong reinforcement learning: task specs, worlds, distances, curricula, a first-person environment and metrics.
#[derive(Parser)]
#[command(name = "driftworld", version, arg_required_else_help = true)]
struct Driftworld {
    #[command(subcommand)]
    command: Command,
    /// When to colour what is printed: on a terminal (auto, unless `NO_COLOR` is set), always or never.
    #[arg(long, global = true, value_enum, default_value_t = ColorChoice::Auto, value_name = "WHEN", hide_possible_values = true)]
    color: ColorChoice,
}

/// Defines the subcommands: an enum of them, and a function that runs the chosen one.
macro_rules! subcommands {
    ($($module:ident::$command:ident),+ $(,)?) => {
        // No doc comments here: they would replace the long ones of the commands.
        #[derive(Subcommand)]
        #[expect(clippy::large_enum_variant, reason = "only one value exists per run")]
        enum Command {
            $($command($module::$command),)+
        }

        impl Command {
            fn run(self) -> Result<(), Failure> {
                match self {
                    $(Self::$command(command) => command.run(),)+
                }
            }
        }
    };
}

subcommands! {
    demo::Demo, tasks::Tasks, new::New, new::Export, validate::Validate,
    sample::Sample, vary::Vary, convert::Convert,
    render::Render, film::Film, play::Play, studio::Studio, sheet::Sheet, assets::Assets, console::Console, photograph::Photograph,
    elements::Elements, distance::Distance, order::Order, curriculum::Curriculum,
    run::Run, replay::Replay, audit::Audit, scales::Scales,
    logs::Logs, metrics::Metrics, report::Report, transfer_report::TransferReport,
    schema::Schema, bench::Bench, completions::Completions, doctor::Doctor,
}

/// Prints on standard error why the command failed; returns the exit code.
fn report(failure: &Failure) -> u8 {
    output::note(format!("error: {}", failure.for_command()));
    interrupt::exit_code().unwrap_or_else(|| failure.exit_code())
}

/// Ends the command silently if the reader of its output goes away, as with `| head`, and with an error if the system cannot
/// start threads: other crates report both as panics.
fn translate_panics() {
    let default = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        let text = info.payload_as_str().unwrap_or_default();
        if text.starts_with("failed printing to std") && text.contains("Broken pipe") {
            #[expect(clippy::exit, reason = "nobody reads the output any more")]
            std::process::exit(0);
        }
        if text.starts_with("The global thread pool has not been initialized") {
            driftworld_atomic_files::remove_unfinished();
            output::note(
                "error: threads: could not start any, expected one per processor; end other programs, or allow more \
                 (`ulimit -u`)",
            );
            #[expect(clippy::exit, reason = "no work was started, and none can be")]
            std::process::exit(1);
        }
        default(info);
    }));
}

//! The executable: parses its arguments, runs a session and sets the exit status.

use std::fmt::Display;
use std::io::{Write, stderr, stdout};
use std::process::ExitCode;

use driftworld_text::printable_lines;
use driftworld_unity::{HELP, Journal, MARK, Request, UnityError, run};

fn main() -> ExitCode {
    // Without this thread, signals keep their default effect.
    #[cfg(unix)]
    let _ = std::thread::Builder::new()
        .name("signals".to_owned())
        .spawn(follow_signals);
    let arguments: Vec<String> = std::env::args_os()
        .skip(1)
        .map(|argument| argument.to_string_lossy().into_owned())
        .collect();
    match Request::parse(&arguments) {
        Ok((Request::Help, _)) => say(stdout(), HELP),
        Ok((Request::Version, _)) => say(stdout(), format_args!("{MARK}, {}", env!("CARGO_PKG_VERSION"))),
        Ok((Request::Run(options), remarks)) => {
            // If the log file cannot be opened, the error goes to the terminal.
            let journal = Journal::open(options.log.as_deref())
                .inspect_err(|error| say(stderr(), format_args!("driftworld-unity: {error}")));
            let ending = journal.and_then(|mut journal| {
                for remark in remarks {
                    journal.note(&remark);
                }
                run(&options, &mut journal).inspect_err(|error| journal.note(&error.to_string()))
            });
            return ending.map_or_else(|error| failed(&error), |()| ExitCode::SUCCESS);
        }
        Err(error) => {
            say(stderr(), format_args!("driftworld-unity: {error}"));
            say(stderr(), "`driftworld-unity --help` lists the options");
            return failed(&error);
        }
    }
    ExitCode::SUCCESS
}

/// Ends the process at the first signal, after removing unfinished files.
#[cfg(unix)]
fn follow_signals() {
    use driftworld_atomic_files::remove_unfinished;
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level;

    let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else {
        return;
    };
    if let Some(signal) = signals.forever().next() {
        remove_unfinished();
        let _ = low_level::emulate_default_handler(signal);
        low_level::exit(128 + signal);
    }
}

/// Writes to the terminal. A closed terminal, or a full disk behind it, does not change the exit status.
fn say(mut terminal: impl Write, words: impl Display) {
    let _ = writeln!(terminal, "{}", printable_lines(&words.to_string()));
}

fn failed(error: &UnityError) -> ExitCode {
    ExitCode::from(error.exit_code())
}

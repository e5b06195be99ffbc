//! The executable: reads its arguments, runs a session, sets the exit status. Everything else is in the library.
#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program speaks through its terminal"
)]

use std::process::ExitCode;

use driftworld_unity::{HELP, Journal, MARK, Request, UnityError, run};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args_os()
        .skip(1)
        .map(|argument| argument.to_string_lossy().into_owned())
        .collect();
    match Request::parse(&arguments) {
        Ok((Request::Help, _)) => println!("{HELP}"),
        Ok((Request::Version, _)) => println!("{MARK}, {}", env!("CARGO_PKG_VERSION")),
        Ok((Request::Run(options), remarks)) => {
            // Without a log file there is the terminal still.
            let journal = Journal::open(options.log.as_deref())
                .inspect_err(|error| eprintln!("driftworld-unity: -logFile {error}"));
            let ending = journal.and_then(|mut journal| {
                for remark in remarks {
                    journal.note(&remark);
                }
                run(&options, &mut journal).inspect_err(|error| journal.note(&error.to_string()))
            });
            return ending.map_or_else(|error| failed(&error), |()| ExitCode::SUCCESS);
        }
        Err(error) => {
            eprintln!("driftworld-unity: {error}\n\n{HELP}");
            return failed(&error);
        }
    }
    ExitCode::SUCCESS
}

fn failed(error: &UnityError) -> ExitCode {
    ExitCode::from(error.exit_code())
}

//! The `driftworld` command: reads arguments, runs one subcommand, turns its result into an exit code. The work is in `commands/`.

mod commands;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    commands::quiet_on_closed_pipe();
    let command = commands::Command::parse();
    match command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => error.report(),
    }
}

//! The `driftworld` program. The work is in `commands/`, which the Python package calls as well.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(driftworld::commands::run(std::env::args_os()))
}

//! The subcommands, one file each, and what they share: how they fail. What is written and shown is in `output.rs`.

mod assets;
mod bench;
mod console;
mod convert;
mod curriculum;
mod demo;
mod distance;
mod doctor;
mod draw_maps;
mod figures;
mod input;
mod interrupt;
mod log_folders;
mod logs;
mod matrix_file;
mod metrics;
mod modality;
mod order;
mod output;
mod photograph;
mod pictures;
mod render;
mod report;
mod run;
mod sample;
mod scenario_file;
mod schema;
mod scoring;
mod sheet;
mod table;
mod tasks;
mod transfer_report;
mod validate;
mod vary;
mod weights;
mod who;

use std::process::ExitCode;

use clap::Parser;

/// Typed task specs to worlds, distances, curricula, and a first-person environment for lifelong reinforcement learning.
#[derive(Parser)]
#[command(name = "driftworld", version, arg_required_else_help = true)]
pub(crate) enum Command {
    Demo(demo::Demo),
    Tasks(tasks::Tasks),
    Validate(validate::Validate),
    Sample(sample::Sample),
    Vary(vary::Vary),
    Convert(convert::Convert),
    Render(render::Render),
    Sheet(sheet::Sheet),
    Assets(assets::Assets),
    Console(console::Console),
    Photograph(photograph::Photograph),
    Distance(distance::Distance),
    Order(order::Order),
    Curriculum(curriculum::Curriculum),
    Run(run::Run),
    // No words here: they would take the place of the long ones that stand with the command.
    Logs(logs::Logs),
    Metrics(metrics::Metrics),
    Report(report::Report),
    TransferReport(transfer_report::TransferReport),
    Schema(schema::Schema),
    Bench(bench::Bench),
    Doctor(doctor::Doctor),
}

impl Command {
    /// Runs the subcommand.
    pub(crate) fn run(self) -> Result<(), Failure> {
        match self {
            Self::Demo(command) => command.run(),
            Self::Tasks(command) => command.run(),
            Self::Validate(command) => command.run(),
            Self::Sample(command) => command.run(),
            Self::Vary(command) => command.run(),
            Self::Convert(command) => command.run(),
            Self::Render(command) => command.run(),
            Self::Sheet(command) => command.run(),
            Self::Assets(command) => command.run(),
            Self::Console(command) => command.run(),
            Self::Photograph(command) => command.run(),
            Self::Distance(command) => command.run(),
            Self::Order(command) => command.run(),
            Self::Curriculum(command) => command.run(),
            Self::Run(command) => command.run(),
            Self::Logs(command) => command.run(),
            Self::Metrics(command) => command.run(),
            Self::Report(command) => command.run(),
            Self::TransferReport(command) => command.run(),
            Self::Schema(command) => command.run(),
            Self::Bench(command) => command.run(),
            Self::Doctor(command) => command.run(),
        }
    }
}

/// Why a subcommand failed; decides the exit code.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The input, or the place for the output, is wrong: exit code 1.
    Input(String),
    /// The arguments contradict each other: exit code 2.
    Usage(String),
}

impl Failure {
    /// Says on standard error what went wrong.
    #[expect(
        clippy::print_stderr,
        reason = "this is the one place where the command reports its failure"
    )]
    pub(crate) fn report(&self) -> ExitCode {
        let (text, code) = match self {
            Self::Input(text) => (text, 1),
            Self::Usage(text) => (text, 2),
        };
        eprintln!("error: {text}");
        ExitCode::from(code)
    }

    /// What it says.
    pub(crate) fn text(&self) -> &str {
        match self {
            Self::Input(text) | Self::Usage(text) => text,
        }
    }

    pub(crate) fn usage(text: impl Into<String>) -> Self {
        Self::Usage(text.into())
    }

    pub(crate) fn input(text: impl Into<String>) -> Self {
        Self::Input(text.into())
    }
}

impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Input(error.to_string())
    }
}

/// Ends the command without a word when the reader of its output goes away, as with `| head`.
pub(crate) fn quiet_on_closed_pipe() {
    let default = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        let text = info.payload_as_str().unwrap_or_default();
        if text.starts_with("failed printing to stdout") && text.contains("Broken pipe") {
            #[expect(
                clippy::exit,
                reason = "the reader of our output has gone: there is nobody left to tell"
            )]
            std::process::exit(0);
        }
        default(info);
    }));
}

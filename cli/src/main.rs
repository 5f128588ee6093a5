//! The command line: `impinge check SCENE`, `impinge run SCENE`, `impinge schema`, `impinge substances`; `impinge
//! completions SHELL` and `impinge man FOLDER` describe it to shells and to `man`. Reports go to standard output;
//! errors, warnings and progress to standard error. Exit status: 0 done, 1 refused or failed, 2 wrong usage.

mod check;
mod completions;
mod error;
mod idle;
mod inputs;
mod man;
mod messages;
mod new;
mod overdue;
mod passing;
mod patience;
mod ranges;
mod report;
mod run;
mod schema;
mod set;
mod substances;
mod summary;
mod table;
mod units;

use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use error::CliError;
use messages::{print_message, warn};

/// Heat and stress in a surface hit by a hot droplet
#[derive(Parser)]
#[command(name = "impinge", version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Check(check::Check),
    New(new::New),
    Run(run::Run),
    Report(report::Report),
    Schema(schema::Schema),
    Substances(substances::Substances),
    Completions(completions::Completions),
    Man(man::Man),
}

fn main() -> ExitCode {
    impinge::runtime::file_size::report_limits();
    let report = match Arguments::parse().command {
        Command::Check(command) => command.execute(),
        Command::New(command) => command.execute(),
        Command::Run(command) => command.execute(),
        Command::Report(command) => command.execute(),
        Command::Schema(command) => command.execute(),
        Command::Substances(command) => command.execute(),
        Command::Completions(command) => command.execute(),
        Command::Man(command) => command.execute(),
    };
    match report.and_then(|report| print(&report)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            print_message("error", &error);
            ExitCode::FAILURE
        }
    }
}

/// Prints a report; a reader that closes the pipe early is not an error.
fn print(report: &str) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    match out.write_all(report.as_bytes()).and_then(|()| out.flush()) {
        Err(reason) if reason.kind() != io::ErrorKind::BrokenPipe => Err(CliError::Print(reason)),
        _ => Ok(()),
    }
}

//! The command line: `impinge check SCENE`, `impinge run SCENE`, `impinge schema`; `impinge completions SHELL` and
//! `impinge man FOLDER` describe it to shells and to `man`. Reports go to standard output; errors, warnings and
//! progress to standard error. Exit status: 0 done, 1 refused or failed, 2 wrong usage.

mod check;
mod completions;
mod error;
mod idle;
mod inputs;
mod man;
mod patience;
mod run;
mod schema;
mod set;
mod summary;
mod table;
mod units;

use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use impinge::warning::Warning;

use error::CliError;

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
    Run(run::Run),
    Schema(schema::Schema),
    Completions(completions::Completions),
    Man(man::Man),
}

fn main() -> ExitCode {
    impinge::runtime::file_size::report_limits();
    let report = match Arguments::parse().command {
        Command::Check(command) => command.execute(),
        Command::Run(command) => command.execute(),
        Command::Schema(command) => command.execute(),
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

/// Prints warnings about implausible values of a scene to standard error.
fn warn(warnings: &[Warning]) {
    for warning in warnings {
        print_message("warning", warning);
    }
}

/// Prints a message to standard error; ignores a failure to do so.
fn print_message(kind: &str, what: &dyn Display) {
    let _ = writeln!(io::stderr(), "{kind}: {what}");
}

/// Prints a report; a reader that closes the pipe early is not an error.
fn print(report: &str) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    match out.write_all(report.as_bytes()).and_then(|()| out.flush()) {
        Err(reason) if reason.kind() != io::ErrorKind::BrokenPipe => Err(CliError::Print(reason)),
        _ => Ok(()),
    }
}

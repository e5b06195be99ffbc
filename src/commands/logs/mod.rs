//! `driftworld logs`: validates logs, and exports them as one table.

mod aggregate;
mod validate;

use clap::{Args, Subcommand};

use crate::Failure;

/// Check logs, or merge their rows into one table.
///
/// Logs are folders in l2logger's format, as `driftworld run` writes them: `logger_info.json`, `scenario_info.json`,
/// and WORKER/BLOCKNUM-BLOCKTYPE/data-log.tsv. To score them, see `driftworld metrics`.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld logs validate demo-out/log
  driftworld logs aggregate demo-out/log -o demo.tsv
  driftworld logs aggregate logs --recursive -o all.csv")]
pub(crate) struct Logs {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    // No doc comments here: they would replace the long ones of the commands.
    Validate(validate::Validate),
    Aggregate(aggregate::Aggregate),
}

impl Logs {
    pub(crate) fn run(self) -> Result<(), Failure> {
        match self.what {
            What::Validate(command) => command.run(),
            What::Aggregate(command) => command.run(),
        }
    }
}

/// `1 row`, `2 rows`, `1,200,000 rows`.
fn count(number: u64, what: &str) -> String {
    format!("{} {what}{}", grouped(number), if number == 1 { "" } else { "s" })
}

/// `1,200,000`.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let groups = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy);
    groups.collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn count_groups_thousands_and_uses_the_plural() {
        let check = |number: u64, expected: &str| assert_eq!(count(number, "row"), expected);
        check(0, "0 rows");
        check(1, "1 row");
        check(999, "999 rows");
        check(1_000, "1,000 rows");
        check(12_345_678, "12,345,678 rows");
    }
}

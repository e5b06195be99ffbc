//! `cargo xtask chaos`: the command under faults, for minutes. It is killed, its system calls fail, the disk is full,
//! the clock jumps, its folder goes away, it gets a signal. Whatever happens, an error says so, and a log that is taken
//! up again ends with the bytes of one that nothing happened to.
//!
//! This file reads the options and prints the figures; each kind of fault is in the file named after it.

mod clock;
mod disk;
mod figures;
mod folders;
mod kills;
mod python;
mod rng;
mod shim;
mod signals;
mod subject;
mod syscalls;

use std::time::{Instant, SystemTime, UNIX_EPOCH};

use crate::error::XtaskError;
use crate::process::{cargo, run};
use crate::stage::AS_TESTED;
use crate::workspace::Workspace;
use figures::{Figures, Table};
use rng::Rng;
use subject::Subject;

/// How many processes are killed if nobody says.
const KILLS: u64 = 1000;

/// What is asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Options {
    /// How many processes are killed.
    kills: u64,
    /// Where chance begins; the clock says if nobody does.
    seed: Option<u64>,
    /// The kinds of fault; all of them if none is named.
    only: Vec<Kind>,
    /// A sample of each, in about a minute.
    is_quick: bool,
}

/// A kind of fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Kills,
    Python,
    Syscalls,
    Disk,
    Clock,
    Folders,
    Signals,
}

impl Kind {
    const ALL: [Self; 7] = [
        Self::Kills,
        Self::Python,
        Self::Syscalls,
        Self::Disk,
        Self::Clock,
        Self::Folders,
        Self::Signals,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Kills => "kills",
            Self::Python => "python",
            Self::Syscalls => "syscalls",
            Self::Disk => "disk",
            Self::Clock => "clock",
            Self::Folders => "folders",
            Self::Signals => "signals",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Kills => "killed at random moments, 1, 2 and 4 jobs",
            Self::Python => "the same with agents in Python",
            Self::Syscalls => "each system call failing in turn",
            Self::Disk => "a disk with room for so many bytes",
            Self::Clock => "a clock that jumps by years",
            Self::Folders => "the log removed, cut or replaced meanwhile",
            Self::Signals => "told to stop, wherever it is",
        }
    }
}

impl Options {
    /// Reads the words after `chaos`.
    pub(crate) fn parse(words: &[&str]) -> Result<Self, String> {
        let mut options = Self {
            kills: KILLS,
            seed: None,
            only: Vec::new(),
            is_quick: false,
        };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("found `{word}` without a value"));
            let number = |text: &str| {
                text.parse::<u64>()
                    .map_err(|_| format!("{word}: found `{text}`, expected a whole number"))
            };
            match *word {
                "--quick" => options.is_quick = true,
                "--kills" => options.kills = number(value()?)?,
                "--seed" => options.seed = Some(number(value()?)?),
                "--only" => options.only.push(kind(value()?)?),
                other => return Err(format!("found unknown argument `{other}` of chaos")),
            }
        }
        Ok(options)
    }
}

fn kind(name: &str) -> Result<Kind, String> {
    let known = || Kind::ALL.map(Kind::name).join(", ");
    let found = Kind::ALL.into_iter().find(|kind| kind.name() == name);
    found.ok_or_else(|| format!("--only: found unknown `{name}`, expected one of {}", known()))
}

/// Does all that is asked for, prints the figures, and fails if anything went wrong.
pub(crate) fn unleash(workspace: &Workspace, options: &Options) -> Result<(), XtaskError> {
    run(cargo(workspace, &[&["build", "--bins"], &AS_TESTED[..]].concat()))?;
    let seed = options.seed.unwrap_or_else(|| {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        u64::from(now.subsec_nanos()) ^ now.as_secs()
    });
    println!("seed {seed}: cargo xtask chaos --seed {seed} draws the same moments");
    let subject = Subject::new(workspace, options.is_quick)?;
    let mut table = Table::default();
    for kind in Kind::ALL {
        if !options.only.is_empty() && !options.only.contains(&kind) {
            continue;
        }
        println!("\n{}: {}", kind.name(), kind.about());
        let (start, mut rng) = (Instant::now(), Rng::new(seed, kind.name()));
        let figures = match kind {
            Kind::Kills => kills::figures(&subject, options, &mut rng),
            Kind::Python => python::figures(workspace, &subject, options, &mut rng),
            Kind::Syscalls => syscalls::figures(&subject, options, &mut rng),
            Kind::Disk => disk::figures(workspace, &subject, options, &mut rng),
            Kind::Clock => clock::figures(workspace, &subject, options, &mut rng),
            Kind::Folders if !cfg!(target_os = "linux") => {
                Ok(Figures::skipped("whether a process stands still is seen in /proc"))
            }
            Kind::Folders => folders::figures(&subject, options, &mut rng),
            Kind::Signals => signals::figures(workspace, &subject, options),
        }?;
        table.add(kind.name(), figures, start.elapsed());
    }
    println!("\nseed {seed}\n{table}");
    match table.num_failures() {
        0 => Ok(()),
        count => Err(XtaskError::Findings { count }),
    }
}

impl Options {
    /// How often something is tried: a tenth where it has to be quick.
    fn scaled(&self, count: u64) -> u64 {
        if self.is_quick { count.div_ceil(10) } else { count }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read() {
        let parse = |words: &str| Options::parse(&words.split_whitespace().collect::<Vec<_>>());
        let none = Options {
            kills: KILLS,
            seed: None,
            only: Vec::new(),
            is_quick: false,
        };
        assert_eq!(parse("").as_ref(), Ok(&none));
        let all = Options {
            kills: 7,
            seed: Some(3),
            only: vec![Kind::Disk, Kind::Clock],
            is_quick: true,
        };
        assert_eq!(parse("--quick --kills 7 --seed 3 --only disk --only clock"), Ok(all));
        let check = |words: &str, part: &str| {
            let complaint = parse(words).unwrap_err();
            assert!(complaint.contains(part), "{words}: {complaint}");
        };
        check("--kills", "`--kills` without a value");
        check("--kills many", "found `many`, expected a whole number");
        check("--only fire", "expected one of kills, python");
        check("--fast", "unknown argument `--fast` of chaos");
    }
}

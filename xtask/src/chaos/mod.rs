//! `cargo xtask chaos`: the command under faults, for minutes. It is killed, its system calls fail, the disk is full,
//! the clock jumps, its folder goes away, it gets a signal. Whatever happens, an error says so, and a log that is taken
//! up again ends with the bytes of one that nothing happened to.
//!
//! This file prints the figures; each kind of fault is in the file named after it.

mod clock;
mod disk;
mod figures;
mod folders;
mod kills;
mod options;
mod python;
mod rng;
mod shim;
mod signals;
mod subject;
mod syscalls;

use std::time::{Instant, SystemTime, UNIX_EPOCH};

use crate::error::XtaskError;
use crate::process::AS_TESTED;
use crate::process::{cargo, run};
use crate::workspace::Workspace;
use figures::{Figures, Table};
use options::Kind;
pub(crate) use options::Options;
use rng::Rng;
use subject::Subject;

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

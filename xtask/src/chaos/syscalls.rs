//! Each system call of a run failing in turn, by strace: the run ends with an error, or as if nothing had been, and its
//! log can be gone on with to the same bytes.

use std::collections::BTreeMap;
use std::fs;
use std::process::Command;

use super::figures::Figures;
use super::rng::Rng;
use super::subject::{Ended, Files, Subject, all_files, difference, file_error, to_its_end};
use super::{Options, subject};
use crate::error::XtaskError;
use crate::process::works;

/// The calls that fail, and how. Those for memory and between threads are left out: without them no program goes on;
/// and `getrandom`, which the kernel lets nobody down with.
const CALLS: [(&str, &[&str]); 33] = [
    ("access", &["EIO"]),
    ("clone", &["EAGAIN"]),
    ("clone3", &["EAGAIN"]),
    ("close", &["EIO"]),
    ("copy_file_range", &["EIO"]),
    ("fchmod", &["EPERM"]),
    ("fchown", &["EPERM"]),
    ("fcntl", &["EIO"]),
    ("fdatasync", &["EIO"]),
    ("flock", &["ENOLCK", "EIO"]),
    ("fstat", &["EIO"]),
    ("fsync", &["EIO", "ENOSPC"]),
    ("ftruncate", &["EIO"]),
    ("getcwd", &["ENOENT"]),
    ("getdents64", &["EIO"]),
    ("ioctl", &["EIO"]),
    ("link", &["EIO"]),
    ("linkat", &["EIO"]),
    ("lseek", &["EIO"]),
    ("mkdir", &["EIO", "ENOSPC"]),
    ("newfstatat", &["EIO"]),
    ("openat", &["EIO", "ENOSPC", "EMFILE"]),
    ("pipe2", &["EMFILE"]),
    ("pread64", &["EIO"]),
    ("read", &["EIO"]),
    ("readlink", &["EIO"]),
    ("rename", &["EIO", "ENOSPC"]),
    ("renameat", &["EIO", "ENOSPC"]),
    ("renameat2", &["EIO", "ENOSPC"]),
    ("socketpair", &["EMFILE"]),
    ("statx", &["EIO"]),
    ("unlink", &["EIO"]),
    ("write", &["EIO", "ENOSPC", "EINTR"]),
];

/// Most places of one call at which it fails.
const PLACES: u64 = 60;

pub(super) fn figures(subject: &Subject, options: &Options, rng: &mut Rng) -> Result<Figures, XtaskError> {
    let mut probe = Command::new("strace");
    probe.args(["-f", "-o", "/dev/null", "-e", "inject=rename:error=EIO:when=99", "true"]);
    if !works(probe) {
        return Ok(Figures::skipped(
            "no strace that may trace (Debian: apt install strace)",
        ));
    }
    let mut figures = Figures::default();
    let (expected, _) = subject.undisturbed(&subject.short, "random", 1)?;
    let jobs: &[u64] = if options.is_quick { &[1] } else { &[1, 2] };
    for &jobs in jobs {
        for begun in [false, true] {
            let place = Place {
                subject,
                expected: &expected,
                jobs,
                begun,
            };
            // One job says it all, but for what threads have among themselves.
            let most = options.scaled(if jobs == 1 { PLACES } else { PLACES / 4 });
            figures.add(place.figures(most, rng)?);
        }
    }
    Ok(figures)
}

/// From where a run goes on, and with how many jobs.
struct Place<'a> {
    subject: &'a Subject,
    expected: &'a Files,
    jobs: u64,
    begun: bool,
}

impl Place<'_> {
    fn figures(&self, most: u64, rng: &mut Rng) -> Result<Figures, XtaskError> {
        let (mut figures, mut not_started, mut of_std) = (Figures::default(), 0_u64, 0_u64);
        let counts = self.counts()?;
        for (call, errors) in CALLS {
            let count = counts.get(call).copied().unwrap_or(0);
            for error in errors {
                for number in chosen(count, most, rng) {
                    let what = format!("{call} number {number} with {error}, {} jobs", self.jobs);
                    self.prepare()?;
                    let ended = to_its_end(&mut self.traced(&[
                        "-e",
                        &format!("trace={call}"),
                        "-e",
                        &format!("inject={call}:error={error}:when={number}"),
                    ]))?;
                    figures.faults += 1;
                    if is_not_started(&ended) {
                        not_started += 1;
                    } else if ended.said.contains("unexpected error during closedir") {
                        // Rust's library panics there, where no system fails.
                        of_std += 1;
                    } else if !ended.is_orderly() {
                        figures.failed(format!("{what}: {}", ended.shown()));
                    } else if ended.is_well()
                        && let Some(difference) = difference(&all_files(&self.log()), self.expected)
                    {
                        figures.failed(format!("{what}: ended well, but {difference}"));
                    }
                    let last = to_its_end(&mut self.run())?;
                    if !last.is_well() {
                        figures.failed(format!("{what}, gone on with: {}", last.shown()));
                    }
                    figures.compared(difference(&all_files(&self.log()), self.expected), &what);
                }
            }
        }
        let begun = if self.begun { "gone on with" } else { "begun" };
        println!(
            "{} jobs, {begun}: {} faults, {not_started} of them before the program was loaded, {of_std} in closedir",
            self.jobs, figures.faults
        );
        figures.notes.push(format!(
            "{} jobs, {begun}: {not_started} before the program was loaded, {of_std} in closedir",
            self.jobs
        ));
        Ok(figures)
    }

    fn log(&self) -> std::path::PathBuf {
        self.subject.folder.join("faulty")
    }

    fn run(&self) -> Command {
        self.subject.run(&self.subject.short, "random", self.jobs, &self.log())
    }

    fn traced(&self, arguments: &[&str]) -> Command {
        let run = self.run();
        let mut traced = Command::new("strace");
        traced
            .args(["-f", "-qq", "-o"])
            .arg(self.subject.folder.join("trace"))
            .args(arguments)
            .arg(run.get_program())
            .args(run.get_args());
        for (name, value) in run.get_envs() {
            if let Some(value) = value {
                traced.env(name, value);
            }
        }
        traced.current_dir(&self.subject.folder);
        traced
    }

    /// No log, or one with a torn row in its second block and an info file that is half written.
    fn prepare(&self) -> Result<(), XtaskError> {
        let log = self.log();
        subject::remove(&log)?;
        if !self.begun {
            return Ok(());
        }
        for (name, bytes) in self.expected {
            let bytes = match name {
                name if name.contains("2-test") => continue,
                name if name.contains("1-train") => &bytes[..bytes.len() * 3 / 4],
                _ => &bytes[..],
            };
            let path = log.join(name);
            fs::create_dir_all(path.parent().unwrap_or(&log))
                .and_then(|()| fs::write(&path, bytes))
                .map_err(|source| file_error(&path, source))?;
        }
        Ok(())
    }

    /// How often a run makes each call.
    fn counts(&self) -> Result<BTreeMap<String, u64>, XtaskError> {
        self.prepare()?;
        let ended = to_its_end(&mut self.traced(&["-c"]))?;
        if !ended.is_well() {
            println!("{}", ended.shown());
        }
        let path = self.subject.folder.join("trace");
        let text = fs::read_to_string(&path).map_err(|source| file_error(&path, source))?;
        Ok(text.lines().filter_map(counted).collect())
    }
}

/// A call and how often it was made, of a line of `strace -c`.
fn counted(line: &str) -> Option<(String, u64)> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let (share, calls) = (words.first()?.parse::<f64>(), words.get(3)?.parse().ok()?);
    share.ok()?;
    let name = *words.last()?;
    (name != "total").then(|| (name.to_owned(), calls))
}

/// So many of `1..=count`, or all.
fn chosen(count: u64, most: u64, rng: &mut Rng) -> Vec<u64> {
    if count <= most {
        return (1..=count).collect();
    }
    // One of each of equal parts.
    (0..most)
        .map(|part| {
            let (first, next) = (count * part / most, count * (part + 1) / most);
            1 + first + rng.below(next - first)
        })
        .collect()
}

/// Whether the fault came before the program was loaded: its loader says so in its own words.
fn is_not_started(ended: &Ended) -> bool {
    !ended.hung && !ended.status.success() && ended.said.contains("error while loading shared libraries")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_of_strace_are_read() {
        let check = |line: &str, expected: Option<(&str, u64)>| {
            let expected = expected.map(|(name, calls)| (name.to_owned(), calls));
            assert_eq!(counted(line), expected, "{line}");
        };
        check(
            " 26.33    0.006796           0     20409           write",
            Some(("write", 20_409)),
        );
        check(
            "  1.00    0.000001           0         9         4 statx",
            Some(("statx", 9)),
        );
        check("100.00    0.025809           0     52911       842 total", None);
        check("% time     seconds  usecs/call     calls    errors syscall", None);
        check(
            "------ ----------- ----------- --------- --------- ----------------",
            None,
        );
    }

    #[test]
    fn places_are_all_or_spread_evenly() {
        let mut rng = Rng::new(1, "places");
        assert_eq!(chosen(3, 5, &mut rng), [1, 2, 3]);
        let some = chosen(1000, 10, &mut rng);
        assert!(
            some.iter()
                .zip(0..)
                .all(|(place, part)| (100 * part + 1..=100 * part + 100).contains(place)),
            "{some:?}"
        );
    }
}

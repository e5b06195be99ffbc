//! The `deny` stage: cargo-deny over every crate of the workspace. The rules stand in `deny.toml`; what is known of
//! crates where the database of advisories cannot be reached is in `advisories.rs`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::advisories;
use crate::error::XtaskError;
use crate::outcome::Outcome;
use crate::process::{bare, cargo, quiet_output, run, works};
use crate::workspace::Workspace;

/// Set where cargo-deny is promised.
const REQUIRE: &str = "DRIFTWORLD_REQUIRE_DENY";

/// Names a git clone of the advisory database, in place of the one at GitHub.
const DATABASE: &str = "DRIFTWORLD_ADVISORY_DB";

/// An advisory about no crate: a database without any is refused.
const NO_ADVISORY: &str = "```toml\n[advisory]\nid = \"RUSTSEC-2000-0001\"\npackage = \"none\"\ndate = \"2000-01-01\"\n\n\
                           [versions]\npatched = []\n```\n\n# No advisory\n\nThere is no such crate.\n";

/// Where cargo-deny has the database from.
const ADDRESS: &str = "https://github.com/RustSec/advisory-db";

/// Checks bans, licences and sources, then advisories as far as their database can be reached; what was not checked is
/// said.
pub(crate) fn stage(workspace: &Workspace) -> Result<Outcome, XtaskError> {
    if !works(cargo(workspace, &["deny", "--version"])) {
        let reason = "cargo-deny is not installed (cargo install cargo-deny --locked)".to_owned();
        return match std::env::var_os(REQUIRE) {
            Some(_) => Err(XtaskError::Required {
                variable: REQUIRE,
                reason,
            }),
            None => Ok(Outcome::Skipped(reason)),
        };
    }
    run(deny(workspace, None, &["check", "bans", "licenses", "sources"]))?;
    if let Some(database) = Database::fetched(workspace)? {
        run(database.check(workspace))?;
        let note = format!("advisories: database of {}", database.date);
        return Ok(Outcome::PassedWith(note));
    }
    run(Database::empty(workspace)?.check(workspace))?;
    Ok(Outcome::Partly(format!(
        "bans, licences, sources and yanked versions are as they should be; advisories were not checked, for their database cannot be reached \
         ({ADDRESS}; {DATABASE} may name a clone). {}",
        advisories::known(workspace)?
    )))
}

/// `cargo xtask advisories`: checks advisories and writes down for which crates that was done, by which state of the
/// database.
pub(crate) fn write_down(workspace: &Workspace) -> Result<(), XtaskError> {
    let Some(database) = Database::fetched(workspace)? else {
        return Err(XtaskError::Missing {
            what: "advisories",
            reason: "the database cannot be reached at GitHub; name a clone of it in DRIFTWORLD_ADVISORY_DB",
        });
    };
    run(database.check(workspace))?;
    advisories::write(workspace, &database.date, &database.commit)
}

/// A folder of advisories, as cargo-deny keeps it.
struct Database {
    /// Rules that name the folder.
    config: PathBuf,
    /// The clone that it is fetched from, where that is not GitHub's.
    clone: Option<PathBuf>,
    /// The day of its last change.
    date: String,
    commit: String,
}

impl Database {
    /// The one that everybody shares; none if it cannot be reached.
    fn fetched(workspace: &Workspace) -> Result<Option<Self>, XtaskError> {
        let folder = workspace.target.join("deny").join("advisories");
        Self::from(workspace, &folder, std::env::var_os(DATABASE).map(PathBuf::from))
    }

    /// One without an advisory of any crate: with it, cargo-deny still asks the index of crates.io which versions were
    /// yanked.
    fn empty(workspace: &Workspace) -> Result<Self, XtaskError> {
        let folder = workspace.target.join("deny").join("none");
        let origin = folder.join("origin");
        let keep = origin.join("crates").join("none");
        remove(&folder)?;
        fs::create_dir_all(&keep).map_err(|source| XtaskError::File {
            path: keep.clone(),
            source,
        })?;
        write(&keep.join("RUSTSEC-2000-0001.md"), NO_ADVISORY)?;
        let git = |arguments: &[&str]| {
            let mut git = bare("git");
            git.arg("-C").arg(&origin).args(arguments);
            quiet_output(git)
        };
        git(&["init", "--quiet", "--initial-branch", "main"])?;
        git(&["add", "."])?;
        let author = ["-c", "user.name=xtask", "-c", "user.email=xtask@localhost"];
        git(&[&author[..], &["commit", "--quiet", "--message", "No advisories"]].concat())?;
        Self::from(workspace, &folder.join("clone"), Some(origin))?.ok_or(XtaskError::Missing {
            what: "deny",
            reason: "cargo-deny did not take a database without advisories",
        })
    }

    /// Has cargo-deny fetch it into a folder, from a clone on this machine or from where it is kept.
    fn from(workspace: &Workspace, folder: &Path, clone: Option<PathBuf>) -> Result<Option<Self>, XtaskError> {
        fs::create_dir_all(folder).map_err(|source| XtaskError::File {
            path: folder.to_owned(),
            source,
        })?;
        let config = folder.join("deny.toml");
        let rules = workspace.root.join("deny.toml");
        let text = fs::read_to_string(&rules).map_err(|source| XtaskError::File { path: rules, source })?;
        let line = format!("[advisories]\ndb-path = {:?}\n", folder.display().to_string());
        write(&config, &text.replacen("[advisories]\n", &line, 1))?;
        let mut database = Self {
            config,
            clone,
            date: String::new(),
            commit: String::new(),
        };
        if !works(database.deny(workspace, &["fetch", "db"])) {
            return Ok(None);
        }
        let entries = fs::read_dir(folder).map_err(|source| XtaskError::File {
            path: folder.to_owned(),
            source,
        })?;
        let Some(clone) = entries.flatten().map(|entry| entry.path()).find(|path| path.is_dir()) else {
            return Ok(None);
        };
        let mut log = bare("git");
        log.arg("-C").arg(clone).args(["log", "-1", "--format=%cs %H"]);
        let said = quiet_output(log)?;
        let (date, commit) = said.trim().split_once(' ').unwrap_or_default();
        (database.date, database.commit) = (date.to_owned(), commit.to_owned());
        Ok(Some(database))
    }

    fn check(&self, workspace: &Workspace) -> Command {
        self.deny(workspace, &["check", "advisories"])
    }

    /// cargo-deny with this database.
    fn deny(&self, workspace: &Workspace, arguments: &[&str]) -> Command {
        let mut command = deny(workspace, Some(&self.config), arguments);
        // Nobody is there to be asked for a password.
        command.env("GIT_TERMINAL_PROMPT", "0");
        if let Some(clone) = &self.clone {
            let settings = [
                (format!("url.{}.insteadOf", clone.display()), ADDRESS),
                ("safe.directory".to_owned(), "*"),
            ];
            command.env("GIT_CONFIG_COUNT", settings.len().to_string());
            for (number, (key, value)) in settings.iter().enumerate() {
                command.env(format!("GIT_CONFIG_KEY_{number}"), key);
                command.env(format!("GIT_CONFIG_VALUE_{number}"), value);
            }
        }
        command
    }
}

/// cargo-deny over all crates of the workspace with everything in.
fn deny(workspace: &Workspace, config: Option<&Path>, arguments: &[&str]) -> Command {
    let mut command = cargo(workspace, &["deny", "--workspace", "--all-features"]);
    if let Some(config) = config {
        command.arg("--config").arg(config);
    }
    command.args(arguments);
    command
}

fn write(path: &Path, text: &str) -> Result<(), XtaskError> {
    fs::write(path, text).map_err(|source| XtaskError::File {
        path: path.to_owned(),
        source,
    })
}

fn remove(folder: &Path) -> Result<(), XtaskError> {
    match fs::remove_dir_all(folder) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => Err(XtaskError::File {
            path: folder.to_owned(),
            source,
        }),
        _ => Ok(()),
    }
}

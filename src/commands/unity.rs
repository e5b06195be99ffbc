//! `driftworld unity install`: the stand-in for L2Explorer's Unity executable, put where the original client finds it. What it
//! does when the client starts it is the business of `unity/`, which builds it; no code of it is here.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use driftworld_atomic_files::AtomicFile;
use driftworld_text::ShownPath;
use serde_json::json;

use super::{Failure, output};

/// Run the original L2Explorer client on Driftworld.
///
/// It takes the place of its Unity build.
#[derive(Args)]
#[command(after_help = "Examples:
  cargo build --release -p driftworld-unity
  eval \"$(driftworld unity install ~/l2explorer)\"
  driftworld unity install app --executable target/release/driftworld-unity")]
pub(crate) struct Unity {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    // No words here: they would take the place of the long ones that stand with the command.
    Install(Install),
}

impl Unity {
    pub(crate) fn run(self) -> Result<(), Failure> {
        match self.what {
            What::Install(command) => command.run(),
        }
    }
}

/// Install `driftworld-unity` as `DIR/l2explorer.x86_64`.
///
/// Prints two lines of shell for `eval`, which set the variables that the client reads. An earlier copy in DIR is
/// replaced. Any other file of that name is kept, since it may be the original Unity build.
#[derive(Args)]
#[command(after_help = "Examples:
  eval \"$(driftworld unity install ~/l2explorer)\"
  driftworld unity install app --executable target/release/driftworld-unity")]
struct Install {
    /// The folder to install into. Created if missing.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// The executable to copy [default: driftworld-unity beside this program, else in PATH].
    #[arg(long, value_name = "FILE")]
    executable: Option<PathBuf>,
    /// Replace `DIR/l2explorer.x86_64` even if it is another program.
    #[arg(long)]
    force: bool,
    /// Print the paths and variables as JSON.
    #[arg(long)]
    json: bool,
}

/// What the client, which strips the ending and looks for it again, can find.
const NAME: &str = "l2explorer.x86_64";

/// The name that Cargo gives the executable.
const EXECUTABLE: &str = "driftworld-unity";

/// How the executable is made.
const BUILD: &str = "cargo build --release -p driftworld-unity";

/// What the executable holds somewhere, with `_` for spaces: so this program does not hold it, and is not taken for the other.
const MARKER: &str = "driftworld-unity:_a_stand-in_for_the_L2Explorer_executable";

/// What the client's Python package cuts out of a path wherever it stands, the longer ending first.
const CUT_OUT: [&str; 4] = [".app", ".exe", ".x86_64", ".x86"];

impl Install {
    fn run(self) -> Result<(), Failure> {
        let source = match &self.executable {
            Some(file) => file.clone(),
            None => look_for_executable()?,
        };
        check_source(&source)?;
        let target = target(&self.folder)?;
        self.check_target(&target)?;
        copy(&source, &target)?;
        output::note(format!("wrote {} (a copy of {})", target.shown(), source.shown()));
        if let Some(odd) = odd_for_the_client(&target) {
            output::warning(odd);
        }
        let app = text(&target)?;
        if self.json {
            return output::json(&json!({
                "installed": app,
                "copied_from": source.display().to_string(),
                "environment": { "L2EXPLORER_APP": app, "L2EXPLORER_WORKER_ID": "0" },
            }));
        }
        output::print(&format!(
            "export L2EXPLORER_APP={}\nexport L2EXPLORER_WORKER_ID=0\n",
            quoted(app)
        ))
    }

    /// Refuses to write over what is not ours.
    fn check_target(&self, target: &Path) -> Result<(), Failure> {
        let shown = target.shown();
        // Of the path itself, not of what it links to: a link that leads nowhere is somebody's, too.
        let Ok(found) = fs::symlink_metadata(target) else {
            return Ok(());
        };
        if found.is_dir() {
            return Err(Failure::input(format!(
                "{shown}: found a folder, expected a file or nothing; name another folder than {}",
                self.folder.shown()
            )));
        }
        let is_ours = target.is_file() && holds_marker(target).map_err(|error| unreadable(target, &error))?;
        if is_ours || self.force {
            return Ok(());
        }
        Err(Failure::input(format!(
            "{shown}: found a program that is not Driftworld's, expected none, or an earlier copy of {EXECUTABLE}; it \
             may be the original Unity build, which is no longer available: name another folder, or replace it with \
             --force"
        )))
    }
}

/// The executable beside this program, else the first of that name in PATH.
fn look_for_executable() -> Result<PathBuf, Failure> {
    let name = format!("{EXECUTABLE}{}", env::consts::EXE_SUFFIX);
    let beside = env::current_exe()
        .ok()
        .and_then(|program| program.parent().map(Path::to_path_buf));
    let path = env::var_os("PATH");
    find_in(beside.as_deref(), path.as_deref(), &name).ok_or_else(|| {
        let beside = beside.map_or_else(String::new, |folder| {
            format!(
                "in {}, beside this program, nor \
             ",
                folder.shown()
            )
        });
        Failure::input(format!(
            "{name}: found neither {beside}in a folder of PATH; build it in a checkout of Driftworld with `{BUILD}`, \
             and name it with --executable target/release/{name}"
        ))
    })
}

fn find_in(beside: Option<&Path>, path: Option<&OsStr>, name: &str) -> Option<PathBuf> {
    let in_path = path.into_iter().flat_map(env::split_paths);
    let folders = beside.map(Path::to_path_buf).into_iter().chain(in_path);
    folders.map(|folder| folder.join(name)).find(|file| file.is_file())
}

/// Refuses to install what is not the executable of `unity/`.
fn check_source(source: &Path) -> Result<(), Failure> {
    let about = fs::metadata(source).map_err(|error| unreadable(source, &error))?;
    if about.is_file() && holds_marker(source).map_err(|error| unreadable(source, &error))? {
        return Ok(());
    }
    let found = if about.is_file() { "another file" } else { "no file" };
    Err(Failure::input(format!(
        "{}: found {found}, expected the executable that `{BUILD}` builds, target/release/{EXECUTABLE}",
        source.shown()
    )))
}

/// Whether a file holds the marker, without keeping more than a piece of it in memory.
fn holds_marker(path: &Path) -> io::Result<bool> {
    const PIECE: u64 = 1 << 16;
    let marker = MARKER.replace('_', " ");
    let mut file = driftworld_files::open(path, u64::MAX).map_err(io::Error::other)?.file;
    let mut piece = Vec::new();
    while file.by_ref().take(PIECE).read_to_end(&mut piece)? > 0 {
        if piece.windows(marker.len()).any(|bytes| bytes == marker.as_bytes()) {
            return Ok(true);
        }
        // The marker may lie across two pieces.
        piece.drain(..piece.len().saturating_sub(marker.len() - 1));
    }
    Ok(false)
}

/// Where the copy goes, as a whole path: the client may be started from any folder.
fn target(folder: &Path) -> Result<PathBuf, Failure> {
    if fs::metadata(folder).is_ok_and(|found| !found.is_dir()) {
        return Err(Failure::input(format!(
            "{}: found a file, expected a folder to install into, or a path to create one",
            folder.shown()
        )));
    }
    let whole = std::path::absolute(folder)
        .map_err(|error| Failure::input(format!("\"{}\": expected a folder: {error}", folder.shown())))?;
    let target = whole.join(NAME);
    text(&target)?;
    Ok(target)
}

/// The path as text, for a variable.
fn text(path: &Path) -> Result<&str, Failure> {
    path.to_str().ok_or_else(|| {
        Failure::input(format!(
            "{}: found a path that is not UTF-8 text, expected one that can be printed; name another folder",
            path.shown()
        ))
    })
}

/// Copies under a temporary name, which is given up for the right one when all is written and can be started.
fn copy(source: &Path, target: &Path) -> Result<(), Failure> {
    let failed = |error: io::Error| Failure::input(format!("{}: cannot be written: {error}", target.shown()));
    let mut from = driftworld_files::open(source, u64::MAX)?.file;
    let mut copy = AtomicFile::create_executable(target).map_err(failed)?;
    io::copy(&mut from, &mut copy).map_err(failed)?;
    copy.commit().map_err(failed)
}

fn unreadable(path: &Path, error: &io::Error) -> Failure {
    Failure::input(format!("{}: cannot be read: {error}", path.shown()))
}

/// Why the client will not find the copy, if it will not.
fn odd_for_the_client(target: &Path) -> Option<String> {
    let folder = target.parent()?.to_str()?;
    let advice = "install into a folder whose path does not contain it";
    if let Some(cut) = CUT_OUT.into_iter().find(|cut| folder.contains(cut)) {
        return Some(format!(
            "{}: the client removes \"{cut}\" from paths, and will not find this one; {advice}",
            target.shown()
        ));
    }
    let pattern = folder.chars().find(|letter| "*?[".contains(*letter))?;
    Some(format!(
        "{}: the client reads \"{pattern}\" in paths as a pattern, and may find nothing or another file; {advice}",
        target.shown()
    ))
}

/// As one word of a POSIX shell, whatever letters it holds.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use tempfile::NamedTempFile;

    use super::*;

    #[test]
    fn any_text_is_one_word_of_a_shell() {
        for word in [
            "plain",
            "two words",
            "it's",
            "$HOME `id` \"x\" \\ *",
            "two\nlines",
            "''",
        ] {
            let mut shell = std::process::Command::new("sh");
            let script = format!("printf %s {}", quoted(word));
            let said = shell.args(["-c", &script]).output().expect("there is a shell");
            assert_eq!(String::from_utf8_lossy(&said.stdout), word);
        }
    }

    #[test]
    fn the_marker_is_found_wherever_it_lies() {
        let marker = MARKER.replace('_', " ");
        for before in [0, 1, 65_500, 65_536, 131_050] {
            let file = NamedTempFile::new().expect("a file");
            fs::write(file.path(), ["x".repeat(before), marker.clone()].concat()).expect("it can be written");
            assert!(
                holds_marker(file.path()).expect("it can be read"),
                "after {before} bytes"
            );
            let almost = ["x".repeat(before), marker[1..].to_owned()].concat();
            fs::write(file.path(), almost).expect("it can be written");
            assert!(
                !holds_marker(file.path()).expect("it can be read"),
                "after {before} bytes"
            );
        }
    }

    #[test]
    fn the_executable_beside_this_program_goes_before_the_path() {
        let [beside, first, second] = [(); 3].map(|()| tempfile::tempdir().expect("a folder"));
        let path = env::join_paths([first.path(), second.path()]).expect("temporary paths can be joined");
        let found = || find_in(Some(beside.path()), Some(&path), EXECUTABLE);
        assert_eq!(found(), None);
        fs::create_dir(first.path().join(EXECUTABLE)).expect("a folder is not an executable");
        for folder in [&second, &beside] {
            let file = folder.path().join(EXECUTABLE);
            fs::write(&file, "").expect("the folder can be written");
            assert_eq!(found(), Some(file));
        }
        assert_eq!(find_in(None, None, EXECUTABLE), None);
    }

    fn check_path(folder: &str, expected: Option<&str>) {
        let found = odd_for_the_client(&Path::new(folder).join(NAME));
        match expected {
            None => assert_eq!(found, None),
            Some(part) => assert!(
                found.as_deref().unwrap_or_default().contains(part),
                "{folder}: {found:?}"
            ),
        }
    }

    #[test]
    fn paths_that_the_client_breaks_are_known() {
        check_path("/home/me/l2explorer", None);
        check_path("/opt/x86_64/It's {here}, ok", None);
        check_path("/home/me/.apps", Some("removes \".app\""));
        check_path("/srv/l2.x86_64", Some("removes \".x86_64\""));
        check_path("/srv/l2.x86", Some("removes \".x86\""));
        check_path("/srv/l2.exe/bin", Some("removes \".exe\""));
        check_path("/srv/[old]", Some("reads \"[\" in paths as a pattern"));
        check_path("/srv/what?", Some("reads \"?\""));
    }
}

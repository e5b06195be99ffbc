//! The book, second half of the stage `docs`: `book/build.py` checks the links of every page, and makes HTML of `docs/`
//! where mdBook is installed.

use std::path::Path;
use std::process::Command;

use crate::error::XtaskError;
use crate::process::{run, works};
use crate::virtual_environment::interpreter;
use crate::workspace::Workspace;

/// How mdBook is installed: without its server.
const INSTALL: &str = "cargo install mdbook@0.5.4 --locked --no-default-features --features search";

/// Checks the recording of the first hour and every link, and builds the book. Returns where it is, or what is missing.
pub(crate) fn build(workspace: &Workspace) -> Result<String, XtaskError> {
    let Some(python) = interpreter() else {
        return Ok("no link was checked and no book built, for want of Python 3.10 or later".to_owned());
    };
    let program = |program: &str, argument: &Path| {
        let mut command = Command::new(&python);
        command.arg(program).arg(argument).current_dir(&workspace.root);
        run(command)
    };
    let check = Path::new("--check");
    program("book/record.py", check)?;
    let mut version = Command::new("mdbook");
    version.arg("--version");
    if !works(version) {
        program("book/build.py", check)?;
        return Ok(format!(
            "every link was checked; no book was built without mdBook ({INSTALL})"
        ));
    }
    let book = workspace.target.join("book");
    program("book/build.py", &book)?;
    Ok(format!("the book is {}", book.join("index.html").display()))
}

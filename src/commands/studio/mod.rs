//! `driftworld studio`: serves the workbench, a web page that runs the simulator, to this machine only, or writes it into a
//! folder.

mod page;
mod server;

use std::net::{Ipv4Addr, TcpListener};
use std::path::PathBuf;
use std::process::{Command, Stdio};

use clap::Args;
use driftworld_text::counted;

use super::output;
use crate::Failure;
use crate::contents::Contents;
use crate::{documents, output_file, tasks};
use page::Page;
use server::Server;

/// Play, author, compare, order and replay worlds in a browser.
///
/// The simulator runs in the page: frames equal those of this command to the bit, and nothing is sent anywhere. The
/// page is served to this machine alone, under an address that nobody can guess, until Ctrl-C. --export writes it into
/// a folder that any web server can serve.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld studio
  driftworld studio find_objects#red --port 8008 --no-open
  driftworld studio --export public")]
pub(crate) struct Studio {
    /// What to start with: a built-in task, or the path of a task spec to edit.
    task: Option<String>,
    /// Write the page into this folder, and exit.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["task", "port", "no_open"])]
    export: Option<PathBuf>,
    /// The port on 127.0.0.1; 0 chooses a free one.
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,
    /// Print the address without opening a browser.
    #[arg(long)]
    no_open: bool,
}

/// Name of the file beside the page that holds a task given by its path.
const TASK_FILE: &str = "task.json";

impl Studio {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let (fragment, text) = match &self.task {
            Some(task) => address_fragment(task)?,
            None => Default::default(),
        };
        let mut page = Page::find()?;
        if let Some(folder) = &self.export {
            return export(&page, folder);
        }
        if let Some(text) = text {
            page.add(TASK_FILE, text.into_bytes());
        }
        let port = self.port;
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|error| {
            Failure::input(format!(
                "--port: found {port}, which cannot be listened on ({error}); give another, or 0 for a free one"
            ))
        })?;
        let server = Server::new(listener, page).map_err(|error| Failure::input(format!("--port: {error}")))?;
        let address = server.address() + &fragment;
        output::line(&address)?;
        if !self.no_open && !open(&address) {
            output::note("found no browser to open; open the address above");
        }
        output::note("serving this machine only; Ctrl-C stops it");
        server.serve()
    }
}

/// The URL fragment that opens a task in the page, and the text of the task's spec unless it is built in.
fn address_fragment(called: &str) -> Result<(String, Option<String>), Failure> {
    let (name, variant) = tasks::split(called);
    let task = tasks::task(name)?;
    if let Some(variant) = variant {
        task.variant(variant)?;
    }
    let variant = variant.map_or_else(String::new, |variant| format!("variant={}", percent_encoded(variant)));
    if tasks::text_by_name(name).is_some() {
        let query = if variant.is_empty() {
            String::new()
        } else {
            format!("?{variant}")
        };
        return Ok((format!("#/play/{}{query}", percent_encoded(name)), None));
    }
    let text =
        documents::text_of(name.as_ref(), &[Contents::Task]).map_err(|error| Failure::input(error.to_string()))?;
    let fragment = format!("#/author/draft?file={TASK_FILE}&{variant}");
    Ok((fragment.trim_end_matches('&').to_owned(), Some(text)))
}

/// A word, percent-encoded for a URL.
fn percent_encoded(word: &str) -> String {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte);
    word.bytes().fold(String::new(), |text, byte| {
        if is_plain(byte) {
            text + &char::from(byte).to_string()
        } else {
            text + &format!("%{byte:02X}")
        }
    })
}

fn export(page: &Page, folder: &std::path::Path) -> Result<(), Failure> {
    let mut bytes = 0;
    for (name, content) in page.files() {
        let path = folder.join(name);
        let parent = documents::folder_of(&path);
        std::fs::create_dir_all(parent).map_err(|error| output_file::unwritable(parent, &error))?;
        output_file::write(&path, content)?;
        bytes += content.len();
    }
    output::wrote(
        folder,
        format!(
            "{}, {} kB; any web server can serve them",
            counted(page.files().count(), "file"),
            bytes.div_ceil(1000)
        ),
    );
    Ok(())
}

/// Opens an address in the user's browser; returns whether the browser could be started.
fn open(address: &str) -> bool {
    let program = match std::env::consts::OS {
        "macos" => "open",
        "windows" => "explorer",
        _ => "xdg-open",
    };
    let mut command = Command::new(program);
    command
        .arg(address)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.spawn().is_ok()
}

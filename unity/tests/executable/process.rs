//! [`Executable`]: the built executable as a process, which is killed when its test ends.

use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// Maximum time to wait for a process to exit.
const PATIENCE: Duration = Duration::from_mins(1);

/// A running process.
pub(crate) struct Executable {
    child: Child,
    stdout: Receiver<String>,
    stderr: Receiver<String>,
}

/// The result of a process.
#[derive(Debug)]
pub(crate) struct Ended {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Executable {
    /// Starts it in a folder.
    pub(crate) fn start(arguments: &[&str], folder: &Path) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_driftworld-unity"))
            .args(arguments)
            .current_dir(folder)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the executable has been built");
        let stdout = read_in_thread(child.stdout.take().expect("the stream is piped"));
        let stderr = read_in_thread(child.stderr.take().expect("the stream is piped"));
        Self { child, stdout, stderr }
    }

    /// Waits until it exits.
    pub(crate) fn ended(mut self) -> Ended {
        let stderr = self.stderr.recv_timeout(PATIENCE).expect("the process exits");
        let stdout = self.stdout.recv_timeout(PATIENCE).expect("the process exits");
        let code = self.child.wait().expect("the process can be waited for").code();
        Ended { code, stdout, stderr }
    }
}

impl Drop for Executable {
    fn drop(&mut self) {
        // Killing a process that has exited fails harmlessly.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Reads a pipe in a thread until the process ends.
fn read_in_thread(mut pipe: impl Read + Send + 'static) -> Receiver<String> {
    let (done, text) = channel();
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        let read = pipe.read_to_end(&mut bytes);
        let text = String::from_utf8_lossy(&bytes).into_owned();
        // A test that has failed in the meantime has dropped the receiver.
        let _ = done.send(read.map_or_else(|error| error.to_string(), |_| text));
    });
    text
}

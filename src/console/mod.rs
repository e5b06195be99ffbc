//! The console: a running world by hand, line by line. Which commands there are is in `line.rs`, what a line does in `session.rs`; where
//! lines come from, the command's.

mod arguments;
#[cfg(feature = "line-editor")]
mod editor;
mod line;
mod look;
mod map;
mod messages;
mod place;
#[cfg(not(feature = "line-editor"))]
mod prompt;
mod report;
mod screen;
mod session;

#[cfg(feature = "line-editor")]
pub(crate) use editor::Editor;
#[cfg(not(feature = "line-editor"))]
pub(crate) use prompt::Editor;
pub(crate) use screen::Screen;
pub(crate) use session::{Reply, Session};

//! The console: controls a running world line by line.

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

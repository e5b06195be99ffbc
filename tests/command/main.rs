//! The `driftworld` command as its users meet it, a file per subcommand. What the libraries under it do is tested in their rooms.

mod general;
mod metrics;
mod terminal;

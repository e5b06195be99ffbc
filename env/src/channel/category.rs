//! What remarks are about, and how grave they are. Which categories are on, and what is remarked, is in `exchange.rs`.

/// What a remark on the Debug channel is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Category {
    /// What the agent meets, and what becomes of it.
    Agent,
    /// Messages that come, and those that are refused.
    Communications,
    /// What messages put into worlds.
    Worldmaker,
    /// Episodes: those that messages begin, and the ends of all.
    Academy,
}

impl Category {
    /// All of them, in the original's order.
    pub const ALL: [Self; 4] = [Self::Agent, Self::Communications, Self::Worldmaker, Self::Academy];

    /// Its name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Agent => "agent",
            Self::Communications => "communications",
            Self::Worldmaker => "worldmaker",
            Self::Academy => "academy",
        }
    }

    /// The category of this name, in any case.
    pub fn from_name(name: &str) -> Option<Self> {
        let named = |category: &Self| category.name().eq_ignore_ascii_case(name);
        Self::ALL.into_iter().find(named)
    }
}

/// How grave a remark is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Good to know.
    Log,
    /// Not as somebody may think.
    Warning,
    /// Refused.
    Error,
}

impl Level {
    /// Its name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Log => "log",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

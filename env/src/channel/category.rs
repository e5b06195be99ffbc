//! What remarks are about, and how grave they are. Which categories are on, and what is remarked, is in `exchange.rs`.

use strum::VariantArray;

/// What a remark on the Debug channel is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::EnumString, strum::IntoStaticStr, strum::VariantArray)]
#[strum(serialize_all = "lowercase", ascii_case_insensitive)]
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
    pub const ALL: &[Self] = Self::VARIANTS;

    /// Its name in messages.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// All names.
    pub fn names() -> Vec<&'static str> {
        Self::ALL.iter().map(|category| category.name()).collect()
    }

    /// The category of this name, in any case.
    pub fn from_name(name: &str) -> Option<Self> {
        name.parse().ok()
    }
}

/// How grave a remark is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
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
        self.into()
    }
}

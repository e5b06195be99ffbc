//! Categories and severities of remarks on the Debug channel.

use strum::VariantArray;

/// The subject of a remark on the Debug channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::EnumString, strum::IntoStaticStr, strum::VariantArray)]
#[strum(serialize_all = "lowercase", ascii_case_insensitive)]
pub enum Category {
    /// Contacts of the agent and their effects.
    Agent,
    /// Messages received and refused.
    Communications,
    /// Worlds and objects created by messages.
    Worldmaker,
    /// Episodes: all endings, and starts requested by messages.
    Academy,
}

impl Category {
    /// All categories, in the order used by the original environment.
    pub const ALL: &[Self] = Self::VARIANTS;

    /// Its name in messages.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// All names.
    pub fn names() -> Vec<&'static str> {
        Self::ALL.iter().map(|category| category.name()).collect()
    }
}

/// The severity of a remark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub enum Level {
    /// Information.
    Log,
    /// A possible mistake.
    Warning,
    /// A request was refused.
    Error,
}

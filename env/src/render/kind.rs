//! [`RendererKind`]: the choice between renderers, and its names. The renderers themselves are made in `renderer.rs`.

use std::fmt;
use std::str::FromStr;

use crate::EnvError;

/// What draws pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RendererKind {
    /// The processor: everywhere, and the same pixels on every machine.
    #[default]
    Cpu,
    /// A graphics card, or software that stands in for one; an error if there is none.
    Gpu,
    /// A graphics card if there is one that works; else the processor. Never software that stands in for a graphics
    /// card: the processor's own renderer is faster.
    Auto,
}

impl RendererKind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Cpu, Self::Gpu, Self::Auto];

    /// Its name: `cpu`, `gpu` or `auto`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
            Self::Auto => "auto",
        }
    }
}

impl fmt::Display for RendererKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for RendererKind {
    type Err = EnvError;

    fn from_str(text: &str) -> Result<Self, EnvError> {
        let found = Self::ALL.into_iter().find(|kind| kind.name() == text);
        found.ok_or_else(|| EnvError::NoSuchRenderer { found: text.to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_back_to_their_kind() {
        for kind in RendererKind::ALL {
            assert_eq!(kind.to_string().parse(), Ok(kind));
        }
        assert!("GPU".parse::<RendererKind>().is_err());
    }
}

//! [`RendererKind`]: a choice of renderer, by name.

use crate::EnvError;

/// A choice of renderer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, strum::Display, strum::EnumString, strum::IntoStaticStr)]
#[cfg_attr(test, derive(strum::EnumIter))]
#[strum(serialize_all = "lowercase", parse_err_ty = EnvError, parse_err_fn = unknown)]
pub enum RendererKind {
    /// The CPU, which works everywhere and gives the same pixels on every machine.
    #[default]
    Cpu,
    /// A GPU, or software emulation of one; an error if there is none. The natural style is rendered on the CPU.
    Gpu,
    /// A GPU if one works, otherwise the CPU. Never software emulation of a GPU, because the CPU renderer is faster.
    Auto,
}

fn unknown(word: &str) -> EnvError {
    EnvError::NoSuchRenderer { found: word.to_owned() }
}

#[cfg(test)]
mod tests {
    use strum::IntoEnumIterator;

    use super::*;

    #[test]
    fn names_parse_back_to_their_kind() {
        for kind in RendererKind::iter() {
            assert_eq!(kind.to_string().parse(), Ok(kind));
        }
        assert!("GPU".parse::<RendererKind>().is_err());
    }
}

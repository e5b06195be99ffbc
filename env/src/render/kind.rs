//! [`RendererKind`]: the choice between renderers, and its names. The renderers themselves are made in `renderer.rs`.

use crate::EnvError;

/// What draws pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, strum::Display, strum::EnumString, strum::IntoStaticStr)]
#[cfg_attr(test, derive(strum::EnumIter))]
#[strum(serialize_all = "lowercase", parse_err_ty = EnvError, parse_err_fn = unknown)]
pub enum RendererKind {
    /// The processor: everywhere, and the same pixels on every machine.
    #[default]
    Cpu,
    /// A graphics card, or software that stands in for one; an error if there is none. Natural looks render on the processor.
    Gpu,
    /// A graphics card if there is one that works; else the processor. Never software that stands in for a graphics
    /// card: the processor's own renderer is faster.
    Auto,
}

impl RendererKind {
    /// Its name: `cpu`, `gpu` or `auto`.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

fn unknown(word: &str) -> EnvError {
    EnvError::NoSuchRenderer { found: word.to_owned() }
}

#[cfg(test)]
mod tests {
    use strum::IntoEnumIterator;

    use super::*;

    #[test]
    fn names_lead_back_to_their_kind() {
        for kind in RendererKind::iter() {
            assert_eq!(kind.to_string().parse(), Ok(kind));
        }
        assert!("GPU".parse::<RendererKind>().is_err());
    }
}

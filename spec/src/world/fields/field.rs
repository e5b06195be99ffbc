//! [`Field`]: the properties of a field, such as its unit, and how two worlds are compared in it.

use super::comparison::Comparison;

/// The properties of a field in the table.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Its key.
    pub key: &'static str,
    /// The unit of its numbers, for display; `None` if they have none.
    pub unit: Option<&'static str>,
    /// Whether L2Explorer's reset files have it.
    pub is_original: bool,
    /// How it is compared between two worlds.
    pub compared: Compared,
    /// Why no parameter can set it; `None` if one can set it or its parts.
    pub fixed: Option<&'static str>,
    /// Why no parameter can set the whole of it, although one can set its parts.
    pub in_parts: Option<&'static str>,
    /// Whether the whole of it is a layout.
    pub(super) is_layout: bool,
    pub(super) is_heading: bool,
}

/// How a field is compared between two worlds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compared {
    /// Number by number and word by word, in the JSON of all fields of a comparison.
    Leaves(Comparison),
    /// By numbers that `similarity` computes for these comparisons.
    Measured(&'static [Comparison]),
    /// Like its parent field, or through each of its own fields.
    AsPart,
    /// Not compared, for this reason.
    Not(&'static str),
}

impl Compared {
    /// The comparisons that use the field.
    pub fn comparisons(&self) -> &[Comparison] {
        match self {
            Self::Leaves(comparison) => std::slice::from_ref(comparison),
            Self::Measured(comparisons) => comparisons,
            Self::AsPart | Self::Not(_) => &[],
        }
    }
}

impl Field {
    /// A field that only our worlds have.
    pub(crate) const fn ours(compared: Compared) -> Self {
        Self {
            key: "",
            unit: None,
            is_original: false,
            compared,
            fixed: None,
            in_parts: None,
            is_layout: false,
            is_heading: false,
        }
    }

    /// A field that L2Explorer's reset files have under the same key.
    pub(crate) const fn original(compared: Compared) -> Self {
        Self {
            is_original: true,
            ..Self::ours(compared)
        }
    }

    pub(crate) const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = Some(unit);
        self
    }

    /// Marks its numbers as headings in degrees.
    pub(crate) const fn heading(mut self) -> Self {
        self.is_heading = true;
        self.unit("degrees")
    }

    /// Excludes it from parameters, for this reason.
    pub(crate) const fn fixed(mut self, reason: &'static str) -> Self {
        self.fixed = Some(reason);
        self
    }

    /// Marks the whole of it as a layout.
    pub(crate) const fn layout(mut self) -> Self {
        self.is_layout = true;
        self
    }

    /// Excludes the whole of it from parameters, for this reason; its parts can be parameters.
    pub(crate) const fn in_parts(mut self, reason: &'static str) -> Self {
        self.in_parts = Some(reason);
        self
    }

    pub(crate) const fn named(self, key: &'static str) -> Self {
        Self { key, ..self }
    }

    /// Uses the name of the Rust field as the key, unless a key was given.
    pub(crate) const fn or_named(self, key: &'static str) -> Self {
        if self.key.is_empty() { self.named(key) } else { self }
    }

    /// Takes unset properties from the parent field.
    pub(super) fn inherit(&self, whole: &Self) -> Self {
        Self {
            compared: match self.compared {
                Compared::AsPart => whole.compared,
                own => own,
            },
            fixed: self.fixed.or(whole.fixed),
            ..*self
        }
    }
}

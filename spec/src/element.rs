//! [`Element`]: the parts of a decision process.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An element of the decision process that a parameter affects.
///
/// Five are coarse. Two are fine, as in the L2Explorer paper: the distribution of the initial state is part of [`Element::S`],
/// the emission is part of [`Element::O`]. Declaring a coarse element also allows changes of its fine one; declaring only the
/// fine one excludes all other changes.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema, strum::IntoStaticStr,
)]
pub enum Element {
    /// The states: which things are where. Covers `p`.
    S,
    /// The actions available to the agent.
    A,
    /// The transitions: how the world responds to an action.
    T,
    /// The rewards.
    R,
    /// The observations: what the agent sees of a state. Covers `phi`.
    O,
    /// The distribution of the initial state, in an unchanged state space: where things are at the start, and how many.
    #[serde(rename = "p")]
    #[strum(serialize = "p")]
    P,
    /// The emission φ, in an unchanged observation space: how a state looks.
    #[serde(rename = "phi")]
    #[strum(serialize = "phi")]
    Phi,
}

impl Element {
    /// The coarse elements, in the order of tables; every distance belongs to one of them.
    pub const ALL: [Self; 5] = [Self::S, Self::A, Self::T, Self::R, Self::O];

    /// The coarse elements, each followed by its fine one if it has one: the values that `affects` may list.
    pub const WITH_FINE: [Self; 7] = [Self::S, Self::P, Self::A, Self::T, Self::R, Self::O, Self::Phi];

    /// The coarse element that this one is, or is part of.
    ///
    /// ```
    /// use driftworld_spec::Element;
    /// assert_eq!((Element::P.coarse(), Element::Phi.coarse(), Element::R.coarse()), (Element::S, Element::O, Element::R));
    /// ```
    #[must_use]
    pub const fn coarse(self) -> Self {
        match self {
            Self::P => Self::S,
            Self::Phi => Self::O,
            coarse => coarse,
        }
    }

    /// Whether declaring this element covers changes of `other`: the same element, or its fine one.
    pub fn covers(self, other: Self) -> bool {
        self == other || self == other.coarse()
    }

    /// The element in one word.
    pub fn name(self) -> &'static str {
        match self {
            Self::S => "state",
            Self::A => "action",
            Self::T => "transition",
            Self::R => "reward",
            Self::O => "observation",
            Self::P => "initial_state",
            Self::Phi => "emission",
        }
    }

    /// The letter or short word for the element in documents: `S`, `A`, `T`, `R`, `O`, `p`, `phi`.
    pub fn letter(self) -> &'static str {
        self.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coarse_element_covers_its_fine_one_and_not_vice_versa() {
        for (coarse, fine) in [(Element::S, Element::P), (Element::O, Element::Phi)] {
            assert!(coarse.covers(fine) && coarse.covers(coarse) && fine.covers(fine));
            assert!(!fine.covers(coarse));
        }
        let covered = |one: Element| {
            Element::WITH_FINE
                .into_iter()
                .filter(|other| one.covers(*other))
                .count()
        };
        assert_eq!(Element::WITH_FINE.map(covered), [2, 1, 1, 1, 1, 2, 1]);
    }

    #[test]
    fn elements_are_written_as_letters() {
        for element in Element::WITH_FINE {
            assert_eq!(serde_json::to_value(element).ok(), Some(element.letter().into()));
        }
        assert_eq!(
            Element::WITH_FINE.map(Element::letter),
            ["S", "p", "A", "T", "R", "O", "phi"]
        );
    }
}

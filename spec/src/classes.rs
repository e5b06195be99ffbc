//! [`Classes`]: which classes of objects there are, as far as a reader of documents is told. Their models are `env`'s.

use crate::error::{Problem, nearest};

/// The most classes that a message lists.
const LISTED: usize = 40;

/// The classes that objects may be of. Capitals do not matter.
///
/// # Example
/// ```
/// use driftworld_spec::{Classes, World};
/// let classes = Classes::new(["tree", "barrel"]).with_advice("name its library");
/// let text = r#"{ "objects": [{ "class": "barrle", "coordinates": [3, 4] }] }"#;
/// let error = World::from_json_with("w", text, Some(&classes)).unwrap_err();
/// assert!(error.to_string().ends_with("did you mean \"barrel\"? Otherwise name its library"), "{error}");
/// # Ok::<(), driftworld_spec::SpecError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Classes {
    names: Vec<String>,
    advice: Option<String>,
}

impl Classes {
    /// These classes.
    pub fn new<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> Self {
        let mut names: Vec<String> = names.into_iter().map(|name| plain(name.as_ref())).collect();
        names.sort();
        names.dedup();
        Self { names, advice: None }
    }

    /// Says beside every unknown class what makes it known, such as how a library is named.
    #[must_use]
    pub fn with_advice(mut self, advice: impl Into<String>) -> Self {
        self.advice = Some(advice.into());
        self
    }

    /// Whether a class is one of them.
    pub fn has(&self, class: &str) -> bool {
        self.names.binary_search(&plain(class)).is_ok()
    }

    /// What is wrong with a class that is none of them.
    pub(crate) fn problem(&self, pointer: impl Into<String>, class: &str) -> Option<Problem> {
        if self.has(class) {
            return None;
        }
        let listed = self.names.iter().take(LISTED).cloned().collect::<Vec<_>>().join(", ");
        let more = self.names.len().saturating_sub(LISTED);
        let rest = if more > 0 {
            format!(" and {more} more")
        } else {
            String::new()
        };
        let problem = Problem::new(
            "spec/unknown-class",
            pointer,
            format!("the unknown class {class:?}"),
            format!("one of {listed}{rest}"),
        );
        let near = nearest(class, &self.names).or_else(|| self.called_otherwise(class));
        let near = near.map(|near| format!("did you mean {near:?}?"));
        Some(match (near, &self.advice) {
            (Some(near), Some(advice)) => problem.advise(format!("{near} Otherwise {advice}")),
            (Some(near), None) => problem.advise(near),
            (None, Some(advice)) => problem.advise(advice.clone()),
            (None, None) => problem,
        })
    }
}

impl Classes {
    /// The class that a word of everyday language means, where there is one.
    fn called_otherwise(&self, word: &str) -> Option<String> {
        let near = nearest(word, OTHER_WORDS.map(|(other, _)| other))?;
        let meant = OTHER_WORDS.iter().find(|(other, _)| *other == near)?.1;
        self.has(meant).then(|| meant.to_owned())
    }
}

/// What things are called where they are not called by their class, each with the class.
const OTHER_WORDS: [(&str, &str); 22] = [
    ("ball", "icosphere"),
    ("barrier", "roadblock"),
    ("bookcase", "shelf"),
    ("boulder", "rock"),
    ("box", "cube"),
    ("bush", "shrub"),
    ("castle", "castleruin"),
    ("cylinder", "geometric"),
    ("flower", "nature"),
    ("gate", "door"),
    ("house", "building"),
    ("lever", "switch"),
    ("plant", "nature"),
    ("ruin", "castleruin"),
    ("sack", "bag"),
    ("seat", "chair"),
    ("sign", "streetsign"),
    ("sphere", "icosphere"),
    ("stone", "rock"),
    ("toadstool", "mushroom"),
    ("vase", "pot"),
    ("vehicle", "car"),
];

fn plain(class: &str) -> String {
    class.trim().to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_of_everyday_language_is_told_the_class_that_it_means() {
        let classes = Classes::new(["shrub", "rock"]);
        let near = |class: &str| classes.problem("/", class).and_then(|problem| problem.advice);
        assert_eq!(near("bushh").as_deref(), Some("did you mean \"shrub\"?"));
        assert_eq!(near("rok").as_deref(), Some("did you mean \"rock\"?"));
        assert_eq!(near("house"), None, "no such class is known here");
        assert_eq!(near("zeppelin"), None);
    }
}

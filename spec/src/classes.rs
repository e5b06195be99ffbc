//! [`Classes`]: the object classes and models that are known when a document is read.

use std::sync::Arc;

use crate::error::Problem;
use crate::suggest::nearest;
use crate::world::{Model, Object};

/// Maximum number of classes or models listed in a message.
const MAX_LISTED: usize = 40;

/// The classes that objects may have. Case is ignored.
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
#[derive(Clone, Debug, Default)]
pub struct Classes {
    names: Vec<String>,
    models: Option<Arc<dyn Models>>,
    advice: Option<String>,
}

/// The models of classes. Case is ignored.
pub trait Models: std::fmt::Debug + Send + Sync {
    /// Whether a class has a model with this name or number.
    fn has(&self, class: &str, model: &Model) -> bool;

    /// The names of a class's models.
    fn names(&self, class: &str) -> Vec<String>;
}

impl Classes {
    /// The given classes; any model is accepted.
    pub fn new<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> Self {
        let mut names: Vec<String> = names.into_iter().map(|name| plain(name.as_ref())).collect();
        names.sort();
        names.dedup();
        Self {
            names,
            ..Self::default()
        }
    }

    /// Also rejects models that a class does not have.
    #[must_use]
    pub fn with_models(mut self, models: impl Models + 'static) -> Self {
        self.models = Some(Arc::new(models));
        self
    }

    /// Adds advice to every report of an unknown class, such as how to name a library.
    #[must_use]
    pub fn with_advice(mut self, advice: impl Into<String>) -> Self {
        self.advice = Some(advice.into());
        self
    }

    /// Whether a class is known.
    pub fn has(&self, class: &str) -> bool {
        self.names.binary_search(&plain(class)).is_ok()
    }

    /// The problem with an unknown class; `None` if the class is known.
    pub(crate) fn problem(&self, pointer: impl Into<String>, class: &str) -> Option<Problem> {
        if self.has(class) {
            return None;
        }
        let near = nearest(class, &self.names).or_else(|| self.class_of_synonym(class));
        let found = format!("the unknown class {class:?}");
        let problem = Problem::new("spec/unknown-class", pointer, found, one_of(&self.names));
        Some(self.advise(problem, near))
    }

    /// The problem with a model that its class does not have; `None` if the class or its models are not known.
    pub(crate) fn model_problem(&self, pointer: impl Into<String>, class: &str, model: &Model) -> Option<Problem> {
        let models = self.models.as_ref().filter(|_| self.has(class))?;
        if models.has(class, model) {
            return None;
        }
        let names = models.names(&plain(class));
        let found = format!("the unknown model {:?} of class {class:?}", model.0);
        let is_numbered = names.iter().zip(1..).all(|(name, number)| *name == number.to_string());
        let expected = match names.len() {
            count if is_numbered && count > 2 => format!("one of 1 to {count}"),
            _ => one_of(&names),
        };
        let problem = Problem::new("spec/unknown-model", pointer, found, expected);
        Some(self.advise(problem, nearest(&model.0, &names).filter(|_| !is_numbered)))
    }

    /// The problems with the class and the models of an object.
    pub(crate) fn problems(&self, pointer: &str, object: &Object) -> impl Iterator<Item = Problem> + use<> {
        let class = self.problem(format!("{pointer}/class"), &object.class);
        let models = [
            ("model", Some(&object.model)),
            ("body_model", object.body_model.as_ref()),
        ];
        let models = models.map(|(key, model)| self.model_problem(format!("{pointer}/{key}"), &object.class, model?));
        class.into_iter().chain(models.into_iter().flatten())
    }

    fn advise(&self, problem: Problem, near: Option<String>) -> Problem {
        let near = near.map(|near| format!("did you mean {near:?}?"));
        let advice: Vec<String> = near.into_iter().chain(self.advice.clone()).collect();
        if advice.is_empty() {
            return problem;
        }
        problem.advise(advice.join(" Otherwise "))
    }
}

/// The first names, and how many more there are.
fn one_of(names: &[String]) -> String {
    format!("one of {}", driftworld_text::first_of(names, MAX_LISTED))
}

impl Classes {
    /// The class that an everyday word means, if any.
    fn class_of_synonym(&self, word: &str) -> Option<String> {
        let near = nearest(word, SYNONYMS.map(|(other, _)| other))?;
        let meant = SYNONYMS.iter().find(|(other, _)| *other == near)?.1;
        self.has(meant).then(|| meant.to_owned())
    }
}

/// Everyday words, each with the class that it means.
const SYNONYMS: [(&str, &str); 22] = [
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
    fn everyday_word_gets_advice_with_its_class() {
        let classes = Classes::new(["shrub", "rock"]);
        let near = |class: &str| classes.problem("/", class).and_then(|problem| problem.advice);
        assert_eq!(near("bushh").as_deref(), Some("did you mean \"shrub\"?"));
        assert_eq!(near("rok").as_deref(), Some("did you mean \"rock\"?"));
        assert_eq!(near("house"), None, "no such class is known here");
        assert_eq!(near("zeppelin"), None);
    }
}

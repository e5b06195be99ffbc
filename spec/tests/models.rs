//! Tests that a task is accepted if and only if every object that it can sample has a model of its class.

use driftworld_spec::{Classes, Model, Models, TaskSpec};
use proptest::prelude::*;
use proptest::sample::subsequence;
use serde_json::{Value, json};

/// Trees are oaks, elms or number 1; rocks have numbers.
#[derive(Debug)]
pub(crate) struct Wood;

impl Models for Wood {
    fn has(&self, class: &str, model: &Model) -> bool {
        self.names(class).contains(&model.0)
    }

    fn names(&self, class: &str) -> Vec<String> {
        let names = if class == "tree" {
            ["oak", "elm", "1"]
        } else {
            ["1", "2", "3"]
        };
        names.map(str::to_owned).to_vec()
    }
}

/// The source of a string.
#[derive(Clone, Debug)]
enum Origin {
    Literal(&'static str),
    Varied(Vec<&'static str>),
    Drawn(Vec<&'static str>),
}

fn origin(words: &'static [&'static str]) -> impl Strategy<Value = Origin> {
    let words_of = || subsequence(words.to_vec(), 1..=2);
    prop_oneof![
        words_of().prop_map(|words| Origin::Literal(words[0])),
        words_of().prop_map(Origin::Varied),
        words_of().prop_map(Origin::Drawn)
    ]
}

impl Origin {
    /// The string's form in the object; declares the parameters that it uses.
    fn declared(&self, name: &str, parameters: &mut serde_json::Map<String, Value>) -> Value {
        let declared = match self {
            Self::Literal(word) => return json!(word),
            Self::Varied(words) => {
                json!({ "role": "variant", "type": "string", "affects": ["S"], "choices": words, "default": words[0] })
            }
            Self::Drawn(words) => {
                json!({ "role": "randomized", "type": "string", "affects": ["S"], "distribution": { "choice": { "values": words } } })
            }
        };
        parameters.insert(name.to_owned(), declared);
        json!({ "param": name })
    }

    fn words(&self) -> &[&'static str] {
        match self {
            Self::Literal(word) => std::slice::from_ref(word),
            Self::Varied(words) | Self::Drawn(words) => words,
        }
    }

    /// Its possible values in the variant that takes the first or the last of its choices.
    fn of_variant(&self, last: bool) -> &[&'static str] {
        let words = self.words();
        match self {
            Self::Varied(_) if last => &words[words.len() - 1..],
            Self::Varied(_) => &words[..1],
            _ => words,
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(100, 2000)))]

    #[test]
    fn task_is_refused_if_and_only_if_an_object_can_have_an_unknown_model(
        class in origin(&["tree", "rock"]), model in origin(&["oak", "1", "2", "foxx"]), body in any::<bool>(), fixture in any::<bool>(),
    ) {
        let mut parameters = serde_json::Map::new();
        let key = if body { "body_model" } else { "model" };
        let mut object = json!({ "class": class.declared("class", &mut parameters), key: model.declared("model", &mut parameters) });
        let last = [("class", &class), ("model", &model)].into_iter();
        let last: serde_json::Map<String, Value> = last
            .filter(|(_, origin)| matches!(origin, Origin::Varied(_)))
            .map(|(name, origin)| (name.to_owned(), json!(origin.words().last())))
            .collect();
        let mut task = json!({ "version": 2, "name": "t", "parameters": parameters, "variants": { "last": last } });
        if fixture {
            object["coordinates"] = json!([1, 1]);
            task["world"] = json!({ "objects": [object] });
        } else {
            let placement = json!({ "disc": { "center": [0, 0], "radius": 9 } });
            task["groups"] = json!([{ "name": "g", "count": 1, "object": object, "placement": placement }]);
        }
        let unknown = |class: &str, model: &str| !Wood.has(class, &Model(model.to_owned()));
        let any = |classes: &[&str], models: &[&str]| classes.iter().any(|class| models.iter().any(|model| unknown(class, model)));
        let (classes, models) = (class.words(), model.words());
        let is_written = |origin: &Origin| matches!(origin, Origin::Literal(_));
        let expected = if is_written(&class) || is_written(&model) {
            any(classes, models)
        } else {
            let has_unknown_model = models.iter().any(|model| classes.iter().all(|class| unknown(class, model)));
            has_unknown_model || [false, true].into_iter().any(|last| any(class.of_variant(last), model.of_variant(last)))
        };
        let known = Classes::new(["tree", "rock"]).with_models(Wood);
        let error = TaskSpec::from_json_with("t", &task.to_string(), Some(&known)).err();
        prop_assert_eq!(error.is_some(), expected, "{:#} {:?}", task, error);
        for problem in error.iter().flat_map(driftworld_spec::SpecError::problems) {
            prop_assert_eq!(problem.code, "spec/unknown-model");
            prop_assert!(problem.pointer.ends_with(key), "{problem:?}");
        }
    }
}

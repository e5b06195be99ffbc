//! [`Fault`]: the reason for a failed call, with a stable code and the problems of a document.

use driftworld::Failure;
use driftworld::distances::DistancesError;
use driftworld::env::EnvError;
use driftworld::generator::GeneratorError;
use driftworld::similarity::SimilarityError;
use driftworld::spec::{Problem, SpecError};
use driftworld::tasks::TaskError;
use serde_json::{Value, json};

/// The reason for a failed call.
#[derive(Debug)]
pub(crate) struct Fault {
    pub(crate) code: String,
    pub(crate) message: String,
    problems: Vec<Value>,
}

impl Fault {
    pub(crate) fn new(code: &str, message: impl Into<String>) -> Self {
        Self {
            code: code.to_owned(),
            message: message.into(),
            problems: Vec::new(),
        }
    }

    /// A request that contradicts itself or names something that does not exist.
    pub(crate) fn request(message: impl Into<String>) -> Self {
        Self::new("request/wrong", message)
    }

    pub(crate) fn json(&self) -> Value {
        json!({ "code": self.code, "message": self.message, "problems": self.problems })
    }
}

/// The problems of an error, as the page shows them. A syntax error is located where parsing stopped.
pub(crate) fn problems_of(error: &SpecError) -> Vec<Value> {
    let to_json = |problem: &Problem| {
        let mut json = json!(problem);
        json["message"] = problem.to_string().into();
        json
    };
    if let SpecError::Syntax {
        line, column, reason, ..
    } = error
    {
        return vec![json!({
            "code": error.code(), "pointer": "", "line": line, "column": column, "found": reason, "expected": "JSON",
            "advice": null, "message": format!("{line}:{column} not valid JSON: {reason}"),
        })];
    }
    if error.problems().is_empty() {
        let message = error.to_string();
        return vec![json!({
            "code": error.code(), "pointer": "", "line": 0, "column": 0, "found": message, "expected": "", "advice": null,
            "message": message,
        })];
    }
    error.problems().iter().map(to_json).collect()
}

impl From<SpecError> for Fault {
    fn from(error: SpecError) -> Self {
        Self {
            code: error.code().to_owned(),
            message: error.to_string(),
            problems: problems_of(&error),
        }
    }
}

impl From<TaskError> for Fault {
    fn from(error: TaskError) -> Self {
        match error {
            TaskError::Spec(error) => error.into(),
            other => Self::request(other.to_string()),
        }
    }
}

impl From<DistancesError> for Fault {
    fn from(error: DistancesError) -> Self {
        Self::new("distance/wrong", error.to_string())
    }
}

impl From<Failure> for Fault {
    fn from(failure: Failure) -> Self {
        Self::request(failure.to_string())
    }
}

macro_rules! with_code {
    ($($error:ty),*) => {
        $(impl From<$error> for Fault {
            fn from(error: $error) -> Self {
                Self::new(error.code(), error.to_string())
            }
        })*
    };
}

with_code!(EnvError, GeneratorError, SimilarityError);

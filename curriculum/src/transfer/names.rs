//! Maps the names in a log to the variants of a distance matrix.

use std::collections::BTreeMap;

use crate::CurriculumError;

/// Indices of a matrix's labels, by log name.
#[derive(Debug)]
pub(super) struct Names(BTreeMap<String, usize>);

impl Names {
    /// Indexes the labels by log name.
    ///
    /// # Errors
    /// [`CurriculumError::SameLogName`] if two labels have the same log name.
    pub(super) fn of(labels: &[String]) -> Result<Self, CurriculumError> {
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        for (index, label) in labels.iter().enumerate() {
            let name = log_name_of_label(label);
            if let Some(other) = names.insert(name.clone(), index) {
                let (a, b) = (labels[other].clone(), label.clone());
                return Err(CurriculumError::SameLogName { a, b, name });
            }
        }
        Ok(Self(names))
    }

    /// The index of the label with this log name.
    pub(super) fn index(&self, log_name: &str) -> Option<usize> {
        self.0.get(&log_name.to_lowercase()).copied()
    }
}

/// The log name of a label `task#variant`; for a task given as a path, its file name without `.json` is used. A label without `#`
/// is taken to be a log name already.
pub fn log_name_of_label(label: &str) -> String {
    let Some((task, variant)) = label.rsplit_once('#') else {
        return label.to_lowercase();
    };
    let file = task.rsplit(['/', '\\']).next().unwrap_or(task);
    crate::log_name(file.strip_suffix(".json").unwrap_or(file), variant)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn label_is_found_by_its_log_name() {
        for (label, name) in [
            ("find_objects#deep-red", "findobjects_deepred"),
            ("examples/tasks/find_objects.json#Red", "findobjects_red"),
            ("findobjects_red", "findobjects_red"),
        ] {
            assert_eq!(log_name_of_label(label), name);
        }
        let names = Names::of(&["a#b".to_owned(), "a#c".to_owned()]).expect("they differ");
        assert_eq!((names.index("A_C"), names.index("a_d")), (Some(1), None));
    }

    #[test]
    fn labels_with_the_same_log_name_are_refused() {
        let error = Names::of(&["a#b_c".to_owned(), "a#bc".to_owned()]).expect_err("both are a_bc");
        assert_eq!(error.code(), "curriculum/same-log-name");
    }
}

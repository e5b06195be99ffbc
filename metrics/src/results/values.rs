//! Values by name: what metrics give for a regime, a task or a whole lifetime.
//!
//! Not here: which names there are; each metric says its own, see `score`.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// Values from one trained task to each other task, in order of the later evaluation.
pub type PairValues = IndexMap<String, Vec<f64>>;

/// One value of a metric. In JSON it stands as itself: a number, a list, a list of lists, or an object of lists; of an empty
/// list, JSON does not tell what it would hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// How many.
    Count(u64),
    /// One number.
    Number(f64),
    /// How many, several times.
    Counts(Vec<u64>),
    /// Several numbers.
    Numbers(Vec<f64>),
    /// Several numbers in groups.
    Runs(Vec<Vec<f64>>),
    /// Several numbers for each of other tasks.
    Pairs(PairValues),
    /// Several numbers, of which some could not be computed: in JSON these are `null`.
    Gapped(Vec<Option<f64>>),
}

impl Value {
    /// Whether every number in it is finite. Others have no place in JSON.
    pub fn is_finite(&self) -> bool {
        match self {
            Self::Count(_) | Self::Counts(_) => true,
            Self::Number(number) => number.is_finite(),
            Self::Numbers(numbers) => numbers.iter().all(|number| number.is_finite()),
            Self::Runs(runs) => runs.iter().flatten().all(|number| number.is_finite()),
            Self::Pairs(pairs) => pairs.values().flatten().all(|number| number.is_finite()),
            Self::Gapped(numbers) => numbers.iter().flatten().all(|number| number.is_finite()),
        }
    }
}

/// Values by name, in the order in which they were given. A value that could not be computed has no entry; none is
/// NaN or infinite.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "IndexMap<String, Option<Value>>")]
pub struct Values(IndexMap<String, Value>);

impl From<IndexMap<String, Option<Value>>> for Values {
    /// What is `null` could not be computed.
    fn from(values: IndexMap<String, Option<Value>>) -> Self {
        Self(
            values
                .into_iter()
                .filter_map(|(name, value)| Some((name, value?)))
                .collect(),
        )
    }
}

impl Values {
    /// Takes a value in. A value with a number that is not finite is left out; one of the same name is replaced.
    pub fn set(&mut self, name: impl Into<String>, value: impl Into<Value>) {
        let value = value.into();
        if value.is_finite() {
            self.0.insert(name.into(), value);
        }
    }

    /// A value.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.0.get(name)
    }

    /// A number, or a count as one.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Value::Number(number) => Some(*number),
            Value::Count(count) => Some(*count as f64),
            _ => None,
        }
    }

    /// Several numbers; none for a list of counts, or for one in which a number is missing.
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        match self.get(name)? {
            Value::Numbers(numbers) => Some(numbers),
            Value::Counts(counts) if counts.is_empty() => Some(&[]),
            _ => None,
        }
    }

    /// Several numbers for each of other tasks.
    pub fn pairs(&self, name: &str) -> Option<&PairValues> {
        match self.get(name)? {
            Value::Pairs(pairs) => Some(pairs),
            _ => None,
        }
    }

    /// All values with their names, in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.0.iter().map(|(name, value)| (name.as_str(), value))
    }
}

macro_rules! into_value {
    ($($from:ty => $variant:ident),+ $(,)?) => {
        $(impl From<$from> for Value {
            fn from(value: $from) -> Self {
                Self::$variant(value.into())
            }
        })+
    };
}

into_value! {
    f64 => Number,
    u64 => Count,
    Vec<f64> => Numbers,
    Vec<u64> => Counts,
    Vec<Vec<f64>> => Runs,
    PairValues => Pairs,
}

impl From<Vec<Option<f64>>> for Value {
    /// Where all could be computed, they are plain numbers.
    fn from(numbers: Vec<Option<f64>>) -> Self {
        match numbers.iter().copied().collect() {
            Some(all) => Self::Numbers(all),
            None => Self::Gapped(numbers),
        }
    }
}

impl From<usize> for Value {
    fn from(count: usize) -> Self {
        Self::Count(count as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_stand_in_json_as_themselves_and_come_back() {
        let mut values = Values::default();
        values.set("count", 3_usize);
        values.set("number", 0.5);
        values.set("counts", vec![1_u64, 2]);
        values.set("numbers", vec![1.0, 2.0]);
        values.set("runs", vec![vec![1.5], vec![]]);
        values.set("pairs", PairValues::from([("b".to_owned(), vec![2.5])]));
        values.set("gapped", vec![Some(1.5), None]);
        values.set("whole", vec![Some(1.5), Some(2.5)]);
        let json = serde_json::to_string(&values).unwrap();
        assert_eq!(
            json,
            r#"{"count":3,"number":0.5,"counts":[1,2],"numbers":[1.0,2.0],"runs":[[1.5],[]],"pairs":{"b":[2.5]},"gapped":[1.5,null],"whole":[1.5,2.5]}"#
        );
        assert_eq!(serde_json::from_str::<Values>(&json).unwrap(), values);
    }

    #[test]
    fn what_is_not_finite_is_left_out() {
        let mut values = Values::default();
        values.set("nan", f64::NAN);
        values.set("list", vec![1.0, f64::INFINITY]);
        values.set("pairs", PairValues::from([("b".to_owned(), vec![f64::NAN])]));
        values.set("number", 1.0);
        assert_eq!(values.iter().map(|(name, _)| name).collect::<Vec<_>>(), ["number"]);
    }

    #[test]
    fn a_value_is_read_as_what_it_is() {
        let mut values = Values::default();
        values.set("count", 3_usize);
        values.set("numbers", vec![1.0]);
        assert_eq!(values.number("count"), Some(3.0));
        assert_eq!(values.number("numbers"), None);
        assert_eq!(values.numbers("numbers"), Some(&[1.0][..]));
        assert_eq!(values.pairs("numbers"), None);
        assert_eq!(values.get("other"), None);
    }
}

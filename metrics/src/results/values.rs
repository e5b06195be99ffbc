//! Values by name: the metrics' results for a regime, a task or a whole lifetime.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// Transfer from one learned task to each other task, in the order of the evaluations that follow.
pub type PairValues = IndexMap<String, Vec<f64>>;

/// One value of a metric. In JSON it is plain: a number, a list, a list of lists, or an object of lists; an empty list does not
/// show its element type.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// A count.
    Count(u64),
    /// One number.
    Number(f64),
    /// A list of counts.
    Counts(Vec<u64>),
    /// A list of numbers.
    Numbers(Vec<f64>),
    /// Groups of numbers.
    Runs(Vec<Vec<f64>>),
    /// A list of numbers for each of the other tasks.
    Pairs(PairValues),
    /// A list of numbers, some of which could not be computed: these are `null` in JSON.
    Gapped(Vec<Option<f64>>),
}

impl Value {
    /// Whether every number in it is finite. JSON cannot represent any other.
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

/// Values by name, in insertion order. A value that could not be computed has no entry; none is NaN or infinite.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "IndexMap<String, Option<Value>>")]
pub struct Values(IndexMap<String, Value>);

impl From<IndexMap<String, Option<Value>>> for Values {
    /// Skips `null`, which marks values that could not be computed.
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
    /// Sets a value. A value with a number that is not finite is dropped; an earlier value of the same name is replaced.
    pub fn set(&mut self, name: impl Into<String>, value: impl Into<Value>) {
        let value = value.into();
        if value.is_finite() {
            self.0.insert(name.into(), value);
        }
    }

    /// A value by name.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.0.get(name)
    }

    /// A number; counts are converted.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Value::Number(number) => Some(*number),
            Value::Count(count) => Some(*count as f64),
            _ => None,
        }
    }

    /// A list of numbers; `None` for a list of counts, or for one in which a number is missing.
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        match self.get(name)? {
            Value::Numbers(numbers) => Some(numbers),
            Value::Counts(counts) if counts.is_empty() => Some(&[]),
            _ => None,
        }
    }

    /// A list of numbers for each of the other tasks.
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
    /// Without gaps, a plain list of numbers.
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
    fn values_round_trip_as_plain_json() {
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
    fn non_finite_values_are_dropped() {
        let mut values = Values::default();
        values.set("nan", f64::NAN);
        values.set("list", vec![1.0, f64::INFINITY]);
        values.set("pairs", PairValues::from([("b".to_owned(), vec![f64::NAN])]));
        values.set("number", 1.0);
        assert_eq!(values.iter().map(|(name, _)| name).collect::<Vec<_>>(), ["number"]);
    }

    #[test]
    fn value_is_read_by_its_type() {
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

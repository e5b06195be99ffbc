//! JSON values that count the errors found in them, so that validation stops after a few hundred in one list or object: each
//! error takes about a kilobyte, and a bad list may have millions of items.

use std::borrow::Cow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};

use jsonschema::JsonType;
use jsonschema::json::{Array, Json, Node, NodeIdentity, Object};
use serde_json::{Map, Number, Value};

/// The JSON representation for validators.
pub(super) struct Counting;

/// The counters.
pub(super) struct Tally {
    /// Number of errors in one list or object after which the rest is skipped.
    limit: usize,
    errors: AtomicUsize,
    /// Number of times a value was accessed.
    accesses: AtomicUsize,
    /// Whether the rest of a list or object was skipped.
    stopped: AtomicBool,
}

impl Tally {
    pub(super) fn new(limit: usize) -> Self {
        Self {
            limit,
            errors: AtomicUsize::new(0),
            accesses: AtomicUsize::new(0),
            stopped: AtomicBool::new(false),
        }
    }

    /// Whether there may be more errors than were listed.
    pub(super) fn has_stopped(&self) -> bool {
        self.stopped.load(Relaxed)
    }
}

/// A value of a document; text from outside the document has no counter.
#[derive(Clone, Copy)]
pub(super) struct Counted<'a> {
    value: &'a Value,
    tally: Option<&'a Tally>,
}

impl<'a> Counted<'a> {
    pub(super) fn new(value: &'a Value, tally: &'a Tally) -> Self {
        let tally = Some(tally);
        Self { value, tally }
    }

    fn errors(&self) -> usize {
        self.tally.map_or(0, |tally| tally.errors.load(Relaxed))
    }

    fn accesses(&self) -> usize {
        self.tally.map_or(0, |tally| tally.accesses.load(Relaxed))
    }

    /// Maximum number of errors listed for one list or object.
    fn limit(&self) -> usize {
        self.tally.map_or(usize::MAX, |tally| tally.limit)
    }

    /// The value; counts the access.
    fn accessed(&self) -> &'a Value {
        if let Some(tally) = self.tally {
            tally.accesses.fetch_add(1, Relaxed);
        }
        self.value
    }
}

impl Json for Counting {
    type Node<'a> = Counted<'a>;
    type PreparedKey = String;
    type StringBuffer = Value;

    fn prepare_key(key: &str) -> String {
        key.to_owned()
    }

    fn with_string_node<T>(buffer: &mut Value, string: &str, f: impl FnOnce(Counted<'_>) -> T) -> T {
        *buffer = string.into();
        f(Counted {
            value: buffer,
            tally: None,
        })
    }
}

impl<'a> Node<'a, Counting> for Counted<'a> {
    type Object = Counted<'a>;
    type Array = Counted<'a>;
    type Number = &'a Number;

    fn as_object(&self) -> Option<Self> {
        self.accessed().is_object().then_some(*self)
    }

    fn as_array(&self) -> Option<Self> {
        self.accessed().is_array().then_some(*self)
    }

    fn as_string(&self) -> Option<Cow<'a, str>> {
        self.accessed().as_str().map(Cow::Borrowed)
    }

    fn as_number(&self) -> Option<&'a Number> {
        self.accessed().as_number()
    }

    fn as_boolean(&self) -> Option<bool> {
        self.accessed().as_bool()
    }

    fn is_null(&self) -> bool {
        self.accessed().is_null()
    }

    fn json_type(&self) -> JsonType {
        match self.accessed() {
            Value::Null => JsonType::Null,
            Value::Bool(_) => JsonType::Boolean,
            Value::Number(_) => JsonType::Number,
            Value::String(_) => JsonType::String,
            Value::Array(_) => JsonType::Array,
            Value::Object(_) => JsonType::Object,
        }
    }

    fn string_length(&self) -> Option<u64> {
        Some(self.accessed().as_str()?.chars().count() as u64)
    }

    fn equals_value(&self, expected: &Value) -> bool {
        jsonschema::json::cmp::equal(self.accessed(), expected)
    }

    /// Counts errors: every error requests the value that it concerns. Returns `null`, because some errors keep a copy;
    /// callers find the value by its path. Property names have no counter and are returned unchanged.
    fn to_value(&self) -> Cow<'a, Value> {
        match self.tally {
            Some(tally) => {
                tally.errors.fetch_add(1, Relaxed);
                Cow::Owned(Value::Null)
            }
            None => Cow::Borrowed(self.value),
        }
    }

    fn identity(&self) -> Option<NodeIdentity> {
        Some(NodeIdentity::new(std::ptr::from_ref(self.value) as usize))
    }
}

/// Iterates over items or members until more errors than the limit are found in them. Members that were never accessed are
/// unknown keys, which errors list by name: the iteration also stops after too many of those in a row.
pub(super) struct UntilFull<'a, I> {
    inner: I,
    holder: Counted<'a>,
    before: usize,
    /// The access count when the last member was returned.
    accesses: usize,
    /// Number of members in a row that were never accessed.
    unseen: usize,
}

impl<'a, I> UntilFull<'a, I> {
    fn new(holder: Counted<'a>, inner: I) -> Self {
        Self {
            inner,
            holder,
            before: holder.errors(),
            accesses: usize::MAX,
            unseen: 0,
        }
    }

    fn is_full(&self) -> bool {
        self.holder.errors() > self.before.saturating_add(self.holder.limit())
    }

    fn counted(&self, value: &'a Value) -> Counted<'a> {
        Counted { value, ..self.holder }
    }
}

impl<I: ExactSizeIterator> UntilFull<'_, I> {
    /// Ends the iteration; the rest is skipped.
    fn stop<T>(&self) -> Option<T> {
        if let Some(tally) = self.holder.tally.filter(|_| self.inner.len() > 0) {
            tally.stopped.store(true, Relaxed);
        }
        None
    }
}

impl<'a> Iterator for UntilFull<'a, std::slice::Iter<'a, Value>> {
    type Item = Counted<'a>;

    fn next(&mut self) -> Option<Counted<'a>> {
        if self.is_full() {
            return self.stop();
        }
        let value = self.inner.next()?;
        Some(self.counted(value))
    }
}

impl<'a> Iterator for UntilFull<'a, serde_json::map::Iter<'a>> {
    type Item = (&'a str, Counted<'a>);

    fn next(&mut self) -> Option<Self::Item> {
        let accesses = self.holder.accesses();
        self.unseen = if accesses == self.accesses { self.unseen + 1 } else { 0 };
        self.accesses = accesses;
        if self.is_full() || self.unseen > self.holder.limit() {
            return self.stop();
        }
        let (key, value) = self.inner.next()?;
        Some((key, self.counted(value)))
    }
}

impl<'a> Counted<'a> {
    fn map(&self) -> Option<&'a Map<String, Value>> {
        self.value.as_object()
    }
}

impl<'a> Object<'a, Counting> for Counted<'a> {
    type Node = Self;
    type MemberName = &'a str;
    type MembersIter = UntilFull<'a, serde_json::map::Iter<'a>>;

    fn len(&self) -> usize {
        self.map().map_or(0, Map::len)
    }

    fn get(&self, key: &String) -> Option<Self> {
        let value = self.map()?.get(key)?;
        Some(Self { value, ..*self })
    }

    fn members(&self) -> Self::MembersIter {
        static NONE: std::sync::LazyLock<Map<String, Value>> = std::sync::LazyLock::new(Map::new);
        UntilFull::new(*self, self.map().unwrap_or(&NONE).iter())
    }
}

impl<'a> Array<'a, Counting> for Counted<'a> {
    type Node = Self;
    type ElementsIter = UntilFull<'a, std::slice::Iter<'a, Value>>;

    fn len(&self) -> usize {
        self.value.as_array().map_or(0, Vec::len)
    }

    fn elements(&self) -> Self::ElementsIter {
        UntilFull::new(*self, self.value.as_array().map_or(&[][..], Vec::as_slice).iter())
    }
}

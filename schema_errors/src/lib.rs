//! Lists what a JSON Schema does not allow in a value, in bounded memory. A crate of its own, because it compiles the
//! whole validator a second time, for values that count: unoptimised here, since it runs for wrong documents alone.

mod counted;

use jsonschema::{ErrorIterator, ValidationError, Validator};
use serde_json::Value;

use counted::{Counted, Counting, Tally};

/// A schema, ready to list errors.
pub struct BoundedErrors {
    validator: Validator<Counting>,
    limit: usize,
}

impl BoundedErrors {
    /// Lists about `limit` errors of any one list or object; its other items are not looked at.
    ///
    /// # Errors
    ///
    /// When the schema is not a valid JSON Schema.
    pub fn new(schema: &Value, limit: usize) -> Result<Self, ValidationError<'static>> {
        let validator = jsonschema::options_for::<Counting>().build(schema)?;
        Ok(Self { validator, limit })
    }

    /// Hands the errors in a value to `read`. Returns what it makes of them, and whether there may be more errors.
    ///
    /// Errors hold no copies of what they are about: `null` stands for it, and their paths tell where it is.
    pub fn list<T>(&self, value: &Value, read: impl FnOnce(ErrorIterator<'_>) -> T) -> (T, bool) {
        let tally = Tally::new(self.limit);
        let made = read(self.validator.iter_errors(Counted::new(value, &tally)));
        (made, tally.has_stopped())
    }
}

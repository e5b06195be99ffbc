//! Lists the errors that a JSON Schema finds in a JSON value, in bounded memory. A separate crate, because it compiles the whole
//! validator a second time, for values that count errors. It runs only for invalid documents, so it is not optimised.

mod counted;

use jsonschema::{ErrorIterator, ValidationError, Validator};
use serde_json::Value;

use counted::{Counted, Counting, Tally};

/// A compiled schema that lists errors.
pub struct BoundedErrors {
    validator: Validator<Counting>,
    limit: usize,
}

impl BoundedErrors {
    /// Lists about `limit` errors per list or object, and skips the items after those.
    ///
    /// # Errors
    ///
    /// [`ValidationError`] if the schema is not a valid JSON Schema.
    pub fn new(schema: &Value, limit: usize) -> Result<Self, ValidationError<'static>> {
        let validator = jsonschema::options_for::<Counting>().build(schema)?;
        Ok(Self { validator, limit })
    }

    /// Passes the errors of a value to `read`. Returns the result of `read`, and whether there may be more errors.
    ///
    /// Errors contain `null` instead of copies of the value; their paths locate it.
    pub fn list<T>(&self, value: &Value, read: impl FnOnce(ErrorIterator<'_>) -> T) -> (T, bool) {
        let tally = Tally::new(self.limit);
        let result = read(self.validator.iter_errors(Counted::new(value, &tally)));
        (result, tally.has_stopped())
    }
}

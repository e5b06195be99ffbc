//! Objects with tags, for worlds with doors and carriable things.

use driftworld_spec::{Object, Portable};

pub(crate) fn thing(class: &str, tag: &str, at: [f64; 2]) -> Object {
    let mut object = Object::new(class, at);
    object.tag = Some(tag.to_owned());
    object
}

pub(crate) fn key(tag: &str, at: [f64; 2]) -> Object {
    let mut key = thing("key", tag, at);
    key.portable = Some(Portable::default());
    key
}

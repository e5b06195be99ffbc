//! The C functions of the module: they allocate memory for a call, and answer it. One thread calls them, one at a time.

#![expect(unsafe_code, reason = "exported names and foreign memory have no safe form")]
#![expect(unreachable_pub, reason = "they are reached by their exported names")]

use std::cell::RefCell;

use crate::Session;

/// The session, and the JSON and bytes of its last answer, with their addresses, for the caller to copy.
struct Module {
    session: Session,
    json: String,
    bytes: Vec<u8>,
    /// The address and length of the JSON, then those of the bytes.
    addresses: [u32; 4],
}

thread_local! {
    static MODULE: RefCell<Module> = RefCell::new(Module {
        session: Session::default(),
        json: String::new(),
        bytes: Vec::new(),
        addresses: [0; 4],
    });
}

/// Allocates `length` bytes for the input of [`driftworld_call`], which frees them.
#[unsafe(no_mangle)]
pub extern "C" fn driftworld_memory(length: usize) -> *mut u8 {
    Box::into_raw(vec![0_u8; length].into_boxed_slice()).cast()
}

/// Answers a call. Of the `length` bytes at `input`, the first `json` are its JSON and the rest its binary data. Returns
/// the address of four 32-bit numbers, valid until the next call: address and length of the answer's JSON and binary data.
///
/// # Safety
/// `input` must come from a call of [`driftworld_memory`] with the same `length`, and must not be used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn driftworld_call(input: *mut u8, length: usize, json: usize) -> *const u32 {
    let memory = std::ptr::slice_from_raw_parts_mut(input, length);
    // SAFETY: the caller promises that this is a box of this length, and that nothing else frees it.
    let input = unsafe { Box::from_raw(memory) };
    let (call, bytes) = input.split_at(json.min(length));
    MODULE.with_borrow_mut(|module| {
        let call = String::from_utf8_lossy(call);
        (module.json, module.bytes) = module.session.call(&call, bytes);
        let (json, bytes) = (module.json.as_bytes(), module.bytes.as_slice());
        module.addresses = [
            json.as_ptr() as u32,
            json.len() as u32,
            bytes.as_ptr() as u32,
            bytes.len() as u32,
        ];
        module.addresses.as_ptr()
    })
}

/// Fixed bytes in place of random ones to seed hash maps. That is safe, because no attacker chooses the keys of a page's maps.
///
/// # Safety
/// `place` must be valid for writing `length` bytes.
#[unsafe(no_mangle)]
unsafe extern "Rust" fn __getrandom_v03_custom(place: *mut u8, length: usize) -> Result<(), getrandom::Error> {
    // SAFETY: the caller promises that the memory is valid.
    unsafe { std::ptr::write_bytes(place, 0x5a, length) };
    Ok(())
}

//! The interface between the module and the page. The page calls three functions of the module, and provides three
//! functions. Both sides exchange data in the module's memory.
#![expect(unsafe_code, reason = "names of exported and imported functions")]
use crate::{PageHost, PageSession};
use std::{cell::RefCell, panic, sync::Once};

#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// Reads bytes of a dropped file into `into`. Returns the number of bytes, or -1 if the file cannot be read.
    safe fn read(file: u32, offset: f64, into: *mut u8, length: usize) -> i32;
    safe fn progress(done: u32, all: u32);
    /// Receives the message of a panic. The module traps afterwards.
    safe fn panicked(message: *const u8, length: usize);
}

struct BrowserHost;

impl PageHost for BrowserHost {
    #[expect(clippy::cast_precision_loss, reason = "files have fewer bytes than 2^53")]
    fn read(&self, file: u32, offset: u64, into: &mut [u8]) -> Option<usize> {
        usize::try_from(read(file, offset as f64, into.as_mut_ptr(), into.len())).ok()
    }

    fn progress(&self, done: u32, all: u32) {
        progress(done, all);
    }
}

thread_local! {
    static SESSION: RefCell<PageSession> = RefCell::default();
    static MESSAGE: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Reserves memory for the bytes of a request. Returns its address.
#[unsafe(no_mangle)]
extern "C" fn reserve_request(length: usize) -> *mut u8 {
    MESSAGE.with_borrow_mut(|message| {
        message.clear();
        message.resize(length, 0);
        message.as_mut_ptr()
    })
}

/// Answers the request. Returns the address of the answer.
#[unsafe(no_mangle)]
extern "C" fn answer_request() -> *const u8 {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        panic::set_hook(Box::new(|fault| {
            let message = fault.to_string();
            panicked(message.as_ptr(), message.len());
        }));
    });
    let request = MESSAGE.take();
    let answer = SESSION.with_borrow_mut(|session| session.answer(&request, &BrowserHost));
    MESSAGE.with_borrow_mut(|message| {
        *message = answer;
        message.as_ptr()
    })
}

/// Returns the number of bytes of the answer.
#[unsafe(no_mangle)]
extern "C" fn length() -> usize {
    MESSAGE.with_borrow(Vec::len)
}

//! Catches panics of the grader. If the grader panics while it judges, explains or reports one scene, the grading of a
//! class must not end.
//!
//! A panic is caught where the work on a scene begins, and its place in the source code is kept. The verdict on that
//! scene is a judge error. Data that the failed work has changed are dropped.
use std::{
    any::Any,
    cell::{Cell, RefCell},
    panic::{self, AssertUnwindSafe},
    sync::Once,
};

/// The description of a panic: its message, and its place in the source code.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct CaughtPanic(String);

thread_local! {
    static IS_GUARDED: Cell<bool> = const { Cell::new(false) };
    static LAST_PANIC: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Calls `work`. If it panics, the panic is not printed, but returned as a fault.
///
/// The caller must drop the data that `work` changed, because their state is unknown.
///
/// # Errors
///
/// Fails if `work` panics.
pub fn catch_panic<T>(work: impl FnOnce() -> T) -> Result<T, CaughtPanic> {
    install_hook();
    let outer = IS_GUARDED.replace(true);
    let result = panic::catch_unwind(AssertUnwindSafe(work));
    IS_GUARDED.set(outer);
    result.map_err(|payload| CaughtPanic(LAST_PANIC.take().unwrap_or_else(|| panic_message(&*payload))))
}

/// Installs a panic hook. It stores panics in guarded work with their places, and forwards all other panics.
fn install_hook() {
    static HOOK_INSTALLED: Once = Once::new();
    HOOK_INSTALLED.call_once(|| {
        let others = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            if !IS_GUARDED.get() {
                return others(panic);
            }
            let location = panic.location().map(|location| format!(" at {}:{}", location.file(), location.line()));
            LAST_PANIC.set(Some(panic_message(panic.payload()) + &location.unwrap_or_default()));
        }));
    });
}

/// Returns the message of a panic as a single line.
fn panic_message(payload: &(dyn Any + Send)) -> String {
    let message = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let message = message.or_else(|| payload.downcast_ref::<String>().cloned());
    message.map_or_else(|| "a panic without a message".to_owned(), |message| message.replace('\n', " "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_comes_back_with_its_message_and_place() {
        let fault = catch_panic(|| -> u32 { panic!("no {}\nleft", "tea") }).expect_err("a panic").to_string();
        assert!(fault.starts_with("no tea left at ") && fault.contains("guard.rs:"), "{fault}");
        assert_eq!(catch_panic(|| 7), Ok(7));
        // This nests one panic in another, and forwards a panic through another thread.
        let nested = catch_panic(|| catch_panic(|| panic!("inner")).map_err(|fault| fault.to_string().len()));
        assert!(matches!(nested, Ok(Err(1..))), "{nested:?}");
        // A panic that began on another thread continues without calling the hook again.
        let elsewhere = catch_panic(|| panic::resume_unwind(Box::new("elsewhere")));
        assert_eq!(elsewhere, Err(CaughtPanic("elsewhere".to_owned())));
    }
}

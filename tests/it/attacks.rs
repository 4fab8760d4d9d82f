//! The attack suite: every hostile program of `tests/attacks` in the real sandbox.

use std::path::Path;

use fosssim_oracle::sandbox::selftest::{self, Verdict};

use crate::sandbox::backend;

#[test]
fn every_promise_of_the_sandbox_holds() {
    let Some(backend) = backend() else { return };
    let cc = Path::new("cc");
    if std::process::Command::new(cc).arg("--version").output().is_err() {
        eprintln!("skipped: there is no C compiler (cc)");
        return;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("attacks");
    std::fs::create_dir_all(&folder).unwrap();
    let table = selftest::run(backend, cc, &folder, |promise| match &promise.verdict {
        Verdict::Held => {}
        verdict => eprintln!("{}: {verdict:?}", promise.attack),
    })
    .unwrap();
    let broken: Vec<_> = table.broken().map(|promise| &promise.attack).collect();
    assert!(broken.is_empty(), "broken promises: {broken:?}");
    let faults = table.promises.iter().filter(
        |promise| matches!(&promise.verdict, Verdict::NotTested(why) if why.contains("failed") || why.contains("compile")),
    );
    assert_eq!(faults.count(), 0);
    assert!(table.held() >= 40, "only {} promises were tried", table.held());
}

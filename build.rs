//! Links the programs statically where the machine has the C library's archives. A grader is started once for every
//! trace. Half of a small scene's time was spent on loading three shared libraries with 15,000 relocations.
//!
//! Rust's own switch for it, `-C target-feature=+crt-static`, can't be set for a package, and set for everything it
//! forbids procedural macros. So the linker is led: a folder that is searched before the system's holds scripts that
//! stand for the shared libraries and name the archives instead. Where a trial shows that this does not work, programs
//! are linked as usual; `FOSSSIM_LINK=shared` asks for that.
//!
//! Besides, it hands over the module of the browser's page, where it is asked to.
#![forbid(unsafe_code)]
use std::{
    env, fs, io,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// The libraries that Rust's standard library asks the linker for.
const SHARED: [&str; 7] = ["gcc_s", "c", "m", "rt", "pthread", "dl", "util"];

/// The archives that it gets for each of them, which need one another.
const ARCHIVES: &str = "GROUP(-l:libc.a -l:libm.a -l:libgcc_eh.a -l:libgcc.a)\n";

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-env-changed=FOSSSIM_LINK");
    take_module();
    let of = |name: &str| env::var(name).unwrap_or_default();
    let is_gnu = of("CARGO_CFG_TARGET_OS") == "linux" && of("CARGO_CFG_TARGET_ENV") == "gnu";
    let is_ours = of("HOST") == of("TARGET") && env::var_os("RUSTC_LINKER").is_none();
    let is_static_already = of("CARGO_CFG_TARGET_FEATURE").split(',').any(|feature| feature == "crt-static");
    if !is_gnu || !is_ours || is_static_already || of("FOSSSIM_LINK") == "shared" {
        return;
    }
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it")).join("archives");
    if lead(&folder).is_ok_and(|links| links) {
        for argument in arguments(&folder) {
            println!("cargo:rustc-link-arg-bins={argument}");
        }
    }
}

/// Has the module of the browser's page compiled into the program, where `FOSSSIM_MODULE` names it
/// (`scripts/browser-page`): nobody else needs the target that it is compiled for.
fn take_module() {
    println!("cargo:rerun-if-env-changed=FOSSSIM_MODULE");
    println!("cargo:rustc-check-cfg=cfg(has_module)");
    let Some(module) = env::var_os("FOSSSIM_MODULE").filter(|module| !module.is_empty()) else { return };
    let module =
        fs::canonicalize(&module).unwrap_or_else(|error| panic!("FOSSSIM_MODULE={}: {error}", module.display()));
    println!("cargo:rerun-if-changed={}", module.display());
    println!("cargo:rustc-env=FOSSSIM_MODULE_FILE={}", module.display());
    println!("cargo:rustc-cfg=has_module");
}

/// Returns the words behind all that Rust says to the linker: of `-pie` and `-no-pie` the last one counts.
fn arguments(folder: &Path) -> [String; 3] {
    [format!("-L{}", folder.display()), "-static".to_owned(), "-no-pie".to_owned()]
}

/// Writes the scripts, and tries them on a program: whether it is linked, and runs.
fn lead(folder: &Path) -> io::Result<bool> {
    fs::create_dir_all(folder)?;
    for shared in SHARED {
        fs::write(folder.join(format!("lib{shared}.so")), ARCHIVES)?;
    }
    let (source, program) = (folder.join("trial.c"), folder.join("trial"));
    fs::write(
        &source,
        "#include <math.h>\nint main(int count, char **words) { return words[0] && sqrt(count) < 0; }\n",
    )?;
    let mut compiler = Command::new("cc");
    compiler.arg(&source).arg("-o").arg(&program).args(["-nodefaultlibs", "-Wl,-Bdynamic"]);
    compiler.args(SHARED.map(|shared| format!("-l{shared}"))).arg("-pie").args(arguments(folder));
    compiler.stdout(Stdio::null()).stderr(Stdio::null());
    Ok(compiler.status()?.success() && Command::new(&program).status()?.success())
}

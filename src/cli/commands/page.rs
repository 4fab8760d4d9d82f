//! The command `page`, which writes the page that checks traces in a browser.
use crate::{
    cli::{arguments::PageArguments, output::Output},
    files::{Identity, open_for_reading, read_limited},
    report::page::Audience,
    suite::plan,
};
use anyhow::{Context, Result, anyhow, bail};
use fosssim_browser::CourseSuite;
use std::borrow::Cow;

/// The WebAssembly module that the build included into the program (build.rs).
#[cfg(has_module)]
const MODULE: Option<&[u8]> = Some(include_bytes!(env!("FOSSSIM_MODULE_FILE")));
#[cfg(not(has_module))]
const MODULE: Option<&[u8]> = None;

/// The maximum size of a module, in bytes.
const MAX_MODULE_BYTES: u64 = 64 << 20;

/// The first bytes that every WebAssembly module has.
const MODULE_MAGIC: &[u8] = b"\0asm";

pub(super) fn run(arguments: &PageArguments) -> Result<()> {
    let (module, inputs) = match (&arguments.module, MODULE) {
        (Some(name), _) => {
            let context = || format!("cannot read the module {}", name.display());
            let (file, metadata) = open_for_reading(name).with_context(context)?;
            let module = read_limited(file, &metadata, MAX_MODULE_BYTES).with_context(context)?;
            (Cow::Owned(module), vec![Identity::from_metadata(&metadata)])
        }
        (None, Some(module)) => (Cow::Borrowed(module), Vec::new()),
        (None, None) => bail!(
            "this program was built without the page: run scripts/browser-page in the sources, or build with \
             FOSSSIM_MODULE (docs/page.md)"
        ),
    };
    if !module.starts_with(MODULE_MAGIC) {
        bail!("the module is not WebAssembly; scripts/browser-page makes one");
    }
    let course = arguments.suite.as_deref().map(|name| select_visible_suite(name, arguments.reader)).transpose()?;
    let target = Output::create(&arguments.output, &inputs)?;
    target.finish_and_print(fosssim_browser::page(&module, course.as_ref()).as_bytes(), true)
}

/// Returns the part of a suite that the readers of the page may see.
fn select_visible_suite(name: &str, reader: Audience) -> Result<CourseSuite> {
    let plan = plan::find_suite(name)?;
    CourseSuite::from_plan(&plan, reader).map_err(|error| anyhow!("the suite {name}: {error}"))
}

//! A working folder in memory: the kernel's limits there, and the grader's access to it.
use crate::sandbox::{backend, small};
use fosssim_oracle::sandbox::{
    Backend, Job, Layer, Limits, Policy, RemainingFolder, RunEnd, RunOutcome, collect::OpenFolder,
};
use fosssim_testing::{Need, skip};
use std::io::Read;
use std::path::Path;

/// Returns a job that runs a shell in a folder that contains `input`, like a build step.
fn job(folder: &Path, script: &str) -> Job {
    std::fs::write(folder.join("input"), "given").unwrap();
    Job::new("/bin/sh", folder).arguments(["-c", script]).policy(Policy::Tools).limits(small()).folder_in_memory()
}

/// Returns the sandbox if it has namespaces.
pub fn with_namespaces() -> Option<&'static Backend> {
    let backend = backend()?;
    let active = backend.layers().iter().any(|report| report.layer == Layer::Namespaces && report.active);
    if !active {
        skip(Need::Walls, "there are no namespaces here");
    }
    active.then_some(backend)
}

fn run(backend: &Backend, job: &Job) -> (RunOutcome, RemainingFolder) {
    backend.start(job).unwrap().wait_with_folder().unwrap()
}

fn text(folder: &OpenFolder, name: &str) -> String {
    let mut text = String::new();
    folder.regular_file(name, 1000).unwrap().0.read_to_string(&mut text).unwrap();
    text
}

#[test]
fn a_programs_files_are_returned_and_its_folder_is_unchanged() {
    let Some(backend) = with_namespaces() else { return };
    let folder = tempfile::tempdir().unwrap();
    let job = job(folder.path(), "mkdir out && cat input input > out/made && rm input && ln -s /etc/passwd link");
    let (outcome, left) = run(backend, &job);
    assert_eq!(outcome.ended, RunEnd::Exited(0));
    let left = left.memory_folder().expect("the folder");
    assert_eq!(text(left, "out/made"), "givengiven");
    assert!(left.regular_file("input", 1000).is_err() && left.regular_file("link", 1000).is_err());
    assert!(left.regular_file("../input", 1000).is_err(), "it leads nowhere else");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    assert_eq!(std::fs::read_to_string(folder.path().join("input")).unwrap(), "given");
}

#[test]
fn a_jobs_files_lie_where_its_program_works_and_nowhere_else() {
    let Some(backend) = with_namespaces() else { return };
    let folder = tempfile::tempdir().unwrap();
    let long = "x".repeat(300_000);
    let files =
        |job: Job| job.file("scene.xml", "a scene").file("empty", "").file("long", long.as_str()).limits(small());
    let read = |folder: &Path| files(Job::new("/usr/bin/wc", folder).arguments(["-c", "scene.xml", "empty", "long"]));
    let sizes = "     7 scene.xml\n     0 empty\n300000 long\n300007 total\n";
    for _ in 0..2 {
        let (outcome, left) = run(backend, &read(folder.path()).folder_in_memory());
        assert_eq!(String::from_utf8_lossy(&outcome.stdout.bytes), sizes);
        assert_eq!((outcome.ended, left.memory_folder().is_some()), (RunEnd::Exited(0), true));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
    // This job uses build tools and folders on the disk.
    let tools = read(folder.path()).folder_in_memory().policy(Policy::Tools);
    for job in [tools, read(folder.path())] {
        assert_eq!(String::from_utf8_lossy(&run(backend, &job).0.stdout.bytes), sizes);
    }
    for name in ["../scene.xml", "", ".", "a/b", "a\0b"] {
        for job in [Job::new("/bin/true", folder.path()), Job::new("/bin/true", folder.path()).folder_in_memory()] {
            assert!(backend.start(&job.file(name, "x").limits(small())).is_err(), "{name:?}");
        }
    }
}

#[test]
fn the_kernel_itself_refuses_more_than_the_folder_may_hold() {
    let Some(backend) = with_namespaces() else { return };
    let folder = tempfile::tempdir().unwrap();
    // Each file is within the file size limit. Together they would be 40 MiB before the supervisor's next check.
    let script = "for i in 1 2 3 4 5 6 7 8 9 10; do head -c 4000000 /dev/zero | tr '\\0' x > f$i; done; sleep 1000";
    let limits = Limits { memory: 256 << 20, ..small() };
    let (outcome, left) = run(backend, &job(folder.path(), script).limits(limits));
    assert_eq!(outcome.ended, RunEnd::FolderLimit);
    let left = left.memory_folder().expect("the folder");
    let bytes: u64 =
        left.list_names().unwrap().iter().filter_map(|name| Some(left.path().join(name).metadata().ok()?.len())).sum();
    assert!(bytes <= 5 << 20, "{bytes} bytes were written");
    assert!(bytes >= 4 << 20, "{bytes} bytes were written");
}

#[test]
fn files_of_the_folder_are_not_the_programs_memory() {
    let Some(backend) = with_namespaces() else { return };
    let folder = tempfile::tempdir().unwrap();
    let limits = Limits { memory: 32 << 20, folder_bytes: 80 << 20, ..small() };
    let script = "head -c 60000000 /dev/zero | tr '\\0' x > file && wc -c < file";
    let (outcome, _) = run(backend, &job(folder.path(), script).limits(limits));
    assert_eq!(outcome.ended, RunEnd::Exited(0), "{outcome:?}");
    assert_eq!(String::from_utf8_lossy(&outcome.stdout.bytes).trim(), "60000000");
    assert!(outcome.peak_memory < 32 << 20, "{}", outcome.peak_memory);
}

#[test]
fn a_trace_lies_in_memory_too() {
    let Some(backend) = with_namespaces() else { return };
    let folder = tempfile::tempdir().unwrap();
    let job = job(folder.path(), "cat input input > trace.bin").trace("trace.bin");
    let (outcome, left) = run(backend, &job);
    let mut trace = Vec::new();
    left.regular_file("trace.bin", 10).unwrap().0.read_to_end(&mut trace).unwrap();
    assert_eq!((outcome.ended, trace.as_slice()), (RunEnd::Exited(0), &b"givengiven"[..]));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing came to the disk");
    assert!(backend.start(&job.trace("../trace.bin")).is_err());
}

#[test]
fn without_namespaces_or_room_the_folder_is_used_as_it_lies() {
    let Some(backend) = backend() else { return };
    let folder = tempfile::tempdir().unwrap();
    let job = job(folder.path(), "cp input made");
    let bare = match backend.without_layer(Layer::Namespaces) {
        Ok(backend) => backend,
        Err(error) => return skip(Need::Walls, error),
    };
    let huge = Limits { folder_bytes: 1 << 50, ..small() };
    for (backend, job) in [(&bare, job.clone()), (backend, job.limits(huge))] {
        let (outcome, left) = run(backend, &job);
        assert_eq!(outcome.ended, RunEnd::Exited(0));
        assert!(left.memory_folder().is_none());
        assert_eq!(std::fs::read_to_string(folder.path().join("made")).unwrap(), "given");
        std::fs::remove_file(folder.path().join("made")).unwrap();
    }
}

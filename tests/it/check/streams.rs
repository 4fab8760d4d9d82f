//! `check` and the files, pipes and devices that it reads and writes.
use super::changed;
use crate::workspace::{BOUNCE, Workspace, finish};
use serde_json::Value;
use std::{
    fs::File,
    io::{Read, Seek, SeekFrom, Write},
    process::Stdio,
};

#[test]
fn a_pipe_without_a_writer_is_rejected() {
    let workspace = Workspace::with_trace(BOUNCE);
    assert!(std::process::Command::new("mkfifo").arg(workspace.path("pipe")).status().unwrap().success());
    let run = workspace.run(["check", "scene.xml", "pipe"]);
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("nothing wrote to the pipe"), "{}", run.err());
    let run = workspace.run(["check", "scene.xml", "trace.bin", "--output", "pipe"]);
    assert_eq!(run.code, Some(2));
    assert!(run.err().contains("this is a pipe, socket or block device"), "{}", run.err());
}

#[test]
fn a_pipe_with_a_writer_is_read() {
    let workspace = Workspace::with_trace(BOUNCE);
    assert!(std::process::Command::new("mkfifo").arg(workspace.path("pipe")).status().unwrap().success());
    let pipe = workspace.path("pipe");
    let trace = workspace.read("trace.bin");
    let run = std::thread::scope(|scope| {
        scope.spawn(move || File::options().write(true).open(pipe).unwrap().write_all(&trace).unwrap());
        workspace.run(["check", "scene.xml", "pipe"])
    });
    assert_eq!(run.code, Some(0), "{}", run.shown());
    let run = workspace.run_with_input(["check", "scene.xml", "-"], &workspace.read("trace.bin"));
    assert_eq!(run.code, Some(0), "{}", run.shown());
    let folder = File::open(workspace.path("")).unwrap();
    let run = finish(workspace.command().args(["check", "scene.xml", "-"]).stdin(folder));
    assert_eq!(run.code, Some(2));
    assert!(run.err().starts_with("error: cannot read the trace from standard input: "), "{}", run.err());
}

#[test]
fn a_sparse_file_of_ten_gigabytes_costs_no_more_than_its_records() {
    let workspace = Workspace::with_trace(BOUNCE);
    let mut file = File::create(workspace.path("sparse.bin")).unwrap();
    file.seek(SeekFrom::Start(10_000_000_000)).unwrap();
    file.write_all(&[0]).unwrap();
    let run = workspace.run(["check", "scene.xml", "sparse.bin", "--format", "json"]);
    let json: Value = serde_json::from_slice(&run.stdout).unwrap();
    assert_eq!((run.code, &json["trailing_bytes"]), (Some(1), &Value::Bool(true)), "{}", run.shown());
}

#[test]
fn compressed_traces_are_unpacked() {
    let workspace = Workspace::with_trace(BOUNCE);
    let packed = zstd::encode_all(&workspace.read("trace.bin")[..], 3).unwrap();
    workspace.write("trace.bin.zst", &packed);
    workspace.write("nameless", &packed);
    for name in ["trace.bin.zst", "nameless"] {
        assert_eq!(workspace.run(["check", "scene.xml", name]).code, Some(0), "{name}");
    }
    let trace = workspace.read("trace.bin");
    let two = [&packed[..], &zstd::encode_all(&b"more"[..], 3).unwrap()].concat();
    workspace.write("two.zst", two);
    let run = workspace.run(["check", "scene.xml", "two.zst"]);
    assert!(run.out().contains("bytes follow the last record"), "{}", run.shown());
    let mut damaged = packed.clone();
    let middle = damaged.len() / 2;
    damaged[middle] ^= 0xff;
    let mut wide = zstd::stream::Encoder::new(Vec::new(), 3).unwrap();
    wide.window_log(27).unwrap();
    std::io::Write::write_all(&mut wide, &trace).unwrap();
    let damage = "the zstd data is damaged; copy it again";
    for (name, bytes, says) in [
        ("cut.zst", packed[..packed.len() - 5].to_vec(), "the zstd data is cut short; copy it again"),
        ("damaged.zst", damaged, damage),
        ("garbage.zst", [&packed[..], b"garbage"].concat(), damage),
        (
            "wide.zst",
            wide.finish().unwrap(),
            "the file's zstd window is larger than 8 MiB; compress it again without --long or --ultra",
        ),
    ] {
        workspace.write(name, bytes);
        for command in [&["check"][..], &["explain"]] {
            let run = workspace.run(command.iter().copied().chain(["scene.xml", name]));
            assert_eq!((run.code, run.out().as_str()), (Some(2), ""), "{name}: {}", run.err());
            assert!(run.err().starts_with(&format!("error: cannot read the trace {name}")), "{}", run.err());
            assert!(run.err().contains(says), "{name}: {}", run.err());
        }
    }
    workspace.write("plain.zst", workspace.read("trace.bin"));
    let plain = workspace.run(["check", "scene.xml", "plain.zst"]);
    assert_eq!(plain.code, Some(2));
    assert!(plain.err().contains("the file is not zstd data"), "{}", plain.err());
}

#[test]
fn the_report_goes_where_it_is_asked_to_go() {
    let workspace = Workspace::with_trace(BOUNCE);
    let printed = workspace.run(["check", "scene.xml", "trace.bin"]);
    let run = workspace.run(["check", "scene.xml", "trace.bin", "--output", "report.txt"]);
    assert_eq!((run.code, run.stdout.len()), (Some(0), 0));
    assert_eq!(workspace.read("report.txt"), printed.stdout);
    assert_eq!(workspace.list(), ["report.txt", "scene.xml", "trace.bin"]);
    for input in ["trace.bin", "scene.xml"] {
        let before = workspace.read(input);
        let run = workspace.run(["check", "scene.xml", "trace.bin", "--output", input]);
        assert_eq!(run.code, Some(2));
        assert!(run.err().contains("this is also an input"), "{}", run.err());
        assert_eq!(workspace.read(input), before);
    }
    let run = workspace.run(["check", "scene.xml", "trace.bin", "--output", "no/such/folder"]);
    assert_eq!(run.code, Some(2));
}

#[test]
fn nobody_listening_does_not_change_the_verdict() {
    let workspace = Workspace::with_trace(BOUNCE);
    workspace.write("wrong.bin", changed(BOUNCE, |frames| frames[2].impulses.clear()));
    for (trace, code) in [("trace.bin", 0), ("wrong.bin", 1)] {
        let mut child = workspace.command().args(["check", "scene.xml", trace]).spawn().unwrap();
        drop(child.stdout.take());
        assert_eq!(child.wait().unwrap().code(), Some(code), "{trace}");
    }
    // A full disk is the machine's fault, not the trace's.
    let full = File::options().write(true).open("/dev/full").unwrap();
    let run = finish(workspace.command().args(["check", "scene.xml", "trace.bin"]).stdout(Stdio::from(full)));
    assert_eq!(run.code, Some(2));
}

#[test]
fn an_endless_input_is_read_no_further_than_the_scene_asks() {
    let workspace = Workspace::with_trace(BOUNCE);
    let run = workspace.run(["check", "scene.xml", "/dev/zero", "--format", "json"]);
    let mut zeros = Vec::new();
    File::open("/dev/zero").unwrap().take(4096).read_to_end(&mut zeros).unwrap();
    workspace.write("zeros.bin", zeros);
    let finite = workspace.run(["check", "scene.xml", "zeros.bin", "--format", "json"]);
    assert_eq!(run.out().replace("/dev/zero", "zeros.bin"), finite.out());
}

//! Programs that create their trace in unusual ways: only the file at the end counts.
use crate::workspace::{BOUNCE, Workspace, trace_of};
use fosssim_testing::{Need, skip};
use std::{fs, os::unix::fs::PermissionsExt};

/// Returns a C program that has the trace of [`BOUNCE`] in `right`, and its file name in `path`.
fn program(body: &str) -> String {
    let bytes: Vec<String> = trace_of(BOUNCE).iter().map(u8::to_string).collect();
    format!(
        "#define _GNU_SOURCE\n#include <fcntl.h>\n#include <stdio.h>\n#include <string.h>\n#include <sys/mman.h>\n\
         #include <unistd.h>\n\
         static const unsigned char right[] = {{{}}};\nenum {{ size = sizeof right }};\n\
         int main(int argc, char **argv) {{\n    const char *path = \"\";\n    int fd;\n\
         for (int i = 1; i + 1 < argc; i++) if (!strcmp(argv[i], \"-o\")) path = argv[i + 1];\n{body}\n}}\n",
        bytes.join(",")
    )
}

#[test]
fn a_program_is_graded_by_the_file_that_it_leaves() {
    let workspace = Workspace::new();
    if workspace.run(["doctor"]).code != Some(0) {
        return skip(Need::Sandbox, "programs can't be run here");
    }
    if !std::process::Command::new("cc").arg("--version").output().is_ok_and(|output| output.status.success()) {
        return skip(Need::Cc, "there is no C compiler (cc)");
    }
    workspace.write(
        "suite.toml",
        "schema = 1\nname = \"t\"\n[[group]]\nname = \"g\"\npoints = 10\nscenes = [\"scenes/*.xml\"]\n",
    );
    workspace.write("scenes/s.xml", BOUNCE);
    let create = "fd = open(path, O_RDWR | O_CREAT | O_TRUNC, 0644);";
    let write = "write(fd, right, size);";
    let map = "void *at = mmap(0, size, PROT_WRITE, MAP_SHARED, fd, 0); if (at == MAP_FAILED) return 5;";
    let exclusive = "fd = open(path, O_WRONLY | O_CREAT | O_EXCL, 0644); if (fd < 0) return 4;";
    let beside = "fd = open(\"beside\", O_WRONLY | O_CREAT, 0644);";
    let seek =
        "write(fd, right + 8, 8); lseek(fd, 8, SEEK_SET); write(fd, right + 8, size - 8); pwrite(fd, right, 8, 0);";
    let print = "for (int i = 0; i < 100000; i++) puts(\"collision between particles\");";
    let ways = [
        ("beside", "accepted", format!("{beside} {write} rename(\"beside\", path);")),
        ("removes", "accepted", format!("{create} close(fd); unlink(path); {create} {write}")),
        ("exclusive", "accepted", format!("{exclusive} {write}")),
        ("seeks", "accepted", format!("{create} {seek}")),
        (
            "truncates",
            "accepted",
            format!("{create} ftruncate(fd, size + 9); {write} if (ftruncate(fd, size)) return 4;"),
        ),
        ("maps", "accepted", format!("{create} if (ftruncate(fd, size)) return 4; {map} memcpy(at, right, size);")),
        ("prints", "accepted", format!("{create} {write} {print}")),
        ("elsewhere", "no output", format!("{beside} {write}")),
        ("moves", "no output", format!("{create} {write} rename(path, \"other\");")),
    ];
    for (name, _, body) in &ways {
        workspace.write(format!("{name}.c"), program(body));
        fs::create_dir_all(workspace.path("class")).expect("a folder");
        let (program, source) = (workspace.path("class").join(name), workspace.path(format!("{name}.c")));
        let built = std::process::Command::new("cc").args(["-w", "-o"]).arg(program).arg(source).status();
        assert!(built.expect("cc").success());
        fs::set_permissions(workspace.path("class").join(name), fs::Permissions::from_mode(0o644)).expect("a mode");
    }
    let run = workspace.run(["grade", "--suite", "suite.toml", "class", "--output", "grades"]);
    let rows = workspace.read("grades/grades.csv");
    let rows: Vec<csv::StringRecord> = csv::Reader::from_reader(&rows[..]).into_records().map(Result::unwrap).collect();
    let mut expected: Vec<(&str, &str)> = ways.iter().map(|(name, verdict, _)| (*name, *verdict)).collect();
    expected.sort_unstable();
    let mut found: Vec<(&str, &str)> = rows.iter().map(|row| (&row[0], &row[1])).collect();
    found.sort_unstable();
    assert_eq!(found, expected, "{}", run.shown());
    let log = String::from_utf8(workspace.read("grades/logs/prints.log")).expect("text");
    assert!(log.contains("[standard output was cut after 1 MiB]"), "{log}");
}

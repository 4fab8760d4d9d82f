//! The examples of where servers and workers run: their options exist, and the tools that read them accept them.
use fosssim_testing::{Need, skip};
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

fn deploy() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/deploy")
}

fn read(name: &str) -> String {
    fs::read_to_string(deploy().join(name)).expect(name)
}

/// The words of a file that look like options.
fn options(text: &str) -> Vec<String> {
    let words = text.split(|c: char| c.is_whitespace() || matches!(c, '"' | ',' | '[' | ']' | '`' | ';'));
    let names = words.filter_map(|word| word.strip_prefix("--")).map(|word| word.split('=').next().unwrap_or_default());
    names.filter(|name| !name.is_empty()).map(|name| format!("--{name}")).collect()
}

/// The lines on which the server's program is started, with those that belong to them.
fn commands(text: &str) -> String {
    let starts = |line: &str| !line.trim_start().starts_with('#') || line.contains("fosssim-server worker");
    text.lines().filter(|line| starts(line)).collect::<Vec<_>>().join("\n")
}

#[test]
fn options_of_examples_exist() {
    let help = |command: &str| {
        let output =
            Command::new(env!("CARGO_BIN_EXE_fosssim-server")).args([command, "--help"]).output().expect("help");
        String::from_utf8(output.stdout).expect("text")
    };
    let (serve, worker) = (help("serve"), help("worker"));
    for (name, help) in [
        ("systemd/fosssim-server.service", &serve),
        ("systemd/fosssim-worker.service", &worker),
        ("kubernetes/worker.yaml", &worker),
        ("slurm/worker.sbatch", &worker),
        ("compose/compose.yaml", &serve),
    ] {
        let text = commands(&read(name));
        let started: String = text
            .lines()
            .skip_while(|line| {
                !line.contains("fosssim-server worker")
                    && !line.contains("fosssim-server serve")
                    && !line.contains("[fosssim-server, worker]")
            })
            .take_while(|line| !line.contains("resources:"))
            .collect::<Vec<_>>()
            .join("\n");
        let found = options(&started);
        assert!(!found.is_empty(), "{name}: {started}");
        for option in found {
            assert!(help.contains(&option), "{name} uses {option}, which is none");
        }
    }
}

#[test]
fn units_are_accepted() {
    if !Path::new("/usr/bin/systemd-analyze").exists() {
        return skip(Need::Systemd, "no systemd-analyze");
    }
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["fosssim-server.service", "fosssim-worker.service"] {
        // The programs are not installed where tests run.
        let text = read(&format!("systemd/{name}")).replace("/opt/fosssim/fosssim-server", "/bin/true");
        let file = folder.path().join(name);
        fs::write(&file, text).expect("written");
        let verified =
            Command::new("systemd-analyze").args(["verify", "--man=no"]).arg(&file).output().expect("an answer");
        let said = String::from_utf8_lossy(&verified.stderr).into_owned();
        assert!(verified.status.success() && !said.contains(name), "{said}");
    }
}

#[test]
fn yaml_is_well_formed() {
    let python = |script: &str| Command::new("python3").args(["-c", script]).current_dir(deploy()).output();
    if !python("import yaml").is_ok_and(|output| output.status.success()) {
        return skip(Need::Yaml, "python3 has no yaml");
    }
    let script = "import yaml\n\
        d = yaml.safe_load(open('kubernetes/worker.yaml'))\n\
        assert d['spec']['selector']['matchLabels'] == d['spec']['template']['metadata']['labels'], d\n\
        c = yaml.safe_load(open('compose/compose.yaml'))\n\
        named = {s for v in c['services'].values() for s in v.get('secrets', [])}\n\
        assert named <= set(c['secrets']) and isinstance(c['services']['server']['command'][0], str), c\n";
    let output = python(script).expect("python");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

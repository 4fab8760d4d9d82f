//! Checks the examples for deployment: their options exist, and the tools that read them accept them.
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

/// Returns the words of a file that look like options.
fn options(text: &str) -> Vec<String> {
    let words = text.split(|c: char| c.is_whitespace() || matches!(c, '"' | ',' | '[' | ']' | '`' | ';'));
    let names = words.filter_map(|word| word.strip_prefix("--")).map(|word| word.split('=').next().unwrap_or_default());
    names.filter(|name| !name.is_empty()).map(|name| format!("--{name}")).collect()
}

/// Returns the lines that start the server's program, with their continuation lines.
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
        ("kubernetes/server.yaml", &serve),
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
                    && !line.contains("[fosssim-server, serve]")
            })
            .take_while(|line| !["resources:", "Probe:", "healthcheck:"].iter().any(|word| line.contains(word)))
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

/// The maximum exposure of a unit according to systemd, in tenths. A service without any rights has 0.
const EXPOSURE: u32 = 29;

#[test]
fn units_leave_little_exposed() {
    if !Path::new("/usr/bin/systemd-analyze").exists() {
        return skip(Need::Systemd, "no systemd-analyze");
    }
    for (name, user) in [("fosssim-server.service", "fosssim"), ("fosssim-worker.service", "fosssim-worker")] {
        let text = read(&format!("systemd/{name}"));
        // The user that runs untrusted programs is not the user that stores the grades.
        for line in [&format!("User={user}"), "Type=notify", "WatchdogSec=120", "PrivateTmp=yes"] {
            assert!(text.lines().any(|known| known == line), "{name} has no {line}");
        }
        let judged = Command::new("systemd-analyze")
            .args(["security", "--offline=true", "--no-pager", &format!("--threshold={EXPOSURE}")])
            .arg(deploy().join("systemd").join(name))
            .output()
            .expect("an answer");
        let said = String::from_utf8_lossy(&judged.stdout).into_owned();
        assert!(judged.status.success() && said.contains("Overall exposure level"), "{name}: {said}");
    }
}

#[test]
fn yaml_is_well_formed() {
    let python = |script: &str| Command::new("python3").args(["-c", script]).current_dir(deploy()).output();
    if !python("import yaml").is_ok_and(|output| output.status.success()) {
        return skip(Need::Yaml, "python3 has no yaml");
    }
    let script = "import yaml\n\
        for name in ['server', 'worker']:\n\
        \x20   objects = {d['kind']: d for d in yaml.safe_load_all(open(f'kubernetes/{name}.yaml'))}\n\
        \x20   spec = next(d['spec'] for k, d in objects.items() if k in ('Deployment', 'StatefulSet'))\n\
        \x20   labels, pod = spec['template']['metadata']['labels'], spec['template']['spec']\n\
        \x20   assert spec['selector']['matchLabels'] == labels, spec\n\
        \x20   assert objects['NetworkPolicy']['spec']['podSelector']['matchLabels'] == labels\n\
        \x20   assert pod['securityContext']['runAsNonRoot'] and not pod['automountServiceAccountToken']\n\
        \x20   for c in pod['containers']:\n\
        \x20       assert c['livenessProbe'] and c['startupProbe'] and c['resources']['limits']['memory'], c\n\
        \x20       assert c['securityContext']['readOnlyRootFilesystem'], c\n\
        \x20       assert c['securityContext']['capabilities'] == {'drop': ['ALL']}, c\n\
        \x20       named = {v['name'] for v in pod['volumes'] + spec.get('volumeClaimTemplates', []) if 'name' in v}\n\
        \x20       named |= {v['metadata']['name'] for v in spec.get('volumeClaimTemplates', [])}\n\
        \x20       assert {m['name'] for m in c['volumeMounts']} <= named, (c, named)\n\
        job = yaml.safe_load(open('kubernetes/class.yaml'))['spec']\n\
        c = job['template']['spec']['containers'][0]\n\
        assert job['completionMode'] == 'Indexed' and c['env'][0]['value'] == str(job['completions']), job\n\
        scale = yaml.safe_load(open('kubernetes/scale.yaml'))['spec']\n\
        assert scale['scaleTargetRef']['name'] == 'fosssim-worker', scale\n\
        c = yaml.safe_load(open('compose/compose.yaml'))\n\
        named = {s for v in c['services'].values() for s in v.get('secrets', [])}\n\
        assert named <= set(c['secrets']) and isinstance(c['services']['server']['command'][0], str), c\n";
    let output = python(script).expect("python");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

//! Finds the kind of a program from its first bytes, before anything is executed.
//!
//! The headers of a submitted file are not followed. Its first bytes show for which machine it was built. The rest is
//! read by the kernel and the loader, within the limits. Only the first line of a script is read, because the system's
//! interpreter is executed instead of the script.

use std::{
    fs::File,
    io::Read,
    os::unix::fs::{MetadataExt, PermissionsExt},
    path::{Component, Path, PathBuf},
};

use super::{outcome::StartProblem, own_files};

/// The first bytes of an ELF file.
const ELF_MAGIC: &[u8] = b"\x7fELF";
/// The number of bytes from which the kind of a file is recognized. The kernel reads as many bytes for the first line
/// of a script.
const HEADER_BYTES: u64 = 256;
/// The folders of the system's programs that a script may name. They are in the same order as in the sandbox's `PATH`.
const PROGRAM_FOLDERS: [&str; 3] = ["/usr/local/bin", "/usr/bin", "/bin"];
/// The folders of interpreters to which folders of programs may link.
const LIBRARY_FOLDERS: [&str; 4] = ["/lib", "/usr/lib", "/usr/lib64", "/usr/libexec"];

/// The facts about a program that the sandbox needs before starting it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct ProgramFacts {
    /// The interpreters that the kernel executes to start the program.
    pub(super) executable: Vec<PathBuf>,
    /// The names by which these files are requested. They may be links.
    pub(super) named_paths: Vec<PathBuf>,
    /// The interpreter and its arguments; `None` if the program is not a script.
    pub(super) script: Option<Script>,
}

/// The interpreter of a script. It is found in the same way as by the kernel and by `env`. Because it is executed
/// directly, a script needs only one execution.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Script {
    /// The path of the interpreter.
    pub(super) interpreter: PathBuf,
    /// The name of the interpreter, followed by those of its arguments that precede the script.
    pub(super) interpreter_arguments: Vec<String>,
    /// The environment variables that the script's first line sets.
    pub(super) environment: Vec<(String, String)>,
}

/// Examines the file at `path`. Symbolic links are followed. The grader's own programs, which are in `own`, are never
/// run as a submission, an interpreter or a loader.
///
/// # Errors
///
/// Fails if the file cannot be started on this machine. The error is the reason.
pub(super) fn examine(path: &Path, own: &[PathBuf]) -> Result<ProgramFacts, StartProblem> {
    let metadata = std::fs::metadata(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::PermissionDenied => StartProblem::NotPermitted,
        _ => StartProblem::NotFound,
    })?;
    if metadata.is_dir() {
        return Err(StartProblem::IsFolder);
    }
    if !metadata.is_file() {
        return Err(StartProblem::NotAFile);
    }
    if is_one_of(path, own) {
        return Err(StartProblem::GradersOwn);
    }
    // A program that may be executed but not read would also prevent the checks of the supervisor.
    let start = read_header(path).ok_or(StartProblem::NotPermitted)?;
    let facts = match (start.strip_prefix(b"#!"), identify_other_system(&start)) {
        (Some(line), _) => find_interpreter(line, own, 0)?,
        (None, Some(system)) => return Err(StartProblem::WrongSystem { system: system.into() }),
        (None, None) => require_elf(&start).map(|()| ProgramFacts::default())?,
    };
    // Permission to execute a file helps only if the file is a program.
    if metadata.permissions().mode() & 0o111 == 0 { Err(StartProblem::NotExecutable) } else { Ok(facts) }
}

/// Returns the other operating system whose programs begin with these bytes; `None` if it is unknown.
fn identify_other_system(start: &[u8]) -> Option<&'static str> {
    match *start.first_chunk::<8>()? {
        [b'M', b'Z', ..] => Some("Windows"),
        [0xcf | 0xce, 0xfa, 0xed, 0xfe, ..] => Some("macOS"),
        // In a universal binary, this is the number of programs. In a Java class it is the version, which is at least
        // 45.
        [0xca, 0xfe, 0xba, 0xbe, 0, 0, 0, 1..45] => Some("macOS"),
        _ => None,
    }
}

/// Returns the bytes from which the kind of a file is recognized; `None` if the file cannot be read.
fn read_header(path: &Path) -> Option<Vec<u8>> {
    let mut start = Vec::new();
    File::open(path).ok()?.take(HEADER_BYTES).read_to_end(&mut start).ok()?;
    Some(start)
}

/// Returns a script's interpreter, given its first line without `#!`.
///
/// The submission may then execute each program that the line names. Therefore, after all links and `..` are resolved,
/// each must be one of the system's own programs. Otherwise a script could name the grader's program, and would be
/// graded on the grader's answers. Nothing outside the system's folders is examined, because that would reveal which
/// files exist there.
fn find_interpreter(line: &[u8], own: &[PathBuf], depth: u32) -> Result<ProgramFacts, StartProblem> {
    /// The maximum number of interpreters in a row that are scripts. The kernel has the same limit.
    const MAX_DEPTH: u32 = 4;
    let line = String::from_utf8_lossy(line.split(|&byte| byte == b'\n').next().unwrap_or_default()).into_owned();
    let hint = "; install it, or name another one";
    let missing = |name: &str, hint: &'static str| StartProblem::MissingInterpreter {
        interpreter: name.escape_default().to_string(),
        hint: hint.into(),
    };
    if line.ends_with('\r') {
        // For the kernel, the carriage return is the last character of the name.
        let hint =
            ": its name ends with a carriage return, because the lines end with CR LF; convert them with dos2unix";
        return Err(missing(line.trim_start(), hint));
    }
    let line = line.trim();
    let (interpreter, rest) =
        line.split_once(char::is_whitespace).map_or((line, ""), |(name, rest)| (name, rest.trim()));
    if interpreter.is_empty() {
        return Err(StartProblem::NoInterpreter);
    }
    let existing = |path: &Path| path.is_file().then(|| path.to_path_buf());
    if !is_system_path(Path::new(interpreter)) {
        return Err(StartProblem::NotTheSystems { path: interpreter.escape_default().to_string() });
    }
    let mut found = existing(Path::new(interpreter)).ok_or_else(|| missing(interpreter, hint))?;
    let mut resolved = require_system_file(&found, own)?;
    let mut script = Script { interpreter_arguments: vec![interpreter.to_owned()], ..Script::default() };
    if interpreter.ends_with("/env") {
        let (name, arguments) = find_env_command(rest, &mut script.environment)?;
        if name.contains('/') {
            return Err(StartProblem::NotTheSystems { path: name.escape_default().to_string() });
        }
        if name.starts_with('-') {
            return Err(missing(&name, "; the only supported option of env is -S"));
        }
        let file = PROGRAM_FOLDERS.iter().find_map(|folder| existing(&Path::new(folder).join(&name)));
        found = file.ok_or_else(|| missing(&name, hint))?;
        resolved = require_system_file(&found, own)?;
        script.interpreter_arguments = [vec![name], arguments].concat();
    } else if !rest.is_empty() {
        script.interpreter_arguments.push(rest.to_owned());
    }
    let start = read_header(&resolved).ok_or(StartProblem::NotPermitted)?;
    let mut program = match start.strip_prefix(b"#!") {
        Some(line) if depth < MAX_DEPTH => {
            let outer = find_interpreter(line, own, depth + 1)?;
            let inner = std::mem::take(&mut script.interpreter_arguments);
            let by = outer.script.clone().unwrap_or_default();
            script.interpreter_arguments =
                [by.interpreter_arguments, vec![found.to_string_lossy().into_owned()], inner[1..].to_vec()].concat();
            script.environment.extend(by.environment);
            script.interpreter = by.interpreter;
            outer
        }
        _ => {
            script.interpreter.clone_from(&found);
            ProgramFacts::default()
        }
    };
    program.executable.insert(0, resolved);
    program.named_paths.insert(0, found);
    Ok(ProgramFacts { script: Some(script), ..program })
}

/// Returns the command that `env` would find, and its arguments. `rest` is the part of a script's first line after
/// `env`.
fn find_env_command(
    rest: &str,
    environment: &mut Vec<(String, String)>,
) -> Result<(String, Vec<String>), StartProblem> {
    // Without -S, the kernel passes the rest of the line as a single word.
    let Some(split) = rest.strip_prefix("-S").or_else(|| rest.strip_prefix("--split-string=")) else {
        return match rest {
            "" => Err(StartProblem::NoInterpreter),
            name => Ok((name.to_owned(), Vec::new())),
        };
    };
    let mut words = split.split_whitespace().peekable();
    while let Some((name, value)) = words.peek().and_then(|word| word.split_once('=')) {
        environment.push((name.to_owned(), value.to_owned()));
        words.next();
    }
    let name = words.next().ok_or(StartProblem::NoInterpreter)?;
    Ok((name.to_owned(), words.map(str::to_owned).collect()))
}

/// Returns whether the text of the path begins with one of the system's folders.
fn is_system_path(path: &Path) -> bool {
    let plain = path.components().all(|part| matches!(part, Component::RootDir | Component::Normal(_)));
    plain && PROGRAM_FOLDERS.iter().chain(&LIBRARY_FOLDERS).any(|folder| path.starts_with(folder))
}

/// Returns the resolved path of an interpreter. It must be below one of the system's folders, and not a program of the
/// grader.
fn require_system_file(path: &Path, own: &[PathBuf]) -> Result<PathBuf, StartProblem> {
    let refused = || StartProblem::NotTheSystems { path: path.to_string_lossy().escape_default().to_string() };
    let resolved = path.canonicalize().map_err(|_| refused())?;
    let beneath = |folder: &&str| Path::new(folder).canonicalize().is_ok_and(|folder| resolved.starts_with(folder));
    // The permission bit that lets every user execute a file. If only the owner could execute a file, this would be
    // noticed too late.
    const EXECUTE_BIT: u32 = 0o001;
    let open = |path: &Path| path.metadata().is_ok_and(|metadata| metadata.permissions().mode() & EXECUTE_BIT != 0);
    let named = [path, &resolved].into_iter().any(own_files::is_program_name);
    let beneath = PROGRAM_FOLDERS.iter().chain(&LIBRARY_FOLDERS).any(beneath);
    if !beneath || named || is_one_of(&resolved, own) || !resolved.ancestors().all(open) {
        return Err(refused());
    }
    Ok(resolved)
}

/// Returns whether the path leads to one of the files in `own`, under any name.
fn is_one_of(path: &Path, own: &[PathBuf]) -> bool {
    let identity = |path: &Path| path.metadata().ok().map(|metadata| (metadata.dev(), metadata.ino()));
    let here = identity(path);
    here.is_some() && own.iter().any(|own| identity(own) == here)
}

/// Checks that a file which begins with `start` is an ELF program for this machine.
fn require_elf(start: &[u8]) -> Result<(), StartProblem> {
    if !start.starts_with(ELF_MAGIC) {
        return Err(StartProblem::NotAProgram);
    }
    if start.get(4) == Some(&1) {
        return Err(StartProblem::ThirtyTwoBit);
    }
    let half =
        |offset: usize| start.get(offset..offset + 2).map_or(0, |bytes| u16::from_le_bytes([bytes[0], bytes[1]]));
    let (machine, here) = (half(18), machine_number());
    if start.get(5) != Some(&1) || machine != here {
        return Err(StartProblem::WrongMachine { machine: machine_name(machine), here: std::env::consts::ARCH.into() });
    }
    match half(16) {
        2 | 3 => Ok(()),
        1 => Err(StartProblem::NotLinked { what: "an object file".into() }),
        4 => Err(StartProblem::NotLinked { what: "a core dump".into() }),
        _ => Err(StartProblem::NotAProgram),
    }
}

fn machine_number() -> u16 {
    match std::env::consts::ARCH {
        "aarch64" => 183,
        "riscv64" => 243,
        _ => 62,
    }
}

fn machine_name(machine: u16) -> String {
    match machine {
        3 => "x86 (32 bits)".into(),
        8 => "MIPS".into(),
        21 => "PowerPC".into(),
        22 => "S/390".into(),
        40 => "ARM (32 bits)".into(),
        62 => "x86_64".into(),
        183 => "aarch64 (64-bit ARM)".into(),
        243 => "RISC-V".into(),
        other => format!("another processor (ELF machine {other})"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(name: &str, bytes: &[u8], mode: u32) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(mode)).unwrap();
        (folder, path)
    }

    fn header(class: u8, kind: u8, machine: u8) -> Vec<u8> {
        let mut bytes = b"\x7fELF\x02\x01\x01".to_vec();
        bytes.resize(64, 0);
        (bytes[4], bytes[16], bytes[18]) = (class, kind, machine);
        bytes
    }

    #[test]
    fn files_that_are_not_programs_are_named_by_kind() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(examine(folder.path(), &[]), Err(StartProblem::IsFolder));
        assert_eq!(examine(&folder.path().join("none"), &[]), Err(StartProblem::NotFound));
        assert_eq!(examine(Path::new("/dev/null"), &[]), Err(StartProblem::NotAFile));
        let (_kept, path) = written("a", b"#!/bin/sh\n", 0o644);
        assert_eq!(examine(&path, &[]), Err(StartProblem::NotExecutable));
        for mode in [0o644, 0o755] {
            let (_kept, path) = written("a", b"hello", mode);
            assert_eq!(examine(&path, &[]), Err(StartProblem::NotAProgram));
        }
        for (start, system) in [
            (b"MZ\x90\x00\x03\x00\x00\x00", Some("Windows")),
            (b"\xcf\xfa\xed\xfe\x0c\x00\x00\x01", Some("macOS")),
            (b"\xca\xfe\xba\xbe\x00\x00\x00\x02", Some("macOS")),
            (b"\xca\xfe\xba\xbe\x00\x00\x00\x41", None),
        ] {
            let (_kept, path) = written("a", start, 0o755);
            let wrong = system.map(|system| StartProblem::WrongSystem { system: system.into() });
            assert_eq!(examine(&path, &[]), Err(wrong.unwrap_or(StartProblem::NotAProgram)));
        }
        let (_kept, path) = written("a", b"", 0o755);
        assert_eq!(examine(&path, &[]), Err(StartProblem::NotAProgram));
    }

    #[test]
    fn foreign_and_unlinked_files_are_named() {
        let here = machine_number() as u8;
        let (_kept, path) = written("a", &header(1, 2, 3), 0o755);
        assert_eq!(examine(&path, &[]), Err(StartProblem::ThirtyTwoBit));
        let (_kept, path) = written("a", &header(2, 2, 21), 0o755);
        assert!(matches!(examine(&path, &[]), Err(StartProblem::WrongMachine { machine, .. }) if machine == "PowerPC"));
        let (_kept, path) = written("a", &header(2, 1, here), 0o755);
        assert_eq!(examine(&path, &[]), Err(StartProblem::NotLinked { what: "an object file".into() }));
        let (_kept, path) = written("a", &header(2, 2, here), 0o755);
        assert_eq!(examine(&path, &[]), Ok(ProgramFacts::default()), "all else is the kernel's matter");
    }

    #[test]
    fn scripts_name_their_interpreter() {
        let (_kept, path) = written("a", b"#!\n", 0o755);
        assert_eq!(examine(&path, &[]), Err(StartProblem::NoInterpreter));
        let (_kept, path) = written("a", b"#!/usr/bin/no-shell -e\n", 0o755);
        let problem = examine(&path, &[]).unwrap_err();
        let StartProblem::MissingInterpreter { interpreter, .. } = &problem else { panic!("{problem}") };
        assert_eq!(interpreter, "/usr/bin/no-shell");
        // It does not matter whether the interpreter exists without the carriage return.
        let (_kept, path) = written("a", b"#!/bin/sh\r\nexit 0\r\n", 0o755);
        let problem = examine(&path, &[]).unwrap_err().to_string();
        assert!(problem.contains("interpreter /bin/sh\\r is not") && problem.contains("carriage return"), "{problem}");
        let (_kept, path) = written("a", b"#!/usr/bin/no-shell\r\n", 0o755);
        let problem = examine(&path, &[]).unwrap_err();
        let StartProblem::MissingInterpreter { hint, .. } = &problem else { panic!("{problem}") };
        assert!(hint.contains("dos2unix"), "{problem}");
        let (_kept, path) = written("a", b"#! /bin/sh -e\n", 0o755);
        let program = examine(&path, &[]).unwrap();
        assert!(program.executable[0] == Path::new("/bin/sh").canonicalize().unwrap());
        let script = program.script.unwrap();
        assert_eq!(
            (script.interpreter.as_path(), script.interpreter_arguments),
            (Path::new("/bin/sh"), vec!["/bin/sh".into(), "-e".into()])
        );
    }

    #[test]
    fn env_is_read_and_not_executed() {
        let script = |line: &str| {
            let (_kept, path) = written("a", line.as_bytes(), 0o755);
            examine(&path, &[]).map(|program| program.script.unwrap())
        };
        let found = script("#!/usr/bin/env sh\n").unwrap();
        assert!(
            found.interpreter.ends_with("sh") && found.interpreter_arguments == ["sh"] && found.environment.is_empty()
        );
        let found = script("#! /usr/bin/env -S A=1 B= sh -e -u \n").unwrap();
        assert_eq!(found.interpreter_arguments, ["sh", "-e", "-u"]);
        assert_eq!(found.environment, [("A".into(), "1".into()), ("B".into(), String::new())]);
        assert!(matches!(script("#!/usr/bin/env -i sh\n"), Err(StartProblem::MissingInterpreter { .. })));
        assert!(matches!(script("#!/usr/bin/env sh -e\n"), Err(StartProblem::MissingInterpreter { .. })));
        assert_eq!(script("#!/usr/bin/env\n"), Err(StartProblem::NoInterpreter));
    }

    #[test]
    fn an_interpreter_that_nobody_may_execute_is_the_programs_fault_from_the_start() {
        let (_kept, path) = written("a", b"#!/usr/lib/os-release\n", 0o755);
        let found = examine(&path, &[]);
        assert!(matches!(found, Err(StartProblem::NotTheSystems { .. } | StartProblem::MissingInterpreter { .. })));
    }

    #[test]
    fn a_script_cannot_find_out_which_files_the_host_has() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("there"), "").unwrap();
        let told = |name: &str| {
            let interpreter = folder.path().join(name);
            let (_kept, path) = written("a", format!("#!{}\n", interpreter.display()).as_bytes(), 0o755);
            examine(&path, &[]).unwrap_err().to_string().replace(name, "NAME")
        };
        assert_eq!(told("there"), told("missing"));
    }

    #[test]
    fn only_the_systems_own_interpreters_are_executed() {
        let (_kept, foreign) = written("shell", b"", 0o755);
        std::fs::copy("/bin/sh", &foreign).unwrap();
        let foreign = foreign.canonicalize().unwrap();
        let path = foreign.display();
        for line in [
            format!("#!{path}\n"),
            format!("#!/usr/bin/../..{path}\n"),
            format!("#!/usr/bin/env {path}\n"),
            format!("#!/usr/bin/env -S {path} original --\n"),
            format!("#!/usr/bin/env -S../..{path} original\n"),
            format!("#!/usr/bin/env -S A=1 {path} original\n"),
            "#!/proc/self/exe\n".into(),
            "#!/proc/thread-self/root/bin/sh\n".into(),
        ] {
            let (_kept, script) = written("a", line.as_bytes(), 0o755);
            assert!(matches!(examine(&script, &[]), Err(StartProblem::NotTheSystems { .. })), "{line}");
        }
    }

    #[test]
    fn the_graders_own_file_is_nobodys_program_whatever_its_name() {
        let own = [Path::new("/bin/sh").canonicalize().unwrap()];
        let (_kept, script) = written("a", b"#!/bin/sh\n", 0o755);
        assert!(matches!(examine(&script, &own), Err(StartProblem::NotTheSystems { .. })));
        assert_eq!(examine(Path::new("/bin/sh"), &own), Err(StartProblem::GradersOwn));
    }
}

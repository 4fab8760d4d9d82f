//! Tests each layer once, in a child process that then ends, and reports what the kernel answered.

use std::{
    fs::{File, Permissions},
    io::{self, Write},
    os::{
        fd::{AsFd, AsRawFd, OwnedFd},
        unix::{fs::PermissionsExt, net::UnixStream},
    },
    path::Path,
    process::ExitCode,
    time::Duration,
};

use super::{
    file_rules, filter,
    group::Group,
    namespaces::{self, NamespaceSide},
    user_slot,
};
use crate::{
    sys::{self, Fork, Resource},
    wire::{self, Failure, Probe, RunOrder},
};

/// The first Landlock version that restricts signals and abstract sockets.
const SIGNAL_SCOPE_ABI: i32 = 6;

/// Tests the layers, and writes a [`Probe`] to standard output.
pub(super) fn main() -> ExitCode {
    match probe().and_then(|probe| wire::send(io::stdout(), &probe)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // The grader shows this message. If nobody reads it, writing fails, which does not matter.
            let _ = writeln!(io::stderr(), "{error}");
            ExitCode::from(1)
        }
    }
}

fn probe() -> io::Result<Probe> {
    let root = sys::user_id() == 0;
    let roots_group = !root && sys::group_id() == 0;
    let mut probe = Probe { root, roots_group, landlock_abi: sys::landlock_version(), ..Probe::default() };
    probe.reaper = failure_reason(sys::become_reaper());
    (probe.execution, probe.executes_from_memory) = try_execution();
    probe.namespaces = try_namespaces();
    match try_group() {
        Ok((controls, ends)) => {
            probe.group_controls = controls.into_iter().map(str::to_string).collect();
            probe.group_can_kill = ends;
        }
        Err(error) => probe.group = Some(error.to_string()),
    }
    let slot = if root { user_slot::claim_slot().map(Some) } else { Ok(None) };
    let user = slot.as_ref().ok().and_then(|slot| slot.as_ref()).map(|slot| slot.user);
    if let Err(error) = &slot {
        probe.own_user = Some(error.to_string());
    }
    let (parent, child) = UnixStream::pair()?;
    match sys::fork()? {
        Fork::Child => {
            drop(parent);
            let outcome = try_layers(probe, user);
            // The result is written as to a file, because the filter allows no socket calls. This fails if the parent
            // has ended, which does not matter.
            let _ = wire::send(std::fs::File::from(OwnedFd::from(child)), &outcome);
            sys::exit_now(0)
        }
        Fork::Parent(_) => {
            drop(child);
            let answer = wire::receive(&parent);
            while !matches!(sys::reap(), Err(_) | Ok(Some(_))) {
                std::thread::sleep(std::time::Duration::from_millis(1));
            }
            answer
        }
    }
}

/// Tries to execute an empty file in the temporary folder. If execution is allowed there, the kernel answers that the
/// file is not a program. If it is not allowed, the same is tried in memory. Returns the reason if neither works, and
/// whether programs must be executed in memory.
fn try_execution() -> (Option<String>, bool) {
    let executable = |error: io::Error| match error.raw_os_error() {
        Some(libc::ENOEXEC) => Ok(()),
        _ => Err(error),
    };
    // These files have no names, so a killed prober leaves nothing behind.
    let try_file = |file: File| -> io::Result<()> {
        file.set_permissions(Permissions::from_mode(0o555))?;
        // A file that is open for writing cannot be executed.
        let again = File::open(format!("/proc/self/fd/{}", file.as_raw_fd()))?;
        drop(file);
        executable(sys::execute_open(again.as_fd(), &[], &[]))
    };
    let in_folder = || tempfile::tempfile().and_then(try_file);
    let in_memory = || sys::memory_file().map(File::from).and_then(try_file);
    let folder = std::env::temp_dir();
    match in_folder() {
        Ok(()) => (None, false),
        Err(error) if error.raw_os_error() == Some(libc::EACCES) => {
            let message = in_memory().err().map(|memory| {
                format!("programs cannot be executed in {} ({error}) or in memory ({memory})", folder.display())
            });
            (message, true)
        }
        // A grading would report this problem of the folder itself.
        Err(error) => (Some(format!("{}: {error}", folder.display())), false),
    }
}

/// Tests whether a control group can kill a child. Returns the limits of the group, and whether it can kill.
fn try_group() -> io::Result<(Vec<&'static str>, bool)> {
    let group = Group::create(&RunOrder::default())?;
    let mut entry_files = group.open_entry_files()?;
    let (mut waits, entered) = io::pipe()?;
    let Fork::Parent(child) = sys::fork()? else {
        let result = entry_files.iter_mut().try_for_each(|entry_file| entry_file.write_all(b"0"));
        let result = result.map_err(|error| error.to_string());
        // If the prober has ended, sending fails, which does not matter. If the prober does not kill this process, the
        // process ends together with its parent, which is the prober.
        let _ = sys::die_with_parent().and_then(|()| wire::send(entered, &result.err()));
        loop {
            std::thread::sleep(Duration::from_secs(1));
        }
    };
    drop(entered);
    let refused: io::Result<Option<String>> = wire::receive(&mut waits);
    let killed = match refused {
        Ok(None) => group.kill(),
        Ok(Some(error)) => Err(io::Error::other(error)),
        Err(error) => Err(error),
    };
    if killed.is_err() || !group.can_kill() {
        sys::kill(child, libc::SIGKILL)?;
    }
    sys::wait_for_exit(child)?;
    killed.map(|()| (group.controls(), group.can_kill()))
}

/// Tests in a child process whether namespaces can be created. The child makes a folder visible that every Linux has.
fn try_namespaces() -> Option<String> {
    let order = RunOrder {
        program: wire::to_raw_bytes(Path::new("/bin/sh")),
        folder: wire::to_raw_bytes(Path::new("/usr")),
        ..RunOrder::default()
    };
    let probe = || -> io::Result<Option<String>> {
        let (reader, mut writer) = io::pipe()?;
        if let Fork::Parent(child) = sys::fork()? {
            drop(writer);
            let answer = wire::receive(reader);
            sys::wait_for_exit(child)?;
            return answer;
        }
        drop(reader);
        let report = match namespaces::enter(&order) {
            Ok(NamespaceSide::Inside) => Some(None),
            // The child has reported the reason itself, or has ended without a report.
            Ok(NamespaceSide::Outside(_)) => None,
            Err(Failure { stage, errno }) => {
                Some(Some(format!("could not {stage}: {}", io::Error::from_raw_os_error(errno))))
            }
        };
        // This fails if the prober has ended, which does not matter.
        let _ = report.map(|report: Option<String>| wire::send(&mut writer, &report));
        sys::exit_now(0)
    };
    probe().unwrap_or_else(|error| Some(error.to_string()))
}

/// Sets up one layer after the other, and records which of them work.
fn try_layers(mut probe: Probe, user: Option<u32>) -> Probe {
    probe.limits =
        failure_reason(sys::set_limit(Resource::Core, 0).and_then(|()| sys::set_limit(Resource::Fsize, 1 << 30)));
    if let Some(user) = user {
        probe.own_user = failure_reason(sys::switch_user(user));
    }
    probe.no_new_privileges = failure_reason(sys::forbid_new_privileges());
    probe.landlock = match probe.landlock_abi {
        0 => Some("the kernel has no Landlock, or it is switched off".into()),
        version => {
            failure_reason(file_rules::deny_all_ruleset(version >= SIGNAL_SCOPE_ABI).and_then(file_rules::enforce))
        }
    };
    let filters = |announce| {
        let own_process = Some(std::process::id() as i32);
        filter::compile_filters(filter::Purpose {
            tools: false,
            announce,
            own_process,
            entry_file: None,
            own_user: user.is_some(),
        })
    };
    let install = || -> io::Result<()> {
        // The filter that announces is the first, as in a real run. The test below only adds to it.
        for program in filters(false)? {
            sys::install_filter(&program, false)?;
        }
        Ok(())
    };
    let announce = || -> io::Result<()> {
        let listener = sys::install_filter(&filters(true)?[0], true)?;
        listener.map(|listener| listener.as_fd().try_clone_to_owned()).transpose().map(drop)
    };
    probe.notify = failure_reason(announce());
    probe.seccomp = failure_reason(install());
    probe
}

fn failure_reason(result: io::Result<()>) -> Option<String> {
    result.err().map(|error| error.to_string())
}

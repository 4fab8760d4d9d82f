//! The Landlock rules. They name the files that the program may access, and forbid signals to processes outside of the
//! run.
//!
//! Rules refer to open descriptors. Therefore they are created before the user changes, and enforced in the child after
//! it has become another user.

use std::{
    collections::BTreeSet,
    ffi::CStr,
    fs::File,
    io,
    os::{
        fd::{AsFd, BorrowedFd, OwnedFd},
        unix::fs::OpenOptionsExt,
    },
    path::{Path, PathBuf},
};

use landlock::{
    ABI, Access, AccessFs, AccessNet, BitFlags, CompatLevel, Compatible, PathBeneath, Ruleset, RulesetAttr,
    RulesetCreated, RulesetCreatedAttr, RulesetError, RulesetStatus, Scope,
};

use crate::{
    own_files::{self, AllowedPath},
    sys::{self, OFlags},
    wire::{self, RunOrder},
};

/// The newest version of the rules that is supported and tested. Older kernels enforce a part of it, which
/// [`LayerReport`] names.
///
/// [`LayerReport`]: crate::LayerReport
const NEWEST_ABI: ABI = ABI::V6;

/// The folders of shared libraries, of loaders, and of the libraries of interpreters.
pub(super) const LIBRARY_FOLDERS: [&str; 5] = ["/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib"];
/// The files from which loaders and runtimes read about the machine: its libraries, its processors, and its time zone.
const MACHINE_FILES: [&str; 6] = [
    "/etc/ld.so.cache",
    "/etc/ld.so.preload",
    "/etc/localtime",
    "/sys/devices/system/cpu/online",
    "/sys/devices/system/cpu/possible",
    "/sys/devices/system/cpu/present",
];
/// The files from which runtimes read about their own process.
const OWN_FILES: [&CStr; 9] =
    [c"auxv", c"cmdline", c"comm", c"environ", c"limits", c"maps", c"stat", c"statm", c"status"];
/// The folders in a process's own `/proc` entry that the process may list: `task`, in which some runtimes count their
/// threads, and `fd`.
const OWN_FOLDERS: [&CStr; 2] = [c"task", c"fd"];
/// Returns the parts of a process's own `/proc` entry that are visible if no file rules protect the entry.
pub(super) fn visible_entry_parts() -> impl Iterator<Item = &'static str> {
    OWN_FILES.into_iter().chain([c"fd"]).filter_map(|name| name.to_str().ok())
}

/// The device files that have no side effects.
pub(super) const DEVICE_FILES: [&str; 5] = ["/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom"];
/// The folders of the system's programs, for compilers and build tools.
const TOOL_FOLDERS: [&str; 4] = ["/usr", "/bin", "/lib", "/lib64"];
/// The files with settings that compilers and build tools read.
const SETTINGS_FILES: [&str; 8] = [
    "/proc/cpuinfo",
    "/etc/alternatives",
    "/etc/ld.so.conf",
    "/etc/ld.so.conf.d",
    "/etc/passwd",
    "/etc/group",
    "/etc/nsswitch.conf",
    "/etc/os-release",
];

/// Returns every path outside of the working folder that must be visible to the program of an order, except for
/// devices.
pub(super) fn list_visible_paths(order: &RunOrder) -> Vec<PathBuf> {
    let named_paths = order.readable.iter().chain(&order.executable).chain([&order.program]).map(wire::to_path);
    let tools = if order.allows_tools { [&TOOL_FOLDERS[..], &SETTINGS_FILES[..]] } else { [&[][..], &[]] };
    let fixed = LIBRARY_FOLDERS.into_iter().chain(MACHINE_FILES).chain(tools.concat()).map(PathBuf::from);
    fixed.chain(named_paths).collect()
}

/// The places outside of the working folder that the program may access. Each is open, and has the program's rights
/// there.
pub(super) struct AllowedPlaces(Vec<(OwnedFd, BitFlags<AccessFs>)>);

impl AllowedPlaces {
    /// Opens the places for an order. Paths that do not exist are left out.
    pub(super) fn for_order(order: &RunOrder) -> Self {
        let read = AccessFs::ReadFile | AccessFs::ReadDir;
        let execute = read | AccessFs::Execute;
        let own: Vec<PathBuf> = order.own_files.iter().map(wire::to_path).collect();
        let own = own.as_slice();
        let mut allowed = Self(Vec::new());
        for path in MACHINE_FILES {
            allowed.add(Path::new(path), read);
        }
        // The kernel must be able to execute the loader. The filter prevents all other executions.
        let libraries: BTreeSet<PathBuf> =
            LIBRARY_FOLDERS.iter().filter_map(|folder| Path::new(folder).canonicalize().ok()).collect();
        for folder in &libraries {
            allowed.add_around(folder, execute, own);
        }
        for path in DEVICE_FILES {
            // If /dev/zero is mapped and shared, bytes that are written to it would be memory that no counter shows.
            let access = if path == "/dev/zero" { BitFlags::EMPTY } else { AccessFs::WriteFile.into() };
            allowed.add(Path::new(path), access | AccessFs::ReadFile);
        }
        for raw in &order.readable {
            allowed.add_around(&wire::to_path(raw), read, own);
        }
        for raw in order.executable.iter().chain([&order.program]) {
            allowed.add(&wire::to_path(raw), execute);
        }
        if order.allows_tools {
            for path in TOOL_FOLDERS {
                allowed.add_around(Path::new(path), execute, own);
            }
            for path in SETTINGS_FILES {
                allowed.add(Path::new(path), read);
            }
        }
        allowed
    }

    /// Moves the files to descriptor numbers that no program may use, so that they do not count toward the limit of a
    /// child. Returns `None` if this process may not use that many numbers.
    pub(super) fn with_high_numbers(self) -> Option<Self> {
        const FIRST_DESCRIPTOR: u32 = 800;
        let moved = self
            .0
            .into_iter()
            .map(|(opened, access)| Some((sys::duplicate_from(opened.as_fd(), FIRST_DESCRIPTOR).ok()?, access)));
        moved.collect::<Option<_>>().map(Self)
    }

    /// Adds a place, with the part of the access that applies to it.
    fn add(&mut self, path: &Path, access: BitFlags<AccessFs>) {
        let Ok(opened) = open_path(path) else { return };
        let is_folder = opened.metadata().is_ok_and(|metadata| metadata.is_dir());
        let access = if is_folder { access } else { access & AccessFs::from_file(NEWEST_ABI) };
        self.0.push((opened.into(), access));
    }

    /// Adds a place as [`AllowedPlaces::add`] does, but leaves out the grader's own files below the path.
    fn add_around(&mut self, path: &Path, access: BitFlags<AccessFs>, own: &[PathBuf]) {
        for allowed in own_files::allow_all_except(path, own) {
            match allowed {
                AllowedPath::Whole(path) => self.add(&path, access),
                AllowedPath::Listing(path) => self.add(&path, access & AccessFs::ReadDir),
            }
        }
    }
}

/// Opens the file at a path only as a reference (`O_PATH`).
fn open_path(path: &Path) -> io::Result<File> {
    File::options().read(true).custom_flags(libc::O_PATH).open(path)
}

/// Prepares the rules for an order. Its working folder is open as `folder`.
pub(super) fn build_ruleset(
    order: &RunOrder,
    places: &AllowedPlaces,
    folder: BorrowedFd<'_>,
) -> io::Result<RulesetCreated> {
    let version = to_abi(order.layers.landlock_version);
    let mut ruleset = begin_ruleset(order.layers.scopes, version)?;
    for (opened, access) in &places.0 {
        ruleset = ruleset.add_rule(PathBeneath::new(opened.as_fd(), *access)).map_err(from_ruleset_error)?;
    }
    let inside = folder_rights(order.allows_tools) & AccessFs::from_all(version);
    ruleset.add_rule(PathBeneath::new(folder, inside)).map_err(from_ruleset_error)
}

/// Adds the files in the process's own `/proc` entry that it may read. They are added one by one, because the entry
/// also shows sockets, mounts and groups of the host, and which pages of a file are in memory. Only the child itself
/// can do this.
pub(super) fn add_own_entry(mut ruleset: RulesetCreated) -> io::Result<RulesetCreated> {
    let Ok(own) = open_path(Path::new("/proc/self")) else { return Ok(ruleset) };
    let files = OWN_FILES.map(|name| (name, AccessFs::ReadFile));
    for (name, access) in files.into_iter().chain(OWN_FOLDERS.map(|name| (name, AccessFs::ReadDir))) {
        if let Ok(opened) = sys::open_beneath(own.as_fd(), name, OFlags::PATH) {
            ruleset = ruleset.add_rule(PathBeneath::new(opened.as_fd(), access)).map_err(from_ruleset_error)?;
        }
    }
    Ok(ruleset)
}

/// Enforces the rules for this process and its descendants.
///
/// # Errors
///
/// Fails if the kernel rejects the rules, or if it accepts them but enforces none of them.
pub(super) fn enforce(ruleset: RulesetCreated) -> io::Result<()> {
    let status = ruleset.restrict_self().map_err(from_ruleset_error)?;
    if status.ruleset == RulesetStatus::NotEnforced {
        return Err(io::Error::from_raw_os_error(libc::EOPNOTSUPP));
    }
    Ok(())
}

/// Returns rules that allow nothing, for the probe.
pub(super) fn deny_all_ruleset(scopes: bool) -> io::Result<RulesetCreated> {
    begin_ruleset(scopes, NEWEST_ABI)
}

/// Returns the version of the rules for a kernel with this version of Landlock, for tests; 0 means the newest one.
fn to_abi(number: u8) -> ABI {
    [NEWEST_ABI, ABI::V1, ABI::V2, ABI::V3, ABI::V4, ABI::V5].get(usize::from(number)).copied().unwrap_or(NEWEST_ABI)
}

/// Returns rules that deny everything that the running kernel can deny, as long as nothing is allowed.
fn begin_ruleset(scopes: bool, version: ABI) -> io::Result<RulesetCreated> {
    let mut ruleset = Ruleset::default()
        .set_compatibility(CompatLevel::BestEffort)
        .handle_access(AccessFs::from_all(version))
        .map_err(from_ruleset_error)?;
    let network = AccessNet::from_all(version);
    if !network.is_empty() {
        ruleset = ruleset.handle_access(network).map_err(from_ruleset_error)?;
    }
    if scopes {
        ruleset = ruleset.scope(Scope::from_all(NEWEST_ABI)).map_err(from_ruleset_error)?;
    }
    ruleset.create().map_err(from_ruleset_error)
}

/// Returns the rights in the program's working folder. They include creating, changing and removing files and folders.
/// Only build tools may also link to other places, create special files, and execute files.
fn folder_rights(tools: bool) -> BitFlags<AccessFs> {
    let submission = AccessFs::ReadFile
        | AccessFs::ReadDir
        | AccessFs::WriteFile
        | AccessFs::Truncate
        | AccessFs::MakeReg
        | AccessFs::MakeDir
        | AccessFs::RemoveFile
        | AccessFs::RemoveDir;
    if tools { submission | AccessFs::Execute | AccessFs::MakeSym | AccessFs::Refer } else { submission }
}

fn from_ruleset_error(error: RulesetError) -> io::Error {
    let errno = io::Error::last_os_error();
    if errno.raw_os_error().is_some_and(|number| number != 0) { errno } else { io::Error::other(error) }
}

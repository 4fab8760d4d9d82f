//! The layers of the sandbox, and which of them work on this host.
//!
//! This module contains only data, which the command `doctor` and reports print. A layer counts as active only if a
//! probe process could set it up on this host.

use std::sync::Arc;

use super::wire::{ActiveLayers, Probe};

/// Declares the layers. Each row has a layer, and the layer's name in reports.
macro_rules! layers {
    ($($(#[$about:meta])+ $layer:ident $name:literal;)+) => {
        /// A layer of the sandbox.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Layer { $($(#[$about])+ $layer,)+ }

        impl Layer {
            /// All layers, in the order of a report.
            pub const ALL: [Self; [$(Self::$layer),+].len()] = [$(Self::$layer),+];

            /// Returns the layer's name in reports.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$layer => $name,)+ }
            }
        }
    };
}

layers! {
    /// Executing a program never gives privileges.
    NoNewPrivileges "no new privileges";
    /// Resource limits, clocks and counters limit what a program uses.
    Limits "resource limits";
    /// The supervisor adopts orphans, so that no process outlives a run.
    Reaper "reaper of orphans";
    /// Copies of programs can be executed. This is not a protection, but grading is impossible without it.
    Execution "executable copies";
    /// Only system calls in a list are allowed (seccomp).
    CallFilter "system call filter";
    /// The outcome names the forbidden call that a program made.
    NamedCalls "named violations";
    /// Landlock's rules restrict access to files.
    FileRules "file rules (Landlock)";
    /// Landlock's rules restrict signals and abstract sockets.
    Scopes "signal scope (Landlock)";
    /// Every running program has its own user, which requires root.
    OwnUser "a user per program";
    /// Namespaces hide other processes, the network, and most files.
    Namespaces "namespaces";
    /// Each run has a control group. In it, the kernel counts what the run uses, and a single command kills all
    /// processes.
    ControlGroup "control group";
}

/// The first version of Landlock that restricts signals.
const SIGNAL_SCOPE_ABI: u8 = 6;

/// Whether a layer works on this host, and the reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LayerReport {
    /// The layer that the report is about.
    pub layer: Layer,
    /// Whether the layer works on this host.
    pub active: bool,
    /// Whether grading on this host requires the layer.
    pub required: bool,
    /// The effect of the layer, or the reason why it does not work.
    pub detail: String,
    /// The component to install or enable so that the layer works; `None` if it works, or if there is no remedy.
    pub remedy: Option<&'static str>,
}

/// Returns the reports on all layers, from the results of a probe.
pub(super) fn reports(probe: &Probe) -> Vec<LayerReport> {
    let mut reports = Vec::from(process_layers(probe));
    reports.extend(call_and_file_layers(probe));
    reports.extend(surrounding_layers(probe));
    reports
}

/// Returns the report on a layer. If there is no problem, it contains what the layer does; otherwise the problem and
/// its remedy.
fn new_report(
    layer: Layer,
    problem: Option<String>,
    success_detail: &str,
    required: bool,
    remedy: &'static str,
) -> LayerReport {
    LayerReport {
        layer,
        active: problem.is_none(),
        required,
        remedy: problem.is_some().then_some(remedy),
        detail: problem.unwrap_or_else(|| success_detail.to_string()),
    }
}

/// Returns whether every running program has its own user.
fn has_own_user(probe: &Probe) -> bool {
    probe.root && probe.own_user.is_none()
}

/// Returns the reports on the layers that a process sets up around itself, and on the execution of copies.
fn process_layers(probe: &Probe) -> [LayerReport; 4] {
    [
        new_report(
            Layer::NoNewPrivileges,
            probe.no_new_privileges.clone(),
            "executing a program gives no privileges",
            true,
            "use Linux 3.5 or newer",
        ),
        new_report(
            Layer::Limits,
            probe.limits.clone(),
            "processor and clock time, memory, output, folder, processes",
            true,
            "allow setrlimit in the container's profile",
        ),
        new_report(
            Layer::Reaper,
            probe.reaper.clone(),
            "no process outlives a run",
            true,
            "allow prctl in the container's profile",
        ),
        new_report(
            Layer::Execution,
            probe.execution.clone(),
            if probe.executes_from_memory {
                "in memory, because the temporary folder is mounted noexec; build steps cannot run compiled files"
            } else {
                "programs run from copies in the temporary folder"
            },
            true,
            "set TMPDIR to a folder in which programs may be executed",
        ),
    ]
}

/// Returns the reports on the layers that restrict system calls, files and signals.
fn call_and_file_layers(probe: &Probe) -> [LayerReport; 4] {
    let (user, hidden) = (has_own_user(probe), probe.namespaces.is_none());
    let scopes = match (&probe.landlock, probe.landlock_abi) {
        (None, 6..) => None,
        (None, abi) => Some(format!("this host has Landlock version {abi}; signals are restricted from version 6 on")),
        (Some(_), _) => Some("this host has no Landlock".into()),
    };
    [
        new_report(
            Layer::CallFilter,
            probe.seccomp.clone(),
            "an allow list; all other calls are denied",
            true,
            "use a kernel with CONFIG_SECCOMP_FILTER on x86_64 or aarch64, and allow seccomp in the container's \
            profile",
        ),
        new_report(
            Layer::NamedCalls,
            probe.notify.clone(),
            "a violation is reported with the call's name",
            false,
            "use Linux 5.5 or newer; until then a violation is reported without its name, build steps cannot lock \
                files, \
             and those of an ordinary user cannot set permission bits",
        ),
        new_report(
            Layer::FileRules,
            probe.landlock.clone(),
            &format!("version {}", probe.landlock_abi),
            !(user && hidden),
            if user && hidden {
                "use Linux 5.13 or newer with landlock among the kernel's lsm=; until then namespaces alone hide the \
                 host's files"
            } else if user {
                "use Linux 5.13 or newer with landlock among the kernel's lsm=, or let the grader make namespaces: \
                 without either, programs read whatever every user can read, this grader included"
            } else {
                "use Linux 5.13 or newer with landlock among the kernel's lsm=, or grade as root"
            },
        ),
        new_report(
            Layer::Scopes,
            scopes,
            "programs can signal only themselves",
            false,
            "use Linux 6.12 or newer; until then the system call filter alone confines signals",
        ),
    ]
}

/// Returns the reports on the layers that only some hosts have: users, namespaces and control groups.
fn surrounding_layers(probe: &Probe) -> [LayerReport; 3] {
    let own_user = match (probe.root, probe.roots_group) {
        (true, _) => probe.own_user.clone(),
        (false, true) => Some("the grader and the programs are not root, but are in root's group".into()),
        (false, false) => Some("the grader is not root".into()),
    };
    [
        LayerReport {
            layer: Layer::OwnUser,
            active: has_own_user(probe),
            required: probe.root,
            detail: own_user.clone().unwrap_or_else(|| "every running program has its own user".into()),
            remedy: match (probe.root, own_user) {
                (true, Some(_)) => {
                    Some("grade as an ordinary user, or let root change its user (CAP_SETUID, CAP_SETGID, CAP_CHOWN)")
                }
                _ if probe.roots_group => Some("name a group, too, for example by --user 1000:1000 in a container"),
                _ => None,
            },
        },
        new_report(
            Layer::Namespaces,
            probe.namespaces.clone(),
            "a run sees only its own processes and files, and no network",
            false,
            "use Linux 5.12 or newer and let the grader make namespaces: in a container by its profile, for an \
             ordinary user by the kernel's settings (kernel.apparmor_restrict_unprivileged_userns=0 on Ubuntu)",
        ),
        new_report(
            Layer::ControlGroup,
            probe.group.clone(),
            &match (&probe.group_controls[..], probe.group_can_kill) {
                ([], _) => "a run ends as a whole; no controller for memory or processes is available".to_string(),
                (controls, true) => format!("a run ends as a whole; the kernel limits {}", controls.join(", ")),
                (controls, false) => format!("the kernel limits {}", controls.join(", ")),
            },
            false,
            "use Linux 5.14 or newer with version 2 (or version 1, for the limits), and start the grader in a group of \
             its own, for example by systemd-run --user --scope -p Delegate=yes",
        ),
    ]
}

/// Returns the reports for the case that `layer` is missing, and all layers that depend on it.
pub(super) fn without_layer(reports: &[LayerReport], layer: Layer) -> Vec<LayerReport> {
    let mut reports = reports.to_vec();
    for report in &mut reports {
        if report.layer == layer || (layer == Layer::FileRules && report.layer == Layer::Scopes) {
            report.active = false;
            report.detail = "switched off on request".into();
            report.remedy = None;
        }
    }
    // Without file rules, root may grade only if the files of the host are hidden.
    if [Layer::FileRules, Layer::Namespaces].contains(&layer) {
        let hidden = is_active(&reports, Layer::OwnUser) && is_active(&reports, Layer::Namespaces);
        for report in reports.iter_mut().filter(|report| report.layer == Layer::FileRules) {
            report.required = !hidden;
        }
    }
    reports
}

/// Returns the reports for the case that the kernel has this older version of Landlock.
pub(super) fn with_landlock(reports: &[LayerReport], version: u8) -> Vec<LayerReport> {
    let mut reports = if version < SIGNAL_SCOPE_ABI { without_layer(reports, Layer::Scopes) } else { reports.to_vec() };
    for report in reports.iter_mut().filter(|report| report.layer == Layer::FileRules && report.active) {
        report.detail = format!("version {version} on request");
    }
    reports
}

/// Returns the layers that the supervisor must set up, according to the reports. If required layers are missing, the
/// error names them.
pub(super) fn select_layers(reports: &[LayerReport]) -> Result<ActiveLayers, String> {
    let missing = describe_missing(reports);
    if missing.is_empty() { Ok(active_layers(reports)) } else { Err(missing.join("\n")) }
}

/// Returns the layers that work, even if required ones are missing. If root would have to run programs as root, the
/// error names the missing layers.
pub(super) fn available_layers(reports: &[LayerReport]) -> Result<ActiveLayers, String> {
    match reports.iter().find(|report| report.layer == Layer::OwnUser && report.required && !report.active) {
        Some(report) => Err(format_report(report)),
        None => Ok(active_layers(reports)),
    }
}

/// Returns one line for each required layer that does not work.
pub(super) fn describe_missing(reports: &[LayerReport]) -> Vec<String> {
    reports.iter().filter(|report| report.required && !report.active).map(format_report).collect()
}

fn format_report(report: &LayerReport) -> String {
    let remedy = report.remedy.map(|remedy| format!("; {remedy}")).unwrap_or_default();
    format!("{}: {}{remedy}", report.layer.name(), report.detail)
}

/// Returns whether a layer works.
pub(super) fn is_active(reports: &[LayerReport], layer: Layer) -> bool {
    reports.iter().any(|report| report.layer == layer && report.active)
}

fn active_layers(reports: &[LayerReport]) -> ActiveLayers {
    let active = |layer| is_active(reports, layer);
    ActiveLayers {
        landlock: active(Layer::FileRules),
        landlock_version: 0,
        scopes: active(Layer::Scopes),
        seccomp: active(Layer::CallFilter),
        // The listener that names calls is a part of the filter.
        notify: active(Layer::NamedCalls) && active(Layer::CallFilter),
        own_user: active(Layer::OwnUser),
        namespaces: active(Layer::Namespaces),
        group: active(Layer::ControlGroup),
    }
}

/// Returns reports for a run that was never started. All layers are inactive in them.
pub(super) fn no_layers() -> Arc<[LayerReport]> {
    let inactive_report = |layer| LayerReport {
        layer,
        active: matches!(layer, Layer::Limits | Layer::Reaper),
        required: false,
        detail: match layer {
            Layer::Limits => "processor and clock time, memory, output and folder only".into(),
            Layer::Reaper => "no process outlives a run".into(),
            _ => "switched off on request".to_string(),
        },
        remedy: None,
    };
    Layer::ALL.map(inactive_report).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn healthy(root: bool) -> Probe {
        Probe { root, landlock_abi: 7, ..Probe::default() }
    }

    #[test]
    fn a_healthy_host_has_every_wall_that_it_can_have() {
        let all = ActiveLayers {
            landlock: true,
            landlock_version: 0,
            scopes: true,
            seccomp: true,
            notify: true,
            own_user: true,
            namespaces: true,
            group: true,
        };
        assert_eq!(select_layers(&reports(&healthy(true))), Ok(all));
        assert_eq!(select_layers(&reports(&healthy(false))), Ok(ActiveLayers { own_user: false, ..all }));
        assert_eq!(reports(&healthy(true)).iter().map(|report| report.layer).collect::<Vec<_>>(), Layer::ALL);
    }

    #[test]
    fn without_landlock_only_root_with_namespaces_may_grade() {
        let missing_layers = |root| Probe { landlock_abi: 0, landlock: Some("none".into()), ..healthy(root) };
        assert!(!select_layers(&reports(&missing_layers(true))).unwrap().landlock);
        let bare = Probe { namespaces: Some("not permitted".into()), ..missing_layers(true) };
        let missing = select_layers(&reports(&bare)).unwrap_err();
        assert!(missing.contains("file rules") && missing.contains("this grader included"), "{missing}");
        let bare = without_layer(&without_layer(&reports(&healthy(true)), Layer::Namespaces), Layer::FileRules);
        assert!(select_layers(&bare).is_err());
        let missing = select_layers(&reports(&missing_layers(false))).unwrap_err();
        assert!(missing.contains("file rules") && missing.contains("5.13"), "{missing}");
    }

    #[test]
    fn root_that_cannot_change_its_user_is_rejected() {
        let bound = Probe { own_user: Some("invalid argument".into()), ..healthy(true) };
        assert!(select_layers(&reports(&bound)).unwrap_err().contains("ordinary user"));
    }

    #[test]
    fn without_the_required_set_whatever_holds_stays_up() {
        let missing_layers = Probe { landlock_abi: 0, landlock: Some("none".into()), ..healthy(false) };
        let walls = available_layers(&reports(&missing_layers)).unwrap();
        assert!(!walls.landlock && walls.seccomp && walls.notify);
        assert_eq!(describe_missing(&reports(&missing_layers)).len(), 1);
        assert_eq!(available_layers(&reports(&healthy(true))), super::select_layers(&reports(&healthy(true))));
        let filterless = Probe { seccomp: Some("none".into()), ..healthy(true) };
        let walls = available_layers(&reports(&filterless)).unwrap();
        assert!(walls.own_user && walls.landlock && !walls.seccomp && !walls.notify);
    }

    #[test]
    fn root_never_runs_programs_as_itself() {
        let bound = Probe { own_user: Some("not permitted".into()), ..healthy(true) };
        assert!(available_layers(&reports(&bound)).unwrap_err().contains("a user per program"));
    }

    #[test]
    fn a_required_wall_cannot_be_taken_away() {
        let healthy = |root| reports(&healthy(root));
        assert!(select_layers(&without_layer(&healthy(true), Layer::CallFilter)).is_err());
        assert!(select_layers(&without_layer(&healthy(false), Layer::FileRules)).is_err());
        let walls = select_layers(&without_layer(&healthy(true), Layer::FileRules)).unwrap();
        assert!(!walls.landlock && !walls.scopes && walls.seccomp);
    }

    #[test]
    fn an_old_landlock_confines_files_and_not_signals() {
        let old = Probe { landlock_abi: 2, ..healthy(false) };
        let walls = select_layers(&reports(&old)).unwrap();
        assert!(walls.landlock && !walls.scopes);
    }
}

//! Processes that end together: programs end with their supervisor, and supervisors with their grader.
use super::*;

/// Returns the process that runs exactly these words, and its parent.
pub fn process(words: &[&str]) -> Option<(i32, i32)> {
    let line: Vec<u8> = words.iter().flat_map(|word| [word.as_bytes(), b"\0"].concat()).collect();
    let pids =
        std::fs::read_dir("/proc").unwrap().flatten().filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    let pid: i32 =
        { pids }.find(|pid| std::fs::read(format!("/proc/{pid}/cmdline")).is_ok_and(|found| found == line))?;
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
    let parent = status.lines().find_map(|line| line.strip_prefix("PPid:"))?.trim().parse().ok()?;
    Some((pid, parent))
}

/// Repeats a check until there is an answer. A test without an answer fails after half a minute.
pub fn eventually<T>(mut look: impl FnMut() -> Option<T>) -> T {
    let start = std::time::Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(start.elapsed() < Duration::from_secs(30), "it did not happen in time");
        std::thread::yield_now();
    }
}

/// Returns whether a process runs. A dead process has no program, even if its parent has not reaped it yet.
fn runs(pid: i32) -> bool {
    Path::new(&format!("/proc/{pid}/exe")).exists()
}

/// Kills a process, and waits until it is dead, because other processes may use it until then.
pub fn kill(pid: i32) {
    assert!(std::process::Command::new("/bin/kill").args(["-KILL", &pid.to_string()]).status().unwrap().success());
    eventually(|| (!runs(pid)).then_some(()));
}

#[test]
fn a_program_dies_with_its_supervisor_and_the_loss_is_our_fault() {
    let Some(bench) = Bench::new() else { return };
    let words = ["/bin/sleep", "98761"];
    let running = bench.backend.start(&bench.job(words[0], &words[1..])).unwrap();
    let (_, supervisor) = eventually(|| process(&words));
    kill(supervisor);
    let error = running.wait().unwrap_err();
    assert!(error.to_string().contains("ended unexpectedly"), "{error}");
    eventually(|| process(&words).is_none().then_some(()));
}

#[test]
fn a_program_dies_with_its_grader() {
    const ROLE: &str = "FOSSSIM_TEST_GRADER";
    let words = ["/bin/sleep", "98762"];
    let Some(bench) = Bench::new() else { return };
    if std::env::var_os(ROLE).is_some() {
        // This grader is going to be killed. It would otherwise wait for its time limit.
        let _ = bench.backend.start(&bench.job(words[0], &words[1..])).unwrap().wait();
        return;
    }
    let mut grader = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "sandbox::deaths::a_program_dies_with_its_grader"])
        .env(ROLE, "1")
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let (_, supervisor) = eventually(|| process(&words));
    grader.kill().unwrap();
    grader.wait().unwrap();
    eventually(|| process(&words).is_none().then_some(()));
    eventually(|| (!runs(supervisor)).then_some(()));
}

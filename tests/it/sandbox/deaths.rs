//! Deaths together: programs die with their supervisor, supervisors with their grader.
use super::*;

/// The process that runs exactly these words, and its parent.
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

/// Looks again and again until there is an answer; a test that gets none fails after half a minute.
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

/// Whether a process runs: one that is dead has no program, though its parent may not have asked for its end yet.
fn runs(pid: i32) -> bool {
    Path::new(&format!("/proc/{pid}/exe")).exists()
}

/// Kills a process, and waits until it is dead: until then others may go on with it.
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
        // The grader that is going to be killed; it would wait for its wall limit.
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

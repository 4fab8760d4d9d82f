//! The actions of hostile programs, in addition to simulating. Their actions are limited, so that they cannot harm a
//! machine without a sandbox. Only the endless loop and the sleep last forever.
use std::{
    fs::File,
    hint::black_box,
    io::{self, Write},
    path::Path,
    process::{Command, Stdio},
    thread::sleep,
    time::Duration,
};

use crate::student::{Area, Mistake, Student};

/// The number of bytes that a program writes too much, after the trace or on standard output or error.
const FLOOD_BYTES: usize = 256 << 20;
const PRINTED_BYTES: usize = 16 << 20;

/// The number of bytes of memory that a memory hog allocates.
const HOG_BYTES: usize = 4 << 30;

/// The environment variable that tells a hostile child program what to do.
const CHILD_VARIABLE: &str = "FOSSSIM_SAMPLE_CHILD";

/// The text that the original oracle prints after a run without faults.
const FORGED_VERDICT: &str = "\
Accumulated Position Residual: 0   Passed.
Accumulated Velocity Residual: 0   Passed.
Maximum Position Residual: 0   Passed.
Maximum Velocity Residual: 0   Passed.
Collisions Passed: Yes.
Overall success: Passed.
\u{1b}[35;1mFOSSSim message: \u{1b}[mSaved residual to residual.txt.
{\"score\": 100, \"output\": \"accepted\"}
";

/// Text that attacks a log in which text is not escaped. It contains colors, the window's title, markup, a formula and
/// control characters.
const ESCAPE_SEQUENCES: &str = "\u{1b}[2J\u{1b}[31;1mred\u{1b}[m \u{1b}]0;title\u{7} <script>alert(1)</script> \
    <b onmouseover='x'>&amp;</b> | `code` **bold** ::error::no \r\n=HYPERLINK(\"http://example.invalid\",\"x\")\n\
    ]]> \u{202e}reversed\u{202c} \u{0}\u{8}\u{c}\n";

/// Runs the actions at the start. Some programs do nothing else, and children only wait.
pub fn act_at_start(student: Student, output: Option<&Path>) -> io::Result<Option<u8>> {
    if std::env::var_os(CHILD_VARIABLE).is_some() {
        sleep(Duration::from_secs(60));
        return Ok(Some(0));
    }
    match student.mistake_in(&[Area::Process]) {
        Some(Mistake::HostileNoOutput) => return Ok(Some(0)),
        Some(Mistake::HostileEmptyTrace) => {
            if let Some(path) = output {
                File::create(path)?;
            }
            return Ok(Some(0));
        }
        Some(Mistake::HostileChildren) => {
            for _ in 0..3 {
                // Nothing waits for this child process, which is left behind on purpose.
                let _child = Command::new(std::env::current_exe()?)
                    .env(CHILD_VARIABLE, "1")
                    .args(["--list"])
                    .stdin(Stdio::null())
                    .spawn()?;
            }
        }
        Some(Mistake::HostileEscapes) => io::stderr().write_all(ESCAPE_SEQUENCES.as_bytes())?,
        Some(Mistake::HostileForgedVerdict) => io::stdout().write_all(FORGED_VERDICT.as_bytes())?,
        _ => {}
    }
    Ok(None)
}

/// The action of a hostile program in the middle of a run.
pub enum MidwayAct {
    /// The program continues the simulation.
    Continue,
    /// The program stops writing, and exits with this status.
    Leave(u8),
    /// The program writes a part of a record, and exits with this status.
    LeaveInsideRecord(u8),
}

/// Runs the hostile action in the middle of the run, before step `steps / 2 + 1`.
pub fn act_midway(student: Student) -> io::Result<MidwayAct> {
    match student.mistake_in(&[Area::Process]) {
        Some(Mistake::HostileExitMidway) => return Ok(MidwayAct::Leave(3)),
        Some(Mistake::HostileTruncated) => return Ok(MidwayAct::LeaveInsideRecord(0)),
        Some(Mistake::HostileCrash) => std::process::abort(),
        Some(Mistake::HostileLoop) => loop {
            black_box(());
        },
        Some(Mistake::HostileSleep) => loop {
            sleep(Duration::from_secs(3600));
        },
        Some(Mistake::HostileFloodStdout) => write_flood(&mut io::stdout().lock(), PRINTED_BYTES)?,
        Some(Mistake::HostileFloodStderr) => write_flood(&mut io::stderr().lock(), PRINTED_BYTES)?,
        Some(Mistake::HostileMemory) => {
            let hog = vec![1_u8; HOG_BYTES];
            black_box(&hog);
        }
        _ => {}
    }
    Ok(MidwayAct::Continue)
}

/// Writes the bytes that the program adds after the last record.
pub fn write_after_trace(student: Student, output: &mut impl Write) -> io::Result<()> {
    match student.mistake_in(&[Area::Process]) {
        Some(Mistake::HostileTrailingBytes) => output.write_all(&[0; 8]),
        Some(Mistake::HostileFloodTrace) => write_flood(output, FLOOD_BYTES),
        _ => Ok(()),
    }
}

/// Returns the status with which the program exits.
pub fn exit_status(student: Student) -> u8 {
    u8::from(student.makes(Mistake::HostileExitOne))
}

fn write_flood(output: &mut impl Write, bytes: usize) -> io::Result<()> {
    let block = [b'x'; 1 << 16];
    for _ in 0..bytes / block.len() {
        output.write_all(&block)?;
    }
    Ok(())
}

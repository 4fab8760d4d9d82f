//! Makes MP4 films with an external program: pictures are sent to ffmpeg through a pipe.
//!
//! ffmpeg writes a temporary file, so that the output appears only when it is complete. If ffmpeg reads nothing for a
//! minute, it is killed. Only one of its arguments contains a name that the user chose: the output, and it begins with
//! `file:`.
use crate::{
    cli::output::Output,
    render::{Size, film::Rate},
};
use anyhow::{Context, Result, bail};
use std::{
    ffi::{OsStr, OsString},
    io::{self, Read, Write},
    process::{Child, ChildStdin, Command, Stdio},
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

/// The name of the program.
const FFMPEG: &str = "ffmpeg";

/// The encoders for MP4 and their arguments. The best encoder is the first.
const ENCODERS: [(&str, &[&str]); 4] = [
    ("libx264", &["-preset", "medium", "-crf", "20"]),
    ("libopenh264", &["-b:v", "4M"]),
    ("libvpx-vp9", &["-crf", "30", "-b:v", "0"]),
    ("mpeg4", &["-q:v", "3"]),
];

/// The time after which a program that reads nothing is killed.
const STUCK_TIME: Duration = Duration::from_secs(60);

/// The maximum number of bytes of the program's messages that are kept.
const MAX_MESSAGE_BYTES: usize = 4096;

/// A film that is being encoded.
pub(super) struct Ffmpeg {
    child: Arc<Mutex<Child>>,
    pipe: Option<ChildStdin>,
    messages: Option<JoinHandle<String>>,
    encoder_watch: Arc<EncoderWatch>,
    /// The temporary file, which is renamed at the end.
    output: Option<Output>,
}

/// The state that the thread that watches the encoder shares with the others.
#[derive(Default)]
struct EncoderWatch {
    pictures: AtomicU64,
    is_finished: AtomicBool,
    is_given_up: AtomicBool,
}

impl Ffmpeg {
    /// Returns an encoder of ffmpeg for MP4, and its arguments.
    ///
    /// # Errors
    ///
    /// Fails if ffmpeg or an encoder is missing. The error says what to install.
    pub(super) fn find() -> Result<(&'static str, &'static [&'static str])> {
        let run = Command::new(FFMPEG)
            .args(["-hide_banner", "-loglevel", "error", "-encoders"])
            .stdin(Stdio::null())
            .stderr(Stdio::null())
            .output();
        let list = match run {
            Ok(run) => String::from_utf8_lossy(&run.stdout).into_owned(),
            Err(error) if error.kind() == io::ErrorKind::NotFound => bail!(
                "an MP4 needs ffmpeg, which is not installed; install it (on Debian and Ubuntu: apt install ffmpeg), \
                 or choose an output .gif, which needs no other program"
            ),
            Err(error) => return Err(error).context("ffmpeg can't be started"),
        };
        // A line of this list looks like ` V....D libx264 description`.
        let is_listed = |name: &str| list.lines().any(|line| line.split_whitespace().nth(1) == Some(name));
        let found = ENCODERS.into_iter().find(|(name, _)| is_listed(name));
        found.context(
            "this ffmpeg has no encoder for MP4 (libx264, libopenh264, libvpx-vp9, mpeg4); name the output \
            .gif",
        )
    }

    /// Starts the program ffmpeg.
    ///
    /// # Errors
    ///
    /// Fails if ffmpeg can't be started, or the output is not a file.
    pub(super) fn start(size: Size, rate: Rate, output: Output) -> Result<Self> {
        let (encoder, options) = Self::find()?;
        let Some(path) = output.temporary_path() else { bail!("an MP4 needs an output file; name one") };
        let mut file = OsString::from("file:");
        file.push(&path);
        let size = size.to_string();
        let rate = rate.per_second().to_string();
        let mut child = Command::new(FFMPEG)
            .args(["-hide_banner", "-loglevel", "error", "-nostdin", "-y"])
            .args(["-f", "rawvideo", "-pix_fmt", "rgba", "-s", &size, "-r", &rate, "-i", "pipe:0"])
            .args(["-an", "-c:v", encoder])
            .args(options)
            .args(["-pix_fmt", "yuv420p", "-threads", "1", "-movflags", "+faststart"])
            .args(["-fflags", "+bitexact", "-flags:v", "+bitexact", "-f", "mp4"].map(OsStr::new))
            .arg(file)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .context("ffmpeg can't be started")?;
        let (pipe, errors) = (child.stdin.take(), child.stderr.take());
        let messages = errors.map(|mut errors| {
            thread::spawn(move || {
                let mut text = Vec::new();
                let _ = errors.by_ref().take(MAX_MESSAGE_BYTES as u64).read_to_end(&mut text);
                // The rest is read as well, so that the program is not blocked.
                let _ = io::copy(&mut errors, &mut io::sink());
                String::from_utf8_lossy(&text).trim().to_owned()
            })
        });
        let watch = Arc::new(EncoderWatch::default());
        let child = Arc::new(Mutex::new(child));
        kill_when_stuck(&child, &watch);
        Ok(Self { child, pipe, messages, encoder_watch: watch, output: Some(output) })
    }

    /// Sends a picture to the program.
    ///
    /// # Errors
    ///
    /// Fails if the program has ended.
    pub(super) fn write_picture(&mut self, rgba: &[u8]) -> Result<()> {
        let pipe = self.pipe.as_mut().context("ffmpeg accepts no pictures")?;
        pipe.write_all(rgba).context("ffmpeg accepts no more pictures")?;
        self.encoder_watch.pictures.fetch_add(1, Ordering::Relaxed);
        Ok(())
    }

    /// Waits until the film is complete, and gives it its final name. `drawn` is the result of drawing the pictures.
    ///
    /// # Errors
    ///
    /// Fails if drawing or the program failed. The error contains the program's output, and there is no film.
    pub(super) fn finish(mut self, drawn: Result<()>) -> Result<()> {
        drop(self.pipe.take());
        self.encoder_watch.pictures.fetch_add(1, Ordering::Relaxed);
        let status = loop {
            // The lock is released while waiting, because the watching thread needs it.
            let status = self.child.lock().unwrap_or_else(PoisonError::into_inner).try_wait();
            match status.context("cannot wait for ffmpeg")? {
                Some(status) => break status,
                None => thread::sleep(Duration::from_millis(10)),
            }
        };
        self.encoder_watch.is_finished.store(true, Ordering::Relaxed);
        let message = self.messages.take().and_then(|reader| reader.join().ok()).unwrap_or_default();
        if self.encoder_watch.is_given_up.load(Ordering::Relaxed) {
            bail!("ffmpeg read no frame for {} seconds and was killed", STUCK_TIME.as_secs());
        }
        if !status.success() {
            bail!("ffmpeg failed ({status}): {message}");
        }
        drawn?;
        self.output.take().map_or(Ok(()), Output::finish)
    }
}

impl Drop for Ffmpeg {
    fn drop(&mut self) {
        self.encoder_watch.is_finished.store(true, Ordering::Relaxed);
        let mut child = self.child.lock().unwrap_or_else(PoisonError::into_inner);
        if let Ok(None) = child.try_wait() {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// Starts a thread that kills the program if it reads nothing for too long. The thread ends together with the program.
fn kill_when_stuck(child: &Arc<Mutex<Child>>, watch: &Arc<EncoderWatch>) {
    let (child, watch) = (Arc::clone(child), Arc::clone(watch));
    thread::spawn(move || {
        let (mut seen, mut since) = (0, Instant::now());
        while !watch.is_finished.load(Ordering::Relaxed) {
            thread::sleep(Duration::from_millis(200));
            let pictures = watch.pictures.load(Ordering::Relaxed);
            if pictures != seen {
                (seen, since) = (pictures, Instant::now());
            } else if since.elapsed() > STUCK_TIME && !watch.is_finished.load(Ordering::Relaxed) {
                watch.is_given_up.store(true, Ordering::Relaxed);
                let _ = child.lock().unwrap_or_else(PoisonError::into_inner).kill();
                return;
            }
        }
    });
}

//! A connection whose other end has to read what it asked for: in time, and not more slowly than a floor. What waits to
//! be written holds a place, a file and a little memory meanwhile.
use std::{
    io,
    pin::Pin,
    task::{Context, Poll},
    time::Duration,
};
use tokio::{
    io::{AsyncRead, AsyncWrite, ReadBuf},
    time::{Instant, Sleep},
};

/// Bytes that have to be read in a second of waiting.
pub(super) const FLOOR: u64 = 4 * 1024;

/// A stream that breaks off when its other end reads too slowly.
pub(super) struct Paced<S> {
    stream: S,
    /// For so long the other end may keep the server waiting before its pace is looked at.
    patience: Duration,
    /// Since when a write waits.
    waits_since: Option<Instant>,
    /// How long writes waited, and what was written, since its pace was looked at.
    waited: Duration,
    written: u64,
    alarm: Option<Pin<Box<Sleep>>>,
}

impl<S> Paced<S> {
    pub(super) fn new(stream: S, patience: Duration) -> Self {
        Self { stream, patience, waits_since: None, waited: Duration::ZERO, written: 0, alarm: None }
    }

    /// Whether the other end kept pace; from now on it is looked at anew.
    fn look(&mut self) -> io::Result<()> {
        let enough = self.written >= FLOOR * self.waited.as_secs().max(1);
        (self.waited, self.written) = (Duration::ZERO, 0);
        if enough { Ok(()) } else { Err(io::Error::new(io::ErrorKind::TimedOut, "the client reads too slowly")) }
    }

    /// Something was written.
    fn went(&mut self, bytes: usize) -> io::Result<()> {
        self.alarm = None;
        self.written += bytes as u64;
        if let Some(since) = self.waits_since.take() {
            self.waited += since.elapsed();
        }
        if self.waited >= self.patience { self.look() } else { Ok(()) }
    }

    /// Nothing can be written now.
    fn stands(&mut self, context: &mut Context<'_>) -> Poll<io::Result<usize>> {
        loop {
            let since = *self.waits_since.get_or_insert_with(Instant::now);
            let until = since + self.patience.saturating_sub(self.waited);
            let alarm = self.alarm.get_or_insert_with(|| Box::pin(tokio::time::sleep_until(until)));
            if alarm.as_mut().poll(context).is_pending() {
                return Poll::Pending;
            }
            self.alarm = None;
            self.waited += since.elapsed();
            self.waits_since = None;
            self.look()?;
        }
    }

    fn after(&mut self, context: &mut Context<'_>, wrote: Poll<io::Result<usize>>) -> Poll<io::Result<usize>> {
        match wrote {
            Poll::Ready(Ok(bytes)) => Poll::Ready(self.went(bytes).map(|()| bytes)),
            Poll::Ready(Err(error)) => Poll::Ready(Err(error)),
            Poll::Pending => self.stands(context),
        }
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Paced<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(context, buffer)
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Paced<S> {
    fn poll_write(mut self: Pin<&mut Self>, context: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let wrote = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.after(context, wrote)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let wrote = Pin::new(&mut self.stream).poll_write_vectored(context, bytes);
        self.after(context, wrote)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tokio::io::{AsyncReadExt, AsyncWriteExt, duplex};

    const PATIENCE: Duration = Duration::from_millis(50);

    fn run<T>(future: impl Future<Output = T>) -> T {
        tokio::runtime::Builder::new_current_thread().enable_time().build().expect("a runtime").block_on(future)
    }

    /// Writes to somebody who reads this many bytes at a time, with a pause after each time; how it ends.
    async fn written_to(bytes: usize, pause: Duration) -> Option<io::ErrorKind> {
        let (near, mut far) = duplex(1024);
        let mut near = Paced::new(near, PATIENCE);
        let writing = async {
            for _ in 0..100 {
                if let Err(error) = near.write_all(&[1; 4096]).await {
                    return Some(error.kind());
                }
            }
            None
        };
        let reading = async {
            let mut chunk = vec![0; bytes];
            loop {
                far.read_exact(&mut chunk).await.expect("bytes");
                tokio::time::sleep(pause).await;
            }
        };
        tokio::select! {
            end = writing => end,
            () = reading => None,
        }
    }

    #[test]
    fn who_reads_nothing_or_too_slowly_is_cut_off() {
        run(async {
            assert_eq!(written_to(1, Duration::from_secs(3600)).await, Some(io::ErrorKind::TimedOut));
            assert_eq!(written_to(1, Duration::from_millis(1)).await, Some(io::ErrorKind::TimedOut));
            assert_eq!(written_to(4096, Duration::ZERO).await, None);
        });
    }

    #[test]
    fn an_answer_with_long_pauses_of_its_own_is_not_cut_off() {
        run(async {
            let (near, mut far) = duplex(1024);
            let mut near = Paced::new(near, PATIENCE);
            let reading = tokio::spawn(async move {
                let mut bytes = Vec::new();
                far.read_to_end(&mut bytes).await.map(|_| bytes.len())
            });
            for _ in 0..4 {
                near.write_all(b"event").await.expect("written");
                tokio::time::sleep(PATIENCE * 2).await;
            }
            drop(near);
            assert_eq!(reading.await.expect("no panic").expect("read"), 20);
        });
    }
}

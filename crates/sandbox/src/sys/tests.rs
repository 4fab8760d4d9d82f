use std::os::fd::AsFd;

use super::*;

#[test]
fn descriptors_travel_through_a_socket() {
    let (left, right) = UnixStream::pair().unwrap();
    let (mut reader, writer) = io::pipe().unwrap();
    let null = std::fs::File::open("/dev/null").unwrap();
    send_descriptors(&left, b'L', [null.as_fd(), writer.as_fd()]).unwrap();
    drop((left, writer));
    let mut buffer = [0; 16];
    let (length, mut fds) = receive_descriptors(&right, &mut buffer).unwrap();
    assert_eq!((&buffer[..length], fds.len()), (&b"L"[..], 2));
    io::Write::write_all(&mut std::fs::File::from(fds.remove(1)), b"through").unwrap();
    drop(fds);
    let mut text = String::new();
    io::Read::read_to_string(&mut reader, &mut text).unwrap();
    assert_eq!(text, "through");
    let (length, fds) = receive_descriptors(&right, &mut buffer).unwrap();
    assert!(length == 0 && fds.is_empty(), "a closed side shows as no bytes");
}

#[test]
fn groups_and_init_are_never_signaled() {
    for pid in [-1, 0, 1] {
        assert!(kill(pid, 0).is_err());
    }
}

#[test]
fn a_process_with_threads_is_not_forked() {
    std::thread::scope(|scope| {
        let (ready, wait) = std::sync::mpsc::channel::<()>();
        scope.spawn(move || wait.recv());
        assert!(fork().is_err());
        drop(ready);
    });
}

#[test]
fn a_closed_end_is_distinguished_from_readable_data() {
    let (reader, mut writer) = io::pipe().unwrap();
    let look = || poll([Some(reader.as_fd()), None], Duration::ZERO).unwrap()[0];
    assert_eq!(look(), Readiness::Idle);
    io::Write::write_all(&mut writer, b"!").unwrap();
    assert_eq!(look(), Readiness::Ready);
    drop(writer);
    assert_eq!(look(), Readiness::Ready, "what was written is still to be read");
    io::Read::read_exact(&mut &reader, &mut [0]).unwrap();
    assert_eq!(look(), Readiness::Closed);
}

use super::*;
use std::fs;

fn fifo(path: &Path) {
    rustix::fs::mknodat(CWD, path, FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
}

#[test]
fn nothing_beneath_a_folder_is_reached_by_a_link_or_waited_for() {
    let (outside, inside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let at = |name: &str| inside.path().join(name);
    fs::write(outside.path().join("secret"), b"secret").unwrap();
    std::os::unix::fs::symlink(outside.path().join("secret"), at("link")).unwrap();
    std::os::unix::fs::symlink(outside.path(), at("way")).unwrap();
    fs::create_dir_all(at("a/b")).unwrap();
    fs::write(at("a/b/file"), b"text").unwrap();
    File::create(at("sparse")).unwrap().set_len(1 << 40).unwrap();
    let _socket = std::os::unix::net::UnixListener::bind(at("socket")).unwrap();
    fifo(&at("fifo"));
    for folder in [Folder::open(inside.path()).unwrap(), Folder::open_to_write(inside.path()).unwrap()] {
        assert_eq!(folder.read(OsStr::new("a/b/file"), 4).unwrap(), b"text");
        assert_eq!(folder.read(OsStr::new("./a/./b/file"), 4).unwrap(), b"text");
        for (name, expected) in [
            ("a/b/file", "the limit is 3"),
            ("link", "a symbolic link"),
            ("way/secret", "a symbolic link"),
            ("sparse", "the limit is 3"),
            ("socket", "a socket"),
            ("fifo", "a pipe"),
            ("a/b", "a folder"),
            ("", "a folder"),
            ("none/file", "none/file does not exist"),
            ("a/b/file/more", "a/b/file/more does not exist"),
            ("../secret", "outside the folder"),
            ("a/../a/b/file", "outside the folder"),
            ("/etc/passwd", "outside the folder"),
        ] {
            let problem = folder.read(OsStr::new(name), 3).unwrap_err().to_string();
            assert!(problem.contains(expected), "{name}: {problem}");
        }
        let mut names = folder.list_names().unwrap();
        names.sort();
        assert_eq!(names, ["a", "fifo", "link", "socket", "sparse", "way"]);
        assert!(folder.create_folder(OsStr::new("way")).unwrap_err().to_string().contains("a link"));
    }
}

#[test]
fn written_files_replace_anything_with_their_name() {
    let (outside, inside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let other = outside.path().join("other");
    fs::write(&other, b"untouched").unwrap();
    let at = |name: &str| inside.path().join(name);
    std::os::unix::fs::symlink(&other, at("link")).unwrap();
    fs::hard_link(&other, at("hard")).unwrap();
    fifo(&at("fifo"));
    let folder = Folder::open_to_write(inside.path()).unwrap();
    for name in ["link", "hard", "fifo", "new"] {
        folder.write(OsStr::new(name), b"ours").unwrap();
        assert_eq!(folder.read(OsStr::new(name), 4).unwrap(), b"ours", "{name}");
    }
    for name in ["..", ".", "", "a/b", "/x"] {
        assert!(folder.write(OsStr::new(name), b"ours").is_err(), "{name}");
    }
    drop(folder.replacement(OsStr::new("given up"), None).unwrap());
    assert_eq!(fs::read(&other).unwrap(), b"untouched");
    assert_eq!(fs::read_dir(inside.path()).unwrap().count(), 4, "nothing unfinished stays");
}

#[test]
fn a_file_that_is_written_in_place_is_one_of_the_folders_own() {
    let (outside, inside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let at = |name: &str| inside.path().join(name);
    fs::write(outside.path().join("other"), b"untouched").unwrap();
    std::os::unix::fs::symlink(outside.path().join("other"), at("link")).unwrap();
    fifo(&at("fifo"));
    let folder = Folder::open_to_write(inside.path()).unwrap();
    assert!(folder.own_file("link").unwrap_err().to_string().contains("a symbolic link"));
    assert!(folder.own_file("fifo").unwrap_err().to_string().contains("a pipe"));
    io::Write::write_all(&mut folder.own_file("journal").unwrap(), b"line").unwrap();
    assert_eq!(folder.read(OsStr::new("journal"), 100).unwrap(), b"line");
}

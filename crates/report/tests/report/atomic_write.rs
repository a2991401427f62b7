//! Writing files so that a reader sees the old one or the new one.

use apportion_report::{prepare_file, prepare_folder, stream_atomically, write_atomically};

#[test]
fn a_failed_write_leaves_the_old_file_and_no_temporary_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.json");
    write_atomically(&path, b"old").unwrap();
    let error = stream_atomically::<()>(&path, |file| {
        file.write_all(b"half of the ne")?;
        Err(std::io::Error::other("disk full"))
    });
    assert_eq!(error.unwrap_err().path, path);
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn folders_and_files_are_tried() {
    let folder = tempfile::tempdir().unwrap();
    let deep = folder.path().join("a/b");
    prepare_folder(&deep).unwrap();
    assert_eq!(std::fs::read_dir(&deep).unwrap().count(), 0);
    write_atomically(&deep.join("f"), b"").unwrap();
    assert!(prepare_folder(&deep.join("f/g")).is_err());
    assert!(prepare_file(&deep).is_err() && prepare_file(&folder.path().join("none/f")).is_err());
    assert!(prepare_file(&deep.join("f")).is_ok());
}

#[cfg(unix)]
#[test]
fn links_stay_links_files_keep_their_permissions_and_pipes_stay_pipes() {
    use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
    let folder = tempfile::tempdir().unwrap();
    let [target, link, pipe] = ["target", "link", "pipe"].map(|name| folder.path().join(name));
    std::fs::write(&target, "old").unwrap();
    std::fs::set_permissions(&target, std::fs::Permissions::from_mode(0o600)).unwrap();
    symlink("target", &link).unwrap();
    write_atomically(&link, b"new").unwrap();
    assert!(link.is_symlink());
    assert_eq!(std::fs::read(&target).unwrap(), b"new");
    assert_eq!(std::fs::metadata(&target).unwrap().permissions().mode() & 0o777, 0o600);
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || std::fs::read(pipe).unwrap()
    });
    prepare_file(&pipe).unwrap();
    write_atomically(&pipe, b"through").unwrap();
    assert_eq!(reader.join().unwrap(), b"through");
    assert!(std::fs::metadata(&pipe).unwrap().file_type().is_fifo());
}

#[test]
fn temporary_files_of_killed_runs_are_removed_and_no_others() {
    let folder = tempfile::tempdir().unwrap();
    let names = [".apportion-notes.txt", ".apportion-notes.partial", ".apportion-aB3dE5gH7jK9mN1p.partial"];
    let old = std::time::SystemTime::now() - std::time::Duration::from_secs(60);
    for name in names {
        std::fs::File::create(folder.path().join(name)).unwrap().set_modified(old).unwrap();
    }
    prepare_folder(folder.path()).unwrap();
    assert_eq!(names.map(|name| folder.path().join(name).exists()), [true, true, false]);
}

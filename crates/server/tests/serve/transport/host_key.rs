//! The host key's file.

use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt;

use cellcaster_server::ssh::host_key::HostKey;

use super::house::folder;

#[test]
fn the_key_is_created_once_and_private() {
    let folder = folder().join("new/folder");
    let made = HostKey::open(&folder).unwrap().fingerprint();
    let mode = fs::metadata(folder.join("host_key")).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
    assert_eq!(HostKey::open(&folder).unwrap().fingerprint(), made);
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

#[test]
fn a_key_readable_by_others_is_refused() {
    let folder = folder();
    HostKey::open(&folder).unwrap();
    let path = folder.join("host_key");
    for mode in [0o640, 0o604, 0o622, 0o777] {
        fs::set_permissions(&path, Permissions::from_mode(mode)).unwrap();
        let error = HostKey::open(&folder).unwrap_err();
        assert!(error.contains("can be read or written by others"), "{error}");
        assert!(error.contains("chmod 600"), "{error}");
    }
}

#[test]
fn an_invalid_key_is_refused() {
    for content in ["", "-----BEGIN OPENSSH PRIVATE KEY-----\n", "x"] {
        let folder = folder();
        let path = folder.join("host_key");
        fs::write(&path, content).unwrap();
        fs::set_permissions(&path, Permissions::from_mode(0o600)).unwrap();
        let error = HostKey::open(&folder).unwrap_err();
        assert!(error.contains("is not an ed25519 key"), "{error}");
        assert_eq!(fs::read_to_string(&path).unwrap(), content);
    }
}

#[test]
fn two_servers_starting_together_create_one_key() {
    let folder = folder();
    let open = || HostKey::open(&folder).unwrap().fingerprint();
    let fingerprints = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..2).map(|_| scope.spawn(open)).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect::<Vec<_>>()
    });
    assert_eq!(fingerprints[0], fingerprints[1]);
}

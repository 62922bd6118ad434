//! A panic is one line and exit code 70; output that nobody takes is no panic at all.
#![cfg(unix)]

mod common;

use common::hexfill;
use std::fs::OpenOptions;
use std::process::{Command, Stdio};

fn binary() -> Command {
    Command::new(assert_cmd::cargo::cargo_bin("hexfill"))
}

#[test]
fn a_panic_in_all_threads_is_one_line_and_code_70() {
    for threads in ["1", "2", "7"] {
        let mut command = binary();
        command.args(["info", ":cube", "-j", threads]).env("HEXFILL_TEST_PANIC", "1").env("RUST_BACKTRACE", "full");
        let out = command.output().unwrap();
        let stderr = String::from_utf8(out.stderr).unwrap();
        assert_eq!(out.status.code(), Some(70), "{stderr}");
        assert_eq!(stderr.lines().count(), 1, "{stderr}");
        for word in ["report", "panics.rs:", "provoked"] {
            assert!(stderr.contains(word), "{stderr}");
        }
        let json = command.arg("--json").output().unwrap();
        let json = common::json(&String::from_utf8(json.stdout).unwrap());
        assert_eq!(json["exit_code"], 70);
        assert!(json["error"].as_str().unwrap().contains("provoked"));
        // With stderr closed at the other end, or full, the code is the same.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        assert_eq!(command.stderr(writer).stdout(Stdio::null()).status().unwrap().code(), Some(70));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_nobody_takes_is_no_panic() {
    let dir = tempfile::tempdir().unwrap();
    let full = || OpenOptions::new().write(true).open("/dev/full").unwrap();
    let broken = || {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        writer
    };
    let fill = |stderr: Stdio| {
        let mut command = binary();
        command.current_dir(&dir).args(["fill", ":schneiders-pyramid", "-o", "out.vtk"]).stderr(stderr);
        command.stdout(Stdio::null()).status().unwrap().code()
    };
    let (code, _, stderr) = hexfill(dir.path(), &["fill", ":schneiders-pyramid", "-o", "plain.vtk"]);
    assert_eq!(code, 0, "{stderr}");
    assert_eq!(fill(full().into()), Some(0));
    assert_eq!(fill(broken().into()), Some(0));
    let same = |name: &str| std::fs::read(dir.path().join(name)).unwrap();
    assert!(same("out.vtk") == same("plain.vtk"));
    for command in [&["catalog"][..], &["completions", "bash"], &["info", ":schneiders-pyramid", "--json"], &["--help"]]
    {
        let code = |stdout: Stdio| binary().args(command).stdout(stdout).stderr(Stdio::null()).status().unwrap().code();
        assert_eq!(code(broken().into()), Some(0), "{command:?}");
        assert_ne!(code(full().into()), Some(101), "{command:?}");
    }
}

#[test]
fn too_many_threads_is_bad_usage() {
    let dir = tempfile::tempdir().unwrap();
    let (code, _, stderr) = hexfill(dir.path(), &["info", ":schneiders-pyramid", "-j", "0"]);
    assert_eq!((code, stderr.lines().count()), (2, 1), "{stderr}");
}
